"""The element ``<sensor>``: sensors with their ranges and noise.

Source of the elements and defaults: the SDFormat specification 1.12, ``sensor.sdf`` and the files of each kind.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from operator import attrgetter, itemgetter
from typing import Any

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.cameras import CAMERA, Camera
from linkwright.sdf.noise import (
    NO_NOISE,
    NO_NOISE_XYZ,
    Noise,
    NoiseXyz,
    make_noise_rule,
    make_noise_xyz_rule,
    make_wrapped_noise_rule,
)
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR3, name_of, never_written, object_rule, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Sweep:
    """The horizontal or vertical rays of a lidar, from `min_angle` to `max_angle` in radians."""

    samples: int = 640
    resolution: float = 1.0
    min_angle: float = 0.0
    max_angle: float = 0.0

    @property
    def count(self) -> int:
        """The number of rays: the samples multiplied by the resolution."""
        return max(round(self.samples * self.resolution), 1) if self.resolution > 0 else max(self.samples, 1)

    @property
    def step(self) -> float:
        """The angle in radians from one ray to the next, or 0 for a single ray."""
        return (self.max_angle - self.min_angle) / (self.count - 1) if self.count > 1 else 0.0


@dataclass(frozen=True, slots=True)
class Reach:
    """The minimum and maximum distance that a sensor measures, and the resolution, in meters."""

    min: float = 0.0
    max: float = 0.0
    resolution: float = 0.0


@dataclass(frozen=True, slots=True)
class Lidar:
    """A lidar that points along the x axis of its frame.

    Horizontal angles are rotations about z, and vertical angles are positive upwards.
    """

    horizontal: Sweep = Sweep()
    vertical: Sweep = Sweep(1)
    range: Reach = Reach()
    noise: Noise = NO_NOISE
    visibility_mask: int = 0xFFFFFFFF


@dataclass(frozen=True, slots=True)
class Imu:
    """An inertial measurement unit (IMU).

    Attributes:
        angular_velocity: the noise in rad/s.
        linear_acceleration: the noise in m/s2.
        enable_orientation: whether the IMU also measures its orientation.
        localization: the frame to which the orientation refers: ``CUSTOM``, ``NED``, ``ENU``, ``NWU``, ``GRAV_UP`` or
            ``GRAV_DOWN``.
        custom_rpy: roll, pitch, yaw of the custom frame, in radians, in the frame `custom_parent_frame`.
    """

    angular_velocity: NoiseXyz = NO_NOISE_XYZ
    linear_acceleration: NoiseXyz = NO_NOISE_XYZ
    enable_orientation: bool = True
    localization: str = "CUSTOM"
    custom_rpy: Vector3 = (0.0, 0.0, 0.0)
    custom_parent_frame: str = ""


@dataclass(frozen=True, slots=True)
class ContactSensor:
    """The collision whose contacts a sensor reports, and the topic for its messages."""

    collision: str = "__default__"
    topic: str = "__default_topic__"


@dataclass(frozen=True, slots=True)
class Navsat:
    """The noise of a satellite receiver: of positions in meters and of velocities in m/s."""

    horizontal_position: Noise = NO_NOISE
    vertical_position: Noise = NO_NOISE
    horizontal_velocity: Noise = NO_NOISE
    vertical_velocity: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class ForceTorque:
    """A force-torque sensor.

    Attributes:
        frame: the frame of the measurement: ``child``, ``parent`` or ``sensor``.
        measure_direction: ``child_to_parent`` or ``parent_to_child``.
        force: the noise in newtons.
        torque: the noise in newton meters.
    """

    frame: str = "child"
    measure_direction: str = "child_to_parent"
    force: NoiseXyz = NO_NOISE_XYZ
    torque: NoiseXyz = NO_NOISE_XYZ


@dataclass(frozen=True, slots=True)
class Altimeter:
    """The noise of an altimeter: of the height in meters and of the vertical velocity in m/s."""

    vertical_position: Noise = NO_NOISE
    vertical_velocity: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class AirPressure:
    """A barometer, with the altitude of the world's origin in meters and noise in pascals."""

    reference_altitude: float = 0.0
    noise: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class AirSpeed:
    """A pitot tube, with noise in pascals."""

    noise: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class Sonar:
    """A sonar, with lengths in meters.

    `geometry` is the shape of its beam, such as ``cone`` or ``sphere``.
    """

    geometry: str = "cone"
    min: float = 0.0
    max: float = 1.0
    radius: float = 0.5


