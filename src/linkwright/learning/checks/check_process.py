"""Run a step's checks in a separate process, because checks may run the learner's code."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.checks.declarations import Check, load_checks
from linkwright.learning.checks.domains import reserve_domain
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.checks.machine_faults import is_machine_fault
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.programs import describe_failure
from linkwright.learning.checks.results import CheckResult, StepResult
from linkwright.learning.checks.work import Work
from linkwright.learning.course import CHECKS_FILE, Step, load_lesson
from linkwright.learning.local_text import LocalText
from linkwright.process.forked import ForkServer, Program, start_new_process
from linkwright.process.patience import PatientClock
from linkwright.process.processors import usable_processors

TIME_LIMIT_S = 120.0
"""The seconds after which the process of a step's checks is ended, without the time in which it waits for a processor.

Checks with simulated worlds take the longest.
"""

_POLL_PERIOD_S = 0.25

PYTHON = [sys.executable]
"""The command that runs Python for checks. Tests measure the coverage of its processes."""

DOMAIN_VARIABLE = "LINKWRIGHT_CHECK_DOMAIN"
"""The variable with the ROS domain of a check, for callers that run several at a time in one network."""

_NICENESS_VARIABLE = "LINKWRIGHT_CHECK_NICENESS"

MODULE = "linkwright.learning.checks"

_STOP_OPTION = "--stop-at-failure"

_PRELOADED_MODULES = (
    "linkwright.learning.checks.*",
    "linkwright.control.*",
    "linkwright.graph.*",
    "linkwright.hosting.*",
    "linkwright.launch.*",
    "linkwright.lint.*",
    "linkwright.messages.*",
    "linkwright.navigation.*",
    "linkwright.nodes.*",
    "linkwright.packages.*",
    "linkwright.rviz.*",
    "linkwright.sdf.*",
    "linkwright.simulation.*",
    "linkwright.standins.*",
    "linkwright.testing.*",
    "linkwright.viewer.*",
    "linkwright.wire.*",
    "markdown_it",
    "mujoco",
    "numpy.random",
    "scipy.ndimage",
    "linkwright.learning.checks.preparation:prepare",
)
"""The modules that most checks import, and the function that prepares the server for them."""

_MAX_ERROR_BYTES = 1 << 16
"""The number of bytes that are kept of the standard error of a process: the last ones."""

_CLOSE_TIMEOUT_S = 5.0
"""The seconds to wait for the end of the standard error. A program that has left the session can keep it open."""


def check_step(
    step: Step,
    workspace: Path,
    *,
    answer: str | None = None,
    stop_at_failure: bool = False,
    begin_checks: Callable[[], None],
) -> StepResult:
    """Run the checks of a step in this process.

    Args:
        step: the step whose checks run.
        workspace: the learner's workspace.
        answer: the learner's answer, a number as text.
        stop_at_failure: whether the first failed check is the last one to run.
        begin_checks: called before the first check, before any code of the learner runs.

    Raises:
        LinkwrightError: LEARN102, LEARN107: the checks of the lesson cannot be loaded.
    """
    begin = time.monotonic()
    checks = load_checks(step.lesson.folder / CHECKS_FILE).get(step.id, ())
    work = Work(workspace, lesson=step.lesson.folder, answer=answer)
    begin_checks()
    results: list[CheckResult] = []
    for check in checks:
        results.append(_run_check(check, work))
        if stop_at_failure and not results[-1].passed:
            break
    return StepResult(step.address, _drop_repeated_messages(results), time.monotonic() - begin)


def _run_check(check: Check, work: Work) -> CheckResult:
    try:
        check.function(work)
    except NotYet as reason:
        return CheckResult(check.title, passed=False, message=reason.text)
    except Exception as error:  # noqa: BLE001 - the learner's files can be anything
        message = describe_failure(error, work.folder.resolve())
        text = LocalText.from_phrase(message)
        return CheckResult(
            check.title, passed=False, message=text, is_machine_fault=is_machine_fault(error, work.folder.resolve())
        )
    return CheckResult(check.title, passed=True)


def _drop_repeated_messages(results: Sequence[CheckResult]) -> list[CheckResult]:
    """Return the results without repeated messages.

    One missing file may fail all checks of a step with the same message.
    """
    seen_messages: set[LocalText] = set()
    unique: list[CheckResult] = []
    for result in results:
        if result.message is not None and result.message in seen_messages:
            result = replace(result, message=None)
        elif result.message is not None:
            seen_messages.add(result.message)
        unique.append(result)
    return unique


def make_check_command(step: Step, workspace: Path, output: Path, *, answer: str | None = None) -> list[str]:
    """Return the command that runs a step's checks and writes the results to a file as JSON."""
    return [*PYTHON, "-m", MODULE, *_make_check_arguments(step, workspace, output, answer)]


