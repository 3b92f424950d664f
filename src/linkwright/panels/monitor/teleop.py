"""The teleop pad: publishes the velocities of pages as Twist or TwistStamped.

If a page sends no velocity for a while, a velocity of zero is published.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Node
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.page.audience import Page
from linkwright.page.protocol.monitor import AimTeleop, Drive, TeleopState, TeleopTarget
from linkwright.panels.page_feature import FeatureHost, PageFeature

_STOP_DELAY_S = 0.4
"""The robot is stopped after this many seconds without a velocity from the page."""


class TeleopFeature(PageFeature):
    """The feature that publishes the velocities of teleop pads, one publisher for each pad."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pads: dict[Page, _Pad] = {}

    def receive(self, page: Page, message: AimTeleop | Drive) -> None:
        """Set the topic of a page's pad, or publish a velocity."""
        if isinstance(message, Drive):
            pad = self._pads.get(page)
            if pad is not None:
                pad.drive(message)
            return
        self.remove_page(page)
        if message.target is not None:
            self._pads[page] = _Pad(self.context.node, message.target, page.send)
            self.context.graph_changes.watch(self._update_types)

    def remove_page(self, page: Page) -> None:
        """Stop the robot that the page drives, and close its pad."""
        pad = self._pads.pop(page, None)
        if pad is not None:
            pad.close()
        if not self._pads:
            self.context.graph_changes.unwatch(self._update_types)

    def close(self) -> None:
        """Stop all robots."""
        for page in tuple(self._pads):
            self.remove_page(page)

    def _update_types(self) -> None:
        for pad in self._pads.values():
            pad.update_message_type()


class _Pad:
    """The teleop pad of a page."""

    def __init__(self, node: Node, target: TeleopTarget, publish: Callable[[TeleopState], None]) -> None:
        self._node = node
        self._target = target
        self._publish = publish
        self._topic: VelocityTopic | None = None
        self._sent_state: TeleopState | None = None
        self._stop_timer: asyncio.TimerHandle | None = None
        self.update_message_type()

    def drive(self, velocity: Drive) -> None:
        """Publish a velocity.

        The robot is stopped if no other velocity follows in time.
        """
        if self._topic is None or len(velocity.linear) != 3 or len(velocity.angular) != 3:
            return
        self._cancel_stop()
        self._topic.publish(velocity.linear, velocity.angular)
        if any(velocity.linear) or any(velocity.angular):
            self._stop_timer = asyncio.get_running_loop().call_later(_STOP_DELAY_S, self._stop)

    def close(self) -> None:
        """Stop the robot, and destroy the publisher."""
        self._stop()
        if self._topic is not None:
            self._topic.close()

    def update_message_type(self) -> None:
        """Adopt the message type of the topic's subscriptions, and send their number to the page.

        While the robot is moving, the type is not changed.
        """
        target = self._target
        try:
            if self._topic is None:
                is_stamped = None if target.kind == "auto" else target.kind == "TwistStamped"
                self._topic = VelocityTopic(self._node, target.topic, is_stamped, target.frame_id)
            subscription_count = self._topic.update_type(may_change=self._stop_timer is None)
        except LinkwrightError as error:
            self._set_state(TeleopState(target.topic, "", 0, error.diagnostics[0].message))
            return
        topic = self._topic
        if topic.foreign_type is not None:
            self._cancel_stop()
            self._set_state(TeleopState(topic.name, "", 0, f"the topic carries {topic.foreign_type}"))
            return
        self._set_state(TeleopState(topic.name, topic.type_name.rpartition("/")[2], subscription_count, None))

    def _stop(self) -> None:
        """Publish zero, unless the last velocity was already zero."""
        if self._stop_timer is not None:
            self._cancel_stop()
            if self._topic is not None:
                self._topic.stop()

    def _cancel_stop(self) -> None:
        if self._stop_timer is not None:
            self._stop_timer.cancel()
            self._stop_timer = None

    def _set_state(self, state: TeleopState) -> None:
        if state != self._sent_state:
            self._sent_state = state
            self._publish(state)
