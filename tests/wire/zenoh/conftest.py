"""Fixtures of the Zenoh tests: settings, routers and processes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec

import pytest

from linkwright.wire.zenoh.settings import OVERRIDES_VARIABLE

ROUTER = [sys.executable, "-m", "linkwright.node_program", "rmw_zenoh_cpp", "rmw_zenohd"]

collect_ignore_glob = [] if find_spec("zenoh") else ["test_*.py"]


@pytest.fixture
def wire() -> str:
    return "zenoh"


@pytest.fixture(autouse=True)
def over_zenoh(zenoh_variables: None) -> None:
    """Use Zenoh also in programs, and in tests that create no `Process`."""


@pytest.fixture
def start_router(router_port) -> Iterator[Callable[[], subprocess.Popen[str]]]:
    """Return a function that starts a router at the test's port, and returns when it listens."""
    routers: list[subprocess.Popen[str]] = []

    def start() -> subprocess.Popen[str]:
        settings = f'listen/endpoints=["tcp/localhost:{router_port}"];connect/endpoints=[]'
        router = subprocess.Popen(
            ROUTER,
            env={**os.environ, OVERRIDES_VARIABLE: settings},
            stderr=subprocess.STDOUT,
            stdout=subprocess.PIPE,
            text=True,
        )
        routers.append(router)
        assert router.stdout is not None
        assert f"Zenoh router at tcp/localhost:{router_port}" in router.stdout.readline()
        return router

    yield start
    for router in routers:
        router.kill()
        router.communicate()
