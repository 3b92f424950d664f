"""Nodes of other processes that have the name of a node of this process."""

from __future__ import annotations

from linkwright.graph import Graph, LogRecord
from linkwright.graph.introspection.graph_queries import SharedNameMonitor
from linkwright.graph.names.rules import NodeIdentity


def test_shared_name_is_reported_once_until_node_disappears():
    log: list[LogRecord] = []
    graph = Graph(threads=True, on_log=log.append)
    graph.create_node("talker", namespace="/robot")
    graph.create_node("listener")
    monitor = SharedNameMonitor()
    identities = [NodeIdentity("talker", "/robot", "/"), NodeIdentity("listener", "/robot", "/")]
    monitor.update(graph.nodes(), [])
    monitor.update(graph.nodes(), identities)
    monitor.update(graph.nodes(), identities)
    (record,) = log
    assert record.text.startswith("Another process has a node of the exact name '/robot/talker' too: ")
    assert "ROS_DOMAIN_ID" in record.text
    monitor.update(graph.nodes(), [])
    monitor.update(graph.nodes(), identities)
    assert len(log) == 2
    graph.close_threadsafe()


def test_root_namespace_names_have_one_slash():
    log: list[LogRecord] = []
    graph = Graph(threads=True, on_log=log.append)
    graph.create_node("talker")
    SharedNameMonitor().update(graph.nodes(), [NodeIdentity("talker", "/", "/")])
    assert "'/talker'" in log[0].text
    graph.close_threadsafe()


def test_shared_name_callback_receives_changes_without_logging():
    log: list[LogRecord] = []
    messages: list[frozenset[str]] = []
    graph = Graph(threads=True, on_log=log.append)
    graph.create_node("talker")
    graph.create_node("listener")
    monitor = SharedNameMonitor(messages.append)
    talker, listener = NodeIdentity("talker", "/", "/"), NodeIdentity("listener", "/", "/")
    for identities in ([], [talker], [talker, NodeIdentity("other", "/", "/")], [talker, listener], [listener], []):
        monitor.update(graph.nodes(), identities)
    assert messages == [
        frozenset({"/talker"}),
        frozenset({"/talker", "/listener"}),
        frozenset({"/listener"}),
        frozenset(),
    ]
    assert not log
    graph.close_threadsafe()
