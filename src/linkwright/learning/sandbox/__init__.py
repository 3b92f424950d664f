"""The sandbox for students' programs, which confines a run, limits its resources, and ends all its processes."""

from linkwright.learning.sandbox.outcome import Exceeded, Limits, Outcome, Protection
from linkwright.learning.sandbox.readable import permit_reading
from linkwright.learning.sandbox.run import protections_available, run_in_sandbox
from linkwright.learning.sandbox.sentences import PROTECTIONS, describe_exceeded

__all__ = [
    "PROTECTIONS",
    "Exceeded",
    "Limits",
    "Outcome",
    "Protection",
    "describe_exceeded",
    "permit_reading",
    "protections_available",
    "run_in_sandbox",
]
