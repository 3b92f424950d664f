"""Transports that only discover: for verbs that list the graph and take no part in it."""

from __future__ import annotations

import subprocess
import sys
import textwrap

import pytest

from linkwright.graph import Graph
from linkwright.messages import String
from linkwright.wire.dds import join
from linkwright.wire.dds import transport as module
from tests.waiting import TIMEOUT_S, wait_until

pytest.importorskip("cyclonedds", reason="cyclonedds is not installed")

on_linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lists other processes' sockets")


@pytest.fixture
def observer():
    graph = Graph(threads=True)
    transport = join(graph, discovers_only=True)
    assert transport is not None
    assert transport.wait_until_ready(TIMEOUT_S)
    yield graph, transport
    graph.close_threadsafe()


@pytest.fixture
def never_settled(monkeypatch):
    """Never conclude from silence that all processes have answered."""
    monkeypatch.setattr(module, "SETTLE_TIME_S", float("inf"))


def test_discovers_only_transport_sees_others_and_is_not_seen(observer, processes):
    graph, _ = observer
    node = graph.create_node("looks")
    node.create_publisher(String, "unheard", 10)
    other = processes("others")
    other.node.create_subscription(String, "chatter", print, 10)
    assert other.transport.wait_until_ready(TIMEOUT_S)
    wait_until(lambda: graph.count_subscribers("/chatter") == 1)
    third = processes("third")
    third.spin_until(lambda: third.node.count_subscribers("chatter") == 1)
    assert sorted(name for name, _ in third.node.get_node_names_and_namespaces()) == ["others", "third"]
    assert third.node.count_publishers("unheard") == 0


@on_linux
def test_wait_for_discovery_ends_without_peers(observer, never_settled):
    _, transport = observer
    assert transport.wait_for_discovery(TIMEOUT_S)


@on_linux
def test_wait_for_discovery_ends_when_all_processes_are_discovered(programs, never_settled):
    programs("linkwright_program", "one")
    programs("linkwright_program", "two")
    graph = Graph(threads=True)
    transport = join(graph, discovers_only=True)
    assert transport is not None
    assert transport.wait_for_discovery(TIMEOUT_S)
    assert {node.name for node in transport.remote_nodes()} == {"one", "two"}
    assert graph.count_publishers("/chatter") == 0
    graph.close_threadsafe()


@on_linux
def test_unanswered_process_is_waited_for(observer, monkeypatch):
    _, transport = observer
    process_count = 1
    monkeypatch.setattr(module, "count_other_processes", lambda _domain: process_count)
    assert not transport._knows_all_processes()
    process_count = 0
    assert transport._knows_all_processes()


def test_process_count_is_inconclusive_with_several_participants(observer, processes, monkeypatch):
    _, transport = observer
    monkeypatch.setattr(module, "count_other_processes", lambda _domain: 0)
    assert transport._knows_all_processes()
    processes("beside")
    wait_until(transport.remote_nodes)
    assert not transport._knows_all_processes()


@pytest.mark.parametrize("range_name", ["SUBNET", "LOCALHOST"])
def test_process_count_is_inconclusive_beyond_own_machine(range_name, monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range_name)
    monkeypatch.setattr(module, "count_other_processes", lambda _domain: 0)
    graph = Graph(threads=True)
    transport = join(graph, discovers_only=True)
    assert transport is not None
    assert not transport._knows_all_processes()
    graph.close_threadsafe()


def test_numpy_and_unused_cyclonedds_modules_are_not_imported():
    code = """
        import sys
        from linkwright.graph import Graph
        from linkwright.wire.dds import join

        graph = Graph(threads=True)
        graph.create_node("looks")
        transport = join(graph, discovers_only=True)
        assert transport.wait_until_ready(60)
        graph.close_threadsafe()
        costly = ("numpy", "cyclonedds.pub", "cyclonedds.qos", "cyclonedds.idl._xt_builder", "urllib.request")
        print([name for name in costly if name in sys.modules])
        import cyclonedds
        from cyclonedds import core
        from cyclonedds.pub import DataWriter
        print(cyclonedds.pub.DataWriter is DataWriter, cyclonedds.core is core, hasattr(cyclonedds, "nothing"))
    """
    result = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, check=False, timeout=TIMEOUT_S
    )
    assert (result.stdout, result.stderr) == ("[]\nTrue True False\n", "")
