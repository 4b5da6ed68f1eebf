"""A saved search goes on as if it had not been stopped; another file is refused with words."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from residual.models import OSCILLATOR, T, made, oscillation, series
from tracewire import resume
from tracewire.errors import OptionError
from tracewire.fit import Fit, fit, optimset
from tracewire.fit.methods import METHODS

MODEL = made(OSCILLATOR)
MEASURED = [series(oscillation(T, 0.9))]


def fitted(method: str, iterations: float = 40, **more: Any) -> Fit:
    small = {"TolX": 1e-9, "TolFun": 1e-16} if method == "fminsearch" else {}
    options = optimset(MaxIter=iterations, Display="off", **small)
    return fit(MODEL, MEASURED, method=method, options=options, rtol=1e-8, **more)


def test_the_simplex_goes_on_to_the_bit(tmp_path: Path) -> None:
    whole = fitted("fminsearch")
    file = tmp_path / "fit.json"
    fitted("fminsearch", 15, save=file)
    resumed = fitted("fminsearch", resume=file)
    assert resumed.values == whole.values
    assert (resumed.iterations, resumed.evaluations) == (whole.iterations, whole.evaluations)
    assert resumed.criterion == whole.criterion
    evaluations = [step.evaluations for step in resumed.history]
    assert evaluations == sorted(evaluations)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_goes_on_from_a_saved_file(method: str, tmp_path: Path) -> None:
    file = tmp_path / "fit.json"
    first = fitted(method, 3, save=file)
    second = fitted(method, resume=file, save=file)
    assert second.criterion <= max(first.criterion * (1 + 1e-9), 1e-16)
    assert second.evaluations > first.evaluations
    assert json.loads(file.read_text())["method"] == method


@pytest.mark.parametrize("method", METHODS)
def test_every_method_is_repeatable(method: str) -> None:
    first, second = (fitted(method, 10, seed=5) for _ in range(2))
    assert first.values == second.values
    assert first.evaluations == second.evaluations


def test_another_method_begins_at_the_saved_values(tmp_path: Path) -> None:
    file = tmp_path / "fit.json"
    first = fitted("fminsearch", 20, save=file)
    second = fitted("least_squares", resume=file)
    assert second.criterion <= first.criterion


def refused(**more: Any) -> str:
    with pytest.raises(OptionError) as caught:
        fitted("least_squares", **more)
    return str(caught.value)


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    told = refused(resume=tmp_path / "none.json")
    assert "the saved fit cannot be read: No such file or directory. Check its path." in told


@pytest.mark.parametrize("text", ["", "[1]", '{"kind": "other"}', '{"kind": "a fit of tracewire"}'])
def test_another_content_is_told(text: str, tmp_path: Path) -> None:
    file = tmp_path / "fit.json"
    file.write_text(text)
    told = refused(resume=file)
    assert "this is not the saved file of a fit. Name the file that --save" in told


def test_other_unknowns_are_told(tmp_path: Path) -> None:
    file = tmp_path / "fit.json"
    fitted("least_squares", save=file)
    told = refused(resume=file, fixed=["c"])
    assert "the saved fit is one of k, c. Free the same, or begin anew; free now: k." in told


def test_a_file_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    told = refused(save=tmp_path / "no" / "fit.json")
    assert "fit.json' cannot be written: No such file or directory" in told


def test_a_disk_that_becomes_full_does_not_cost_the_fit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All writings but the first fail: the fit is done and says so, and the first file is there."""
    usual, count = resume.write_file, 0

    def full(path: Any, content: Any) -> Any:
        nonlocal count
        count += 1
        if count > 1:
            raise OSError(28, "No space left on device")
        return usual(path, content)

    monkeypatch.setattr(resume.RESUME, "every", 0.0)
    monkeypatch.setattr(resume, "write_file", full)
    found = fitted("least_squares", save=tmp_path / "fit.json")
    assert count > 1
    assert found.values == fitted("least_squares").values
    (said,) = [text for text in found.remarks if "was not saved to its end" in text]
    assert "No space left on device" in said
    assert fitted("least_squares", resume=tmp_path / "fit.json").values
