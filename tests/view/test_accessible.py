"""The live page for everyone: names for a screen reader, contrast, the keyboard, a phone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tracewire.view import Service
from view.browsing import needs_browser
from view.conftest import serving

from benchmarks.view.chromium import Chromium

pytestmark = needs_browser

NEED_NAMES = {"button", "slider", "textbox", "combobox", "spinbutton", "searchbox", "image", "img"}
# the ratio of each text to what is behind it, by WCAG 2: 4.5 is asked for
CONTRAST = """
(() => {
  const numbers = (text) => text.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((v) => v / 255)
    .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
    .reduce((sum, v, n) => sum + v * [0.2126, 0.7152, 0.0722][n], 0);
  const behind = (one) => {
    for (; one; one = one.parentElement) {
      const color = numbers(getComputedStyle(one).backgroundColor);
      if (color.length < 4 || color[3] > 0.8) return color;
    }
    return [255, 255, 255];
  };
  const found = [];
  for (const one of document.querySelectorAll("body *:not(svg *)")) {
    const own = [...one.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
    if (!own || !one.checkVisibility() || one.closest("svg, option")) continue;
    const [a, b] = [light(numbers(getComputedStyle(one).color)), light(behind(one))];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) found.push([one.id || one.className, one.textContent.trim(), ratio]);
  }
  return found;
})()
"""


@pytest.fixture(params=[False, True], ids=["edit", "present"])
def page(browser: Chromium, spring: Path, request: pytest.FixtureRequest) -> Iterator[Chromium]:
    with serving(Service(spring, present=request.param)) as server:
        browser.resize(1280, 900)
        browser.open(server.address)
        browser.wait("document.body && document.body.dataset.shown === '1'")
        browser.wait("!!document.querySelector('#drawing svg')")
        yield browser
        browser.open("about:blank")
        browser.wait("location.href === 'about:blank'")


def test_each_control_and_picture_has_a_name(page: Chromium) -> None:
    page.send("Accessibility.enable")
    nodes = page.send("Accessibility.getFullAXTree")["nodes"]
    seen = [n for n in nodes if not n["ignored"] and n["role"]["value"] in NEED_NAMES]
    assert len(seen) > 15
    assert [n for n in seen if not n.get("name", {}).get("value")] == []


def test_the_rules_of_axe_are_kept(page: Chromium) -> None:
    axe = pytest.importorskip("axe_core_python")
    page.run((Path(axe.__file__).parent / "axe.min.js").read_text(encoding="utf-8"))
    found: Any = page.run("axe.run().then((all) => [all.violations, all.passes.length])")
    broken = [(rule["id"], [node["html"] for node in rule["nodes"]]) for rule in found[0]]
    assert broken == []
    assert found[1] > 20


def test_headings_regions_and_the_language_are_there(page: Chromium) -> None:
    assert page.run("document.documentElement.lang") == "en"
    assert page.run("document.querySelectorAll('h1').length") == 1
    assert page.run("document.querySelectorAll('section:not([aria-labelledby])').length") == 0
    ids: Any = page.run("[...document.querySelectorAll('[id]')].map(one => one.id)")
    assert len(set(ids)) == len(ids)
    named: Any = page.run(
        "[...document.querySelectorAll('section')].map(s => s.getAttribute('aria-labelledby'))"
    )
    assert set(named) <= set(ids)


def test_texts_can_be_told_from_what_is_behind_them(page: Chromium) -> None:
    assert page.run(CONTRAST) == []


def test_parameters_are_moved_by_keyboard(page: Chromium) -> None:
    page.key("Tab", 9)  # to the way past all else
    assert page.run("document.activeElement.className") == "skip"
    page.key("Enter", 13, "\r")
    for _ in range(6):
        page.key("Tab", 9)
        if page.run("document.activeElement.id") == "p-k":
            break
    before = page.run("+document.activeElement.value")
    page.key("ArrowRight", 39)
    page.wait("document.body.dataset.shown === '2'")
    assert page.run("+document.getElementById('p-k').value") == before + 1
    text = page.run("document.getElementById('p-k').getAttribute('aria-valuetext')")
    assert text.endswith(" 1/s^2")


def test_what_has_the_focus_is_seen(page: Chromium) -> None:
    page.key("Tab", 9)
    style: Any = page.run("getComputedStyle(document.activeElement).outlineStyle")
    assert style == "solid"


def test_a_phone_shows_curves_and_sliders_together(page: Chromium) -> None:
    page.resize(390, 800, mobile=True)
    page.wait("innerWidth === 390")
    assert page.run("document.documentElement.scrollWidth") == 390
    tops = "['plots', 'p-k'].map(id => document.getElementById(id).getBoundingClientRect().top)"
    plots, slider = page.run(tops)
    assert 0 < plots < slider < 800


def test_a_page_for_a_class_is_large_and_has_no_text(browser: Chromium, spring: Path) -> None:
    with serving(Service(spring, present=True)) as server:
        browser.resize(1280, 900)
        browser.open(server.address)
        browser.wait("document.body && document.body.dataset.shown === '1'")
        for name in ("text", "work"):
            assert not browser.run(f"document.getElementById('{name}').checkVisibility()")
        size = "parseFloat(getComputedStyle(document.querySelector('label')).fontSize)"
        assert browser.run(size) >= 18
        browser.open("about:blank")
