"""Actions on environment variables."""

from __future__ import annotations

import os
from typing import Any

from linkwright.launch.conditions import evaluate_condition_expression
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class SetEnvironmentVariable(Action):
    """Sets an environment variable."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    @property
    def value(self) -> list[Substitution]:
        """The value, as substitutions."""
        return self._value

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        name = perform_substitutions(context, self._name)
        context.environment[name] = perform_substitutions(context, self._value)


class UnsetEnvironmentVariable(Action):
    """Unsets an environment variable; one that is not set stays so."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.environment.pop(perform_substitutions(context, self._name), None)


class AppendEnvironmentVariable(Action):
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
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)
        self._value = normalize_to_list_of_substitutions(value)
        self._prepend = normalize_to_list_of_substitutions(str(prepend) if isinstance(prepend, bool) else prepend)
        self._separator = normalize_to_list_of_substitutions(separator)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    @property
    def value(self) -> list[Substitution]:
        """The value, as substitutions."""
        return self._value

    def execute(self, context: LaunchContext) -> None:
        """Add it."""
        name = perform_substitutions(context, self._name)
        value = perform_substitutions(context, self._value)
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
