from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import pytest

from linkwright.wire.zenoh.settings import OVERRIDES

ROUTER = [sys.executable, "-m", "linkwright.node_program", "rmw_zenoh_cpp", "rmw_zenohd"]

collect_ignore_glob = [] if find_spec("zenoh") else ["test_*.py"]


@pytest.fixture
def wire() -> str:
    return "zenoh"


@pytest.fixture(autouse=True)
def over_zenoh(zenoh_variables: None) -> None:
    """Zenoh for programs, too, and for tests that start no process of their own."""


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
