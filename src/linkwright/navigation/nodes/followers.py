"""Plugins of nav2's controller_server, with nav2's names and parameters.

A deliberate difference: one sampling follower replaces DWB and MPPI. It uses their parameters for limits and times, and
logs which other parameters are set.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph import Node
from linkwright.navigation.following.checkers import (
    GoalChecker,
    PoseProgressParameters,
    ProgressChecker,
    ProgressParameters,
    SimpleGoalChecker,
    SimpleGoalParameters,
    StoppedGoalChecker,
    StoppedGoalParameters,
)
from linkwright.navigation.following.follower import Follower, Velocity
from linkwright.navigation.following.pure_pursuit import PurePursuitParameters, RegulatedPurePursuit
from linkwright.navigation.following.rotation_shim import RotationShim, RotationShimParameters
from linkwright.navigation.following.sampling import SamplingFollower, SamplingParameters, VelocityLimits
from linkwright.navigation.nodes.plugins import declare_unused, get_or_declare, get_plugin_type
from linkwright.nodes.parameter_tables import declare_table
from linkwright.nodes.settings import invalid_value_error

DWB, MPPI = "dwb_core/DWBLocalPlanner", "nav2_mppi_controller/MPPIController"
PURE_PURSUIT = "nav2_regulated_pure_pursuit_controller/RegulatedPurePursuitController"
ROTATION_SHIM = "nav2_rotation_shim_controller/RotationShimController"

DEFAULT_FOLLOWERS = {"FollowPath": DWB}
DEFAULT_GOAL_CHECKERS = {"goal_checker": "nav2_controller/SimpleGoalChecker"}
DEFAULT_PROGRESS_CHECKERS = {"progress_checker": "nav2_controller/SimpleProgressChecker"}


def make_follower(node: Node, plugin: str) -> Follower:
    """Create the path follower of a plugin.

    Raises:
        LinkwrightError: NODE431, the plugin's type is not set; GRAPH201, a parameter has the wrong type.
    """
    kind = get_plugin_type(node, plugin, DEFAULT_FOLLOWERS)
    logger = node.get_logger()
    logger.info(f"Created controller : {plugin} of type {kind.replace('/', '::')}")
    if kind == ROTATION_SHIM:
        return _make_rotation_shim(node, plugin)
    follower = _make_basic_follower(node, plugin, kind)
    unused_parameters = declare_unused(node, plugin)
    if kind in (DWB, MPPI):
        note = f"; these parameters have no effect: {', '.join(unused_parameters)}" if unused_parameters else ""
        logger.info(f"{plugin}: Linkwright's velocity-sampling follower replaces {kind}{note}")
    elif kind != PURE_PURSUIT:
        logger.warning(f"{plugin}: {kind} is not supported; regulated pure pursuit replaces it")
    elif unused_parameters:
        logger.info(f"{plugin}: these parameters have no effect: {', '.join(unused_parameters)}")
    return follower


def _make_rotation_shim(node: Node, plugin: str) -> Follower:
    parameters = declare_table(node, RotationShimParameters, plugin)
    primary = str(get_or_declare(node, f"{plugin}.primary_controller", DWB)).replace("::", "/")
    follower = RotationShim(_make_basic_follower(node, plugin, primary), parameters)
    unused_parameters = declare_unused(node, plugin)
    if unused_parameters:
        node.get_logger().info(f"{plugin}: these parameters have no effect: {', '.join(unused_parameters)}")
    return follower


def _make_basic_follower(node: Node, plugin: str, kind: str) -> Follower:
    if kind == DWB:
        return SamplingFollower(_read_dwb_parameters(node, plugin))
    if kind == MPPI:
        return SamplingFollower(_read_mppi_parameters(node, plugin))
    return RegulatedPurePursuit(declare_table(node, PurePursuitParameters, plugin))


def _read_dwb_parameters(node: Node, plugin: str) -> SamplingParameters:
    """Return the sampling settings with DWB's limits, simulated time and defaults."""

    def value(name: str, default: float) -> float:
        return float(get_or_declare(node, f"{plugin}.{name}", default))

    limits = VelocityLimits(
        min_velocity=Velocity(value("min_vel_x", 0.0), value("min_vel_y", 0.0), -value("max_vel_theta", 0.0)),
        max_velocity=Velocity(value("max_vel_x", 0.0), value("max_vel_y", 0.0), value("max_vel_theta", 0.0)),
        acceleration=Velocity(value("acc_lim_x", 0.0), value("acc_lim_y", 0.0), value("acc_lim_theta", 0.0)),
        deceleration=Velocity(
            abs(value("decel_lim_x", 0.0)), abs(value("decel_lim_y", 0.0)), abs(value("decel_lim_theta", 0.0))
        ),
    )
    return SamplingParameters(limits=limits, simulated_seconds=value("sim_time", 1.7))


