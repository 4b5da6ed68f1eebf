"""Installed libraries: they are found by name, nothing of them is run before, and what is wrong."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from library.installed import HEAD, MAGNET, RIG, install
from tracewire.errors import BlockError
from tracewire.library import (
    describe,
    find_package,
    folder_of,
    installed_packages,
    load_library,
    package_blocks,
    package_file,
    packages_with,
    subsystem_files,
)

RUB = HEAD + (
    'rub = Block("rub", "Rubs.", inputs=(Input("rate"),), parameters=(Parameter("c", low=0.0),),'
    ' outputs=(Output("force", "-c*rate"),),'
    ' effect=Effect("c", {"rate": "v"}, sign=1, alias=("magnet", "viscous")))\n'
)


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path of Python."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    return folder


def told(call: Callable[[], object]) -> str:
    with pytest.raises(BlockError) as caught:
        call()
    return str(caught.value)


def test_a_library_is_found_with_its_distribution_and_its_files(site: Path) -> None:
    files = {"magnets.py": MAGNET, "rig.yaml": RIG, "parts/more.yml": RIG, "notes.txt": ""}
    folder = install(site, files)
    package = find_package("mylab")
    assert str(package) == "mylab-blocks 1.2"
    assert folder_of(package) == folder
    assert subsystem_files(package) == ("parts/more.yml", "rig.yaml")
    assert package_file(package, "parts/more.yml") == folder / "parts" / "more.yml"
    assert package in installed_packages()


def test_blocks_of_a_library_have_its_name_in_front(site: Path) -> None:
    install(site, {"magnets.py": MAGNET, "frictions.py": RUB})
    blocks, families = package_blocks(find_package("mylab"))
    assert families == {"mylab.rub": "frictions", "mylab.magnet": "magnets"}
    effect = blocks["mylab.rub"].effect
    assert effect is not None
    assert effect.alias == ("mylab.magnet", "viscous")
    library = load_library().extended(blocks, families)
    assert {"mylab.rub", "viscous"} <= library.effects().keys()
    assert describe(library, "mylab.magnet").startswith("mylab.magnet: Pulls iron.")


def test_to_find_and_search_a_library_runs_nothing_of_it(site: Path) -> None:
    loud = "raise SystemExit('run')\n"
    install(site, {"__init__.py": loud, "_helpers.py": loud, "magnets.py": MAGNET + loud})
    package = find_package("mylab")
    assert packages_with("magnet") == ["mylab"]
    assert packages_with("pendulum") == []
    assert folder_of(package).is_dir()
    assert "mylab_blocks" not in sys.modules


def test_only_block_files_are_run(site: Path) -> None:
    loud = "raise ValueError('run')\n"
    install(site, {"__init__.py": loud, "_helpers.py": loud, "magnets.py": MAGNET})
    blocks, _ = package_blocks(find_package("mylab"))
    assert [*blocks] == ["mylab.magnet"]


def test_a_library_that_is_edited_in_place_is_found(
    site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An editable install has its information in one folder and its package in another."""
    written = install(site, {"magnets.py": MAGNET})
    (tmp_path / "work").mkdir()
    elsewhere = written.rename(tmp_path / "work" / written.name)
    monkeypatch.syspath_prepend(tmp_path / "work")
    assert folder_of(find_package("mylab")) == elsewhere


def test_what_lies_in_the_working_folder_is_not_installed(
    site: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`python -m` has that folder on the path; it may be the one of a stranger's diagram."""
    install(site, {"magnets.py": MAGNET})
    monkeypatch.chdir(site)
    assert "is not installed" in told(lambda: find_package("mylab"))


def test_the_library_of_tracewire_itself_has_its_version() -> None:
    package = find_package("tracewire")
    assert package.version == sys.modules["tracewire"].__version__
    assert folder_of(package).name == "blocks"


def test_a_library_that_is_missing_is_told_with_those_that_are_there(site: Path) -> None:
    install(site, {"magnets.py": MAGNET})
    message = told(lambda: find_package("mylob"))
    assert message.startswith("the library 'mylob' is not installed; there are: ")
    assert "mylab" in message
    assert "Did you mean 'mylab'? Install the package that has it: " in message
    assert "its types have no 'mylob.' in front." in message


def test_two_distributions_with_one_library_are_refused(site: Path) -> None:
    install(site, {"magnets.py": MAGNET})
    install(site, {"magnets.py": MAGNET}, distribution="other-blocks", version="3")
    assert told(lambda: find_package("mylab")) == (
        "two distributions have a library 'mylab': mylab-blocks 1.2 and other-blocks 3."
        " Uninstall one: pip uninstall other-blocks."
    )


def test_a_library_whose_name_cannot_stand_in_a_diagram_is_refused(site: Path) -> None:
    install(site, {"magnets.py": MAGNET}, name="my-lab")
    message = told(lambda: find_package("my-lab"))
    assert message.startswith(
        "'my-lab' cannot be the name of a library, and mylab-blocks 1.2 declares it. Use the"
    )


@pytest.mark.parametrize("module", ["no_such_package", "../..", "mylab_blocks:magnets", "a.b"])
def test_an_entry_point_that_names_no_package_is_refused(site: Path, module: str) -> None:
    install(site, {"magnets.py": MAGNET}, module=module)
    assert told(lambda: folder_of(find_package("mylab"))) == (
        f"the library 'mylab' of mylab-blocks 1.2 has no folder '{module}'."
        " Its entry point must name a package of it: mylab = 'mylab_blocks'."
    )


@pytest.mark.parametrize("path", ["../x.yaml", "/etc/passwd", "a/../../x.yaml", "out.yaml", "\0"])
def test_no_path_leads_out_of_a_library(site: Path, tmp_path: Path, path: str) -> None:
    folder = install(site, {"rig.yaml": RIG})
    (tmp_path / "secret.yaml").write_text(RIG, encoding="utf-8")
    (folder / "out.yaml").symlink_to(tmp_path / "secret.yaml")
    message = told(lambda: package_file(find_package("mylab"), path))
    assert message.startswith(f"'mylab:{path}' leads out of the library 'mylab'; there are: out.ya")


def test_a_broken_block_file_of_a_library_is_told_with_its_line(site: Path) -> None:
    folder = install(site, {"magnets.py": MAGNET + "x = = 1\n"})
    message = told(lambda: package_blocks(find_package("mylab")))
    assert message.startswith(f"{folder / 'magnets.py'}:3: the block file cannot be read: Syntax")
