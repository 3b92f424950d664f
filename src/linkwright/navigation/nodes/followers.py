"""Plugins of nav2's controller_server: Linkwright's classes with nav2's names and parameters.

Deliberate differences: one sampling follower replaces DWB and MPPI. It uses the limits and times among the parameters
of both, and logs which other parameters were set.
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
from linkwright.navigation.following.sampling import Limits, SamplingFollower, SamplingParameters
from linkwright.navigation.nodes.plugins import declare_unused, type_of, value_of
from linkwright.nodes.parameter_tables import declared
from linkwright.nodes.settings import bad_value

DWB, MPPI = "dwb_core/DWBLocalPlanner", "nav2_mppi_controller/MPPIController"
PURE_PURSUIT = "nav2_regulated_pure_pursuit_controller/RegulatedPurePursuitController"
ROTATION_SHIM = "nav2_rotation_shim_controller/RotationShimController"

USUAL_FOLLOWERS = {"FollowPath": DWB}
USUAL_GOAL_CHECKERS = {"goal_checker": "nav2_controller/SimpleGoalChecker"}
USUAL_PROGRESS_CHECKERS = {"progress_checker": "nav2_controller/SimpleProgressChecker"}


def make_follower(node: Node, plugin: str) -> Follower:
    """Create the path follower of a plugin.

    Raises:
        LinkwrightError: NODE431, the plugin's type is not set; GRAPH201, a parameter has the wrong type.
    """
    kind = type_of(node, plugin, USUAL_FOLLOWERS)
    logger = node.get_logger()
    logger.info(f"Created controller : {plugin} of type {kind.replace('/', '::')}")
    if kind == ROTATION_SHIM:
        return _with_shim(node, plugin)
    follower = _made(node, plugin, kind)
    unread = declare_unused(node, plugin)
    if kind in (DWB, MPPI):
        ignored = f"; without effect here: {', '.join(unread)}" if unread else ""
        logger.info(f"{plugin}: Linkwright's velocity-sampling follower replaces {kind}{ignored}")
    elif kind != PURE_PURSUIT:
        logger.warning(f"{plugin}: {kind} is not supported; regulated pure pursuit replaces it")
    elif unread:
        logger.info(f"{plugin}: without effect here: {', '.join(unread)}")
    return follower


def _with_shim(node: Node, plugin: str) -> Follower:
    parameters = declared(node, RotationShimParameters, plugin)
    primary = str(value_of(node, f"{plugin}.primary_controller", DWB)).replace("::", "/")
    follower = RotationShim(_made(node, plugin, primary), parameters)
    unread = declare_unused(node, plugin)
    if unread:
        node.get_logger().info(f"{plugin}: without effect here: {', '.join(unread)}")
    return follower


def _made(node: Node, plugin: str, kind: str) -> Follower:
    if kind == DWB:
        return SamplingFollower(_dwb(node, plugin))
    if kind == MPPI:
        return SamplingFollower(_mppi(node, plugin))
    return RegulatedPurePursuit(declared(node, PurePursuitParameters, plugin))


def _dwb(node: Node, plugin: str) -> SamplingParameters:
    """Return the sampling settings with DWB's limits, simulated time and defaults."""

    def value(name: str, default: float) -> float:
        return float(value_of(node, f"{plugin}.{name}", default))

    limits = Limits(
        least=Velocity(value("min_vel_x", 0.0), value("min_vel_y", 0.0), -value("max_vel_theta", 0.0)),
        most=Velocity(value("max_vel_x", 0.0), value("max_vel_y", 0.0), value("max_vel_theta", 0.0)),
        acceleration=Velocity(value("acc_lim_x", 0.0), value("acc_lim_y", 0.0), value("acc_lim_theta", 0.0)),
        deceleration=Velocity(
            abs(value("decel_lim_x", 0.0)), abs(value("decel_lim_y", 0.0)), abs(value("decel_lim_theta", 0.0))
        ),
    )
    return SamplingParameters(limits=limits, seconds=value("sim_time", 1.7))


def _mppi(node: Node, plugin: str) -> SamplingParameters:
    """Return the sampling settings with MPPI's limits, simulated time and defaults."""

    def value(name: str, default: float) -> float:
        return float(value_of(node, f"{plugin}.{name}", default))

    is_sideways = value_of(node, f"{plugin}.motion_model", "DiffDrive") == "Omni"
    sideways = value("vy_max", 0.5) if is_sideways else 0.0
    limits = Limits(
        least=Velocity(max(value("vx_min", -0.35), 0.0), -sideways, -value("wz_max", 1.9)),
        most=Velocity(value("vx_max", 0.5), sideways, value("wz_max", 1.9)),
        acceleration=Velocity(value("ax_max", 3.0), value("ay_max", 3.0), value("az_max", 3.5)),
        deceleration=Velocity(abs(value("ax_min", -3.0)), abs(value("ay_min", -3.0)), value("az_max", 3.5)),
    )
    steps, step = int(value_of(node, f"{plugin}.time_steps", 56)), value("model_dt", 0.05)
    return SamplingParameters(limits=limits, seconds=min(steps * step, _LONGEST))


def make_goal_checker(node: Node, plugin: str) -> GoalChecker:
    """Create the goal checker of a plugin; see `make_follower`."""
    kind = type_of(node, plugin, USUAL_GOAL_CHECKERS)
    checkers: dict[str, Callable[[], GoalChecker]] = {
        "nav2_controller/SimpleGoalChecker": lambda: SimpleGoalChecker(declared(node, SimpleGoalParameters, plugin)),
        "nav2_controller/StoppedGoalChecker": lambda: StoppedGoalChecker(declared(node, StoppedGoalParameters, plugin)),
    }
    checker: GoalChecker = _checker(node, plugin, kind, checkers)
    return checker


def make_progress_checker(node: Node, plugin: str) -> ProgressChecker:
    """Create the progress checker of a plugin; see `make_follower`."""
    kind = type_of(node, plugin, USUAL_PROGRESS_CHECKERS)
    checkers: dict[str, Callable[[], ProgressChecker]] = {
        "nav2_controller/SimpleProgressChecker": lambda: ProgressChecker(declared(node, ProgressParameters, plugin)),
        "nav2_controller/PoseProgressChecker": lambda: ProgressChecker(declared(node, PoseProgressParameters, plugin)),
    }
    checker: ProgressChecker = _checker(node, plugin, kind, checkers)
    return checker


def _checker(node: Node, plugin: str, kind: str, known: dict[str, Callable[[], Any]]) -> Any:
    if kind not in known:
        raise bad_value(f"{plugin}.plugin", kind, node.get_name(), list(known))
    return known[kind]()


_LONGEST = 2.0
"""Seconds for which a motion is simulated at the most."""
