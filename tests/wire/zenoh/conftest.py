from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import pytest

from linkwright.wire.zenoh import ZenohTransport, join
from linkwright.wire.zenoh.settings import ATTEMPTS, OVERRIDES, ROUTER_FILE, SESSION_FILE
from tests.waiting import SECONDS
from tests.wire.conftest import Process

ROUTER = [sys.executable, "-m", "linkwright.node_program", "rmw_zenoh_cpp", "rmw_zenohd"]

collect_ignore_glob = [] if find_spec("zenoh") else ["test_*.py"]


@pytest.fixture
def router_port() -> int:
    """A port that nobody listens at: no router of this machine takes part in a test."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


@pytest.fixture(autouse=True)
def zenoh_variables(monkeypatch: pytest.MonkeyPatch, domain: int, router_port: int) -> None:
    """Zenoh, and a router that is looked for at a port of the test's own."""
    for name in (ATTEMPTS, ROUTER_FILE, SESSION_FILE):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    monkeypatch.setenv(OVERRIDES, f'connect/endpoints=["tcp/localhost:{router_port}"]')


@pytest.fixture
def start_router(router_port) -> Iterator[Callable[[], subprocess.Popen[str]]]:
    """Starts a router at the port of the test; it has said that it is one when this returns."""
    started: list[subprocess.Popen[str]] = []

    def start() -> subprocess.Popen[str]:
        settings = f'listen/endpoints=["tcp/localhost:{router_port}"];connect/endpoints=[]'
        router = subprocess.Popen(
            ROUTER,
            env={**os.environ, OVERRIDES: settings},
            stderr=subprocess.STDOUT,
            stdout=subprocess.PIPE,
            text=True,
        )
        started.append(router)
        assert router.stdout is not None
        assert f"Zenoh router at tcp/localhost:{router_port}" in router.stdout.readline()
        return router

    yield start
    for router in started:
        router.kill()
        router.communicate()


class ZenohProcess(Process):
    """What a process has on a domain, over Zenoh."""

    def join(self) -> ZenohTransport:
        self.transport = join(self.graph)
        assert self.transport is not None
        assert self.transport.wait_until_ready(SECONDS)
        return self.transport


@pytest.fixture
def processes() -> Iterator[Callable[..., ZenohProcess]]:
    """Makes graphs that meet over Zenoh alone, closed after the test."""
    made: list[ZenohProcess] = []

    def make(name: str, **options: bool) -> ZenohProcess:
        made.append(ZenohProcess(name, **options))
        return made[-1]

    yield make
    for each in made:
        each.close()