def _make_check_arguments(
    step: Step, workspace: Path, output: Path, answer: str | None, *, stop_at_failure: bool = False
) -> list[str]:
    options = [_STOP_OPTION] if stop_at_failure else []
    arguments = [*options, str(step.lesson.folder), step.id, str(workspace), str(output)]
    return arguments if answer is None else [*arguments, answer]


def create_check_server() -> ForkServer:
    """Return a server that starts check processes without repeated imports.

    The caller must close it.
    """
    return ForkServer(_PRELOADED_MODULES, PYTHON)


def check_in_process(
    step: Step,
    workspace: Path,
    *,
    answer: str | None = None,
    stop_at_failure: bool = False,
    time_limit: float = TIME_LIMIT_S,
    server: ForkServer | None = None,
) -> StepResult:
    """Run the checks of a step in a separate process. See `CheckProcess`."""
    process = CheckProcess(
        step, workspace, answer=answer, stop_at_failure=stop_at_failure, time_limit=time_limit, server=server
    )
    return process.run()


class CheckProcess:
    """A process that runs the checks of a step.

    All processes that it started end with it. If it takes longer than `time_limit`, or dies, the result of the step is
    a failure with a message. The load of the machine does not count: the limit applies to the time on a `PatientClock`,
    and to the processor time of all processes divided by the number of processors.

    Args:
        step: the step whose checks run.
        workspace: the learner's workspace.
        answer: the learner's answer, a number as text.
        stop_at_failure: whether the first failed check is the last one to run.
        time_limit: the time after which the process is killed, in seconds, without the time in which its processes
            wait for a processor.
        server: starts the process; see `create_check_server`. None to start an ordinary process.
        niceness: the increase of the process's nice value, 0 to 19; ignored on Windows.
    """

    def __init__(
        self,
        step: Step,
        workspace: Path,
        *,
        answer: str | None = None,
        stop_at_failure: bool = False,
        time_limit: float = TIME_LIMIT_S,
        server: ForkServer | None = None,
        niceness: int = 0,
    ) -> None:
        self._step = step
        self._workspace = workspace
        self._answer = answer
        self._stop_at_failure = stop_at_failure
        self._time_limit = time_limit
        self._niceness = niceness
        self._start = partial(start_new_process, PYTHON) if server is None else server.start
        self._process: Program | None = None
        self._is_canceled = False

    def run(self) -> StepResult:
        """Run the checks, and return their results."""
        begin = time.monotonic()
        with ScratchFolder("check") as scratch:
            output = Path(scratch) / "result.json"
            arguments = _make_check_arguments(
                self._step, self._workspace, output, self._answer, stop_at_failure=self._stop_at_failure
            )
            reason = self._run_program(arguments)
            data = _read_output(output)
        if data is not None and reason is None:
            return StepResult.from_data(data)
        message = reason or phrase("the checks of this step ended without a result")
        failed = CheckResult(self._step.title, passed=False, message=LocalText.from_phrase(message))
        return StepResult(self._step.address, [failed], time.monotonic() - begin)

    def cancel(self) -> None:
        """Kill the process, from any thread. `run` then returns soon, with a meaningless result."""
        self._is_canceled = True
        process = self._process
        if process is not None:
            _kill_session(process)

    def _run_program(self, arguments: Sequence[str]) -> Phrase | None:
        """Run the program of the checks, and return the reason why it ended early, or None."""
        with Path(os.devnull).open("r+b") as null_device, _capture_last_bytes() as (errors, descriptor):
            streams = null_device.fileno(), null_device.fileno(), descriptor
            environment = {**os.environ, _NICENESS_VARIABLE: str(self._niceness)}
            process = self._start(MODULE, arguments, cwd=self._workspace, env=environment, streams=streams)
            self._process = process
            if self._is_canceled:
                _kill_session(process)
            try:
                if not self._ends_in_time(process):
                    return phrase("the check took longer than {seconds:g} s and was ended", seconds=self._time_limit)
            finally:
                self._process = None
                _kill_session(process)
                process.wait()
        if process.returncode:
            last = (errors.decode(errors="replace").strip().splitlines() or [""])[-1]
            return phrase("the process of the check ended early: {error}", error=foreign(last))
        return None

    def _ends_in_time(self, process: Program) -> bool:
        """Wait for the end of the process, and return whether it came within the limit."""
        clock = PatientClock(process.pid)
        processors = usable_processors()
        while max(clock.read(), clock.cpu_seconds / processors) < self._time_limit:
            with suppress(subprocess.TimeoutExpired):
                process.wait(min(_POLL_PERIOD_S, self._time_limit))
                return True
        return False


