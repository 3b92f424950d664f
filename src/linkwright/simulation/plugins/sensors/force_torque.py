"""Force-torque sensors on joints: ``gazebo_ros_ft_sensor``, and ``force_torque`` of gz.

Source: gazebo_ros_pkgs for ROS 2 (parameters, topic, the frame of the child link), gz-sensors (topic).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from linkwright.geometry.single import compose, invert
from linkwright.sdf.sensors import ForceTorque
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.sensors.base import SENSOR_QOS, FrameNameParameter, SingleTopicSensor
from linkwright.simulation.plugins.sensors.contact import wrench_to_message
from linkwright.simulation.sensors.force_torque import ForceTorqueSensor

P = TypeVar("P")

_MESSAGE_TYPE = "geometry_msgs/msg/WrenchStamped"


@dataclass(frozen=True, kw_only=True)
class ForceTorqueParameters(FrameNameParameter):
    """Parameters of ``gazebo_ros_ft_sensor``."""

    joint_name: str = parameter(aliases=("jointName",))
    topic_name: str = parameter("wrench", aliases=("topicName",))
    update_rate: float = parameter(0.0, aliases=("updateRate",))


class _ForceTorque(SingleTopicSensor[P], Generic[P]):
    """A force-torque sensor that publishes ``geometry_msgs/msg/WrenchStamped``."""

    _sensor: ForceTorqueSensor
    _frame: str

    def measure(self) -> None:
        """Measure, and publish the wrench."""
        message = self.message(_MESSAGE_TYPE, self._frame)
        message.wrench = wrench_to_message(*self._sensor.measure())
        self.output.publish(message)


class ClassicForceTorque(_ForceTorque[ForceTorqueParameters]):
    """The substitute for ``libgazebo_ros_ft_sensor.so``.

    The plugin publishes the wrench that the child link exerts on its parent, in the child's frame.
    """

    PARAMETERS = ForceTorqueParameters
    IGNORED = ("gaussian_noise", "gaussianNoise")

    @property
    def rate(self) -> float:
        """The number of measurements per simulated second, from the plugin's parameters."""
        return self.parameters.update_rate

    def create_sensor(self) -> None:
        """Find the joint that the parameters name, and create its sensor."""
        joint = self.joint(self.parameters.joint_name)
        self._child = self.simulation.scene.joints[joint].child
        self._sensor = ForceTorqueSensor(self.simulation, joint, ForceTorque(), self.random)

    def create_publishers(self) -> None:
        """Create the publisher on the topic that the parameters name."""
        self._frame = self.parameters.frame_name.lstrip("/") or self._child.rpartition("::")[2]
        self.output = self.node.publisher(_MESSAGE_TYPE, self.parameters.topic_name, SENSOR_QOS)


class GzForceTorque(_ForceTorque[NoParameters]):
    """The sensor ``force_torque`` of gz, in a joint."""

    def create_sensor(self) -> None:
        """Find the joint that contains the sensor, and create the sensor model."""
        joint = self.joint(self.sensor.joint.rpartition("::")[2])
        placed_joint = self.simulation.scene.joints[joint]
        child = self.simulation.link_pose(placed_joint.child)
        offset = compose(invert(placed_joint.pose), compose(child, self.sensor.pose))
        self._sensor = ForceTorqueSensor(self.simulation, joint, self.sensor.sensor.force_torque, self.random, offset)

    def create_publishers(self) -> None:
        """Create the publisher on the sensor's topic, or on gz's default topic."""
        self._frame = self.gz_frame()
        self.output = self.create_gz_output(_MESSAGE_TYPE, "forcetorque", "/force_torque")
