"""How publishers of other sessions left.

This follows from the order of events, some of which may be missing.
"""

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


class DepartureScene:
    """A session with a publisher, and the publishers that were reported lost."""

    def __init__(self) -> None:
        self.time = 0.0
        self.lost: list[EndpointInfo] = []
        self.remote = RemoteGraph()
        self.departures = ZenohDepartureMonitor(self.remote, lambda: self.time)
        self.departures.watch(self.lost.append)
        self.remote.add(PUBLISHER.key, PUBLISHER)

    def remove(self, token: Token) -> None:
        if self.remote.remove(token.key) is not None:
            self.departures.on_token_removed(token.key, token)

    def lost_names(self) -> list[str]:
        """Return the names of the lost publishers after all departures are judged."""
        self.time += 2 * GRACE_S
        assert self.departures.report_lost_publishers() is None
        return [endpoint.name for endpoint in self.lost]


@pytest.mark.parametrize("leaves", [False, True], ids=["killed", "left"])
@pytest.mark.parametrize("knows_node", [False, True], ids=["of the publisher alone", "of its node"])
def test_publisher_of_ended_session_is_lost_unless_session_left(leaves, knows_node):
    """A client may be killed after the publisher's announcement and before that of its node."""
    scene = DepartureScene()
    scene.departures.on_session_started(SESSION)
    if knows_node:
        scene.remote.add(NODE.key, NODE)
    if leaves:
        scene.departures.on_session_leaving(SESSION)
    scene.departures.on_session_ended(SESSION)
    scene.remove(PUBLISHER)
    scene.remove(NODE)
    assert scene.lost_names() == ([] if leaves else ["/chatter"])


def test_publisher_with_remaining_session_and_node_is_not_lost():
    scene = DepartureScene()
    scene.departures.on_session_started(SESSION)
    scene.remote.add(NODE.key, NODE)
    scene.remove(PUBLISHER)
    assert scene.lost_names() == []


@pytest.mark.parametrize("first", [NODE, PUBLISHER], ids=["node", "publisher"])
def test_publisher_in_foreign_session_is_lost_if_node_left_first(first):
    scene = DepartureScene()
    scene.remote.add(NODE.key, NODE)
    scene.remove(first)
    scene.remove(NODE)
    scene.remove(PUBLISHER)
    assert scene.lost_names() == (["/chatter"] if first is NODE else [])


def test_publisher_of_unknown_session_is_not_lost():
    scene = DepartureScene()
    scene.remove(PUBLISHER)
    assert scene.lost_names() == []
