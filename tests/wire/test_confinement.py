"""By default no announcement leaves the machine.

Each interface has the membership that Linux needs to drop them.
"""

from __future__ import annotations

import asyncio
import socket
import sys
from pathlib import Path

import pytest

from linkwright.graph import Graph
from linkwright.wire.dds import join, open_domains
from linkwright.wire.dds.settings import find_own_addresses
from tests.waiting import TIMEOUT_S

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="only Linux sends packets with a time to live of zero"
)

GROUP = "0xefff0001"


def memberships() -> set[str]:
    """Return the addresses that are the only source of their interface's group.

    The group is that of the announcements.
    """
    rows = [line.split() for line in Path("/proc/self/net/mcfilter").read_text().splitlines()[1:]]
    sources = [source for _, _, group, source, included, _ in rows if group == GROUP and int(included)]
    return {socket.inet_ntoa(int(source, 16).to_bytes(4, "big")) for source in sources}


def join_network() -> Graph:
    """Return a graph that has joined the network as far as the settings allow."""
    graph = Graph(threads=True)
    transport = join(graph)
    assert transport is not None
    assert transport.wait_until_ready(TIMEOUT_S)
    return graph


def test_interfaces_accept_announcements_of_own_address_only():
    graph = join_network()
    assert memberships() >= set(find_own_addresses())
    asyncio.run(graph.close())


def test_only_loopback_is_used_if_memberships_fail(monkeypatch):
    def refuse(addresses):
        raise OSError("no buffer space")

    interfaces = []
    first_taken = open_domains._create_with_first_accepted

    def note(number, configurations):
        interfaces.extend(configurations)
        return first_taken(number, configurations)

    monkeypatch.setattr(open_domains, "confine_announcements", refuse)
    monkeypatch.setattr(open_domains, "_create_with_first_accepted", note)
    asyncio.run(join_network().close())
    assert interfaces
    assert not any("autodetermine" in configuration for configuration in interfaces)
