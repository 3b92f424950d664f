"""The UDP sockets of a participant, and the addresses at which it looks for others."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

from linkwright.wire.dds.local_sockets import compute_multicast_port
from linkwright.wire.dds.rtps.values import Address
from linkwright.wire.dds.rtps.writer import Packet
from linkwright.wire.dds.settings import Range, Settings, find_own_addresses, max_participants

_LOOPBACK = "127.0.0.1"
_MULTICAST_GROUP = "239.255.0.1"
_FIRST_UNICAST, _PORTS_PER_PARTICIPANT = 10, 2
_MAX_SEARCHED = 33
"""The maximum number of processes to search for on a machine if ROS's variables set the range, as in Cyclone."""

_BUFFER_SIZE = 4 << 20
_MAX_PACKET_SIZE = 0x1_0000
_MAX_BURST_SIZE = 120_000
"""Bytes after which sending pauses, so that they fit into the receiver's buffer (by default 212 992 bytes)."""

_PAUSE_S = 0.001
_NETWORK_TTL = 32


@dataclass(frozen=True, slots=True)
class NetworkAddresses:
    """The addresses of a participant, and the addresses at which it looks for others.

    Attributes:
        own_hosts: the participant's addresses, without ports.
        ports: the ports at which others may listen.
        hosts: the unicast addresses of others.
        interfaces: the addresses of the interfaces through which multicast is sent.
        ttl: the time to live of multicast packets; 0 for this machine only.
        local_only: whether packets from other machines are ignored.
    """

    own_hosts: tuple[str, ...]
    ports: range
    hosts: tuple[str, ...]
    interfaces: tuple[str, ...]
    ttl: int
    local_only: bool


def addresses_from_settings(settings: Settings) -> NetworkAddresses:
    """Return the addresses that follow from the settings.

    See `docs/decisions/0011-dds.md`.
    """
    interface_addresses = tuple(find_own_addresses()[:3])
    is_localhost = settings.range is Range.LOCALHOST and bool(settings.peers)
    is_machine = settings.range is Range.MACHINE or (settings.range is Range.LOCALHOST and not is_localhost)
    first_port = compute_multicast_port(settings.domain_id) + _FIRST_UNICAST
    max_count = max_participants(settings.domain_id)
    count = max_count if is_machine else min(max_count, _MAX_SEARCHED)
    return NetworkAddresses(
        own_hosts=(_LOOPBACK,) if is_localhost or is_machine or not interface_addresses else interface_addresses,
        ports=range(first_port, first_port + _PORTS_PER_PARTICIPANT * count, _PORTS_PER_PARTICIPANT),
        hosts=(_LOOPBACK, *(interface_addresses if is_machine else ()), *_resolve_peers(settings.peers)),
        interfaces=() if is_localhost else (_LOOPBACK, *interface_addresses),
        ttl=0 if is_machine else _NETWORK_TTL,
        local_only=is_machine,
    )


def _resolve_peers(peers: Iterable[str]) -> list[str]:
    addresses = []
    for peer in peers:
        with suppress(OSError):
            addresses.append(socket.gethostbyname(peer))
    return addresses


class Network:
    """The UDP socket of a participant.

    Args:
        settings: the domain and the discovery range.

    Raises:
        OSError: no socket is available.
    """

    SOCKET = socket.socket
    """The class of the socket."""

    def __init__(self, settings: Settings) -> None:
        self._network_addresses = addresses_from_settings(settings)
        self._group = (_MULTICAST_GROUP, compute_multicast_port(settings.domain_id))
        self._local_hosts = {_LOOPBACK, *find_own_addresses()}
        self.socket = self.SOCKET(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self.socket.bind(
                (
                    _LOOPBACK
                    if self._network_addresses.own_hosts == (_LOOPBACK,) and not self._network_addresses.hosts[1:]
                    else "",
                    0,
                )
            )
            self.socket.setblocking(False)
            for option in (socket.SO_RCVBUF, socket.SO_SNDBUF):
                with suppress(OSError):
                    self.socket.setsockopt(socket.SOL_SOCKET, option, _BUFFER_SIZE)
            self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, self._network_addresses.ttl)
        except OSError:
            self.socket.close()
            raise
        port = self.socket.getsockname()[1]
        self.addresses: list[Address] = [(host, port) for host in self._network_addresses.own_hosts]

    def receive(self) -> tuple[bytes, Address] | None:
        """Return the next message and its sender, or None if no message is waiting."""
        while True:
            try:
                packet, source = self.socket.recvfrom(_MAX_PACKET_SIZE)
            except BlockingIOError:
                return None
            except OSError:
                continue  # A receiver of our packets no longer listens (Windows reports this here).
            if not self._network_addresses.local_only or self.is_local(source[0]):
                return packet, source

    def send(self, packets: Iterable[Packet]) -> None:
        """Send messages.

        A packet that the system refuses is lost, and readers request it again.
        """
        burst = 0
        for packet, addresses in packets:
            burst += len(packet)
            if burst > _MAX_BURST_SIZE:
                time.sleep(_PAUSE_S)
                burst = len(packet)
            for address in addresses:
                with suppress(OSError):
                    self.socket.sendto(packet, address)

    def send_everywhere(self, packet: bytes) -> None:
        """Send a message to every address where a participant may be."""
        self.send(
            [
                (
                    packet,
                    tuple(
                        (host, port) for host in self._network_addresses.hosts for port in self._network_addresses.ports
                    ),
                )
            ]
        )
        for interface in self._network_addresses.interfaces:
            with suppress(OSError):
                self.socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
                self.socket.sendto(packet, self._group)

    def choose_addresses(self, addresses: Iterable[Address]) -> tuple[Address, ...]:
        """Return the addresses to use for one receiver.

        The result is one address if the receiver is on this machine, otherwise all addresses.
        """
        unique_addresses = tuple(dict.fromkeys(addresses))
        local_addresses = sorted(
            (address for address in unique_addresses if self.is_local(address[0])),
            key=lambda address: address[0] != _LOOPBACK,
        )
        if local_addresses:
            return (local_addresses[0],)
        return () if self._network_addresses.local_only else unique_addresses

    def close(self) -> None:
        """Close the socket."""
        self.socket.close()

    def is_local(self, host: str) -> bool:
        """Return whether an address belongs to this machine."""
        return host in self._local_hosts or host.startswith("127.")
