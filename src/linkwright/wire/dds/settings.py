"""The settings of DDS from the environment: domain, discovery range, Cyclone configuration.

By default, a process communicates only inside its machine; `docs/decisions/0011-dds.md` explains the parts of the
configuration. If ROS's own variables set the range, they are applied as in rmw_cyclonedds_cpp.
"""

from __future__ import annotations

import os
import socket
import struct
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from linkwright.diagnostics import did_you_mean
from linkwright.messages import is_before_iron
from linkwright.wire.dds.discovery_info import GID_SIZE, OLD_GID_SIZE
from linkwright.wire.domain_id import read_domain_id

_MAX_PARTICIPANTS = 99
"""The maximum number of processes on one machine that find each other without multicast.

The highest domains have ports for fewer processes.
"""

_LAST_PORT = 0xFFFF
_FIRST_UNICAST_PORT = 7411
_PORTS_OF_A_DOMAIN = 250

_FRAGMENT_SIZE = 60_000
"""The maximum size, in bytes, of a sample that is sent in one packet, if the configuration is Linkwright's."""

_CYCLONE_FRAGMENT_SIZE = 1344
"""The same, if Cyclone chooses the size."""

LEASE_S = 5
"""Seconds of silence after which a process counts as gone, if the configuration is Linkwright's."""

_STATIC_PEERS_SEPARATOR = ";"


