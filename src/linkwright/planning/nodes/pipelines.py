"""The planning pipelines of move_group: which planner a request gets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from linkwright.planning.nodes.conversions import RequestError
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
        notice: the warning that another planner takes the place of the requested one; empty after the first time.
    """

    method: Method = Method.SAMPLING
    planner: str = DEFAULT_PLANNER
    parameters: Mapping[str, Any] = field(default_factory=dict)
    notice: str = ""


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
        self._announced: set[str] = set()

    def planner_ids(self, pipeline: str) -> list[str]:
        """Return the names of the planners of a pipeline."""
        if self._is_pilz(pipeline):
            return list(_PILZ)
        if self._missing_plugin(pipeline):
            return [DEFAULT_PLANNER]
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

        Raises:
            RequestError: the pipeline is not configured, or it is that of Pilz, which has no such planner.
        """
        pipeline = pipeline or self.default
        if pipeline not in (*self.names, self.default):
            raise RequestError("FAILURE", f"Couldn't find requested planning pipeline '{pipeline}'")
        if self._is_pilz(pipeline):
            if planner not in _PILZ:
                raise RequestError(
                    "PLANNING_FAILED", f"No ContextLoader for planner_id '{planner}' found. Planning not possible."
                )
            return PlannerChoice(_PILZ[planner])
        if plugin := self._missing_plugin(pipeline):
            notice = f"The planner '{plugin}' of the pipeline '{pipeline}' is not available"
            return PlannerChoice(notice=self._announce(notice, DEFAULT_PLANNER))
        planner = planner or str(self._parameters.get(f"{pipeline}.{group}.default_planner_config") or "")
        prefix = f"{pipeline}.planner_configs.{planner}."
        settings = {key[len(prefix) :]: value for key, value in self._parameters.items() if key.startswith(prefix)}
        kind = planner_class(str(settings.get("type") or planner)) if planner else DEFAULT_PLANNER
        parameters = {key: value for key, value in settings.items() if key not in _RESERVED}
        if kind is None:
            return PlannerChoice(notice=self._announce(f"The planner '{planner}' is not available", DEFAULT_PLANNER))
        return PlannerChoice(planner=kind, parameters=parameters)

    def _announce(self, reason: str, planner: str) -> str:
        """Return a warning about a planner that is replaced, or nothing if it was returned before."""
        if reason in self._announced:
            return ""
        self._announced.add(reason)
        return f"{reason}; {planner} takes its place"

    def _is_pilz(self, pipeline: str) -> bool:
        return any("pilz" in name for name in (pipeline, *self._plugins(pipeline)))

    def _missing_plugin(self, pipeline: str) -> str:
        """Return the planner plugin of a pipeline that has neither OMPL nor Pilz' planner, or an empty string."""
        plugins = self._plugins(pipeline)
        return "" if not plugins or any("ompl" in name.lower() for name in plugins) else plugins[0]

    def _plugins(self, pipeline: str) -> list[str]:
        """Return the planner plugins of a pipeline: one until Humble, a list since Jazzy."""
        plugins = self._parameters.get(f"{pipeline}.planning_plugins") or ()
        plugin = self._parameters.get(f"{pipeline}.planning_plugin")
        return [str(name) for name in (*((plugin,) if plugin else ()), *plugins)]
