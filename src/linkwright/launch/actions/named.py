"""What actions on a named thing share: launch configurations and environment variables have names and values."""

from __future__ import annotations

from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class NamedAction(Action):
    """An action on the thing of a name."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def resolved_name(self, context: LaunchContext) -> str:
        """The name."""
        return perform_substitutions(context, self._name)


class AssigningAction(NamedAction):
    """An action that gives a value to the thing of a name."""

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(name, **kwargs)
        self._value = normalize_to_list_of_substitutions(value)

    @property
    def value(self) -> list[Substitution]:
        """The value, as substitutions."""
        return self._value

    def resolved_value(self, context: LaunchContext) -> str:
        """The value."""
        return perform_substitutions(context, self._value)
