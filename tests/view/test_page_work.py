"""Fits and traces from the page: begun, followed, accepted or refused, saved, reported."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from tracewire.view import Service
from view.browsing import needs_browser, opened
from view.conftest import serving

from benchmarks.view.chromium import Chromium

pytestmark = needs_browser

LESSONS = Path(__file__).parents[2] / "diagrams" / "lessons"
SOURCE = "document.getElementById('source').value"
BLOCKS = "[...document.querySelectorAll('#drawing .block.effect')].map((one) => one.dataset.block)"
OWN_CURVES = "text('criterion').startsWith('Criterion of swing: 135')"
CRITERION = "Number(text('criterion').split(' ')[3].replace(';', ''))"
SHIFT = 0.05  # rad


@pytest.fixture
def lesson(tmp_path: Path) -> Path:
    """The pendulum with its two records, in a folder of its own."""
    for file in LESSONS.glob("pendulum*"):
        shutil.copy(file, tmp_path)
    return tmp_path / "pendulum.yaml"


@pytest.fixture
def page(browser: Chromium, lesson: Path) -> Iterator[Chromium]:
    """The page of the pendulum, which has no error in the end."""
    with serving(Service(lesson)) as server:
        opened(browser, server)
        yield browser
        browser.open("about:blank")
    assert browser.errors == []


def test_a_fit_is_proposed_and_taken_by_a_click(page: Chromium, lesson: Path) -> None:
    before = lesson.read_text(encoding="utf-8")
    page.run("choose('series', 'swing')")
    page.wait(OWN_CURVES)
    assert page.run("text('criterion')").endswith("theta 0.1644 rad")
    disabled = "document.getElementById('p-theta.start').disabled"
    assert page.run(disabled)  # the series begins as its data tell
    page.run("choose('series', '')")
    page.wait(f"!{disabled}")
    page.run("choose('series', 'swing')")
    page.wait(OWN_CURVES)
    assert page.run("document.querySelectorAll('.uplot').length") == 3
    page.run("document.getElementById('fit').click()")
    page.wait("shows('proposal')")
    assert "converged" in page.run("text('proposal-words')")
    assert not page.run("shows('effects')")
    page.wait(f"!{OWN_CURVES}")  # the curves are those of the proposal, until one looks away
    page.run("document.getElementById('preview').click()")
    page.wait(OWN_CURVES)
    page.run("document.getElementById('preview').click()")
    page.wait(f"!{OWN_CURVES}")
    proposed = page.run(CRITERION)
    assert proposed < 50
    page.run("document.getElementById('accept').click()")
    page.wait("!shows('proposal')")
    page.wait(f"{CRITERION} === {proposed}")  # the text brings what was seen before
    assert page.run("text('criterion')").startswith("Criterion of swing: ")
    assert page.run("text('saved')") == "not saved"
    assert lesson.read_text(encoding="utf-8") == before


def test_a_slider_shows_its_own_run_beside_a_proposal(page: Chromium) -> None:
    page.run("choose('series', 'swing')")
    page.wait(OWN_CURVES)
    page.run("document.getElementById('fit').click()")
    page.wait("shows('proposal')")
    page.wait(f"!{OWN_CURVES}")
    page.run("set('p-w0_squared', 999)")
    page.wait(f"{CRITERION} > 300000")
    assert not page.run("document.getElementById('preview').checked")
    assert page.run("shows('proposal')")
    page.run("document.getElementById('refuse').click()")
    assert not page.run("shows('proposal')")


def shift_record(file: Path) -> None:
    """Add to each sample of a record what the sensor of a second effect would."""
    lines = file.read_text(encoding="utf-8").splitlines()
    for n, line in enumerate(lines):
        t, _, theta = line.partition(",")
        if t.replace(".", "").isdigit():
            lines[n] = f"{t},{float(theta) + SHIFT:.6f}"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


@pytest.mark.slow
def test_effects_of_a_trace_are_accepted_one_by_one(page: Chromium, lesson: Path) -> None:
    shift_record(lesson.with_name("pendulum_swing.csv"))
    before = lesson.read_text(encoding="utf-8")
    page.run("document.getElementById('trace').click()")
    page.wait("text('progress').includes('trace, ')")
    page.wait("shows('proposal')", 300)
    names = page.run("[...document.querySelectorAll('#effects input')].map((one) => one.value)")
    assert set(names) == {"sensor_offset @ sensor.theta", "coulomb @ acceleration"}
    assert "level = 0.1" in page.run("text('effects')")
    assert page.run("text('proposal-words').startsWith('The diagram lacks')")
    assert page.run("document.querySelectorAll('#proposal-words p').length") > 3
    assert sorted(page.run(BLOCKS)) == ["coulomb", "sensor of theta"]
    page.run("document.querySelector('#drawing [data-type=sensor]').dispatchEvent("
             "new MouseEvent('dblclick', {bubbles: true}))")  # fmt: skip
    at = page.run("document.getElementById('source').selectionStart")
    assert "theta: {column: theta" in page.run(SOURCE)[at:].splitlines()[0]

    tick = "document.querySelector('#effects input[value^={}]').click()"
    page.run(tick.format("coulomb"))
    page.wait(f"{BLOCKS}.join() === 'sensor of theta'")
    assert "fit again" in page.run("text('chosen')")
    page.run(tick.format("sensor"))
    page.wait("document.getElementById('accept').disabled && !text('chosen')")
    page.run(tick.format("coulomb"))
    page.wait(f"{BLOCKS}.join() === 'coulomb' && !document.getElementById('accept').disabled")
    page.run("choose('series', 'swing')")
    page.wait("text('criterion')")
    proposed = page.run(CRITERION)
    page.run("document.getElementById('accept').click()")
    page.wait(f"{SOURCE}.includes('type: coulomb, rate: omega') && !shows('proposal')")
    page.wait(f"{CRITERION} === {proposed}")
    assert "offset:" not in page.run(SOURCE)
    assert lesson.read_text(encoding="utf-8") == before
    page.run("document.getElementById('save').click()")
    page.wait("text('saved') === 'saved'")
    assert "{type: coulomb, rate: omega, level:" in lesson.read_text(encoding="utf-8")


def test_a_proposal_keeps_the_rules_of_axe(page: Chromium) -> None:
    axe = pytest.importorskip("axe_core_python")
    page.run("document.getElementById('fit').click()")
    page.wait("shows('proposal')")
    page.run("document.getElementById('proposal-words').style.maxHeight = '2rem'")  # it scrolls
    page.run("document.getElementById('enlarge').click()")
    page.run((Path(axe.__file__).parent / "axe.min.js").read_text(encoding="utf-8"))
    rules = page.run("axe.run().then((all) => all.violations.map((rule) => rule.id))")
    assert rules == []


def test_the_report_of_a_fit_opens_beside_the_page(page: Chromium) -> None:
    page.run("document.getElementById('fit').click()")
    page.wait("shows('proposal')")
    link = "document.getElementById('report')"
    assert page.run(f"[{link}.target, {link}.rel]") == ["_blank", "noopener"]
    address, own = page.run(f"{link}.href"), page.page
    page.new_page()
    try:
        page.open(address)
        page.wait("document.querySelectorAll('.uplot').length > 0")  # its script may run
        assert page.run("document.querySelector('img').naturalWidth") > 100
        assert page.run("getComputedStyle(document.querySelector('table')).borderCollapse") == (
            "collapse"
        )
        asked = "fetch('state', {method: 'POST'}).then(() => 'answered', () => 'refused')"
        assert page.run(asked) == "refused"
    finally:
        page.errors.clear()  # of that request
        page.page = own
