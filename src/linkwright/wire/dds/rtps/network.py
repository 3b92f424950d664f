"""The UDP sockets of a participant, and the addresses at which it looks for others."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

from linkwright.wire.dds.local_sockets import multicast_port
from linkwright.wire.dds.rtps.values import Address
from linkwright.wire.dds.rtps.writer import Packet
from linkwright.wire.dds.settings import Range, Settings, max_participants, own_addresses

_LOOPBACK = "127.0.0.1"
_GROUP = "239.255.0.1"
_FIRST_UNICAST, _PORTS_EACH = 10, 2
_FEW = 33
"""How many processes of a machine are looked for where ROS's variables set the range, as Cyclone does then."""

_BUFFER = 4 << 20
_LARGEST = 0x1_0000
_BURST = 120_000
"""Bytes after which sending pauses, so that they fit the buffer of the receiver; the usual one holds 212 992."""

_PAUSE = 0.001
_NETWORK_TTL = 32


@dataclass(frozen=True, slots=True)
class Places:
    """The addresses of a participant, and the addresses at which it looks for others.

    Attributes:
        own: the participant's addresses, without ports.
        ports: the ports at which others may listen.
        hosts: the unicast addresses of others.
        interfaces: the addresses of the interfaces through which multicast is sent.
        ttl: the time to live of multicast packets; 0 for this machine only.
        only_here: whether packets from other machines are ignored.
    """

    own: tuple[str, ...]
    ports: range
    hosts: tuple[str, ...]
    interfaces: tuple[str, ...]
    ttl: int
    only_here: bool


def addresses_from_settings(settings: Settings) -> Places:
    """Return the addresses that follow from the settings; see `docs/decisions/0011-dds.md`."""
    others = tuple(own_addresses()[:3])
    local = settings.range is Range.LOCALHOST and bool(settings.peers)
    machine = settings.range is Range.MACHINE or (settings.range is Range.LOCALHOST and not local)
    first = multicast_port(settings.domain_id) + _FIRST_UNICAST
    most = max_participants(settings.domain_id)
    count = most if machine else min(most, _FEW)
    return Places(
        own=(_LOOPBACK,) if local or machine or not others else others,
        ports=range(first, first + _PORTS_EACH * count, _PORTS_EACH),
        hosts=(_LOOPBACK, *(others if machine else ()), *_resolved(settings.peers)),
        interfaces=() if local else (_LOOPBACK, *others),
        ttl=0 if machine else _NETWORK_TTL,
        only_here=machine,
    )


def _resolved(peers: Iterable[str]) -> list[str]:
    found = []
    for peer in peers:
        with suppress(OSError):
            found.append(socket.gethostbyname(peer))
    return found


class Network:
    """The UDP socket of a participant.

    Args:
        settings: the domain and the discovery range.

    Raises:
        OSError: no socket is available.
    """

    SOCKET = socket.socket
    """The class of its socket."""

    def __init__(self, settings: Settings) -> None:
        self._places = addresses_from_settings(settings)
        self._group = (_GROUP, multicast_port(settings.domain_id))
        self._here = {_LOOPBACK, *own_addresses()}
        self.socket = self.SOCKET(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self.socket.bind((_LOOPBACK if self._places.own == (_LOOPBACK,) and not self._places.hosts[1:] else "", 0))
            self.socket.setblocking(False)
            for option in (socket.SO_RCVBUF, socket.SO_SNDBUF):
                with suppress(OSError):
                    self.socket.setsockopt(socket.SOL_SOCKET, option, _BUFFER)
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, self._places.ttl)
        except OSError:
            self.socket.close()
            raise
        port = self.socket.getsockname()[1]
        self.addresses: list[Address] = [(host, port) for host in self._places.own]

    def receive(self) -> tuple[bytes, Address] | None:
        """Return the next message and its sender; None if there is none."""
        while True:
            try:
                packet, source = self.socket.recvfrom(_LARGEST)
            except BlockingIOError:
                return None
            except OSError:
                continue  # A receiver of our packets no longer listens (Windows reports this here).
            if not self._places.only_here or self.is_here(source[0]):
                return packet, source

    def send(self, packets: Iterable[Packet]) -> None:
        """Send messages. A packet that the system refuses is lost, and readers request it again."""
        burst = 0
        for packet, addresses in packets:
            burst += len(packet)
            if burst > _BURST:
                time.sleep(_PAUSE)
                burst = len(packet)
            for address in addresses:
                with suppress(OSError):
                    self.socket.sendto(packet, address)

    def send_everywhere(self, packet: bytes) -> None:
        """Send a message to every address where a participant may be."""
        self.send([(packet, tuple((host, port) for host in self._places.hosts for port in self._places.ports))])
        for interface in self._places.interfaces:
            with suppress(OSError):
                self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
                self.socket.sendto(packet, self._group)

    def best_of(self, addresses: Iterable[Address]) -> tuple[Address, ...]:
        """Return the addresses to use for one receiver: one on this machine if any, otherwise all."""
        known = tuple(dict.fromkeys(addresses))
        here = sorted(
            (address for address in known if self.is_here(address[0])), key=lambda address: address[0] != _LOOPBACK
        )
        if here:
            return (here[0],)
        return () if self._places.only_here else known

    def close(self) -> None:
        """Close the socket."""
        self.socket.close()

    def is_here(self, host: str) -> bool:
        """Return whether an address belongs to this machine."""
        return host in self._here or host.startswith("127.")
