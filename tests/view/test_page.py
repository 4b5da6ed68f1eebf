"""The live page in a browser without a window: what a user does there, and sees."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from tracewire.view import Service
from tracewire.view.server import PageServer
from view.browsing import LAST, needs_browser, opened
from view.conftest import SPRING, serving

from benchmarks.view.chromium import Chromium

pytestmark = needs_browser

ROOT = Path(__file__).parents[2]


@pytest.fixture
def server(spring: Path) -> Iterator[PageServer]:
    with serving(Service(spring, seconds=1.0)) as running:
        yield running


@pytest.fixture
def page(browser: Chromium, server: PageServer) -> Iterator[Chromium]:
    """A page of the spring that has shown its first run, and that has no error in the end."""
    opened(browser, server)
    yield browser
    browser.open("about:blank")  # before its server ends
    assert browser.errors == []


def test_the_page_shows_the_diagram_its_parameters_and_a_run(page: Chromium) -> None:
    assert page.run("document.title") == "A mass on a spring"
    names = page.run("[...document.querySelectorAll('#sliders label')].map(l => l.textContent)")
    assert names == ["k", "start", "twice", "force", "c"]
    assert page.run("document.querySelectorAll('.uplot').length") == 2
    assert page.run("document.getElementById('source').value") == SPRING
    page.wait("!!document.querySelector('#drawing svg [data-block=a]')")
    outline = "document.querySelector('#drawing .wire path')"
    assert page.run(f"getComputedStyle({outline}).fill") == "none"  # its style sheet is allowed
    assert page.run("shows('stage')")


def test_the_picture_is_enlarged_by_a_click(page: Chromium) -> None:
    page.wait("!!document.querySelector('#drawing svg')")
    wide = "document.querySelector('#drawing').clientWidth"
    before = page.run(wide)
    page.run("document.getElementById('enlarge').click()")
    assert page.run(wide) > 2 * before
    picture = "document.querySelector('#drawing svg')"
    own = page.run(f"+{picture}.getAttribute('width')")  # a small one grows, up to 1.8 times
    assert page.run(f"{picture}.getBoundingClientRect().width") == pytest.approx(
        1.8 * own, rel=0.01
    )
    page.resize(640, 900)  # where it has no room it is not made smaller than it is
    page.wait("document.documentElement.clientWidth === 640")
    assert page.run(f"{picture}.getBoundingClientRect().width") >= own
    page.resize(*page.size)
    page.wait(f"document.documentElement.clientWidth === {page.size[0]}")
    assert page.run("document.getElementById('enlarge').getAttribute('aria-pressed')") == "true"
    page.run("document.getElementById('enlarge').click()")
    assert page.run(wide) == before


def test_a_block_that_one_types_leaves_the_others_where_they_are(page: Chromium) -> None:
    page.wait("!!document.querySelector('#drawing [data-block=a]')")
    tops = (
        "['x', 'v', 'a'].map((name) => document.querySelector(`#drawing [data-block=${name}]`)"
        ".getBoundingClientRect().left)"
    )
    before = page.run(tops)
    text = SPRING.replace("presets:", "  b: {type: gain, of: v, k: -c}\npresets:")
    page.run(f"set('source', {text!r})")
    page.wait("!!document.querySelector('#drawing [data-block=b]')")
    assert sorted(before) == [before[n] for n in sorted(range(3), key=page.run(tops).__getitem__)]
    page.run("document.querySelector('#drawing [data-block=b]').dispatchEvent("
             "new MouseEvent('dblclick', {bubbles: true}))")  # fmt: skip
    at = page.run("document.getElementById('source').selectionStart")
    assert text[at:].startswith("  b: {type: gain") or text[at:].startswith("b: {type: gain")


def test_what_one_sees_is_saved_as_a_figure_a_script_and_a_diagram(page: Chromium) -> None:
    page.run("set('p-k', 0)")
    page.wait("document.getElementById('p-k').value === '0'")
    page.run(
        "window.saved = []; URL.createObjectURL = (blob) => {"
        " blob.text().then((text) => window.saved.push(text)); return 'data:,'; }"
    )
    for count, kind in enumerate(("figure", "script", "diagram"), start=1):
        page.run(f"document.querySelector('#exports [data-kind={kind}]').click()")
        page.wait(f"window.saved.length === {count}")
    figure, script, diagram = page.run("window.saved")
    assert "<svg" in figure and "</svg>" in figure
    assert "tw.simulate(" in script and "'k': 1.0" in script
    assert "k: {value: 1, unit: 1/s^2, fit: [1, 9]}" in diagram


def test_a_slider_moves_the_curve(page: Chromium) -> None:
    page.run("window.before = painted()")
    page.run("set('p-k', 900)")
    page.wait(f"{LAST} === '2'")
    assert page.run("painted() !== before")
    field = "document.querySelector('#sliders input[type=number]')"
    assert page.run(f"{field}.value") == "8.2"
    follows = "document.querySelectorAll('#sliders input[type=number]')[2].value"
    assert page.run(follows) == "16.4"
    page.run("document.getElementById('reset').click()")
    page.wait(f"{LAST} === '3'")
    page.wait("painted() === before")  # as wide, too, once the drag has paused


def test_only_the_newest_of_many_wishes_is_run(page: Chromium) -> None:
    page.run("for (let n = 0; n <= 50; n++) set('p-k', 500 + n)")
    page.wait("document.querySelector('#sliders input[type=number]').value === '5.4'")
    page.wait(f"+{LAST} >= 2")
    time.sleep(0.5)
    assert int(page.run(LAST)) <= 4  # not fifty


def test_of_a_thousand_moves_the_last_one_is_shown(page: Chromium) -> None:
    page.run("""(async () => {
      for (let n = 0; n < 1000; n++) {
        set("p-k", (n * 37) % 1001);
        if (n % 5 === 0) await new Promise((done) => setTimeout(done));
      }
      set("p-k", 100);
    })()""")
    page.wait("!document.getElementById('status').textContent.startsWith('simulating')")
    page.wait("document.querySelector('#sliders input[type=number]').value === '1.8'")
    time.sleep(0.5)
    before, shown = page.run("painted()"), int(page.run(LAST))
    page.run("set('p-k', 100)")  # alone: the curve of that value
    page.wait(f"+{LAST} === {shown + 1}")
    assert page.run("painted()") == before


@pytest.mark.slow
def test_a_diagram_of_three_hundred_blocks_is_shown_and_follows(
    browser: Chromium, tmp_path: Path
) -> None:
    masses = range(100)
    lines = "".join(
        f"  x{n}: {{type: integrator, of: v{n}, start: {n % 7}}}\n"
        f"  v{n}: {{type: integrator, of: a{n}}}\n"
        f"  a{n}: {{type: expression, formula: -k*(x{n} - x{(n + 1) % 100})}}\n"
        for n in masses
    )
    file = tmp_path / "chain.yaml"
    file.write_text(f"span: [0, 2]\nrecord: [x0, x99]\nparameters: {{k: 5}}\nblocks:\n{lines}")
    with serving(Service(file)) as server:
        opened(browser, server)
        browser.wait("document.querySelectorAll('#drawing [data-block]').length >= 300")
        before = browser.run("painted()")
        browser.run("set('p-k', 900)")
        browser.wait(f"{LAST} === '2'")
        assert browser.run("painted()") != before
        browser.open("about:blank")
    assert browser.errors == []


def test_a_run_that_fails_hides_the_old_curves(page: Chromium) -> None:
    page.run(
        "set('source', document.getElementById('source').value.replace('-k*x', '-k/(x - 5*t)'))"
    )
    page.wait("shows('failure')")
    assert "t = 0.0" in page.run("text('failure')")
    assert not page.run("shows('plots')")
    assert not page.run("shows('stage')")
    page.run(f"set('source', {SPRING!r})")
    page.wait("shows('plots') && !shows('failure')")


def test_a_mistake_is_told_at_its_line_while_one_types(page: Chromium) -> None:
    page.run("set('source', document.getElementById('source').value.replace('of: v', 'off: v'))")
    page.wait("document.querySelectorAll('#problems li').length > 0")
    wrong = page.run("[...document.querySelectorAll('#gutter .wrong')].map(l => l.textContent)")
    assert wrong == ["11"]
    assert "line 11:" in page.run("text('problems')")
    assert not page.run("shows('plots')")
    page.run("document.querySelector('#problems button').click()")
    caret = page.run("document.getElementById('source').selectionStart")
    assert SPRING[:caret].count("\n") == 10
    page.run(f"set('source', {SPRING!r})")
    page.wait("shows('plots')")
    assert page.run("document.querySelectorAll('#problems li, #gutter .wrong').length") == 0


def test_saving_writes_the_file_and_says_so(page: Chromium, spring: Path) -> None:
    assert page.run("text('saved')") == "saved"
    page.run("set('p-k', 0)")
    page.run("document.getElementById('put').click()")
    page.wait("document.getElementById('source').value.includes('value: 1, unit: 1/s^2')")
    assert page.run("text('saved')") == "not saved"
    assert spring.read_text(encoding="utf-8") == SPRING
    page.run("document.getElementById('save').click()")
    page.wait("text('saved') === 'saved'")
    assert "k: {value: 1, unit: 1/s^2" in spring.read_text(encoding="utf-8")


def test_a_change_by_another_editor_shows_at_once(page: Chromium, spring: Path) -> None:
    spring.write_text(SPRING.replace("A mass", "A heavy mass"), encoding="utf-8")
    page.wait("document.title === 'A heavy mass on a spring'", 10)
    assert not page.run("shows('notice')")


def test_a_change_on_both_sides_is_told_and_nothing_is_lost(page: Chromium, spring: Path) -> None:
    page.run("set('source', document.getElementById('source').value + '# here\\n')")
    theirs = SPRING + "# there\n"
    spring.write_text(theirs, encoding="utf-8")
    page.wait("shows('notice')", 10)
    assert "another program" in page.run("text('notice')")
    assert page.run("document.getElementById('source').value.endsWith('# here\\n')")
    page.run("document.getElementById('save').click()")
    time.sleep(0.7)  # a look at the file, too
    assert page.run("shows('notice')")
    assert spring.read_text(encoding="utf-8") == theirs
    page.run("document.querySelector('#notice button').click()")
    page.wait("document.getElementById('source').value.endsWith('# there\\n')")


def test_a_file_that_goes_and_comes_back_is_told(page: Chromium, spring: Path) -> None:
    spring.unlink()
    page.wait("shows('notice')", 10)
    assert "spring.yaml" in page.run("text('notice')")
    spring.write_text(SPRING, encoding="utf-8")
    page.wait("!shows('notice')", 10)


def test_the_mechanism_is_played(page: Chromium) -> None:
    still = page.run("document.getElementById('stage').toDataURL()")
    page.run("document.getElementById('play').click()")
    page.wait("+document.getElementById('time').value > 20")
    page.run("document.getElementById('play').click()")
    assert page.run("document.getElementById('stage').toDataURL()") != still
    assert re.match(r"t = [\d.]+ s", page.run("text('clock')"))


def test_two_pages_do_not_disturb_each_other(
    browser: Chromium, server: PageServer, page: Chromium
) -> None:
    first = page.page
    page.run("set('p-k', 900)")
    page.wait(f"{LAST} === '2'")
    browser.new_page()
    opened(browser, server)
    browser.run("set('p-k', 100)")
    browser.wait(f"{LAST} === '2'")
    fields = "document.querySelector('#sliders input[type=number]').value"
    assert browser.run(fields) == "1.8"
    browser.page = first
    assert browser.run(fields) == "8.2"


TYPE = """
(words) => {
  const area = document.getElementById("source");
  area.focus();
  document.execCommand("insertText", false, words);
}
"""
PRESS = """
(key, ctrlKey = false) => document.getElementById("source").dispatchEvent(
  new KeyboardEvent("keydown", {key, ctrlKey, bubbles: true, cancelable: true}))
