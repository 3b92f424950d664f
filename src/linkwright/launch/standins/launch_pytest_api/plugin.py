"""The pytest plugin of ``launch_pytest``.

The plugin launches the descriptions of fixtures and runs the marked tests. A test with
``@pytest.mark.launch(fixture=description)`` runs during the launch: a coroutine on the launch's event loop, a function
in a thread. With ``shutdown=True``, the test runs after the launch has ended. A generator runs up to its ``yield``
during the launch, and continues after it. If the scope of the fixture is wider than a function, this second part is a
separate test, which runs after all tests that run during the launch.
"""

from __future__ import annotations

import asyncio
import functools
import importlib
import inspect
import types
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import pytest

from linkwright.launch.engine.service import LaunchService
from linkwright.launch.model.actions.testing import ReadyToTest, find_ready_actions
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.standins.launch_pytest_api.fixtures import (
    FIXTURES,
    LaunchOptions,
    event_loop,
    finish_launch,
    get_options,
    launch_context,
    launch_service,
)

if TYPE_CHECKING:
    from _pytest.fixtures import SubRequest

__all__ = ["event_loop", "launch_context", "launch_service"]  # exported so that pytest finds the fixtures here

_MARKER = "launch(fixture, shutdown=False): run the test beside the launch of a launch_pytest fixture, or after its end"
_EXHAUSTED = object()


class LaunchTestWarning(pytest.PytestWarning):
    """Issued when a test has the mark ``launch`` without a launch fixture."""


