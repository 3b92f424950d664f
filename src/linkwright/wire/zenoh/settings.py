"""The settings of Zenoh from the environment: domain, configuration, wait for a router.

The variables are those of rmw_zenoh_cpp. By default a session is configured as in rmw_zenoh_cpp, and also finds
Linkwright's sessions on this machine if no router is running (`docs/decisions/0066-zenoh.md`).
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.wire.domain_id import read_domain_id

ROUTER_PORT = 7447
"""The TCP port at which a router listens, and at which sessions search for a router."""

SESSION_FILE_VARIABLE = "ZENOH_SESSION_CONFIG_URI"
ROUTER_FILE_VARIABLE = "ZENOH_ROUTER_CONFIG_URI"
OVERRIDES_VARIABLE = "ZENOH_CONFIG_OVERRIDE"
ATTEMPTS_VARIABLE = "ZENOH_ROUTER_CHECK_ATTEMPTS"

_WITHOUT_HASHES = "humble"
_QUERY_TIMEOUT_MS = 600_000
_LEASE_MS = 60_000
_MAX_WAIT_US = 50_000
"""The time for which a publisher waits for space before it drops a message, in microseconds.

Zenoh's default of 1 ms is shorter than a busy machine may take to schedule the receiver.
"""

_MAX_FRAGMENTS_WAIT_US = 200_000
"""The same for a large message, each fragment of which waits."""

_DROP_KEY = "transport/link/tx/queue/congestion_control/drop"
_LOOPBACK = {"linux": "lo", "darwin": "lo0"}

Entries = tuple[tuple[str, str], ...]
"""Keys of a configuration, and their values in JSON5."""

_SHARED: Entries = (
    ("timestamping/enabled", "true"),
    ("queries_default_timeout", str(_QUERY_TIMEOUT_MS)),
    ("transport/link/tx/lease", str(_LEASE_MS)),
    ("transport/link/tx/keep_alive", "2"),
    ("transport/shared_memory/enabled", "false"),
)
_ROUTER: Entries = (
    ("mode", '"router"'),
    ("listen/endpoints", f'["tcp/localhost:{ROUTER_PORT}"]'),
    ("open/return_conditions/connect_scouted", "false"),
    ("scouting/delay", "0"),
    ("scouting/multicast/enabled", "false"),
    *_SHARED,
)


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a session.

    Attributes:
        domain_id: the ROS domain.
        config_file: the configuration file that replaces Linkwright's configuration; empty for none.
        default_entries: Linkwright's configuration.
        overrides: entries that are applied last, to either configuration.
        attempts: the number of checks for a router, a second apart, before continuing without one; None for no limit.
        has_type_hashes: whether types have a hash on the wire; in Humble they have none.
    """

    domain_id: int
    config_file: str = ""
    default_entries: Entries = ()
    overrides: Entries = ()
    attempts: int | None = 0
    has_type_hashes: bool = True


def read_settings(environment: Mapping[str, str] | None = None, *, domain_id: int | None = None) -> Settings:
    """Read the settings from environment variables.

    Args:
        environment: the variables; by default, the variables of this process.
        domain_id: the domain, which takes precedence over ROS_DOMAIN_ID; None for ROS_DOMAIN_ID.

    Raises:
        LinkwrightError: DDS101, the domain is not valid; DDS111, a variable is malformed.
    """
    variables = os.environ if environment is None else environment
    domain_id = read_domain_id(variables, domain_id)
    return Settings(
        domain_id=domain_id,
        config_file=_to_path(variables.get(SESSION_FILE_VARIABLE, "")),
        default_entries=_make_session_entries(domain_id),
        overrides=_read_overrides(variables),
        attempts=_read_attempts(variables),
        has_type_hashes=ASSUMED_DISTRIBUTION_VARIABLE in variables
        or variables.get("ROS_DISTRO", "").lower() != _WITHOUT_HASHES,
    )


def read_router_settings(environment: Mapping[str, str] | None = None) -> Settings:
    """Read the settings of a router.

    Raises:
        LinkwrightError: DDS111, a variable is malformed.
    """
    variables = os.environ if environment is None else environment
    return Settings(0, _to_path(variables.get(ROUTER_FILE_VARIABLE, "")), _ROUTER, _read_overrides(variables))


def _make_session_entries(domain_id: int) -> Entries:
    """Return the configuration of a peer that communicates only on this machine.

    The peer announces itself by multicast that never leaves the machine, at an address for its domain.
    """
    loopback = _LOOPBACK.get(sys.platform, "auto")
    return (
        ("mode", '"peer"'),
        ("connect/endpoints", f'["tcp/localhost:{ROUTER_PORT}"]'),
        ("connect/timeout_ms", "{router: -1, peer: -1, client: 0}"),
        ("connect/exit_on_failure", "{router: false, peer: false, client: true}"),
        ("listen/endpoints", '["tcp/localhost:0"]'),
        ("open/return_conditions/connect_scouted", "false"),
        ("scouting/multicast/enabled", "true"),
        ("scouting/multicast/interface", f'"{loopback}"'),
        ("scouting/multicast/address", f'"239.255.74.{domain_id}:{ROUTER_PORT - 1}"'),
        ("scouting/multicast/ttl", "0"),
        ("scouting/gossip/enabled", "true"),
        (f"{_DROP_KEY}/wait_before_drop", str(_MAX_WAIT_US)),
        (f"{_DROP_KEY}/max_wait_before_drop_fragments", str(_MAX_FRAGMENTS_WAIT_US)),
        *_SHARED,
    )


def _to_path(address: str) -> str:
    return address.removeprefix("file://")


def _read_overrides(variables: Mapping[str, str]) -> Entries:
    entries = []
    for item in variables.get(OVERRIDES_VARIABLE, "").split(";"):
        if not item.strip():
            continue
        key, equals, value = item.partition("=")
        if not equals or not key.strip():
            raise LinkwrightError(
                Diagnostic(
                    "DDS111",
                    phrase("'{item}' in {variable} is not a Zenoh setting", item=item, variable=OVERRIDES_VARIABLE),
                    hint=phrase('write it as key=value;key=value, such as mode="client"'),
                )
            )
        entries.append((key.strip(), value.strip()))
    return tuple(entries)


def _read_attempts(variables: Mapping[str, str]) -> int | None:
    """Return the number of checks for a router, or None for no limit.

    The default is 0, unlike in rmw_zenoh_cpp.
    """
    text = variables.get(ATTEMPTS_VARIABLE, "").strip()
    if not text:
        return 0
    try:
        number = int(text)
    except ValueError:
        raise LinkwrightError(
            Diagnostic(
                "DDS111",
                phrase("'{value}' in {variable} is not a number", value=text, variable=ATTEMPTS_VARIABLE),
                hint=phrase("write the number of attempts to find a router; 0 for no limit, -1 for no attempt"),
            )
        ) from None
    if number == 0:
        return None
    return max(number, 0)
