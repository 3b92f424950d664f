"""The parameters of amcl, with nav2's names and defaults."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from linkwright.graph import Node
from linkwright.navigation.localization.motion_models import (
    MotionModel,
    Noise,
    Pose,
    move_differentially,
    move_omnidirectionally,
)
from linkwright.navigation.localization.particle_filter import FilterSettings
from linkwright.navigation.localization.sensor_models import MODELS, BeamSkipping, LaserSettings
from linkwright.nodes.parameter_tables import declare_table
from linkwright.nodes.settings import invalid_value_error

_MOTION_MODELS: dict[str, MotionModel] = {
    "differential": move_differentially,
    "nav2_amcl::DifferentialMotionModel": move_differentially,
    "omnidirectional": move_omnidirectionally,
    "nav2_amcl::OmniMotionModel": move_omnidirectionally,
}
_POSITIVE_PARAMETERS = ("max_particles", "min_particles", "max_beams", "resample_interval", "sigma_hit", "pf_err")
_NON_NEGATIVE_PARAMETERS = ("laser_likelihood_max_dist", *(f"alpha{number}" for number in range(1, 6)))


@dataclass(frozen=True, kw_only=True)
class InitialPose:
    """The parameters ``initial_pose.*``, in meters and radians."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0


@dataclass(frozen=True, kw_only=True)
class AmclParameters:
    """The parameters that are in neither `LaserSettings` nor `FilterSettings`.

    Units are meters, radians and seconds.
    """

    alpha1: float = 0.2
    alpha2: float = 0.2
    alpha3: float = 0.2
    alpha4: float = 0.2
    alpha5: float = 0.2
    base_frame_id: str = "base_footprint"
    beam_skip_distance: float = 0.5
    beam_skip_error_threshold: float = 0.9
    beam_skip_threshold: float = 0.3
    do_beamskip: bool = False
    global_frame_id: str = "map"
    laser_max_range: float = 100.0
    laser_min_range: float = -1.0
    laser_model_type: str = "likelihood_field"
    set_initial_pose: bool = False
    initial_pose: InitialPose = InitialPose()
    max_beams: int = 60
    odom_frame_id: str = "odom"
    resample_interval: int = 1
    robot_model_type: str = "nav2_amcl::DifferentialMotionModel"
    save_pose_rate: float = 0.5
    tf_broadcast: bool = True
    transform_tolerance: float = 1.0
    update_min_a: float = 0.2
    update_min_d: float = 0.25
    always_reset_initial_pose: bool = False
    scan_topic: str = "scan"
    map_topic: str = "map"
    first_map_only: bool = False
    freespace_downsampling: bool = False


@dataclass(frozen=True, slots=True)
class AmclSettings:
    """The parameters, and the objects created from them.

    Attributes:
        parameters: the values of `AmclParameters`.
        base_frame: the frame of the robot.
        odom_frame: the frame of odometry.
        global_frame: the frame of the map.
        motion_model: the motion model.
        noise: the noise of odometry.
        laser: the settings of the laser model.
        beam_skipping: the settings of beam skipping; None to skip no beams.
        filter: the settings of the particle filter.
        initial_pose: the initial pose of the robot; None to wait for one.
    """

    parameters: AmclParameters
    base_frame: str
    odom_frame: str
    global_frame: str
    motion_model: MotionModel
    noise: Noise
    laser: LaserSettings
    beam_skipping: BeamSkipping | None
    filter: FilterSettings
    initial_pose: Pose | None


def declare_parameters(node: Node) -> tuple[AmclParameters, LaserSettings, FilterSettings]:
    """Declare all parameters that are not declared yet, and read them."""
    return declare_table(node, AmclParameters), declare_table(node, LaserSettings), declare_table(node, FilterSettings)


def read_parameters(node: Node) -> AmclSettings:
    """Read all parameters.

    Raises:
        LinkwrightError: NODE433, a parameter has an invalid value.
    """
    parameters, laser, particles = declare_parameters(node)
    for name in (*_POSITIVE_PARAMETERS, *_NON_NEGATIVE_PARAMETERS):
        value: Any = node.get_parameter(name).value
        if value < 0 or (name in _POSITIVE_PARAMETERS and value == 0):
            raise invalid_value_error(name, value, node.get_name())
    if parameters.laser_model_type not in MODELS:
        raise invalid_value_error("laser_model_type", parameters.laser_model_type, node.get_name(), MODELS)
    if particles.min_particles > particles.max_particles:
        raise invalid_value_error("min_particles", particles.min_particles, node.get_name())
    beam_skipping = None
    if parameters.do_beamskip and parameters.laser_model_type == "likelihood_field_prob":
        beam_skipping = BeamSkipping(
            parameters.beam_skip_distance, parameters.beam_skip_threshold, parameters.beam_skip_error_threshold
        )
    pose = parameters.initial_pose
    return AmclSettings(
        parameters=parameters,
        base_frame=parameters.base_frame_id.removeprefix("/"),
        odom_frame=parameters.odom_frame_id.removeprefix("/"),
        global_frame=parameters.global_frame_id.removeprefix("/"),
        motion_model=_find_motion_model(node, parameters.robot_model_type),
        # alpha1: rotation from rotation, alpha2: rotation from translation, alpha3: translation from translation,
        # alpha4: translation from rotation.
        noise=Noise(parameters.alpha1, parameters.alpha2, parameters.alpha3, parameters.alpha4, parameters.alpha5),
        laser=laser,
        beam_skipping=beam_skipping,
        filter=particles,
        initial_pose=(pose.x, pose.y, pose.yaw) if parameters.set_initial_pose else None,
    )


def _find_motion_model(node: Node, name: str) -> MotionModel:
    motion = _MOTION_MODELS.get(name)
    if motion is None:
        node.get_logger().warning(
            f"robot_model_type '{name}' is not one of {', '.join(_MOTION_MODELS)}; particles move as for "
            "a differential drive"
        )
        return move_differentially
    return motion
