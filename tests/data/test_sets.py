"""Sets of real measurements: fetched from a server, refused where they are another, and made."""

from __future__ import annotations

import gc
import hashlib
import sys
import threading
import warnings
from collections.abc import Iterator
from functools import partial
from http.server import HTTPServer, SimpleHTTPRequestHandler
from pathlib import Path

import numpy as np
import pytest
from tracewire.data import read_columns, sets
from tracewire.data.index import SETS, DataSet, Upstream
from tracewire.data.sets import fetch, get_set
from tracewire.errors import DownloadError, OptionError

SHARED = Path(__file__).parents[3] / "shared/data"
CONTENT = b"t,theta\n0,1\n1,2\n"
SMALL = DataSet(
    "a swing",
    "someone/rig",
    "0123abc",
    "MIT",
    (Upstream("runs/swing.csv", hashlib.sha256(CONTENT).hexdigest()),),
    {"second.csv": lambda folder: (folder / "swing.csv").read_text("utf-8").replace("1,2", "1,3")},
)


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, format: str, *args: object) -> None:
        pass


@pytest.fixture(autouse=True)
def sockets_closed() -> Iterator[None]:
    """requests leaves the socket of a failed request to the garbage collector, which warns."""
    yield
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        gc.collect()


@pytest.fixture
def server(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    """The address of a server that holds the file of SMALL, and the path of that file."""
    file = tmp_path / "server/someone/rig/0123abc/runs/swing.csv"
    file.parent.mkdir(parents=True)
    file.write_bytes(CONTENT)
    served = HTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(tmp_path / "server")))
    thread = threading.Thread(target=served.serve_forever, args=(0.01,))
    thread.start()
    yield f"http://127.0.0.1:{served.server_port}", file
    served.shutdown()
    served.server_close()
    thread.join()


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sets, "SETS", {"small": SMALL})


@pytest.mark.usefixtures("small")
def test_a_set_is_fetched_once_and_what_is_made_of_it_stands_beside(
    server: tuple[str, Path], tmp_path: Path
) -> None:
    pytest.importorskip("pooch")
    told: list[str] = []
    home = get_set("small", tmp_path, told.append, server[0])
    assert home == tmp_path / "small"
    assert (home / "data/swing.csv").read_bytes() == CONTENT
    assert (home / "data/second.csv").read_text("utf-8") == "t,theta\n0,1\n1,3\n"
    assert told[0] == f"fetching {server[0]}/someone/rig/0123abc/runs/swing.csv"
    server[1].unlink()
    get_set("small", tmp_path, told.append, server[0])
    assert told[-2].startswith("is there ")


def test_a_file_with_another_content_is_refused(server: tuple[str, Path], tmp_path: Path) -> None:
    pytest.importorskip("pooch")
    server[1].write_bytes(CONTENT + b"2,3\n")
    with pytest.raises(DownloadError, match=r"its SHA-256 is another\. It must be [0-9a-f]{64}"):
        fetch(SMALL, SMALL.files[0], tmp_path, base=server[0])
    assert not (tmp_path / "swing.csv").exists()


@pytest.mark.parametrize("base", ["http://127.0.0.1:9", ""])
def test_no_network_is_told_with_what_to_do(
    base: str, server: tuple[str, Path], tmp_path: Path
) -> None:
    pytest.importorskip("pooch")
    server[1].unlink()
    with pytest.raises(DownloadError) as caught:
        fetch(SMALL, SMALL.files[0], tmp_path, base=base or server[0])
    assert "could not be fetched (" in str(caught.value)
    assert f"Or put the file to '{tmp_path / 'swing.csv'}' yourself" in str(caught.value)