@dataclass(frozen=True, slots=True)
class LogicalCamera:
    """A sensor that reports the models in its field of view.

    Distances are in meters, and the horizontal field of view is in radians.
    """

    near: float = 0.0
    far: float = 1.0
    aspect_ratio: float = 1.0
    horizontal_fov: float = 1.0


@dataclass(frozen=True, slots=True)
class Sensor:
    """A sensor on a link or joint.

    Attributes:
        type: the type, such as ``camera``, ``gpu_lidar`` or ``imu``; an unknown type is kept as written.
        pose: the pose in the frame of the link or joint, unless it names another frame.
        update_rate: the measurements per second; 0 for one per step.
        always_on: whether the sensor measures without a subscriber.
        visualize: whether measurements are displayed.
        topic: the topic of the measurements; empty for the default topic.
        frame_id: the frame of the messages; empty for the default frame.
        cameras: the cameras; every camera type except ``multicamera`` has one.
        plugins: the plugins that publish the measurements in Gazebo classic.
    """

    name: str
    type: str
    pose: RawPose = AT_ORIGIN
    update_rate: float = 0.0
    always_on: bool = False
    visualize: bool = False
    enable_metrics: bool = False
    topic: str = ""
    frame_id: str = ""
    cameras: tuple[Camera, ...] = ()
    lidar: Lidar | None = None
    imu: Imu | None = None
    contact: ContactSensor | None = None
    navsat: Navsat | None = None
    magnetometer: NoiseXyz | None = None
    altimeter: Altimeter | None = None
    air_pressure: AirPressure | None = None
    air_speed: AirSpeed | None = None
    force_torque: ForceTorque | None = None
    sonar: Sonar | None = None
    logical_camera: LogicalCamera | None = None
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


def _sweep_rule(tag: str, meaning: str, samples: int) -> ElementRule:
    return object_rule(
        Sweep,
        tag,
        meaning,
        value("samples", INTEGER, "the number of rays", default=str(samples)),
        value("resolution", NUMBER, "the number of measured distances per reported distance", default="1"),
        value("min_angle", NUMBER, "the first angle", "rad", default="0"),
        value("max_angle", NUMBER, "the last angle", "rad", default="0"),
        default=Sweep(samples),
    )


_RANGE = object_rule(
    Reach,
    "range",
    "the range of measurable distances",
    value("min", NUMBER, "the minimum distance", "m", default="0"),
    value("max", NUMBER, "the maximum distance", "m", default="0"),
    value("resolution", NUMBER, "the step to which distances are rounded", "m", default="0"),
    default=Reach(),
)


@dataclass(frozen=True, slots=True)
class _ScanValues:
    horizontal: Sweep = Sweep()
    vertical: Sweep = Sweep(1)


def _make_lidar(scan: _ScanValues, **options: Any) -> Lidar:
    return Lidar(scan.horizontal, scan.vertical, **options)


def _lidar_rule(tag: str) -> ElementRule:
    return object_rule(
        _make_lidar,
        tag,
        "the rays and the range of a lidar",
        object_rule(
            _ScanValues,
            "scan",
            "the rays",
            _sweep_rule("horizontal", "the horizontal rays", 640),
            _sweep_rule("vertical", "the vertical rays", 1),
            default=_ScanValues(),
            get=lambda lidar: _ScanValues(lidar.horizontal, lidar.vertical),
        ),
        _RANGE,
        make_noise_rule(),
        value("visibility_mask", INTEGER, "a bit mask of the visuals that are visible", default="4294967295"),
    )


