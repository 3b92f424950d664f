"""Event handlers: what is to be done when something happens."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from linkwright.launch import events
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import LaunchDescriptionEntity, SomeEntitiesType, as_entities

EntitiesOrCallable = SomeEntitiesType | Callable[..., Any] | None


class EventHandler:
    """Gives entities to be visited when an event comes that its matcher accepts.

    Args:
        matcher: called with the event.
        entities: what is visited then.
        handle_once: whether it is unregistered after the first event.
    """

    def __init__(
        self,
        *,
        matcher: Callable[[events.Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        self._matcher = matcher
        self._entities = as_entities(entities)
        self.handle_once = handle_once
        self._handled = False

    @property
    def entities(self) -> list[LaunchDescriptionEntity]:
        """The entities to be visited, as far as they are known beforehand."""
        return self._entities

    def matches(self, event: events.Event) -> bool:
        """Whether the handler is for the event."""
        return not (self.handle_once and self._handled) and self._matcher(event)

    def handle(self, event: events.Event, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """The entities to be visited for the event."""
        context.extend_locals({"event": event})
        self._handled = True
        return self._react(event, context)

    def _react(self, event: events.Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:  # noqa: ARG002
        return self._entities


class _Reaction(EventHandler):
    """A handler that visits entities, or calls a function of event and context that returns entities."""

    def __init__(
        self,
        reaction: EntitiesOrCallable,
        matcher: Callable[[events.Event], bool],
        handle_once: bool,
    ) -> None:
        function = callable(reaction) and not isinstance(reaction, LaunchDescriptionEntity)
        super().__init__(matcher=matcher, entities=None if function else as_entities(reaction), handle_once=handle_once)
        self._function: Callable[..., Any] | None = reaction if function else None  # type: ignore[assignment]

    def _react(self, event: events.Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        if self._function is None:
            return self._entities
        return as_entities(self._function(event, context))


def _targets(target_action: Any, event_type: type[events.Event]) -> Callable[[events.Event], bool]:
    """A matcher for events of a type that come from an action: all, one, or those that a function accepts."""
    if target_action is None:
        return lambda event: isinstance(event, event_type)
    if isinstance(target_action, LaunchDescriptionEntity):
        return lambda event: isinstance(event, event_type) and getattr(event, "action", None) is target_action
    if callable(target_action):
        return lambda event: isinstance(event, event_type) and bool(target_action(getattr(event, "action", None)))
    raise TypeError(f"target_action must be an action or a function of an action, got {target_action!r}")


class OnProcessStart(_Reaction):
    """Reacts when a process has started."""

    def __init__(
        self,
        *,
        on_start: EntitiesOrCallable,
        target_action: Any = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(on_start, _targets(target_action, events.ProcessStarted), handle_once)


class OnProcessExit(_Reaction):
    """Reacts when a process has ended."""

    def __init__(
        self,
        *,
        on_exit: EntitiesOrCallable,
        target_action: Any = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(on_exit, _targets(target_action, events.ProcessExited), handle_once)


class OnExecutionComplete(_Reaction):
    """Reacts when an action that takes time has ended."""

    def __init__(
        self,
        *,
        on_completion: EntitiesOrCallable,
        target_action: Any = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(on_completion, _targets(target_action, events.ExecutionComplete), handle_once)


class OnProcessIO(EventHandler):
    """Reacts when a process writes.

    Args:
        target_action: the action whose process is meant; all by default.
        on_stdout: function of the event, for what is written to stdout.
        on_stderr: function of the event, for what is written to stderr.
    """

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdout: Callable[[events.ProcessIO], Any] | None = None,
        on_stderr: Callable[[events.ProcessIO], Any] | None = None,
        handle_once: bool = False,
    ) -> None:
        targeted = _targets(target_action, events.ProcessIO)
        self._functions = {1: on_stdout, 2: on_stderr}
        super().__init__(
            matcher=lambda event: (
                isinstance(event, events.ProcessIO) and self._functions.get(event.fd) is not None and targeted(event)
            ),
            handle_once=handle_once,
        )

    def _react(self, event: events.Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:  # noqa: ARG002
        assert isinstance(event, events.ProcessIO)
        function = self._functions[event.fd]
        return as_entities(function(event) if function else None)


class OnShutdown(_Reaction):
    """Reacts when the launch is to end."""

    def __init__(self, *, on_shutdown: EntitiesOrCallable, handle_once: bool = False) -> None:
        super().__init__(on_shutdown, lambda event: isinstance(event, events.Shutdown), handle_once)
