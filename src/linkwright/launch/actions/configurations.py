"""Actions on launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class SetLaunchConfiguration(Action):
    """Sets a launch configuration."""

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
        context.launch_configurations[name] = perform_substitutions(context, self._value)


class UnsetLaunchConfiguration(Action):
    """Unsets a launch configuration; one that is not set stays so."""

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.launch_configurations.pop(perform_substitutions(context, self._name), None)


class PushLaunchConfigurations(Action):
    """Opens a scope: what is set from here on ends with `PopLaunchConfigurations`."""

    def execute(self, context: LaunchContext) -> None:
        """Open it."""
        context.push_launch_configurations()


class PopLaunchConfigurations(Action):
    """Closes a scope: the launch configurations are again what they were."""

    def execute(self, context: LaunchContext) -> None:
        """Close it."""
        context.pop_launch_configurations()


class ResetLaunchConfigurations(Action):
    """Forgets all launch configurations but those given.

    Args:
        launch_configurations: name -> value of what is set afterwards, worked out before the others are
        forgotten.
    """

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._kept = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    def execute(self, context: LaunchContext) -> None:
        """Forget the others."""
        kept = {
            perform_substitutions(context, name): perform_substitutions(context, value) for name, value in self._kept
        }
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
