"""The environment variable that disables communication with other processes."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from linkwright.diagnostics import Phrase, phrase

SWITCH_VARIABLE = "LINKWRIGHT_DDS"
"""With the value 0 a process does not communicate with others, over any middleware."""


def is_switched_off(environment: Mapping[str, str] | None = None) -> bool:
    """Return whether communication with other processes is switched off.

    Args:
        environment: the environment variables; by default, the variables of this process.
    """
    variables = os.environ if environment is None else environment
    return variables.get(SWITCH_VARIABLE, "1") == "0"


@contextmanager
def switched_off() -> Iterator[None]:
    """Switch communication with other processes off, in a ``with`` block."""
    old_value = os.environ.get(SWITCH_VARIABLE)
    os.environ[SWITCH_VARIABLE] = "0"
    try:
        yield
    finally:
        if old_value is None:
            del os.environ[SWITCH_VARIABLE]
        else:
            os.environ[SWITCH_VARIABLE] = old_value


def switched_off_reason() -> Phrase:
    """Return the reason why communication is switched off."""
    return phrase("the environment variable {variable} is 0", variable=SWITCH_VARIABLE)
