"""Substitutions that read the launch context: configurations, environment, the launch file itself."""

from __future__ import annotations

import os
import random
import sys
from pathlib import Path
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    Parsed,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_ANONYMOUS = "anon"


@expose_substitution("var")
class LaunchConfiguration(Parsed, Substitution):
    """The value of a launch configuration, such as a launch argument.

    Args:
        variable_name: its name.
        default: the text where it is not set; None makes that an error.
    """

    PARSED_AS = "var"
    ARGUMENTS = ("variable_name",)
    OPTIONAL_ARGUMENTS = ("default",)

    def __init__(self, variable_name: SomeSubstitutionsType, *, default: Any = None) -> None:
        self._variable_name = normalize_to_list_of_substitutions(variable_name)
        if default is not None and not isinstance(default, (str, Substitution)):
            parts = default if isinstance(default, (list, tuple)) else [default]
            default = [part if isinstance(part, (str, Substitution)) else str(part) for part in parts]
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
            SubstitutionFailure: LAUNCH121, if it is not set and has no default.
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
        promised = SubstitutionFailure(f"launch configuration '{name}' does not exist")
        raise error_at(self.place, "LAUNCH121", f"launch configuration '{name}' is not set", hint, promises=promised)


@expose_substitution("env")
class EnvironmentVariable(Parsed, Substitution):
    """The value of an environment variable.

    Args:
        name: its name.
        default_value: the text where it is not set; None makes that an error.
    """

    PARSED_AS = "env"
    ARGUMENTS = ("name",)
    OPTIONAL_ARGUMENTS = ("default_value",)

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
            SubstitutionFailure: LAUNCH122, if it is not set and has no default.
        """
        name = perform_substitutions(context, self._name)
        if name in context.environment:
            return context.environment[name]
        if self._default is not None:
            return perform_substitutions(context, self._default)
        hint = did_you_mean(name, context.environment) or "set it, or give the substitution a default_value"
        promised = SubstitutionFailure(f"environment variable '{name}' does not exist")
        raise error_at(self.place, "LAUNCH122", f"environment variable '{name}' is not set", hint, promises=promised)


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
            SubstitutionFailure: LAUNCH123, if there is no such value now.
        """
        known = context.get_locals_as_dict()
        first, *rest = self.expression.split(".")
        if first not in known:
            promised = SubstitutionFailure(f"no local '{first}' in this context")
            message = f"'{first}' is not known at this moment"
            raise error_at(self.place, "LAUNCH123", message, did_you_mean(first, known), promises=promised)
        value = known[first]
        for name in rest:
            if not hasattr(value, name):
                message = f"'{self.expression}': {type(value).__name__} has no '{name}'"
                hint = did_you_mean(name, dir(value))
                raise error_at(self.place, "LAUNCH123", message, hint, promises=SubstitutionFailure(message))
            value = getattr(value, name)
        return str(value)


@expose_substitution("filename")
class ThisLaunchFile(Parsed, Substitution):
    """The path of the launch file that is being visited."""

    PARSED_AS = "filename"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: LAUNCH123, if the description comes from no file.
        """
        path = context.get_locals_as_dict().get("current_launch_file_path")
        if path is None:
            promised = SubstitutionFailure(f"{type(self).__name__} used outside of a launch file (in a script)")
            raise error_at(self.place, "LAUNCH123", "the launch description comes from no file", promises=promised)
        return str(path)


@expose_substitution("dirname")
class ThisLaunchFileDir(Parsed, Substitution):
    """The folder of the launch file that is being visited. With ``/`` it gives a path below it."""

    PARSED_AS = "dirname"

    def __truediv__(self, other: SomeSubstitutionsType) -> Any:
        from linkwright.launch.substitutions.paths import PathJoinSubstitution

        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """The folder.

        Raises:
            SubstitutionFailure: LAUNCH123, if the description comes from no file.
        """
        path: str = ThisLaunchFile.perform(self, context)  # type: ignore[arg-type]
        return str(Path(path).parent)


@expose_substitution("launch_log_dir")
@expose_substitution("log_dir")
class LaunchLogDir(Parsed, Substitution):
    """The folder that this launch writes its log into."""

    PARSED_AS = "launch_log_dir/log_dir"

    def perform(self, context: LaunchContext) -> str:
        """The folder."""
        return str(context.log_folder)


@expose_substitution(_ANONYMOUS)
class AnonName(Parsed, Substitution):
    """A name with numbers behind it that no other launch has; the same each time in one launch."""

    PARSED_AS = _ANONYMOUS
    ARGUMENTS = ("name",)

    def __init__(self, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def describe(self) -> str:
        """The name."""
        return f"AnonName({describe(self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The name with its numbers."""
        name = perform_substitutions(context, self._name)
        names: dict[str, str] = context.launch_configurations.setdefault(_ANONYMOUS, {})
        if name not in names:
            names[name] = f"{name}_{os.getpid()}_{random.randint(0, sys.maxsize)}"  # noqa: S311 - a name, no secret
        return names[name]
