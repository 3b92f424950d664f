"""Publishers of joint states in simulations of Gazebo classic and gz.

The libraries are ``libgazebo_ros_joint_state_publisher.so``, ``gz-sim-joint-state-publisher-system`` and
``libuuv_joint_state_publisher.so``.

Source: gazebo_ros_pkgs for ROS 2, gz-sim and uuv_simulator (parameters, topics, defaults). gz sends its message
Model, which a bridge converts to the message published here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Header, JointState
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

P = TypeVar("P")

_FIXED = (0.0, 0.0)
"""The position and velocity of a joint without an axis."""


@dataclass(frozen=True, kw_only=True)
class ClassicParameters:
    """Parameters of ``libgazebo_ros_joint_state_publisher.so``."""

    joint_name: tuple[str, ...] = parameter(aliases=("jointName",))
    update_rate: float = parameter(100.0, aliases=("updateRate",))


@dataclass(frozen=True, kw_only=True)
class GzParameters:
    """Parameters of ``gz-sim-joint-state-publisher-system``."""

    joint_name: tuple[str, ...] = ()
    topic: str = ""
    update_rate: float = 0.0


class _JointStates(SimulatedPlugin[P], Generic[P]):
    """A plugin that publishes the positions and velocities of joints.

    A joint without an axis, such as one that fixes the robot to the world, is at 0, as in Gazebo.
    """

    def _publish_joints(
        self, names: list[str], joints: list[str], rate: float, topic: str, conventional_topic: str = ""
    ) -> None:
        scene_joints = self.simulation.scene.joints
        self._names = names
        self._joints = [joint if scene_joints[joint].axes else None for joint in joints]
        self._output = self.node.publisher(
            "sensor_msgs/msg/JointState", topic, 1000, conventional_topic=conventional_topic
        )
        self.every(rate, self._publish)

    def _publish(self) -> None:
        if not self._output.is_wanted:
            return
        states = [_FIXED if joint is None else self.simulation.joint_state(joint) for joint in self._joints]
        message = JointState(header=Header(stamp=self.stamp()))
        message.name = list(self._names)
        message.position = [position for position, _ in states]
        message.velocity = [velocity for _, velocity in states]
        self._output.publish(message)


class ClassicJointStates(_JointStates[ClassicParameters]):
    """The substitute for ``libgazebo_ros_joint_state_publisher.so``."""

    PARAMETERS = ClassicParameters

    def start(self) -> None:
        """Find the joints, and publish their states.

        Fixed and missing joints are skipped with a warning.
        """
        requested_names = [name for entry in self.parameters.joint_name for name in entry.replace(",", " ").split()]
        joints_by_name = [(name, joint) for name in requested_names if (joint := self._find_joint(name)) is not None]
        names, joints = [name for name, _ in joints_by_name], [joint for _, joint in joints_by_name]
        if names:
            self._publish_joints(names, joints, self.parameters.update_rate, "joint_states")

    def _find_joint(self, name: str) -> str | None:
        try:
            return self.joint(name)
        except LinkwrightError as error:
            self.node.logger.warning(error.diagnostics[0].message)
            return None


class GzJointStates(_JointStates[GzParameters]):
    """The substitute for ``gz-sim-joint-state-publisher-system``."""

    PARAMETERS = GzParameters

    def start(self) -> None:
        """Start to publish the joints named by the parameters, or all movable joints by default."""
        prefix = f"{self.context.path}::"
        movable_joints = [
            name
            for name, scene_joint in self.simulation.scene.joints.items()
            if name.startswith(prefix) and scene_joint.axes
        ]
        joints = [self.joint(name) for name in self.parameters.joint_name] or movable_joints
        names = [joint.removeprefix(prefix) for joint in joints]
        topic = self.parameters.topic or f"/world/{self.context.world.name}/model/{self.context.path}/joint_state"
        self._publish_joints(names, joints, self.parameters.update_rate, topic, "/joint_states")


@dataclass(frozen=True, kw_only=True)
class UuvParameters:
    """Parameters of ``libuuv_joint_state_publisher.so``."""

    update_rate: float = parameter(50.0, aliases=("updateRate",))


class UuvJointStates(_JointStates[UuvParameters]):
    """The substitute for ``libuuv_joint_state_publisher.so``, which publishes the states of all joints of a model.

    The topic is in the namespace of the plugin, by default the name of the model.
    """

    PARAMETERS = UuvParameters

    def start(self) -> None:
        """Start to publish the states of all joints with an axis."""
        prefix = f"{self.context.path}::"
        joints = [
            name for name, joint in self.simulation.scene.joints.items() if name.startswith(prefix) and joint.axes
        ]
        namespace = self.text_in(self.context.element, "robotNamespace").strip("/") or self.context.path
        names = [joint.removeprefix(prefix) for joint in joints]
        self._publish_joints(names, joints, self.parameters.update_rate, f"/{namespace}/joint_states")
