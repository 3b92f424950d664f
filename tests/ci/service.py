"""A local service with pull requests, for programs that comment on them.

It imitates GitHub, Gitea and GitLab.
"""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

TOKEN = "a-token"


@dataclass
class Service:
    """A service that answers requests and records them.

    Attributes:
        me: the name of the token's owner; None if the token may not request it, as for tokens of jobs.
        can_write: whether the token can comment.
        ignores_pages: whether each page of a list has all items, as in Gitea.
        author_key: the key of a comment's author.
        name_key: the key of the author's name.
        comments: the comments, in their order.
        pulls: the pull requests by number.
        artifact: the artifact of a run, as a zip file.
        failures: the statuses with which the next requests fail.
        requests: the method and the path of each request.
        tokens: the header with the token of each request.
    """

    me: str | None = None
    can_write: bool = True
    ignores_pages: bool = False
    author_key: str = "user"
    name_key: str = "login"
    comments: list[dict[str, Any]] = field(default_factory=list)
    pulls: dict[int, dict[str, Any]] = field(default_factory=dict)
    artifact: bytes | None = None
    failures: list[int] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)
    tokens: list[str] = field(default_factory=list)
    url: str = ""

    @property
    def bodies(self) -> list[str]:
        return [comment["body"] for comment in self.comments]

    @property
    def writes(self) -> list[str]:
        """Return the requests that wrote something."""
        return [request for request in self.requests if not request.startswith("GET")]

    def add(self, body: str, name: str = "github-actions[bot]", kind: str = "Bot") -> None:
        """Add a comment of an author."""
        author = {self.name_key: name, "type": kind}
        self.comments.append({"id": 100 + len(self.comments), "body": body, self.author_key: author})

    def answer(self, method: str, path: str, query: dict[str, list[str]], body: Any) -> tuple[int, Any]:
        """Return the status and the content of the response to a request."""
        routes: list[tuple[str, str, Callable[..., tuple[int, Any]]]] = [
            ("GET", r"/user", lambda: (200, {self.name_key: self.me}) if self.me else (403, {})),
            ("GET", r".*/(?:comments|notes)", lambda: (200, self._page(query))),
            ("POST", r".*/(?:comments|notes)", lambda: self._post(body)),
            ("PATCH", r".*/issues/comments/(\d+)", lambda number: self._edit(int(number), body)),
            ("PUT", r".*/notes/(\d+)", lambda number: self._edit(int(number), body)),
            ("GET", r".*/pulls/(\d+)", lambda number: self._pull(int(number))),
            ("GET", r".*/runs/\d+/artifacts", lambda: (200, self._artifacts(query))),
            ("GET", r".*/artifacts/8/zip", lambda: (302, f"{self.url}/storage")),
            ("GET", r"/storage", lambda: (200, self.artifact)),
        ]
        for route_method, pattern, function in routes:
            match = re.fullmatch(pattern, path)
            if match and method == route_method:
                return function(*match.groups())
        return 404, {}

    def _page(self, query: dict[str, list[str]]) -> list[dict[str, Any]]:
        size, page = int(query["per_page"][0]), int(query["page"][0])
        return self.comments if self.ignores_pages else self.comments[size * (page - 1) : size * page]

    def _post(self, body: Any) -> tuple[int, Any]:
        if not self.can_write:
            return 403, {"message": "Resource not accessible by integration"}
        self.add(body["body"], self.me or "github-actions[bot]")
        return 201, self.comments[-1]

    def _edit(self, number: int, body: Any) -> tuple[int, Any]:
        if not self.can_write:
            return 403, {"message": "Resource not accessible by integration"}
        (comment,) = [comment for comment in self.comments if comment["id"] == number]
        comment["body"] = body["body"]
        return 200, comment

    def _pull(self, number: int) -> tuple[int, Any]:
        return (200, self.pulls[number]) if number in self.pulls else (404, {})

    def _artifacts(self, query: dict[str, list[str]]) -> dict[str, Any]:
        name = query["name"][0]
        artifacts = [{"id": number, "name": name, "expired": number == 9} for number in (7, 8, 9)]
        return {"artifacts": artifacts if self.artifact is not None else []}


@contextmanager
def serve(service: Service) -> Iterator[Service]:
    """Serve on a free port of this machine."""

    class Handler(BaseHTTPRequestHandler):
        def _handle(self) -> None:
            address = urlsplit(self.path)
            length = int(self.headers.get("Content-Length") or 0)
            body = json.loads(self.rfile.read(length)) if length else None
            service.requests.append(f"{self.command} {address.path}")
            service.tokens.append(self.headers.get("Authorization") or self.headers.get("PRIVATE-TOKEN") or "")
            if service.failures:
                status, content = service.failures.pop(0), {}
            else:
                status, content = service.answer(self.command, address.path, parse_qs(address.query), body)
            self.send_response(status)
            if status == 302:
                self.send_header("Location", content)
                content = b""
            data = content if isinstance(content, bytes) else json.dumps(content).encode()
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

        do_GET = do_POST = do_PATCH = do_PUT = _handle  # noqa: N815 - the names of the base class

        def log_message(self, *_: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    thread = threading.Thread(target=server.serve_forever, args=(0.02,))
    thread.start()
    service.url = f"http://127.0.0.1:{server.server_port}"
    try:
        yield service
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
