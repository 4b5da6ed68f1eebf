"""What is installed is what the repository holds, and the documents name commands that exist."""

from __future__ import annotations

import ast
import importlib.util
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from importlib.metadata import packages_distributions
from pathlib import Path
from types import ModuleType

import pytest
from hatchling.builders.sdist import SdistBuilder
from tracewire.solve.core_file import file_name

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
INSTALLED_AS = {
    "solver/tracewire": "tracewire",
    "blocks": "tracewire/blocks",
    "diagrams": "tracewire/diagrams",
}
HOOK = ROOT / "solver" / "build_core.py"
BUILDING = {"hatchling", "numba"}  # when the package is built, and not in a run
CODE = "core_library"  # machine code of the core; `make clean` removes it
CACHES = {"__pycache__", ".mypy_cache", ".ruff_cache", ".pytest_cache", ".DS_Store"}


def files(folder: Path) -> set[str]:
    found = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return {path.as_posix() for path in found if not (CACHES | {CODE}) & set(path.parts)}


def expected(root: Path) -> set[str]:
    """The files that belong into the wheel, by their installed names."""
    return {
        f"{installed}/{file}"
        for room, installed in INSTALLED_AS.items()
        for file in files(root / room)
    }


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The unpacked source distribution."""
    folder = tmp_path_factory.mktemp("sdist")
    archive = next(iter(SdistBuilder(str(ROOT)).build(directory=str(folder))))
    with tarfile.open(archive) as opened:
        opened.extractall(folder, filter="data")
    return folder / f"{PROJECT['name']}-{PROJECT['version']}"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory, sdist: Path) -> Path:
    """The unpacked wheel, built from the source distribution as an installer builds it."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=sdist, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    unpacked = folder / "site-packages"
    with zipfile.ZipFile(wheel) as opened:
        opened.extractall(unpacked)
    return unpacked


def test_wheel_has_one_top_level_name(installed: Path) -> None:
    information = f"{PROJECT['name']}-{PROJECT['version']}.dist-info"
    assert {path.name for path in installed.iterdir()} == {"tracewire", information}


def test_wheel_holds_the_package_the_blocks_and_the_diagrams(installed: Path) -> None:
    found = {file for file in files(installed) if file.startswith("tracewire/")}
    assert found == expected(ROOT)
    assert {"tracewire/py.typed", "tracewire/shipped.py", "tracewire/errors.py"} <= found


def test_wheel_has_the_machine_code_of_its_sources(installed: Path) -> None:
    (file,) = (installed / "tracewire" / "solve" / CODE).iterdir()
    assert file.name == file_name()
    (information,) = installed.glob("*.dist-info")
    tags = (information / "WHEEL").read_text(encoding="utf-8")
    assert "Root-Is-Purelib: false" in tags
    assert "Tag: py3-none-any" not in tags


def test_sdist_holds_what_a_clone_holds(sdist: Path) -> None:
    for room in ("solver", "blocks", "diagrams", "docs", "tests", "benchmarks"):
        assert files(sdist / room) == files(ROOT / room)
    names = ["README.md", "LICENSE", "CHANGELOG.md", "CONTRIBUTING.md", "Makefile"]
    assert [name for name in names if not (sdist / name).is_file()] == []


def load_shipped(package: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location("shipped_under_test", package / "shipped.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("room", ["blocks", "diagrams"])
def test_shipped_folders_are_found_beside_the_package_or_at_the_root(
    room: str, tmp_path: Path
) -> None:
    source = ROOT / "solver" / "tracewire" / "shipped.py"
    checkout = tmp_path / "clone" / "solver" / "tracewire"
    installation = tmp_path / "site-packages" / "tracewire"
    (tmp_path / "clone" / room).mkdir(parents=True)
    (installation / room).mkdir(parents=True)
    checkout.mkdir(parents=True)
    for package in (checkout, installation):
        shutil.copy(source, package)
    assert load_shipped(checkout).shipped(room) == tmp_path / "clone" / room
    assert load_shipped(installation).shipped(room) == installation / room


def test_package_and_project_agree_on_the_version() -> None:
    tree = ast.parse((ROOT / "solver" / "tracewire" / "__init__.py").read_text(encoding="utf-8"))
    said = [
        node.value.value
        for node in tree.body
        if isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Constant)
        and any(isinstance(t, ast.Name) and t.id == "__version__" for t in node.targets)
    ]
    assert said == [PROJECT["version"]]


def test_every_imported_package_is_a_declared_dependency() -> None:
    extras = PROJECT["optional-dependencies"]
    wanted = PROJECT["dependencies"] + [d for e in extras if e != "test" for d in extras[e]]
    declared = {re.split(r"[^\w.-]", text)[0].lower() for text in wanted}
    distributions = packages_distributions()
    undeclared = {}
    for file in (ROOT / "solver").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom) and not node.level and node.module:
                names = [node.module]
            for top in {name.split(".")[0] for name in names}:
                if top in sys.stdlib_module_names or top in {"tracewire", "__future__"}:
                    continue
                if top in BUILDING and (file.parent.name == "core_build" or file == HOOK):
                    continue
                if not declared & {d.lower() for d in distributions.get(top, [top])}:
                    undeclared[top] = str(file.relative_to(ROOT))
    assert undeclared == {}


def shell_lines(document: str) -> list[str]:
    """The commands in the ```sh blocks of a document, without comments and prompts."""
    blocks = re.findall(r"^```sh\n(.*?)^```", document, flags=re.MULTILINE | re.DOTALL)
    lines = (
        line.split("#")[0].strip().removeprefix("$ ") for b in blocks for line in b.split("\n")
    )
    return [line for line in lines if line]


def make_targets(command: str) -> list[str]:
    """The targets of a `make` command; assignments like PYTHON=python3.13 and options are none."""
    words = command.split()
    plain = [word for word in words[1:] if "=" not in word and not word.startswith("-")]
    return plain if words[0] == "make" else []


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md"])
def test_make_commands_of_the_documents_exist(name: str) -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    existing = set(re.findall(r"^([a-z]+):", makefile, flags=re.MULTILINE))
    lines = shell_lines((ROOT / name).read_text(encoding="utf-8"))
    named = {target for line in lines for target in make_targets(line)}
    assert named
    assert named <= existing


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"])
def test_links_of_the_documents_lead_to_files(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    links = [link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", text)]
    local = [link for link in links if link and "://" not in link]
    assert [link for link in local if not (ROOT / link).exists()] == []
