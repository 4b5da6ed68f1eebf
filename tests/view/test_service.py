"""What the page of a diagram asks for, and what it gets."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tracewire.compile import compile
from tracewire.diagram import read_text
from tracewire.errors import DiagramError
from tracewire.view import Service
from tracewire.view.limits import VIEW
from tracewire.view.sliders import range_of, sliders_of
from view.conftest import SPRING, frame_in

KeyOf = Callable[[str], str]


def test_a_page_opens_the_file_and_reads_it(service: Service, spring: Path) -> None:
    opened: Any = service.answer("open", {})
    assert (opened["name"], opened["text"], opened["present"]) == ("spring.yaml", SPRING, False)
    read: Any = service.answer("read", {"text": opened["text"]})
    assert read["problems"] == []
    assert (read["title"], read["presets"], read["scene"]) == (
        "A mass on a spring",
        ["stiff"],
        True,
    )
    assert [p["name"] for p in read["parameters"]] == ["k", "start", "twice", "force", "c"]


def test_a_page_is_told_what_may_stand_at_its_cursor(service: Service) -> None:
    key: Any = service.answer("read", {"text": SPRING})
    assert key["drawn"] is True
    before = SPRING.partition("-k*x - c")[0] + "st"
    answer: Any = service.answer("complete", {"text": before, "key": key["key"]})
    assert answer["word"] == "st"
    assert answer["proposals"] == [{"text": "start", "doc": "a parameter", "insert": "start"}]
    other: Any = service.answer("complete", {"text": "blocks: {a: {type: gai", "key": "gone"})
    assert other["proposals"][0]["text"] == "gain"
    assert other["proposals"][0]["doc"]
    wrong: Any = service.answer("read", {"text": "blocks: [1"})
    assert wrong["drawn"] is False


def test_sliders_have_bounds_units_and_scales() -> None:
    sliders = {s.name: s for s in sliders_of(compile(read_text(SPRING)))}
    k, start, c = sliders["k"], sliders["start"], sliders["c"]
    assert (k.low, k.high, k.unit, k.free, k.logarithmic, k.line) == (1, 9, "1/s^2", True, False, 5)
    assert (start.value, start.low, start.high) == (pytest.approx(100), 0, pytest.approx(200))
    assert (start.unit, start.factor, start.free) == ("mm", 1e-3, False)
    assert sliders["twice"].follows == "2*k"
    assert (sliders["force"].low, sliders["force"].high) == (-1, 1)
    assert c.logarithmic
    stiff = {s.name: s.value for s in sliders_of(compile(read_text(SPRING)), "stiff")}
    assert (stiff["k"], stiff["twice"]) == (8, 16)


@pytest.mark.parametrize(
    ("value", "fit", "ends"),
    [
        (3.0, None, (0.0, 6.0)),
        (-3.0, None, (-6.0, 0.0)),
        (0.0, None, (-1.0, 1.0)),
        (3.0, (-np.inf, np.inf), (0.0, 6.0)),
        (3.0, (1.0, np.inf), (1.0, 6.0)),
        (-3.0, (-np.inf, 5.0), (-6.0, 5.0)),
        (0.0, (0.0, np.inf), (0.0, 1.0)),
        (3.0, (2.0, 4.0), (2.0, 4.0)),
    ],
)
def test_a_slider_has_two_ends(
    value: float, fit: tuple[float, float] | None, ends: tuple[float, float]
) -> None:
    assert range_of(value, fit) == ends


def test_a_run_follows_its_parameters(service: Service, key_of: KeyOf) -> None:
    key = key_of(SPRING)
    values = {"k": 9.0, "c": 0.0}
    head, arrays = frame_in(service.answer("run", {"key": key, "number": 7, "parameters": values}))
    t = arrays[head["t"]]
    assert head["number"] == 7
    assert [[line["name"] for line in panel["lines"]] for panel in head["panels"]] == [["x"], ["v"]]
    x = arrays[head["panels"][0]["lines"][0]["values"]]
    assert x == pytest.approx(0.1 * np.cos(3 * t), abs=1e-6)
    assert head["followed"]["twice"] == 18
    (box,) = head["scene"]["parts"]
    assert arrays[box["points"]["at"][0]] == pytest.approx(x)
    assert len(arrays[box["sizes"]["width"]]) == 1  # what does not move is sent once
    assert head["scene"]["extent"][1] > 0.15


def test_a_run_takes_a_preset(service: Service, key_of: KeyOf) -> None:
    head, _ = frame_in(service.answer("run", {"key": key_of(SPRING), "preset": "stiff"}))
    assert head["followed"]["k"] == 8


def test_events_and_what_sticks_are_told(service: Service) -> None:
    cart = Path(__file__).parents[2] / "diagrams" / "lessons" / "cart.yaml"
    known = Service(cart)
    read: Any = known.answer("read", {"text": cart.read_text(encoding="utf-8")})
    head, _ = frame_in(known.answer("run", {"key": read["key"]}))
    lines = {line["name"]: line for panel in head["panels"] for line in panel["lines"]}
    assert set(lines) == {"x", "v", "friction"}  # not `end`, which only the scene reads
    assert len(lines["v"]["held"]) == 6
    assert {event["kind"] for event in head["events"]} == {"stick", "slip"}
    assert head["event_count"] == len(head["events"]) == 11


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        ({"parameters": {"q": 1.0}}, "unknown parameter 'q'"),
        ({"parameters": {"k": "4"}}, "the value of 'k' is no number"),
        ({"parameters": {"k": True}}, "the value of 'k' is no number"),
        ({"preset": "soft"}, "unknown preset 'soft'"),
        ({"key": "gone"}, "not kept any more"),
    ],
)
def test_a_wrong_run_is_told(
    service: Service, key_of: KeyOf, request_: dict[str, Any], said: str
) -> None:
    answer: Any = service.answer("run", {"key": key_of(SPRING)} | request_)
    assert said in answer["problems"][0]["text"]


def test_a_run_that_fails_says_where_and_why(service: Service, key_of: KeyOf) -> None:
    text = SPRING.replace("-k*x", "-k/(x - 5*t)")
    answer: Any = service.answer("run", {"key": key_of(text), "number": 3})
    assert answer["number"] == 3
    assert "t = 0.0" in answer["problems"][0]["text"]


ENDLESS = SPRING.replace("[0, 10]", "[0, 1e9]")


def test_a_run_has_a_time_limit(spring: Path) -> None:
    service = Service(spring, seconds=0.3)
    read: Any = service.answer("read", {"text": ENDLESS})
    answer: Any = service.answer("run", {"key": read["key"]})
    assert "more than 0.3 s of wall time" in answer["problems"][0]["text"]


def test_a_newer_run_of_the_same_page_ends_an_older_one(service: Service, key_of: KeyOf) -> None:
    request = {"key": key_of(ENDLESS), "tab": "a"}
    answers: list[Any] = []
    older = threading.Thread(
        target=lambda: answers.append(service.answer("run", request | {"number": 1}))
    )
    older.start()
    while not service._latest:
        time.sleep(0.01)
    short, _ = frame_in(
        service.answer("run", {"key": key_of(SPRING), "tab": "b", "number": 1})
    )  # another page does not end it
    assert older.is_alive() and short["number"] == 1
    newer = threading.Thread(target=lambda: service.answer("run", request | {"number": 2}))
    newer.start()
    older.join(4.0)
    assert answers == [{"superseded": True, "number": 1}]
    service.answer("run", {"key": key_of(SPRING), "tab": "a", "number": 3})
    newer.join(4.0)
    assert not newer.is_alive()


def test_mistakes_have_lines_and_are_drawn_in_red(service: Service) -> None:
    wrong = SPRING.replace("type: integrator, of: v", "type: integrater, of: v")
    read: Any = service.answer("read", {"text": wrong})
    (problem,) = read["problems"]
    assert problem["line"] == 11
    assert "Did you mean 'integrator'?" in problem["text"]
    assert not read["runs"]
    drawn: Any = service.answer("draw", {"key": read["key"]})
    assert 'class="block wrong"' in drawn["svg"]
    assert service.answer("run", {"key": read["key"]})["problems"]


def test_units_that_contradict_are_red_and_run_all_the_same(service: Service) -> None:
    text = SPRING.replace("of: a, unit: m/s}", "of: a, unit: N}")
    read: Any = service.answer("read", {"text": text})
    assert "needs a rate in" in read["problems"][0]["text"]
    assert read["runs"]
    assert 'class="block wrong"' in service.answer("draw", {"key": read["key"]})["svg"]
    assert isinstance(service.answer("run", {"key": read["key"]}), bytes)


def test_blocks_stay_where_they_are_while_one_types(service: Service, key_of: KeyOf) -> None:
    def picture(text: str, like: str = "") -> Any:
        key = key_of(text)
        return key, service.answer("draw", {"key": key, "like": like})["svg"]

    first, before = picture(SPRING)
    line = "  b: {type: gain, of: v, k: -c}\n"
    second, after = picture(SPRING.replace("presets:", f"{line}presets:"), first)
    assert 'data-block="b"' in after
    assert picture(SPRING, second) == (first, before)


def test_what_is_no_diagram_is_told(service: Service) -> None:
    read: Any = service.answer("read", {"text": "title: [\n"})
    assert read["problems"][0]["line"] == 2
    assert service.answer("draw", {"key": read["key"]})["problems"]
    assert service.answer("read", {"text": 5})["problems"]
    assert service.answer("bake", {})["problems"]


def test_values_go_into_the_text_in_its_units(service: Service, key_of: KeyOf) -> None:
    put: Any = service.answer("put", {"key": key_of(SPRING), "parameters": {"start": 0.05}})
    assert put["text"] == SPRING.replace("value: 100", "value: 50")


def test_the_file_is_written_when_it_is_saved_and_not_before(
    service: Service, spring: Path, key_of: KeyOf
) -> None:
    opened: Any = service.answer("open", {})
    other = SPRING.replace("value: 4", "value: 5")
    key_of(other)
    assert spring.read_text(encoding="utf-8") == SPRING
    saved: Any = service.answer("save", {"text": other, "digest": opened["digest"]})
    assert spring.read_text(encoding="utf-8") == other
    assert service.answer("state", {})["digest"] == saved["digest"]


def test_a_file_that_others_have_changed_is_not_written_over(
    service: Service, spring: Path
) -> None:
    opened: Any = service.answer("open", {})
    theirs, ours = SPRING + "# theirs\n", SPRING + "# ours\n"
    spring.write_text(theirs, encoding="utf-8")
    request = {"text": ours, "digest": opened["digest"]}
    answer: Any = service.answer("save", request)
    assert answer["conflict"]
    assert spring.read_text(encoding="utf-8") == theirs
    service.answer("save", request | {"over": True})
    assert spring.read_text(encoding="utf-8") == ours


def test_a_changed_file_that_the_diagram_names_is_noticed(service: Service, spring: Path) -> None:
    wheel = spring.with_name("wheel.yaml")
    wheel.write_text(
        "subsystems: {wheel: {outputs: {y: c}, blocks: {c: {type: constant, value: 1}}}}\n"
    )
    text = SPRING.replace("blocks:\n", "include: wheel.yaml\nblocks:\n  w: {type: wheel}\n")
    read: Any = service.answer("read", {"text": text})
    assert read["problems"] == []
    assert service.answer("state", {"key": read["key"]})["fresh"]
    os.utime(wheel, (1, 1))
    assert not service.answer("state", {"key": read["key"]})["fresh"]


def test_a_diagram_that_extends_another_one_has_its_sliders(service: Service, spring: Path) -> None:
    base = spring.with_name("base.yaml")
    base.write_text(SPRING, encoding="utf-8")
    read: Any = service.answer("read", {"text": f"extends: {base.name}\n"})
    assert [p["name"] for p in read["parameters"]] == ["k", "start", "twice", "force", "c"]
    assert {p["line"] for p in read["parameters"]} == {0}
    put: Any = service.answer("put", {"key": read["key"], "parameters": {"k": 4.0}})
    assert put["text"].startswith(
        f"extends: {base.name}\nparameters:\n  k: {{value: 4, unit: 1/s^2"
    )
    assert service.answer("state", {"key": read["key"]})["fresh"]
    os.utime(base, (1, 1))
    assert not service.answer("state", {"key": read["key"]})["fresh"]


def test_the_count_of_a_row_has_no_slider() -> None:
    text = "parameters: {n: 2, c: 1}\nblocks: {x: {type: constant, value: c, replicate: n}}"
    assert [s.name for s in sliders_of(compile(read_text(text)))] == ["c"]


def test_a_page_for_a_class_changes_nothing(spring: Path) -> None:
    service = Service(spring, present=True)
    assert service.answer("read", {"text": SPRING})["problems"] == []
    for action in ("read", "save"):
        answer: Any = service.answer(action, {"text": "blocks: {}\n", "over": True})
        assert "--present" in answer["problems"][0]["text"]
    assert spring.read_text(encoding="utf-8") == SPRING


def test_a_file_that_is_not_there_is_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(DiagramError, match="no file"):
        Service(tmp_path / "no.yaml")


def test_only_some_versions_are_kept(service: Service, key_of: KeyOf) -> None:
    keys = [key_of(f"{SPRING}# {n}\n") for n in range(VIEW.most_versions + 1)]
    assert "not kept" in service.answer("run", {"key": keys[0]})["problems"][0]["text"]
    frame_in(service.answer("run", {"key": keys[-1]}))


def test_a_slider_is_plain_data() -> None:
    (slider, *_) = sliders_of(compile(read_text(SPRING)))
    assert asdict(slider)["name"] == "k"
