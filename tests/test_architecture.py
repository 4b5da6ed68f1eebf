"""Rooms and files import in one direction, stay small, and run no text as code."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import pytest
from file_graph import circles, modules, needs
from named_numbers import constants

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "solver" / "tracewire"
BLOCKS = ROOT / "blocks"

# a room may import itself and the rooms before it
ROOMS = ["array_types", "errors", "arguments", "extras", "files", "npm", "shipped", "result"]
ROOMS += ["options", "blas", "resume", "formula", "library", "data", "diagram", "elk", "draw"]
ROOMS += ["compile", "solve", "residual", "fit", "trace", "analyse", "show", "view", "paper", "cli"]
# the same for the stages of a trace, files and folders of that room
STAGES = [
    "limits",
    "data_thresholds",
    "thresholds",
    "options",
    "found",
    "candidates",
    "units",
    "trials",
    "check",
    "screen",
]
STAGES += ["missing", "search", "choose", "experiment", "results", "saved", "trace"]
# A room is used by the others through its face, what its `__init__` names. These pairs take more,
# as often as said; a pair that is not here takes nothing more. The numbers only fall.
DEEP = {
    "analyse -> solve": 1,
    "cli -> data": 2,
    "cli -> paper": 7,
    "cli -> show": 11,
    "cli -> trace": 3,
    "paper -> show": 16,
    "show -> fit": 2,
    "show -> trace": 2,
    "solve -> compile": 1,
}
# Thresholds stand in `limits.py` or an options record. Other numbers with names at the top of a
# file, by room: codes, sizes of formats, plain mathematics; those of the core. They only fall.
CONSTANTS = {"errors": 2, "files": 1, "formula": 1, "data": 9, "elk": 2, "compile": 7, "solve": 5}
CONSTANTS |= {"solve/core": 101, "residual": 2, "trace": 2, "analyse": 1, "paper": 14, "cli": 2}
# Modules that a function of the same name hides in their room. There shall be no more of them.
HIDDEN = {"fit/fit", "fit/fminsearch", "fit/optimset", "fit/profile", "trace/trace"}
FACADE = {"__init__", "__main__"}  # they stand above the rooms and may import each of them
BLOCKS_MAY_IMPORT = {"__future__", "tracewire.library"}
MOST_LINES = 500
# the functions of a model, and the callers of the core by the names of their arguments
RUN_THEIR_OWN_SOURCE = {"compile/source.py", "solve/core_build/lower.py"}
WRITES_FILES = {"files.py", "cli/streams.py"}
WRITING = {"write_text", "write_bytes", "savez_compressed", "savetxt", "tofile"}
TAKES_A_FILE = {"savez", "savefig"}
UNSAFE_YAML = {"unsafe_load", "unsafe_load_all", "full_load", "full_load_all"}
SAFE_LOADERS = {"SafeLoader", "CSafeLoader"}


def python_files(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.py"))


def against_the_order(file: str, source: str) -> list[str]:
    """The imports of `file` (its path inside the package) that its room may not make."""
    parts = Path(file).with_suffix("").parts
    if parts[0] in FACADE:
        return []
    if parts[0] not in ROOMS:
        return [f"{file}: the room '{parts[0]}' has no place in the order of ROOMS"]
    if parts[0] == "trace" and parts[1] not in {*STAGES, *FACADE}:
        return [f"{file}: the stage '{parts[1]}' has no place in the order of STAGES"]
    found = []
    for line, module in modules(source, ".".join(("tracewire", *parts[:-1]))):
        top, *rest = module.split(".")
        room = rest[0] if rest else ""
        if top == "blocks" or (top == "tracewire" and room == "blocks"):
            found.append(f"{file}:{line}: {module}: blocks are read, never imported by name")
        elif top == "tracewire" and room not in ROOMS:
            found.append(f"{file}:{line}: {module}: name the room, not the package above it")
        elif top == "tracewire" and ROOMS.index(room) > ROOMS.index(parts[0]):
            found.append(f"{file}:{line}: {module}: '{room}' comes after '{parts[0]}'")
        elif top == "tracewire" and room == parts[0] == "trace" and parts[1] not in FACADE:
            stage = rest[1]
            if stage not in STAGES:
                found.append(f"{file}:{line}: {module}: name the stage, not the room above it")
            elif STAGES.index(stage) > STAGES.index(parts[1]):
                found.append(f"{file}:{line}: {module}: '{stage}' comes after '{parts[1]}'")
    return found


def past_a_face(file: str, source: str, faces: Mapping[str, set[str]]) -> list[tuple[str, str]]:
    """(room, what is wrong) of each import of `file` that takes more of a room than its face."""
    parts = Path(file).with_suffix("").parts
    found = []
    for line, module in modules(source, ".".join(("tracewire", *parts[:-1]))):
        top, *rest = module.split(".")
        if top != "tracewire" or not rest or rest[0] == parts[0]:
            continue
        if rest[0] in faces and not (len(rest) == 2 and rest[1] in faces[rest[0]]):
            found.append((rest[0], f"{file}:{line}: {module}: not in the face of '{rest[0]}'"))
    return found


def face(source: str) -> set[str]:
    """What the `__init__` of a room exports: its `__all__`."""
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and last_name(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    return set()


def bases_of_classes(sources: Mapping[str, str]) -> dict[str, set[str]]:
    """The base classes that each class of the sources names, without the module before the name."""
    bases: dict[str, set[str]] = {}
    for source in sources.values():
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.ClassDef):
                bases.setdefault(node.name, set()).update(last_name(b) for b in node.bases)
    return bases


def last_name(node: ast.expr) -> str:
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


def is_safe(loader: str, bases: Mapping[str, set[str]]) -> bool:
    if loader in SAFE_LOADERS:
        return True
    # a class that names itself as its base would not even import, so this ends
    return any(is_safe(base, bases) for base in bases.get(loader, set()) - {loader})


def runs_text(file: str, source: str, bases: Mapping[str, set[str]]) -> list[str]:
    """Where `source` could run text as code: eval, exec, a YAML loader that builds any object."""
    found = []
    executed = 0
    tree = ast.parse(source)
    from_yaml = {
        name.asname or name.name: name.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == "yaml"
        for name in node.names
    }
    for node in ast.walk(tree):
        match node:
            case ast.Name(id="eval" | "exec" as name):
                pass
            case ast.Attribute(value=ast.Name(id="builtins"), attr="eval" | "exec" as name):
                pass
            case ast.Call(func=ast.Attribute(value=ast.Name(id="yaml"), attr=name)):
                pass
            case ast.Call(func=ast.Name(id=called)) if called in from_yaml:
                name = from_yaml[called]
            case _:
                continue
        if name == "exec" and file in RUN_THEIR_OWN_SOURCE:
            executed += 1
            if executed == 1:
                continue
        if name in {"load", "load_all"} and isinstance(node, ast.Call):
            given = [k.value for k in node.keywords if k.arg == "Loader"] + node.args[1:2]
            if given and is_safe(last_name(given[0]), bases):
                continue
        elif name not in UNSAFE_YAML | {"eval", "exec"}:
            continue
        found.append(f"{file}:{node.lineno}: {name}")
    return found


def writes_past(file: str, source: str) -> list[str]:
    """Where `source` writes a file by its name, past the one place that writes files whole."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if file in WRITES_FILES or not isinstance(node, ast.Call):
            continue
        name, first = last_name(node.func), node.args[0] if node.args else None
        modes = [k.value for k in node.keywords if k.arg == "mode"] + node.args[:2]
        texts = [mode.value for mode in modes if isinstance(mode, ast.Constant)]
        opened = name == "open" and any(
            set(str(text)) & set("wax+") and len(str(text)) < 4 for text in texts
        )
        by_name = name in TAKES_A_FILE and last_name(first or node.func) != "file"
        if name in WRITING or opened or by_name:
            found.append(f"{file}:{node.lineno}: {name}")
    return found


