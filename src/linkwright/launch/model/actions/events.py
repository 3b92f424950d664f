"""Actions that emit events, and actions that register and unregister event handlers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.event_handlers import BaseEventHandler
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from linkwright.launch.model.markup.entity import Entity, Parser


class _HandlerAction(Action):
    """The base class of actions that register or unregister an event handler."""

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event_handler = event_handler

    @property
    def event_handler(self) -> BaseEventHandler:
        """The event handler."""
        return self._event_handler


class RegisterEventHandler(_HandlerAction):
    """An action that registers an event handler."""

    def execute(self, context: LaunchContext) -> None:
        """Register the event handler."""
        context.register_event_handler(self._event_handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return the handler's entities with a text about the event.

        The list is empty if the entities are unknown before the event.
        """
        entities = self.get_sub_entities()
        return [(f"{self._event_handler} handles an event", entities)] if entities else []

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return an empty list, because the handler visits its entities only on an event."""
        return []

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities that the handler visits, if they are known before the event."""
        return self._event_handler.describe()[1]


class UnregisterEventHandler(_HandlerAction):
    """An action that unregisters an event handler."""

    def execute(self, context: LaunchContext) -> None:
        """Unregister the event handler."""
        context.unregister_event_handler(self._event_handler)


class EmitEvent(Action):
    """An action that emits an event for the launch to handle."""

    def __init__(self, *, event: events.Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, events.Event):
            raise TypeError(f"EmitEvent expects an event, got {event!r} of type {type(event).__name__}")
        self._event = event

    @property
    def event(self) -> events.Event:
        """The event to emit."""
        return self._event

    def describe(self) -> str:
        """Return a text with the name of the event."""
        return f"{type(self).__name__}(event='{self._event.name}')"

    def execute(self, context: LaunchContext) -> None:
        """Emit the event."""
        context.emit_event_sync(self._event)


@expose_action("shutdown")
class Shutdown(EmitEvent):
    """An action that shuts the launch down.

    If the action runs because a process ended, it also logs the name of the process.
    """

    def __init__(self, *, reason: SomeSubstitutionsType = "reason not given", **kwargs: Any) -> None:
        self._reason: list[Substitution] = normalize_to_list_of_substitutions(reason)
        text = reason if isinstance(reason, str) else describe(self._reason)
        super().__init__(event=events.Shutdown(reason=text), **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        reason = entity.get_attr("reason", optional=True)
        if reason:
            kwargs["reason"] = parser.parse_substitution(reason)
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Emit the event that ends the launch."""
        handled_event = context.get_locals_as_dict().get("event")
        if isinstance(handled_event, events.ProcessExited):
            context.log(
                "launch", 20, f"process[{handled_event.process_name}] was required: shutting down launched system"
            )
        context.emit_event_sync(events.Shutdown(reason=perform_substitutions(context, self._reason)))
