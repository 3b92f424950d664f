"""Whether this installation can speak DDS, found out without importing the library (which takes 0.15 s)."""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from importlib.util import find_spec

SWITCH = "LINKWRIGHT_DDS"


def why_not(environment: Mapping[str, str] | None = None) -> str:
    """Why this process keeps to itself; empty when nothing stands in the way of DDS.

    Args:
        environment: the environment variables; those of the process when left out.
    """
    variables = os.environ if environment is None else environment
    if variables.get(SWITCH, "1") == "0":
        return f"the environment variable {SWITCH} is 0"
    if find_spec("cyclonedds") is None:
        return (
            "the package 'cyclonedds' is not installed (there are wheels of it for Linux x86_64, Windows and "
            f"macOS arm64; this is {platform.system()} {platform.machine()} with Python {platform.python_version()})"
        )
    return ""


def available(environment: Mapping[str, str] | None = None) -> bool:
    """Whether DDS can be joined."""
    return not why_not(environment)
