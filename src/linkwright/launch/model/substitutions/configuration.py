"""Substitutions that read the launch context.

They evaluate to launch configurations, environment variables, locals, and paths of the launch.
"""

from __future__ import annotations

import os
import random
import socket
import sys
from pathlib import Path
from typing import Any

from linkwright.diagnostics import did_you_mean, phrase
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    AnyOptionalTexts,
    DeclaredSubstitution,
    OptionalTexts,
    Texts,
)
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_ANONYMOUS = "anon"
_NAME_REPLACEMENTS = str.maketrans(".-:", "___")


def normalize_default(default: Any) -> list[Substitution]:
    """Return a default as substitutions.

    The default may be or contain numbers and booleans.
    """
    values = default if isinstance(default, (list, tuple)) else [default]
    return normalize_to_list_of_substitutions(
        [value if isinstance(value, Substitution) else str(value) for value in values]
    )


class LaunchConfiguration(DeclaredSubstitution, tag="var", shown="LaunchConfig({variable_name})"):
    """The value of a launch configuration, such as a launch argument.

    Args:
        variable_name: the name of the launch configuration.
        default: the text if the configuration is not set. If it is None, an unset configuration is an error.
    """

    variable_name: Texts = Texts()
    default: AnyOptionalTexts = AnyOptionalTexts(default=None, kw_only=True, read=normalize_default)

    def perform(self, context: LaunchContext) -> str:
        """Return the value.

        Raises:
            SubstitutionFailure: LAUNCH121, the configuration is not set and there is no default.
        """
        name = perform_substitutions(context, self.variable_name)
        configurations = context.launch_configurations
        if name in configurations:
            return str(configurations[name])
        if self.default is not None:
            return perform_substitutions(context, self.default)
        hint = did_you_mean(name, configurations) or (
            phrase("declare it with DeclareLaunchArgument('{name}') before the action that uses it", name=name)
        )
        ros_error = SubstitutionFailure(f"launch configuration '{name}' does not exist")
        raise error_at(
            self.source_location,
            "LAUNCH121",
            phrase("launch configuration '{name}' is not set", name=name),
            hint,
            ros_error=ros_error,
        )


class EnvironmentVariable(DeclaredSubstitution, tag="env", shown="EnvVar({name})"):
    """The value of an environment variable.

    Args:
        name: the name of the variable.
        default_value: the text if the variable is not set. If it is None, an unset variable is an error.
    """

    name: Texts = Texts()
    default_value: OptionalTexts = OptionalTexts(default=None, kw_only=True)

    def perform(self, context: LaunchContext) -> str:
        """Return the value.

        Raises:
            SubstitutionFailure: LAUNCH122, the variable is not set and there is no default.
        """
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is not None:
            return perform_substitutions(context, self.default_value)
        hint = did_you_mean(name, context.environment) or phrase("set the variable, or pass a default_value")
        ros_error = SubstitutionFailure(f"environment variable '{name}' does not exist")
        raise error_at(
            self.source_location,
            "LAUNCH122",
            phrase("environment variable '{name}' is not set", name=name),
            hint,
            ros_error=ros_error,
        )


class LocalSubstitution(Substitution):
    """The value of a local of the launch context, or of its attribute, as in ``event.reason``.

    Args:
        expression: the name of the local, and names of attributes, separated by dots.
        description: the text for listings; by default the expression.
    """

    def __init__(self, expression: str, description: str | None = None) -> None:
        self.expression = expression
        self.description = description

    def describe(self) -> str:
        """Return a text with the description, or the expression if there is none."""
        return f"LocalVar('{self.description or self.expression}')"

    def perform(self, context: LaunchContext) -> str:
        """Return the value as text.

        Raises:
            SubstitutionFailure: LAUNCH123, the local does not exist when the substitution is evaluated.
        """
        local_values = context.get_locals_as_dict()
        local, *attributes = self.expression.split(".")
        if local not in local_values:
            ros_error = SubstitutionFailure(f"no local '{local}' in this context")
            message = phrase("the launch context has no local '{first}' at this point", first=local)
            raise error_at(
                self.source_location, "LAUNCH123", message, did_you_mean(local, local_values), ros_error=ros_error
            )
        value = local_values[local]
        for attribute in attributes:
            if not hasattr(value, attribute):
                message = phrase(
                    "'{expression}' cannot be evaluated: {type} has no attribute '{name}'",
                    expression=self.expression,
                    type=type(value).__name__,
                    name=attribute,
                )
                hint = did_you_mean(attribute, dir(value))
                raise error_at(self.source_location, "LAUNCH123", message, hint, ros_error=SubstitutionFailure(message))
            value = getattr(value, attribute)
        return str(value)


class ThisLaunchFile(DeclaredSubstitution, tag="filename"):
    """The path of the launch file that is being visited."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path.

        Raises:
            SubstitutionFailure: LAUNCH123, the description was not read from a file.
        """
        path = context.get_locals_as_dict().get("current_launch_file_path")
        if path is None:
            ros_error = SubstitutionFailure(f"{type(self).__name__} used outside of a launch file (in a script)")
            raise error_at(
                self.source_location,
                "LAUNCH123",
                phrase("the launch description was not read from a file"),
                ros_error=ros_error,
            )
        return str(path)


class ThisLaunchFileDir(DeclaredSubstitution, tag="dirname"):
    """The folder of the launch file that is being visited.

    The operator ``/`` appends a path.
    """

    def __truediv__(self, other: SomeSubstitutionsType) -> Any:
        from linkwright.launch.model.substitutions.paths import PathJoinSubstitution

        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the folder.

        Raises:
            SubstitutionFailure: LAUNCH123, the description was not read from a file.
        """
        folder = context.get_locals_as_dict().get("current_launch_file_directory")
        if folder is not None:
            return str(folder)
        path: str = ThisLaunchFile.perform(self, context)  # type: ignore[arg-type]  # does not use self
        return str(Path(path).parent)


class LaunchLogDir(DeclaredSubstitution, tag="launch_log_dir/log_dir"):
    """The folder that contains the log files of the launch."""

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the folder."""
        return str(context.log_folder)


class AnonName(DeclaredSubstitution, tag=_ANONYMOUS):
    """A name made unique by the host name, the process ID and a random number.

    The same name evaluates to the same text within a launch.
    """

    name: Texts = Texts()

    def perform(self, context: LaunchContext) -> str:
        """Return the unique name."""
        name = perform_substitutions(context, self.name)
        unique_names: dict[str, str] = context.launch_configurations.setdefault(_ANONYMOUS, {})
        if name not in unique_names:
            random_number = random.randint(0, sys.maxsize)  # noqa: S311 - a name, not a secret
            unique_name = f"{name}_{socket.gethostname()}_{os.getpid()}_{random_number}"
            unique_names[name] = unique_name.translate(_NAME_REPLACEMENTS)
        return unique_names[name]
