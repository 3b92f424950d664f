"""Broadcasters of sensors: IMU, force-torque, range, pose, GNSS and magnetometer.

Source: ``imu_sensor_broadcaster``, ``force_torque_sensor_broadcaster``, ``range_sensor_broadcaster``,
``pose_broadcaster``, ``gps_sensor_broadcaster`` and ``magnetometer_broadcaster`` of ros2_controllers (parameters, names
of interfaces, topics).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, ClassVar, TypeVar

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.diagnostics import Phrase, phrase
from linkwright.graph import ParameterDescriptor
from linkwright.messages import Header, Quaternion, Time, Transform, TransformStamped, Vector3, from_values, get_message
from linkwright.nodes.parameter_tables import at_least, not_empty, parameter
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_UNKNOWN_COVARIANCE = (0.0,) * 9
_FILTER_CHAIN = "sensor_filter_chain"


def _check_covariance(name: str, value: tuple[float, ...]) -> Phrase | None:
    """Return an error message unless a covariance consists of 9 numbers, row by row."""
    if len(value) != 9:
        return phrase("parameter '{name}' must have 9 numbers, but it has {count}", name=name, count=len(value))
    return None


@dataclass(frozen=True, kw_only=True)
class ImuParameters:
    """Parameters of the IMU broadcaster."""

    sensor_name: str = parameter("", description="the name of the sensor in ros2_control", check=not_empty)
    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    static_covariance_orientation: tuple[float, ...] = parameter(
        _UNKNOWN_COVARIANCE, description="the covariance of the orientation, 9 values", check=_check_covariance
    )
    static_covariance_angular_velocity: tuple[float, ...] = parameter(
        _UNKNOWN_COVARIANCE, description="the covariance of the angular velocity, 9 values", check=_check_covariance
    )
    static_covariance_linear_acceleration: tuple[float, ...] = parameter(
        _UNKNOWN_COVARIANCE, description="the covariance of the acceleration, 9 values", check=_check_covariance
    )


@dataclass(frozen=True, kw_only=True)
class VectorNames:
    """The names of the three interfaces of a vector."""

    x: str = ""
    y: str = ""
    z: str = ""


@dataclass(frozen=True, kw_only=True)
class QuaternionNames(VectorNames):
    """The names of the four interfaces of a quaternion."""

    w: str = ""


@dataclass(frozen=True, kw_only=True)
class WrenchNames:
    """The names of the interfaces of a force-torque sensor."""

    force: VectorNames = VectorNames()
    torque: VectorNames = VectorNames()


@dataclass(frozen=True, kw_only=True)
class PoseNames:
    """The names of the interfaces of a pose."""

    position: VectorNames = VectorNames()
    orientation: QuaternionNames = QuaternionNames()


@dataclass(frozen=True, kw_only=True)
class AxisOffsets:
    """The offsets of three axes, 0 by default."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(frozen=True, kw_only=True)
class AxisFactors:
    """The factors of three axes, 1 by default."""

    x: float = 1.0
    y: float = 1.0
    z: float = 1.0


@dataclass(frozen=True, kw_only=True)
class WrenchOffset:
    """The offset of a wrench, in N and N m."""

    force: AxisOffsets = AxisOffsets()
    torque: AxisOffsets = AxisOffsets()


@dataclass(frozen=True, kw_only=True)
class WrenchMultiplier:
    """The factors by which a wrench is multiplied."""

    force: AxisFactors = AxisFactors()
    torque: AxisFactors = AxisFactors()


@dataclass(frozen=True, kw_only=True)
class WrenchParameters:
    """Parameters of the force-torque broadcaster.

    `offset` is added to the wrench before it is multiplied by `multiplier`.
    """

    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    sensor_name: str = parameter("", description="the name of the sensor in ros2_control")
    interface_names: WrenchNames = WrenchNames()
    offset: WrenchOffset = WrenchOffset()
    multiplier: WrenchMultiplier = WrenchMultiplier()


@dataclass(frozen=True, kw_only=True)
class RangeParameters:
    """Parameters of the range broadcaster."""

    sensor_name: str = parameter("", description="the name of the sensor in ros2_control", check=not_empty)
    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    radiation_type: int = parameter(0, description="0 for ultrasound, 1 for infrared")
    field_of_view: float = parameter(0.52, description="the field of view, in rad")
    min_range: float = parameter(0.52, description="the minimum range, in m")
    max_range: float = parameter(4.0, description="the maximum range, in m")
    variance: float = parameter(0.0, description="the variance of the range, in m²; without effect in Humble")


