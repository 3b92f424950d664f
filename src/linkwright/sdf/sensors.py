"""``<sensor>``: what measures, and how well.

Source of the elements and defaults: the SDFormat specification 1.12, ``sensor.sdf`` and the files of each kind.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from linkwright.geometry.vectors import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.plugins import PLUGIN, Plugin
from linkwright.sdf.poses import AT_ORIGIN, POSE, RawPose
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR2, VECTOR3, made, name_of, value
from linkwright.xmltree import Element


@dataclass(frozen=True, slots=True)
class Noise:
    """Noise on a value, in the unit of the value.

    Attributes:
        type: ``none``, ``gaussian`` or ``gaussian_quantized``.
        mean: what is added on average.
        stddev: the standard deviation.
        bias_mean: the mean of a bias that is drawn once.
        bias_stddev: its standard deviation.
        dynamic_bias_stddev: the standard deviation of a bias that wanders.
        dynamic_bias_correlation_time: how slowly it wanders, in seconds.
        precision: what values are rounded to, where they are quantized.
    """

    type: str = "none"
    mean: float = 0.0
    stddev: float = 0.0
    bias_mean: float = 0.0
    bias_stddev: float = 0.0
    dynamic_bias_stddev: float = 0.0
    dynamic_bias_correlation_time: float = 0.0
    precision: float = 0.0


NO_NOISE = Noise()


@dataclass(frozen=True, slots=True)
class Picture:
    """Size in pixels and format of a camera's pictures, as ``R8G8B8``."""

    width: int = 320
    height: int = 240
    format: str = "R8G8B8"


@dataclass(frozen=True, slots=True)
class Clip:
    """The nearest and the farthest distance that a camera sees, in metres."""

    near: float = 0.1
    far: float = 100.0


@dataclass(frozen=True, slots=True)
class Distortion:
    """Brown's coefficients of a lens; `center` in shares of the picture."""

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    center: tuple[float, float] = (0.5, 0.5)


