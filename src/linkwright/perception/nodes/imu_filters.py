"""imu_filter_madgwick_node and complementary_filter_node: orientation from IMU data.

Sources: imu_filter_madgwick and imu_complementary_filter 2.1 (ROS 2 Humble): topics, parameters, defaults. Each IMU
message is paired with the latest magnetometer message; the originals match stamps.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import isfinite
from typing import Any, Protocol

import numpy as np

from linkwright.geometry.single import (
    Quaternion,
    Vector3,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
    rpy_from_quaternion,
)
from linkwright.graph import SENSOR_DATA_QOS, TF_QOS, Graph
from linkwright.messages import TFMessage, TransformBatch, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import invalid_value_error, log_unknown_parameters
from linkwright.perception.attitude import (
    GRAVITY,
    ComplementaryFilter,
    MadgwickFilter,
    WorldFrame,
    compute_attitude_at_rest,
)

_QUEUE_DEPTH = 5


class _Filter(Protocol):
    orientation: Quaternion

    def update(self, rates: Vector3, acceleration: Vector3, magnetic: Vector3 | None, seconds: float) -> None: ...


class _ImuFilter(SingleNode, ABC):
    """The base of both nodes: topics, transform, and the time between measurements."""

    _USES_MAGNETOMETER: bool
    _PUBLISHES_TF: bool

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        self._last_ns: int | None = None
        self._magnetic: Vector3 | None = None
        with handle_start_errors(node):
            declare = node.declare_parameter
            self._use_mag: bool = declare("use_mag", self._USES_MAGNETOMETER).value
            self._publish_tf: bool = declare("publish_tf", self._PUBLISHES_TF).value
            self._reverse_tf: bool = declare("reverse_tf", False).value
            self._fixed_frame: str = declare("fixed_frame", "odom").value
            self._constant_dt: float = declare("constant_dt", 0.0).value
            self._debug: bool = declare("publish_debug_topics", False).value
            standard_deviation: float = declare("orientation_stddev", 0.0).value
            self._covariance = np.eye(3).reshape(9) * standard_deviation**2
            if not self._constant_dt >= 0.0:
                raise invalid_value_error("constant_dt", self._constant_dt, node.get_name())
            self._filter = self._create_filter()
            log_unknown_parameters(node)
        imu_class, vector_class = get_message("sensor_msgs/msg/Imu"), get_message("geometry_msgs/msg/Vector3Stamped")
        self._publisher = node.create_publisher(imu_class, "imu/data", _QUEUE_DEPTH)
        self._tf_publisher = node.create_publisher(TFMessage, "/tf", TF_QOS) if self._publish_tf else None
        self._rpy_publisher = (
            node.create_publisher(vector_class, "imu/rpy/filtered", _QUEUE_DEPTH) if self._debug else None
        )
        node.create_subscription(imu_class, "imu/data_raw", self._receive_imu, SENSOR_DATA_QOS)
        if self._use_mag:
            node.create_subscription(
                get_message("sensor_msgs/msg/MagneticField"), "imu/mag", self._receive_magnetic, SENSOR_DATA_QOS
            )

    @abstractmethod
    def _create_filter(self) -> _Filter:
        """Create the filter from the remaining parameters."""

    def _initialize_orientation(self, acceleration: Vector3, magnetic: Vector3 | None) -> bool:
        """Initialize the orientation, or return False if that is not possible yet."""
        return True

    def _output_orientation(self, orientation: Quaternion) -> Quaternion:
        return orientation

    def _output_acceleration(self, acceleration: Vector3) -> Vector3:
        """Return the acceleration to publish: without gravity if the node removes it."""
        return acceleration

    def _receive_magnetic(self, message: Any) -> None:
        field = message.magnetic_field
        if all(isfinite(component) for component in (field.x, field.y, field.z)):
            self._magnetic = self._remove_bias((field.x, field.y, field.z))

    def _remove_bias(self, magnetic: Vector3) -> Vector3:
        return magnetic

    def _receive_imu(self, message: Any) -> None:
        if self._use_mag and self._magnetic is None:
            return
        rates, linear_acceleration = message.angular_velocity, message.linear_acceleration
        angular_velocity, acceleration = (
            (rates.x, rates.y, rates.z),
            (linear_acceleration.x, linear_acceleration.y, linear_acceleration.z),
        )
        if not all(isfinite(component) for component in (*angular_velocity, *acceleration)):
            return
        stamp_ns: int = message.header.stamp.nanoseconds
        if self._last_ns is None and not self._initialize_orientation(acceleration, self._magnetic):
            self._node.get_logger().warning(
                "The IMU seems to be in free fall, cannot determine gravity direction!", throttle_duration_sec=5.0
            )
            return
        seconds = self._constant_dt or (0.0 if self._last_ns is None else (stamp_ns - self._last_ns) / 1e9)
        self._last_ns = stamp_ns
        if seconds >= 0.0:  # the interval is negative after simulated time has jumped back
            self._filter.update(angular_velocity, acceleration, self._magnetic, seconds)
        self._publish(message, acceleration)

    def _publish(self, message: Any, acceleration: Vector3) -> None:
        result = get_message("sensor_msgs/msg/Imu")(header=message.header)
        result.angular_velocity = message.angular_velocity
        result.angular_velocity_covariance = message.angular_velocity_covariance
        result.linear_acceleration_covariance = message.linear_acceleration_covariance
        linear_acceleration = result.linear_acceleration
        linear_acceleration.x, linear_acceleration.y, linear_acceleration.z = self._output_acceleration(acceleration)
        orientation = self._output_orientation(self._filter.orientation)
        quaternion = result.orientation
        quaternion.x, quaternion.y, quaternion.z, quaternion.w = orientation
        result.orientation_covariance = self._covariance
        self._publisher.publish(result)
        if self._tf_publisher is not None:
            self._tf_publisher.publish(TFMessage(batch=self._create_transform(message.header)))
        if self._rpy_publisher is not None:
            angles = get_message("geometry_msgs/msg/Vector3Stamped")(header=message.header)
            angles.vector.x, angles.vector.y, angles.vector.z = rpy_from_quaternion(orientation)
            self._rpy_publisher.publish(angles)

    def _create_transform(self, header: Any) -> TransformBatch:
        parent, child, rotation = self._fixed_frame, header.frame_id, self._filter.orientation
        if self._reverse_tf:
            parent, child, rotation = child, parent, quaternion_inverse(rotation)
        return TransformBatch((parent,), (child,), header.stamp.nanoseconds, np.array([[0.0, 0.0, 0.0, *rotation]]))


class MadgwickNode(_ImuFilter):
    """The node that estimates the orientation with the Madgwick filter.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "imu_filter_madgwick"
    _USES_MAGNETOMETER = True
    _PUBLISHES_TF = True

    def _create_filter(self) -> MadgwickFilter:
        declare = self._node.declare_parameter
        name: str = declare("world_frame", "enu").value
        if name not in [world.value for world in WorldFrame]:
            raise invalid_value_error("world_frame", name, self._node.get_name(), [world.value for world in WorldFrame])
        self._world = WorldFrame(name)
        self._stateless: bool = declare("stateless", False).value
        self._remove_gravity: bool = declare("remove_gravity_vector", False).value
        offset: float = declare("yaw_offset", 0.0).value - declare("declination", 0.0).value
        self._yaw_offset = quaternion_from_rpy((0.0, 0.0, offset))
        bias = [float(declare(f"mag_bias_{axis}", 0.0).value) for axis in "xyz"]
        self._magnetometer_bias = (bias[0], bias[1], bias[2])
        return MadgwickFilter(declare("gain", 0.1).value, declare("zeta", 0.0).value, self._world)

    def _initialize_orientation(self, acceleration: Vector3, magnetic: Vector3 | None) -> bool:
        orientation = compute_attitude_at_rest(acceleration, magnetic, self._world)
        if orientation is None:
            return False
        self._filter.orientation = orientation
        return True

    def _receive_imu(self, message: Any) -> None:
        if self._stateless:
            self._last_ns = None  # each measurement is then handled as the first one
        super()._receive_imu(message)

    def _remove_bias(self, magnetic: Vector3) -> Vector3:
        x, y, z = (reading - bias for reading, bias in zip(magnetic, self._magnetometer_bias, strict=True))
        return x, y, z

    def _output_orientation(self, orientation: Quaternion) -> Quaternion:
        return quaternion_multiply(self._yaw_offset, orientation)

    def _output_acceleration(self, acceleration: Vector3) -> Vector3:
        if not self._remove_gravity:
            return acceleration
        gravity_in_body = rotate(quaternion_inverse(self._filter.orientation), (0.0, 0.0, GRAVITY * self._world.up))
        x, y, z = (component - gravity for component, gravity in zip(acceleration, gravity_in_body, strict=True))
        return x, y, z


class ComplementaryNode(_ImuFilter):
    """The node that estimates the orientation with a complementary filter.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "complementary_filter_gain_node"
    _USES_MAGNETOMETER = False
    _PUBLISHES_TF = False

    def _create_filter(self) -> ComplementaryFilter:
        declare = self._node.declare_parameter

        def declare_fraction(name: str) -> float:
            value: float = declare(name, 0.01).value
            if not 0.0 <= value <= 1.0:
                raise invalid_value_error(name, value, self._node.get_name())
            return value

        return ComplementaryFilter(
            gain_acc=declare_fraction("gain_acc"),
            gain_mag=declare_fraction("gain_mag"),
            bias_alpha=declare_fraction("bias_alpha"),
            do_bias_estimation=declare("do_bias_estimation", True).value,
            do_adaptive_gain=declare("do_adaptive_gain", True).value,
        )

    def _initialize_orientation(self, acceleration: Vector3, magnetic: Vector3 | None) -> bool:
        orientation = compute_attitude_at_rest(acceleration, magnetic, WorldFrame.NWU)
        if orientation is not None:
            self._filter.orientation = orientation
        return orientation is not None
