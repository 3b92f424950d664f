"""Run the checks of a step in a process of their own, because they may run the learner's code."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, foreign, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.checks.declaring import Check, load_checks
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.checks.lacks import is_lack
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.programs import describe_failure
from linkwright.learning.checks.results import CheckResult, StepResult
from linkwright.learning.checks.work import Work
from linkwright.learning.course import CHECKS_FILE, Step, load_lesson
from linkwright.learning.local_text import LocalText

TIME_LIMIT = 120.0
"""The seconds after which the process of a step's checks is ended. Checks with simulated worlds take the longest."""

_DOMAINS = 100
"""The number of ROS domains among which the process of a check selects one, without domain 0, the default.

The domain of the learner's own programs is left out, too.
"""

PYTHON = [sys.executable]
"""The command that runs Python for checks. Tests measure the coverage of its processes."""

DOMAIN_VARIABLE = "LINKWRIGHT_CHECK_DOMAIN"
"""The variable with the ROS domain of a check, for callers that run several at a time in one network."""

MODULE = "linkwright.learning.checks.running"


def check_step(
    step: Step, workspace: Path, *, answer: str | None = None, begin_checks: Callable[[], None]
) -> StepResult:
    """Run the checks of a step in this process.

    Args:
        step: the step.
        workspace: the learner's workspace.
        answer: the number that the learner answered, as text.
        begin_checks: called before the first check, when nothing of the learner's has run yet.

    Raises:
        LinkwrightError: LEARN102, LEARN107: the checks of the lesson cannot be loaded.
    """
    begin = time.monotonic()
    checks = load_checks(step.lesson.folder / CHECKS_FILE).get(step.id, ())
    work = Work(workspace, lesson=step.lesson.folder, answer=answer)
    begin_checks()
    results = [_run(check, work) for check in checks]
    return StepResult(step.address, _without_repetition(results), time.monotonic() - begin)


def _run(check: Check, work: Work) -> CheckResult:
    try:
        check.function(work)
    except NotYet as reason:
        return CheckResult(check.title, passed=False, message=reason.text)
    except Exception as error:  # noqa: BLE001 - the learner's files can be anything
        message = describe_failure(error, work.folder.resolve())
        text = LocalText.from_phrase(message)
        return CheckResult(check.title, passed=False, message=text, is_lack=is_lack(error, work.folder.resolve()))
    return CheckResult(check.title, passed=True)


def _without_repetition(results: Sequence[CheckResult]) -> list[CheckResult]:
    """Return the results with each message only once: a missing file fails all checks of a step."""
    seen: set[LocalText] = set()
    unique: list[CheckResult] = []
    for result in results:
        if result.message is not None and result.message in seen:
            result = replace(result, message=None)
        elif result.message is not None:
            seen.add(result.message)
        unique.append(result)
    return unique


def check_command(step: Step, workspace: Path, output: Path, *, answer: str | None = None) -> list[str]:
    """Return the command that runs the checks of a step and writes the result as JSON to a file."""
    words = [*PYTHON, "-m", MODULE, str(step.lesson.folder), step.id, str(workspace), str(output)]
    return words if answer is None else [*words, answer]


def check_in_process(
    step: Step, workspace: Path, *, answer: str | None = None, time_limit: float = TIME_LIMIT
) -> StepResult:
    """Run the checks of a step in a process of their own; see `CheckProcess`."""
    return CheckProcess(step, workspace, answer=answer, time_limit=time_limit).run()


class CheckProcess:
    """A process that runs the checks of a step.

    Everything that the process started ends with it. A process that takes longer than `time_limit`, or that dies,
    fails the step with a message.

    Args:
        step: the step.
        workspace: the learner's workspace.
        answer: the number that the learner answered, as text.
        time_limit: the seconds after which the process is ended.
    """

    def __init__(
        self, step: Step, workspace: Path, *, answer: str | None = None, time_limit: float = TIME_LIMIT
    ) -> None:
        self._step = step
        self._workspace = workspace
        self._answer = answer
        self._time_limit = time_limit
        self._process: subprocess.Popen[str] | None = None
        self._is_canceled = False

    def run(self) -> StepResult:
        """Run the checks, and return their results."""
        begin = time.monotonic()
        with ScratchFolder("check") as scratch:
            output = Path(scratch) / "result.json"
            reason = self._run_command(check_command(self._step, self._workspace, output, answer=self._answer))
            data = _read(output)
        if data is not None and reason is None:
            return StepResult.from_data(data)
        message = reason or phrase("the checks of this step ended without a result")
        failed = CheckResult(self._step.title, passed=False, message=LocalText.from_phrase(message))
        return StepResult(self._step.address, [failed], time.monotonic() - begin)

    def cancel(self) -> None:
        """End the process, from any thread. `run` then returns soon, with a result that is of no use."""
        self._is_canceled = True
        process = self._process
        if process is not None:
            _end_group(process)

    def _run_command(self, command: Sequence[str]) -> Any:
        """Run a command, and return why it ended early, or None."""
        with subprocess.Popen(  # noqa: S603 - our own command
            command,
            cwd=self._workspace,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
            text=True,
            encoding="utf-8",
            errors="replace",
        ) as process:
            self._process = process
            if self._is_canceled:
                _end_group(process)
            try:
                _, errors = process.communicate(timeout=self._time_limit)
            except subprocess.TimeoutExpired:
                return phrase("the check took longer than {seconds:g} s and was ended", seconds=self._time_limit)
            finally:
                self._process = None
                _end_group(process)
            if process.returncode:
                last = (errors.strip().splitlines() or [""])[-1]
                return phrase("the process of the check ended early: {error}", error=foreign(last))
        return None


def _end_group(process: subprocess.Popen[str]) -> None:
    """End the process and all processes of its session."""
    if sys.platform == "win32":
        if process.poll() is None:  # Windows finds the children of a running process only
            command = ["taskkill", "/T", "/F", "/PID", str(process.pid)]
            subprocess.run(command, capture_output=True, check=False)  # noqa: S603 - the ID of our own process
            process.kill()
        return
    with suppress(ProcessLookupError, PermissionError):
        os.killpg(process.pid, signal.SIGKILL)


def _read(output: Path) -> Any:
    try:
        return json.loads(output.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None


def main(words: Sequence[str]) -> int:
    """Run the checks of a step, as `check_command` requests it.

    The output exists, and is empty, from the beginning of the first check on.
    """
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    domains = [domain for domain in range(1, _DOMAINS + 1) if str(domain) != os.environ.get("ROS_DOMAIN_ID")]
    os.environ["ROS_DOMAIN_ID"] = os.environ.get(DOMAIN_VARIABLE) or str(domains[os.getpid() % len(domains)])
    lesson_folder, step_id, workspace, output, *answers = words
    lesson = load_lesson(Path(lesson_folder))
    step = next(step for step in lesson.steps if step.id == step_id)
    try:
        answer = answers[0] if answers else None
        result = check_step(step, Path(workspace), answer=answer, begin_checks=Path(output).touch)
    except LinkwrightError as error:
        texts = [LocalText.from_phrase(describe_finding(finding)) for finding in error.diagnostics]
        failed = [CheckResult(step.title, passed=False, message=text, is_lack=True) for text in texts]
        result = StepResult(step.address, failed)
    Path(output).write_text(json.dumps(result.to_data(), ensure_ascii=False), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