@dataclass(frozen=True, slots=True)
class Intrinsics:
    """Focal lengths and centre of a picture in pixels, and skew."""

    fx: float = 277.0
    fy: float = 277.0
    cx: float = 160.0
    cy: float = 120.0
    s: float = 0.0


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera; it looks along x of its frame, with z up.

    Attributes:
        name: of one camera among several.
        pose: in the frame of the sensor.
        horizontal_fov: the angle that the width of the picture covers, in radians.
        image: size and format.
        clip: what it sees.
        noise: on each colour, from 0 to 1.
        distortion: of the lens; None for a perfect one.
        intrinsics: where they are given instead of the angle; else None.
        depth_clip: what a depth camera measures; None for the same as `clip`.
        segmentation_type: ``semantic`` or ``instance`` (also ``panoptic``).
        box_type: ``2d``, ``visible_2d``, ``full_2d`` or ``3d``.
        camera_info_topic: the topic of its intrinsics; empty for the usual one.
        optical_frame_id: the frame of its pictures; empty for that of the sensor.
        triggered: whether it takes pictures only when asked.
        trigger_topic: where it is asked.
        visibility_mask: which visuals it sees: those with a bit in common.
    """

    name: str = ""
    pose: RawPose = AT_ORIGIN
    horizontal_fov: float = 1.047
    image: Picture = Picture()
    clip: Clip = Clip()
    noise: Noise = NO_NOISE
    distortion: Distortion | None = None
    intrinsics: Intrinsics | None = None
    depth_clip: Clip | None = None
    segmentation_type: str = "semantic"
    box_type: str = "2d"
    camera_info_topic: str = ""
    optical_frame_id: str = ""
    triggered: bool = False
    trigger_topic: str = ""
    visibility_mask: int = 0xFFFFFFFF


@dataclass(frozen=True, slots=True)
class Sweep:
    """The rays of a lidar in one direction; angles in radians, from `min_angle` to `max_angle`."""

    samples: int = 640
    resolution: float = 1.0
    min_angle: float = 0.0
    max_angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Reach:
    """The shortest and longest distance that a sensor measures, and what distances are rounded to; metres."""

    min: float = 0.0
    max: float = 0.0
    resolution: float = 0.0


@dataclass(frozen=True, slots=True)
class Lidar:
    """A lidar; it looks along x of its frame, horizontal angles are about z and vertical ones upwards."""

    horizontal: Sweep = Sweep()
    vertical: Sweep = Sweep(1)
    range: Reach = Reach()
    noise: Noise = NO_NOISE
    visibility_mask: int = 0xFFFFFFFF


@dataclass(frozen=True, slots=True)
class NoiseXyz:
    """Noise on the three parts of a vector."""

    x: Noise = NO_NOISE
    y: Noise = NO_NOISE
    z: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class Imu:
    """An inertial measurement unit.

    Attributes:
        angular_velocity: noise in rad/s.
        linear_acceleration: noise in m/s2.
        enable_orientation: whether it tells its orientation too.
        localization: what the orientation is against: ``CUSTOM``, ``NED``, ``ENU``, ``NWU``, ``GRAV_UP`` or
            ``GRAV_DOWN``.
        custom_rpy: roll, pitch, yaw of the custom frame, in radians, in the frame `custom_parent_frame`.
    """

    angular_velocity: NoiseXyz = NoiseXyz()
    linear_acceleration: NoiseXyz = NoiseXyz()
    enable_orientation: bool = True
    localization: str = "CUSTOM"
    custom_rpy: Vector3 = (0.0, 0.0, 0.0)
    custom_parent_frame: str = ""


@dataclass(frozen=True, slots=True)
class ContactSensor:
    """The collision that a contact sensor listens to, and the topic of its messages."""

    collision: str = "__default__"
    topic: str = "__default_topic__"


@dataclass(frozen=True, slots=True)
class Navsat:
    """Noise of a satellite receiver: positions in metres, velocities in m/s, across the ground and upwards."""

    horizontal_position: Noise = NO_NOISE
    vertical_position: Noise = NO_NOISE
    horizontal_velocity: Noise = NO_NOISE
    vertical_velocity: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class ForceTorque:
    """A force-torque sensor.

    Attributes:
        frame: the frame of what it measures: ``child``, ``parent`` or ``sensor``.
        measure_direction: ``child_to_parent`` or ``parent_to_child``.
        force: noise in newtons.
        torque: noise in newton metres.
    """

    frame: str = "child"
    measure_direction: str = "child_to_parent"
    force: NoiseXyz = NoiseXyz()
    torque: NoiseXyz = NoiseXyz()


@dataclass(frozen=True, slots=True)
class Altimeter:
    """Noise of an altimeter: height in metres, vertical velocity in m/s."""

    vertical_position: Noise = NO_NOISE
    vertical_velocity: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class AirPressure:
    """A barometer: the altitude in metres that its zero is at, and noise in pascals."""

    reference_altitude: float = 0.0
    noise: Noise = NO_NOISE


@dataclass(frozen=True, slots=True)
class Sonar:
    """A sonar: the cone, sphere or box (``geometry``) that it listens in; lengths in metres."""

    geometry: str = "cone"
    min: float = 0.0
    max: float = 1.0
    radius: float = 0.5


@dataclass(frozen=True, slots=True)
class LogicalCamera:
    """A camera that names the models which it sees: distances in metres, the angle across in radians."""

    near: float = 0.0
    far: float = 1.0
    aspect_ratio: float = 1.0
    horizontal_fov: float = 1.0


@dataclass(frozen=True, slots=True)
class Sensor:
    """A sensor on a link or joint.

    Attributes:
        type: such as ``camera``, ``gpu_lidar``, ``imu``; what `linkwright.sdf` does not know stays as written.
        pose: in the frame of the link or joint.
        update_rate: measurements a second; 0 for one each step.
        always_on: whether it measures while nobody listens.
        visualize: whether what it measures is drawn.
        topic: where it publishes; empty for the usual topic.
        frame_id: the frame of its messages; empty for the usual one.
        cameras: its cameras, of which all but ``multicamera`` have one.
        plugins: what publishes its measurements in Gazebo classic.
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
    force_torque: ForceTorque | None = None
    sonar: Sonar | None = None
    logical_camera: LogicalCamera | None = None
    plugins: tuple[Plugin, ...] = ()
    element: Element | None = field(default=None, compare=False, repr=False)


