"""ros_gz_sim's program ``create``, which spawns a model.

Source: ros_gz_sim (options, parameters). It sends a pose in every request, and gz-sim (``UserCommands``) replaces the
pose of the model by it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Clock, ClockType, Graph, Parameter
from linkwright.messages import get_message, get_service
from linkwright.nodes.options import NodeOptions, create_node, handle_start_errors
from linkwright.simulation.gz_services import CREATE
from linkwright.simulation.nodes.spawner import Entity, EntitySpawner, read_description, set_pose

_TEXT_OPTIONS = ("world", "file", "topic", "string", "param", "name")
_NUMBER_OPTIONS = ("x", "y", "z", "R", "P", "Y")
_TRUE_VALUES = ("", "true", "1", "yes", "t", "y")
_SEARCH_PERIOD = 0.1
"""The seconds between two searches for the service of a world."""


class Create(EntitySpawner):
    """The node of ``create``, which spawns an entity and ends.

    The exit status is 0, or 1 after a failure.

    Raises:
        LinkwrightError: NODE812, neither the command line nor the parameters name a description, or a number is
            invalid; NODE811, the file cannot be read.
    """

    DEFAULT_NAME = "ros_gz_sim"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            options_by_name = self._read_parameter_options(options.parameters) | dict(_read_options(arguments))
            pose = {name: _parse_number(name, options_by_name.get(name, 0.0)) for name in _NUMBER_OPTIONS}
            name = str(options_by_name.get("name", ""))
            entity = Entity(name, (pose["x"], pose["y"], pose["z"]), (pose["R"], pose["P"], pose["Y"]))
            self._renames = str(options_by_name.get("allow_renaming", "false")).lower() in _TRUE_VALUES
            self._prepare(self._node, entity)
            self._start_spawning(
                {source: str(options_by_name[source]) for source in _TEXT_OPTIONS if options_by_name.get(source)},
                options.environment,
            )

    def _read_parameter_options(self, parameters: dict[str, Any]) -> dict[str, Any]:
        """Return the options whose values were passed as parameters."""
        option_names = [name for name in (*_TEXT_OPTIONS, *_NUMBER_OPTIONS, "allow_renaming") if name in parameters]
        for name in option_names:
            self._node.declare_parameter(name, parameters[name])
        return {name: self._node.get_parameter(name).value for name in option_names}

    def _start_spawning(self, sources: dict[str, str], environment: Mapping[str, str]) -> None:
        if "topic" in sources:
            self._spawn_from_topic(sources["topic"])
        elif "string" in sources:
            self._spawn(sources["string"])
        elif "file" in sources:
            self._spawn(read_description(sources["file"], environment))
        elif "param" in sources:
            self._spawn(self._read_parameter(sources["param"]))
        else:
            message = phrase("the command line of create does not name a model to add to the world")
            hint = phrase("pass one of -topic, -file, -string and -param")
            raise LinkwrightError(Diagnostic("NODE812", message, hint=hint))

    def _read_parameter(self, name: str) -> str:
        parameter: Parameter = self._node.declare_parameter(name, "")
        return str(parameter.value)

    def _request_spawn(self, description: str) -> None:
        """Send the request to the first world that has the service; the user's name of the world can be wrong."""
        factory = get_message("ros_gz_interfaces/msg/EntityFactory")(
            name=self._entity.name, allow_renaming=self._renames, sdf=description
        )
        set_pose(factory.pose, self._entity)
        request = get_service(CREATE.ros_type).Request(entity_factory=factory)
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=self._node.get_clock().timebase)

        def search() -> bool:
            service = self._find_service()
            if service is not None:
                self._call_service(CREATE.ros_type, service, request, self._on_response)
            return service is not None

        def search_again() -> None:
            if search():
                timer.cancel()

        if not search():
            self._log("Waiting for a world")
            timer = self._node.create_timer(_SEARCH_PERIOD, search_again, clock=clock)

    def _find_service(self) -> str | None:
        """Return the name of the service that creates models in a world, relative to the root, or None."""
        for name, types in self._node.get_service_names_and_types():
            if CREATE.ros_type in types and re.fullmatch(f"/world/[^/]+/{CREATE.name}", name):
                return name[1:]
        return None

    def _on_response(self, response: Any) -> None:
        if response.success:
            self._log("Entity creation successful.")
            self._finish(0)
        else:
            self._fail(f"Failed request to create entity '{self._entity.name}'; the simulator's log names the reason.")


def _read_options(arguments: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield the names and values of options, in the syntax of gflags.

    A name follows one or two dashes. Its value follows ``=`` or is the next argument.
    """
    remaining = list(arguments)
    while remaining:
        argument = remaining.pop(0)
        option, equals, value = argument.partition("=")
        name = option.lstrip("-")
        if not option.startswith("-") or name not in (*_TEXT_OPTIONS, *_NUMBER_OPTIONS, "allow_renaming"):
            continue  # gz ignores unknown options
        if not equals and remaining and (name != "allow_renaming" or remaining[0].lower() in ("true", "false")):
            value = remaining.pop(0)
        yield name, value


def _parse_number(name: str, value: Any) -> float:
    try:
        return float(value)
    except ValueError:
        message = phrase("'{value}' for '{name}' is not a number", value=str(value), name=name)
        raise LinkwrightError(
            Diagnostic("NODE812", message, hint=phrase("write a number in meters or radians"))
        ) from None
