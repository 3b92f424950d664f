"""Actions: entities that are executed when they are visited."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.conditions import Condition, IfCondition, UnlessCondition
from linkwright.launch.model.entity import LaunchDescriptionEntity, as_entities

if TYPE_CHECKING:
    from linkwright.launch.model.context import LaunchContext
    from linkwright.launch.model.markup.entity import Entity, Parser


class Action(LaunchDescriptionEntity):
    """An entity that is executed when it is visited and its condition holds.

    Args:
        condition: decides at each visit whether `execute` runs; None if it always runs.
    """

    def __init__(self, *, condition: Condition | None = None, **unknown: Any) -> None:
        for name in unknown:  # the message names the user's class, not this one
            raise TypeError(f"{type(self).__name__}() got an unexpected keyword argument '{name}'")
        self._condition = condition

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and the keyword arguments for an XML or YAML tag of the action.

        This base class reads the attributes ``if`` and ``unless``.

        Raises:
            RuntimeError: LAUNCH118, the tag has both attributes.
        """
        return cls, parse_condition(entity, parser)

    @property
    def condition(self) -> Condition | None:
        """The condition, or None for an action that always runs."""
        return getattr(self, "_condition", None)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the child entities, or an empty list if the action has a condition."""
        return list(self.get_sub_entities()) if self.condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return a list with one pair: a text with the condition, and the child entities.

        The list is empty if the action has no condition.
        """
        if self.condition is None:
            return []
        return [("Conditionally included: " + str(self.condition), list(self.get_sub_entities()))]

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Execute the action if its condition holds, and return the entities to visit next."""
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        next_entities = self.execute(context)
        self._emit_completion(context)
        return None if next_entities is None else as_entities(next_entities)

    def _emit_completion(self, context: LaunchContext) -> None:
        """Emit the completion event, unless no handler would accept it.

        If the action has a future, the event is emitted when the future is done.
        """
        from linkwright.launch.model.events import ExecutionComplete

        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))

    def execute(self, context: LaunchContext) -> Any:
        """Execute the action, and optionally return entities to visit next."""
        return None

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return the child entities, which are also searched for declared arguments."""
        return []


def parse_condition(entity: Entity, parser: Parser) -> dict[str, Any]:
    """Return the keyword argument ``condition`` for a tag's attribute ``if`` or ``unless``.

    The result is empty if the tag has neither attribute.

    Raises:
        RuntimeError: LAUNCH118, the tag has both attributes.
    """
    conditions = (("if", IfCondition), ("unless", UnlessCondition))
    attribute_texts = {condition_class: entity.get_attr(name, optional=True) for name, condition_class in conditions}
    created_conditions = [
        kind(parser.parse_substitution(text)) for kind, text in attribute_texts.items() if text is not None
    ]
    if len(created_conditions) > 1:
        ros_error = RuntimeError("if and unless conditions can't be used simultaneously")
        message = phrase("'{type_name}' has both 'if' and 'unless'", type_name=entity.type_name)
        raise error_at(entity.source_location, "LAUNCH118", message, ros_error=ros_error)
    return {"condition": created_conditions[0]} if created_conditions else {}