@pytest.mark.parametrize("package", ["pooch", "openpyxl"])
def test_a_missing_package_is_named(
    package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    needed = {
        "pooch": lambda: fetch(SMALL, SMALL.files[0], tmp_path),
        "openpyxl": lambda: SETS["falling_balls"].made["drops.csv"](tmp_path),
    }
    with pytest.raises(DownloadError, match=rf"package {package} is needed.*'tracewire\[data\]'"):
        needed[package]()


def test_what_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"unknown set of measurements 'mr_dampers'.*'mr_damper'"):
        get_set("mr_dampers", tmp_path)
    with pytest.raises(OptionError, match="there is no folder"):
        get_set("mr_damper", tmp_path / "nowhere")


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "mr_damper").write_text("a file in the way", encoding="utf-8")
    with pytest.raises(DownloadError, match="cannot be written"):
        get_set("mr_damper", tmp_path)


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
@pytest.mark.parametrize("name", SETS)
def test_the_known_content_is_that_of_the_files_at_hand(name: str) -> None:
    for file in SETS[name].files:
        content = (SHARED / name / file.name).read_bytes()
        assert hashlib.sha256(content).hexdigest() == file.sha256, file.name


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
@pytest.mark.parametrize("size", ["large", "small"])
def test_a_swing_is_thinned_out_and_counted_from_hanging(size: str, tmp_path: Path) -> None:
    made = tmp_path / "swing.csv"
    folder = SHARED / "multiarm_pendulum"
    made.write_text(SETS["multiarm_pendulum"].made[f"swing_{size}.csv"](folder), encoding="utf-8")
    own = read_columns(made, {"theta": "theta"}, "t")
    derived = folder / f"derived_freeswing_{size}_200Hz.csv"
    other = read_columns(derived, {"theta": "theta_from_hanging_rad"}, "t_s")
    rows = min(len(own.time), len(other.time))
    assert abs(len(own.time) - len(other.time)) <= 1
    assert own.time[:rows] == pytest.approx(other.time[:rows], abs=1e-9)
    assert np.max(np.abs(own.values["theta"][:rows] - other.values["theta"][:rows])) < 2e-6


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
def test_all_drops_of_all_balls_are_in_one_table() -> None:
    pytest.importorskip("openpyxl")
    folder = SHARED / "falling_balls"
    own = SETS["falling_balls"].made["drops.csv"](folder).splitlines()
    other = (folder / "derived_drops.csv").read_text("utf-8").splitlines()
    assert own[0] == other[0]
    assert sorted(own) == sorted(other)


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
def test_counts_of_the_motor_become_an_angle(tmp_path: Path) -> None:
    made = tmp_path / "turn.csv"
    folder = SHARED / "motor_cogging"
    made.write_text(SETS["motor_cogging"].made["turn_0.csv"](folder), encoding="utf-8")
    own = read_columns(made, {"angle": "angle", "current": "current"}, "t")
    t, counts, current = np.load(folder / "slow2_nocomp_0.npy")
    assert own.time == pytest.approx(t, abs=1e-6)
    assert own.values["angle"] / (2 * np.pi) * 8192 == pytest.approx(counts, abs=1e-3)
    assert own.values["current"] == pytest.approx(current, abs=1e-6)


@pytest.mark.skipif(not SHARED.is_dir(), reason="the measured series are not here")
def test_periods_of_the_bench_are_averaged_and_angles_become_speeds(tmp_path: Path) -> None:
    folder = SHARED / "twomass_bench"
    made = tmp_path / "period.csv"
    made.write_text(SETS["twomass_bench"].made["periods_4_12.csv"](folder), encoding="utf-8")
    own = read_columns(made, {"current": "current", "motor": "motor", "load": "load"}, "t")
    file = folder / "MultisineTypeA.mat"
    raw = read_columns(file, {"motor": "theta_mx", "load": "theta_my"}, every=4e-4)
    assert len(own.time) == 2500
    assert abs(np.mean(own.values["current"])) < 1e-6
    for name, sign in (("motor", 1), ("load", -1)):
        angle = sign * raw.values[name].reshape(20, 2500)[3:12].mean(axis=0)
        between = np.diff(angle) / 4e-4  # the mean speed between two samples
        middle = (own.values[name][1:] + own.values[name][:-1]) / 2
        assert np.std(between - middle) < 0.03 * np.std(middle)
