"""The parameters of ekf_node and ukf_node, as robot_localization declares them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Node, Parameter, ParameterType
from linkwright.navigation.estimation.estimator import Timing
from linkwright.navigation.estimation.kalman import Control, Settings
from linkwright.navigation.estimation.motion_model import STATE_SIZE, Matrix
from linkwright.navigation.estimation.readings import GRAVITY, UsedFlags
from linkwright.nodes.settings import check_positive, invalid_value_error

KINDS = ("odom", "pose", "twist", "imu")
"""The kinds of sensors, in the order of their parameters: ``odom0``, ``odom1``, ..., ``pose0``, ..."""

_PROVIDED_QUANTITIES = {
    "odom": (True, True, False),
    "pose": (True, False, False),
    "twist": (False, True, False),
    "imu": (True, True, True),
}
"""Whether a kind of sensor provides a pose, a twist and an acceleration."""


@dataclass(frozen=True, slots=True)
class Frames:
    """The names of the frames.

    `world` equals `map` or `odom`, and `output` is the body frame in messages.
    """

    map: str
    odom: str
    base: str
    output: str
    world: str


@dataclass(frozen=True, slots=True)
class SensorSettings:
    """The settings of one sensor.

    Attributes:
        name: the name, such as ``odom0``.
        kind: one of `KINDS`.
        topic: the topic of the sensor's messages.
        used: whether the filter uses each of the 15 state values from this sensor.
        differential: whether the sensor's poses are used as velocities.
        relative: whether the sensor's poses are relative to the first pose.
        queue_size: the depth of the subscription.
        pose_threshold: a pose is rejected if it deviates by more than this number of standard deviations.
        twist_threshold: the same for twists.
        acceleration_threshold: the same for accelerations.
        remove_gravity: whether to subtract gravity from the measured accelerations.
    """

    name: str
    kind: str
    topic: str
    used: UsedFlags
    differential: bool
    relative: bool
    queue_size: int
    pose_threshold: float
    twist_threshold: float
    acceleration_threshold: float
    remove_gravity: bool


@dataclass(frozen=True, slots=True)
class Configuration:
    """The parameters of a node.

    Times are in nanoseconds if the name ends in ``_ns``, and in seconds otherwise.
    """

    frequency: float
    two_d: bool
    frames: Frames
    publishes_tf: bool
    publishes_acceleration: bool
    publishes_corrections: bool
    transform_offset_ns: int
    reset_on_time_jump: bool
    gravity: float
    publishes_diagnostics: bool
    is_initially_enabled: bool
    timing: Timing
    filter: Settings
    sensors: tuple[SensorSettings, ...]


def read_configuration(node: Node) -> Configuration:
    """Declare and read the parameters of a node.

    Raises:
        LinkwrightError: NODE433, a value is invalid; NODE441, a list has the wrong length; NODE442, two frames are the
            same.
    """
    declare = node.declare_parameter
    frequency = check_positive(node, "frequency", declare("frequency", 30.0).value)
    timeout: float = declare("sensor_timeout", 1.0 / frequency).value
    smooths_lagged_data: bool = declare("smooth_lagged_data", False).value
    history_seconds: float = declare("history_length", 0.0).value
    for name, default in (("debug", False), ("debug_out_file", "robot_localization_debug.txt")):
        declare(name, default)
    declare("transform_timeout", 0.0)  # The parameter has no effect, because lookups never wait.
    sensors = tuple(_read_sensors(node))
    return Configuration(
        frequency=frequency,
        two_d=declare("two_d_mode", False).value,
        frames=_read_frames(node),
        publishes_tf=declare("publish_tf", True).value,
        publishes_acceleration=declare("publish_acceleration", False).value,
        publishes_corrections=declare("permit_corrected_publication", False).value,
        transform_offset_ns=_nanoseconds_from_seconds(declare("transform_time_offset", 0.0).value),
        reset_on_time_jump=declare("reset_on_time_jump", False).value,
        gravity=declare("gravitational_acceleration", GRAVITY).value,
        publishes_diagnostics=declare("print_diagnostics", False).value,
        is_initially_enabled=not declare("disabled_at_startup", False).value,
        timing=Timing(
            sensor_timeout_ns=_nanoseconds_from_seconds(timeout),
            predict_to_now=declare("predict_to_current_time", False).value,
            history_ns=_nanoseconds_from_seconds(abs(history_seconds)) if smooths_lagged_data else None,
        ),
        filter=Settings(
            noise=_read_covariance(node, "process_noise_covariance", Settings().noise),
            initial_covariance=_read_covariance(node, "initial_estimate_covariance", Settings().initial_covariance),
            initial_state=np.array(_read_numbers(node, "initial_state", (STATE_SIZE,)) or [0.0] * STATE_SIZE),
            uses_dynamic_noise=declare("dynamic_process_noise_covariance", False).value,
            control=_read_control(node, sensors),
        ),
        sensors=sensors,
    )


def _read_frames(node: Node) -> Frames:
    def name(parameter: str, default: str) -> str:
        value: str = node.declare_parameter(parameter, default).value
        return value.removeprefix("/")

    world_map, odom, base = name("map_frame", "map"), name("odom_frame", "odom"), name("base_link_frame", "base_link")
    frames = Frames(world_map, odom, base, name("base_link_frame_output", base), name("world_frame", odom))
    if len({frames.map, frames.odom, frames.base}) < 3 or frames.output in (frames.map, frames.odom):
        raise LinkwrightError(
            Diagnostic(
                "NODE442",
                phrase(
                    "map_frame '{map}', odom_frame '{odom}' and base_link_frame '{base}' must be different frames",
                    map=frames.map,
                    odom=frames.odom,
                    base=frames.base,
                ),
                hint=phrase("see REP 105; the defaults are map, odom and base_link"),
            )
        )
    if frames.world not in (frames.map, frames.odom):
        raise invalid_value_error("world_frame", frames.world, node.get_name(), (frames.map, frames.odom))
    return frames


def _read_sensors(node: Node) -> Iterator[SensorSettings]:
    for kind in KINDS:
        number = 0
        while True:
            name = f"{kind}{number}"
            node.declare_parameter(name, ParameterType.STRING)
            topic = node.get_parameter_or(name, Parameter(name)).value
            if topic is None:
                node.undeclare_parameter(name)
                break
            yield _read_sensor(node, kind, name, topic)
            number += 1


def _read_sensor(node: Node, kind: str, name: str, topic: str) -> SensorSettings:
    pose, twist, acceleration = _PROVIDED_QUANTITIES[kind]

    def declare(suffix: str, default: bool | float) -> bool | float:
        value: bool | float = node.declare_parameter(f"{name}_{suffix}", default).value
        return value

    used = _read_flags(node, f"{name}_config", STATE_SIZE) or (False,) * STATE_SIZE
    provided_flags = (*[pose] * 6, *[twist] * 6, *[acceleration] * 3)
    if kind == "imu":
        provided_flags = (*[False] * 3, *[True] * 3, *[False] * 3, *[True] * 6)
    differential = bool(declare("differential", False)) if pose else False
    relative = bool(declare("relative", False)) if pose else False
    if differential and relative:
        node.get_logger().warning(
            f"Both {name}_differential and {name}_relative were set to true. Using differential mode."
        )
        relative = False
    names = ("rejection_threshold",) * 2 if kind in ("pose", "twist") else _THRESHOLD_PARAMETERS
    sensor = SensorSettings(
        name=name,
        kind=kind,
        topic=topic,
        used=tuple(bool(flag and is_provided) for flag, is_provided in zip(used, provided_flags, strict=True)),
        differential=differential,
        relative=relative,
        queue_size=int(declare("queue_size", 10)),
        pose_threshold=declare(names[0], inf) if pose else inf,
        twist_threshold=declare(names[1], inf) if twist else inf,
        acceleration_threshold=declare("linear_acceleration_rejection_threshold", inf) if acceleration else inf,
        remove_gravity=bool(declare("remove_gravitational_acceleration", False)) if acceleration else False,
    )
    declare("nodelay", False)  # A parameter of ROS 1 that parameter files still contain.
    if not any(sensor.used):
        node.get_logger().warning(
            f"{topic} is listed as an input topic ({name}), but {name}_config enables none of its values"
        )
    return sensor


_CONTROL_TIMEOUT_S = 0.2
"""The documented default in seconds. The code of robot_localization has 0, which ignores every command."""
_THRESHOLD_PARAMETERS = ("pose_rejection_threshold", "twist_rejection_threshold")


def _read_control(node: Node, sensors: Sequence[SensorSettings]) -> Control | None:
    """Return the response to commanded velocities, or None if they are not used.

    All parameters are declared even if unused, so that they are not reported as unknown.
    """
    uses_control: bool = node.declare_parameter("use_control", False).value
    timeout: float = node.declare_parameter("control_timeout", _CONTROL_TIMEOUT_S).value
    node.declare_parameter("stamped_control", False)
    used = _read_flags(node, "control_config", 6)
    acceleration_limits = _read_numbers(node, "acceleration_limits", (6,)) or [1.0] * 6
    acceleration_gains = _read_numbers(node, "acceleration_gains", (6,)) or [1.0] * 6
    deceleration_limits = _read_numbers(node, "deceleration_limits", (6,)) or acceleration_limits
    deceleration_gains = _read_numbers(node, "deceleration_gains", (6,)) or acceleration_gains
    if not uses_control:
        return None
    for index, axis in enumerate("XYZ"):
        if used is not None and used[index] and any(sensor.used[12 + index] for sensor in sensors):
            node.get_logger().warning(
                f"{axis} acceleration is being measured from IMU; {axis} velocity control input is disabled"
            )
            used = (*used[:index], False, *used[index + 1 :])
    if used is None or not any(used):
        node.get_logger().warning(
            "use_control is set to true, but control_config has no true value. No control term will be used."
        )
        return None
    return Control(
        used,
        _nanoseconds_from_seconds(timeout),
        tuple(acceleration_limits),
        tuple(acceleration_gains),
        tuple(deceleration_limits),
        tuple(deceleration_gains),
    )


def _read_covariance(node: Node, name: str, default: Matrix) -> Matrix:
    """Return a covariance from a parameter, or the default if the parameter is not set.

    The parameter has all 225 numbers or the 15 numbers of the diagonal.
    """
    numbers = _read_numbers(node, name, (STATE_SIZE * STATE_SIZE, STATE_SIZE))
    if numbers is None:
        return default
    return np.diag(numbers) if len(numbers) == STATE_SIZE else np.array(numbers).reshape(STATE_SIZE, STATE_SIZE)


def _read_numbers(node: Node, name: str, lengths: tuple[int, ...]) -> list[float] | None:
    node.declare_parameter(name, ParameterType.DOUBLE_ARRAY)
    numbers = node.get_parameter_or(name, Parameter(name)).value
    if numbers is None:
        return None
    check_length(name, len(numbers), lengths)
    return [float(number) for number in numbers]


def _read_flags(node: Node, name: str, length: int) -> UsedFlags | None:
    node.declare_parameter(name, ParameterType.BOOL_ARRAY)
    flags = node.get_parameter_or(name, Parameter(name)).value
    if flags is None:
        return None
    check_length(name, len(flags), (length,))
    return tuple(bool(flag) for flag in flags)


def check_length(name: str, length: int, lengths: tuple[int, ...]) -> None:
    """Check that a parameter's list has one of the permitted lengths.

    Raises:
        LinkwrightError: NODE441, the length is wrong.
    """
    if length not in lengths:
        permitted_lengths = " / ".join(str(length) for length in lengths)
        message = phrase(
            "parameter '{name}' must have {known} values, but it has {length}",
            name=name,
            known=permitted_lengths,
            length=length,
        )
        raise LinkwrightError(Diagnostic("NODE441", message))


def _nanoseconds_from_seconds(seconds: float) -> int:
    return round(seconds * 1e9)