def sources() -> dict[str, str]:
    """{path inside the package: text}; a face that is lazy is read from the stub beside it."""
    return {
        file.relative_to(PACKAGE).as_posix(): (
            stub if (stub := file.with_suffix(".pyi")).is_file() else file
        ).read_text(encoding="utf-8")
        for file in python_files(PACKAGE)
    }


def test_imports_run_one_way() -> None:
    read = sources()
    assert read
    assert [line for file, text in read.items() for line in against_the_order(file, text)] == []


def test_rooms_use_each_other_s_faces() -> None:
    read = sources()
    faces = {room: face(read.get(f"{room}/__init__.py", "")) for room in ROOMS}
    faces = {room: names for room, names in faces.items() if names}
    found = [
        (f"{Path(file).with_suffix('').parts[0]} -> {room}", line)
        for file, text in read.items()
        for room, line in past_a_face(file, text, faces)
    ]
    counts = Counter(pair for pair, _ in found)
    assert [line for pair, line in found if counts[pair] > DEEP.get(pair, 0)] == []
    assert counts == DEEP, "there are fewer now: write the smaller numbers into DEEP"


def test_no_function_hides_the_module_of_its_name() -> None:
    read = sources()
    hidden = {
        f"{folder}/{name}"
        for folder, text in ((f.removesuffix("/__init__.py"), t) for f, t in read.items())
        for name in face(text)
        if f"{folder}/{name}.py" in read
    }
    assert hidden == HIDDEN


