"""Run the checks of a step in a process of their own, because they may run the learner's code."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from linkwright.diagnostics import LinkwrightError, foreign, phrase
from linkwright.learning.checks.declaring import Check, load_checks
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.programs import describe_failure
from linkwright.learning.checks.results import CheckResult, StepResult
from linkwright.learning.checks.work import Work
from linkwright.learning.course import CHECKS_FILE, Step, load_lesson
from linkwright.learning.local_text import LocalText

TIME_LIMIT = 120.0
"""The seconds after which the process of a step's checks is ended. Checks with simulated worlds take the longest."""

_DOMAINS = 100
"""The number of ROS domains among which the process of a check selects its own, without domain 0, the default."""

DOMAIN_VARIABLE = "LINKWRIGHT_CHECK_DOMAIN"
"""The variable with the ROS domain of a check, for callers that run several at a time in one network."""

MODULE = "linkwright.learning.checks.running"


def check_step(step: Step, workspace: Path, *, answer: str | None = None) -> StepResult:
    """Run the checks of a step in this process.

    Args:
        step: the step.
        workspace: the learner's workspace.
        answer: the number that the learner answered, as text.

    Raises:
        LinkwrightError: LEARN102, LEARN107: the checks of the lesson cannot be loaded.
    """
    begin = time.monotonic()
    checks = load_checks(step.lesson.folder / CHECKS_FILE).get(step.id, ())
    work = Work(workspace, lesson=step.lesson.folder, answer=answer)
    results = [_run(check, work) for check in checks]
    return StepResult(step.address, _without_repetition(results), time.monotonic() - begin)


def _run(check: Check, work: Work) -> CheckResult:
    try:
        check.function(work)
    except NotYet as reason:
        return CheckResult(check.title, passed=False, message=reason.text)
    except LinkwrightError as error:
        return CheckResult(check.title, passed=False, message=LocalText.from_phrase(error.diagnostics[0].message))
    except Exception as error:  # noqa: BLE001 - the learner's files can be anything
        message = describe_failure(error, work.folder.resolve())
        return CheckResult(check.title, passed=False, message=LocalText.from_phrase(message))
    return CheckResult(check.title, passed=True)


def _without_repetition(results: Sequence[CheckResult]) -> list[CheckResult]:
    """Return the results with each message only once: a missing file fails all checks of a step."""
    seen: set[LocalText] = set()
    unique: list[CheckResult] = []
    for result in results:
        if result.message is not None and result.message in seen:
            result = CheckResult(result.title, passed=False)
        elif result.message is not None:
            seen.add(result.message)
        unique.append(result)
    return unique


def check_command(step: Step, workspace: Path, output: Path, *, answer: str | None = None) -> list[str]:
    """Return the command that runs the checks of a step and writes the result as JSON to a file."""
    words = [sys.executable, "-m", MODULE, str(step.lesson.folder), step.id, str(workspace), str(output)]
    return words if answer is None else [*words, answer]


def check_in_process(
    step: Step, workspace: Path, *, answer: str | None = None, time_limit: float = TIME_LIMIT
) -> StepResult:
    """Run the checks of a step in a process of their own.

    Everything that the process started ends with it. A process that takes longer than `time_limit`, or that dies,
    fails the step with a message.

    Args:
        step: the step.
        workspace: the learner's workspace.
        answer: the number that the learner answered, as text.
        time_limit: the seconds after which the process is ended.
    """
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="linkwright-check-") as scratch:
        output = Path(scratch) / "result.json"
        command = check_command(step, workspace, output, answer=answer)
        reason = _run_command(command, workspace, time_limit)
        data = _read(output)
    if data is not None and reason is None:
        return StepResult.from_data(data)
    message = reason or phrase("the checks of this step ended without a result")
    failed = CheckResult(step.title, passed=False, message=LocalText.from_phrase(message))
    return StepResult(step.address, [failed], time.monotonic() - begin)


def _run_command(command: Sequence[str], workspace: Path, time_limit: float) -> Any:
    """Run a command, and return why it ended early, or None."""
    with subprocess.Popen(  # noqa: S603 - our own command
        command,
        cwd=workspace,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        start_new_session=True,
        text=True,
        encoding="utf-8",
        errors="replace",
    ) as process:
        try:
            _, errors = process.communicate(timeout=time_limit)
        except subprocess.TimeoutExpired:
            return phrase("the check took longer than {seconds:g} s and was ended", seconds=time_limit)
        finally:
            _end_group(process)
        if process.returncode:
            last = (errors.strip().splitlines() or [""])[-1]
            return phrase("the process of the check ended early: {error}", error=foreign(last))
    return None


def _end_group(process: subprocess.Popen[str]) -> None:
    """End the process and all processes of its session."""
    if sys.platform == "win32":
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
    """Run the checks of a step, as `check_command` requests it."""
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_DOMAIN_ID"] = os.environ.get(DOMAIN_VARIABLE) or str(1 + os.getpid() % _DOMAINS)
    lesson_folder, step_id, workspace, output, *answers = words
    lesson = load_lesson(Path(lesson_folder))
    step = next(step for step in lesson.steps if step.id == step_id)
    try:
        result = check_step(step, Path(workspace), answer=answers[0] if answers else None)
    except LinkwrightError as error:
        failed = [
            CheckResult(step.title, passed=False, message=LocalText.from_phrase(finding.message))
            for finding in error.diagnostics
        ]
        result = StepResult(step.address, failed)
    Path(output).write_text(json.dumps(result.to_data(), ensure_ascii=False), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
