"""The quality of service to subscribe with, given the publishers of a topic, as ros2cli chooses it."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy


@dataclass(frozen=True, slots=True)
class Fitting:
    """A profile that fits publishers.

    Attributes:
        profile: what to subscribe with.
        mixed: the policies in which the publishers differ, so that the weaker was taken: ``(offered by some, taken)``,
            named as rclpy's enumerations.
    """

    profile: QoSProfile
    mixed: tuple[tuple[str, str], ...] = ()


def fit(wanted: QoSProfile, offers: Sequence[QoSProfile]) -> Fitting:
    """The strongest reliability and durability that all of the publishers offer, for everything to come that can.

    Args:
        wanted: the rest of the profile, and all of it where there are no publishers.
        offers: what the publishers of the topic offer.
    """
    chosen = copy(wanted)
    if not offers:
        return Fitting(chosen)
    reliable = sum(offer.reliability is ReliabilityPolicy.RELIABLE for offer in offers)
    lasting = sum(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
    everybody = len(offers)
    chosen.reliability = ReliabilityPolicy.RELIABLE if reliable == everybody else ReliabilityPolicy.BEST_EFFORT
    chosen.durability = DurabilityPolicy.TRANSIENT_LOCAL if lasting == everybody else DurabilityPolicy.VOLATILE
    mixed = []
    if 0 < reliable < everybody:
        mixed.append(("QoSReliabilityPolicy.RELIABLE", "QoSReliabilityPolicy.BEST_EFFORT"))
    if 0 < lasting < everybody:
        mixed.append(("QoSDurabilityPolicy.TRANSIENT_LOCAL", "QoSDurabilityPolicy.VOLATILE"))
    return Fitting(chosen, tuple(mixed))