@dataclass(frozen=True, kw_only=True)
class TransformParameters:
    """Parameters of the transform that is published with a pose."""

    enable: bool = parameter(True, description="whether to publish the transform")
    child_frame_id: str = parameter("", description="the frame at the pose; pose_name if empty")
    publish_rate: float = parameter(0.0, description="the rate in Hz; 0 for each update", check=at_least(0.0))


@dataclass(frozen=True, kw_only=True)
class PoseParameters:
    """Parameters of the pose broadcaster."""

    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    pose_name: str = parameter("", description="the name of the pose sensor in ros2_control")
    interface_names: PoseNames = PoseNames()
    tf: TransformParameters = TransformParameters()


@dataclass(frozen=True, kw_only=True)
class GpsParameters:
    """Parameters of the GNSS broadcaster."""

    sensor_name: str = parameter("", description="the name of the sensor in ros2_control", check=not_empty)
    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    static_position_covariance: tuple[float, ...] = parameter(
        _UNKNOWN_COVARIANCE, description="the covariance of the position, 9 values in m²", check=_check_covariance
    )
    read_covariance_from_interface: bool = parameter(
        False, description="whether the sensor has interfaces for the variances of the position"
    )


@dataclass(frozen=True, kw_only=True)
class MagnetometerParameters:
    """Parameters of the magnetometer broadcaster."""

    sensor_name: str = parameter("", description="the name of the sensor in ros2_control", check=not_empty)
    frame_id: str = parameter("", description="the frame_id of the messages", check=not_empty)
    static_covariance: tuple[float, ...] = parameter(
        _UNKNOWN_COVARIANCE, description="the covariance of the magnetic field, 9 values in T²", check=_check_covariance
    )


P = TypeVar("P")


