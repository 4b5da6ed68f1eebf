"""What a browser is given that it must not trust, and a server that is not there any more."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from pathlib import Path

from tracewire.view import Service
from view.browsing import needs_browser, opened, opened_at
from view.conftest import SPRING, serving

from benchmarks.view.chromium import Chromium

pytestmark = needs_browser

BAD = "<img src=x onerror=alert(1)><script>window.bad = 1</script>"
ADDRESS = re.compile(r"http://127\.0\.0\.1:\d+/\S+/")


def test_text_of_a_diagram_stays_text(browser: Chromium, spring: Path) -> None:
    text = SPRING.replace("A mass on a spring", f"'{BAD}'").replace("stiff:", '"<b>stiff</b>":')
    spring.write_text(text, encoding="utf-8")
    with serving(Service(spring)) as server:
        browser.errors.clear()
        browser.open(server.address)
        browser.wait("document.title.startsWith('<img')")
        browser.wait("!!document.querySelector('#drawing svg')")
        assert browser.run("[window.bad, document.querySelectorAll('img').length]") == [None, 0]
        assert browser.errors == []


def test_text_of_a_data_file_stays_text(browser: Chromium, spring: Path) -> None:
    data = spring.with_name("data.csv")
    data.write_text(f't,"{BAD}"\n0,1\n1,2\n2,{BAD}\n', encoding="utf-8")
    series = f'"{BAD}": {{file: data.csv, time: t, signals: {{x: {{column: "{BAD}", sigma: 1}}}}}}'
    spring.write_text(f"{SPRING}measured:\n  {series}\n", encoding="utf-8")
    with serving(Service(spring)) as server:
        opened(browser, server)
        browser.run("choose('series', document.getElementById('series').options[1].value)")
        browser.wait("shows('failure')")
        assert "<script>" in browser.run("text('failure')")  # the cell that is no number
        data.write_text(f't,"{BAD}"\n0,1\n1,2\n2,3\n', encoding="utf-8")
        browser.wait("text('criterion').startsWith('Criterion of <img')")
        assert browser.run("[window.bad, document.querySelectorAll('img').length]") == [None, 0]
        assert browser.errors == []
        browser.open("about:blank")


def test_a_server_that_is_killed_is_told(browser: Chromium, spring: Path) -> None:
    command = [sys.executable, "-m", "tracewire", "view", str(spring), "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        try:
            address = next(found[0] for line in process.stdout if (found := ADDRESS.search(line)))
            opened_at(browser, address)
        finally:
            process.send_signal(signal.SIGKILL)
    browser.wait("shows('notice')", 10)
    assert "has ended" in browser.run("text('notice')")
    browser.run("set('p-k', 900)")
    browser.wait("shows('failure')")
    assert "tracewire view" in browser.run("text('failure')")
    browser.open("about:blank")
