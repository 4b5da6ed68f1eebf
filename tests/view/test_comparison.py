"""Measured data on the page: the residual, the criterion, and fits and traces in the background."""

from __future__ import annotations

import re
import shutil
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.compile import Model, compile
from tracewire.diagram import read, read_text
from tracewire.errors import DataError, Problem
from tracewire.fit import fit, optimset
from tracewire.solve import parameter_values
from tracewire.view import Service
from view.conftest import frame_in

LESSONS = Path(__file__).parents[2] / "diagrams" / "lessons"


@pytest.fixture
def lesson(tmp_path: Path) -> Path:
    """The pendulum with its two records, in a folder of its own."""
    for file in LESSONS.glob("pendulum*"):
        shutil.copy(file, tmp_path)
    return tmp_path / "pendulum.yaml"


@pytest.fixture
def pendulum(lesson: Path) -> Service:
    return Service(lesson)


def key_of(service: Service) -> str:
    opened: Any = service.answer("open", {})
    read_: Any = service.answer("read", {"text": opened["text"]})
    assert read_["fits"] and "swing" in read_["series"]
    return str(read_["key"])


def test_the_criterion_is_that_of_a_fit(pendulum: Service, lesson: Path) -> None:
    text = lesson.read_text(encoding="utf-8")
    free, known = "start: {theta: free, omega: free}", "start: {theta: 1.4, omega: 0}"
    assert free in text
    lesson.write_text(text.replace(free, known), encoding="utf-8")
    request = {"key": key_of(pendulum), "series": "swing"}
    head, arrays = frame_in(pendulum.answer("run", request))
    model = compile(read(lesson))
    fitted = fit(model, method="least_squares", options=optimset(Display="off", MaxIter=1))
    (compared,) = (c for c in fitted.comparisons if c.series == "swing")
    measured = head["measured"]
    assert measured["criterion"] == pytest.approx(fitted.criterion_before, rel=1e-3)
    theta = measured["signals"]["theta"]
    residual = arrays[theta["residual"]]
    assert theta["rms"] == pytest.approx(compared.rmse_before, rel=1e-3)
    assert len(residual) == len(arrays[theta["t"]]) == len(arrays[theta["values"]])
    t = arrays[head["t"]]
    simulated = arrays[head["panels"][0]["lines"][0]["values"]]
    there = np.interp(arrays[theta["t"]], t, simulated)
    assert arrays[theta["values"]] - there == pytest.approx(residual, abs=2e-3)


def test_the_residual_follows_the_parameters(pendulum: Service) -> None:
    key = key_of(pendulum)

    def rms(c: float) -> float:
        request = {"key": key, "series": "swing", "parameters": {"c": c, "w0_squared": 61.7}}
        head, _ = frame_in(pendulum.answer("run", request))
        return float(head["measured"]["signals"]["theta"]["rms"])

    assert rms(0.12) < rms(0.0) != rms(0.5)


def test_a_start_that_the_series_gives_is_told(pendulum: Service) -> None:
    key = key_of(pendulum)
    measured, _ = frame_in(pendulum.answer("run", {"key": key, "series": "swing"}))
    assert measured["overruled"] == ["theta.start"]
    plain, _ = frame_in(pendulum.answer("run", {"key": key}))
    assert plain["overruled"] == []


def test_a_wrong_series_and_a_broken_file_are_told(pendulum: Service, lesson: Path) -> None:
    key = key_of(pendulum)
    answer: Any = pendulum.answer("run", {"key": key, "series": "sing"})
    assert "Did you mean 'swing'?" in answer["problems"][0]["text"]
    lesson.with_name("pendulum_swing.csv").write_text("t,theta\n0,x\n1,2\n", encoding="utf-8")
    answer = pendulum.answer("run", {"key": key, "series": "swing"})
    assert "pendulum_swing.csv" in answer["problems"][0]["text"]


def ended(service: Service, seconds: float = 60.0) -> Any:
    """What a page is told of a fit or a trace that has ended."""
    end = time.monotonic() + seconds
    while not (job := service.answer("state", {})["job"])["done"]:
        assert time.monotonic() < end
        time.sleep(0.02)
    return job


