"""Machines that are reached without multicast, as with ROS_STATIC_PEERS.

They may start late, and return.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from importlib.util import find_spec

import pytest

from tests.wire.programs import Program
from tests.wire.zenoh.hosts import CLOUD, DESK, DESKS_CLOUD_ADDRESS, Hosts, unsupported_reason

PRUNE_DELAY_S = 2
"""The seconds after which Cyclone stops asking an address that does not answer; 30 by default."""


def cyclone_configuration(interface: str) -> str:
    """Return a configuration of Cyclone without multicast."""
    return (
        "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast>"
        f"<Interfaces><NetworkInterface name='{interface}'/></Interfaces></General>"
        f"<Discovery><InitialLocatorPruneDelay>{PRUNE_DELAY_S} s</InitialLocatorPruneDelay></Discovery>"
        "</Domain></CycloneDDS>"
    )


pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("cyclonedds") is None, reason="cyclonedds is not installed"),
]


@pytest.fixture
def hosts() -> Iterator[Hosts]:
    reason = unsupported_reason()
    if reason:
        pytest.skip(reason)
    hosts = Hosts()
    yield hosts
    hosts.close()


def test_late_and_returning_static_peer_is_discovered(hosts):
    def start(host: str, other: str, name: str, **environment: str) -> Program:
        settings = {"CYCLONEDDS_URI": cyclone_configuration(f"to{other}"), "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}
        return Program("far_program", name, prefix_words=hosts.within(host), **settings, **environment)

    desk = start(DESK, CLOUD, "desk", ROS_STATIC_PEERS=DESKS_CLOUD_ADDRESS)
    try:
        for name in ("first", "second"):
            time.sleep(2 * PRUNE_DELAY_S)
            late_peer = start(CLOUD, DESK, name)
            desk.ask_until(lambda nodes, name=name: name in nodes, "nodes")
            late_peer.end()
            desk.ask_until(lambda nodes, name=name: name not in nodes, "nodes")
    finally:
        desk.end()
