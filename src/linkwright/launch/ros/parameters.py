"""The ``parameters`` of a node: dictionaries, files and single parameters, evaluated in the order given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.places import Place, error_at
from linkwright.launch.ros.parameter_files import ParameterFile, parameters_for
from linkwright.launch.ros.parameter_values import (
    Parameter,
    ParameterValue,
    is_substitution,
    typed_value,
    uniform_list,
    yaml_value,
)
from linkwright.launch.substitution import (
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


@dataclass
class EvaluatedParameters:
    """Parameters as they reach a node.

    Attributes:
        values: full name with dots -> value, as a node of this process takes them; later ones win.
        sources: the same in order, as another process takes them: values by name, or the path of a file.
    """

    values: dict[str, Any] = field(default_factory=dict)
    sources: list[dict[str, Any] | Path] = field(default_factory=list)

    def add(self, values: Mapping[str, Any]) -> None:
        """Add values by name."""
        self.values.update(values)
        if self.sources and isinstance(self.sources[-1], dict):
            self.sources[-1].update(values)
        else:
            self.sources.append(dict(values))


def check_parameters(parameters: Any, place: Place | None) -> list[Any]:
    """The ``parameters`` argument of a node, after a look at its form.

    Raises:
        LinkwrightError: LAUNCH132, if it is no list, or has items that cannot be parameters.
    """
    if isinstance(parameters, (str, Mapping)) or not isinstance(parameters, Sequence):
        hint = "put it into a list: parameters=[...]"
        raise error_at(place, "LAUNCH132", "'parameters' of a node must be a list", hint)
    allowed = (Mapping, str, Path, Substitution, ParameterFile, Parameter, list, tuple)
    for item in parameters:
        if not isinstance(item, allowed):
            message = f"'parameters' of a node has an item of type {type(item).__name__}"
            raise error_at(place, "LAUNCH132", message, "items are dictionaries and paths of YAML files")
    return list(parameters)


def evaluate_parameters(
    context: LaunchContext, parameters: Sequence[Any], node: str, place: Place | None
) -> EvaluatedParameters:
    """Evaluate the parameters of a node.

    Args:
        context: where substitutions are performed.
        parameters: dictionaries, paths, `ParameterFile` and `Parameter` objects.
        node: the node's full name, by which parameter files are read.
        place: the node's, for messages.

    Raises:
        LinkwrightError: LAUNCH132 or LAUNCH133, what is wrong with a value or a file.
    """
    evaluated = EvaluatedParameters()
    for item in parameters:
        if isinstance(item, Parameter):
            name, value = item.named_value(context)
            evaluated.add({name: value})
        elif isinstance(item, Mapping):
            evaluated.add(dict(_evaluated_items(context, item, "", place)))
        else:
            file = item if isinstance(item, ParameterFile) else ParameterFile(item)
            file.place = file.place or place
            path, content, substituted = file.read(context)
            chosen = dict(_flattened(parameters_for(content, node)))
            if substituted:
                evaluated.add(chosen)
            else:
                evaluated.values.update(chosen)
                evaluated.sources.append(path)
    return evaluated


def _evaluated_items(
    context: LaunchContext, parameters: Mapping[Any, Any], prefix: str, place: Place | None
) -> Iterator[tuple[str, Any]]:
    for key, value in parameters.items():
        name = prefix + perform_substitutions(context, normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            yield from _evaluated_items(context, value, f"{name}.", place)
        else:
            yield name, _evaluate(context, name, value, place)


def _evaluate(context: LaunchContext, name: str, value: Any, place: Place | None) -> Any:
    if isinstance(value, ParameterValue):
        if is_substitution(value.value):
            text = perform_substitutions(context, value.value)
            return typed_value(text, value.value_type, name, value.place or place)
        return value.evaluate(context)
    if is_substitution(value):
        substitutions = normalize_to_list_of_substitutions(value)
        return yaml_value(perform_substitutions(context, substitutions), name, substitutions[0].place or place)
    if isinstance(value, (bool, int, float, str, bytes)):
        return value
    if isinstance(value, (list, tuple)):
        items = (
            perform_substitutions(context, normalize_to_list_of_substitutions(item))
            if isinstance(item, (list, tuple, Substitution))
            else item
            for item in value
        )
        return uniform_list(items)
    if isinstance(value, Path):
        raise error_at(place, "LAUNCH132", f"parameter '{name}' is a Path", "give it as text: str(PATH)")
    raise error_at(
        place, "LAUNCH132", f"parameter '{name}' is of type {type(value).__name__}, which no parameter can be"
    )


def _flattened(parameters: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in parameters.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