def test_thresholds_stand_in_limits_or_options() -> None:
    counts: Counter[str] = Counter()
    for file, text in sources().items():
        room = Path(file).with_suffix("").parts[0]
        counts["solve/core" if file.startswith("solve/core/") else room] += len(constants(text))
    assert {room: n for room, n in counts.items() if n > CONSTANTS.get(room, 0)} == {}, (
        "a threshold belongs into the `limits.py` of its room, with meaning, unit and source"
    )
    assert +counts == CONSTANTS, "there are fewer now: write the smaller numbers into CONSTANTS"


def test_no_file_needs_one_that_needs_it() -> None:
    read = {f"tracewire/{file}": text for file, text in sources().items()}
    for folder in (BLOCKS, ROOT / "benchmarks"):
        for file in python_files(folder):
            read[file.relative_to(ROOT).as_posix()] = file.read_text(encoding="utf-8")
    found = circles(read)
    assert not found, "\n".join(found)


def test_block_files_import_the_library_and_nothing_else() -> None:
    strangers = [
        f"{file.relative_to(ROOT)}:{line}: {module}"
        for file in python_files(BLOCKS)
        for line, module in modules(file.read_text(encoding="utf-8"))
        if not any(f"{module}.".startswith(f"{allowed}.") for allowed in BLOCKS_MAY_IMPORT)
    ]
    assert strangers == []


def test_files_stay_small() -> None:
    counted = {
        str(file.relative_to(ROOT)): len(file.read_text(encoding="utf-8").splitlines())
        for room in ("solver", "blocks", "tests", "benchmarks")
        for file in python_files(ROOT / room)
    }
    assert {file: lines for file, lines in counted.items() if lines > MOST_LINES} == {}


def test_every_package_folder_says_what_it_is() -> None:
    silent = []
    for folder in {file.parent for file in python_files(PACKAGE)}:
        front = folder / "__init__.py"
        if not front.is_file() or not ast.get_docstring(ast.parse(front.read_text("utf-8"))):
            silent.append(str(folder.relative_to(ROOT)))
    assert silent == []


def test_nothing_runs_text_as_code() -> None:
    read = sources()
    bases = bases_of_classes(read)
    assert [line for file, text in read.items() for line in runs_text(file, text, bases)] == []


def test_files_are_written_whole_in_one_place() -> None:
    assert [line for file, text in sources().items() for line in writes_past(file, text)] == []


# The checks themselves are checked: each of these sources must be refused, or let pass.


@pytest.mark.parametrize(
    ("file", "source"),
    [
        ("formula/parser.py", "from tracewire.library import Block"),
        ("formula/parser.py", "from tracewire import library"),
        ("formula/parser.py", "from ..library.declare import Block"),
        ("formula/__init__.py", "from ..library import Block"),
        ("formula/deep/parse.py", "from ... import solve"),
        ("errors.py", "from . import shipped"),
        ("errors.py", "def late():\n    import tracewire.cli"),
        ("solve/run.py", "import tracewire"),
        ("solve/run.py", "from tracewire import simulate"),
        ("library/load.py", "import blocks.friction"),
        ("library/load.py", "from tracewire.blocks import friction"),
        ("library/load.py", "import_module('tracewire.blocks.friction')"),
        ("cellar/wine.py", ""),
        ("trace/cellar/wine.py", ""),
        (
            "trace/found.py",
            "from tracewire.trace.screen.torque_linearisation import TorqueLinearisation",
        ),
        ("trace/screen/torque_linearisation.py", "from ..search.search import Search"),
        ("trace/screen/torque_linearisation.py", "from tracewire.trace import Found"),
        ("fit/fit.py", "from tracewire.trace import Found"),
    ],
)
def test_an_import_against_the_order_is_found(file: str, source: str) -> None:
    assert len(against_the_order(file, source)) == 1


@pytest.mark.parametrize(
    ("file", "source"),
    [
        ("solve/run.py", "from tracewire.compile import Model"),
        ("solve/run.py", "from ..errors import Problem\nfrom . import steps"),
        ("compile/source.py", "from .tape import Tape\nimport compileall, trace, blocksworld"),
        ("__init__.py", "from tracewire.cli import main"),
        ("trace/__init__.py", "from tracewire.trace.trace import trace"),
        (
            "trace/search/search.py",
            "from tracewire.trace.screen.torque_linearisation import TorqueLinearisation",
        ),
    ],
)
def test_an_import_in_the_order_passes(file: str, source: str) -> None:
    assert against_the_order(file, source) == []


