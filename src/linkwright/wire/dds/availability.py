"""Whether DDS is installed, found out without importing the library (which takes 0.15 s)."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from importlib.util import find_spec

from linkwright.diagnostics import Phrase, phrase

SWITCH = "LINKWRIGHT_DDS"


def why_not(environment: Mapping[str, str] | None = None) -> Phrase:
    """Why this process does not use DDS; empty when it does.

    Args:
        environment: the environment variables; those of the process when left out.
    """
    variables = os.environ if environment is None else environment
    if variables.get(SWITCH, "1") == "0":
        return phrase("the environment variable {switch} is 0", switch=SWITCH)
    if find_spec("cyclonedds") is None:
        return phrase(
            "the package 'cyclonedds' is not installed: run pip install 'linkwright[dds]' (there are wheels of it for"
            " Linux x86_64, Windows and macOS arm64; this is {system} {machine} with Python {version})",
            system=platform.system(),
            machine=platform.machine(),
            version=platform.python_version(),
        )
    return Phrase("")


def available(environment: Mapping[str, str] | None = None) -> bool:
    """Whether DDS can be joined."""
    return not why_not(environment)
