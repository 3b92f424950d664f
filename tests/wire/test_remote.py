"""The time at which the remote graph counts as complete."""

from __future__ import annotations

import time

import pytest

from linkwright.graph import QoSProfile
from linkwright.wire.dds.discovery_info import NodeEntities, ParticipantEntities
from linkwright.wire.dds.names import DISCOVERY_TOPIC
from linkwright.wire.dds.remote import RemoteEndpoint, RemoteGraph, RemoteParticipant

PARTICIPANT, LISTENER, SPEAKER, TALKER = b"p" * 16, b"l" * 16, b"s" * 16, b"t" * 16
TYPE_NAME = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"


@pytest.fixture
def remote():
    graph = RemoteGraph()
    graph.add_participant(RemoteParticipant(PARTICIPANT))
    return graph


def make_endpoint(guid, *, is_writer, topic=DISCOVERY_TOPIC):
    return RemoteEndpoint(guid, 1, PARTICIPANT, is_writer, topic, TYPE_NAME, QoSProfile(1))


def test_graph_is_incomplete_until_writers_of_node_are_discovered(remote):
    """Fast DDS announces one endpoint a second before the other."""
    assert not remote.is_complete()
    remote.add_endpoint(make_endpoint(LISTENER, is_writer=False))
    assert not remote.is_complete()
    remote.add_endpoint(make_endpoint(SPEAKER, is_writer=True))
    assert not remote.is_complete()
    remote.on_entities_announced(ParticipantEntities(PARTICIPANT, [NodeEntities("/", "talker", writers=(TALKER,))]))
    assert not remote.is_complete()
    remote.add_endpoint(make_endpoint(TALKER, is_writer=True, topic="rt/chatter"))
    assert remote.is_complete()


def test_participant_without_writers_is_not_waited_for_indefinitely():
    remote = RemoteGraph()
    remote.add_participant(RemoteParticipant(PARTICIPANT, discovered_at=time.monotonic() - 10.0))
    remote.add_endpoint(make_endpoint(LISTENER, is_writer=False))
    assert remote.is_complete()


def test_other_dds_programs_are_not_waited_for(remote):
    remote.add_endpoint(make_endpoint(LISTENER, is_writer=False, topic="temperature"))
    assert remote.is_complete()