_NOISE_PARTS = (
    value("mean", NUMBER, "what it adds on average", default="0"),
    value("stddev", NUMBER, "its standard deviation", default="0"),
    value("bias_mean", NUMBER, "the mean of a bias that is drawn once", default="0"),
    value("bias_stddev", NUMBER, "the standard deviation of that bias", default="0"),
    value("dynamic_bias_stddev", NUMBER, "the standard deviation of a bias that wanders", default="0"),
    value("dynamic_bias_correlation_time", NUMBER, "how slowly that bias wanders", "s", default="0"),
    value("precision", NUMBER, "what values are rounded to", default="0"),
)


def _noise_of(type: str, said_type: str, **parts: float) -> Noise:  # noqa: A002 - the attribute's name
    """Noise; older files name its type by an element, and Gazebo takes Gaussian noise where only numbers are given."""
    return Noise(said_type or type or ("gaussian" if any(parts.values()) else "none"), **parts)


def _noise(tag: str = "noise", meaning: str = "noise on the value", target: str = "") -> ElementRule:
    return ElementRule(
        tag,
        meaning,
        (AttributeRule("type", TEXT, "none, gaussian or gaussian_quantized", default=""),),
        (value("type", TEXT, "the kind of noise, up to SDF 1.4", default="", field="said_type"), *_NOISE_PARTS),
        make=_noise_of,
        keeps=True,
        default=NO_NOISE,
        field=target or tag,
    )


def _around(tag: str, meaning: str, target: str = "") -> ElementRule:
    """An element that has nothing but noise in it, and stands for that."""
    return made(_inner, tag, meaning, _noise(), default=NO_NOISE, field=target or tag)


def _inner(noise: Noise) -> Noise:
    return noise


def _xyz(tag: str, meaning: str, absent: NoiseXyz | None = NoiseXyz()) -> ElementRule:
    parts = (_around("x", "along x"), _around("y", "along y"), _around("z", "along z"))
    return made(NoiseXyz, tag, meaning, *parts, default=absent)


def _sweep(tag: str, meaning: str, samples: int) -> ElementRule:
    return made(
        Sweep,
        tag,
        meaning,
        value("samples", INTEGER, "how many rays", default=str(samples)),
        value("resolution", NUMBER, "how many measured distances make one that is told", default="1"),
        value("min_angle", NUMBER, "where it begins", "rad", default="0"),
        value("max_angle", NUMBER, "where it ends", "rad", default="0"),
        default=Sweep(samples),
    )


_RANGE = made(
    Reach,
    "range",
    "the distances that it measures",
    value("min", NUMBER, "the shortest", "m", default="0"),
    value("max", NUMBER, "the longest", "m", default="0"),
    value("resolution", NUMBER, "what distances are rounded to", "m", default="0"),
    default=Reach(),
)


@dataclass(frozen=True, slots=True)
class _Scan:
    horizontal: Sweep = Sweep()
    vertical: Sweep = Sweep(1)


def _lidar_of(scan: _Scan, **parts: Any) -> Lidar:
    return Lidar(scan.horizontal, scan.vertical, **parts)


def _lidar(tag: str) -> ElementRule:
    return made(
        _lidar_of,
        tag,
        "what a lidar measures",
        made(
            _Scan,
            "scan",
            "its rays",
            _sweep("horizontal", "the rays about z", 640),
            _sweep("vertical", "the rays upwards", 1),
            default=_Scan(),
        ),
        _RANGE,
        _noise(),
        value("visibility_mask", INTEGER, "which visuals it sees: those with a bit in common", default="4294967295"),
    )


_CLIP_PARTS = (
    value("near", NUMBER, "the nearest", "m", default="0.1"),
    value("far", NUMBER, "the farthest", "m", default="100"),
)


@dataclass(frozen=True, slots=True)
class _Lens:
    intrinsics: Intrinsics | None


@dataclass(frozen=True, slots=True)
class _DepthCamera:
    clip: Clip | None


def _camera_of(lens: _Lens | None, depth_camera: _DepthCamera | None, **parts: Any) -> Camera:
    return Camera(
        intrinsics=lens.intrinsics if lens else None, depth_clip=depth_camera.clip if depth_camera else None, **parts
    )


