"""Runs the tests of a file and their launches (``launch_testing.test_runner``).

A launch runs in the main thread, because only the main thread receives signals. The tests during the launch run in
another thread. The post-shutdown tests run in the main thread after the launch.
"""

from __future__ import annotations

import inspect
import threading
import unittest
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from linkwright.launch.engine.service import LaunchService, ProcessLaunchService
from linkwright.launch.frontend.include import IncludeLaunchDescription
from linkwright.launch.frontend.sources import LaunchDescriptionSource
from linkwright.launch.model import events
from linkwright.launch.model.actions import RegisterEventHandler
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.model.process_event_handlers import OnProcessExit, OnProcessIO, OnProcessStart
from linkwright.launch.ros2launch_api import parse_launch_arguments
from linkwright.launch.standins.launch_testing_api.asserts import join_output
from linkwright.launch.standins.launch_testing_api.records import ActiveIoHandler, ActiveProcInfoHandler
from linkwright.launch.standins.launch_testing_api.results import FailResult, SkipResult, TestResult
from linkwright.launch.standins.launch_testing_api.test_runs import TestRun


class _LaunchDiedError(Exception):
    """Raised when a launch has ended before its tests finished."""


class _RunnerWorker:
    """A runner of one launch and its tests.

    Args:
        test_run: the tests to run.
        test_run_preamble: the entities to launch before the description of the tests.
        launch_file_arguments: the arguments of the launch in the form ``name:=value``.
        debug: whether the launch logs details.
    """

    def __init__(
        self,
        test_run: TestRun,
        test_run_preamble: Iterable[Any],
        launch_file_arguments: Sequence[str] = (),
        debug: bool = False,
    ) -> None:
        self._test_run = test_run
        self._preamble = list(test_run_preamble)
        self._arguments = dict(parse_launch_arguments(launch_file_arguments))
        self._launch_service: LaunchService = ProcessLaunchService(debug=debug)
        self._ready = threading.Event()
        self._tests_completed = threading.Event()
        self._results: Any = None
        self._proc_info = ActiveProcInfoHandler()
        self._proc_output = ActiveIoHandler()

    def run(self) -> TestResult:
        """Launch the description, run the tests, and return the results of the tests.

        Raises:
            _LaunchDiedError: the launch ended before its tests finished.
            unittest.SkipTest: the launch is skipped.
        """
        run = self._test_run
        description, context = run.normalized_test_description(ready_fn=self._ready.set)
        self._bind({**context, **run.param_args})
        self._launch_service.include_launch_description(self._with_recorders(description))
        threading.Thread(target=self._run_test, name="test_runner_thread", daemon=True).start()
        self._launch_service.run(shutdown_when_idle=not run.markers.get("keep_alive", False))
        if not self._tests_completed.is_set():
            print("Processes under test stopped before tests completed")
            self._print_failed_processes()
            raise _LaunchDiedError
        results: TestResult = self._results
        results.append(_run_suite(run.post_shutdown_tests))
        return results

    def _bind(self, context: Mapping[str, Any]) -> None:
        """Pass the attributes and arguments of the launch to its tests."""
        attributes_during: dict[str, Any] = {
            "launch_service": self._launch_service,
            "proc_info": self._proc_info,
            "proc_output": self._proc_output,
            "test_args": self._arguments,
        }
        attributes_after: dict[str, Any] = {
            "proc_info": self._proc_info._proc_info_handler,
            "proc_output": self._proc_output._io_handler,
            "test_args": self._arguments,
        }
        self._test_run.bind(self._test_run.pre_shutdown_tests, attributes_during, {**context, **attributes_during})
        self._test_run.bind(self._test_run.post_shutdown_tests, attributes_after, {**context, **attributes_after})

    def _with_recorders(self, description: LaunchDescription) -> LaunchDescription:
        """Return a launch description that includes another one, and records its processes.

        The included description receives the arguments of the launch.
        """
        info, output = self._proc_info, self._proc_output

        def started(event: events.ProcessStarted, _: Any) -> None:
            info.append(event)
            output.track(event.process_name)

        return LaunchDescription(
            [
                *self._preamble,
                RegisterEventHandler(OnProcessStart(on_start=started)),
                RegisterEventHandler(OnProcessExit(on_exit=lambda event, _: info.append(event))),
                RegisterEventHandler(OnProcessIO(on_stdout=output.append, on_stderr=output.append)),
                IncludeLaunchDescription(
                    LaunchDescriptionSource(launch_description=description), launch_arguments=self._arguments.items()
                ),
            ]
        )

    def _run_test(self) -> None:
        """Run the tests once the launch is ready, and then end the launch."""
        if not self._ready.wait(self._test_run.timeout):
            print("Timed out waiting for processes to start up")
            self._launch_service.shutdown()
            return
        try:
            self._results = _run_suite(self._test_run.pre_shutdown_tests)
        finally:
            self._tests_completed.set()
            self._launch_service.shutdown()

    def _print_failed_processes(self) -> None:
        """Print the output of processes that exited with an error code."""
        for event in self._proc_info:
            if getattr(event, "returncode", 0) == 0:
                continue
            name = event.process_name
            heading = f"##### '{name}' output #####"
            print(f"Process '{name}' exited with {event.returncode}", heading, sep="\n")  # type: ignore[attr-defined]  # checked
            print(join_output(self._proc_output[name]), "#" * len(heading), sep="\n")


