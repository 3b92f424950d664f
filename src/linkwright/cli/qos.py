"""The options ``--qos-...`` of ``topic echo``, ``topic pub`` and other commands."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from copy import copy
from typing import TYPE_CHECKING

from linkwright.cli.numbers import unsigned_int

if TYPE_CHECKING:
    from linkwright.graph import Node, QoSProfile

_PROFILES = (
    "unknown",
    "default",
    "system_default",
    "sensor_data",
    "services_default",
    "parameters",
    "parameter_events",
    "action_status_default",
    "best_available",
)
_HISTORY = ("system_default", "keep_last", "keep_all", "unknown")
_RELIABILITY = ("system_default", "reliable", "best_effort", "unknown", "best_available")
_DURABILITY = ("system_default", "transient_local", "volatile", "unknown", "best_available")
_LIVELINESS = ("system_default", "automatic", "manual_by_topic", "unknown", "best_available")

_MIN_QUEUE_DEPTH = 100
"""The minimum queue depth of a subscribing command that does not set a policy."""
_POLICY_OPTIONS = ("qos_reliability", "qos_durability", "qos_depth", "qos_history", "qos_liveliness")
_LEASE_OPTION = "qos_liveliness_lease_duration_seconds"


def add_publisher_qos_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the QoS options of a publishing command; see `create_profile`."""
    _add_arguments(
        parser,
        "default",
        profile_help="the profile to publish with (default: %(default)s): %(choices)s",
        reliability_help="whether delivery is guaranteed: %(choices)s",
        durability_help="whether late joiners receive earlier messages: %(choices)s",
    )


def add_subscription_qos_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the QoS options of a subscribing command; see `create_fitting_profile`."""
    _add_arguments(
        parser,
        "sensor_data",
        profile_help="the profile to subscribe with (default: %(default)s): %(choices)s",
        reliability_help="whether delivery is guaranteed (default: the publishers' policy, if they agree): %(choices)s",
        durability_help="whether late joiners receive earlier messages (default: the publishers' policy, if "
        "they agree): %(choices)s",
    )


def _add_arguments(
    parser: argparse.ArgumentParser, default: str, *, profile_help: str, reliability_help: str, durability_help: str
) -> None:
    def add_policy(name: str, values: Sequence[str], *, help: str) -> None:  # noqa: A002 - argparse's name
        group.add_argument(f"--qos-{name}", metavar="POLICY", choices=values, help=help)

    group = parser.add_argument_group(title="quality of service")
    group.add_argument("--qos-profile", metavar="PROFILE", choices=_PROFILES, default=default, help=profile_help)
    group.add_argument("--qos-depth", metavar="N", type=unsigned_int, help="the queue depth")
    add_policy("history", _HISTORY, help="which samples to keep: %(choices)s")
    add_policy("reliability", _RELIABILITY, help=reliability_help)
    add_policy("durability", _DURABILITY, help=durability_help)
    add_policy("liveliness", _LIVELINESS, help="how publishers assert that they are alive: %(choices)s")
    group.add_argument(
        "--qos-liveliness-lease-duration-seconds",
        metavar="SECONDS",
        type=float,
        help="the time within which a publisher must assert its liveliness",
    )


def create_profile(arguments: argparse.Namespace) -> QoSProfile:
    """Return the QoS profile that the options set."""
    from linkwright.graph.qos import profile as qos
    from linkwright.graph.time.values import Duration

    qos_profile = copy(qos.QoSPresetProfiles.get_from_short_key(arguments.qos_profile))
    if arguments.qos_history is not None:
        qos_profile.history = qos.HistoryPolicy[arguments.qos_history.upper()]
    if arguments.qos_reliability is not None:
        qos_profile.reliability = qos.ReliabilityPolicy[arguments.qos_reliability.upper()]
    if arguments.qos_durability is not None:
        qos_profile.durability = qos.DurabilityPolicy[arguments.qos_durability.upper()]
    if arguments.qos_liveliness is not None:
        qos_profile.liveliness = qos.LivelinessPolicy[arguments.qos_liveliness.upper()]
    lease = getattr(arguments, _LEASE_OPTION)
    if lease is not None and lease >= 0:
        qos_profile.liveliness_lease_duration = Duration(seconds=lease)
    if arguments.qos_depth:
        qos_profile.depth = arguments.qos_depth
    elif qos_profile.durability is qos.DurabilityPolicy.TRANSIENT_LOCAL and qos_profile.depth == 0:
        qos_profile.depth = 1
    return qos_profile


def create_fitting_profile(node: Node, topic: str, arguments: argparse.Namespace) -> QoSProfile:
    """Return the QoS profile of a subscription that is compatible with the topic's publishers.

    If the options set a policy, the result is the profile of the options. If they set none, each policy is the
    strictest that all publishers offer. As in ros2cli, the subscription is reliable and transient local if all
    publishers are, so that it also receives a message that was published before. The default queue is longer than in
    ros2, so that bursts of messages are not dropped.
    """
    from linkwright.graph.qos.compatibility import fit_profile

    requested_profile = create_profile(arguments)
    if any(getattr(arguments, name) is not None for name in (*_POLICY_OPTIONS, _LEASE_OPTION)):
        return requested_profile
    requested_profile.depth = max(requested_profile.depth, _MIN_QUEUE_DEPTH)
    fitted = fit_profile(requested_profile, [info.qos_profile for info in node.get_publishers_info_by_topic(topic)])
    for offered_policies, chosen_policy in fitted.mixed:
        print(
            f"Some, but not all, publishers are offering {offered_policies}. Falling back to "
            f"{chosen_policy} as it will connect to all "
            "publishers",
            file=sys.stderr,
        )
    return fitted.profile
