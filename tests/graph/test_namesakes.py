"""Nodes of other processes that have the name of one of ours."""

from __future__ import annotations

from linkwright.graph import Graph, LogRecord
from linkwright.graph.namesakes import Namesakes
from linkwright.graph.transport import NodeIdentity


def test_each_is_told_once_as_long_as_it_is_there():
    log: list[LogRecord] = []
    graph = Graph(threads=True, on_log=log.append)
    graph.create_node("talker", namespace="/robot")
    graph.create_node("listener")
    namesakes = Namesakes()
    there = [NodeIdentity("talker", "/robot", "/"), NodeIdentity("listener", "/robot", "/")]
    namesakes.review(graph.nodes(), [])
    namesakes.review(graph.nodes(), there)
    namesakes.review(graph.nodes(), there)
    assert [record.text for record in log] == [
        "Another process has a node of the exact name '/robot/talker' too: this can have unintended side effects"
    ]
    namesakes.review(graph.nodes(), [])
    namesakes.review(graph.nodes(), there)
    assert len(log) == 2
    graph.close_now()


def test_names_of_the_root_have_one_slash():
    log: list[LogRecord] = []
    graph = Graph(threads=True, on_log=log.append)
    graph.create_node("talker")
    Namesakes().review(graph.nodes(), [NodeIdentity("talker", "/", "/")])
    assert "'/talker'" in log[0].text
    graph.close_now()
