"""What a running launch knows: configurations, environment, locals, event handlers."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Iterable, MutableMapping, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, print_diagnostics
from linkwright.launch.substitution import Substitution, perform

if TYPE_CHECKING:
    from linkwright.launch.engine.descriptions import Descriptions
    from linkwright.launch.engine.session import LaunchSession
    from linkwright.launch.event_handlers import EventHandler
    from linkwright.launch.events import Event


class LaunchContext:
    """The state that actions and substitutions read and change.

    Attributes:
        argv: the arguments the launch was started with.
        launch_configurations: name -> value of the launch configurations in scope.
        environment: the environment variables, those of this process, as in ROS: what is set here is seen by
            the processes started later and by ``$(env ...)`` in xacro files.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.environment: MutableMapping[str, str] = os.environ
        self._locals: list[dict[str, Any]] = [{}]
        self._globals: dict[str, Any] = {}
        self._configurations_stack: list[dict[str, Any]] = []
        self._environment_stack: list[dict[str, str]] = []
        self._session: LaunchSession | None = None

    def perform_substitution(self, substitution: Substitution) -> str:
        """The text of a substitution."""
        return perform(self, substitution)

    # --- locals ---------------------------------------------------------------------------------------------

    @property
    def locals(self) -> SimpleNamespace:
        """The values of the moment, such as ``event`` while an event is handled."""
        return SimpleNamespace(**self.get_locals_as_dict())

    def get_locals_as_dict(self) -> dict[str, Any]:
        """The same values as a dict."""
        merged = dict(self._globals)
        for layer in self._locals:
            merged.update(layer)
        return merged

    def extend_locals(self, extensions: dict[str, Any]) -> None:
        """Set values of the moment."""
        self._locals[-1].update(extensions)

    def extend_globals(self, extensions: dict[str, Any]) -> None:
        """Set values that outlast the moment."""
        self._globals.update(extensions)

    def push_locals(self) -> None:
        """Begin a moment: what `extend_locals` sets from here on ends with `pop_locals`."""
        self._locals.append({})

    def pop_locals(self) -> None:
        """End a moment."""
        self._locals.pop()

    # --- scopes ---------------------------------------------------------------------------------------------

    def push_launch_configurations(self) -> None:
        """Open a scope of launch configurations."""
        self._configurations_stack.append(dict(self.launch_configurations))

    def pop_launch_configurations(self) -> None:
        """Close it: they are what they were before."""
        restored = self._configurations_stack.pop()
        self.launch_configurations.clear()
        self.launch_configurations.update(restored)

    def push_environment(self) -> None:
        """Open a scope of environment variables."""
        self._environment_stack.append(dict(self.environment))

    def pop_environment(self) -> None:
        """Close it: they are what they were before."""
        self.reset_environment(self._environment_stack.pop())

    def reset_environment(self, environment: dict[str, str]) -> None:
        """Make the environment the one given."""
        for name in [name for name in self.environment if name not in environment]:
            del self.environment[name]
        self.environment.update(environment)

    def snapshot(self) -> LaunchContext:
        """A context with the configurations as they are now, for an action that is to be tried again later."""
        copy = LaunchContext(argv=self.argv, noninteractive=self.noninteractive)
        copy.launch_configurations.update(self.launch_configurations)
        copy._globals = dict(self._globals)
        copy._locals = [self.get_locals_as_dict()]
        copy._session = self._session
        return copy

    # --- the running launch ---------------------------------------------------------------------------------

    def attach(self, session: LaunchSession) -> None:
        """Tie the context to the launch that runs in it."""
        self._session = session

    @property
    def session(self) -> LaunchSession:
        """The running launch.

        Raises:
            RuntimeError: when nothing runs in this context.
        """
        if self._session is None:
            raise RuntimeError("no launch runs in this context")
        return self._session

    @property
    def descriptions(self) -> Descriptions | None:
        """The robot descriptions of the running launch; None when nothing runs."""
        return None if self._session is None else self._session.descriptions

    def warn(self, warning: Diagnostic) -> None:
        """Tell the user of something that is no error."""
        if self._session is None:
            print_diagnostics([warning], sys.stderr)
        else:
            self._session.log.diagnostics([warning])

    def remark(self, about: object, findings: Sequence[Diagnostic]) -> None:
        """Tell the user what is remarkable about a robot description, here and in the viewer."""
        if self._session is None:
            print_diagnostics(findings, sys.stderr)
        else:
            self._session.reload.report(about, findings)

    @property
    def is_shutdown(self) -> bool:
        """Whether the launch is ending."""
        return self._session is not None and self._session.ending

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop that the launch runs on."""
        return None if self._session is None else self._session.loop

    def register_event_handler(self, event_handler: EventHandler) -> None:
        """Have a handler asked about every event from now on, before those registered earlier."""
        self.session.handlers.insert(0, event_handler)

    def unregister_event_handler(self, event_handler: EventHandler) -> None:
        """Have a handler asked no longer.

        Raises:
            ValueError: if it is not registered.
        """
        self.session.handlers.remove(event_handler)

    def would_handle_event(self, event: Event) -> bool:
        """Whether any handler is for the event."""
        return any(handler.matches(event) for handler in self.session.handlers)

    def emit_event_sync(self, event: Event) -> None:
        """Put an event into the queue."""
        self.session.emit(event)

    async def emit_event(self, event: Event) -> None:
        """Put an event into the queue."""
        self.session.emit(event)