@contextmanager
def _capture_last_bytes() -> Iterator[tuple[bytearray, int]]:
    """Yield a buffer and a file descriptor for writing.

    At the end, the buffer has the last written bytes.
    """
    reader, writer = os.pipe()
    last_bytes = bytearray()

    def read() -> None:
        with os.fdopen(reader, "rb", buffering=0) as stream:
            while chunk := stream.read(_MAX_ERROR_BYTES):
                last_bytes.extend(chunk)
                del last_bytes[:-_MAX_ERROR_BYTES]

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    try:
        yield last_bytes, writer
    finally:
        os.close(writer)
        thread.join(_CLOSE_TIMEOUT_S)


def _kill_session(process: Program) -> None:
    """Kill the process and all processes of its session."""
    if sys.platform == "win32":
        if process.poll() is None:  # Windows finds the children of a running process only
            command = ["taskkill", "/T", "/F", "/PID", str(process.pid)]
            subprocess.run(command, capture_output=True, check=False)  # noqa: S603 - the ID of our own process
            process.kill()
        return
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)


def _read_output(output: Path) -> Any:
    try:
        return json.loads(output.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def main(arguments: Sequence[str]) -> int:
    """Run the checks of a step, as `make_check_command` requests it.

    The output file is created, empty, when the first check begins.
    """
    if sys.platform != "win32":
        os.nice(int(os.environ.get(_NICENESS_VARIABLE, "0")))
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_DOMAIN_ID"] = os.environ.get(DOMAIN_VARIABLE) or str(reserve_domain())
    stop_at_failure = arguments[0] == _STOP_OPTION
    lesson_folder, step_id, workspace, output, *answers = arguments[1:] if stop_at_failure else arguments
    lesson = load_lesson(Path(lesson_folder))
    step = next(step for step in lesson.steps if step.id == step_id)
    try:
        answer = answers[0] if answers else None
        result = check_step(
            step, Path(workspace), answer=answer, stop_at_failure=stop_at_failure, begin_checks=Path(output).touch
        )
    except LinkwrightError as error:
        texts = [LocalText.from_phrase(describe_finding(finding)) for finding in error.diagnostics]
        failed = [CheckResult(step.title, passed=False, message=text, is_machine_fault=True) for text in texts]
        result = StepResult(step.address, failed)
    Path(output).write_text(json.dumps(result.to_data(), ensure_ascii=False), encoding="utf-8")
    return 0
