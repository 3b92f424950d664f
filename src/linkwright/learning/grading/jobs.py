"""Run a step's checks on a copy of a student's folder, in the sandbox."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.learning.checks.check_process import DOMAIN_VARIABLE, make_check_command
from linkwright.learning.checks.results import StepResult
from linkwright.learning.course import Step
from linkwright.learning.grading.marks import Mark
from linkwright.learning.local_text import LocalText
from linkwright.learning.sandbox import Exceeded, Limits, Outcome, describe_exceeded, run_in_sandbox

_SLOW_RUN_S = 2.0
"""A failed run of more seconds may have waited in vain, and is repeated without other runs."""

_MAX_RESULT_BYTES = 4 << 20
"""The size up to which a result is read. The student's program can have written it."""


@dataclass(frozen=True)
class Job:
    """A step to check for a student.

    Attributes:
        student: the index of the student.
        step: the step to check.
        copy: a copy of the student's folder, which the run copies again.
        answer: the student's answer.
        limits: the limits of the run.
        course: the folder with the lessons, which the run may read.
        domain: the ROS domain of the run.
        is_repeated: whether it is the second run.
    """

    student: int
    step: Step
    copy: Path
    answer: str | None
    limits: Limits
    course: Path
    domain: int
    is_repeated: bool = False


def run_job(job: Job) -> Mark:
    """Check a step in the sandbox, and return the mark.

    The step is not graded if a check failed because of the machine, or if the run ended before the first check began,
    before any code of the student ran.

    Raises:
        LinkwrightError: LEARN901, LEARN902: the sandbox cannot be used.
    """
    try:
        return _run_checks(job)
    except OSError as error:  # such as a full disk
        message = phrase("the program cannot run in the sandbox: {reason}", reason=foreign(error.strerror or error))
        raise LinkwrightError(Diagnostic("LEARN901", message)) from None


def _run_checks(job: Job) -> Mark:
    with tempfile.TemporaryDirectory(prefix="run-", dir=job.copy.parent, ignore_cleanup_errors=True) as name:
        folder = Path(name)
        workspace = folder / "workspace"
        shutil.copytree(job.copy, workspace)
        output = folder / f"result-{secrets.token_hex(16)}.json"
        outcome = run_in_sandbox(
            make_check_command(job.step, workspace, output, answer=job.answer),
            folder=folder,
            limits=job.limits,
            readable=[job.course],
            environment={DOMAIN_VARIABLE: str(job.domain)},
        )
        result = _read_result(output, job.step)
        has_begun = os.path.lexists(output)
    protections = sorted(protection.value for protection in outcome.protections)
    if result is None or outcome.exceeded is not None or outcome.status != 0:
        may_differ = not has_begun or outcome.exceeded in {None, Exceeded.SECONDS}
        reason = LocalText.from_phrase(_describe_end(outcome, job.limits))
        return Mark(
            job.step.address,
            passed=False,
            reason=reason,
            seconds=outcome.seconds,
            protections=protections,
            is_repeated=job.is_repeated,
            is_graded=has_begun,
            may_differ=may_differ,
        )
    return Mark(
        job.step.address,
        passed=result.passed and bool(result.checks),
        checks=result.checks,
        seconds=outcome.seconds,
        protections=protections,
        is_repeated=job.is_repeated,
        is_graded=not result.has_machine_fault,
        may_differ=result.has_machine_fault or (not result.passed and outcome.seconds > _SLOW_RUN_S),
    )


def _describe_end(outcome: Outcome, limits: Limits) -> Phrase:
    if outcome.exceeded is not None:
        return describe_exceeded(outcome.exceeded, limits)
    if outcome.status:
        return phrase("the process of the checks ended with status {status}", status=outcome.status)
    return phrase("the checks of this step ended without a result")


def _read_result(output: Path, step: Step) -> StepResult | None:
    """Return the result from a file whose content is not trusted.

    The student's program can write to the file.
    """
    try:
        descriptor = os.open(output, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return None
    with os.fdopen(descriptor, "rb") as file:
        content = file.read(_MAX_RESULT_BYTES + 1)
    if len(content) > _MAX_RESULT_BYTES:
        return None
    try:
        result = StepResult.from_data(json.loads(content))
        is_valid = result.step == step.address and all(map(_has_texts, result.checks))
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None
    return result if is_valid else None


def _has_texts(check: Any) -> bool:
    texts = [*check.title.texts.values(), *(check.message.texts.values() if check.message else ())]
    return all(isinstance(text, str) for text in texts)
