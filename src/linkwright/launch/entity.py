"""Entities of a launch description, and actions, the entities that do something."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.places import Place, error_at

if TYPE_CHECKING:
    from linkwright.launch.conditions import Condition
    from linkwright.launch.context import LaunchContext
    from linkwright.launch.frontend.entity import Entity
    from linkwright.launch.frontend.parser import Parser

E = TypeVar("E", bound="LaunchDescriptionEntity")


class LaunchDescriptionEntity:
    """Something a launch description holds.

    Attributes:
        place: where in the user's program it was made.
    """

    place: Place | None = None

    def __new__(cls: type[E], *_: Any, **__: Any) -> E:  # noqa: PYI019 - Self needs Python 3.11
        """Remember the place; done here because entities of users need not call our constructor."""
        made = super().__new__(cls)
        made.place = Place.of_caller()
        return made

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:  # noqa: ARG002
        """Do the work and return the entities to be visited next."""
        return None

    def describe(self) -> str:
        """A short description."""
        return f"{type(self).__name__}()"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities that are always visited after it, as far as is known before the launch."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities that are visited under a condition, each lot behind words about the condition."""
        return []

    def explain_inside(self, error: LinkwrightError) -> LinkwrightError:
        """An error that happened in the entities that this one led to, with what there is to say of the way there."""
        return error

    def get_asyncio_future(self) -> asyncio.Future[Any] | None:
        """What is done when the entity is, for one that goes on after its visit."""
        return None


SomeEntitiesType = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""What may stand where entities are expected: one, or several."""

SomeEntitiesType_types_tuple = (LaunchDescriptionEntity, Iterable)


class Action(LaunchDescriptionEntity):
    """An entity that does something when it is visited and its condition holds.

    Args:
        condition: decides at the visit whether `execute` runs.
    """

    def __init__(self, *, condition: Condition | None = None, **unknown: Any) -> None:
        for name in unknown:  # said of the class that the user wrote, not of this one
            raise TypeError(f"{type(self).__name__}() got an unexpected keyword argument '{name}'")
        self._condition = condition

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """The class and the keyword arguments for the tag of an XML or YAML file: here its ``if`` or ``unless``.

        Raises:
            RuntimeError: LAUNCH118, both are there.
        """
        from linkwright.launch.conditions import IfCondition, UnlessCondition

        wanted = entity.get_attr("if", optional=True)
        unwanted = entity.get_attr("unless", optional=True)
        if wanted is not None and unwanted is not None:
            text = "if and unless conditions can't be used simultaneously"
            message = f"'{entity.type_name}' has both 'if' and 'unless'"
            raise error_at(entity.place, "LAUNCH118", message, promises=RuntimeError(text))
        if wanted is not None:
            return cls, {"condition": IfCondition(predicate_expression=parser.parse_substitution(wanted))}
        if unwanted is not None:
            return cls, {"condition": UnlessCondition(predicate_expression=parser.parse_substitution(unwanted))}
        return cls, {}

    @property
    def condition(self) -> Condition | None:
        """The condition, or None for an action that always runs."""
        return getattr(self, "_condition", None)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """The entities inside, for an action without a condition."""
        return list(self.get_sub_entities()) if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """The entities inside, for an action with a condition."""
        if self.condition is None:
            return []
        return [("Conditionally included: " + str(self.condition), list(self.get_sub_entities()))]

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Execute, if the condition holds; gives None where nothing is to be visited next."""
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        following = self.execute(context)
        return None if following is None else as_entities(following)

    def execute(self, context: LaunchContext) -> Any:  # noqa: ARG002 - the interface of actions
        """Do the work; may return entities to be visited next."""
        return None

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities inside, for a reader who asks which arguments are declared."""
        return []


def as_entities(value: Any) -> list[LaunchDescriptionEntity]:
    """One entity, several, or None, as a list.

    Raises:
        TypeError: for anything that is not an entity.
    """
    if value is None:
        return []
    if isinstance(value, LaunchDescriptionEntity):
        return [value]
    entities = list(value) if isinstance(value, Iterable) and not isinstance(value, str) else [value]
    for entity in entities:
        if not isinstance(entity, LaunchDescriptionEntity):
            raise TypeError(f"expected launch actions, got {entity!r} of type {type(entity).__name__}")
    return entities
