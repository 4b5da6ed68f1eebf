"""How tests open the live page in a browser without a window."""

from __future__ import annotations

import pytest
from tracewire.view.server import PageServer

from benchmarks.view.chromium import BROWSER, Chromium

needs_browser = pytest.mark.skipif(not BROWSER, reason="no Chromium here")
LAST = "document.body.dataset.shown"
HELPERS = """
window.set = (id, value) => {
  const one = document.getElementById(id);
  one.value = value;
  one.dispatchEvent(new Event("input", {bubbles: true}));
};
window.choose = (id, value) => {
  document.getElementById(id).value = value;
  document.getElementById(id).dispatchEvent(new Event("change"));
};
window.text = (id) => document.getElementById(id).textContent;
window.shows = (id) => {
  const one = document.getElementById(id);
  return one.checkVisibility({visibilityProperty: true});
};
window.painted = () =>
  [...document.querySelectorAll("#plots canvas")].map((one) => one.toDataURL()).join();
"""


def opened(browser: Chromium, server: PageServer) -> None:
    """Open the page of a server, and wait for its first run."""
    opened_at(browser, server.address)


def opened_at(browser: Chromium, address: str) -> None:
    """Open the page at an address, and wait for its first run."""
    browser.open("about:blank")
    browser.wait("location.href === 'about:blank'")
    browser.errors.clear()
    browser.open(address)
    browser.wait(f"document.body && {LAST} === '1'")
    browser.run(HELPERS)