def look_up_hooks() -> None:
    """Load the hooks of the stand-in module ``launch_pytest.plugin`` into its namespace.

    pytest registers only the hooks that a module's namespace already contains.
    """
    module = importlib.import_module("launch_pytest.plugin")
    for name in module.__all__:
        getattr(module, name)


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker ``launch``."""
    config.addinivalue_line("markers", _MARKER)


# --- the launch ---------------------------------------------------------------------------------------------


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_fixture_setup(fixturedef: pytest.FixtureDef[Any], request: SubRequest) -> Generator[None, object, object]:
    """Launch the description of a launch fixture, and wait until tests may start."""
    options = get_options(fixturedef.func)
    if options is None:
        return (yield)
    service = request.getfixturevalue("launch_service")
    loop = request.getfixturevalue("event_loop")
    fixture_value = yield
    phase = f"launch fixture '{options.fixture}'"
    fixturedef.addfinalizer(functools.partial(finish_launch, service, phase, shuts_down=options.auto_shutdown))
    try:
        _launch(service, loop, _get_description(fixture_value, phase), options)
    except BaseException as error:  # cache the error, so that other tests that use the fixture fail with it
        fixturedef.cached_result = (None, fixturedef.cache_key(request), (error, error.__traceback__))
        raise
    return fixture_value


def _get_description(fixture_value: object, phase: str) -> LaunchDescription:
    """Return the launch description in the value of a launch fixture.

    Raises:
        pytest.fail.Exception: the value contains no launch description.
    """
    description = fixture_value[0] if isinstance(fixture_value, Sequence) and fixture_value else fixture_value
    if not isinstance(description, LaunchDescription):
        pytest.fail(
            f"{phase}: its value must be either a launch description or a sequence whose first item is one",
            pytrace=False,
        )
    return description


def _launch(
    service: LaunchService, loop: asyncio.AbstractEventLoop, description: LaunchDescription, options: LaunchOptions
) -> None:
    """Start a launch, and wait until its `ReadyToTest` action is executed."""
    actions = list(find_ready_actions(description.entities))
    if len(actions) > 1:
        pytest.fail(f"launch fixture '{options.fixture}': it may contain only one ReadyToTest action", pytrace=False)
    if not actions:
        actions.append(ReadyToTest())
        description.add_action(actions[0])
    ready = asyncio.Event()
    actions[0]._add_callback(ready.set)
    service.include_launch_description(description)
    launch_task = loop.create_task(service.run_async(shutdown_when_idle=options.shutdown_when_idle))
    ready_task = loop.create_task(ready.wait())
    loop.run_until_complete(asyncio.wait({ready_task, launch_task}, return_when=asyncio.FIRST_COMPLETED))
    if not ready.is_set():
        ready_task.cancel()
        launch_task.result()  # raises the exception of run_async, if it failed
        pytest.fail(f"launch fixture '{options.fixture}': the launch ended before it was ready to test", pytrace=False)


# --- the tests ----------------------------------------------------------------------------------------------


class LaunchTest(pytest.Function):
    """A test that runs during a launch, or the part of a test that runs after the launch.

    Attributes:
        options: the options of the launch fixture.
        test: the test function or bound method.
        started_generator: the generator after its first part has passed; None before that.
        first_part: the test that runs the first part of the same generator; None for a test with a single part.
    """

    options: LaunchOptions
    test: Callable[..., Any]
    started_generator: Any = None
    first_part: LaunchTest | None = None

    @classmethod
    def of(cls, item: pytest.Function, options: LaunchOptions, first_part: LaunchTest | None = None) -> LaunchTest:
        """Create the launch test for a function that pytest collected."""
        suffix = "" if first_part is None else "[shutdown_test]"
        launch_test: LaunchTest = cls.from_parent(
            item.parent,
            name=item.name + suffix,
            callspec=getattr(item, "callspec", None),
            callobj=_as_plain_function(item.obj),
            fixtureinfo=item._fixtureinfo,
            keywords=item.keywords,
            originalname=item.originalname + suffix,  # newer versions of pytest use the original name as the identifier
        )
        launch_test.options, launch_test.test, launch_test.first_part = options, item.obj, first_part
        return launch_test

    @property
    def is_after_shutdown(self) -> bool:
        """Whether the test runs after the launch has ended."""
        marker = self.get_closest_marker("launch")
        return self.first_part is not None or bool(marker and marker.kwargs.get("shutdown", False))

    @property
    def launch_key(self) -> tuple[object, ...]:
        """The key of the launch that the test belongs to.

        All tests of one launch have the same key.
        """
        kinds: dict[str, Any] = {"function": pytest.Function, "class": pytest.Class, "module": pytest.Module}
        scope_node = self.getparent(kinds.get(self.options.scope, pytest.Session)) or self.getparent(pytest.Module)
        params = self.callspec.indices if hasattr(self, "callspec") else {}
        return self.options.fixture, scope_node, params.get(self.options.fixture)

    def runtest(self) -> None:
        """Run the test, or the part of the test that this item represents."""
        __tracebackhide__ = True
        loop = self._loop
        arguments = {name: self.funcargs[name] for name in self._fixtureinfo.argnames}
        if not _is_generator(self.test):
            if self.is_after_shutdown:
                self._end_launch()
            if inspect.iscoroutinefunction(self.test):
                loop.run_until_complete(self.test(**arguments))
            else:
                loop.run_until_complete(loop.run_in_executor(None, functools.partial(self.test, **arguments)))
        elif self.first_part is not None:
            if self.first_part.started_generator is None:
                pytest.skip("the part of the test before the shutdown did not pass")
            self._resume(loop, self.first_part.started_generator)
        elif self.is_after_shutdown:
            pytest.fail("a generator or async generator must not be marked with shutdown=True", pytrace=False)
        else:
            generator = self.test(**arguments)
            if inspect.isasyncgen(generator):
                loop.run_until_complete(_advance(generator))
            else:
                loop.run_until_complete(loop.run_in_executor(None, next, generator, _EXHAUSTED))
            self.started_generator = generator
            if self.options.scope == "function":
                self._resume(loop, generator)

    @property
    def _loop(self) -> asyncio.AbstractEventLoop:
        loop = self.funcargs["event_loop"]
        assert isinstance(loop, asyncio.AbstractEventLoop)
        return loop

    def _end_launch(self) -> None:
        service = self.funcargs["launch_service"]
        assert isinstance(service, LaunchService)
        finish_launch(service, f"before test '{self.name}'", shuts_down=self.options.auto_shutdown)

    def _resume(self, loop: asyncio.AbstractEventLoop, generator: Any) -> None:
        """End the launch, and run the part of the test after the ``yield``."""
        __tracebackhide__ = True
        self._end_launch()
        is_async = inspect.isasyncgen(generator)
        next_value = loop.run_until_complete(_advance(generator)) if is_async else next(generator, _EXHAUSTED)
        if next_value is not _EXHAUSTED:
            pytest.fail("a launch test that is a generator must stop iteration after yielding once", pytrace=False)


async def _advance(generator: Any) -> object:
    return await anext(generator, _EXHAUSTED)


def _is_generator(test: Callable[..., Any]) -> bool:
    return inspect.isgeneratorfunction(test) or inspect.isasyncgenfunction(test)


def _as_plain_function(test: Callable[..., Any]) -> Callable[..., Any]:
    """Return a plain function with the signature of a test, for pytest to collect.

    If pytest collected the coroutine function itself, plugins for coroutines would run it.
    """

    @functools.wraps(getattr(test, "__func__", test))
    def plain_test(*_: object, **__: object) -> None:
        raise AssertionError("run by LaunchTest.runtest")

    owner = getattr(test, "__self__", None)
    return plain_test if owner is None else types.MethodType(plain_test, owner)


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(
    collector: pytest.Module | pytest.Class, name: str, obj: object
) -> list[pytest.Function] | None:
    """Collect a function that is marked with ``launch`` as launch tests."""
    if not inspect.isfunction(obj) or not collector.funcnamefilter(name):
        return None
    marks = [mark for mark in getattr(obj, "pytestmark", ()) if mark.name == "launch"]
    marker = marks[0] if marks else collector.get_closest_marker("launch")
    if marker is None:
        return None
    options = get_options(marker.kwargs.get("fixture"))
    if options is None:
        return [_mark_skipped(pytest.Function.from_parent(collector, name=name))]
    pytest.mark.usefixtures(options.fixture, *FIXTURES[:2])(obj)
    items = list(collector._genfunctions(name, obj))
    tests = [LaunchTest.of(item, options) for item in items]
    second_parts = []
    if _is_generator(obj) and options.scope != "function":
        second_parts = [LaunchTest.of(item, options, test) for item, test in zip(items, tests, strict=True)]
    return [*tests, *second_parts]


def _mark_skipped(item: pytest.Function) -> pytest.Function:
    reason = 'the "fixture" keyword argument is required in pytest.mark.launch(), with a launch_pytest fixture'
    item.warn(LaunchTestWarning(reason))
    item.add_marker(pytest.mark.skip(reason))
    return item


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the tests: first the tests during a launch, then the tests after it."""
    last_index = {
        item.launch_key: index
        for index, item in enumerate(items)
        if isinstance(item, LaunchTest) and not item.is_after_shutdown
    }
    sort_keys: dict[pytest.Item, tuple[int, bool]] = {}
    for index, item in enumerate(items):
        is_after = isinstance(item, LaunchTest) and item.is_after_shutdown
        during_index = last_index.get(item.launch_key, index) if isinstance(item, LaunchTest) and is_after else index
        sort_keys[item] = max(index, during_index), is_after
    items.sort(key=lambda item: sort_keys[item])
