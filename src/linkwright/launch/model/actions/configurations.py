"""Actions that change launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.named import (
    AssigningAction,
    NamedAction,
    normalize_pairs,
    parse_pairs,
    perform_pairs,
)
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser


@expose_action("let")
class SetLaunchConfiguration(AssigningAction):
    """An action that sets a launch configuration."""

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration."""
        context.launch_configurations[self.evaluate_name(context)] = self.evaluate_value(context)


@expose_action("unset")
class UnsetLaunchConfiguration(NamedAction):
    """An action that unsets a launch configuration, if it is set."""

    def execute(self, context: LaunchContext) -> None:
        """Unset the launch configuration."""
        context.launch_configurations.pop(self.evaluate_name(context), None)


class PushLaunchConfigurations(Action):
    """An action that opens a scope of launch configurations.

    `PopLaunchConfigurations` undoes the changes made in the scope.
    """

    def execute(self, context: LaunchContext) -> None:
        """Open the scope."""
        context.push_launch_configurations()


class PopLaunchConfigurations(Action):
    """An action that closes a scope of launch configurations.

    The configurations get the values that they had before the scope.
    """

    def execute(self, context: LaunchContext) -> None:
        """Close the scope."""
        context.pop_launch_configurations()


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """An action that removes all launch configurations, and then sets the given ones.

    Args:
        launch_configurations: maps names to the values to set. Both are evaluated before the existing configurations
            are removed.
    """

    def __init__(self, launch_configurations: Mapping[Any, Any] | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._new_configurations = normalize_pairs(launch_configurations or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with the ``keep`` tags inside."""
        _, kwargs = super().parse(entity, parser)
        configurations = parse_pairs(entity, parser, "keep")
        if configurations is not None:
            kwargs["launch_configurations"] = configurations
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Replace all launch configurations with the given ones."""
        configurations = perform_pairs(context, self._new_configurations)
        context.launch_configurations.clear()
        context.launch_configurations.update(configurations)
