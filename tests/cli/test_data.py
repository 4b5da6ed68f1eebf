"""The verb `data`: which sets there are, and what becomes of one that cannot be brought."""

from __future__ import annotations

import gc
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tracewire.data import sets
from tracewire.data.index import SETS, DataSet

Call = Callable[..., Any]


def test_the_list_says_source_and_licence(call: Call) -> None:
    result = call("data", "list")
    assert result.code == 0
    for name, found in SETS.items():
        assert name in result.out
        assert f"github.com/{found.repository}" in result.out
        assert found.licence in result.out


def test_the_list_for_programs_has_pinned_addresses(call: Call) -> None:
    listed = call("data", "list", "--json").data["sets"]
    assert set(listed) == set(SETS)
    (loop,) = listed["tribometer_presliding"]["files"]
    assert "/e60a4bd245dfc96aeb7045998a535f9bcb24cb0c/" in loop["address"]
    assert len(loop["sha256"]) == 64


def test_a_set_comes_with_its_diagrams_and_keeps_edited_ones(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    without_files = DataSet("wheels", "someone/rig", "0123abc", "MIT", ())
    monkeypatch.setattr(sets, "SETS", {"bicycle_wheel_pendulum": without_files})
    home = tmp_path / "bicycle_wheel_pendulum"
    result = call("data", "get", "bicycle_wheel_pendulum", "--to", tmp_path)
    assert result.code == 0
    assert f"tracewire trace {home / 'axial.yaml'}" in result.out
    assert (home / "data").is_dir()
    (home / "axial.yaml").write_text("title: mine\n", encoding="utf-8")
    (home / "radial.yaml").unlink()
    again = call("data", "get", "bicycle_wheel_pendulum", "--to", tmp_path, "--json")
    assert again.data["diagrams"] == [str(home / "axial.yaml"), str(home / "radial.yaml")]
    assert (home / "axial.yaml").read_text(encoding="utf-8") == "title: mine\n"


def test_a_wrong_name_is_a_wrong_input(call: Call) -> None:
    result = call("data", "get", "mr_dampers")
    assert result.code == 2
    assert "Did you mean 'mr_damper'?" in result.err


def test_what_cannot_be_fetched_is_work_that_failed(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pooch")
    here = sets.get_set.__defaults__ or ()
    monkeypatch.setattr(sets.get_set, "__defaults__", (*here[:-1], "http://127.0.0.1:9"))
    result = call("data", "get", "mr_damper", "--to", tmp_path)
    assert result.code == 1
    assert "could not be fetched" in result.err
    assert "Check the network" in result.err
    with warnings.catch_warnings():  # requests leaves its socket to the garbage collector
        warnings.simplefilter("ignore", ResourceWarning)
        gc.collect()