"""
OPEN = "!document.getElementById('completion').hidden"
ROWS = "[...document.querySelectorAll('#completion b')].map((one) => one.textContent)"


def cursor_behind(page: Chromium, words: str) -> None:
    page.run(f"""
        (() => {{
          const area = document.getElementById("source");
          const at = area.value.indexOf({words!r}) + {len(words)};
          area.focus();
          area.setSelectionRange(at, at);
        }})()""")


def test_a_word_in_the_text_is_completed(page: Chromium) -> None:
    cursor_behind(page, "start: start, unit: m}")
    page.run(f"({TYPE})('\\n  b: {{type: integr')")
    page.wait(OPEN)
    assert page.run(ROWS)[0] == "integrator"
    area = "document.getElementById('source')"
    assert page.run(f"{area}.getAttribute('aria-activedescendant')") == "proposal-0"
    page.run(f"({PRESS})('Enter')")
    assert "  b: {type: integrator\n" in page.run(f"{area}.value")
    assert not page.run(OPEN)
    page.run(f"({TYPE})(', ')")
    page.wait(OPEN)
    assert page.run(ROWS)[:2] == ["of", "start"]
    assert page.run(f"({PRESS})('Enter')") is True  # nothing is chosen yet: a new line
    page.run(f"({PRESS})('Escape')")
    page.run(f"({PRESS})(' ', true)")
    page.wait(f"{OPEN} && {ROWS}[0] === 'of'")
    page.run(f"({PRESS})('ArrowDown')")
    page.run(f"({PRESS})('ArrowUp')")
    page.run(f"({PRESS})('Tab')")
    page.run(f"({TYPE})('v')")
    page.wait("document.getElementById('problems').children.length > 0")
    page.run(f"({PRESS})('Escape')")
    page.run(f"({TYPE})('}}')")
    page.wait("document.getElementById('problems').children.length === 0")
    assert "  b: {type: integrator, of: v}\n" in page.run(f"{area}.value")
    page.run("document.execCommand('undo')")
    assert "of: v}\n  v:" not in page.run(f"{area}.value")


def test_the_list_of_words_closes(page: Chromium) -> None:
    cursor_behind(page, "record: [x, v")
    page.run(f"({TYPE})(', ')")
    page.wait(OPEN)
    page.run(f"({PRESS})('Escape')")
    assert not page.run(OPEN)
    page.run(f"({PRESS})(' ', true)")
    page.wait(OPEN)
    page.run("document.getElementById('source').dispatchEvent(new Event('blur'))")
    assert not page.run(OPEN)
    cursor_behind(page, "title: A mass")
    page.run(f"({PRESS})(' ', true)")
    page.run(f"({TYPE})(' x')")
    time.sleep(0.3)
    assert not page.run(OPEN)
