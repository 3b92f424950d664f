"""The context of a launch: its configurations, environment, locals and event handlers."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator, MutableMapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, print_diagnostics
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.locations import SourceLocation, error_at, with_location

if TYPE_CHECKING:
    from linkwright.hosting.xacro_calls import Descriptions
    from linkwright.launch.model.events import Event
    from linkwright.launch.model.running_launch import RunningLaunch


class Performable(Protocol):
    """The interface through which the launch context uses substitutions."""

    source_location: SourceLocation | None

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the substitution, and return the resulting text."""


class Handler(Protocol):
    """The interface of event handlers that the context uses."""

    def matches(self, event: Any) -> bool:
        """Return whether the handler accepts the event."""

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Return the entities to visit for the event."""


class EventQueue:
    """The queue of events that the launch has yet to handle.

    Attributes:
        on_put: called after an event is added.
    """

    def __init__(self) -> None:
        self._events: deque[Event] = deque()
        self.on_put: Callable[[], None] | None = None

    def put_nowait(self, event: Event) -> None:
        """Add an event to the queue."""
        self._events.append(event)
        if self.on_put is not None:
            self.on_put()

    def get_nowait(self) -> Event:
        """Remove and return the oldest event.

        Raises:
            asyncio.QueueEmpty: the queue is empty.
        """
        if not self._events:
            raise asyncio.QueueEmpty
        return self._events.popleft()

    def qsize(self) -> int:
        """Return the number of queued events."""
        return len(self._events)

    def empty(self) -> bool:
        """Return whether the queue is empty."""
        return not self._events


class Locals:
    """Read-only access to the locals of a launch context by attribute."""

    def __init__(self, values: dict[str, Any]) -> None:
        object.__setattr__(self, "_values", values)

    def __getattr__(self, name: str) -> Any:
        values = object.__getattribute__(self, "_values")
        if name not in values:
            names_text = ", ".join(values)
            raise AttributeError(f"context.locals does not contain attribute '{name}', it contains: [{names_text}]")
        return values[name]

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"can't set attribute '{name}', locals are read-only")


class LaunchContext:
    """The state of a launch, read and changed by actions and substitutions.

    Attributes:
        argv: the command-line arguments with which the launch was started.
        launch_configurations: maps the names of the launch configurations in scope to their values.
        environment: the environment variables of the launcher's process, as in ROS. Processes that start later and
            ``$(env ...)`` in xacro files see its changes.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.environment: MutableMapping[str, str] = os.environ
        self._initial_environment = dict(os.environ)
        self._event_queue = EventQueue()
        self._event_handlers: deque[Handler] = deque()
        self._is_shutdown = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._locals: list[dict[str, Any]] = [{}]
        self._globals: dict[str, Any] = {}
        self._configurations_stack: list[dict[str, Any]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._session: RunningLaunch | None = None

    def perform_substitution(self, substitution: Performable) -> str:
        """Evaluate a substitution, and return the resulting text.

        An error without a location receives the location of the substitution.
        """
        try:
            return substitution.perform(self)
        except LinkwrightError as error:
            raise with_location(error, substitution.source_location) from error
        except SubstitutionFailure as error:
            raise error_at(substitution.source_location, "LAUNCH120", foreign(error), ros_error=error) from error

    # --- locals ---------------------------------------------------------------------------------------------

    @property
    def locals(self) -> Locals:
        """The locals, such as ``event`` while an event is handled."""
        return Locals(self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the globals and the locals of all scopes as a dictionary.

        Inner scopes take precedence.
        """
        merged = dict(self._globals)
        for scope in self._locals:
            merged.update(scope)
        return merged

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Set locals in the current scope."""
        self._locals[-1].update(extensions)

    def remove_locals(self, names: Iterable[str]) -> None:
        """Remove locals from every scope."""
        for name in names:
            for scope in self._locals:
                scope.pop(name, None)

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Set locals that remain when scopes are closed."""
        self._globals.update(extensions)

    def push_locals(self) -> None:
        """Open a scope of locals, to be closed with `pop_locals`."""
        self._locals.append({})

    def pop_locals(self) -> None:
        """Close the innermost scope of locals.

        Raises:
            RuntimeError: no scope is open.
        """
        if len(self._locals) < 2:
            raise RuntimeError("locals stack unexpectedly empty")
        self._locals.pop()

    # --- scopes ---------------------------------------------------------------------------------------------

    def push_launch_configurations(self) -> None:
        """Open a scope of launch configurations."""
        self._configurations_stack.append(dict(self.launch_configurations))

    def pop_launch_configurations(self) -> None:
        """Close the innermost scope of launch configurations, and restore the earlier values.

        Raises:
            RuntimeError: no scope is open.
        """
        if not self._configurations_stack:
            raise RuntimeError("launch_configurations stack unexpectedly empty")
        configurations = self._configurations_stack.pop()
        self.launch_configurations.clear()
        self.launch_configurations.update(configurations)

    def push_environment(self) -> None:
        """Open a scope of environment variables."""
        self._environment_stack.append(dict(self.environment))

    def pop_environment(self) -> None:
        """Close the innermost scope of environment variables, and restore the earlier values.

        Raises:
            RuntimeError: no scope is open.
        """
        if not self._environment_stack:
            raise RuntimeError("environment stack unexpectedly empty")
        self.reset_environment(self._environment_stack.pop())

    def reset_environment(self, environment: dict[str, str] | None = None) -> None:
        """Replace the environment, by default with the environment at the creation of the context."""
        if environment is None:
            environment = self._initial_environment
        for name in [name for name in self.environment if name not in environment]:
            del self.environment[name]
        self.environment.update(environment)

    def snapshot(self) -> LaunchContext:
        """Return a copy with the current configurations and locals, for a later retry of an action.

        The copy shares the event queue and event handlers with this context.
        """
        copy = LaunchContext(argv=self.argv, noninteractive=self.noninteractive)
        copy.launch_configurations.update(self.launch_configurations)
        copy._globals = dict(self._globals)
        copy._locals = [self.get_locals_as_dict()]
        copy._session = self._session
        copy._loop = self._loop
        copy._event_queue = self._event_queue
        copy._event_handlers = self._event_handlers
        return copy

    # Users' entities and tests call these methods by their private names in ROS.
    _push_locals = push_locals
    _pop_locals = pop_locals
    _push_launch_configurations = push_launch_configurations
    _pop_launch_configurations = pop_launch_configurations
    _push_environment = push_environment
    _pop_environment = pop_environment
    _reset_environment = reset_environment

    # --- the running launch ---------------------------------------------------------------------------------

    def attach(self, session: RunningLaunch) -> EventQueue:
        """Attach a running launch, and return the queue of the events that the launch must handle."""
        self._session = session
        return self._event_queue

    @property
    def is_running(self) -> bool:
        """Whether a launch is running in this context."""
        return self._session is not None

    def detach(self) -> None:
        """Detach the context from a finished launch."""
        self._session = None
        self._event_queue.on_put = None
        self._locals = self._locals[:1]

    @property
    def session(self) -> RunningLaunch:
        """The running launch.

        Raises:
            RuntimeError: no launch is running in this context.
        """
        if self._session is None:
            raise RuntimeError("no launch is running in this context")
        return self._session

    @property
    def descriptions(self) -> Descriptions | None:
        """The robot descriptions of the running launch, or None if no launch is running."""
        return None if self._session is None else self._session.descriptions

    def log(self, name: str, level: int, text: str) -> None:
        """Write a line to the log of the launch.

        Args:
            name: the name of the logger.
            level: the level, a number as in ``logging``.
            text: the line.
        """
        if self._session is not None:
            log = self._session.log
            if level >= logging.ERROR:
                log.write_error(name, text)
            elif level >= logging.WARNING:
                log.write_warning(name, text)
            else:
                (log.write_info if level >= logging.INFO else log.write_debug)(name, text)
        else:
            from linkwright.launch.log.loggers import get_logger

            get_logger(name).log(level, "%s", text)

    @property
    def log_folder(self) -> Path:
        """The folder that contains the log files of the launch."""
        if self._session is not None:
            return self._session.log.folder
        from linkwright.launch.log.loggers import launch_config

        return Path(launch_config.log_dir)

    def warn(self, warning: Diagnostic) -> None:
        """Report a warning to the user."""
        if self._session is None:
            print_diagnostics([warning], sys.stderr)
        else:
            self._session.log.write_diagnostics([warning])

    def report_findings(self, description: object, findings: Sequence[Diagnostic]) -> None:
        """Report findings about a robot description in the log and the viewer."""
        if self._session is None:
            print_diagnostics(findings, sys.stderr)
        else:
            self._session.report(description, findings)

    @property
    def is_shutdown(self) -> bool:
        """Whether the launch is ending."""
        return self._is_shutdown or (self._session is not None and self._session.is_ending)

    def _set_is_shutdown(self, state: bool) -> None:
        self._is_shutdown = state

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """The event loop on which the launch runs, or None if no loop is set."""
        return self._session.loop if self._session is not None and self._session.loop else self._loop

    def _set_asyncio_loop(self, loop: asyncio.AbstractEventLoop | None) -> None:
        self._loop = loop

    def add_completion_future(self, completion_future: asyncio.Future[Any]) -> None:
        """Delay the end of the launch until a future is done."""
        if self._session is not None:
            self._session.keep_running_until(completion_future)

    def register_event_handler(self, event_handler: Handler, append: bool = False) -> None:
        """Register a handler for future events.

        Args:
            event_handler: the handler of future events.
            append: whether to call the handler after the handlers that were registered before. If False, it is called
                first.
        """
        if append:
            self._event_handlers.append(event_handler)
        else:
            self._event_handlers.appendleft(event_handler)

    def unregister_event_handler(self, event_handler: Handler) -> None:
        """Unregister an event handler.

        Raises:
            ValueError: the handler is not registered.
        """
        self._event_handlers.remove(event_handler)

    def would_handle_event(self, event: Event) -> bool:
        """Return whether any handler accepts the event."""
        return any(True for _ in self.matching_handlers(event))

    def matching_handlers(self, event: Event) -> Iterator[Handler]:
        """Return the handlers that accept an event, in calling order."""
        return (handler for handler in tuple(self._event_handlers) if handler.matches(event))

    def emit_event_sync(self, event: Event) -> None:
        """Add an event to the queue."""
        self._event_queue.put_nowait(event)

    async def emit_event(self, event: Event) -> None:
        """Add an event to the queue."""
        self._event_queue.put_nowait(event)
