"""Actions on events."""

from __future__ import annotations

from typing import Any

from linkwright.launch import events
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action, LaunchDescriptionEntity
from linkwright.launch.event_handlers import EventHandler
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class RegisterEventHandler(Action):
    """Has a handler react to events from now on."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event_handler = event_handler

    @property
    def event_handler(self) -> EventHandler:
        """The handler."""
        return self._event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register it."""
        context.register_event_handler(self._event_handler)

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """What the handler visits, as far as it is known."""
        return self._event_handler.entities


class UnregisterEventHandler(Action):
    """Has a handler react no longer."""

    def __init__(self, event_handler: EventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._event_handler = event_handler

    @property
    def event_handler(self) -> EventHandler:
        """The handler."""
        return self._event_handler

    def execute(self, context: LaunchContext) -> None:
        """Unregister it."""
        context.unregister_event_handler(self._event_handler)


class EmitEvent(Action):
    """Puts an event into the queue."""

    def __init__(self, *, event: events.Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        if not isinstance(event, events.Event):
            raise TypeError(f"EmitEvent expects an event, got {event!r} of type {type(event).__name__}")
        self._event = event

    @property
    def event(self) -> events.Event:
        """The event."""
        return self._event

    def execute(self, context: LaunchContext) -> None:
        """Emit it."""
        context.emit_event_sync(self._event)


class Shutdown(EmitEvent):
    """Ends the launch. Also good as ``on_exit`` of a node: then its reason names the node."""

    def __init__(self, *, reason: SomeSubstitutionsType = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=events.Shutdown(), **kwargs)
        self._reason = normalize_to_list_of_substitutions(reason)

    def execute(self, context: LaunchContext) -> None:
        """End it."""
        reason = perform_substitutions(context, self._reason)
        cause = context.get_locals_as_dict().get("event")
        if isinstance(cause, events.ProcessExited):
            reason = f"{cause.process_name}: {reason}"
        context.emit_event_sync(events.Shutdown(reason=reason))
