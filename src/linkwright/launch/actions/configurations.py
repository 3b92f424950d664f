"""Actions on launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linkwright.launch.actions.named import AssigningAction, NamedAction
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class SetLaunchConfiguration(AssigningAction):
    """Sets a launch configuration."""

    def execute(self, context: LaunchContext) -> None:
        """Set it."""
        context.launch_configurations[self.resolved_name(context)] = self.resolved_value(context)


class UnsetLaunchConfiguration(NamedAction):
    """Unsets a launch configuration; one that is not set stays so."""

    def execute(self, context: LaunchContext) -> None:
        """Unset it."""
        context.launch_configurations.pop(self.resolved_name(context), None)


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
