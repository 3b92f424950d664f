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

_PARTICIPANTS = 99
"""How many processes on one machine find each other without multicast, where the domain has ports for them."""

_LAST_PORT = 0xFFFF
_FIRST_UNICAST_PORT = 7411
_PORTS_OF_A_DOMAIN = 250

_FRAGMENT_SIZE = 60_000
"""Bytes of a sample that go into one packet where the configuration is our own; larger ones go in several."""

_CYCLONES_FRAGMENT_SIZE = 1344
"""The same where Cyclone chooses."""

LEASE = 5
"""Seconds of silence after which a process counts as gone, where the configuration is our own."""

_STATIC_PEERS_SEPARATOR = ";"


def max_participants(domain_id: int) -> int:
    """Return the maximum number of participants of a domain on one machine.

    Each participant uses two ports, and only a few ports are left for the highest domains. The ports are those of RTPS
    (DDSI-RTPS 2.5, 9.6.1).
    """
    return min(_PARTICIPANTS, (_LAST_PORT - _FIRST_UNICAST_PORT - _PORTS_OF_A_DOMAIN * domain_id) // 2)


class Range(Enum):
    """The range in which other participants are looked for (ROS_AUTOMATIC_DISCOVERY_RANGE)."""

    MACHINE = "machine"
    """Our own default: this machine, on all its ways."""

    LOCALHOST = "LOCALHOST"
    SUBNET = "SUBNET"
    OFF = "OFF"
    SYSTEM_DEFAULT = "SYSTEM_DEFAULT"


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a participant.

    Attributes:
        domain_id: the DDS domain.
        range: the range in which other participants are looked for.
        configurations: XML fragments for Cyclone; the first one that Cyclone accepts is used.
        gid_size: the size in bytes of a gid in ``ros_discovery_info`` until a ROS 2 node is discovered.
        warnings: warnings for the user.
        user_configuration: the value of CYCLONEDDS_URI.
        own_configurations: the fragments without the user's configuration.
        peers: other machines to contact without multicast.
        enclave: the security enclave of the nodes.
        fragment_size: the size in bytes up to which a sample always fits into one packet.
        on_loopback: the configurations that use loopback only; empty if discovery may leave the machine.
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
    fragment_size: int = _CYCLONES_FRAGMENT_SIZE
    on_loopback: tuple[str, ...] = ()


def read_settings(environment: Mapping[str, str] | None = None, *, domain_id: int | None = None) -> Settings:
    """Read the settings from environment variables.

    Args:
        environment: the variables; those of this process if omitted.
        domain_id: the domain, which takes precedence over ROS_DOMAIN_ID; None for ROS_DOMAIN_ID.

    Raises:
        LinkwrightError: DDS101, the domain is not valid.
    """
    variables = os.environ if environment is None else environment
    warnings: list[str] = []
    reach = _range(variables, warnings)
    peers = [peer for peer in variables.get("ROS_STATIC_PEERS", "").split(_STATIC_PEERS_SEPARATOR) if peer]
    if peers and reach in (Range.OFF, Range.SYSTEM_DEFAULT):
        warnings.append(f"{len(peers)} static peers were specified, but discovery is {reach.value}: they are ignored")
    user = variables.get("CYCLONEDDS_URI", "")
    domain_id = read_domain_id(variables, domain_id)
    own = tuple(_configurations(reach, peers, max_participants(domain_id)))
    configurations = tuple(",".join(part for part in (configuration, user) if part) for configuration in own)
    return Settings(
        domain_id=domain_id,
        range=reach,
        configurations=configurations,
        gid_size=OLD_GID_SIZE if is_before_iron(variables) else GID_SIZE,
        warnings=tuple(warnings),
        user_configuration=user,
        own_configurations=own,
        peers=() if reach in (Range.OFF, Range.SYSTEM_DEFAULT) else tuple(peers),
        fragment_size=_FRAGMENT_SIZE if not user and _stays_here(reach, peers) else _CYCLONES_FRAGMENT_SIZE,
        on_loopback=configurations[-_ON_LOOPBACK:] if _stays_here(reach, peers) else (),
    )


def _range(variables: Mapping[str, str], warnings: list[str]) -> Range:
    """Return the discovery range, from ROS_LOCALHOST_ONLY or ROS_AUTOMATIC_DISCOVERY_RANGE.

    As in rcl, ROS_LOCALHOST_ONLY takes precedence.
    """
    localhost_only = variables.get("ROS_LOCALHOST_ONLY", "")
    if localhost_only == "1":
        return Range.LOCALHOST
    named = variables.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "")
    if named:
        choices = [choice.value for choice in Range if choice is not Range.MACHINE]
        if named in choices:
            return Range(named)
        hint = did_you_mean(named, choices)
        warnings.append(
            f"Invalid value '{named}' specified for 'ROS_AUTOMATIC_DISCOVERY_RANGE', assuming localhost only"
            + (f" ({hint})" if hint else "")
        )
        return Range.LOCALHOST
    if localhost_only or variables.get("CYCLONEDDS_URI") or variables.get("ROS_STATIC_PEERS"):
        return Range.SUBNET
    return Range.MACHINE


_AUTO_INDEX = "<ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>{0}</MaxAutoParticipantIndex>"

_REPEATED = "<SPDPInterval>3 s</SPDPInterval>"
"""How often a process announces itself where that goes beyond the machine: as often as Fast DDS does."""

_THIS_MACHINE = '<Peer address="127.0.0.1" PruneDelay="inf"/>'
"""The ports of this machine, for as long as the process lives.

A node of Fast DDS on LOCALHOST announces itself on loopback alone, and Cyclone ignores packets on loopback unless
loopback is one of its interfaces. So we announce ourselves to it, and it answers at our address on the network. Were
loopback an interface, its address would be announced to the network, and Fast DDS on other machines sends all data to
their own loopback as well.
"""

