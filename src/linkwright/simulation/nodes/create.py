"""The program ``create`` of ros_gz_sim, which spawns a model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Graph, Parameter
from linkwright.nodes.options import NodeOptions, create_node, starting
from linkwright.simulation.nodes.spawner import Entity, EntitySpawner, read_description

_TEXTS = ("world", "file", "topic", "string", "param", "name")
_NUMBERS = ("x", "y", "z", "R", "P", "Y")
_TRUE = ("", "true", "1", "yes", "t", "y")


class Create(EntitySpawner):
    """The node of ``create``, which spawns an entity and then ends with status 0.

    Raises:
        LinkwrightError: NODE812, neither the command line nor the parameters name a description, or a number is
            invalid; NODE811, the file cannot be read.
    """

    DEFAULT_NAME = "ros_gz_sim"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, words = create_node(graph, options, self.DEFAULT_NAME)
        with starting(self._node):
            given = self._from_parameters(options.parameters) | dict(_options(words))
            number = {name: _number(name, given.get(name, 0.0)) for name in _NUMBERS}
            name = str(given.get("name", ""))
            entity = Entity(name, (number["x"], number["y"], number["z"]), (number["R"], number["P"], number["Y"]))
            self._renames = str(given.get("allow_renaming", "false")).lower() in _TRUE
            self._prepare(self._node, entity)
            self._begin({source: str(given[source]) for source in _TEXTS if given.get(source)}, options.environment)

    def _from_parameters(self, parameters: dict[str, Any]) -> dict[str, Any]:
        """Return the options that were given as parameters."""
        known = [name for name in (*_TEXTS, *_NUMBERS, "allow_renaming") if name in parameters]
        for name in known:
            self._node.declare_parameter(name, parameters[name])
        return {name: self._node.get_parameter(name).value for name in known}

    def _begin(self, source: dict[str, str], environment: Mapping[str, str]) -> None:
        if "topic" in source:
            self._wait_for(source["topic"])
        elif "string" in source:
            self._spawn(source["string"])
        elif "file" in source:
            self._spawn(read_description(source["file"], environment))
        elif "param" in source:
            self._spawn(self._parameter(source["param"]))
        else:
            message = phrase("the command line of create names no model to add to the world")
            hint = phrase("give it one of -topic, -file, -string and -param")
            raise LinkwrightError(Diagnostic("NODE812", message, hint=hint))

    def _parameter(self, name: str) -> str:
        parameter: Parameter = self._node.declare_parameter(name, "")
        return str(parameter.value)

    def _spawn(self, text: str) -> None:
        if not self._renames or self._described:
            super()._spawn(text)
            return

        def name_and_spawn(names: list[str]) -> None:
            self._entity = _with_free_name(self._entity, names)
            super(Create, self)._spawn(text)

        self._ask_for_names(name_and_spawn)


def _with_free_name(entity: Entity, names: Sequence[str]) -> Entity:
    """Return the entity under a name that is not in `names`, with a number appended if necessary.

    As in gz, the numbers begin with 0: ``box``, ``box_0``, ``box_1``.
    """
    name, number = entity.name, 0
    while name in names:
        name, number = f"{entity.name}_{number}", number + 1
    return Entity(name, entity.xyz, entity.rpy, entity.namespace, entity.reference_frame)


def _options(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Parse options as gflags does: one or two dashes, and a value after ``=`` or in the next word."""
    rest = list(words)
    while rest:
        word = rest.pop(0)
        option, equals, value = word.partition("=")
        name = option.lstrip("-")
        if not option.startswith("-") or name not in (*_TEXTS, *_NUMBERS, "allow_renaming"):
            continue  # gz ignores unknown options
        if not equals and rest and (name != "allow_renaming" or rest[0].lower() in ("true", "false")):
            value = rest.pop(0)
        yield name, value


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except ValueError:
        message = phrase("'{value}' for '{name}' is not a number", value=str(value), name=name)
        raise LinkwrightError(Diagnostic("NODE812", message, hint=phrase("give metres, or radians"))) from None
