"""Substitutions that read the launch context: configurations, environment, the launch file itself."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class LaunchConfiguration(Substitution):
    """The value of a launch configuration, such as a launch argument.

    Args:
        variable_name: its name.
        default: the text where it is not set; None makes that an error.
    """

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._variable_name = normalize_to_list_of_substitutions(variable_name)
        if default is not None and not isinstance(default, (str, Substitution, list, tuple)):
            default = str(default)
        self._default = None if default is None else normalize_to_list_of_substitutions(default)

    @property
    def variable_name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._variable_name

    def describe(self) -> str:
        """The name."""
        return f"LaunchConfig({describe(self._variable_name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        Raises:
            LinkwrightError: LAUNCH121, if it is not set and has no default.
        """
        name = perform_substitutions(context, self._variable_name)
        known = context.launch_configurations
        if name in known:
            return str(known[name])
        if self._default is not None:
            return perform_substitutions(context, self._default)
        hint = did_you_mean(name, known) or (
            f"declare it with DeclareLaunchArgument('{name}') before the action that uses it"
        )
        raise error_at(self.place, "LAUNCH121", f"launch configuration '{name}' is not set", hint)


class EnvironmentVariable(Substitution):
    """The value of an environment variable.

    Args:
        name: its name.
        default_value: the text where it is not set; None makes that an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The default, as substitutions."""
        return self._default

    def describe(self) -> str:
        """The name."""
        return f"EnvVar({describe(self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        Raises:
            LinkwrightError: LAUNCH122, if it is not set and has no default.
        """
        name = perform_substitutions(context, self._name)
        if name in context.environment:
            return context.environment[name]
        if self._default is not None:
            return perform_substitutions(context, self._default)
        hint = did_you_mean(name, context.environment) or "set it, or give the substitution a default_value"
        raise error_at(self.place, "LAUNCH122", f"environment variable '{name}' is not set", hint)


class LocalSubstitution(Substitution):
    """A value of the moment, named by an expression such as ``event.reason``."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.description = description

    def describe(self) -> str:
        """The expression."""
        return f"LocalVar('{self.description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        Raises:
            LinkwrightError: LAUNCH123, if there is no such value now.
        """
        known = context.get_locals_as_dict()
        first, *rest = self.expression.split(".")
        if first not in known:
            raise error_at(
                self.place, "LAUNCH123", f"'{first}' is not known at this moment", did_you_mean(first, known)
            )
        value = known[first]
        for name in rest:
            if not hasattr(value, name):
                message = f"'{self.expression}': {type(value).__name__} has no '{name}'"
                raise error_at(self.place, "LAUNCH123", message, did_you_mean(name, dir(value)))
            value = getattr(value, name)
        return str(value)


class ThisLaunchFile(Substitution):
    """The path of the launch file that is being visited."""

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            LinkwrightError: LAUNCH123, if the description comes from no file.
        """
        path = context.get_locals_as_dict().get("current_launch_file_path")
        if path is None:
            raise error_at(self.place, "LAUNCH123", "the launch description comes from no file")
        return str(path)


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file that is being visited."""

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            LinkwrightError: LAUNCH123, if the description comes from no file.
        """
        return str(Path(ThisLaunchFile.perform(self, context)).parent)  # type: ignore[arg-type]


class LaunchLogDir(Substitution):
    """The folder that this launch writes its log into."""

    def perform(self, context: LaunchContext) -> str:
        """The folder."""
        return str(context.session.log.folder)
