"""The results of the checks of a step, and their conversion to JSON for other processes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.learning.local_text import LocalText


@dataclass(frozen=True)
class CheckResult:
    """The result of one check.

    Attributes:
        title: what the check expects.
        passed: whether the check is satisfied.
        message: the reason why the check is not satisfied; None if it is.
        is_machine_fault: whether the check failed because of the machine, and not because of the learner's files.
    """

    title: LocalText
    passed: bool
    message: LocalText | None = None
    is_machine_fault: bool = False

    def to_data(self) -> dict[str, Any]:
        """Return the result as JSON values."""
        message = None if self.message is None else self.message.texts
        return {
            "title": self.title.texts,
            "passed": self.passed,
            "message": message,
            "machine_fault": self.is_machine_fault,
        }

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> CheckResult:
        """Return the result that `to_data` wrote."""
        message = data["message"]
        text = None if message is None else LocalText(message)
        return cls(LocalText(data["title"]), bool(data["passed"]), text, bool(data.get("machine_fault", False)))


@dataclass(frozen=True)
class StepResult:
    """The results of the checks of a step.

    Attributes:
        step: the address of the step, ``LESSON/STEP``.
        checks: the result of each check in the order of the file.
        seconds: the time that the checks took.
    """

    step: str
    checks: Sequence[CheckResult]
    seconds: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether all checks are satisfied."""
        return all(result.passed for result in self.checks)

    @property
    def has_machine_fault(self) -> bool:
        """Whether a check failed because of the machine, and not because of the learner's files."""
        return any(result.is_machine_fault for result in self.checks)

    def to_data(self) -> dict[str, Any]:
        """Return the results as JSON values."""
        return {
            "step": self.step,
            "passed": self.passed,
            "checks": [result.to_data() for result in self.checks],
            "seconds": round(self.seconds, 3),
        }

    @classmethod
    def from_data(cls, data: Mapping[str, Any]) -> StepResult:
        """Return the results that `to_data` wrote."""
        checks = [CheckResult.from_data(result) for result in data["checks"]]
        return cls(str(data["step"]), checks, float(data["seconds"]))
