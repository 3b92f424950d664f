"""Bonds (bondcpp): the heartbeats that nav2's servers and their manager exchange.

Each end detects when the other process has died.

Both ends publish heartbeats on ``bond`` with the same id. An end that leaves sends a last message; an end that dies
stops publishing. Unlike in bondcpp, an end waits for the other without a timeout instead of 10 s, so either may start
first. The timeout is counted in the end's own heartbeats, so a suspended process does not consider the other end dead
when it resumes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from uuid import uuid4

from linkwright.graph import Clock, ClockType, Node
from linkwright.messages import get_message

TOPIC = "bond"
TIMEOUT_S = 4.0
"""The seconds without a heartbeat after which nav2 considers the other end dead."""
PERIOD_S = 0.1
"""The seconds between nav2's heartbeats."""
_QUEUE_DEPTH = 100


def _ignore_event() -> None:
    """Ignore an event."""


class Bond:
    """One end of a bond.

    Args:
        node: the node that exchanges the heartbeats.
        name: the id of the bond; with nav2, the name of the managed node.
        timeout: the seconds without a heartbeat after which the other end is considered dead.
        period: the seconds between heartbeats.
        on_formed: called once at the first heartbeat of the other end.
        on_broken: called once when the other end leaves or is considered dead; not after `end`.
    """

    def __init__(
        self,
        node: Node,
        name: str,
        *,
        timeout: float = TIMEOUT_S,
        period: float = PERIOD_S,
        on_formed: Callable[[], None] = _ignore_event,
        on_broken: Callable[[], None] = _ignore_event,
    ) -> None:
        status = get_message("bond/msg/Status")
        self._heartbeat = status(id=name, instance_id=str(uuid4()), heartbeat_timeout=timeout, heartbeat_period=period)
        self._on_formed, self._on_broken = on_formed, on_broken
        self._max_missed = max(1, round(timeout / period))
        self._missed_count = 0
        self._clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self.is_formed = False
        self.is_broken = False
        self._publisher = node.create_publisher(status, TOPIC, _QUEUE_DEPTH)
        self._subscription = node.create_subscription(status, TOPIC, self._receive, _QUEUE_DEPTH)
        self._subscription.deliver_in_batches()  # The heartbeats of all bonds in the system arrive on this topic.
        self._timer = node.create_timer(period, self._on_timer, clock=self._clock)
        self._send(is_active=True)

    def end(self) -> None:
        """Break the bond and notify the other end."""
        if not self.is_broken:
            self.is_broken = True
            self._send(is_active=False)
        for endpoint in (self._timer, self._subscription, self._publisher):
            endpoint.destroy()

    def _on_timer(self) -> None:
        if self.is_broken:
            return
        self._send(is_active=True)
        self._missed_count += 1
        if self.is_formed and self._missed_count > self._max_missed:
            self._break()

    def _receive(self, message: Any) -> None:
        if message.id != self._heartbeat.id or message.instance_id == self._heartbeat.instance_id or self.is_broken:
            return
        self._missed_count = 0
        if not message.active:
            if self.is_formed:
                self._send(is_active=False)
                self._break()
        elif not self.is_formed:
            self.is_formed = True
            # Answer immediately, so that the other end need not wait for the next heartbeat.
            self._send(is_active=True)
            self._on_formed()

    def _break(self) -> None:
        self.is_broken = True
        self._on_broken()

    def _send(self, *, is_active: bool) -> None:
        self._heartbeat.active = is_active
        self._heartbeat.header.stamp = self._clock.now().to_msg()
        self._publisher.publish(self._heartbeat)
