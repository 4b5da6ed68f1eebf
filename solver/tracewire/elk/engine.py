"""The layout engine: elkjs inside of QuickJS, started once in a process."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from threading import Lock, Thread, stack_size
from typing import Any

import quickjs

from tracewire.errors import InstallationError, Location

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

QUICKER = {
    "function Bhb(a){var b,c;b=0;for(c=0;c<a.length;c++)"
    "{b=(b<<5)-b+(yFb(c,a.length),a.charCodeAt(c))|0}return b}": (
        "var hashes=new Map;function Bhb(a){var b=hashes.get(a);if(b===undefined)"
        "{b=0;for(var c=0;c<a.length;c++){b=(b<<5)-b+a.charCodeAt(c)|0}hashes.set(a,b)}return b}"
    ),
    "function FD(a,b){zFb(a==null||ED(a,b));return a}": "function FD(a,b){return a}",
}
"""What stands for a function of the script when it is loaded; the layouts stay the same.

ELK's authors compile it from Java. It computes the hash of a text each time anew, where Java keeps
it, and asks at each cast whether an object is of its class. Both took 30 % of the time.
"""


@cache
def _context() -> Any:
    """The engine, which takes a sixth of a second to start."""
    try:
        script = SCRIPT.read_text(encoding="utf-8")
    except OSError as error:
        what = f"the layout engine cannot be read: {error.strerror or error}"
        hint = "Install tracewire again; in a checkout 'python -m tracewire.elk' fetches it."
        raise InstallationError.one(what, Location(str(SCRIPT)), hint=hint) from None
    for slow, quick in QUICKER.items():
        script = script.replace(slow, quick)
    context = quickjs.Context()
    context.set_max_stack_size(STACK)
    context.set_memory_limit(MEMORY)
    context.eval(SURROUNDINGS)
    context.eval(script)
    context.eval(CALL)
    return context


def start() -> None:
    """Let the engine start in a thread, while the caller goes on. What fails is told later."""
    with LOCK:
        _started(_begin)


def lay_out(graph: dict[str, Any]) -> dict[str, Any]:
    """The graph in ELK's JSON with coordinates. Raises RuntimeError where ELK cannot lay it out."""
    answers: list[str | Exception] = []
    with LOCK:
        worker = _started(_work, json.dumps(graph), answers)
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


def _started(run: Callable[..., None], *arguments: Any) -> Thread:
    """A thread that works; the stack of the main thread is too small for a long chain."""
    before = stack_size(THREAD_STACK)
    try:
        worker = Thread(target=run, args=arguments, daemon=True)
        worker.start()
    finally:
        stack_size(before)
    return worker


def _begin() -> None:
    with LOCK, suppress(Exception):  # it comes again, and is told, where a layout is asked for
        _context()


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
