"""`python -m benchmarks view`: the time from a slider to the painted curve, in a real browser."""

from __future__ import annotations

import argparse
import platform
import threading
from pathlib import Path

import numpy as np
from tracewire.view import Service, open_server

from benchmarks.view.chromium import BROWSER, Chromium

ROOT = Path(__file__).parents[2]
DIAGRAMS = (
    "diagrams/lessons/pendulum.yaml",
    "diagrams/lessons/cart.yaml",
    "diagrams/papers/a_torsion/pendulum.yaml",
    "diagrams/papers/b_triple/pendulum.yaml",
)
# a slider is moved, and the clock stops in the frame after the one in which its run was painted
DRAG = """
(async (count) => {
  const slider = document.querySelector("#sliders input[type=range]:not([hidden])");
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const times = [];
  for (let n = 0; n < count; n++) {
    await frame();
    const before = document.body.dataset.shown;
    const began = performance.now();
    slider.value = 450 + (n * 37) % 100;
    slider.dispatchEvent(new Event("input", {bubbles: true}));
    while (document.body.dataset.shown === before) await new Promise((done) => setTimeout(done, 0));
    await frame();
    await frame();
    times.push(performance.now() - began);
  }
  return times;
})(COUNT)
"""


def measured(diagram: Path, count: int) -> list[float]:
    """The times in ms of so many moves of the first slider of a page."""
    server = open_server(Service(diagram))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with Chromium() as browser:
            browser.open(server.address)
            browser.wait("document.body && document.body.dataset.shown")
            browser.wait("!!document.querySelector('#drawing svg')")
            browser.run(DRAG.replace("COUNT", "10"))  # until all is compiled, there and here
            times: list[float] = browser.run(DRAG.replace("COUNT", str(count)))
            if browser.errors:
                raise RuntimeError("; ".join(browser.errors))
            return times
    finally:
        server.shutdown()
        server.server_close()


def main(arguments: list[str]) -> int:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks view", description=__doc__)
    parser.add_argument("diagram", nargs="*", help="diagram files; four shipped ones unless given")
    parser.add_argument("--count", type=int, default=100, help="moves of the slider; default 100")
    given = parser.parse_args(arguments)
    if not BROWSER:
        print("no Chromium here; on Debian: apt-get install chromium")
        return 1
    print(f"{platform.machine()}, Python {platform.python_version()}; ms from slider to painted")
    print(f"{'diagram':42} {'median':>7} {'95 %':>7} {'worst':>7}")
    for name in given.diagram or DIAGRAMS:
        times = np.array(measured(ROOT / name, given.count))
        numbers = (np.median(times), np.quantile(times, 0.95), times.max())
        print(f"{name:42} " + " ".join(f"{number:7.1f}" for number in numbers))
    return 0
