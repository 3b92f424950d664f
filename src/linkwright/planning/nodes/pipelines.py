"""The planning pipelines of move_group: which planner a request gets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from linkwright.planning.planner import Method
from linkwright.planning.sampling import DEFAULT_PLANNER, planner_class

_PILZ = {"PTP": Method.JOINT_LINE, "LIN": Method.CARTESIAN_LINE, "CIRC": Method.CARTESIAN_ARC}
_RESERVED = ("type", "planner_configs")


@dataclass(frozen=True, slots=True)
class PlannerChoice:
    """A planner for a request.

    Attributes:
        method: how the path is found.
        planner: the planner of OMPL.
        parameters: its parameters.
        replaced: the requested planner, if another one takes its place; else empty.
    """

    method: Method = Method.SAMPLING
    planner: str = DEFAULT_PLANNER
    parameters: Mapping[str, Any] = field(default_factory=dict)
    replaced: str = ""


class Pipelines:
    """The pipelines in the parameters of move_group.

    Args:
        parameters: the parameters by name.

    Attributes:
        names: the names of the pipelines.
        default: the name of the pipeline of requests that name none.
    """

    def __init__(self, parameters: Mapping[str, Any]) -> None:
        self._parameters = parameters
        names = parameters.get("planning_pipelines.pipeline_names") or parameters.get("planning_pipelines")
        self.names: Sequence[str] = list(names) if isinstance(names, (list, tuple)) else ["move_group"]
        self.default = str(parameters.get("default_planning_pipeline") or self.names[0])

    def planner_ids(self, pipeline: str) -> list[str]:
        """Return the names of the planners of a pipeline."""
        if self._is_pilz(pipeline):
            return list(_PILZ)
        prefix = f"{pipeline}.planner_configs."
        names = {key[len(prefix) :].split(".")[0] for key in self._parameters if key.startswith(prefix)}
        return sorted(names) or [DEFAULT_PLANNER]

    def title(self, pipeline: str) -> str:
        """Return the name of a pipeline's library."""
        return "Pilz Industrial Motion Planner" if self._is_pilz(pipeline) else "OMPL"

    def choose(self, pipeline: str, planner: str, group: str) -> PlannerChoice:
        """Return the planner for a request.

        Args:
            pipeline: the requested pipeline; empty for the default.
            planner: the requested planner; empty for the group's default.
            group: the group to plan for.
        """
        pipeline = pipeline or self.default
        if planner in _PILZ and (self._is_pilz(pipeline) or pipeline not in self.names):
            return PlannerChoice(_PILZ[planner])
        if self._is_pilz(pipeline):
            return PlannerChoice(Method.JOINT_LINE, replaced=planner)
        planner = planner or str(self._parameters.get(f"{pipeline}.{group}.default_planner_config") or "")
        prefix = f"{pipeline}.planner_configs.{planner}."
        settings = {key[len(prefix) :]: value for key, value in self._parameters.items() if key.startswith(prefix)}
        kind = planner_class(str(settings.get("type") or planner)) if planner else DEFAULT_PLANNER
        parameters = {key: value for key, value in settings.items() if key not in _RESERVED}
        if kind is None:
            return PlannerChoice(replaced=planner)
        return PlannerChoice(planner=kind, parameters=parameters)

    def _is_pilz(self, pipeline: str) -> bool:
        plugins = self._parameters.get(f"{pipeline}.planning_plugins") or ()
        plugin = str(self._parameters.get(f"{pipeline}.planning_plugin") or "")
        return any("pilz" in str(name) for name in (pipeline, plugin, *plugins))
