"""Name the sets of argument values with which a robot is compared."""

from __future__ import annotations

import re
from collections.abc import Sequence

_MAX_ARGUMENTS = 4
"""The maximum number of arguments of an argument set that a line names."""
ARGUMENT = re.compile(r" (?=[\w.-]+:=)")
"""The space between two arguments in the name of an argument set."""


def find_distinct_arguments(case_name: str, cases: Sequence[str]) -> str:
    """Return the values that distinguish an argument set from the first set.

    For the first set, they are the values that the other sets do not share.
    """
    words = [set(ARGUMENT.split(case)) for case in cases]
    shared = set.intersection(*words) if case_name == cases[0] else words[0]
    distinct = [word for word in ARGUMENT.split(case_name) if word not in shared]
    return " ".join([*distinct[:_MAX_ARGUMENTS], *(["..."] if len(distinct) > _MAX_ARGUMENTS else [])]) or case_name
