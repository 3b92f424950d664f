"""The pytest plugin of ``launch_testing``.

pytest collects a marked file of launch tests as a single test. In such a file, ``generate_test_description`` has the
mark ``@pytest.mark.launch_test``, or ``@pytest.mark.rostest`` of launch_testing_ros.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from linkwright.launch.standins.launch_testing_api.runner import LaunchTestRunner
from linkwright.launch.standins.launch_testing_api.test_runs import LoadTestsFromPythonModule, TestRun


@pytest.hookspec(firstresult=True)
def pytest_launch_collect_makemodule(path: Path, parent: pytest.Collector, entrypoint: object) -> object:
    """Create a collector for a file with ``generate_test_description``.

    Plugins may override this hook.
    """


MARKS = ("launch_test", "rostest")


class LaunchTestFailure(Exception):
    """Raised when tests of a launch have failed.

    Attributes:
        message: the error message.
        results: maps each launch to the results of its tests.
    """

    def __init__(self, message: str, results: dict[TestRun, Any]) -> None:
        super().__init__(message)
        self.message = message
        self.results = results

    @property
    def report(self) -> str:
        """The failure messages of all failed tests, each below its name."""
        sections = []
        for result in self.results.values():
            for case, text in (*result.errors, *result.failures):
                name = case.id() if hasattr(case, "id") else str(case)
                separator = "=" * max(len(name) + 6, 3)
                sections.append(f"{separator}\nFAIL: {name}\n{'-' * len(separator)}\n{text}")
        return "\n".join(sections)


class LaunchTestItem(pytest.Item):
    """All tests of a file, with their launches.

    Attributes:
        load: a function that loads the tests again, for plugins that run an item several times.
        runner_cls: the class that runs the tests.
    """

    load: Callable[[], list[TestRun]]
    runner_cls: type[LaunchTestRunner]

    @classmethod
    def from_parent(  # type: ignore[override]  # as pytest documents for more arguments
        cls,
        parent: pytest.Collector,
        *,
        name: str,
        load: Callable[[], list[TestRun]],
        runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
    ) -> LaunchTestItem:
        """Create the item, as pytest creates its nodes."""
        item: LaunchTestItem = super().from_parent(parent, name=name)
        item.load, item.runner_cls = load, runner_cls
        return item

    def runtest(self) -> None:
        """Run all tests of the file.

        Raises:
            LaunchTestFailure: a test has failed.
        """
        words = [
            argument for launch_arguments in self.config.getoption("--launch-args") for argument in launch_arguments
        ]
        runner = self.runner_cls(self.load(), words, debug=self.config.get_verbosity() > 1)
        runner.validate()
        results = runner.run()
        if not all(result.wasSuccessful() for result in results.values()):
            raise LaunchTestFailure("some test cases have failed", results)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], *args: Any, **kwargs: Any) -> Any:
        """Return the messages of the failed tests, or pytest's text for another exception."""
        if isinstance(excinfo.value, LaunchTestFailure):
            return excinfo.value.report
        return super().repr_failure(excinfo, *args, **kwargs)

    def reportinfo(self) -> tuple[Path, int, str]:
        """Return the location and name of the item."""
        return self.path, 0, f"launch tests: {self.name}"


class LaunchTestModule(pytest.File):
    """A file of launch tests."""

    module: Any

    def makeitem(self, *args: Any, **kwargs: Any) -> LaunchTestItem:
        """Create the single test of the file."""
        return LaunchTestItem.from_parent(*args, **kwargs)

    def collect(self) -> Iterator[LaunchTestItem]:
        """Yield the single test of the file."""
        name = self.module.__name__
        yield self.makeitem(name=name, parent=self, load=lambda: LoadTestsFromPythonModule(self.module, name=name))


def collect_marked(path: Path, parent: pytest.Collector) -> LaunchTestModule | None:
    """Return a collector for a file of marked launch tests.

    The result is None if the file has no such tests or cannot be imported.
    """
    python_module = pytest.Module.from_parent(parent, path=path)
    try:
        module = python_module.obj
    except (python_module.CollectError, pytest.skip.Exception):
        return None  # pytest reports the failed import on collection
    marks = list(getattr(getattr(module, "generate_test_description", None), "pytestmark", ()))
    if not any(mark.name in MARKS for mark in marks):
        return None
    launch_module = LaunchTestModule.from_parent(parent, path=path)
    launch_module.module = module
    for mark in marks:
        launch_module.add_marker(getattr(pytest.mark, mark.name).with_args(*mark.args, **mark.kwargs))
    return launch_module