@dataclass(frozen=True, slots=True)
class _OrientationReference:
    localization: str = "CUSTOM"
    custom_rpy: tuple[Vector3, str] = ((0.0, 0.0, 0.0), "")


def _make_imu(orientation_reference_frame: _OrientationReference, **options: Any) -> Imu:
    rpy, parent = orientation_reference_frame.custom_rpy
    return Imu(
        localization=orientation_reference_frame.localization, custom_rpy=rpy, custom_parent_frame=parent, **options
    )


def _custom_orientation(angles: Vector3, parent_frame: str) -> tuple[Vector3, str]:
    return angles, parent_frame


_IMU = object_rule(
    _make_imu,
    "imu",
    "the noise and the reference frame of an IMU",
    make_noise_xyz_rule("angular_velocity", "the noise on the angular velocity"),
    make_noise_xyz_rule("linear_acceleration", "the noise on the acceleration"),
    value("enable_orientation", TRUTH, "whether the IMU also measures its orientation", default="true"),
    object_rule(
        _OrientationReference,
        "orientation_reference_frame",
        "the reference frame of the orientation",
        value("localization", TEXT, "the frame: CUSTOM, NED, ENU, NWU, GRAV_UP or GRAV_DOWN", default="CUSTOM"),
        ElementRule(
            "custom_rpy",
            "the orientation of the custom frame",
            (AttributeRule("parent_frame", TEXT, "the frame of the orientation", default="", get=itemgetter(1)),),
            text=AttributeRule(
                "text", VECTOR3, "roll, pitch, yaw", "rad", default="0 0 0", field="angles", get=itemgetter(0)
            ),
            make=_custom_orientation,
            default=((0.0, 0.0, 0.0), ""),
        ),
        default=_OrientationReference(),
        get=lambda imu: _OrientationReference(imu.localization, (imu.custom_rpy, imu.custom_parent_frame)),
    ),
)


@dataclass(frozen=True, slots=True)
class _SensingNoise:
    horizontal: Noise = NO_NOISE
    vertical: Noise = NO_NOISE


def _make_navsat(position_sensing: _SensingNoise, velocity_sensing: _SensingNoise) -> Navsat:
    return Navsat(
        position_sensing.horizontal,
        position_sensing.vertical,
        velocity_sensing.horizontal,
        velocity_sensing.vertical,
    )


def _navsat_rule(tag: str) -> ElementRule:
    def sensing(kind: str, meaning: str) -> ElementRule:
        noise_rules = (
            make_wrapped_noise_rule("horizontal", "horizontally"),
            make_wrapped_noise_rule("vertical", "vertically"),
        )
        get_both = attrgetter(f"horizontal_{kind}", f"vertical_{kind}")
        return object_rule(
            _SensingNoise,
            f"{kind}_sensing",
            meaning,
            *noise_rules,
            default=_SensingNoise(),
            get=lambda navsat: _SensingNoise(*get_both(navsat)),
        )

    return object_rule(
        _make_navsat,
        tag,
        "the noise of a satellite receiver",
        sensing("position", "the noise on the position"),
        sensing("velocity", "the noise on the velocity"),
    )


_FORCE_TORQUE = object_rule(
    ForceTorque,
    "force_torque",
    "the frame and the noise of a force-torque sensor",
    value("frame", TEXT, "the frame of the measurement: child, parent or sensor", default="child"),
    value("measure_direction", TEXT, "the direction: child_to_parent or parent_to_child", default="child_to_parent"),
    make_noise_xyz_rule("force", "the noise on the force"),
    make_noise_xyz_rule("torque", "the noise on the torque"),
)