def max_participants(domain_id: int) -> int:
    """Return the maximum number of participants of a domain on one machine.

    Each participant uses two ports, and only a few ports are left for the highest domains. The ports are those of RTPS
    (DDSI-RTPS 2.5, 9.6.1).
    """
    return min(_MAX_PARTICIPANTS, (_LAST_PORT - _FIRST_UNICAST_PORT - _PORTS_OF_A_DOMAIN * domain_id) // 2)


class Range(Enum):
    """The range of discovery (ROS_AUTOMATIC_DISCOVERY_RANGE)."""

    MACHINE = "machine"
    """Linkwright's default: this machine, through all its interfaces."""

    LOCALHOST = "LOCALHOST"
    SUBNET = "SUBNET"
    OFF = "OFF"
    SYSTEM_DEFAULT = "SYSTEM_DEFAULT"


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a participant.

    Attributes:
        domain_id: the DDS domain.
        range: the range of discovery.
        configurations: XML fragments for Cyclone; the first one that Cyclone accepts is used.
        gid_size: the size in bytes of a gid in ``ros_discovery_info`` until a ROS 2 node is discovered.
        warnings: warnings for the user.
        user_configuration: the value of CYCLONEDDS_URI.
        own_configurations: the fragments without the user's configuration.
        peers: other machines to contact without multicast.
        enclave: the security enclave of the nodes.
        fragment_size: the size in bytes up to which a sample always fits into one packet.
        loopback_configurations: the configurations that use loopback only; empty if discovery may leave the machine.
    """

    domain_id: int
    range: Range
    configurations: tuple[str, ...]
    gid_size: int
    warnings: tuple[str, ...] = ()
    user_configuration: str = ""
    own_configurations: tuple[str, ...] = ()
    peers: tuple[str, ...] = ()
    enclave: str = "/"
    fragment_size: int = _CYCLONE_FRAGMENT_SIZE
    loopback_configurations: tuple[str, ...] = ()


def read_settings(environment: Mapping[str, str] | None = None, *, domain_id: int | None = None) -> Settings:
    """Read the settings from environment variables.

    Args:
        environment: the variables; by default, the variables of this process.
        domain_id: the domain, which takes precedence over ROS_DOMAIN_ID; None for ROS_DOMAIN_ID.

    Raises:
        LinkwrightError: DDS101, the domain is not valid.
    """
    variables = os.environ if environment is None else environment
    warnings: list[str] = []
    discovery_range = _read_range(variables, warnings)
    peers = [peer for peer in variables.get("ROS_STATIC_PEERS", "").split(_STATIC_PEERS_SEPARATOR) if peer]
    if peers and discovery_range in (Range.OFF, Range.SYSTEM_DEFAULT):
        warnings.append(
            f"{len(peers)} static peers were specified, but discovery is {discovery_range.value}: they are ignored"
        )
    user = variables.get("CYCLONEDDS_URI", "")
    domain_id = read_domain_id(variables, domain_id)
    own_configurations = tuple(_make_configurations(discovery_range, peers, max_participants(domain_id)))
    configurations = tuple(
        ",".join(fragment for fragment in (configuration, user) if fragment) for configuration in own_configurations
    )
    return Settings(
        domain_id=domain_id,
        range=discovery_range,
        configurations=configurations,
        gid_size=OLD_GID_SIZE if is_before_iron(variables) else GID_SIZE,
        warnings=tuple(warnings),
        user_configuration=user,
        own_configurations=own_configurations,
        peers=() if discovery_range in (Range.OFF, Range.SYSTEM_DEFAULT) else tuple(peers),
        fragment_size=_FRAGMENT_SIZE if not user and _is_local_only(discovery_range, peers) else _CYCLONE_FRAGMENT_SIZE,
        loopback_configurations=configurations[-_LOOPBACK_CONFIGURATIONS:]
        if _is_local_only(discovery_range, peers)
        else (),
    )


def _read_range(variables: Mapping[str, str], warnings: list[str]) -> Range:
    """Return the discovery range, from ROS_LOCALHOST_ONLY or ROS_AUTOMATIC_DISCOVERY_RANGE.

    As in rcl, ROS_LOCALHOST_ONLY takes precedence.
    """
    localhost_only = variables.get("ROS_LOCALHOST_ONLY", "")
    if localhost_only == "1":
        return Range.LOCALHOST
    range_name = variables.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if range_name:
        choices = [choice.value for choice in Range if choice is not Range.MACHINE]
        if range_name in choices:
            return Range(range_name)
        hint = did_you_mean(range_name, choices)
        warnings.append(
            f"Invalid value '{range_name}' specified for 'ROS_AUTOMATIC_DISCOVERY_RANGE', assuming localhost only"
            + (f" ({hint})" if hint else "")
        )
        return Range.LOCALHOST
    if localhost_only or variables.get("CYCLONEDDS_URI") or variables.get("ROS_STATIC_PEERS"):
        return Range.SUBNET
    return Range.MACHINE


_AUTO_INDEX = "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{0}</MaxAutoParticipantIndex>"

_ANNOUNCEMENT_INTERVAL = "<SPDPInterval>3 s</SPDPInterval>"
"""The interval at which a process announces itself outside this machine, as in Fast DDS."""

_THIS_MACHINE = '<Peer address="127.0.0.1" PruneDelay="inf"/>'
"""The element that lets a process announce itself to the ports of this machine.

Announcements continue for as long as the process lives.

A node of Fast DDS on LOCALHOST announces itself on loopback alone, and Cyclone ignores packets on loopback unless
loopback is one of its interfaces. So this process announces itself to the node, which answers at this process's address
on the network. If loopback were an interface, its address would be announced to the network, and Fast DDS on other
machines would also send all data to their own loopback.
"""

_RELIABLE_TRAFFIC = (
    "<Internal><Watermarks><WhcHigh>16 MB</WhcHigh><WhcHighInit>1 MB</WhcHighInit></Watermarks>"
    "<HeartbeatInterval minsched='5 ms'>10 ms</HeartbeatInterval><BurstSize><MaxRexmit>200 kB</MaxRexmit></BurstSize>"
    "<SocketReceiveBufferSize max='8 MB'/></Internal>"
)
"""Settings of reliable writers.

More than Cyclone's half megabyte may wait for acknowledgment, because a single image is larger. While acknowledgments
are missing, they are requested every 10 ms instead of every 100 ms. Retransmissions are limited to portions that fit
into Linux's default receive buffer.
"""

_MAX_OWN_ADDRESSES = 3
"""The maximum number of addresses besides loopback at which processes of this machine are contacted."""

_LOOPBACK_CONFIGURATIONS = 2
"""The number of configurations for this machine that use only loopback; they come last."""

_LOOPBACK = '<NetworkInterface address="127.0.0.1" multicast="true"/>'
_OTHER_INTERFACES = '<NetworkInterface autodetermine="true"/>'


def _make_machine_configuration(interfaces: str, addresses: list[str], max_index: int, *, multicast: bool) -> str:
    """Return a configuration for discovery on this machine.

    Discovery uses unicast to each participant index at the machine's own addresses, and multicast that never leaves the
    machine (TTL 0). Multicast is received on loopback only, so that announcements of other machines are ignored.
    """
    peers = "".join(f'<Peer address="{address}"/>' for address in ("127.0.0.1", *addresses))
    multicast_elements = (
        "<AllowMulticast>spdp</AllowMulticast><MulticastTimeToLive>0</MulticastTimeToLive>"
        "<MulticastRecvNetworkInterfaceAddresses>127.0.0.1</MulticastRecvNetworkInterfaceAddresses>"
        if multicast
        else "<AllowMulticast>false</AllowMulticast>"
    )
    return (
        f"<CycloneDDS><Domain><General><Interfaces>{interfaces}</Interfaces>{multicast_elements}"
        f"<MaxMessageSize>65000 B</MaxMessageSize><FragmentSize>{_FRAGMENT_SIZE} B</FragmentSize></General>"
        f"<Discovery>{_AUTO_INDEX.format(max_index)}<LeaseDuration>{LEASE_S} s</LeaseDuration>"
        f"<Peers>{peers}</Peers></Discovery>"
        f"{_RELIABLE_TRAFFIC}</Domain></CycloneDDS>"
    )


def _is_local_only(discovery_range: Range, peers: list[str]) -> bool:
    """Return whether discovery is restricted to processes of this machine."""
    return discovery_range is Range.MACHINE or (discovery_range is Range.LOCALHOST and not peers)


def _make_configurations(discovery_range: Range, peers: list[str], max_index: int) -> list[str]:
    """Return the configurations in order of preference, without the user's own configuration."""
    if _is_local_only(discovery_range, peers):
        addresses = find_own_addresses()[:_MAX_OWN_ADDRESSES]
        loopback_only = [
            _make_machine_configuration(_LOOPBACK, [], max_index, multicast=True),
            _make_machine_configuration('<NetworkInterface address="127.0.0.1"/>', [], max_index, multicast=False),
        ]
        on_network = (
            [_make_machine_configuration(_LOOPBACK + _OTHER_INTERFACES, addresses, max_index, multicast=True)]
            if addresses
            else []
        )
        return on_network + loopback_only
    if discovery_range is Range.SYSTEM_DEFAULT:
        return [""]
    if discovery_range is Range.OFF:
        off = (
            "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General>"
            "<Discovery><ParticipantIndex>none</ParticipantIndex>"
            f"<Tag>ros_discovery_off_{os.getpid()}</Tag></Discovery></Domain></CycloneDDS>"
        )
        return [off]
    from xml.sax.saxutils import quoteattr  # imported here because it loads modules of urllib, which are rarely needed

    local = discovery_range is Range.LOCALHOST
    peer_elements = _THIS_MACHINE + "".join(f"<Peer address={quoteattr(peer)} PruneDelay='inf'/>" for peer in peers)
    return [
        "<CycloneDDS><Domain>"
        + ("<General><AllowMulticast>false</AllowMulticast></General>" if local else "")
        + f"<Discovery>{_AUTO_INDEX.format(32)}{_ANNOUNCEMENT_INTERVAL}<Peers>{peer_elements}</Peers>"
        + "</Discovery></Domain></CycloneDDS>"
    ]


_SIOCGIFADDR = 0x8915
_REQUEST_FORMAT = "256s"


def find_own_addresses() -> list[str]:
    """Return the IPv4 addresses of the interfaces other than loopback, in the system's order.

    Cyclone prints an error if an interface in its configuration does not exist. A process that is configured to stay on
    the machine may be reachable only at the address of its interface.
    """
    addresses = _query_interface_addresses() if sys.platform.startswith("linux") else _resolve_own_addresses()
    return [address for address in dict.fromkeys(addresses) if address and not address.startswith("127.")]


def _query_interface_addresses() -> list[str]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as query_socket:
        return [_query_address(query_socket, name) for _, name in socket.if_nameindex()]


def _query_address(query_socket: socket.socket, name: str) -> str:
    """Return the address of an interface, or an empty string if the interface has none."""
    from fcntl import ioctl

    try:
        response = ioctl(query_socket.fileno(), _SIOCGIFADDR, struct.pack(_REQUEST_FORMAT, name.encode()[:15]))
    except OSError:
        return ""
    return socket.inet_ntoa(response[20:24])


def _resolve_own_addresses() -> list[str]:
    try:
        results = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        return []
    return [str(address[0]) for *_, address in results]
