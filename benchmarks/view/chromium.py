"""Chromium without a window, driven over a pipe by its DevTools protocol: no package is needed."""

from __future__ import annotations

import base64
import contextlib
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

NAMES = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next((found for name in NAMES if (found := shutil.which(name))), "")
"""The browser of this machine; empty where there is none."""
PATIENCE = 60.0
EXEC = """
import fcntl, os, sys
ends = [fcntl.fcntl(int(end), fcntl.F_DUPFD, 10) for end in sys.argv[1:3]]
os.dup2(ends[0], 3)
os.dup2(ends[1], 4)
os.execv(sys.argv[3], sys.argv[3:])
"""
"""Becomes the browser, which reads file 3 and writes file 4."""


class Chromium:
    """A browser with one page, for a `with` block. Errors of the page are collected in `errors`."""

    def __init__(self, width: int = 1280, height: int = 900) -> None:
        self.size = width, height
        self.errors: list[str] = []
        self._number = 0
        self._rest = b""
        self.page = ""

    def __enter__(self) -> Chromium:
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        read_end, self._to = os.pipe()
        self._from, write_end = os.pipe()
        command = [
            *(sys.executable, "-c", EXEC, str(read_end), str(write_end), BROWSER),
            *("--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe"),
            *(f"--window-size={self.size[0]},{self.size[1]}", "--no-first-run"),
            *(f"--user-data-dir={self._folder.name}", "--hide-scrollbars", "about:blank"),
        ]
        self._process = subprocess.Popen(
            command,
            pass_fds=(read_end, write_end),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(read_end)
        os.close(write_end)
        try:
            self.page = self.new_page()
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with contextlib.suppress(OSError, RuntimeError, TimeoutError):
            self.send("Browser.close", session="")
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self._folder.cleanup()

    def new_page(self) -> str:
        """Open a further page, and look at that from now on; its session."""
        target = self.send("Target.createTarget", {"url": "about:blank"}, session="")["targetId"]
        given = {"targetId": target, "flatten": True}
        self.page = str(self.send("Target.attachToTarget", given, session="")["sessionId"])
        for domain in ("Page", "Runtime", "Log"):
            self.send(f"{domain}.enable")
        width, height = self.size
        self.resize(width, height)
        return self.page

    def resize(self, width: int, height: int, mobile: bool = False) -> None:
        """Let the page be as large as this, in pixels."""
        shape = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile}
        self.send("Emulation.setDeviceMetricsOverride", shape)

    def send(
        self, method: str, parameters: dict[str, Any] | None = None, session: str | None = None
    ) -> Any:
        """Call a method of the protocol; its result."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method}
        message["params"] = parameters or {}
        where = self.page if session is None else session
        if where:
            message["sessionId"] = where
        os.write(self._to, json.dumps(message).encode() + b"\0")
        while True:
            got = self._next()
            if got.get("id") == self._number:
                if "error" in got:
                    raise RuntimeError(f"{method}: {got['error']['message']}")
                return got["result"]
            self._notice(got)

    def _next(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._from], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                raise TimeoutError("the browser says nothing")
            got = os.read(self._from, 1 << 16)
            if not got:
                raise RuntimeError("the browser has ended")
            self._rest += got
        text, _, self._rest = self._rest.partition(b"\0")
        message: dict[str, Any] = json.loads(text)
        return message

    def _notice(self, message: dict[str, Any]) -> None:
        given, here = message.get("params", {}), message.get("sessionId") == self.page
        if here and message.get("method") == "Runtime.exceptionThrown":
            details = given["exceptionDetails"]
            self.errors.append(str(details.get("exception", {}).get("description", details)))
        elif (
            here
            and message.get("method") == "Log.entryAdded"
            and given["entry"]["level"] == "error"
        ):
            text = f"{given['entry']['text']} {given['entry'].get('url', '')}"
            if "beforeunload" not in text:  # a page that was left unsaved, without a user
                self.errors.append(text)
        elif message.get("method") == "Page.javascriptDialogOpening":
            # answered without waiting for the answer's answer
            self._number += 1
            answer = {"id": self._number, "method": "Page.handleJavaScriptDialog"}
            answer |= {"params": {"accept": True}, "sessionId": message["sessionId"]}
            os.write(self._to, json.dumps(answer).encode() + b"\0")

    def open(self, address: str) -> None:
        """Open an address in the page."""
        self.send("Page.navigate", {"url": address})

    def run(self, script: str) -> Any:
        """The value of an expression of the page, awaited where it is a promise."""
        given = {"expression": script, "awaitPromise": True, "returnByValue": True}
        result = self.send("Runtime.evaluate", given)
        if "exceptionDetails" in result:
            details = result["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", str(details)))
        return result["result"].get("value")

    def wait(self, script: str, seconds: float = PATIENCE) -> Any:
        """The value of an expression as soon as it is true. Raises TimeoutError."""
        end = time.monotonic() + seconds
        while True:
            value = self.run(script)
            if value:
                return value
            if time.monotonic() > end:
                raise TimeoutError(f"never true: {script}; errors: {self.errors}")
            time.sleep(0.03)

    def key(self, name: str, code: int, text: str = "", modifiers: int = 0) -> None:
        """Press a key: its name and code of the DOM, the text that it makes; 2 is Ctrl, 8 Shift."""
        given = {"key": name, "code": name, "windowsVirtualKeyCode": code, "modifiers": modifiers}
        down = given | ({"type": "keyDown", "text": text} if text else {"type": "rawKeyDown"})
        self.send("Input.dispatchKeyEvent", down)
        self.send("Input.dispatchKeyEvent", given | {"type": "keyUp"})

    def picture(self, path: str | Path) -> None:
        """Write what the page shows as a PNG."""
        shot = self.send("Page.captureScreenshot", {"format": "png"})
        Path(path).write_bytes(base64.b64decode(shot["data"]))
