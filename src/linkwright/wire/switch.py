"""The environment variable that keeps a process to itself."""

from __future__ import annotations

import os
from collections.abc import Mapping

from linkwright.diagnostics import Phrase, phrase

SWITCH = "LINKWRIGHT_DDS"
"""With the value 0 a process does not communicate with others, over any middleware."""


def is_switched_off(environment: Mapping[str, str] | None = None) -> bool:
    """Whether this process is to keep to itself.

    Args:
        environment: the environment variables; those of the process when left out.
    """
    variables = os.environ if environment is None else environment
    return variables.get(SWITCH, "1") == "0"


def switched_off() -> Phrase:
    """The reason to give for it."""
    return phrase("the environment variable {switch} is 0", switch=SWITCH)
