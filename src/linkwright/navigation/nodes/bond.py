"""Bonds (bondcpp), by which nav2's servers and their manager detect that the other process died.

Both sides publish heartbeats on ``bond`` with the same id. A side that leaves sends a last message; a side that dies
stops publishing. Unlike in bondcpp, a side waits for the other without a timeout instead of 10 s, so either may start
first. The timeout is counted in the side's own heartbeats, so a process that was itself suspended does not declare the
other one dead.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from uuid import uuid4

from linkwright.graph import Clock, ClockType, Node
from linkwright.messages import get_message

TOPIC = "bond"
TIMEOUT = 4.0
"""Seconds of silence after which nav2 takes the other side for dead."""
PERIOD = 0.1
"""Seconds between nav2's heartbeats."""
_DEPTH = 100


def _nothing() -> None:
    """Ignore an event."""


class Bond:
    """One side of a bond.

    Args:
        node: the node that exchanges the heartbeats.
        name: the id of the bond; with nav2, the name of the managed node.
        timeout: the seconds without a heartbeat after which the other side is considered dead.
        period: the seconds between heartbeats.
        on_formed: called once at the first heartbeat of the other side.
        on_broken: called once when the other side leaves or is considered dead; not after `end`.
    """

    def __init__(
        self,
        node: Node,
        name: str,
        *,
        timeout: float = TIMEOUT,
        period: float = PERIOD,
        on_formed: Callable[[], None] = _nothing,
        on_broken: Callable[[], None] = _nothing,
    ) -> None:
        status = get_message("bond/msg/Status")
        self._beat = status(id=name, instance_id=str(uuid4()), heartbeat_timeout=timeout, heartbeat_period=period)
        self._on_formed, self._on_broken = on_formed, on_broken
        self._most_missed = max(1, round(timeout / period))
        self._missed = 0
        self._clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        self.formed = False
        self.broken = False
        self._publisher = node.create_publisher(status, TOPIC, _DEPTH)
        self._subscription = node.create_subscription(status, TOPIC, self._receive, _DEPTH)
        self._subscription.deliver_in_batches()  # The heartbeats of all bonds in the system arrive on this topic.
        self._timer = node.create_timer(period, self._tick, clock=self._clock)
        self._send(active=True)

    def end(self) -> None:
        """Break the bond and notify the other side."""
        if not self.broken:
            self.broken = True
            self._send(active=False)
        for part in (self._timer, self._subscription, self._publisher):
            part.destroy()

    def _tick(self) -> None:
        if self.broken:
            return
        self._send(active=True)
        self._missed += 1
        if self.formed and self._missed > self._most_missed:
            self._break()

    def _receive(self, message: Any) -> None:
        if message.id != self._beat.id or message.instance_id == self._beat.instance_id or self.broken:
            return
        self._missed = 0
        if not message.active:
            if self.formed:
                self._send(active=False)
                self._break()
        elif not self.formed:
            self.formed = True
            self._send(active=True)  # Answer immediately, so that the other side need not wait for the next heartbeat.
            self._on_formed()

    def _break(self) -> None:
        self.broken = True
        self._on_broken()

    def _send(self, *, active: bool) -> None:
        self._beat.active = active
        self._beat.header.stamp = self._clock.now().to_msg()
        self._publisher.publish(self._beat)
