"""The Joint trajectory panel, the counterpart of ``rqt_joint_trajectory_controller``."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from math import isfinite, pi
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph import MessageInfo, QoSProfile
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.graph.qos.profile import DurabilityPolicy
from linkwright.messages import Duration, get_message
from linkwright.page.audience import Page
from linkwright.page.protocol.controllers import (
    MoveJoints,
    TrajectoryController,
    TrajectoryControllers,
    TrajectoryJoint,
    WatchTrajectory,
)
from linkwright.panels.monitor.topic_tap import RateLimiter, TopicTap
from linkwright.panels.monitor.watched_items import WatchedItemsFeature
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.parameter_responses import NoParameterResponseError, wait_for_response, wait_for_services
from linkwright.urdf import Joint

_TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
_TOPIC_SUFFIX = "/joint_trajectory"
_DESCRIPTION = "robot_description"
_PUBLISH_PERIOD_S = 0.1
_MIN_SECONDS = 0.05


class TrajectoriesFeature(WatchedItemsFeature["_Controller"]):
    """The feature that shows the joints of trajectory controllers, and moves them."""

    def receive(self, page: Page, message: WatchTrajectory | MoveJoints) -> None:
        """Handle a request. A page can move only the joints of the controller that it watches."""
        if not isinstance(message, WatchTrajectory):
            controller = self.find_watched(page, message.controller)
            if controller is not None:
                controller.move(message.positions, message.seconds)
            return
        controller = self.watch(page, message.controller, wants_list=message.wants_list)
        if controller is not None:
            controller.request_state()

    def create_item(self, name: str) -> _Controller:
        """Start to follow the joints of a controller."""
        return _Controller(self.context, name, lambda joints: self.publish(name, joints))

    def make_list(self) -> TrajectoryControllers:
        """Return the names of the controllers that accept trajectories."""
        return TrajectoryControllers(
            sorted(
                name.removesuffix(_TOPIC_SUFFIX)
                for name, kinds in self.context.node.graph.topics().items()
                if name.endswith(_TOPIC_SUFFIX) and _TRAJECTORY in kinds
            )
        )


class _Controller:
    """A trajectory controller: its joints, their positions and limits.

    Args:
        context: the viewer's node.
        name: the full name of the controller.
        publish: called with the joints after changes.
    """

    def __init__(self, context: ViewerContext, name: str, publish: Callable[[TrajectoryController], None]) -> None:
        self.name = name
        self._node = context.node
        self._publish = publish
        self._joint_names: list[str] = []
        self._positions: dict[str, float] = {}
        self._joints: dict[str, Joint] = {}
        self._error: str | None = None
        self._limiter = RateLimiter(self._publish_state, _PUBLISH_PERIOD_S)
        self._output: Any = self._node.create_publisher(_TRAJECTORY, f"{name}{_TOPIC_SUFFIX}", 1)
        self._client = AsyncParameterClient(self._node, name)
        namespace = name.rpartition("/")[0]
        self._tap = TopicTap(context, f"{namespace}/joint_states", self._on_joint_states)
        profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscriptions: list[Any] = [
            self._node.create_subscription("std_msgs/msg/String", topic, self._on_description, profile)
            for topic in dict.fromkeys((f"/{_DESCRIPTION}", f"{namespace}/{_DESCRIPTION}"))
        ]
        self._task = asyncio.get_running_loop().create_task(self._read_joint_names())

    def close(self) -> None:
        """Cancel requests, and destroy the subscriptions."""
        self._limiter.cancel()
        self._task.cancel()
        self._tap.close()
        self._client.destroy()
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._node.destroy_publisher(self._output)

    def request_state(self) -> None:
        """Publish the joints soon."""
        self._limiter.request()

    def move(self, positions: list[float], seconds: float) -> None:
        """Send a trajectory with one point to the controller."""
        if len(positions) != len(self._joint_names) or not positions or not all(map(isfinite, (*positions, seconds))):
            return
        duration = Duration.from_nanoseconds(round(max(seconds, _MIN_SECONDS) * 1e9))
        point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(positions=positions, time_from_start=duration)
        self._output.publish(get_message(_TRAJECTORY)(joint_names=list(self._joint_names), points=[point]))

    async def _read_joint_names(self) -> None:
        try:
            await wait_for_services(self._client)
            response = await wait_for_response(self._client, self._client.get_parameters(["joints"]))
            self._joint_names = list(response.values[0].string_array_value)
            if not self._joint_names:
                self._error = phrase("the node '{name}' has no parameter 'joints'", name=self.name)
        except NoParameterResponseError as error:
            self._error = str(error)
        self._limiter.request()

    def _on_joint_states(self, message: Any, _: MessageInfo) -> None:
        for name, position in zip(message.name, message.position, strict=False):
            if name in self._joint_names:
                self._positions[name] = float(position)
        if self._joint_names:
            self._limiter.request()

    def _on_description(self, message: Any) -> None:
        from linkwright.descriptions import DescriptionLibrary

        try:
            robot = DescriptionLibrary().read(message.data).robot
        except LinkwrightError:
            return
        if robot is not None:
            self._joints.update(robot.joints)
            self._limiter.request()

    def _publish_state(self) -> None:
        joints = [self._make_joint(name) for name in self._joint_names]
        self._publish(TrajectoryController(self.name, f"{self.name}{_TOPIC_SUFFIX}", joints, self._error))

    def _make_joint(self, name: str) -> TrajectoryJoint:
        position = self._positions.get(name)
        if position is not None and not isfinite(position):
            position = None
        joint = self._joints.get(name)
        if joint is None:
            return TrajectoryJoint(name, position, None, None, None)
        limit = joint.limit
        velocity = limit.velocity if limit is not None and limit.velocity > 0 else None
        if joint.type == "continuous":
            return TrajectoryJoint(name, position, -pi, pi, velocity)
        if limit is None or limit.lower >= limit.upper:
            return TrajectoryJoint(name, position, None, None, velocity)
        return TrajectoryJoint(name, position, limit.lower, limit.upper, velocity)
