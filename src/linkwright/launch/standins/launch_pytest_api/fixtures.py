"""The fixtures of ``launch_pytest``: descriptions that are launched for tests, with their service, context and loop."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Iterator, MutableMapping
from dataclasses import dataclass
from typing import Any

import pytest

from linkwright.launch.engine.service import LaunchService, ServiceOfProcesses
from linkwright.launch.model.context import LaunchContext

_OPTIONS = "_launch_options"
_SCOPE = "_launch_scope"
_SCOPES = ("function", "class", "module", "package", "session")


@dataclass(frozen=True)
class LaunchOptions:
    """The launch options of a fixture's description.

    Attributes:
        fixture: the name of the fixture.
        scope: the duration of the launch: one of pytest's scopes.
        shutdown_when_idle: whether the launch ends when it is idle.
        auto_shutdown: whether it is shut down before tests that run after it; otherwise they wait for its end.
    """

    fixture: str
    scope: str
    shutdown_when_idle: bool
    auto_shutdown: bool


def fixture(
    decorated: Callable[..., Any] | None = None,
    *args: Any,
    shutdown_when_idle: bool = True,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Decorate a function that creates a launch description, to launch it for the tests that name it.

    The function returns or yields a ``LaunchDescription``, or a sequence whose first item is one. A launch that
    outlasts a test needs the other fixtures of this module to last as long: unless the test's module has its own,
    they are put there.

    Args:
        decorated: the function, where the decorator has no arguments.
        *args: for ``pytest.fixture``.
        shutdown_when_idle: whether the launch ends when it is idle.
        auto_shutdown: whether the launch is ended once the tests that run beside it are over.
        **kwargs: for ``pytest.fixture``; a ``scope`` that depends on the configuration is not supported.
    """
    scope = kwargs.get("scope", "function")
    if scope != "function":
        _provide(sys._getframe(1).f_globals, scope)

    def decorate(function: Callable[..., Any]) -> Any:
        name = kwargs.get("name") or function.__name__
        options = LaunchOptions(name, scope, shutdown_when_idle, auto_shutdown)
        setattr(function, _OPTIONS, options)
        made: Any = pytest.fixture(*args, **kwargs)(function)
        setattr(made, _OPTIONS, options)  # the marker gets this object, and pytest's hook the function
        return made

    return decorate if decorated is None else decorate(decorated)


def options_of(function: object) -> LaunchOptions | None:
    """Return the options of a fixture that `fixture` created, or of its function; None for any other."""
    options = getattr(function, _OPTIONS, None)
    return options if isinstance(options, LaunchOptions) else None


def _provide(namespace: MutableMapping[str, Any], scope: str) -> None:
    """Add fixtures with a scope to a module that has none, or ours with a shorter scope."""
    for name, function in _FUNCTIONS.items():
        present = namespace.get(name)
        if present is None or _SCOPES.index(getattr(present, _SCOPE, _SCOPES[-1])) < _SCOPES.index(scope):
            namespace[name] = _lasting(function, scope)


def _lasting(function: Callable[..., Any], scope: Any) -> Any:
    made: Any = pytest.fixture(scope=scope)(function)
    setattr(made, _SCOPE, scope)
    return made


def _event_loop() -> Iterator[asyncio.AbstractEventLoop]:
    """The event loop that the launch and coroutines of tests run on."""
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    yield loop
    loop.run_until_complete(loop.shutdown_asyncgens())
    loop.run_until_complete(loop.shutdown_default_executor())
    asyncio.set_event_loop(None)
    loop.close()


def _launch_service(event_loop: asyncio.AbstractEventLoop) -> Iterator[LaunchService]:  # noqa: ARG001 - to outlast it
    """The service that launches the description."""
    service = ServiceOfProcesses()
    yield service
    finish(service, "when the fixture launch_service ended")


def _launch_context(launch_service: LaunchService) -> LaunchContext:
    """The context of the launch."""
    return launch_service.context


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "event_loop": _event_loop,
    "launch_service": _launch_service,
    "launch_context": _launch_context,
}
FIXTURES = tuple(_FUNCTIONS)
"""The names of the fixtures that each launch has."""

event_loop = _lasting(_event_loop, "function")
launch_service = _lasting(_launch_service, "function")
launch_context = _lasting(_launch_context, "function")


def finish(service: LaunchService, when: str, *, ask: bool = True) -> None:
    """End a running launch, and wait for its end.

    Args:
        service: the launch service.
        when: the phase, for the failure message.
        ask: whether to end it; otherwise its own end is awaited.

    Raises:
        pytest.fail.Exception: something in the launch failed.
    """
    loop, task = service.event_loop, service.task
    if loop is None or task is None or loop.is_closed():
        return
    if ask:
        service.shutdown(force_sync=True)
    status = loop.run_until_complete(task)
    if status != 0:
        pytest.fail(f"{when}: the launch failed with status {status}; its output says why", pytrace=False)
