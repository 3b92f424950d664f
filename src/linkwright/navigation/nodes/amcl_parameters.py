"""The parameters of amcl, under nav2's names and with its defaults."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

from linkwright.graph import Node
from linkwright.navigation.localization.motion_models import MotionModel, Noise, Pose, differential, omnidirectional
from linkwright.navigation.localization.particle_filter import FilterSettings
from linkwright.navigation.localization.sensor_models import MODELS, BeamSkipping, LaserSettings
from linkwright.nodes.settings import bad_value

_DEFAULTS: dict[str, Any] = {
    **{f"alpha{number}": 0.2 for number in range(1, 6)},
    "base_frame_id": "base_footprint",
    "beam_skip_distance": 0.5,
    "beam_skip_error_threshold": 0.9,
    "beam_skip_threshold": 0.3,
    "do_beamskip": False,
    "global_frame_id": "map",
    "laser_max_range": 100.0,
    "laser_min_range": -1.0,
    "laser_model_type": "likelihood_field",
    "set_initial_pose": False,
    "initial_pose.x": 0.0,
    "initial_pose.y": 0.0,
    "initial_pose.z": 0.0,
    "initial_pose.yaw": 0.0,
    "max_beams": 60,
    "odom_frame_id": "odom",
    "resample_interval": 1,
    "robot_model_type": "nav2_amcl::DifferentialMotionModel",
    "save_pose_rate": 0.5,
    "tf_broadcast": True,
    "transform_tolerance": 1.0,
    "update_min_a": 0.2,
    "update_min_d": 0.25,
    "always_reset_initial_pose": False,
    "scan_topic": "scan",
    "map_topic": "map",
    "first_map_only": False,
    "freespace_downsampling": False,
    **{field.name: field.default for kind in (LaserSettings, FilterSettings) for field in fields(kind)},
}
_MOTIONS: dict[str, MotionModel] = {
    "differential": differential,
    "nav2_amcl::DifferentialMotionModel": differential,
    "omnidirectional": omnidirectional,
    "nav2_amcl::OmniMotionModel": omnidirectional,
}
_POSITIVE = ("max_particles", "min_particles", "max_beams", "resample_interval", "sigma_hit", "pf_err")
_NOT_NEGATIVE = ("laser_likelihood_max_dist", *(f"alpha{number}" for number in range(1, 6)))


@dataclass(frozen=True, slots=True)
class AmclSettings:
    """The parameters as one object; lengths in metres, angles in radians, times in seconds.

    Attributes:
        base: the frame of the robot.
        odom: the frame of odometry.
        world: the frame of the map.
        motion: the motion model.
        noise: the noise of odometry.
        model: one of `MODELS`.
        laser: the settings of the laser model.
        skipping: the settings of beam skipping; None to skip no beams.
        filter: the settings of the particle filter.
        max_beams: the number of beams used of a scan.
        range_max: longer beams are shortened to this; negative for the scan's own limit.
        range_min: shorter beams count as without a return; negative for the scan's own limit.
        initial_pose: the pose to start at; None to wait for one.
        resample_interval: the number of measurements between two resamplings.
        update_min_d: the distance after which a scan is used.
        update_min_a: the rotation after which a scan is used.
        tolerance: how long the published transform is valid.
        broadcasts: whether the transform is published.
        forgets: whether each configuration needs a new initial pose.
        first_map_only: whether later maps are ignored.
        scan_topic: the topic of scans.
        map_topic: the topic of the map.
    """

    base: str
    odom: str
    world: str
    motion: MotionModel
    noise: Noise
    model: str
    laser: LaserSettings
    skipping: BeamSkipping | None
    filter: FilterSettings
    max_beams: int
    range_max: float
    range_min: float
    initial_pose: Pose | None
    resample_interval: int
    update_min_d: float
    update_min_a: float
    tolerance: float
    broadcasts: bool
    forgets: bool
    first_map_only: bool
    scan_topic: str
    map_topic: str


def declare_parameters(node: Node) -> None:
    """Declare all parameters."""
    for name, default in _DEFAULTS.items():
        node.declare_parameter(name, default)


def read_parameters(node: Node) -> AmclSettings:
    """Read all parameters.

    Raises:
        LinkwrightError: NODE433, one cannot have its value.
    """

    def value(name: str) -> Any:
        return node.get_parameter(name).value

    for name in (*_POSITIVE, *_NOT_NEGATIVE):
        if value(name) < 0 or (name in _POSITIVE and value(name) == 0):
            raise bad_value(name, value(name), node.get_name())
    model: str = value("laser_model_type")
    if model not in MODELS:
        raise bad_value("laser_model_type", model, node.get_name(), MODELS)
    if value("min_particles") > value("max_particles"):
        raise bad_value("min_particles", value("min_particles"), node.get_name())
    skipping = None
    if value("do_beamskip") and model == "likelihood_field_prob":
        names = ("beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold")
        skipping = BeamSkipping(*(value(name) for name in names))
    pose = (value("initial_pose.x"), value("initial_pose.y"), value("initial_pose.yaw"))
    return AmclSettings(
        base=value("base_frame_id").removeprefix("/"),
        odom=value("odom_frame_id").removeprefix("/"),
        world=value("global_frame_id").removeprefix("/"),
        motion=_motion(node, value("robot_model_type")),
        # alpha1 turn of turn, alpha2 turn of drive, alpha3 drive of drive, alpha4 drive of turn
        noise=Noise(*(value(f"alpha{number}") for number in range(1, 6))),
        model=model,
        laser=LaserSettings(**{field.name: value(field.name) for field in fields(LaserSettings)}),
        skipping=skipping,
        filter=FilterSettings(**{field.name: value(field.name) for field in fields(FilterSettings)}),
        max_beams=value("max_beams"),
        range_max=value("laser_max_range"),
        range_min=value("laser_min_range"),
        initial_pose=pose if value("set_initial_pose") else None,
        resample_interval=value("resample_interval"),
        update_min_d=value("update_min_d"),
        update_min_a=value("update_min_a"),
        tolerance=value("transform_tolerance"),
        broadcasts=value("tf_broadcast"),
        forgets=value("always_reset_initial_pose"),
        first_map_only=value("first_map_only"),
        scan_topic=value("scan_topic"),
        map_topic=value("map_topic"),
    )


def _motion(node: Node, name: str) -> MotionModel:
    motion = _MOTIONS.get(name)
    if motion is None:
        node.get_logger().warning(
            f"robot_model_type '{name}' is none of {', '.join(_MOTIONS)}; particles move as for a differential drive"
        )
        return differential
    return motion
