"""The parameters of plans (``PlanRequestParameters`` and ``MultiPipelinePlanRequestParameters``)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from linkwright.moveit_py.session import HasSession

_SECTION = "plan_request_params."


class PlanRequestParameters:
    """The parameters of a plan, as ``plan_request_params`` in the parameters of the node has them.

    Args:
        moveit_py_instance: the instance with the parameters.
        ns: the namespace of the section; empty for the one of all plans.

    Attributes:
        planner_id: the planner; empty for the default of the pipeline.
        planning_pipeline: the pipeline; empty for the first one.
        planning_attempts: accepted for compatibility; one plan is made.
        planning_time: the maximum time in s.
        max_velocity_scaling_factor: the share of the maximum velocities, from 0 to 1.
        max_acceleration_scaling_factor: the share of the maximum accelerations, from 0 to 1.
    """

    def __init__(self, moveit_py_instance: HasSession, ns: str = "") -> None:
        values = _section(moveit_py_instance.session.parameters, f"{ns}.{_SECTION}" if ns else _SECTION)
        if ns and not values:
            moveit_py_instance.session.log_warning(f"There are no parameters '{ns}.{_SECTION}*'; the defaults are used")
        self.planner_id = str(values.get("planner_id", ""))
        self.planning_pipeline = str(values.get("planning_pipeline", ""))
        self.planning_attempts = int(values.get("planning_attempts", 1))
        self.planning_time = float(values.get("planning_time", 1.0))
        self.max_velocity_scaling_factor = float(values.get("max_velocity_scaling_factor", 1.0))
        self.max_acceleration_scaling_factor = float(values.get("max_acceleration_scaling_factor", 1.0))


class MultiPipelinePlanRequestParameters:
    """The parameters of several plans for one goal.

    Args:
        moveit_py_instance: the instance with the parameters.
        planning_pipelines: the namespace of each plan's section.

    Attributes:
        multi_plan_request_parameters: the parameters of each plan.
    """

    def __init__(self, moveit_py_instance: HasSession, planning_pipelines: Iterable[str]) -> None:
        self.multi_plan_request_parameters = [
            PlanRequestParameters(moveit_py_instance, name) for name in planning_pipelines
        ]


def _section(parameters: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    return {name[len(prefix) :]: value for name, value in parameters.items() if name.startswith(prefix)}
