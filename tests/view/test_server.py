"""Who is answered by the server of the page, and who is not."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from http.client import HTTPConnection, HTTPResponse
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from tracewire.errors import OptionError
from tracewire.show import report_script
from tracewire.view import Service, open_server
from tracewire.view.assets import FOLDER, POLICY, assets, report_policy, source_of
from tracewire.view.server import PageServer
from view.conftest import SPRING, serving


@pytest.fixture
def server(service: Service) -> Iterator[PageServer]:
    with serving(service) as running:
        yield running


def asked(
    server: PageServer,
    name: str = "",
    body: Any = None,
    *,
    path: str | None = None,
    **headers: str,
) -> tuple[HTTPResponse, bytes]:
    """The answer to a request for a name behind the token, with headers as they are given."""
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=20)
    try:
        where = f"/{server.token}/{name}" if path is None else path
        if body is None:
            connection.request("GET", where, headers=headers)
        else:
            given = {"Content-Type": "application/json"} | headers
            content = body if isinstance(body, bytes) else json.dumps(body).encode()
            connection.request("POST", where, content, given)
        response = connection.getresponse()
        return response, response.read()
    finally:
        connection.close()


def test_it_listens_on_this_machine_only(server: PageServer) -> None:
    assert server.server_address[0] == "127.0.0.1"
    assert urlsplit(server.address).netloc == f"127.0.0.1:{server.server_port}"


def test_the_page_and_its_files_come_with_a_strict_policy(server: PageServer) -> None:
    response, page = asked(server)
    assert response.status == 200
    assert response.getheader("Content-Security-Policy") == POLICY
    assert response.getheader("X-Content-Type-Options") == "nosniff"
    assert response.getheader("Cache-Control") == "no-store"
    for name in re.findall(r'(?:src|href)="([\w.]+)"', page.decode()):
        assert asked(server, name)[0].status == 200
    assert asked(server, "no.js")[0].status == 404


def test_the_policy_allows_no_script_of_a_text_and_nothing_from_outside() -> None:
    assert "default-src 'none'" in POLICY
    assert "unsafe" not in POLICY
    assert "http" not in POLICY and "*" not in POLICY


def test_a_request_is_answered(server: PageServer) -> None:
    response, content = asked(server, "open", {}, Origin=server.address.rsplit("/", 2)[0])
    assert response.status == 200
    assert json.loads(content)["text"] == SPRING


@pytest.mark.parametrize("path", ["/", "/wrong/", "/wrong/open", "/open", "//", "/../"])
@pytest.mark.parametrize("body", [None, {}])
def test_without_the_token_nothing_is_told(server: PageServer, path: str, body: Any) -> None:
    response, content = asked(server, body=body, path=path)
    assert response.status == 403
    assert b"token" in content
    assert SPRING.encode()[:20] not in content


@pytest.mark.parametrize(
    ("header", "value"),
    [
        ("Host", "evil.example:80"),
        ("Host", "127.0.0.1"),
        ("Origin", "http://evil.example"),
        ("Origin", "null"),
        ("Sec-Fetch-Site", "cross-site"),
        ("Sec-Fetch-Site", "same-site"),
    ],
)
@pytest.mark.parametrize("body", [None, {}])
def test_other_pages_and_names_are_refused(
    server: PageServer, header: str, value: str, body: Any
) -> None:
    assert asked(server, "open", body, **{header: value})[0].status == 403


@pytest.mark.parametrize(
    ("body", "headers", "status"),
    [
        (b"{", {}, 400),
        (b"[]", {}, 400),
        (b"{}", {"Content-Type": "text/plain"}, 415),
        (b"{}", {"Content-Length": "99999999"}, 413),
        (b"{}", {"Content-Length": "x"}, 413),
    ],
)
def test_what_is_no_request_is_refused(
    server: PageServer, body: bytes, headers: dict[str, str], status: int
) -> None:
    assert asked(server, "open", body, **headers)[0].status == status


def test_a_mistake_of_ours_is_told_and_does_not_end_it(
    server: PageServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(request: Any) -> Any:
        raise ZeroDivisionError("a/0")

    monkeypatch.setitem(server.service.actions, "open", broken)
    response, content = asked(server, "open", {})
    assert response.status == 200
    assert json.loads(content)["problems"][0]["text"].startswith("internal error (ZeroDivision")
    assert asked(server)[0].status == 200


def test_a_port_that_is_taken_is_told(server: PageServer, service: Service) -> None:
    with pytest.raises(OptionError, match=f"port {server.server_port} .* cannot be used"):
        open_server(service, server.server_port)
    with pytest.raises(OptionError, match="cannot be used"):
        open_server(service, 70000)


def test_a_report_that_is_not_there_is_told(server: PageServer) -> None:
    response, content = asked(server, "report-0123456789abcdef.html")
    assert (response.status, b"no such result" in content) == (404, True)
    assert asked(server, "report-.html")[0].status == 404
    assert asked(server, path="/wrong/report-0123456789abcdef.html")[0].status == 403


def test_a_report_runs_its_own_script_and_asks_for_nothing() -> None:
    rules = dict(rule.partition(" ")[::2] for rule in report_policy().split("; "))
    assert rules["default-src"] == "'none'" and "connect-src" not in rules
    assert rules["sandbox"] == "allow-scripts"  # without allow-same-origin it is a stranger here
    assert rules["script-src"] == source_of(report_script())
    assert "unsafe" not in report_policy() and "self" not in report_policy()


@pytest.mark.parametrize(
    "name",
    [
        "../spring.yaml",
        "..%2fspring.yaml",
        "spring.yaml",
        "page/main.js",
        "report-../../spring.html",
        "//spring.yaml",
        "..\\spring.yaml",
    ],
)
def test_no_file_but_those_of_the_page_is_given(
    server: PageServer, spring: Path, name: str
) -> None:
    response, content = asked(server, name)
    assert response.status == 404 and SPRING.encode()[:20] not in content
    assert asked(server, path=f"/{server.token}{spring}")[0].status == 404


def test_two_servers_have_different_tokens(service: Service, server: PageServer) -> None:
    with serving(service) as other:
        assert other.token != server.token
        assert asked(other, path=f"/{server.token}/")[0].status == 403


def test_scripts_put_texts_in_as_text_only() -> None:
    scripts = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.js")}
    assert len(scripts) > 5
    ways = re.compile(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(|new Function")
    assert [name for name, text in scripts.items() if ways.search(text)] == []


def test_scripts_import_what_is_there() -> None:
    for path in FOLDER.glob("*.js"):
        for name in re.findall(r'from "\./([\w.]+)"', path.read_text(encoding="utf-8")):
            assert name in assets()


def test_files_of_the_page_stay_small() -> None:
    counted = {p.name: len(p.read_text(encoding="utf-8").splitlines()) for p in FOLDER.iterdir()}
    assert {name: lines for name, lines in counted.items() if lines > 300} == {}


def test_no_file_of_the_page_names_another_host() -> None:
    for path in Path(FOLDER).iterdir():
        assert "://" not in path.read_text(encoding="utf-8")
