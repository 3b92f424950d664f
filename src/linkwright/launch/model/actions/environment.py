"""Actions that change environment variables."""

from __future__ import annotations

import os
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
from linkwright.launch.model.markup.entity import parse_attributes
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.markup.values import normalize_typed_substitution, perform_typed_substitution, read_boolean
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser


@expose_action("set_env")
class SetEnvironmentVariable(AssigningAction):
    """An action that sets an environment variable."""

    def execute(self, context: LaunchContext) -> None:
        """Set the environment variable."""
        context.environment[self.evaluate_name(context)] = self.evaluate_value(context)


@expose_action("unset_env")
class UnsetEnvironmentVariable(NamedAction):
    """An action that unsets an environment variable, if it is set."""

    def execute(self, context: LaunchContext) -> None:
        """Unset the environment variable."""
        context.environment.pop(self.evaluate_name(context), None)


@expose_action("append_env")
class AppendEnvironmentVariable(AssigningAction):
    """An action that adds a value to a list in an environment variable, such as a search path.

    Args:
        name: the name of the variable.
        value: the value to add.
        prepend: whether to insert the value before the existing values.
        separator: the separator between the values; the system's path separator by default.
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
        self._prepend = normalize_typed_substitution(read_boolean(prepend), bool)
        self._separator = normalize_to_list_of_substitutions(separator)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        prepend = entity.get_attr("prepend", optional=True, data_type=bool, can_be_str=True)
        if prepend is not None:
            kwargs["prepend"] = parser.parse_if_substitutions(prepend)
        return cls, {**kwargs, **parse_attributes(entity, parser, separator="separator")}

    @property
    def prepend(self) -> Any:
        """Whether to insert the value before the existing values: a boolean or substitutions."""
        return self._prepend

    @property
    def separator(self) -> list[Substitution]:
        """The separator between the values, as substitutions."""
        return self._separator

    def execute(self, context: LaunchContext) -> None:
        """Add the value to the environment variable."""
        name, value = self.evaluate_name(context), self.evaluate_value(context)
        values = [context.environment[name]] if name in context.environment else []
        values.insert(0 if perform_typed_substitution(context, self._prepend, bool) else len(values), value)
        context.environment[name] = perform_substitutions(context, self._separator).join(values)


@expose_action("rep_env")
class ReplaceEnvironmentVariables(Action):
    """An action that replaces the entire environment with the given variables.

    Args:
        environment: maps the names of the variables to their values.
    """

    def __init__(self, environment: Mapping[Any, Any] | None = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._environment = dict(environment or {})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with the ``env`` tags inside."""
        _, kwargs = super().parse(entity, parser)
        environment = parse_pairs(entity, parser, "env")
        if environment is not None:
            kwargs["environment"] = environment
        return cls, kwargs

    @property
    def environment(self) -> Mapping[Any, Any]:
        """The names and values of the variables, as passed to the constructor."""
        return self._environment

    def execute(self, context: LaunchContext) -> None:
        """Replace the environment."""
        context.reset_environment(perform_pairs(context, normalize_pairs(self._environment)))


@expose_action("push_env")
class PushEnvironment(Action):
    """An action that opens a scope of environment variables.

    `PopEnvironment` undoes the changes made in the scope.
    """

    def execute(self, context: LaunchContext) -> None:
        """Open the scope."""
        context.push_environment()


@expose_action("pop_env")
class PopEnvironment(Action):
    """An action that closes a scope of environment variables.

    The variables get the values that they had before the scope.
    """

    def execute(self, context: LaunchContext) -> None:
        """Close the scope."""
        context.pop_environment()


@expose_action("reset_env")
class ResetEnvironment(Action):
    """An action that restores the environment to its state at the start of the launch."""

    def execute(self, context: LaunchContext) -> None:
        """Restore the environment."""
        context.reset_environment()
