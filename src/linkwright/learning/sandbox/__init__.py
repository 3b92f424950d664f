"""The sandbox in which students' work is checked: a program runs confined, within limits, and is ended as a whole."""

from linkwright.learning.sandbox.outcome import Exceeded, Limits, Outcome, Protection
from linkwright.learning.sandbox.readable import permit_reading
from linkwright.learning.sandbox.run import protections_available, run_in_sandbox
from linkwright.learning.sandbox.words import PROTECTIONS, describe_exceeded

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
