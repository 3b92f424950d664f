"""Actions on environment variables."""

from __future__ import annotations

import os
from typing import Any

from linkwright.launch.actions.named import AssigningAction, NamedAction
from linkwright.launch.conditions import evaluate_condition_expression
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class SetEnvironmentVariable(AssigningAction):
    """Sets an environment variable."""

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        context.environment[self.resolved_name(context)] = self.resolved_value(context)


class UnsetEnvironmentVariable(NamedAction):
    """Unsets an environment variable; one that is not set stays so."""

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.environment.pop(self.resolved_name(context), None)


class AppendEnvironmentVariable(AssigningAction):
    """Adds a value to an environment variable that is a list, such as a search path.

    Args:
        name: the variable.
        value: what is added.
        prepend: whether it goes before what is there.
        separator: what stands between; the system's path separator by default.
    """

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self._prepend = normalize_to_list_of_substitutions(str(prepend) if isinstance(prepend, bool) else prepend)
        self._separator = normalize_to_list_of_substitutions(separator)

    def execute(self, context: LaunchContext) -> None:
        """Add it."""
        name, value = self.resolved_name(context), self.resolved_value(context)
        parts = [context.environment[name]] if name in context.environment else []
        parts.insert(0 if evaluate_condition_expression(context, self._prepend) else len(parts), value)
        context.environment[name] = perform_substitutions(context, self._separator).join(parts)


class PushEnvironment(Action):
    """Opens a scope: what is set from here on ends with `PopEnvironment`."""

    def execute(self, context: LaunchContext) -> None:
        """Open it."""
        context.push_environment()


class PopEnvironment(Action):
    """Closes a scope: the environment is again what it was."""

    def execute(self, context: LaunchContext) -> None:
        """Close it."""
        context.pop_environment()


class ResetEnvironment(Action):
    """Gives the environment back that the launch was started with."""

    def execute(self, context: LaunchContext) -> None:
        """Give it back."""
        context.reset_environment(context.session.initial_environment)
