"""The JSON messages between the grader and a run's supervisor: the plan and the outcome."""

from __future__ import annotations

import base64
import json
from dataclasses import asdict, dataclass

from linkwright.learning.sandbox.outcome import Exceeded, Limits, Outcome, Protection


@dataclass(frozen=True)
class Plan:
    """The description of a run for its supervisor. Paths are absolute."""

    arguments: tuple[str, ...]
    folder: str
    readable: tuple[str, ...]
    environment: dict[str, str]
    limits: Limits
    processors: tuple[int, ...] = ()
    """The processors that the run may use. Empty means all of the grader's."""

    def to_json(self) -> str:
        """Return the plan as JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> Plan:
        """Parse a plan from JSON."""
        data = json.loads(text)
        return cls(
            arguments=tuple(data["arguments"]),
            folder=data["folder"],
            readable=tuple(data["readable"]),
            environment=data["environment"],
            limits=Limits(**data["limits"]),
            processors=tuple(data["processors"]),
        )


def outcome_to_json(outcome: Outcome) -> str:
    """Return an outcome as JSON."""
    return json.dumps(
        {
            "status": outcome.status,
            "stdout": base64.b64encode(outcome.stdout).decode(),
            "stderr": base64.b64encode(outcome.stderr).decode(),
            "exceeded": outcome.exceeded.value if outcome.exceeded else None,
            "protections": sorted(protection.value for protection in outcome.protections),
            "removed": outcome.removed,
            "seconds": outcome.seconds,
            "cpu_seconds": outcome.cpu_seconds,
        }
    )


def outcome_from_json(text: str) -> Outcome:
    """Parse an outcome from JSON."""
    data = json.loads(text)
    return Outcome(
        status=data["status"],
        stdout=base64.b64decode(data["stdout"]),
        stderr=base64.b64decode(data["stderr"]),
        exceeded=Exceeded(data["exceeded"]) if data["exceeded"] else None,
        protections=frozenset(Protection(value) for value in data["protections"]),
        removed=tuple(data["removed"]),
        seconds=data["seconds"],
        cpu_seconds=data["cpu_seconds"],
    )
