"""Actions that hold for all nodes after them in the scope: namespace, parameters, remappings.

They are kept in launch configurations, as in launch_ros, so that groups end them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_values import Parameter
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

NAMESPACE = "ros_namespace"
PARAMETERS = "global_params"
REMAPPINGS = "ros_remaps"


def joined_namespace(outer: str, inner: str) -> str:
    """A namespace inside another; one that starts with a slash stands for itself."""
    if inner.startswith("/"):
        return inner.rstrip("/") or "/"
    joined = f"/{outer.strip('/')}/{inner.strip('/')}".replace("//", "/")
    return joined.rstrip("/") or "/"


class PushRosNamespace(Action):
    """Puts a namespace before those of the nodes that follow."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        """Put it."""
        inner = perform_substitutions(context, self._namespace)
        outer = context.launch_configurations.get(NAMESPACE, "")
        context.launch_configurations[NAMESPACE] = joined_namespace(outer, inner)


class SetParameter(Action):
    """Gives a parameter to all nodes that follow; one of the node's own wins."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._parameter = Parameter(name, value)
        self._parameter.place = self.place

    def execute(self, context: LaunchContext) -> None:
        """Give it."""
        name, value = self._parameter.named_value(context)
        _append(context, PARAMETERS, Parameter(name, value))


class SetParametersFromFile(Action):
    """Gives the parameters of a file to all nodes that follow that it names."""

    def __init__(self, filename: Path | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._filename = normalize_to_list_of_substitutions(filename)

    def execute(self, context: LaunchContext) -> None:
        """Give them."""
        file = ParameterFile(perform_substitutions(context, self._filename))
        file.place = self.place
        _append(context, PARAMETERS, file)


class SetRemap(Action):
    """Gives a remapping to all nodes that follow."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._source = normalize_to_list_of_substitutions(src)
        self._destination = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        """Give it."""
        rule = perform_substitutions(context, self._source), perform_substitutions(context, self._destination)
        _append(context, REMAPPINGS, rule)


def _append(context: LaunchContext, name: str, item: Any) -> None:
    # A new list, so that what a scope has kept of the old one stays as it was.
    context.launch_configurations[name] = [*context.launch_configurations.get(name, ()), item]
