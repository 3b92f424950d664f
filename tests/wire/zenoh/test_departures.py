"""How publishers of other sessions went, told by the order of news, some of which may not come."""

from __future__ import annotations

import pytest

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.zenoh.departures import GRACE_S, ZenohDepartureMonitor
from linkwright.wire.zenoh.remote import RemoteGraph
from linkwright.wire.zenoh.tokens import Token

SESSION = "5e55"
NAME = NodeIdentity("talker", "/far")
NODE = Token(7, SESSION, "0", "0", NAME)
PUBLISHER = Token(
    7,
    SESSION,
    "0",
    "1",
    NAME,
    EndpointKind.PUBLISHER,
    "/chatter",
    "std_msgs::msg::dds_::String_",
    "hash",
    "::,10:,:,:,,",
)


class Scene:
    """A session with a publisher, and who is told to be lost."""

    def __init__(self) -> None:
        self.time = 0.0
        self.lost: list[EndpointInfo] = []
        self.remote = RemoteGraph()
        self.departures = ZenohDepartureMonitor(self.remote, lambda: self.time)
        self.departures.watch(self.lost.append)
        self.remote.add(PUBLISHER.key, PUBLISHER)

    def went(self, token: Token) -> None:
        if self.remote.remove(token.key) is not None:
            self.departures.token_removed(token.key, token)

    def names_lost(self) -> list[str]:
        """Those that are lost once all is judged."""
        self.time += 2 * GRACE_S
        assert self.departures.report_lost_publishers() is None
        return [endpoint.name for endpoint in self.lost]


@pytest.mark.parametrize("leaves", [False, True], ids=["killed", "left"])
@pytest.mark.parametrize("knows_node", [False, True], ids=["of the publisher alone", "of its node"])
def test_publisher_of_ended_session_is_lost_unless_session_left(leaves, knows_node):
    """Which a client is told of before the node: it may be killed in between."""
    scene = Scene()
    scene.departures.session_started(SESSION)
    if knows_node:
        scene.remote.add(NODE.key, NODE)
    if leaves:
        scene.departures.session_leaving(SESSION)
    scene.departures.session_ended(SESSION)
    scene.went(PUBLISHER)
    scene.went(NODE)
    assert scene.names_lost() == ([] if leaves else ["/chatter"])


def test_publisher_with_remaining_session_and_node_is_not_lost():
    scene = Scene()
    scene.departures.session_started(SESSION)
    scene.remote.add(NODE.key, NODE)
    scene.went(PUBLISHER)
    assert scene.names_lost() == []


@pytest.mark.parametrize("first", [NODE, PUBLISHER], ids=["node", "publisher"])
def test_publisher_in_foreign_session_is_lost_if_node_left_first(first):
    scene = Scene()
    scene.remote.add(NODE.key, NODE)
    scene.went(first)
    scene.went(NODE)
    scene.went(PUBLISHER)
    assert scene.names_lost() == (["/chatter"] if first is NODE else [])


def test_publisher_of_unknown_session_is_not_lost():
    scene = Scene()
    scene.went(PUBLISHER)
    assert scene.names_lost() == []
