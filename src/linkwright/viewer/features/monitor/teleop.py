"""The teleop pad: velocities of pages as geometry_msgs/msg/Twist or TwistStamped, and zero when they fall silent."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import EndpointKind, Node, Publisher
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.monitor import AimTeleop, Drive, TeleopState, TeleopTarget
from linkwright.viewer.web.audience import Page

_SILENCE = 0.4
"""Seconds without a word from a page that drives, after which the robot is stopped."""

_DEPTH = 10
_PACKAGE = "geometry_msgs/msg/"
_PLAIN, _STAMPED = f"{_PACKAGE}Twist", f"{_PACKAGE}TwistStamped"


class TeleopFeature(PageFeature):
    """Publishes what pads of pages say; a publisher is there while a page has its pad open."""

    RECEIVES = (AimTeleop, Drive)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._pads: dict[Page, _Pad] = {}

    def receive(self, page: Page, message: AimTeleop | Drive) -> None:
        """Aim a page's pad, or publish a velocity."""
        if isinstance(message, Drive):
            pad = self._pads.get(page)
            if pad is not None:
                pad.drive(message)
            return
        self.page_gone(page)
        if message.target is not None:
            self._pads[page] = _Pad(self.context.node, message.target, page.send)
            self.context.graph_changes.listen(self._review)

    def page_gone(self, page: Page) -> None:
        """Stop what the page drives."""
        pad = self._pads.pop(page, None)
        if pad is not None:
            pad.close()
        if not self._pads:
            self.context.graph_changes.ignore(self._review)

    def close(self) -> None:
        """Stop everything."""
        for page in tuple(self._pads):
            self.page_gone(page)

    def _review(self) -> None:
        for pad in self._pads.values():
            pad.review()


class _Pad:
    """One page's pad."""

    def __init__(self, node: Node, target: TeleopTarget, tell: Callable[[TeleopState], None]) -> None:
        self._node = node
        self._target = target
        self._tell = tell
        self._publisher: Publisher[Any] | None = None
        self._told: TeleopState | None = None
        self._silent: asyncio.TimerHandle | None = None
        self.review()

    def drive(self, velocity: Drive) -> None:
        """Publish a velocity, and stop unless another comes soon."""
        if self._publisher is None or len(velocity.linear) != 3 or len(velocity.angular) != 3:
            return
        self._cancel()
        self._publish(velocity.linear, velocity.angular)
        if any(velocity.linear) or any(velocity.angular):
            self._silent = asyncio.get_running_loop().call_later(_SILENCE, self._stop)

    def close(self) -> None:
        """Stop, and leave the topic."""
        self._stop()
        self._retire()

    def review(self) -> None:
        """Look which type the topic's subscribers have, and how many they are. A pad that drives keeps its own type."""
        try:
            topic = self._node.resolve_topic_name(self._target.topic)
        except LinkwrightError as error:
            self._say(TeleopState(self._target.topic, "", 0, error.diagnostics[0].message))
            return
        others = [
            endpoint
            for endpoint in self._node.graph.endpoints()
            if endpoint.name == topic and (self._publisher is None or endpoint.gid != self._publisher.gid)
        ]
        listeners = [each.type_name for each in others if each.kind is EndpointKind.SUBSCRIPTION]
        kind = self._kind(listeners)
        foreign = sorted({each.type_name for each in others} - {_PLAIN, _STAMPED})
        if foreign:
            self._stop()
            self._retire()
            self._say(TeleopState(topic, "", 0, f"the topic carries {foreign[0]}"))
            return
        if self._silent is None and (self._publisher is None or self._publisher.type_name != kind):
            self._retire()
            self._publisher = self._node.create_publisher(kind, topic, _DEPTH)
        kind = self._publisher.type_name if self._publisher is not None else kind
        self._say(TeleopState(topic, kind.removeprefix(_PACKAGE), listeners.count(kind), None))

    def _kind(self, listeners: list[str]) -> str:
        if self._target.kind != "auto":
            return f"{_PACKAGE}{self._target.kind}"
        return _STAMPED if _STAMPED in listeners and _PLAIN not in listeners else _PLAIN

    def _publish(self, linear: list[float], angular: list[float]) -> None:
        publisher = self._publisher
        if publisher is None:
            return
        message = publisher.msg_type()
        twist = message
        if publisher.type_name == _STAMPED:
            message.header.stamp = self._node.get_clock().now().to_msg()
            message.header.frame_id = self._target.frame_id
            twist = message.twist
        for vector, values in ((twist.linear, linear), (twist.angular, angular)):
            vector.x, vector.y, vector.z = values
        publisher.publish(message)

    def _stop(self) -> None:
        """Publish zero, if something else was published last."""
        if self._silent is not None:
            self._cancel()
            self._publish([0.0] * 3, [0.0] * 3)

    def _cancel(self) -> None:
        if self._silent is not None:
            self._silent.cancel()
            self._silent = None

    def _retire(self) -> None:
        if self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    def _say(self, state: TeleopState) -> None:
        if state != self._told:
            self._told = state
            self._tell(state)
