"""Tests that run as processes or other actions of a launch (``launch_testing.legacy``).

The tests of nav2 and other projects use this module.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, TypeVar

from linkwright.launch.model.actions import EmitEvent, ExecuteProcess, RegisterEventHandler
from linkwright.launch.model.event_handlers import OnExecutionComplete, OnShutdown
from linkwright.launch.model.events import Shutdown
from linkwright.launch.model.process_event_handlers import OnProcessExit, OnProcessIO

_Action = TypeVar("_Action")
_RUNNING, _PASSED, _FAILED, _DROPPED = "runs", "passed", "failed", "dropped"

_OutputTest = tuple[Any, Callable[[Any, bytes], Any], Callable[[Any, Any], bool], Sequence[Any]]


class LaunchTestService:
    """A service that ends a launch when all its tests have finished.

    `run` returns the status of the first failed test.
    """

    def __init__(self) -> None:
        self._tests: dict[str, str] = {}
        self._statuses: list[int] = []

    def add_fixture_action(
        self, launch_description: Any, action: _Action, exit_allowed: Collection[int] | bool = (0,)
    ) -> _Action:
        """Add an action that the tests need to a launch description.

        If the action is a process, the launch ends when the process exits with a status that is not allowed.

        Args:
            launch_description: the description to which the action is added.
            action: the action that the tests need.
            exit_allowed: the statuses with which the process may exit before the tests end. True allows any status,
                and False allows none.
        """
        launch_description.add_action(action)

        def on_exit(event: Any, context: Any) -> Any:
            allowed = exit_allowed if isinstance(exit_allowed, bool) else event.returncode in exit_allowed
            if allowed or context.is_shutdown:
                return None
            self._statuses.append(event.returncode or 1)
            return _create_shutdown(f"{_find_name(event.action)} fixture process died!")

        if isinstance(action, ExecuteProcess):
            launch_description.add_action(RegisterEventHandler(OnProcessExit(target_action=action, on_exit=on_exit)))
        return action

    def add_test_action(self, launch_description: Any, action: _Action) -> _Action:
        """Add an action that is itself a test to a launch description.

        A process passes if it exits with 0. Any other action passes if it completes without an exception.
        """
        test = f"test_{id(action)}"

        def on_exit(event: Any, _: Any) -> Any:
            if event.returncode == 0:
                return self._handle_pass(test)
            self._statuses.append(event.returncode)
            return self._handle_failure(test, f"{_find_name(event.action)} test failed!")

        def on_completion(event: Any, _: Any) -> Any:
            future = event.action.get_asyncio_future()
            if future is not None and future.cancelled():
                self._tests[test] = _DROPPED
                return None
            error = None if future is None else future.exception()
            return self._handle_pass(test) if error is None else self._handle_failure(test, str(error))

        handler: Any
        if isinstance(action, ExecuteProcess):
            handler = OnProcessExit(target_action=action, on_exit=on_exit)
        else:
            handler = OnExecutionComplete(target_action=action, on_completion=on_completion)
        launch_description.add_action(RegisterEventHandler(handler))
        launch_description.add_action(action)
        self._tests[test] = _RUNNING
        return action

    def add_output_test(
        self,
        launch_description: Any,
        action: _Action,
        output_test: _OutputTest,
        test_suffix: str = "output",
        output_filter: Callable[[bytes], bytes] | None = None,
        side_effect: str | None = None,
    ) -> _Action:
        """Add a test of the output of a process to a launch description.

        Args:
            launch_description: the description that contains the process.
            action: the action of the process.
            output_test: the result of a function of `linkwright.launch.standins.launch_testing_api.legacy_output`.
            test_suffix: a suffix of the test's name, which distinguishes several tests of one process.
            output_filter: a function that filters the output.
            side_effect: ``shutdown`` to end the launch when the test has passed.
        """
        test = f"test_{id(action)}_{test_suffix}"
        output, append, matches, patterns = output_test
        missing_patterns = list(patterns)
        self._tests[test] = _RUNNING

        def on_stdout(event: Any) -> Any:
            nonlocal output
            output = append(output, output_filter(event.text) if output_filter else event.text)
            missing_patterns[:] = [pattern for pattern in missing_patterns if not matches(output, pattern)]
            return None if missing_patterns else self._handle_pass(test, side_effect)

        def on_exit(*_: Any) -> Any:
            return self._handle_end(test) if missing_patterns else None  # output may arrive after the exit

        def on_shutdown(*_: Any) -> None:
            if missing_patterns:
                self._handle_failure(test, f"not all {_find_name(action)} output matched!")

        for handler in (
            OnProcessExit(target_action=action, on_exit=on_exit),
            OnShutdown(on_shutdown=on_shutdown),
            OnProcessIO(target_action=action, on_stdout=on_stdout),
        ):
            launch_description.add_action(RegisterEventHandler(handler))
        return action

    def run(self, launch_service: Any, *args: Any, **kwargs: Any) -> int:
        """Run a launch service, and return its status.

        If this status is 0, return the status of the first failed test.
        """
        status = int(launch_service.run(*args, **kwargs))
        return status or next(iter(self._statuses), int(_FAILED in self._tests.values()))

    def _handle_pass(self, test: str, side_effect: str | None = None) -> Any:
        self._tests[test] = _PASSED
        if side_effect == "shutdown":
            return [_create_shutdown("shutdown after test")]
        return self._handle_end(test)

    def _handle_failure(self, test: str, reason: str) -> Any:
        self._tests = {name: _DROPPED if state == _RUNNING else state for name, state in self._tests.items()}
        self._tests[test] = _FAILED
        return [_create_shutdown(reason)]

    def _handle_end(self, test: str) -> Any:
        """Return an action that ends the launch, or None if another test is still running."""
        other_states = [state for name, state in self._tests.items() if name != test]
        return None if _RUNNING in other_states else [_create_shutdown("all tests finished")]


def _create_shutdown(reason: str) -> Any:
    return EmitEvent(event=Shutdown(reason=reason))


def _find_name(action: Any) -> str:
    return str(action.process_details["name"])
