"""Lost publishers, as distinct from those that left."""

from __future__ import annotations

import sys

import pytest

from linkwright.graph import EndpointInfo, NodeIdentity, QoSProfile
from linkwright.graph.faults import ExternalShutdownException
from linkwright.messages import String
from linkwright.wire.dds import departures
from linkwright.wire.dds.departures import GRACE_S, WITHDRAWAL_TIMEOUT_S, DdsDepartureMonitor
from linkwright.wire.dds.discovery_info import NodeEntities, ParticipantEntities
from linkwright.wire.dds.remote import RemoteEndpoint, RemoteGraph, RemoteParticipant
from linkwright.wire.engine import is_ending_by_error

PARTICIPANT, WRITER, OTHER = b"p" * 16, b"w" * 16, b"o" * 16


class DepartureScene:
    """A discovered participant with two writers, and the publishers that were reported lost."""

    def __init__(self, participant: RemoteParticipant | None = None, *, watched: bool = True) -> None:
        self.time = 0.0
        self.remote = RemoteGraph()
        self.departures = DdsDepartureMonitor(self.remote, lambda: self.time)
        self.lost: list[EndpointInfo] = []
        if watched:
            self.departures.watch(self.lost.append)
        self.remote.add_participant(participant or RemoteParticipant(PARTICIPANT))
        for guid in (WRITER, OTHER):
            topic = "rt/chatter" if guid == WRITER else "rr/flipReply"
            endpoint = RemoteEndpoint(guid, 1, PARTICIPANT, True, topic, "std_msgs::msg::dds_::String_", QoSProfile(1))
            self.remote.add_endpoint(endpoint)
        self.announce(WRITER, OTHER)

    def announce(self, *writers: bytes) -> None:
        nodes = [NodeEntities("/far", "talker", writers=writers)] if writers else []
        self.remote.on_entities_announced(ParticipantEntities(PARTICIPANT, nodes))

    def after(self, seconds: float) -> float | None:
        self.time += seconds
        return self.departures.report_lost_publishers()


def test_withdrawn_publisher_is_not_lost():
    scene = DepartureScene()
    scene.announce(OTHER)
    scene.remote.remove_endpoint(WRITER)
    assert scene.after(0.0) is None
    assert scene.after(2 * WITHDRAWAL_TIMEOUT_S) is None
    assert not scene.lost


def test_withdrawal_after_participant_removal_is_not_a_loss():
    scene = DepartureScene()
    scene.remote.remove_participant(PARTICIPANT)
    assert scene.after(10.0) is not None
    scene.announce()
    scene.after(2 * WITHDRAWAL_TIMEOUT_S)
    assert not scene.lost


def test_participant_without_withdrawal_is_lost_with_its_publishers():
    scene = DepartureScene()
    scene.remote.remove_participant(PARTICIPANT)
    scene.after(10.0)  # samples received before the removal are read first
    assert not scene.lost
    scene.after(2 * WITHDRAWAL_TIMEOUT_S)
    (lost,) = scene.lost
    assert (lost.name, lost.node, lost.gid) == ("/chatter", NodeIdentity("talker", "/far"), WRITER)
    assert scene.after(WITHDRAWAL_TIMEOUT_S) is None
    assert len(scene.lost) == 1


def test_participant_of_ended_process_is_lost_before_lease_expires(monkeypatch):
    running = True
    monkeypatch.setattr("linkwright.wire.dds.remote.is_process_running", lambda _: running)
    scene = DepartureScene(RemoteParticipant(PARTICIPANT, peer_process=7))
    assert scene.after(0.0) == departures.POLL_S
    running = False
    scene.after(1.0)
    assert not scene.lost
    scene.after(2 * GRACE_S)
    assert [endpoint.name for endpoint in scene.lost] == ["/chatter"]
    scene.remote.remove_participant(PARTICIPANT)
    assert scene.after(2 * WITHDRAWAL_TIMEOUT_S) is None
    assert len(scene.lost) == 1


def test_process_that_ends_after_withdrawal_is_not_lost(monkeypatch):
    monkeypatch.setattr("linkwright.wire.dds.remote.is_process_running", lambda _: False)
    scene = DepartureScene(RemoteParticipant(PARTICIPANT, peer_process=7))
    scene.after(0.0)
    scene.announce()
    scene.remote.remove_participant(PARTICIPANT)
    scene.after(2 * WITHDRAWAL_TIMEOUT_S)
    assert not scene.lost


def test_departures_are_not_polled_without_watchers():
    scene = DepartureScene(RemoteParticipant(PARTICIPANT, peer_process=7), watched=False)
    assert scene.after(0.0) is None


def test_destroyed_publisher_and_leaving_process_are_not_lost(processes, programs):
    process = processes("ours")
    lost: list[EndpointInfo] = []
    process.node.create_subscription(String, "/other", lambda _: None, 10).watch_lost(lost.append)
    peer, marker = processes("theirs"), programs("linkwright_program", "marker")
    publisher = peer.node.create_publisher(String, "/other", 10)
    peer.node.create_publisher(String, "/other", 10)
    process.spin_until(lambda: process.node.count_publishers("/other") == 2)
    publisher.destroy()
    process.spin_until(lambda: process.node.count_publishers("/other") == 1)
    peer.close()
    process.spin_until(lambda: process.node.count_publishers("/other") == 0)
    process.node.create_subscription("rcl_interfaces/msg/Log", "/rosout", lambda _: None, 10).watch_lost(lost.append)
    process.spin_until(lambda: process.node.count_publishers("/rosout") == 2)
    marker.kill()
    process.spin_until(lambda: lost)  # reports about the publishers that left would have come first
    assert {endpoint.node.name for endpoint in lost} == {"marker"}, lost


def test_program_that_ends_with_uncaught_exception_is_lost(processes, monkeypatch):
    process = processes("ours")
    lost: list[EndpointInfo] = []
    process.node.create_subscription(String, "/other", lambda _: None, 10).watch_lost(lost.append)
    peer = processes("theirs")
    peer.node.create_publisher(String, "/other", 10)
    process.spin_until(lambda: process.node.count_publishers("/other") == 1)
    monkeypatch.setattr(sys, "last_value", ValueError("not caught"), raising=False)
    peer.transport.close()  # as at the end of the program
    process.spin_until(lambda: lost)
    assert [endpoint.node.name for endpoint in lost] == ["theirs"]


@pytest.mark.parametrize(
    ("error", "is_one"),
    [(ValueError(), True), (None, False), (KeyboardInterrupt(), False), (ExternalShutdownException(), False)],
)
def test_ends_by_error_distinguishes_exceptions(monkeypatch, error, is_one):
    monkeypatch.setattr(sys, "last_value", error, raising=False)
    assert is_ending_by_error() is is_one
