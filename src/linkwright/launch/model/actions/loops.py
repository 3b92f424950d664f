"""Actions that repeat other actions with different values."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import foreign, phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.functions import OpaqueFunction
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity, as_entities
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.model.substitutions.loops import local_name

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser


@expose_action("for_each")
class ForEach(Action):
    """An action that calls a function for each of several sets of values.

    It visits the entities that the function returns.

    Args:
        input_values: the sets of values, each a YAML mapping in braces, separated by semicolons.
        function: called with the values of one set as keyword arguments; returns entities.
    """

    SEPARATOR = ";"

    def __init__(self, input_values: SomeSubstitutionsType, *, function: Callable[..., Any], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._input_values = normalize_to_list_of_substitutions(input_values)
        self._function = function

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with the actions inside."""
        _, kwargs = super().parse(entity, parser)
        kwargs["input_values"] = parser.parse_substitution(entity.get_attr("values"))
        children = [parser.parse_action(child) for child in entity.children]
        kwargs["function"] = lambda **values: create_iteration_entities(children, values)
        return cls, kwargs

    @property
    def input_values(self) -> list[Substitution]:
        """The sets of values, as substitutions."""
        return self._input_values

    @property
    def function(self) -> Callable[..., Any]:
        """The function that is called with each set of values."""
        return self._function

    def describe(self) -> str:
        """Return a text with the values and the function's name."""
        return f"{type(self).__name__}(input_values={describe(self._input_values)}, function={_name(self._function)})"

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities to visit next, for all sets of values.

        Raises:
            LinkwrightError: LAUNCH151, a set is not a mapping.
        """
        import yaml

        entities: list[LaunchDescriptionEntity] = []
        for text in perform_substitutions(context, self._input_values).split(self.SEPARATOR):
            if not text.strip():
                continue
            try:
                values = yaml.safe_load(text)
            except yaml.YAMLError as error:
                raise error_at(
                    self.source_location,
                    "LAUNCH151",
                    phrase(
                        "values '{text}' of the loop are not valid YAML: {error}",
                        text=text.strip(),
                        error=foreign(error),
                    ),
                ) from error
            if not isinstance(values, dict):
                hint = phrase("write each set of values as {name: value, ...}, and separate them with ';'")
                message = phrase("values '{text}' of the loop are not a mapping", text=text.strip())
                raise error_at(self.source_location, "LAUNCH151", message, hint)
            entities += as_entities(self._function(**values))
        return entities


@expose_action("for")
class ForLoop(Action):
    """An action that calls a function for each index from 0.

    It visits the entities that the function returns.

    Args:
        length: the number of iterations.
        function: called with the keyword argument ``i``, which is the index; returns entities.
        name: the name of the index in ``$(index NAME)``.
    """

    def __init__(
        self, length: SomeSubstitutionsType, *, function: Callable[..., Any], name: str | None = None, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self._length = normalize_to_list_of_substitutions(length)
        self._function = function
        self._name = name

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with the actions inside."""
        _, kwargs = super().parse(entity, parser)
        kwargs["length"] = parser.parse_substitution(entity.get_attr("len"))
        name = kwargs["name"] = entity.get_attr("name")
        children = [parser.parse_action(child) for child in entity.children]
        kwargs["function"] = lambda i: create_iteration_entities(children, {name: i})
        return cls, kwargs

    @property
    def length(self) -> list[Substitution]:
        """The number of iterations, as substitutions."""
        return self._length

    @property
    def function(self) -> Callable[..., Any]:
        """The function to call for each index."""
        return self._function

    @property
    def name(self) -> str | None:
        """The name of the index in ``$(index NAME)``, or None."""
        return self._name

    def describe(self) -> str:
        """Return a text with the length, the name and the function's name."""
        length, function = describe(self._length), _name(self._function)
        return f"{type(self).__name__}(length={length}, name='{self._name}', function={function})"

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Return a `ForEach` over the indices, to be visited next.

        Raises:
            ValueError: LAUNCH151, the length is not an integer.
        """
        text = perform_substitutions(context, self._length)
        try:
            length = int(text)
        except ValueError as error:
            message = phrase("the length '{text}' of a loop is not an integer", text=text)
            raise error_at(self.source_location, "LAUNCH151", message, ros_error=error) from error
        values = ForEach.SEPARATOR.join(f"{{i: {index}}}" for index in range(length))
        return [ForEach(values, function=self._function)]


def _name(function: Callable[..., Any]) -> str:
    return str(getattr(function, "__name__", type(function).__name__))


def create_iteration_entities(
    children: Sequence[LaunchDescriptionEntity], values: Mapping[str, Any]
) -> list[LaunchDescriptionEntity]:
    """Return the actions of one iteration of a loop.

    In these actions, ``$(for-var NAME)`` and ``$(index NAME)`` return the values of the iteration.
    """

    def open_scope(context: LaunchContext) -> None:
        context.push_locals()

    def set_values(context: LaunchContext) -> None:
        context.extend_locals({local_name(name): str(value) for name, value in values.items()})

    def close_scope(context: LaunchContext) -> None:
        context.pop_locals()

    # As in ROS, three actions open and close the scope, because users count the entities of a loop. The children are
    # copied for each iteration, because an action such as a node has state.
    scope_actions = [OpaqueFunction(function=function) for function in (open_scope, set_values, close_scope)]
    return [*scope_actions[:2], *deepcopy(list(children)), scope_actions[2]]
