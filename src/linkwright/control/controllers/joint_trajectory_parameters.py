"""The parameters of ``joint_trajectory_controller/JointTrajectoryController``.

Source: ros2_controllers for Humble and Jazzy; parameters that exist in only one of them are marked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.control.controllers.pid_parameters import PidParameters
from linkwright.control.hardware.interfaces import ACCELERATION, EFFORT, POSITION, VELOCITY
from linkwright.control.motion.tolerances import StateTolerance, Tolerances
from linkwright.diagnostics import Phrase, phrase
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, at_least, for_each, not_empty, one_of, parameter

_check_command_names = one_of(POSITION, VELOCITY, ACCELERATION, EFFORT)
_check_state_names = one_of(POSITION, VELOCITY, ACCELERATION)


def _check_command_combination(name: str, value: tuple[str, ...]) -> Phrase | None:
    """Return an error message unless the command interfaces are a valid combination.

    The valid combinations are effort, velocity, position, and position with velocity and optionally acceleration.
    """
    problem = not_empty(name, value) or _check_command_names(name, value)
    if problem is not None:
        return problem
    if VELOCITY in value and len(value) > 1 and POSITION not in value:
        return phrase("'velocity' command interface can be used either alone or 'position' interface has to be present")
    if ACCELERATION in value and (VELOCITY not in value or POSITION not in value):
        return phrase(
            "'acceleration' command interface can only be used if 'velocity' and 'position' interfaces are present"
        )
    if EFFORT in value and len(value) > 1:
        return phrase("'effort' command interface has to be used alone")
    return None


def _check_state_combination(name: str, value: tuple[str, ...]) -> Phrase | None:
    """Return an error message unless the state interfaces are a valid combination.

    The valid combinations are position, position with velocity, and all three.
    """
    problem = not_empty(name, value) or _check_state_names(name, value)
    if problem is not None:
        return problem
    if VELOCITY in value and POSITION not in value:
        return phrase("'velocity' state interface cannot be used if 'position' interface is missing.")
    if ACCELERATION in value and not (POSITION in value and VELOCITY in value):
        return phrase(
            "'acceleration' state interface cannot be used if 'position' and 'velocity' interfaces are not present."
        )
    return None


@dataclass(frozen=True, kw_only=True)
class Gains(PidParameters):
    """The gains of a joint's PID controller."""

    ff_velocity_scale: float = parameter(0.0, description="the fraction of the desired velocity to add")
    angle_wraparound: bool = parameter(False, description="whether the joint rotates without limits", only=HUMBLE)
    normalize_error: bool = parameter(False, description="an older name of angle_wraparound", only=HUMBLE)


@dataclass(frozen=True, kw_only=True)
class JointConstraints:
    """The tolerances of a joint's position, in rad or m, where 0 means no limit."""

    trajectory: float = parameter(0.0, description="along the trajectory, in rad or m; 0 for no limit")
    goal: float = parameter(0.0, description="at the end, in rad or m; 0 for no limit")


@dataclass(frozen=True, kw_only=True)
class Constraints:
    """The tolerances of all joints, and the time limit of goals."""

    stopped_velocity_tolerance: float = parameter(0.01, description="the maximum velocity at the end, in rad/s or m/s")
    goal_time: float = parameter(
        0.0, description="the maximum delay of the goal, in seconds; 0 for no limit", check=at_least(0.0)
    )


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The parameters of a joint_trajectory_controller."""

    joints: tuple[str, ...] = parameter(
        (), read_only=True, description="the joints that trajectories move", check=not_empty
    )
    command_joints: tuple[str, ...] = parameter(
        (), read_only=True, description="the names of the commanded joints, if they differ"
    )
    command_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the command interfaces of each joint", check=_check_command_combination
    )
    state_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the state interfaces of each joint", check=_check_state_combination
    )
    allow_partial_joints_goal: bool = parameter(False, description="whether trajectories may leave out joints")
    open_loop_control: bool = parameter(
        False, read_only=True, description="whether trajectories begin at the last command", only=HUMBLE
    )
    interpolate_from_desired_state: bool = parameter(
        False, read_only=True, description="whether trajectories begin at the last command", only=JAZZY
    )
    allow_integration_in_goal_trajectories: bool = parameter(False, description="whether points may lack positions")
    set_last_command_interface_value_as_state_on_activation: bool = parameter(
        True, description="whether the controller starts at the last command, if there is one"
    )
    state_publish_rate: float | None = parameter(
        None, description="the rate of states, in Hz; each update if not set", only=HUMBLE
    )
    action_monitor_rate: float = parameter(
        20.0, read_only=True, description="the rate of feedback, in Hz", check=at_least(0.1)
    )
    interpolation_method: str = parameter(
        "splines", read_only=True, description="the interpolation between points", check=one_of("splines", "none")
    )
    allow_nonzero_velocity_at_trajectory_end: bool = parameter(
        True, description="whether a trajectory may end in motion", later=False
    )
    cmd_timeout: float = parameter(
        0.0, description="the time after the end of a trajectory until it is aborted, in seconds; more than goal_time"
    )
    gains: Mapping[str, Gains] = for_each("joints", Gains)
    constraints: Constraints = Constraints()
    joint_constraints: Mapping[str, JointConstraints] = for_each("joints", JointConstraints, prefix="constraints")

    @property
    def open_loop(self) -> bool:
        """Whether trajectories start at the last command instead of the current state."""
        return self.open_loop_control or self.interpolate_from_desired_state

    @property
    def has_pid(self) -> bool:
        """Whether a PID controller computes the commands from the errors."""
        return self.command_interfaces == (EFFORT,) or (self.command_interfaces == (VELOCITY,) and not self.open_loop)

    @property
    def tolerances(self) -> Tolerances:
        """The tolerances for trajectories without tolerances of their own."""
        joint_constraints = [self.joint_constraints[joint] for joint in self.joints]
        stopped_velocity = self.constraints.stopped_velocity_tolerance
        return Tolerances(
            tuple(StateTolerance(constraint.trajectory) for constraint in joint_constraints),
            tuple(StateTolerance(constraint.goal, stopped_velocity) for constraint in joint_constraints),
            self.constraints.goal_time,
        )
