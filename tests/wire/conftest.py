"""Fixtures of the network tests: domains, processes and programs."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator

import pytest

from linkwright.graph import Graph, LogRecord
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.graph.log.logger import LogLevel
from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.wire import dds, zenoh
from linkwright.wire.background import BackgroundTransport
from linkwright.wire.unsupported_settings import DISCOVERY_SERVER_VARIABLES, SECURITY_VARIABLES
from linkwright.wire.zenoh.settings import (
    ATTEMPTS_VARIABLE,
    OVERRIDES_VARIABLE,
    ROUTER_FILE_VARIABLE,
    SESSION_FILE_VARIABLE,
)
from tests.domains import own_domain
from tests.waiting import TIMEOUT_S
from tests.wire.programs import Program

ROS_VARIABLES = (
    "ROS_LOCALHOST_ONLY",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "ROS_DISTRO",
    ASSUMED_DISTRIBUTION_VARIABLE,
    "CYCLONEDDS_URI",
    "LINKWRIGHT_DDS",
    "RMW_IMPLEMENTATION",
    *SECURITY_VARIABLES,
    *DISCOVERY_SERVER_VARIABLES,
)
JOINS = {"dds": dds.join, "zenoh": zenoh.join}
PACKAGES = {"dds": "cyclonedds", "zenoh": "zenoh"}

both_wires = pytest.mark.parametrize("wire", list(JOINS), indirect=True)
"""Run a test with DDS and with Zenoh."""


@pytest.fixture(autouse=True)
def domain(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    """Use a domain of this worker, and remove the other variables of ROS from the environment."""
    for name in ROS_VARIABLES:
        monkeypatch.delenv(name, raising=False)
    number = own_domain(1 if "command" in request.node.nodeid else 0)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
    return number


@pytest.fixture
def wire(request: pytest.FixtureRequest) -> str:
    """Return the transport of a test: DDS, unless the test is parametrized with `both_wires`."""
    return getattr(request, "param", "dds")


@pytest.fixture
def router_port() -> int:
    """Return a port without a listener, so that no router of this machine takes part in a test."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


@pytest.fixture
def zenoh_variables(monkeypatch: pytest.MonkeyPatch, domain: int, router_port: int) -> None:
    """Select Zenoh, with a router at a port of the test's own."""
    for name in (ATTEMPTS_VARIABLE, ROUTER_FILE_VARIABLE, SESSION_FILE_VARIABLE):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    monkeypatch.setenv(OVERRIDES_VARIABLE, f'connect/endpoints=["tcp/localhost:{router_port}"]')


class Process:
    """The graph, executor and transport of a process in a domain.

    Several of them share one test process.

    Args:
        name: the name of its node.
        wire: its transport, one of `JOINS`.
        join_now: whether it joins immediately.
    """

    def __init__(self, name: str, *, wire: str = "dds", join_now: bool = True) -> None:
        self.log: list[LogRecord] = []
        self.graph = Graph(threads=True, on_log=self.log.append)
        self.node = self.graph.create_node(name)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.transport: BackgroundTransport | None = None
        self._join = JOINS[wire]
        if join_now:
            self.join()

    def join(self) -> BackgroundTransport:
        self.transport = self._join(self.graph)
        assert self.transport is not None
        assert self.transport.wait_until_ready(TIMEOUT_S)
        return self.transport

    def spin_until(self, condition: Callable[[], object], seconds: float = TIMEOUT_S) -> None:
        """Run callbacks until a condition is met, and fail after the time limit."""
        deadline = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < deadline, f"condition not met within {seconds} s"
            self.executor.spin_once(timeout_sec=0.02)

    def warnings(self) -> list[str]:
        return [record.text for record in self.log if record.level >= LogLevel.WARN]

    def close(self) -> None:
        self.executor.shutdown()
        self.graph.close_threadsafe()


@pytest.fixture
def processes(wire: str, request: pytest.FixtureRequest) -> Iterator[Callable[..., Process]]:
    """Return a function that creates graphs.

    They meet only over the transport, and are closed after the test.
    """
    pytest.importorskip(PACKAGES[wire], reason=f"{wire} is not installed")
    if wire == "zenoh":
        request.getfixturevalue("zenoh_variables")
    processes: list[Process] = []

    def make(name: str, **options: bool) -> Process:
        processes.append(Process(name, wire=wire, **options))
        return processes[-1]

    yield make
    for process in processes:
        process.close()


@pytest.fixture
def programs() -> Iterator[Callable[..., Program]]:
    """Return a function that starts a program of this folder in another process.

    It ends after the test.
    """
    programs: list[Program] = []

    def start(name: str, *arguments: str, **environment: str) -> Program:
        programs.append(Program(name, *arguments, **environment))
        return programs[-1]

    yield start
    for program in programs:
        program.end()
