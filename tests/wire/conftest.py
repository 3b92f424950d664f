from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator

import pytest

from linkwright.graph import Graph, LogRecord
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.graph.log.logger import LogLevel
from linkwright.messages.distribution import ASSUMED
from linkwright.wire import dds, zenoh
from linkwright.wire.background import BackgroundTransport
from linkwright.wire.unsupported_settings import DISCOVERY_SERVERS, SECURITY
from linkwright.wire.zenoh.settings import ATTEMPTS, OVERRIDES, ROUTER_FILE, SESSION_FILE
from tests.domains import own_domain
from tests.waiting import SECONDS
from tests.wire.programs import Program

ROS_VARIABLES = (
    "ROS_LOCALHOST_ONLY",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "ROS_DISTRO",
    ASSUMED,
    "CYCLONEDDS_URI",
    "LINKWRIGHT_DDS",
    "RMW_IMPLEMENTATION",
    *SECURITY,
    *DISCOVERY_SERVERS,
)
JOINS = {"dds": dds.join, "zenoh": zenoh.join}
PACKAGES = {"dds": "cyclonedds", "zenoh": "zenoh"}

both_wires = pytest.mark.parametrize("wire", list(JOINS), indirect=True)
"""For a test that says the same of DDS and of Zenoh."""


@pytest.fixture(autouse=True)
def domain(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    """A domain for this worker of a parallel run, and nothing else of ROS in the environment."""
    for name in ROS_VARIABLES:
        monkeypatch.delenv(name, raising=False)
    number = own_domain(1 if "command" in request.node.nodeid else 0)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
    return number


@pytest.fixture
def wire(request: pytest.FixtureRequest) -> str:
    """The transport of a test: DDS, unless it asks for both."""
    return getattr(request, "param", "dds")


@pytest.fixture
def router_port() -> int:
    """A port that nobody listens at: no router of this machine takes part in a test."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


@pytest.fixture
def zenoh_variables(monkeypatch: pytest.MonkeyPatch, domain: int, router_port: int) -> None:
    """Zenoh, and a router that is looked for at a port of the test's own."""
    for name in (ATTEMPTS, ROUTER_FILE, SESSION_FILE):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    monkeypatch.setenv(OVERRIDES, f'connect/endpoints=["tcp/localhost:{router_port}"]')


class Process:
    """What a process has on a domain: a graph, an executor, a transport. Several of them live in one test process.

    Args:
        name: the name of its node.
        wire: its transport, one of `JOINS`.
        join_now: whether it joins at once.
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
        assert self.transport.wait_until_ready(SECONDS)
        return self.transport

    def spin_until(self, condition: Callable[[], object], seconds: float = SECONDS) -> None:
        """Run callbacks until something holds; fails when it does not in time."""
        until = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < until, f"not so within {seconds} s"
            self.executor.spin_once(timeout_sec=0.02)

    def warnings(self) -> list[str]:
        return [record.text for record in self.log if record.level >= LogLevel.WARN]

    def close(self) -> None:
        self.executor.shutdown()
        self.graph.close_threadsafe()


@pytest.fixture
def processes(wire: str, request: pytest.FixtureRequest) -> Iterator[Callable[..., Process]]:
    """Makes graphs that meet on the wire alone, closed after the test."""
    pytest.importorskip(PACKAGES[wire], reason=f"there is no {wire} here")
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
    """Starts a program of this folder in a Python of its own; gone after the test."""
    started: list[Program] = []

    def start(name: str, *words: str, **environment: str) -> Program:
        started.append(Program(name, *words, **environment))
        return started[-1]

    yield start
    for program in started:
        program.end()