class SensorBroadcaster(Controller[P]):
    """The base class of broadcasters that publish their states in a message at each update."""

    TYPE: ClassVar[str]
    TOPIC: ClassVar[str]

    @abstractmethod
    def state_interfaces(self) -> InterfaceNames:
        """Return the state interfaces of the sensor."""

    @abstractmethod
    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a message that contains the values of the state interfaces.

        Args:
            message_class: the message class.
            header: the header of the message.
            values: the values, in the order of `state_interfaces`.
        """

    def on_configure(self) -> None:
        """Create the publisher."""
        self._message_class = get_message(self.TYPE)
        self._output = self.node.publisher(self.TYPE, self.TOPIC)

    def update(self, time_ns: int, period_s: float) -> None:
        """Publish a message if the topic has a subscription."""
        if self._output.is_wanted:
            self._output.publish(
                self.message(self._message_class, self.header(time_ns), [state.value for state in self.states])
            )

    def header(self, time_ns: int) -> Header:
        """Return a header with a time in nanoseconds and the frame from the parameters."""
        frame: str = self.parameters.frame_id  # type: ignore[attr-defined]  # All parameter classes have it.
        return Header(stamp=Time.from_nanoseconds(time_ns), frame_id=frame)


def _list_components(wrench: WrenchNames | WrenchOffset | WrenchMultiplier) -> list[Any]:
    """Return the six values of forces and torques: force x, y, z, torque x, y, z."""
    return [getattr(vector, axis) for vector in (wrench.force, wrench.torque) for axis in "xyz"]


def _to_vector(values: Sequence[float]) -> Vector3:
    return Vector3(x=values[0], y=values[1], z=values[2])


class ImuBroadcaster(SensorBroadcaster[ImuParameters]):
    """``imu_sensor_broadcaster/IMUSensorBroadcaster``."""

    PARAMETERS = ImuParameters
    TYPE, TOPIC = "sensor_msgs/msg/Imu", "~/imu"

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of orientation, angular velocity and linear acceleration."""
        orientation = [f"orientation.{axis}" for axis in "xyzw"]
        vectors = [f"{kind}.{axis}" for kind in ("angular_velocity", "linear_acceleration") for axis in "xyz"]
        return [f"{self.parameters.sensor_name}/{item}" for item in (*orientation, *vectors)]

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return an IMU message with the covariances from the parameters."""
        parameters = self.parameters
        return message_class(
            header=header,
            orientation=from_values(Quaternion, values[:4]),
            orientation_covariance=parameters.static_covariance_orientation,
            angular_velocity=_to_vector(values[4:7]),
            angular_velocity_covariance=parameters.static_covariance_angular_velocity,
            linear_acceleration=_to_vector(values[7:]),
            linear_acceleration_covariance=parameters.static_covariance_linear_acceleration,
        )


class ForceTorqueBroadcaster(SensorBroadcaster[WrenchParameters]):
    """``force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster``."""

    PARAMETERS = WrenchParameters
    TYPE, TOPIC = "geometry_msgs/msg/WrenchStamped", "~/wrench"

    def declare_parameters(self) -> None:
        """Declare the parameters of the filter chain, and warn that it is not used."""
        node = self.node.graph_node
        filter_parameters = [name for name in node.undeclared_overrides() if name.startswith(f"{_FILTER_CHAIN}.")]
        for name in filter_parameters:
            node.declare_parameter(name, descriptor=ParameterDescriptor(dynamic_typing=True))
        if filter_parameters:
            message = phrase(
                "'{parameter}' is not supported, so the wrench is not filtered, and '{topic}' is not published",
                parameter=_FILTER_CHAIN,
                topic="~/wrench_filtered",
            )
            self.node.logger.warning(message)

    def on_configure(self) -> None:
        """Determine the interface of each axis, and create the publisher.

        Raises:
            ControllerError: neither or both of ``sensor_name`` and ``interface_names`` are set.
        """
        parameters = self.parameters
        interface_names = _list_components(parameters.interface_names)
        if not parameters.sensor_name and not any(interface_names):
            raise ControllerError(
                "'sensor_name' or at least one 'interface_names.[force|torque].[x|y|z]' parameter has to be specified."
            )
        if parameters.sensor_name and any(interface_names):
            raise ControllerError(
                "both 'sensor_name' and 'interface_names.[force|torque].[x|y|z]' parameters can not be specified "
                "together."
            )
        kinds = [f"{kind}.{axis}" for kind in ("force", "torque") for axis in "xyz"]
        self._names = (
            [f"{parameters.sensor_name}/{kind}" for kind in kinds] if parameters.sensor_name else interface_names
        )
        super().on_configure()

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the forces, then of the torques."""
        return [name for name in self._names if name]

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a wrench message.

        Axes without an interface are 0 before the offset and the multiplier are applied.
        """
        remaining_values = iter(values)
        parameters = self.parameters
        wrench_values = [
            ((next(remaining_values) if name else 0.0) + offset) * factor
            for name, offset, factor in zip(
                self._names, _list_components(parameters.offset), _list_components(parameters.multiplier), strict=True
            )
        ]
        wrench = get_message("geometry_msgs/msg/Wrench")
        return message_class(
            header=header, wrench=wrench(force=_to_vector(wrench_values[:3]), torque=_to_vector(wrench_values[3:]))
        )


class RangeBroadcaster(SensorBroadcaster[RangeParameters]):
    """``range_sensor_broadcaster/RangeSensorBroadcaster``."""

    PARAMETERS = RangeParameters
    TYPE, TOPIC = "sensor_msgs/msg/Range", "~/range"

    def state_interfaces(self) -> InterfaceNames:
        """Return the range interface."""
        return [f"{self.parameters.sensor_name}/range"]

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a range message with the limits from the parameters."""
        parameters = self.parameters
        return message_class(
            header=header,
            radiation_type=parameters.radiation_type,
            field_of_view=parameters.field_of_view,
            min_range=parameters.min_range,
            max_range=parameters.max_range,
            range=values[0],
        )


