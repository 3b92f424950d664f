"""The tests in a file and their launches (``launch_testing.loader``)."""

from __future__ import annotations

import functools
import inspect
import unittest
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from linkwright.launch.model.actions.testing import ReadyToTest, find_ready_actions
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.standins.launch_testing_api.marks import AFTER_SHUTDOWN, MARKERS, PARAMETRIZED, TIMEOUT

_READY_S = 15.0
"""The default maximum time in seconds from the start of a launch until its tests may start."""


NormalizedDescription = tuple[LaunchDescription, dict[str, Any]]


class TestRun:
    """One launch and the tests that belong to it.

    Attributes:
        name: the name of the tests.
        param_args: the arguments of the parametrized description; empty if it has no parameters.
        pre_shutdown_tests: the tests that run during the launch.
        post_shutdown_tests: the tests that run after the launch has ended.
        timeout: the maximum time in seconds from the start of the launch until the tests may start.
    """

    __test__ = False  # keeps pytest from collecting the class as a test

    def __init__(
        self,
        name: str,
        test_description_function: Callable[..., Any],
        param_args: Mapping[str, Any],
        pre_shutdown_tests: Iterable[Any],
        post_shutdown_tests: Iterable[Any],
    ) -> None:
        self.name = name
        self.param_args = dict(param_args)
        self.pre_shutdown_tests = pre_shutdown_tests
        self.post_shutdown_tests = post_shutdown_tests
        self.timeout: float = getattr(test_description_function, TIMEOUT, _READY_S)
        self._test_description_function = test_description_function
        self._cases = [
            *_iterate_cases(pre_shutdown_tests),
            *_iterate_cases(post_shutdown_tests),
        ]  # suites drop finished tests
        if self.param_args:
            for case in self._cases:
                _rename(case, case._testMethodName + self._format_arguments())

    @property
    def markers(self) -> dict[str, Any]:
        """The marks of the function that creates the launch description."""
        markers: dict[str, Any] = getattr(self._test_description_function, MARKERS, {})
        return markers

    def normalized_test_description(self, *, ready_fn: Callable[[], object]) -> NormalizedDescription:
        """Return the launch description, and the named values that it provides to its tests.

        Args:
            ready_fn: called when the tests may start.

        Raises:
            Exception: the description has no `ReadyToTest`.
        """
        description_value = self._test_description_function()
        description, context = description_value if isinstance(description_value, tuple) else (description_value, {})
        action = next(find_ready_actions(description.entities), None)
        if action is None:
            raise Exception(  # noqa: TRY002 - launch_testing raises it
                f"generate_test_description functions must return a LaunchDescription containing a "
                f"{ReadyToTest.__name__} action"
            )
        action._add_callback(ready_fn)
        return description, context

    def get_launch_description(self) -> LaunchDescription:
        """Return the launch description, for inspection."""
        return self.normalized_test_description(ready_fn=lambda: None)[0]

    def bind(
        self,
        tests: Iterable[Any],
        injected_attributes: Mapping[str, Any] | None = None,
        injected_args: Mapping[str, Any] | None = None,
    ) -> None:
        """Pass attributes and arguments to tests.

        Args:
            tests: the suite of tests.
            injected_attributes: maps names to values that are set as attributes on the class of each test.
            injected_args: maps names to values that are passed to the tests and fixtures with a parameter of
                that name.
        """
        cases = list(_iterate_cases(tests))
        for test_class in {type(case) for case in cases}:
            for name, value in (injected_attributes or {}).items():
                setattr(test_class, name, value)
            for name in ("setUpClass", "tearDownClass"):
                setattr(test_class, name, staticmethod(_bind_arguments(getattr(test_class, name), injected_args or {})))
        for case in cases:
            for name in (case._testMethodName, "setUp", "tearDown"):
                setattr(case, name, _bind_arguments(getattr(case, name), injected_args or {}))

    def all_cases(self) -> Iterator[unittest.TestCase]:
        """Return an iterator over all tests, including finished tests."""
        return iter(self._cases)

    def __str__(self) -> str:
        return self.name + self._format_arguments()

    def _format_arguments(self) -> str:
        return f"[{', '.join(map(str, self.param_args.values()))}]" if self.param_args else ""


def LoadTestsFromPythonModule(module: Any, *, name: str = "launch_tests") -> list[TestRun]:
    """Return the tests of a module, one `TestRun` for each launch.

    Args:
        module: the module, which must have a function ``generate_test_description``.
        name: the name of the tests.
    """
    create_description = module.generate_test_description
    create_functions = create_description() if hasattr(create_description, PARAMETRIZED) else [(create_description, {})]
    return [
        TestRun(
            name,
            description,
            arguments,
            PreShutdownTestLoader().loadTestsFromModule(module),
            PostShutdownTestLoader().loadTestsFromModule(module),
        )
        for description, arguments in create_functions
    ]


class _Loader(unittest.TestLoader):
    """The base class of loaders for the tests during a launch or after it."""

    is_after = False

    def loadTestsFromTestCase(self, testCaseClass: type[unittest.TestCase]) -> unittest.TestSuite:
        """Load the tests of a class through a new subclass.

        Each launch has its own subclass, because attributes of the launch are set on the class.
        """
        if getattr(testCaseClass, AFTER_SHUTDOWN, False) != self.is_after:
            return unittest.TestSuite()
        subclass = type(testCaseClass.__name__, (testCaseClass,), {"__module__": testCaseClass.__module__})
        return super().loadTestsFromTestCase(subclass)


class PreShutdownTestLoader(_Loader):
    """A loader of the tests that run during the launch."""


class PostShutdownTestLoader(_Loader):
    """A loader of the tests that run after the launch has ended."""

    is_after = True


def _iterate_cases(tests: Iterable[Any]) -> Iterator[Any]:
    """Yield the tests in test suites, including nested ones."""
    for test in tests:
        if isinstance(test, Iterable):
            yield from _iterate_cases(test)
        else:
            yield test


def _rename(case: Any, name: str) -> None:
    setattr(case, name, getattr(case, case._testMethodName))
    case._testMethodName = name


def _bind_arguments(function: Callable[..., Any], given: Mapping[str, Any]) -> Callable[..., Any]:
    """Bind given arguments to the parameters of a function.

    Arguments without a parameter are ignored.
    """
    parameters = inspect.signature(function).parameters
    return functools.partial(function, **{name: value for name, value in given.items() if name in parameters})
