"""The sandbox for students' programs.

It confines a run, limits its resources, and ends all its processes.
"""

from linkwright.learning.sandbox.outcome import Exceeded, Limits, Outcome, Protection
from linkwright.learning.sandbox.readable import permit_reading
from linkwright.learning.sandbox.run import find_available_protections, run_in_sandbox
from linkwright.learning.sandbox.sentences import PROTECTIONS, describe_exceeded

__all__ = [
    "PROTECTIONS",
    "Exceeded",
    "Limits",
    "Outcome",
    "Protection",
    "describe_exceeded",
    "find_available_protections",
    "permit_reading",
    "run_in_sandbox",
]