def _read_mppi_parameters(node: Node, plugin: str) -> SamplingParameters:
    """Return the sampling settings with MPPI's limits, simulated time and defaults."""

    def value(name: str, default: float) -> float:
        return float(get_or_declare(node, f"{plugin}.{name}", default))

    is_omnidirectional = get_or_declare(node, f"{plugin}.motion_model", "DiffDrive") == "Omni"
    max_sideways = value("vy_max", 0.5) if is_omnidirectional else 0.0
    limits = VelocityLimits(
        min_velocity=Velocity(max(value("vx_min", -0.35), 0.0), -max_sideways, -value("wz_max", 1.9)),
        max_velocity=Velocity(value("vx_max", 0.5), max_sideways, value("wz_max", 1.9)),
        acceleration=Velocity(value("ax_max", 3.0), value("ay_max", 3.0), value("az_max", 3.5)),
        deceleration=Velocity(abs(value("ax_min", -3.0)), abs(value("ay_min", -3.0)), value("az_max", 3.5)),
    )
    steps, step = int(get_or_declare(node, f"{plugin}.time_steps", 56)), value("model_dt", 0.05)
    return SamplingParameters(limits=limits, simulated_seconds=min(steps * step, _MAX_DURATION_S))


def make_goal_checker(node: Node, plugin: str) -> GoalChecker:
    """Create the goal checker of a plugin.

    The exceptions are the same as for `make_follower`.
    """
    kind = get_plugin_type(node, plugin, DEFAULT_GOAL_CHECKERS)
    checkers: dict[str, Callable[[], GoalChecker]] = {
        "nav2_controller/SimpleGoalChecker": lambda: SimpleGoalChecker(
            declare_table(node, SimpleGoalParameters, plugin)
        ),
        "nav2_controller/StoppedGoalChecker": lambda: StoppedGoalChecker(
            declare_table(node, StoppedGoalParameters, plugin)
        ),
    }
    checker: GoalChecker = _make_checker(node, plugin, kind, checkers)
    return checker


def make_progress_checker(node: Node, plugin: str) -> ProgressChecker:
    """Create the progress checker of a plugin.

    The exceptions are the same as for `make_follower`.
    """
    kind = get_plugin_type(node, plugin, DEFAULT_PROGRESS_CHECKERS)
    checkers: dict[str, Callable[[], ProgressChecker]] = {
        "nav2_controller/SimpleProgressChecker": lambda: ProgressChecker(
            declare_table(node, ProgressParameters, plugin)
        ),
        "nav2_controller/PoseProgressChecker": lambda: ProgressChecker(
            declare_table(node, PoseProgressParameters, plugin)
        ),
    }
    checker: ProgressChecker = _make_checker(node, plugin, kind, checkers)
    return checker


def _make_checker(node: Node, plugin: str, kind: str, factories: dict[str, Callable[[], Any]]) -> Any:
    if kind not in factories:
        raise invalid_value_error(f"{plugin}.plugin", kind, node.get_name(), list(factories))
    return factories[kind]()


_MAX_DURATION_S = 2.0
"""The maximum time for which a motion is simulated, in seconds."""
