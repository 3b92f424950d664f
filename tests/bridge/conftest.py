"""Fixtures of the bridge tests: two networks, a bridge between them, and processes on both."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from typing import TypeVar

import pytest

from linkwright.bridge.bridge import run_bridge
from linkwright.bridge.filters import NameFilter
from linkwright.bridge.networks import read_network
from linkwright.graph import LogRecord
from linkwright.wire.zenoh.settings import (
    ATTEMPTS_VARIABLE,
    OVERRIDES_VARIABLE,
    ROUTER_FILE_VARIABLE,
    SESSION_FILE_VARIABLE,
)
from tests.waiting import TIMEOUT_S
from tests.wire.conftest import Process, domain, router_port  # noqa: F401 - fixtures, which take no part here else

collect_ignore_glob = [] if find_spec("zenoh") and find_spec("cyclonedds") else ["test_*.py"]


@pytest.fixture(autouse=True)
def variables(monkeypatch: pytest.MonkeyPatch, domain: int, router_port: int) -> None:  # noqa: F811 - fixtures
    """Set the router's address to a port that only this test uses."""
    for name in (ATTEMPTS_VARIABLE, ROUTER_FILE_VARIABLE, SESSION_FILE_VARIABLE, "RMW_IMPLEMENTATION"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv(OVERRIDES_VARIABLE, f'connect/endpoints=["tcp/localhost:{router_port}"]')


ClosableT = TypeVar("ClosableT", Process, "Bridge")


class Bridge:
    """A bridge in a separate thread."""

    def __init__(self, bridge_id: str, *, allowed: tuple[str, ...] = (), denied: tuple[str, ...] = ()) -> None:
        self.log: list[LogRecord] = []
        self._ready = threading.Event()
        self._loop = asyncio.new_event_loop()
        networks = (read_network("dds"), read_network("zenoh"))
        self._work = run_bridge(networks, NameFilter(allowed, denied), bridge_id, self.log.append, self._ready.set)
        self._task: asyncio.Task[None] | None = None
        self._thread = threading.Thread(target=self._run, name="bridge")
        self._thread.start()
        assert self._ready.wait(TIMEOUT_S)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._task = self._loop.create_task(self._work)
        try:
            self._loop.run_until_complete(self._task)
        except asyncio.CancelledError:
            pass
        finally:
            self._loop.close()

    def close(self) -> None:
        """Stop the bridge."""
        if self._thread.is_alive():
            assert self._task is not None
            self._loop.call_soon_threadsafe(self._task.cancel)
            self._thread.join(TIMEOUT_S)
        assert not self._thread.is_alive()


class Networks:
    """The processes of a test over DDS and over Zenoh, and the bridges between them."""

    def __init__(self) -> None:
        self._closables: list[Process | Bridge] = []

    def dds(self, name: str) -> Process:
        """Create a process that uses DDS."""
        return self._track(Process(name))

    def zenoh(self, name: str) -> Process:
        """Create a process that uses Zenoh."""
        return self._track(Process(name, wire="zenoh"))

    def bridge(self, bridge_id: str = "b0", **names: tuple[str, ...]) -> Bridge:
        """Start a bridge between both networks."""
        return self._track(Bridge(bridge_id, **names))

    def make(self, network: str) -> Callable[[str], Process]:
        """Return the function that creates processes in a network."""
        return self.dds if network == "dds" else self.zenoh

    def close(self) -> None:
        """Close all processes and bridges."""
        for closable in self._closables:
            closable.close()

    def _track(self, closable: ClosableT) -> ClosableT:
        self._closables.append(closable)
        return closable


@pytest.fixture
def networks() -> Iterator[Networks]:
    """Both networks, empty."""
    networks = Networks()
    yield networks
    networks.close()


def spin_all(condition: Callable[[], object], *processes: Process) -> None:
    """Run the callbacks of several processes until something holds."""

    def holds() -> bool:
        for process in processes[1:]:
            process.executor.spin_once(timeout_sec=0.0)
        return bool(condition())

    processes[0].spin_until(holds)
