"""Event handlers for the start, output and end of processes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.launch.model import events
from linkwright.launch.model.actions.execute import ExecuteLocal
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.event_handlers import EntitiesOrCallable, OnActionEventBase


def _check_target(target_action: Any, handler_name: str) -> None:
    """Raise TypeError unless the target of a handler is a process action, a function or None.

    Raises:
        TypeError: the target is another object.
    """
    if target_action is None or isinstance(target_action, ExecuteLocal):
        return
    if isinstance(target_action, LaunchDescriptionEntity) or not callable(target_action):
        type_name = type(target_action).__name__
        raise TypeError(
            f"{handler_name}: target_action must be an ExecuteProcess or a function of one, got a {type_name}"
        )


class _OnProcessEvent(OnActionEventBase):
    """The base class of handlers for events of processes."""

    def __init__(
        self,
        event_class: type[events.Event],
        reaction: EntitiesOrCallable,
        target_action: Any,
        handle_once: bool,
    ) -> None:
        _check_target(target_action, type(self).__name__)
        super().__init__(
            action_matcher=target_action,
            on_event=reaction,
            target_event_cls=event_class,
            target_action_cls=ExecuteLocal,
            handle_once=handle_once,
        )


class OnProcessStart(_OnProcessEvent):
    """An event handler that reacts when a process starts."""

    def __init__(self, *, on_start: EntitiesOrCallable, target_action: Any = None, handle_once: bool = False) -> None:
        super().__init__(events.ProcessStarted, on_start, target_action, handle_once)


class OnProcessExit(_OnProcessEvent):
    """An event handler that reacts when a process ends."""

    def __init__(
        self, *, on_exit: EntitiesOrCallable = None, target_action: Any = None, handle_once: bool = False
    ) -> None:
        super().__init__(events.ProcessExited, on_exit, target_action, handle_once)


class OnProcessIO(_OnProcessEvent):
    """An event handler that reacts when a process writes output.

    Args:
        target_action: the action of the process; None for all processes.
        on_stdin: called with the event when text is sent to stdin.
        on_stdout: called with the event when the process writes to stdout.
        on_stderr: called with the event when the process writes to stderr.
        handle_once: whether the handler is unregistered after the first event.
    """

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Callable[[Any], Any] | None = None,
        on_stdout: Callable[[Any], Any] | None = None,
        on_stderr: Callable[[Any], Any] | None = None,
        handle_once: bool = False,
    ) -> None:
        callbacks = (on_stdin, on_stdout, on_stderr)

        def react(event: events.ProcessIO, _: LaunchContext) -> Any:
            callback = callbacks[event.fd]
            return None if callback is None else callback(event)

        super().__init__(events.ProcessIO, react, target_action, handle_once)