@pytest.mark.parametrize(
    ("source", "refused"),
    [
        ("from tracewire.fit import fit", 0),
        ("from tracewire.compile.model import Model", 0),
        ("from tracewire.trace.found import Found", 0),
        ("from tracewire.fit.fit import fit", 1),
        ("from tracewire.fit import secret", 1),
        ("import tracewire.fit", 1),
    ],
)
def test_an_import_past_a_face_is_found(source: str, refused: int) -> None:
    faces = {"fit": {"fit"}, "trace": {"trace"}}
    assert len(past_a_face("trace/trace.py", source, faces)) == refused


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("FAR = 3.0", ["FAR"]),
        ("FAR: float = -2 * 10**3", ["FAR"]),
        ("NEAR, FAR = 1, 2.5", ["NEAR", "FAR"]),
        ("NEAR = FAR = 1", ["NEAR", "FAR"]),
        ("NAME, FAR = 'far', 2", ["FAR"]),
        ("TABLE = (1, 2)\nLIVE = True\nTEXT = '1'\nEPS = eps(float)", []),
        ("class Limits:\n    far: float = 3.0", []),
        ("def f(far=3.0):\n    near = 1", []),
    ],
)
def test_a_number_with_a_name_is_counted(source: str, names: list[str]) -> None:
    assert constants(source) == names


HOUSE = {
    "house/__init__.py": "from house.door import door",
    "house/door.py": "from house.wall import Wall, paint",
    "house/wall.py": "class Wall: ...",
    "house/roof.py": "from house.wall import Wall",
    "garden/gate.py": "import house\nfrom house import door, roof",
}


def test_a_name_of_a_face_is_taken_from_it_and_a_module_from_its_file() -> None:
    assert circles(HOUSE) == []
    taken = needs(HOUSE)
    assert taken["house/door.py"] == {"house/wall.py": ["Wall", "paint"]}
    assert taken["garden/gate.py"] == {
        "house/__init__.py": ["door", "the module"],
        "house/roof.py": ["the module"],
    }


@pytest.mark.parametrize(
    "source",
    [
        "from house.roof import Tile",
        "from .roof import Tile",
        "def late():\n    from house.roof import Tile",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from house.roof import Tile",
    ],
)
def test_a_circle_of_files_is_found_with_what_each_takes(source: str) -> None:
    assert circles(HOUSE | {"house/wall.py": source}) == [
        "2 files need each other:\n"
        "  house/roof.py takes Wall from house/wall.py\n"
        "  house/wall.py takes Tile from house/roof.py"
    ]


@pytest.mark.parametrize(
    "source",
    ["import house.roof", "from house import roof", "import_module('house.roof')"],
)
def test_a_circle_through_a_module_is_found(source: str) -> None:
    (circle,) = circles(HOUSE | {"house/wall.py": source})
    assert "house/wall.py takes the module from house/roof.py" in circle


def test_a_circle_through_a_face_is_found() -> None:
    assert circles(HOUSE | {"house/wall.py": "from house import door"}) == [
        "3 files need each other:\n"
        "  house/__init__.py takes door from house/door.py\n"
        "  house/door.py takes Wall, paint from house/wall.py\n"
        "  house/wall.py takes door from house/__init__.py"
    ]


@pytest.mark.parametrize(
    "source",
    [
        "eval('1')",
        "import builtins\nbuiltins.exec('1')",
        "import yaml\nyaml.load(text)",
        "import yaml\nyaml.load(text, Loader=yaml.Loader)",
        "import yaml\nyaml.load(text, Loud)",
        "import yaml\nyaml.unsafe_load(text)",
        "from yaml import load as read\nread(text, Loader=Loud)",
        "run = exec",
    ],
)
def test_text_run_as_code_is_found(source: str) -> None:
    assert len(runs_text("fit/fit.py", source, {"Loud": {"Loader"}})) == 1


@pytest.mark.parametrize(
    "source",
    [
        "import yaml\nyaml.load(text, Loader=yaml.SafeLoader)\nyaml.safe_load(text)",
        "import yaml\nyaml.load(text, Strict)",
        "import numpy as np\nnp.load(file)\nspecification.loader.exec_module(module)",
    ],
)
def test_what_runs_no_text_passes(source: str) -> None:
    assert runs_text("fit/fit.py", source, {"Strict": {"Marked"}, "Marked": {"SafeLoader"}}) == []


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("Path(name).write_text('a')", 1),
        ("with open(name, 'w') as file:\n    pass", 1),
        ("with Path(name).open('ab') as file:\n    pass", 1),
        ("figure.savefig(path)", 1),
        ("np.savez(path, x=x)", 1),
        ("with open(name) as file, replacing(name) as file:\n    np.savez(file)", 0),
    ],
)
def test_a_file_that_is_not_written_whole_is_found(source: str, found: int) -> None:
    assert len(writes_past("fit/fit.py", source)) == found


def test_generated_source_is_executed_in_one_place_of_a_file() -> None:
    assert runs_text("compile/source.py", "exec(code, names)", {}) == []
    assert len(runs_text("compile/source.py", "exec(code, names)\nexec(code, names)", {})) == 1
    assert len(runs_text("solve/source.py", "exec(code, names)", {})) == 1