_RELIABLE_TRAFFIC = (
    "<Internal><Watermarks><WhcHigh>16 MB</WhcHigh><WhcHighInit>1 MB</WhcHighInit></Watermarks>"
    "<HeartbeatInterval minsched='5 ms'>10 ms</HeartbeatInterval><BurstSize><MaxRexmit>200 kB</MaxRexmit></BurstSize>"
    "<SocketReceiveBufferSize max='8 MB'/></Internal>"
)
"""More than Cyclone's half megabyte may wait for acknowledgement, for an image alone is larger; readers are asked for
acknowledgements every 10 ms in place of 100, for as long as any are missing; and what is sent again goes in portions
that fit the receive buffer of a process with Linux's default."""

_OWN_ADDRESSES = 3
"""At how many addresses besides loopback others of this machine are looked for."""

_ON_LOOPBACK = 2
"""How many of the configurations for this machine use loopback alone; they come last."""

_LOOPBACK = '<NetworkInterface address="127.0.0.1" multicast="true"/>'
_OTHERS = '<NetworkInterface autodetermine="true"/>'


def _machine(interfaces: str, addresses: list[str], most: int, *, multicast: bool) -> str:
    """Return a configuration for discovery on this machine.

    Discovery uses unicast to each participant index at the machine's own addresses, and multicast that never leaves the
    machine (TTL 0). Multicast is received on loopback only, so that announcements of other machines are ignored.
    """
    peers = "".join(f'<Peer address="{address}"/>' for address in ("127.0.0.1", *addresses))
    by_multicast = (
        "<AllowMulticast>spdp</AllowMulticast><MulticastTimeToLive>0</MulticastTimeToLive>"
        "<MulticastRecvNetworkInterfaceAddresses>127.0.0.1</MulticastRecvNetworkInterfaceAddresses>"
        if multicast
        else "<AllowMulticast>false</AllowMulticast>"
    )
    return (
        f"<CycloneDDS><Domain><General><Interfaces>{interfaces}</Interfaces>{by_multicast}"
        f"<MaxMessageSize>65000 B</MaxMessageSize><FragmentSize>{_FRAGMENT_SIZE} B</FragmentSize></General>"
        f"<Discovery>{_AUTO_INDEX.format(most)}<LeaseDuration>{LEASE} s</LeaseDuration>"
        f"<Peers>{peers}</Peers></Discovery>"
        f"{_RELIABLE_TRAFFIC}</Domain></CycloneDDS>"
    )


def _stays_here(reach: Range, peers: list[str]) -> bool:
    """Return whether discovery is restricted to processes of this machine."""
    return reach is Range.MACHINE or (reach is Range.LOCALHOST and not peers)


def _configurations(reach: Range, peers: list[str], most: int) -> list[str]:
    """Return the configurations in order of preference, without the user's own configuration."""
    if _stays_here(reach, peers):
        addresses = own_addresses()[:_OWN_ADDRESSES]
        loopback_alone = [
            _machine(_LOOPBACK, [], most, multicast=True),
            _machine('<NetworkInterface address="127.0.0.1"/>', [], most, multicast=False),
        ]
        on_network = [_machine(_LOOPBACK + _OTHERS, addresses, most, multicast=True)] if addresses else []
        return on_network + loopback_alone
    if reach is Range.SYSTEM_DEFAULT:
        return [""]
    if reach is Range.OFF:
        off = (
            "<CycloneDDS><Domain><General><AllowMulticast>false</AllowMulticast></General>"
            "<Discovery><ParticipantIndex>none</ParticipantIndex>"
            f"<Tag>ros_discovery_off_{os.getpid()}</Tag></Discovery></Domain></CycloneDDS>"
        )
        return [off]
    from xml.sax.saxutils import quoteattr  # imported here: it loads modules of urllib, which are rarely needed

    local = reach is Range.LOCALHOST
    listed = _THIS_MACHINE + "".join(f"<Peer address={quoteattr(peer)} PruneDelay='inf'/>" for peer in peers)
    return [
        "<CycloneDDS><Domain>"
        + ("<General><AllowMulticast>false</AllowMulticast></General>" if local else "")
        + f"<Discovery>{_AUTO_INDEX.format(32)}{_REPEATED}<Peers>{listed}</Peers></Discovery></Domain></CycloneDDS>"
    ]


_SIOCGIFADDR = 0x8915
_REQUEST = "256s"


def own_addresses() -> list[str]:
    """Return the IPv4 addresses of the interfaces other than loopback, in the system's order.

    Cyclone prints an error if it is given an interface that does not exist. A process that is configured to stay on the
    machine may be reachable only at the address of its interface.
    """
    addresses = _interface_addresses() if sys.platform.startswith("linux") else _by_name()
    return [address for address in dict.fromkeys(addresses) if address and not address.startswith("127.")]


def _interface_addresses() -> list[str]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
        return [_address(asking, name) for _, name in socket.if_nameindex()]


def _address(asking: socket.socket, name: str) -> str:
    """Return the address of an interface; empty if the interface has none."""
    from fcntl import ioctl

    try:
        answer = ioctl(asking.fileno(), _SIOCGIFADDR, struct.pack(_REQUEST, name.encode()[:15]))
    except OSError:
        return ""
    return socket.inet_ntoa(answer[20:24])


def _by_name() -> list[str]:
    try:
        found = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        return []
    return [str(address[0]) for *_, address in found]
