"""`tracewire blocks` of installed libraries: what is listed, described, and on the page."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from library.installed import MAGNET, RIG, install


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder on the path of Python with an installed library, which has a diagram, too."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    example = "subsystems: {}\nblocks: {x: {type: constant, value: 1}}\n"
    install(folder, {"magnets.py": MAGNET, "rig.yaml": RIG, "example.yaml": example})
    return folder


def test_the_palette_ends_with_the_libraries(call: Any, site: Path) -> None:
    lines = call("blocks").out.splitlines()
    assert lines[0].split() == ["family", "block", "what", "it", "is"]
    head = lines.index("libraries: 'tracewire blocks NAME' lists one")
    assert "  mylab      mylab-blocks 1.2" in lines[head:]
    assert not any("mylab.magnet" in line for line in lines)
    data = call("blocks", "--json").data
    told = {"library": "mylab", "distribution": "mylab-blocks", "version": "1.2"}
    assert told in data["libraries"]
    assert "gain" in [block["name"] for block in data["blocks"]]


def test_the_palette_says_what_a_trace_tries(call: Any) -> None:
    lines = call("blocks").out.splitlines()
    head = lines.index("effects that a trace tries; --effects says what each is")
    sums, drives, sensors = (line.split(None, 3) for line in lines[head + 1 : head + 4])
    assert sums[:3] == ["at", "a", "sum"] and "coulomb" in sums[3]
    assert drives[:3] == ["in", "a", "drive"] and "drive_lag" in drives[3]
    assert sensors[:3] == ["of", "a", "sensor"] and "sensor_quad" in sensors[3]


def test_effects_are_listed_with_place_and_meaning(call: Any) -> None:
    lines = call("blocks", "--effects").out.splitlines()
    assert lines[0].split() == ["place", "effect", "what", "it", "is"]
    (lag,) = (line for line in lines if " drive_lag " in line)
    assert lag.startswith("in a drive") and lag.endswith(".")
    rows = call("blocks", "--effects", "--json").data["effects"]
    assert {"place": "of a sensor", "effect": "sensor_delay", "what": "A delay."} in rows
    assert len(rows) == len(lines) - 1


def test_an_effect_of_a_sensor_is_described(call: Any, tmp_path: Path) -> None:
    assert call("blocks", "sensor_drift").out.splitlines() == [
        "sensor_drift: A drift. It is no block: a measured signal has it.",
        "",
        "formula",
        "  shown = z + drift*(t - t0), where z is the signal and t0 the time of the first sample",
        "",
        "number",
        "  drift  [unit of the column/s]  default 0",
        "",
        "in a diagram, where a fit may change it",
        "  signals: {x: {column: x, drift: {fit: [-1, 1]}}}",
        "",
        "An effect that a trace tries at each sensor: coefficient drift, of either sign.",
    ]
    rows = call("blocks", "--effects", "--json").data["effects"]
    sensors = [row for row in rows if row["place"] == "of a sensor"]
    for row in sensors:
        told = call("blocks", row["effect"], "--json").data
        assert (told["name"], told["doc"]) == (row["effect"], row["what"])
        (number,) = told["parameters"]
        assert f"{number['name']}: {{fit:" in told["written"]
    assert call("blocks", "sensor_gain", "--json").data["parameters"][0]["low"] == 0
    told = call("blocks", "sensor_gain", "--report", tmp_path / "a.html")
    assert told.code == 2 and "is an effect of a sensor, and a report is of blocks" in told.err


def test_effects_are_no_block_and_stand_alone(call: Any) -> None:
    told = call("blocks", "effects")
    assert told.code == 2 and "'tracewire blocks --effects' lists the effects" in told.err
    told = call("blocks", "coulomb", "--effects")
    assert told.code == 2 and "--effects lists all effects, and coulomb is of blocks" in told.err


def test_to_list_the_libraries_runs_none_of_them(call: Any, site: Path) -> None:
    (site / "mylab_blocks" / "magnets.py").write_text("raise SystemExit('run')", encoding="utf-8")
    assert call("blocks").code == 0


def test_a_library_is_listed_under_its_name(call: Any, site: Path) -> None:
    assert call("blocks", "mylab").out.splitlines() == [
        "library mylab of mylab-blocks 1.2",
        "",
        "family   block         what it is",
        "magnets  mylab.magnet  Pulls iron.",
        "",
        "subsystems",
        "  include: mylab:rig.yaml  pulled",
    ]
    data = call("blocks", "mylab", "--json").data
    assert [block["name"] for block in data["blocks"]] == ["mylab.magnet"]
    assert data["subsystems"] == {"rig.yaml": ["pulled"]}
    listed = [line.split() for line in call("blocks", "tracewire").out.splitlines()]
    assert ["include:", "tracewire:motors.yaml", "dc_motor,", "servo"] in listed


def test_a_block_of_a_library_is_described(call: Any, site: Path) -> None:
    told = call("blocks", "mylab.magnet")
    assert told.out.startswith("mylab.magnet: Pulls iron.")
    assert "force = -k/x**2" in told.out
    assert call("blocks", "mylab.magnet", "--json").data["family"] == "magnets"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("mylab.magnit", "unknown block 'mylab.magnit'; there are: mylab.magnet. Did you mean"),
        ("nolab.magnet", "the library 'nolab' is not installed; there are: "),
        (
            "magnet",
            "'magnet' is no block of tracewire. The installed library 'mylab' has it: write",
        ),
        ("pulled", "The library 'mylab' has a subsystem 'pulled': write include: mylab:rig.yaml."),
        ("mylob", "unknown block 'mylob'"),
    ],
)
def test_a_name_that_is_not_there_is_explained(
    call: Any, site: Path, name: str, message: str
) -> None:
    told = call("blocks", name)
    assert told.code == 2
    assert message in told.err


def test_the_page_of_a_library_stands_alone(call: Any, site: Path, tmp_path: Path) -> None:
    page = tmp_path / "mylab.html"
    assert call("blocks", "mylab", "--report", page).out == f"written: {page}\n"
    text = page.read_text(encoding="utf-8")
    headings = re.findall("<h2>(.*?)</h2>", text)
    assert headings == ["What there is", "mylab.magnet", "pulled"]
    assert "<pre>force = -k/x**2</pre>" in text
    assert "<pre>include: mylab:rig.yaml</pre>" in text
    assert "<tr><th>parameter</th><th>value</th></tr><tr><td>k</td><td>2</td></tr>" in text
    assert text.count('src="data:image/svg+xml;base64,') == 1
    assert not re.search(r'(src|href)="(?!data:)', text)


def test_the_page_of_one_block_has_its_name_here(call: Any, tmp_path: Path) -> None:
    page = tmp_path / "block.md"
    data = call("blocks", "INTEGRAL_m", "--report", page, "--json").data
    assert data["written"] == [str(page)]
    assert page.read_text(encoding="utf-8").startswith("# integrator\n")


def test_a_page_that_cannot_be_written_is_refused_before(call: Any, tmp_path: Path) -> None:
    told = call("blocks", "gain", "--report", tmp_path / "block.pdf")
    assert told.code == 2
    assert "unknown file ending '.pdf'" in told.err
