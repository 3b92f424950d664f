"""The marks of students, and their conversion to JSON for the journal and other programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.learning.checks.results import CheckResult
from linkwright.learning.grading.submissions import Submission
from linkwright.learning.local_text import LocalText

NOT_GRADED = phrase("not graded, because the check could not run")


@dataclass(frozen=True)
class Mark:
    """The mark of a student for a step.

    Attributes:
        step: the address of the step.
        passed: whether all checks are satisfied.
        checks: the results of the checks; none if the run ended without a result.
        reason: why the run ended without a result.
        seconds: the time that the run took, which does not affect the mark.
        protections: the protections that were in force.
        is_repeated: whether the step was checked again alone.
        is_graded: whether the mark is valid; False if the grader failed.
        may_differ: whether the run should be repeated alone, because the load of the machine may have made it fail.
    """

    step: str
    passed: bool
    checks: Sequence[CheckResult] = ()
    reason: LocalText | None = None
    seconds: float = 0.0
    protections: Sequence[str] = ()
    is_repeated: bool = False
    is_graded: bool = True
    may_differ: bool = False

    @property
    def messages(self) -> list[LocalText]:
        """The messages of the checks that are not satisfied."""
        messages = [check.message or check.title for check in self.checks if not check.passed]
        messages = messages if self.reason is None else [self.reason, *messages]
        return messages if self.is_graded else [LocalText.from_phrase(NOT_GRADED), *messages]

    def to_data(self) -> dict[str, Any]:
        """Return the mark as JSON values."""
        return {
            "step": self.step,
            "passed": self.passed,
            "graded": self.is_graded,
            "checks": [check.to_data() for check in self.checks],
            "reason": None if self.reason is None else self.reason.texts,
            "seconds": round(self.seconds, 2),
            "protections": list(self.protections),
            "repeated": self.is_repeated,
        }

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> Mark:
        """Return the mark that `to_data` wrote."""
        return cls(
            step=data["step"],
            passed=data["passed"],
            is_graded=data["graded"],
            checks=[CheckResult.from_data(check) for check in data["checks"]],
            reason=None if data["reason"] is None else LocalText(data["reason"]),
            seconds=data["seconds"],
            protections=data["protections"],
            is_repeated=data["repeated"],
        )


@dataclass(frozen=True)
class StudentMarks:
    """The marks of a student.

    Attributes:
        submission: the student's folder.
        marks: the marks by the address of the step, in the order of the course; none if the folder was not graded.
        points: the points of each step.
    """

    submission: Submission
    marks: Mapping[str, Mark]
    points: Mapping[str, float]

    @property
    def is_graded(self) -> bool:
        """Whether all steps are graded."""
        return self.submission.is_readable and all(mark.is_graded for mark in self.marks.values())

    @property
    def total(self) -> float:
        """The points of the steps that are passed."""
        return sum(self.points[step] for step, mark in self.marks.items() if mark.passed)

    @property
    def possible(self) -> float:
        """The points of all steps."""
        return sum(self.points.values())


def describe_class_size(students: Sequence[StudentMarks]) -> Phrase:
    """Return the number of students and of steps."""
    steps = len(students[0].points) if students else 0
    return phrase(
        "{students}, {steps}",
        students=counted("{count} student", "{count} students", len(students)),
        steps=counted("{count} step", "{count} steps", steps),
    )