_CAMERA = ElementRule(
    "camera",
    "what a camera sees",
    (AttributeRule("name", TEXT, "the name of one camera among several", default=""),),
    (
        POSE,
        value("horizontal_fov", NUMBER, "the angle that the width of the picture covers", "rad", default="1.047"),
        made(
            Picture,
            "image",
            "its pictures",
            value("width", INTEGER, "pixels in a row", default="320"),
            value("height", INTEGER, "rows", default="240"),
            value("format", TEXT, "the format of a pixel, such as R8G8B8 or L8", default="R8G8B8"),
            default=Picture(),
        ),
        made(Clip, "clip", "the distances that it sees", *_CLIP_PARTS, default=Clip()),
        _noise(),
        made(
            Distortion,
            "distortion",
            "how the lens distorts",
            value("k1", NUMBER, "the first radial coefficient", default="0"),
            value("k2", NUMBER, "the second radial coefficient", default="0"),
            value("k3", NUMBER, "the third radial coefficient", default="0"),
            value("p1", NUMBER, "the first tangential coefficient", default="0"),
            value("p2", NUMBER, "the second tangential coefficient", default="0"),
            value("center", VECTOR2, "its centre, in shares of the picture", default="0.5 0.5"),
        ),
        made(
            _Lens,
            "lens",
            "the lens",
            made(
                Intrinsics,
                "intrinsics",
                "the focal lengths and the centre in pixels",
                value("fx", NUMBER, "the focal length across", "pixels", default="277"),
                value("fy", NUMBER, "the focal length down", "pixels", default="277"),
                value("cx", NUMBER, "the centre across", "pixels", default="160"),
                value("cy", NUMBER, "the centre down", "pixels", default="120"),
                value("s", NUMBER, "the skew", default="0"),
            ),
        ),
        made(
            _DepthCamera,
            "depth_camera",
            "what a depth camera measures",
            made(Clip, "clip", "the distances that it measures", *_CLIP_PARTS),
        ),
        value("segmentation_type", TEXT, "semantic, instance or panoptic", default="semantic"),
        value("box_type", TEXT, "2d, visible_2d, full_2d or 3d", default="2d"),
        value("camera_info_topic", TEXT, "the topic of its intrinsics", default=""),
        value("optical_frame_id", TEXT, "the frame of its pictures", default=""),
        value("triggered", TRUTH, "whether it takes pictures only when asked", default="false"),
        value("trigger_topic", TEXT, "where it is asked for a picture", default=""),
        value("visibility_mask", INTEGER, "which visuals it sees: those with a bit in common", default="4294967295"),
    ),
    many=True,
    make=_camera_of,
    keeps=True,
    field="cameras",
)


@dataclass(frozen=True, slots=True)
class _Reference:
    localization: str = "CUSTOM"
    custom_rpy: tuple[Vector3, str] = ((0.0, 0.0, 0.0), "")


def _imu_of(orientation_reference_frame: _Reference, **parts: Any) -> Imu:
    rpy, parent = orientation_reference_frame.custom_rpy
    return Imu(
        localization=orientation_reference_frame.localization, custom_rpy=rpy, custom_parent_frame=parent, **parts
    )


def _custom(said: Vector3, parent_frame: str) -> tuple[Vector3, str]:
    return said, parent_frame


_IMU = made(
    _imu_of,
    "imu",
    "what an IMU measures",
    _xyz("angular_velocity", "noise on the angular velocity"),
    _xyz("linear_acceleration", "noise on the acceleration"),
    value("enable_orientation", TRUTH, "whether it tells its orientation too", default="true"),
    made(
        _Reference,
        "orientation_reference_frame",
        "what the orientation is against",
        value("localization", TEXT, "CUSTOM, NED, ENU, NWU, GRAV_UP or GRAV_DOWN", default="CUSTOM"),
        ElementRule(
            "custom_rpy",
            "roll, pitch, yaw of the custom frame",
            (AttributeRule("parent_frame", TEXT, "the frame that it is against", default=""),),
            text=AttributeRule("text", VECTOR3, "roll, pitch, yaw", "rad", default="0 0 0", field="said"),
            make=_custom,
            default=((0.0, 0.0, 0.0), ""),
        ),
        default=_Reference(),
    ),
)


@dataclass(frozen=True, slots=True)
class _Sensing:
    horizontal: Noise = NO_NOISE
    vertical: Noise = NO_NOISE