_SONAR = object_rule(
    Sonar,
    "sonar",
    "the beam of a sonar",
    value("geometry", TEXT, "the shape: cone or sphere", default="cone"),
    value("min", NUMBER, "the minimum distance", "m", default="0"),
    value("max", NUMBER, "the maximum distance", "m", default="1"),
    value("radius", NUMBER, "the radius of the cone at its end", "m", default="0.5"),
)


def _make_sensor(
    *,
    ray: Lidar | None,
    gps: Navsat | None,
    lidar: Lidar | None,
    navsat: Navsat | None,
    ignition_frame_id: str,
    gz_frame_id: str,
    frame_id: str,
    **options: Any,
) -> Sensor:
    return Sensor(
        lidar=lidar or ray, navsat=navsat or gps, frame_id=frame_id or gz_frame_id or ignition_frame_id, **options
    )


SENSOR = ElementRule(
    "sensor",
    "a sensor on a link or joint",
    (name_of(), AttributeRule("type", TEXT, "the type, such as camera or gpu_lidar", required=True, default="")),
    (
        POSE,
        value("update_rate", NUMBER, "the measurements per second; 0 for one per step", "Hz", default="0"),
        value("always_on", TRUTH, "whether the sensor measures without a subscriber", default="false"),
        value("visualize", TRUTH, "whether measurements are displayed", default="false"),
        value("enable_metrics", TRUTH, "whether the sensor publishes its rate", default="false"),
        value("topic", TEXT, "the topic of the measurements", default=""),
        value("frame_id", TEXT, "the frame of the messages", default="", get=never_written),
        value(
            "gz_frame_id",
            TEXT,
            "the frame of the messages, before SDF 1.12",
            default="",
            get=lambda sensor: sensor.frame_id,
        ),
        value("ignition_frame_id", TEXT, "the frame of the messages, in older files", default="", get=never_written),
        CAMERA,
        _lidar_rule("lidar"),
        replace(_lidar_rule("ray"), get=never_written),
        _IMU,
        object_rule(
            ContactSensor,
            "contact",
            "the collision and the topic of a contact sensor",
            value("collision", TEXT, "the collision to observe", default="__default__"),
            value("topic", TEXT, "the topic of the messages", default="__default_topic__"),
        ),
        _navsat_rule("navsat"),
        replace(_navsat_rule("gps"), get=never_written),
        make_noise_xyz_rule("magnetometer", "the noise of a magnetometer", None),
        object_rule(
            Altimeter,
            "altimeter",
            "the noise of an altimeter",
            make_wrapped_noise_rule("vertical_position", "the noise on the height"),
            make_wrapped_noise_rule("vertical_velocity", "the noise on the vertical velocity"),
        ),
        object_rule(
            AirPressure,
            "air_pressure",
            "the reference altitude and the noise of a barometer",
            value("reference_altitude", NUMBER, "the altitude of the world's origin", "m", default="0"),
            make_wrapped_noise_rule("pressure", "the noise on the pressure", "noise"),
        ),
        object_rule(
            AirSpeed,
            "air_speed",
            "the noise of a sensor of air speed",
            make_wrapped_noise_rule("pressure", "the noise on the pressure", "noise"),
        ),
        _FORCE_TORQUE,
        _SONAR,
        object_rule(
            LogicalCamera,
            "logical_camera",
            "the view of a logical camera, which reports models",
            value("near", NUMBER, "the near clipping distance", "m", default="0"),
            value("far", NUMBER, "the far clipping distance", "m", default="1"),
            value("aspect_ratio", NUMBER, "the width of the view divided by its height", default="1"),
            value("horizontal_fov", NUMBER, "the horizontal field of view", "rad", default="1"),
        ),
        PLUGIN,
    ),
    is_repeated=True,
    make=_make_sensor,
    keeps_element=True,
    passes_element=True,
    is_owner=True,
    field="sensors",
)
