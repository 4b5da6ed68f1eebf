"""The server of the page: on this machine only, for who has its address, and for no other page.

Each request must name the token of the address, name this server as its host, and come from no
other page. It is Python's own `http.server`: no package more, and one page is no load.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import secrets
import socket
import socketserver
import sys
from collections.abc import Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, ClassVar
from urllib.parse import urlsplit

from tracewire.errors import OptionError, TracewireError
from tracewire.view.assets import KINDS, POLICY, Asset, assets, report_policy
from tracewire.view.limits import VIEW
from tracewire.view.service import Service

HOST = "127.0.0.1"
NAMES = (HOST, "localhost")
SITES = (None, "same-origin", "none")
"""What a browser may say of the page that asks: itself, or the user's own hand."""
REPORT = re.compile(r"report-([0-9a-f]{1,64})\.html")
"""The name of the report of a fit or a trace, by the id of that."""
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class PageServer(ThreadingHTTPServer):
    """A server for the pages of one service, with a token that no other server has."""

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would share a port that is taken

    def __init__(self, service: Service, port: int = 0) -> None:
        self.service = service
        self.token = secrets.token_urlsafe(24)
        self._open: set[Any] = set()
        super().__init__((HOST, port), Handler)

    def server_bind(self) -> None:
        """Bind without the look-up of a name, which may take seconds."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = HOST, self.server_address[1]

    def finish_request(self, request: Any, client_address: Any) -> None:
        """Talk to one browser until either goes."""
        self._open.add(request)
        try:
            super().finish_request(request, client_address)
        finally:
            self._open.discard(request)

    def server_close(self) -> None:
        """Stop listening, and end the connections that are open."""
        super().server_close()
        for request in tuple(self._open):
            with contextlib.suppress(OSError):
                request.shutdown(socket.SHUT_RDWR)

    @property
    def address(self) -> str:
        """The address of the page, with its token."""
        return f"http://{HOST}:{self.server_port}/{self.token}/"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A browser that goes away is no error; anything else is told in a line."""
        error = sys.exception()
        if not isinstance(error, ConnectionError | TimeoutError):
            sys.stderr.write(f"a request failed: {type(error).__name__}: {error}\n")


def open_server(service: Service, port: int = 0) -> PageServer:
    """A server on a port of this machine, a free one where it is 0. Raises OptionError."""
    try:
        return PageServer(service, port)
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        what = f"the port {port} of this machine cannot be used: {reason}"
        raise OptionError.one(what, hint="Leave out --port, and a free one is taken.") from None


class Handler(BaseHTTPRequestHandler):
    """One connection of a browser."""

    server: PageServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "tracewire", ""
    disable_nagle_algorithm = True
    wbufsize = -1
    timeout = VIEW.idle
    assets: ClassVar[Mapping[str, Asset]] = assets()

    def do_GET(self) -> None:
        """A file of the page."""
        name = self._allowed()
        if name is None:
            return
        report = REPORT.fullmatch(name)
        asset = self.assets.get(name)
        if report:
            self._send_report(report[1])
        elif asset is None:
            self._say(HTTPStatus.NOT_FOUND, "There is no such file in this page.")
        else:
            self._send(HTTPStatus.OK, asset.content, asset.kind)

    def do_POST(self) -> None:
        """A request of the page, in JSON."""
        length = self.headers.get("Content-Length", "")
        if not length.isdigit() or int(length) > VIEW.most_of_body:
            self.close_connection = True
            self._say(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, "The request is too large.")
            return
        body = self.rfile.read(int(length))
        action = self._allowed()
        if action is None:
            return
        if self.headers.get_content_type() != "application/json":
            self._say(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, "A request is in JSON.")
            return
        try:
            request = json.loads(body)
        except ValueError:
            request = None
        if not isinstance(request, dict):
            self._say(HTTPStatus.BAD_REQUEST, "A request is an object of JSON.")
            return
        try:
            answer = self.server.service.answer(action, request)
        except Exception as error:  # the page tells it, and the server goes on
            text = f"internal error ({type(error).__name__}: {error}). Please report it."
            answer = {"problems": [{"text": text, "file": "", "line": 0, "column": 0, "block": ""}]}
        if isinstance(answer, bytes):
            self._send(HTTPStatus.OK, answer, "application/octet-stream")
        else:
            self._send(HTTPStatus.OK, json.dumps(answer).encode(), "application/json")

    def _send_report(self, id: str) -> None:
        """The report of a fit or a trace, under a policy of its own."""
        try:
            page = self.server.service.report(id)
        except Exception as error:  # the page tells it, and the server goes on
            ours = not isinstance(error, TracewireError)
            text = f"internal error ({type(error).__name__}: {error})" if ours else str(error)
            self._say(HTTPStatus.INTERNAL_SERVER_ERROR if ours else HTTPStatus.NOT_FOUND, text)
            return
        self._send(HTTPStatus.OK, page.encode(), KINDS[".html"], report_policy())

    def _allowed(self) -> str | None:
        """What is asked for behind the token; None where it is refused, which is said then."""
        hosts = {f"{name}:{self.server.server_port}" for name in NAMES}
        origin, site = self.headers.get("Origin"), self.headers.get("Sec-Fetch-Site")
        _, token, *rest = [*urlsplit(self.path).path.split("/", 2), "", ""][:3]
        why = ""
        if self.headers.get("Host") not in hosts:
            why = "This server answers to its own name only."
        elif origin not in {None, *(f"http://{host}" for host in hosts)} or site not in SITES:
            why = "This server answers to its own page only."
        elif not secrets.compare_digest(token.encode(), self.server.token.encode()):
            why = "The address lacks its token: take it as `tracewire view` has printed it."
        if not why:
            return rest[0] if rest else ""
        self._say(HTTPStatus.FORBIDDEN, why)
        return None

    def _say(self, status: HTTPStatus, text: str) -> None:
        self._send(status, f"{text}\n".encode(), "text/plain; charset=utf-8")

    def _send(self, status: HTTPStatus, content: bytes, kind: str, policy: str = POLICY) -> None:
        self.send_response(status)
        self.send_header("Content-Security-Policy", policy)
        for name, value in HEADERS.items():
            self.send_header(name, value)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)
        self.wfile.flush()

    def log_message(self, format: str, *args: object) -> None:
        """Requests are not told: the terminal shows the address."""