def _navsat_of(position_sensing: _Sensing, velocity_sensing: _Sensing) -> Navsat:
    return Navsat(
        position_sensing.horizontal,
        position_sensing.vertical,
        velocity_sensing.horizontal,
        velocity_sensing.vertical,
    )


def _navsat(tag: str) -> ElementRule:
    def sensing(name: str, meaning: str) -> ElementRule:
        parts = (_around("horizontal", "across the ground"), _around("vertical", "upwards"))
        return made(_Sensing, name, meaning, *parts, default=_Sensing())

    return made(
        _navsat_of,
        tag,
        "noise of a satellite receiver",
        sensing("position_sensing", "noise on the position"),
        sensing("velocity_sensing", "noise on the velocity"),
    )


_FORCE_TORQUE = made(
    ForceTorque,
    "force_torque",
    "what a force-torque sensor measures",
    value("frame", TEXT, "the frame of what it measures: child, parent or sensor", default="child"),
    value("measure_direction", TEXT, "child_to_parent or parent_to_child", default="child_to_parent"),
    _xyz("force", "noise on the force"),
    _xyz("torque", "noise on the torque"),
)

_SONAR = made(
    Sonar,
    "sonar",
    "what a sonar measures",
    value("geometry", TEXT, "cone or sphere", default="cone"),
    value("min", NUMBER, "the shortest distance", "m", default="0"),
    value("max", NUMBER, "the longest distance", "m", default="1"),
    value("radius", NUMBER, "radius of the cone at its end", "m", default="0.5"),
)


def _sensor_of(
    *,
    ray: Lidar | None,
    gps: Navsat | None,
    lidar: Lidar | None,
    navsat: Navsat | None,
    ignition_frame_id: str,
    gz_frame_id: str,
    frame_id: str,
    **parts: Any,
) -> Sensor:
    return Sensor(
        lidar=lidar or ray, navsat=navsat or gps, frame_id=frame_id or gz_frame_id or ignition_frame_id, **parts
    )


SENSOR = ElementRule(
    "sensor",
    "something that measures",
    (name_of(), AttributeRule("type", TEXT, "what it is, such as camera or gpu_lidar", required=True, default="")),
    (
        POSE,
        value("update_rate", NUMBER, "measurements a second; 0 for one each step", "Hz", default="0"),
        value("always_on", TRUTH, "whether it measures while nobody listens", default="false"),
        value("visualize", TRUTH, "whether what it measures is drawn", default="false"),
        value("enable_metrics", TRUTH, "whether it tells how fast it is", default="false"),
        value("topic", TEXT, "where it publishes", default=""),
        value("frame_id", TEXT, "the frame of its messages", default=""),
        value("gz_frame_id", TEXT, "the frame of its messages, before SDF 1.12", default=""),
        value("ignition_frame_id", TEXT, "the frame of its messages, in older files", default=""),
        _CAMERA,
        _lidar("lidar"),
        _lidar("ray"),
        _IMU,
        made(
            ContactSensor,
            "contact",
            "what a contact sensor listens to",
            value("collision", TEXT, "the collision", default="__default__"),
            value("topic", TEXT, "the topic of its messages", default="__default_topic__"),
        ),
        _navsat("navsat"),
        _navsat("gps"),
        _xyz("magnetometer", "noise of a magnetometer", None),
        made(
            Altimeter,
            "altimeter",
            "noise of an altimeter",
            _around("vertical_position", "noise on the height"),
            _around("vertical_velocity", "noise on the vertical velocity"),
        ),
        made(
            AirPressure,
            "air_pressure",
            "what a barometer measures",
            value("reference_altitude", NUMBER, "the altitude of its zero", "m", default="0"),
            _around("pressure", "noise on the pressure", "noise"),
        ),
        _FORCE_TORQUE,
        _SONAR,
        made(
            LogicalCamera,
            "logical_camera",
            "what a camera that names models sees",
            value("near", NUMBER, "the nearest", "m", default="0"),
            value("far", NUMBER, "the farthest", "m", default="1"),
            value("aspect_ratio", NUMBER, "width of what it sees by its height", default="1"),
            value("horizontal_fov", NUMBER, "the angle that it sees across", "rad", default="1"),
        ),
        PLUGIN,
    ),
    many=True,
    make=_sensor_of,
    keeps=True,
    located=True,
    owns=True,
    field="sensors",
)
