"""Counts of the entities that an executor waits for (rclpy ``waitable``)."""

from __future__ import annotations

from dataclasses import astuple, dataclass


@dataclass
class NumberOfEntities:
    """The number of entities of each kind.

    Two objects can be added with ``+``.
    """

    num_subscriptions: int = 0
    num_guard_conditions: int = 0
    num_timers: int = 0
    num_clients: int = 0
    num_services: int = 0
    num_events: int = 0

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        return NumberOfEntities(*(left + right for left, right in zip(astuple(self), astuple(other), strict=True)))
