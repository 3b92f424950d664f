"""The base Kobuki of TurtleBot 2: ``libgazebo_ros_kobuki.so``.

The plugin drives two wheels, and publishes the events of three cliff sensors and of a bumper with three zones, the
measurements of the IMU, and odometry whose heading is that of the gyroscope.

Source: kobuki_gazebo_plugins (parameters, topics, covariances, zones of the bumper, formula of the cliff sensors). It
publishes after each step; here the rate is that of the real base. The messages are those of ``kobuki_ros_interfaces``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, pi, sin
from typing import Any

import numpy as np

from linkwright.control.odometry import get_yaw
from linkwright.diagnostics import phrase
from linkwright.messages import Header, JointState, Quaternion, from_values, get_message
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.sensors import Lidar
from linkwright.simulation.plugins.contexts import model_plugins
from linkwright.simulation.plugins.diff_drive import ClassicDiffDrive, ClassicParameters
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import Environment, PlacedSensor, PluginContext
from linkwright.simulation.plugins.sensors.base import vector_to_message
from linkwright.simulation.sensors.contact import ContactSensor
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.lidar import LidarSensor
from linkwright.simulation.sensors.mount import Mount

_RATE_HZ = 50.0
_PREFIX = "mobile_base"
_LEFT, _CENTER, _RIGHT = range(3)
_LOWEST_CONTACT_M, _HIGHEST_CONTACT_M = 0.01, 0.13
"""The heights above the base between which contacts press the bumper."""
_HALF_ZONE_RAD, _ZONE_LIMIT_RAD = pi / 6, pi / 2
_READING_SCALE, _READING_DISTANCE = 76123.0, 0.995
"""The reading of a cliff sensor is the scale times the arctangent of the second number over the distance in m."""
_READING_MASK = 0xFFFF
"""The 16 bits of a reading that fit into the message."""
_UNKNOWN_VARIANCE, _YAW_VARIANCE, _POSITION_VARIANCE = 1e6, 0.05, 0.1


@dataclass(frozen=True, kw_only=True)
class KobukiParameters:
    """Parameters of ``libgazebo_ros_kobuki.so``."""

    left_wheel_joint_name: str = parameter()
    right_wheel_joint_name: str = parameter()
    wheel_separation: float = parameter()
    wheel_diameter: float = parameter()
    max_wheel_torque: float = parameter(aliases=("torque",))
    velocity_command_timeout: float = parameter()
    cliff_sensor_left_name: str = parameter()
    cliff_sensor_center_name: str = parameter()
    cliff_sensor_right_name: str = parameter()
    cliff_detection_threshold: float = parameter()
    bumper_name: str = parameter()
    imu_name: str = parameter()
    publish_tf: bool = False

    def as_diff_drive(self) -> ClassicParameters:
        """Return the parameters of the equivalent differential drive."""
        return ClassicParameters(
            left_joint=(self.left_wheel_joint_name,),
            right_joint=(self.right_wheel_joint_name,),
            wheel_separation=(self.wheel_separation,),
            wheel_diameter=(self.wheel_diameter,),
            max_wheel_torque=self.max_wheel_torque,
            update_rate=_RATE_HZ,
            command_topic=f"{_PREFIX}/commands/velocity",
            odometry_source="encoder",
            publish_odom=True,
            publish_odom_tf=self.publish_tf,
            covariance_x=_POSITION_VARIANCE,
            covariance_y=_POSITION_VARIANCE,
            covariance_yaw=_YAW_VARIANCE,
        )


class Kobuki(ClassicDiffDrive):
    """The substitute for ``libgazebo_ros_kobuki.so``."""

    PARAMETERS = KobukiParameters
    CARRIED = (*ClassicDiffDrive.CARRIED, "_last_command_s", "_has_power", "_cliffs", "_pressed")

    def __init__(
        self, context: PluginContext, node: PluginNode, parameters: KobukiParameters, environment: Environment
    ) -> None:
        super().__init__(context, node, parameters.as_diff_drive(), environment)
        self._settings = parameters

    def start(self) -> None:
        """Find the wheels and the sensors, create the topics, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, there is no such joint; SIM160, there is no such sensor.
        """
        settings, node = self._settings, self.node
        names = (settings.cliff_sensor_left_name, settings.cliff_sensor_center_name, settings.cliff_sensor_right_name)
        self._cliff_sensors = [self._find_sensor(name) for name in names]
        self._bumper, self._placed_imu = self._find_sensor(settings.bumper_name), self._find_sensor(settings.imu_name)
        self._restart()
        super().start()
        self._joint_output = node.publisher("sensor_msgs/msg/JointState", "joint_states", 1)
        self._cliff_output, self._bumper_output, self._imu_output = (
            node.publisher(message_type, f"{_PREFIX}/{topic}", 1)
            for message_type, topic in (
                ("kobuki_ros_interfaces/msg/CliffEvent", "events/cliff"),
                ("kobuki_ros_interfaces/msg/BumperEvent", "events/bumper"),
                ("sensor_msgs/msg/Imu", "sensors/imu_data"),
            )
        )
        node.subscribe("kobuki_ros_interfaces/msg/MotorPower", f"{_PREFIX}/commands/motor_power", self._on_power)
        node.subscribe("std_msgs/msg/Empty", f"{_PREFIX}/commands/reset_odometry", self._on_reset_odometry)
        self.every(_RATE_HZ, self._publish_sensors)

    @property
    def read_sensors(self) -> tuple[str, ...]:
        """The names of the cliff sensors, the bumper and the IMU."""
        return tuple(sensor.name for sensor in (*self._cliff_sensors, self._bumper, self._placed_imu))

    def reset(self) -> None:
        """Stop the robot, and reset the odometry and the events."""
        self._restart()
        super().reset()

    def _restart(self) -> None:
        """Create the sensor models, and forget commands and events."""
        self._last_command_s, self._has_power = 0.0, True
        self._cliffs, self._pressed = [False] * 3, [False] * 3
        generator = self.random
        self._imu = ImuSensor(self._mount(self._placed_imu), self._placed_imu.sensor.imu, generator=generator)
        self._lidars = [
            LidarSensor(
                self._mount(placed),
                placed.sensor.lidar or Lidar(),
                sees_visuals=placed.sensor.type != "ray",
                generator=generator,
            )
            for placed in self._cliff_sensors
        ]
        contact = self._bumper.sensor.contact
        collisions = [] if contact is None or contact.collision == "__default__" else [contact.collision]
        self._contacts = ContactSensor(self._mount(self._bumper), collisions)

    def _mount(self, placed: PlacedSensor) -> Mount:
        return Mount(self.simulation, placed.link, placed.pose)

    def _find_sensor(self, name: str) -> PlacedSensor:
        """Return the sensor of the model with a name.

        Raises:
            LinkwrightError: SIM160, there is no such sensor.
        """
        context = self.context
        assert context.model is not None
        for item in model_plugins(context.world, context.model, context.path):
            if item.sensor is not None and f"{SEPARATOR}{item.sensor.name}".endswith(f"{SEPARATOR}{name}"):
                return item.sensor
        raise self.parameter_error(
            phrase("plugin '{plugin}': there is no sensor '{name}'", plugin=context.name, name=name)
        )

    # --- drive --------------------------------------------------------------------------------------------------------

    def _on_command(self, twist: Any) -> None:
        self._last_command_s = self.simulation.seconds
        super()._on_command(twist)

    def _on_power(self, message: Any) -> None:
        self._has_power = bool(message.state)

    def _on_reset_odometry(self, _: Any) -> None:
        self._pose = type(self._pose)()

    def _drive(self) -> None:
        is_late = self.simulation.seconds - self._last_command_s > self._settings.velocity_command_timeout
        if is_late or not self._has_power:
            self._stop_motion()
        super()._drive()

    def _measure_velocity(self) -> tuple[float, float]:
        forward, _ = super()._measure_velocity()
        return forward, self._yaw_rate

    def _update_odometry(self) -> None:
        """Update the odometry from the rotation of the wheels, and from the gyroscope."""
        pair, (left, right), self._wheel_angles = self._pairs[0], self._wheel_angles, self._read_angles()
        new_left, new_right = self._wheel_angles
        distance, _ = pair.drive.motion(new_left - left, new_right - right)
        self._motion = self._imu.measure()
        self._yaw_rate = float(self._motion.angular_velocity[2])
        self._pose.x += distance * cos(self._pose.yaw)
        self._pose.y += distance * sin(self._pose.yaw)
        self._pose.yaw += self._yaw_rate / _RATE_HZ

    # --- sensors ------------------------------------------------------------------------------------------------------

    def _publish_sensors(self) -> None:
        header = Header(stamp=self.stamp(), frame_id="base_link")
        if self._joint_output.is_wanted:
            states = [self.simulation.joint_state(joint) for joint in self._pairs[0].joints]
            message = JointState(header=header)
            message.name = [joint.rpartition(SEPARATOR)[2] for joint in self._pairs[0].joints]
            message.position, message.velocity = [state[0] for state in states], [state[1] for state in states]
            message.effort = [0.0, 0.0]
            self._joint_output.publish(message)
        if self._imu_output.is_wanted:
            self._publish_imu(header)
        self._publish_cliffs()
        self._publish_bumps()

    def _publish_imu(self, header: Header) -> None:
        message = get_message("sensor_msgs/msg/Imu")(header=header)
        message.orientation = from_values(Quaternion, self._motion.orientation)
        message.angular_velocity = vector_to_message(np.array(self._motion.angular_velocity))
        message.linear_acceleration = vector_to_message(np.array(self._motion.linear_acceleration))
        variances = np.diag([_UNKNOWN_VARIANCE, _UNKNOWN_VARIANCE, _YAW_VARIANCE]).ravel()
        message.orientation_covariance = message.angular_velocity_covariance = variances
        self._imu_output.publish(message)

    def _publish_cliffs(self) -> None:
        """Publish the events of the cliff sensors whose states have changed."""
        for index, lidar in enumerate(self._lidars):
            distance = float(lidar.measure().ranges[0, 0])
            is_cliff = distance >= self._settings.cliff_detection_threshold
            if is_cliff == self._cliffs[index]:
                continue
            self._cliffs[index] = is_cliff
            reading = int(_READING_SCALE * atan2(_READING_DISTANCE, max(distance, 0.0)))
            event = get_message("kobuki_ros_interfaces/msg/CliffEvent")
            self._cliff_output.publish(event(sensor=index, state=int(is_cliff), bottom=reading & _READING_MASK))

    def _publish_bumps(self) -> None:
        """Publish the events of the zones of the bumper whose states have changed."""
        pose = self.simulation.model_pose(self.context.path)
        heading, pressed = get_yaw(pose), [False] * 3
        for contact in self._contacts.measure():
            for position, normal in zip(contact.positions, contact.normals, strict=True):
                if not _LOWEST_CONTACT_M <= position[2] - pose[2] <= _HIGHEST_CONTACT_M:
                    continue
                direction = atan2(-normal[1], -normal[0]) - heading
                zone = _find_zone((direction + pi) % (2 * pi) - pi)
                if zone is not None:
                    pressed[zone] = True
        for zone, is_pressed in enumerate(pressed):
            if is_pressed != self._pressed[zone]:
                event = get_message("kobuki_ros_interfaces/msg/BumperEvent")
                self._bumper_output.publish(event(bumper=zone, state=int(is_pressed)))
        self._pressed = pressed


def _find_zone(direction: float) -> int | None:
    """Return the zone of the bumper in a direction in rad, relative to the robot; None for the rear."""
    if abs(direction) <= _HALF_ZONE_RAD:
        return _CENTER
    if abs(direction) > _ZONE_LIMIT_RAD:
        return None
    return _LEFT if direction > 0 else _RIGHT
