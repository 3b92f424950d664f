"""The fixtures of ``launch_pytest``.

The fixtures provide launch descriptions for tests, and the service, context and event loop of each launch.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Iterator, MutableMapping
from dataclasses import dataclass
from typing import Any

import pytest

from linkwright.launch.engine.service import LaunchService, ProcessLaunchService
from linkwright.launch.model.context import LaunchContext

_OPTIONS_ATTRIBUTE = "_launch_options"
_SCOPE_ATTRIBUTE = "_launch_scope"
_SCOPES = ("function", "class", "module", "package", "session")


@dataclass(frozen=True)
class LaunchOptions:
    """The options with which the description of a launch fixture is launched.

    Attributes:
        fixture: the name of the fixture.
        scope: the pytest scope of the fixture, during which the launch runs.
        shutdown_when_idle: whether the launch ends when it is idle.
        auto_shutdown: whether the launch is shut down before the tests that run after it. If False, these tests wait
            for the launch to end.
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
    """Decorate a function that creates a launch description for tests.

    The description is launched for the tests that request the fixture. The function returns or yields a
    ``LaunchDescription``, or a sequence whose first item is one. If the scope is wider than a function, the other
    fixtures of this module need the same scope. They are therefore added to the test's module, unless that module
    defines them itself.

    Args:
        decorated: the function, if the decorator has no arguments.
        *args: passed to ``pytest.fixture``.
        shutdown_when_idle: whether the launch ends when it is idle.
        auto_shutdown: whether the launch is shut down after the tests that run during it. If False, it must end by
            itself.
        **kwargs: passed to ``pytest.fixture``; a ``scope`` that depends on the configuration is not supported.
    """
    scope = kwargs.get("scope", "function")
    if scope != "function":
        _add_fixtures(sys._getframe(1).f_globals, scope)

    def decorate(function: Callable[..., Any]) -> Any:
        name = kwargs.get("name") or function.__name__
        options = LaunchOptions(name, scope, shutdown_when_idle, auto_shutdown)
        setattr(function, _OPTIONS_ATTRIBUTE, options)
        created_fixture: Any = pytest.fixture(*args, **kwargs)(function)
        setattr(
            created_fixture, _OPTIONS_ATTRIBUTE, options
        )  # the marker gets this object, and pytest's hook gets the function
        return created_fixture

    return decorate if decorated is None else decorate(decorated)


def get_options(function: object) -> LaunchOptions | None:
    """Return the launch options of a fixture that `fixture` created, or of its function.

    The result is None for any other object.
    """
    options = getattr(function, _OPTIONS_ATTRIBUTE, None)
    return options if isinstance(options, LaunchOptions) else None


def _add_fixtures(namespace: MutableMapping[str, Any], scope: str) -> None:
    """Add the fixtures of this module, with a scope, to the namespace of a test module.

    Fixtures that the test module defines itself are kept. Fixtures that were added earlier with a narrower scope are
    replaced.
    """
    for name, function in _FUNCTIONS.items():
        existing = namespace.get(name)
        if existing is None or _SCOPES.index(getattr(existing, _SCOPE_ATTRIBUTE, _SCOPES[-1])) < _SCOPES.index(scope):
            namespace[name] = _create_fixture(function, scope)


def _create_fixture(function: Callable[..., Any], scope: Any) -> Any:
    created_fixture: Any = pytest.fixture(scope=scope)(function)
    setattr(created_fixture, _SCOPE_ATTRIBUTE, scope)
    return created_fixture


def _event_loop() -> Iterator[asyncio.AbstractEventLoop]:
    """Yield the event loop that runs the launch and the tests' coroutines."""
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    yield loop
    loop.run_until_complete(loop.shutdown_asyncgens())
    loop.run_until_complete(loop.shutdown_default_executor())
    asyncio.set_event_loop(None)
    loop.close()


def _launch_service(event_loop: asyncio.AbstractEventLoop) -> Iterator[LaunchService]:  # noqa: ARG001 - closed first
    """Yield the service that launches the description."""
    service = ProcessLaunchService()
    yield service
    finish_launch(service, "when the fixture launch_service ended")


def _launch_context(launch_service: LaunchService) -> LaunchContext:
    """Return the context of the launch."""
    return launch_service.context


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "event_loop": _event_loop,
    "launch_service": _launch_service,
    "launch_context": _launch_context,
}
FIXTURES = tuple(_FUNCTIONS)
"""The names of the fixtures that belong to each launch."""

event_loop = _create_fixture(_event_loop, "function")
launch_service = _create_fixture(_launch_service, "function")
launch_context = _create_fixture(_launch_context, "function")


def finish_launch(service: LaunchService, phase: str, *, shuts_down: bool = True) -> None:
    """Shut down a running launch, and wait until it has ended.

    Args:
        service: the launch service.
        phase: the phase of the test run, with which the failure message begins.
        shuts_down: whether to shut the launch down. If False, only wait until it ends on its own.

    Raises:
        pytest.fail.Exception: something in the launch failed.
    """
    loop, task = service.event_loop, service.task
    if loop is None or task is None or loop.is_closed():
        return
    if shuts_down:
        service.shutdown(force_sync=True)
    status = loop.run_until_complete(task)
    if status != 0:
        pytest.fail(f"{phase}: the launch failed with status {status}; see its output", pytrace=False)