class LaunchTestRunner:
    """A runner of several launches and the tests of each launch.

    Args:
        test_runs: the tests of each launch.
        launch_file_arguments: the arguments of the launches in the form ``name:=value``.
        debug: whether the launches log details.
    """

    def __init__(
        self, test_runs: Sequence[TestRun], launch_file_arguments: Sequence[str] = (), debug: bool = False
    ) -> None:
        self._test_runs = list(test_runs)
        self._launch_file_arguments = launch_file_arguments
        self._debug = debug

    def generate_preamble(self) -> list[Any]:
        """Return the entities to launch before the description of each test run.

        The list is empty unless a subclass overrides this method.
        """
        return []

    def run(self) -> dict[TestRun, unittest.TestResult]:
        """Run the launches in order, and return the test results of each one.

        If a launch ends before its tests have finished, the remaining launches do not run.
        """
        results: dict[TestRun, unittest.TestResult] = {}
        for run in self._test_runs:
            if len(self._test_runs) > 1:
                print(f"\nStarting test run {run}")
            try:
                worker = _RunnerWorker(run, self.generate_preamble(), self._launch_file_arguments, self._debug)
                results[run] = worker.run()
            except unittest.SkipTest as skipped:
                print(f"{run} is skipped: {skipped}")
                results[run] = SkipResult(test_run=run, skip_reason=str(skipped))
            except _LaunchDiedError:
                results[run] = FailResult(test_run=run, message="Launch stopped before the active tests finished.")
                break
        return results

    def validate(self) -> None:
        """Check the parameters of ``generate_test_description`` against its parametrization.

        Raises:
            Exception: a parameter is missing or unexpected.
        """
        for run in self._test_runs:
            parameters = inspect.getfullargspec(inspect.unwrap(run._test_description_function))
            names = [*parameters.args, *parameters.kwonlyargs]
            for name in run.param_args:
                if name not in names:
                    raise Exception(  # noqa: TRY002 - launch_testing raises it
                        f"Could not find an argument in generate_test_description matching prametrized argument "
                        f"'{name}'"
                    )
            for name in names:
                if name not in run.param_args:
                    raise Exception(  # noqa: TRY002 - launch_testing raises it
                        f"generate_test_description has unexpected extra argument '{name}'"
                    )


def _run_suite(tests: Any) -> Any:
    return unittest.TextTestRunner(verbosity=2, resultclass=TestResult).run(tests)
