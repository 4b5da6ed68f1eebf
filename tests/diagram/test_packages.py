"""Diagrams that use installed libraries: their types, their files, and the versions they need."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from library.installed import HEAD, MAGNET, RIG, install
from tracewire.compile import compile
from tracewire.diagram import effects_of, read_text
from tracewire.errors import DiagramError
from tracewire.library import load_library, packages
from tracewire.solve import simulate

TOP = "blocks: {x: {type: constant, value: 2}, f: {type: mylab.magnet, x: x, k: 8}}\n"
INCLUDING = "blocks: {x: {type: constant, value: 2}, b: {type: pulled, x: x}}\n"


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path of Python."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    return folder


def refused(text: str, file: Path = Path("top.yaml")) -> list[str]:
    with pytest.raises(DiagramError) as caught:
        read_text(text, file)
    return str(caught.value).splitlines()


def test_a_block_of_an_installed_library_needs_its_name_only(site: Path) -> None:
    install(site, {"magnets.py": MAGNET})
    run = simulate(compile(read_text(TOP), record=["f"]), span=(0, 1))
    assert run["f"][-1] == -2
    assert "mylab.magnet" not in load_library()


def test_subsystems_of_a_library_are_included_by_its_name(site: Path) -> None:
    folder = install(site, {"magnets.py": MAGNET, "parts/rig.yaml": RIG})
    diagram = read_text(f"include: [mylab:parts/rig.yaml, tracewire:motors.yaml]\n{INCLUDING}")
    assert diagram.subsystems["pulled"].file == folder / "parts" / "rig.yaml"
    assert "dc_motor" in diagram.subsystems
    assert simulate(compile(diagram, record=["b.force"]), span=(0, 1))["b.force"][-1] == -0.5


def test_a_library_is_not_read_before_a_diagram_names_it(site: Path) -> None:
    install(site, {"magnets.py": "raise ValueError('run')\n", "rig.yaml": "subsystems: {}"})
    read_text("blocks: {x: {type: constant, value: 2}}")
    read_text("include: mylab:rig.yaml\nblocks: {x: {type: constant, value: 2}}")
    assert "magnets.py:1: the block file cannot be read: ValueError: run" in refused(TOP)[0]


def test_a_diagram_without_libraries_does_not_look_for_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def scanned(path: object) -> None:
        raise AssertionError("no diagram asked for a library")

    monkeypatch.setattr("tracewire.library.packages._scanned", scanned)
    read_text("blocks: {x: {type: constant, value: 2}}")


def test_effects_of_a_library_are_tried_where_the_diagram_names_it(site: Path) -> None:
    rub = HEAD + (
        'rub = Block("rub", "Rubs.", inputs=(Input("rate"),), parameters=(Parameter("c"),),'
        ' outputs=(Output("force", "-c*rate"),), effect=Effect("c", {"rate": "v"}, sign=1))\n'
    )
    install(site, {"frictions.py": rub})
    text = "blocks: {x: {type: constant, value: 2}}\n"
    names = [kind.name for kind in effects_of(read_text(f"libraries: [mylab]\n{text}"))]
    assert "mylab.rub" in names
    assert "mylab.rub" not in [kind.name for kind in effects_of(read_text(text))]


def test_a_diagram_with_a_library_can_be_sent_to_where_it_is_not_installed(site: Path) -> None:
    install(site, {"magnets.py": MAGNET})
    sent = pickle.loads(pickle.dumps(read_text(TOP)))
    assert sent == read_text(TOP)
    assert sent.library["mylab.magnet"].doc == "Pulls iron."


@pytest.mark.parametrize(
    "libraries", ['{mylab: ">=1.2"}', "[mylab]", "mylab", "{mylab: '>=1, <2', tracewire: '>=0.1'}"]
)
def test_a_diagram_says_what_it_needs(site: Path, libraries: str) -> None:
    install(site, {"magnets.py": MAGNET})
    assert "f" in read_text(f"libraries: {libraries}\n{TOP}").blocks


def test_a_development_version_meets_a_condition(site: Path) -> None:
    install(site, {"magnets.py": MAGNET}, version="1.3.dev1")
    assert "f" in read_text(f'libraries: {{mylab: ">=1.2"}}\n{TOP}').blocks


def test_what_a_diagram_needs_and_does_not_find_is_told_at_its_place(site: Path) -> None:
    install(site, {"magnets.py": MAGNET, "rig.yaml": RIG})
    text = (
        'libraries: {mylab: ">=2", nolab: ">=1", tracewire: ">=99", a b: ">1"}\n'
        "blocks: {a: {type: nolab.wing}, b: {type: mylab.magnat}}\n"
    )
    first, second, third, fourth, last = refused(text)
    assert first == (
        "top.yaml:1:20: the diagram needs the library 'mylab' >=2, and mylab-blocks 1.2 is"
        " installed. Install another version: pip install 'mylab-blocks>=2'."
    )
    assert second.startswith("top.yaml:1:27: the library 'nolab' is not installed; there are: ")
    assert third.startswith("top.yaml:1:52: the diagram needs the library 'tracewire' >=99, and ")
    assert fourth.startswith("top.yaml:1:60: 'a b' cannot be the name of a library. Use the lett")
    assert last == (
        "top.yaml:2:43: block 'b': unknown block type 'mylab.magnat'; there are: mylab.magnet."
        " Did you mean 'mylab.magnet'? 'tracewire blocks mylab' lists what the library has."
    )


def test_a_version_that_is_none_meets_nothing(site: Path) -> None:
    install(site, {"magnets.py": MAGNET}, version="new")
    (told,) = refused(f'libraries: {{mylab: ">=1"}}\n{TOP}')
    assert "the diagram needs the library 'mylab' >=1, and mylab-blocks new is installed" in told
    (information,) = site.glob("*.dist-info")
    (information / "METADATA").write_text("Name: mylab-blocks\n", encoding="utf-8")
    packages._scanned.cache_clear()
    (told,) = refused(f'libraries: {{mylab: ">=1"}}\n{TOP}')
    assert "mylab-blocks ? is installed" in told


@pytest.mark.parametrize(
    ("libraries", "message"),
    [
        ("{mylab: 1.2}", "'1.2' is no condition on the version of a library. Write it like \">=1"),
        ("{mylab: [1]}", "the condition on a version must be a text"),
        ("[[mylab]]", "an entry of 'libraries' must be a name"),
    ],
)
def test_a_need_that_is_written_wrongly_is_refused(
    site: Path, libraries: str, message: str
) -> None:
    install(site, {"magnets.py": MAGNET})
    (told,) = refused(f"libraries: {libraries}\n{TOP}")
    assert message in told


def test_an_included_file_says_what_it_needs_too(site: Path, tmp_path: Path) -> None:
    install(site, {"magnets.py": MAGNET, "rig.yaml": 'libraries: {mylab: ">=9"}\n' + RIG})
    (told,) = refused(f"include: mylab:rig.yaml\n{INCLUDING}")
    assert "rig.yaml:1:20: the diagram needs the library 'mylab' >=9" in told


def test_a_library_that_is_missing_is_told_once(site: Path) -> None:
    text = (
        "include: nolab:rig.yaml\nlibraries: [nolab]\n"
        "blocks: {a: {type: nolab.wing}, b: {type: nolab.wing}}\n"
    )
    (told,) = refused(text)
    assert told.startswith("top.yaml:2:13: the library 'nolab' is not installed")


def test_a_type_of_tracewire_has_no_name_in_front() -> None:
    (told,) = refused("blocks: {a: {type: tracewire.constant, value: 1}}")
    assert told.endswith(
        "'tracewire.constant'; there is no block type here. The types of tracewire"
        " have no name in front."
    )


def test_an_unknown_type_names_the_library_that_has_it(site: Path) -> None:
    install(site, {"magnets.py": MAGNET, "rig.yaml": RIG})
    one, two, three = refused(
        "blocks:\n  a: {type: magnet}\n  b: {type: pulled}\n  c: {type: dc_motor}\n"
    )
    assert one == (
        "top.yaml:2:13: block 'a': unknown block type 'magnet'."
        " The installed library 'mylab' has it: write type: mylab.magnet."
    )
    assert two == (
        "top.yaml:3:13: block 'b': unknown block type 'pulled'."
        " The library 'mylab' has a subsystem 'pulled': write include: mylab:rig.yaml."
    )
    assert three.endswith("has a subsystem 'dc_motor': write include: tracewire:motors.yaml.")


def test_no_include_leads_out_of_a_library(site: Path, tmp_path: Path) -> None:
    (tmp_path / "secret.yaml").write_text(RIG, encoding="utf-8")
    files = {"rig.yaml": "include: ../../secret.yaml\n" + RIG, "good.yaml": "include: parts/a.yaml"}
    install(site, {**files, "parts/a.yaml": RIG, "magnets.py": MAGNET})
    (told,) = refused("include: mylab:../../secret.yaml\nblocks: {}")
    assert "'mylab:../../secret.yaml' leads out of the library 'mylab'; there are: good" in told
    (told,) = refused("include: mylab:rig.yaml\nblocks: {}")
    assert "rig.yaml:1:10: '../../secret.yaml' leads out of the library that names it." in told
    assert read_text("include: mylab:good.yaml\nblocks: {}").subsystems == {}
    assert "pulled" in read_text("include: secret.yaml\nblocks: {}", tmp_path / "a").subsystems


def test_a_module_that_is_no_library_is_never_loaded(site: Path) -> None:
    (site / "strange.py").write_text("raise SystemExit('run')\n", encoding="utf-8")
    (told,) = refused("blocks: {a: {type: strange.block}}")
    assert "the library 'strange' is not installed" in told
