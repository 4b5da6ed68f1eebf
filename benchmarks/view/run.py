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
# drawn: all curves and the scene are on their canvases; painted: the browser has shown that frame
DRAG = """
(async (count) => {
  const slider = document.querySelector("#sliders input[type=range]:not([hidden])");
  const frame = () => new Promise((done) => requestAnimationFrame(done));
  const shown = () => new Promise((done) => {  // a timer would add the 4 ms of its clock
    const observer = new MutationObserver(() => { observer.disconnect(); done(); });
    observer.observe(document.body, {attributeFilter: ["data-shown"]});
  });
  const times = [];
  for (let n = 0; n < count; n++) {
    await frame();
    const next = shown();
    const began = performance.now();
    slider.value = 450 + (n * 37) % 100;
    slider.dispatchEvent(new Event("input", {bubbles: true}));
    await next;
    const drawn = performance.now() - began;
    await frame();
    await frame();
    times.push([drawn, performance.now() - began]);
  }
  return times;
})(COUNT)
"""


def measured(diagram: Path, count: int) -> list[list[float]]:
    """The times in ms, drawn and painted, of so many moves of the first slider of a page."""
    server = open_server(Service(diagram))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with Chromium() as browser:
            browser.open(server.address)
            browser.wait("document.body && document.body.dataset.shown")
            browser.wait("!!document.querySelector('#drawing svg')")
            browser.run(DRAG.replace("COUNT", "10"))  # until all is compiled, there and here
            times: list[list[float]] = browser.run(DRAG.replace("COUNT", str(count)))
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
    print(f"{platform.machine()}, Python {platform.python_version()}; ms from the move of a slider")
    print(f"{'':42} {'drawn':>23} {'painted':>23}")
    print(f"{'':42}" + f" {'median':>7} {'95 %':>7} {'worst':>7}" * 2)
    for name in given.diagram or DIAGRAMS:
        times = np.array(measured(ROOT / name, given.count))
        ends = (np.median(times, axis=0), np.quantile(times, 0.95, axis=0), times.max(axis=0))
        numbers = np.array(ends).T.ravel()
        print(f"{name:42} " + " ".join(f"{number:7.1f}" for number in numbers))
    return 0
