"""The parameters of MoveIt Servo's node, as Humble and Jazzy name them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.planning.groups import JointGroup
from linkwright.planning.servo import ServoSettings

PREFIX = "moveit_servo."
_POSITIVE = (
    "publish_period", "incoming_command_timeout", "lower_singularity_threshold", "hard_stop_singularity_threshold",
    "leaving_singularity_threshold_multiplier", "self_collision_proximity_threshold",
    "scene_collision_proximity_threshold", "collision_check_rate", "singularity_step_scale",
)  # fmt: skip
_CHOICES = {
    "command_in_type": ("unitless", "speed_units"),
    "command_out_type": ("trajectory_msgs/JointTrajectory", "std_msgs/Float64MultiArray"),
}


@dataclass(frozen=True, slots=True)
class ServoParameters:
    """The parameters of the node that are not those of `ServoSettings`; the names are MoveIt's."""

    move_group_name: str
    active_subgroup: str = ""
    cartesian_command_in_topic: str = "~/delta_twist_cmds"
    joint_command_in_topic: str = "~/delta_joint_cmds"
    pose_command_in_topic: str = "~/pose_target_cmds"
    command_in_type: str = "unitless"
    linear_scale: float = 0.4
    rotational_scale: float = 0.8
    joint_scale: float = 0.5
    incoming_command_timeout: float = 0.1
    robot_link_command_frame: str = ""
    apply_twist_commands_about_ee_frame: bool = True
    linear_tolerance: float = 0.001
    angular_tolerance: float = 0.01
    status_topic: str = "~/status"
    command_out_topic: str = "/panda_arm_controller/joint_trajectory"
    command_out_type: str = "trajectory_msgs/JointTrajectory"
    publish_joint_positions: bool = True
    publish_joint_velocities: bool = True
    publish_joint_accelerations: bool = False
    num_outgoing_halt_msgs_to_publish: int = 4
    joint_topic: str = "joint_states"
    monitored_planning_scene_topic: str = "/planning_scene"
    check_collisions: bool = True
    collision_check_rate: float = 10.0
    halt_all_joints_in_joint_mode: bool = True
    halt_all_joints_in_cartesian_mode: bool = True


def read_parameters(parameters: Mapping[str, Any]) -> ServoParameters:
    """Return the parameters of the node.

    Args:
        parameters: the parameters by name, such as ``moveit_servo.scale.linear``.

    Raises:
        LinkwrightError: ARM107, a parameter has an invalid value, or ``move_group_name`` is missing.
    """
    values: dict[str, Any] = {}
    for name, default in (*_defaults().items(), ("move_group_name", "")):
        path = {"linear_scale": "scale.linear", "rotational_scale": "scale.rotational", "joint_scale": "scale.joint"}
        path |= {key: f"pose_tracking.{key}" for key in ("linear_tolerance", "angular_tolerance")}
        values[name] = _read(parameters, path.get(name, name), default)
    if not values["move_group_name"]:
        raise _invalid("move_group_name", values["move_group_name"])
    return ServoParameters(**values)


def read_settings(parameters: Mapping[str, Any], group: JointGroup) -> ServoSettings:
    """Return the settings of the motion.

    Args:
        parameters: the parameters by name.
        group: the joints to move.

    Raises:
        LinkwrightError: ARM107, a parameter has an invalid value.
    """
    defaults = ServoSettings(np.empty(0))
    names = [name for name in ServoSettings.__slots__ if name != "joint_limit_margins"]
    values = {name: _read(parameters, name, getattr(defaults, name)) for name in names}
    margins = parameters.get(f"{PREFIX}joint_limit_margins", parameters.get(f"{PREFIX}joint_limit_margin", 0.1))
    count = len(group.joint_names)
    try:
        row = np.broadcast_to(np.asarray(margins, dtype=np.float64), (count,))
    except (TypeError, ValueError):
        raise _invalid("joint_limit_margins", margins) from None
    if not np.all(np.isfinite(row)) or np.any(row < 0.0):
        raise _invalid("joint_limit_margins", margins)
    if values["lower_singularity_threshold"] >= values["hard_stop_singularity_threshold"]:
        raise _invalid("hard_stop_singularity_threshold", values["hard_stop_singularity_threshold"])
    return ServoSettings(row.copy(), **values)


def _defaults() -> dict[str, Any]:
    defaults = ServoParameters("arm")
    return {name: getattr(defaults, name) for name in ServoParameters.__slots__ if name != "move_group_name"}


def _read(parameters: Mapping[str, Any], name: str, default: Any) -> Any:
    """Return a parameter of the type of its default."""
    value = parameters.get(f"{PREFIX}{name}", default)
    if isinstance(default, float) and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    is_valid = type(value) is type(default) and (not isinstance(value, float) or bool(np.isfinite(value)))
    if not is_valid or (name in _POSITIVE and value <= 0.0) or value not in _CHOICES.get(name, (value,)):
        raise _invalid(name, value)
    return value


def _invalid(name: str, value: Any) -> LinkwrightError:
    message = phrase(
        "the parameter '{name}' of servo_node has the invalid value {value}", name=PREFIX + name, value=repr(value)
    )
    return LinkwrightError(Diagnostic("ARM107", message))