def test_a_fit_proposes_a_text_and_changes_no_file(pendulum: Service, lesson: Path) -> None:
    before = lesson.read_text(encoding="utf-8")
    begun: Any = pendulum.answer("start", {"key": key_of(pendulum), "kind": "fit"})
    job = ended(pendulum)
    assert (job["id"], job["kind"]) == (begun["id"], "fit")
    proposal: Any = pendulum.answer("proposal", {"id": job["id"]})
    assert "converged" in proposal["words"][0]
    assert "<svg" in proposal["svg"]
    fitted = read_values(proposal["text"])
    alone = fit(compile(read(lesson)), method="least_squares")
    assert fitted["w0_squared"] == pytest.approx(alone.values["w0_squared"], rel=1e-5)
    assert fitted["c"] == pytest.approx(alone.values["c"], rel=1e-5)
    assert lesson.read_text(encoding="utf-8") == before
    assert proposal["effects"] == []
    report = pendulum.report(job["id"])
    assert report.startswith("<!") and "w0_squared" in report


def test_the_criterion_of_an_accepted_fit_is_that_of_the_fit(pendulum: Service) -> None:
    """Also in another page and after the server began anew: the text alone says it."""
    alone = fit(compile(read(pendulum.file)), method="least_squares")
    pendulum.answer("start", {"key": key_of(pendulum), "kind": "fit"})
    proposal: Any = pendulum.answer("proposal", {"id": ended(pendulum)["id"]})
    for service in (pendulum, Service(pendulum.file)):
        read_back: Any = service.answer("read", {"text": proposal["text"]})
        head, _ = frame_in(service.answer("run", {"key": read_back["key"], "series": "swing"}))
        assert head["measured"]["criterion"] == pytest.approx(alone.criterion, rel=1e-3)


def test_a_model_that_fails_at_the_start_of_the_data_is_told(
    pendulum: Service, lesson: Path
) -> None:
    text = lesson.read_text(encoding="utf-8")
    sine = "{type: sin, of: theta}"
    assert sine in text
    lesson.write_text(text.replace(sine, "{type: expression, formula: sqrt(theta - 10)}"))
    answer: Any = pendulum.answer("run", {"key": key_of(pendulum), "series": "swing"})
    assert "'height'" in answer["problems"][0]["text"]


def read_values(text: str) -> dict[str, float]:
    return parameter_values(compile(read_text(text, LESSONS / "pendulum.yaml")), {})


def test_a_trace_begins_at_the_values_of_the_sliders(
    pendulum: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[dict[str, float]] = []

    def noted(model: Model, progress: object) -> None:
        begun.append(parameter_values(model, {}))
        raise DataError([Problem("enough")])

    monkeypatch.setattr(import_module("tracewire.trace"), "trace", noted)
    values = {"c": 0.31, "w0_squared": 60.5}
    key = key_of(pendulum)
    pendulum.answer("start", {"key": key, "kind": "trace", "parameters": values})
    ended(pendulum)
    assert {name: begun[0][name] for name in values} == values


@pytest.mark.slow
def test_a_trace_shows_the_effect_that_it_found_in_green(pendulum: Service) -> None:
    pendulum.answer("start", {"key": key_of(pendulum), "kind": "trace"})
    job = ended(pendulum, 300)
    proposal: Any = pendulum.answer("proposal", {"id": job["id"]})
    assert 'class="block effect" data-block="coulomb"' in proposal["svg"]
    assert proposal["svg"].count('class="block effect"') == 1
    assert re.search(r"needed: up to 0\.\d+ rad/s\^2 over omega<", proposal["svg"])
    assert "{type: coulomb, rate: omega" in proposal["text"]


def test_a_fit_can_be_stopped_and_only_one_runs(
    pendulum: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = key_of(pendulum)
    pendulum.answer("start", {"key": key, "kind": "trace"})
    again: Any = pendulum.answer("start", {"key": key, "kind": "fit"})
    assert "a trace is under way" in again["problems"][0]["text"]
    pendulum.answer("stop", {})
    job = ended(pendulum)
    answer: Any = pendulum.answer("proposal", {"id": job["id"]})
    assert "stopped" in str(answer.get("problems")) or "interrupted" in str(answer.get("words"))


@pytest.mark.parametrize(
    ("action", "request_", "said"),
    [
        ("start", {"kind": "bake"}, "there is no work 'bake'"),
        ("proposal", {"id": "x"}, "no such result"),
        ("proposal", {"effects": "all"}, "no list"),
    ],
)
def test_wrong_requests_are_told(
    pendulum: Service, action: str, request_: dict[str, Any], said: str
) -> None:
    answer: Any = pendulum.answer(action, {"key": key_of(pendulum)} | request_)
    assert said in answer["problems"][0]["text"]


def test_a_page_for_a_class_fits_nothing(lesson: Path) -> None:
    service = Service(lesson, present=True)
    answer: Any = service.answer("start", {"key": key_of(service), "kind": "fit"})
    assert "--present" in answer["problems"][0]["text"]
