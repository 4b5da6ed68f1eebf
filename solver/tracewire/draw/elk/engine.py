"""The layout engine: elkjs inside of QuickJS, started once in a process."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from threading import Lock, Thread, stack_size
from typing import Any

import quickjs

from tracewire.errors import InstallationError, Place

SCRIPT = Path(__file__).parent / "elk.bundled.js"
STACK = 64 * 2**20  # bytes: ELK walks along chains of blocks by recursion
THREAD_STACK = STACK + 4 * 2**20
MEMORY = 2**30  # bytes
LOCK = Lock()

# the script was made for a browser or Node: it wants their names, but its worker needs no threads
SURROUNDINGS = """
var self = globalThis;
var setTimeout = function (run) { run(); return 0; };
var clearTimeout = function () {};
var nothing = function () {};
var console = {log: nothing, info: nothing, warn: nothing, error: nothing, debug: nothing};
"""
CALL = """
var kernel = new ELK(), answer = null, failure = null;
function layOut(graph) {
  answer = failure = null;
  kernel.layout(JSON.parse(graph)).then(
    function (placed) { answer = JSON.stringify(placed); },
    function (error) { failure = String(error); }
  );
}
"""


@cache
def _context() -> Any:
    """The engine, which takes a quarter of a second to start."""
    try:
        script = SCRIPT.read_text(encoding="utf-8")
    except OSError as error:
        what = f"the layout engine cannot be read: {error.strerror or error}"
        hint = "Install tracewire again; in a checkout 'python -m tracewire.draw.elk' fetches it."
        raise InstallationError.one(what, Place(str(SCRIPT)), hint=hint) from None
    context = quickjs.Context()
    context.set_max_stack_size(STACK)
    context.set_memory_limit(MEMORY)
    context.eval(SURROUNDINGS)
    context.eval(script)
    context.eval(CALL)
    return context


def lay_out(graph: dict[str, Any]) -> dict[str, Any]:
    """The graph in ELK's JSON with coordinates. Raises RuntimeError where ELK cannot lay it out."""
    answers: list[str | Exception] = []
    with LOCK:
        before = stack_size(THREAD_STACK)  # that of the main thread is too small for a long chain
        try:
            worker = Thread(target=_work, args=(json.dumps(graph), answers), daemon=True)
            worker.start()
        finally:
            stack_size(before)
        try:
            worker.join()
        except BaseException:
            _context.cache_clear()  # that of the thread, which goes on, is not used again
            raise
    (answer,) = answers
    if isinstance(answer, Exception):
        raise answer
    placed: dict[str, Any] = json.loads(answer)
    return placed


def _work(graph: str, answers: list[str | Exception]) -> None:
    try:
        context = _context()
        context.get("layOut")(graph)
        while context.execute_pending_job():
            pass
        answer = context.get("answer")
        answers.append(answer if answer else RuntimeError(str(context.get("failure"))))
    except Exception as error:  # it is raised again where the answer is awaited
        answers.append(error)