class PoseBroadcaster(SensorBroadcaster[PoseParameters]):
    """``pose_broadcaster/PoseBroadcaster``, which publishes a pose and its transform."""

    PARAMETERS = PoseParameters
    TYPE, TOPIC = "geometry_msgs/msg/PoseStamped", "~/pose"

    def on_configure(self) -> None:
        """Determine the interfaces of the pose, and create the publishers.

        Raises:
            ControllerError: neither or both of ``pose_name`` and ``interface_names`` are set.
        """
        parameters = self.parameters
        position, orientation = parameters.interface_names.position, parameters.interface_names.orientation
        interface_names = [
            position.x,
            position.y,
            position.z,
            orientation.x,
            orientation.y,
            orientation.z,
            orientation.w,
        ]
        if not parameters.pose_name and not all(interface_names):
            raise ControllerError(
                "'pose_name' or 'interface_names.[position.[x|y|z]|orientation.[x|y|z|w]]' parameter has to be "
                "specified."
            )
        if parameters.pose_name and any(interface_names):
            raise ControllerError(
                "'pose_name' and 'interface_names.[position.[x|y|z]|orientation.[x|y|z|w]]' parameters can not be "
                "specified together."
            )
        kinds = [*(f"position.{axis}" for axis in "xyz"), *(f"orientation.{axis}" for axis in "xyzw")]
        self._names = [f"{parameters.pose_name}/{kind}" for kind in kinds] if parameters.pose_name else interface_names
        self._next_transform_ns = 0
        self._child_frame = parameters.tf.child_frame_id or parameters.pose_name
        self._transforms = self.node.publisher("tf2_msgs/msg/TFMessage", "/tf", 100) if parameters.tf.enable else None
        super().on_configure()

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the position, then of the orientation."""
        return self._names

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a pose message."""
        pose = get_message("geometry_msgs/msg/Pose")
        point = get_message("geometry_msgs/msg/Point")
        return message_class(
            header=header,
            pose=pose(position=from_values(point, values[:3]), orientation=from_values(Quaternion, values[3:])),
        )

    def update(self, time_ns: int, period_s: float) -> None:
        """Publish the pose, and the transform if its period has passed and all values are finite."""
        super().update(time_ns, period_s)
        rate = self.parameters.tf.publish_rate
        period_ns = round(NANOSECONDS_PER_SECOND / rate) if rate else 0
        # A remaining time above the period means that simulated time was reset.
        is_too_early = 0 < self._next_transform_ns - time_ns <= period_ns
        if self._transforms is None or not self._child_frame or is_too_early:
            return
        values = [state.value for state in self.states]
        if not self._transforms.is_wanted or not all(map(isfinite, values)):
            return
        self._next_transform_ns = time_ns + period_ns
        transform = Transform(translation=_to_vector(values), rotation=from_values(Quaternion, values[3:]))
        stamped_transform = TransformStamped(
            header=self.header(time_ns), child_frame_id=self._child_frame, transform=transform
        )
        self._transforms.publish(get_message("tf2_msgs/msg/TFMessage")(transforms=[stamped_transform]))


class GpsBroadcaster(SensorBroadcaster[GpsParameters]):
    """``gps_sensor_broadcaster/GPSSensorBroadcaster``."""

    PARAMETERS = GpsParameters
    TYPE, TOPIC = "sensor_msgs/msg/NavSatFix", "~/gps/fix"

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of status, service and position, and of variances if enabled."""
        coordinates = ("latitude", "longitude", "altitude")
        names = ["status", "service", *coordinates]
        if self.parameters.read_covariance_from_interface:
            names += (f"{coordinate}_covariance" for coordinate in coordinates)
        return [f"{self.parameters.sensor_name}/{name}" for name in names]

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a position message.

        An unknown status is -1, and an unknown service is 0.
        """
        status, service, latitude, longitude, altitude, *position_variances = values
        covariance = list(self.parameters.static_position_covariance)
        if position_variances:
            covariance = [0.0] * 9
            covariance[::4] = position_variances
        return message_class(
            header=header,
            status=get_message("sensor_msgs/msg/NavSatStatus")(
                status=int(status) if isfinite(status) else -1, service=int(service) if isfinite(service) else 0
            ),
            latitude=latitude,
            longitude=longitude,
            altitude=altitude,
            position_covariance=covariance,
            position_covariance_type=message_class.COVARIANCE_TYPE_DIAGONAL_KNOWN
            if position_variances
            else message_class.COVARIANCE_TYPE_KNOWN,
        )


class MagnetometerBroadcaster(SensorBroadcaster[MagnetometerParameters]):
    """``magnetometer_broadcaster/MagnetometerBroadcaster``."""

    PARAMETERS = MagnetometerParameters
    TYPE, TOPIC = "sensor_msgs/msg/MagneticField", "~/magnetic_field"

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the magnetic field, in T."""
        return [f"{self.parameters.sensor_name}/magnetic_field.{axis}" for axis in "xyz"]

    def message(self, message_class: Any, header: Header, values: Sequence[float]) -> Any:
        """Return a message of the magnetic field with the covariance from the parameters."""
        return message_class(
            header=header,
            magnetic_field=_to_vector(values),
            magnetic_field_covariance=self.parameters.static_covariance,
        )
