"""TOML files, which Python itself can read from 3.11 on."""

from __future__ import annotations

import re
import sys
from importlib import import_module
from typing import Any

from tests.places import REPOSITORY

_tomllib: Any = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")


def read_toml(text: str) -> dict[str, Any]:
    """Return the content of a TOML text."""
    found: dict[str, Any] = _tomllib.loads(text)
    return found


PYPROJECT = read_toml((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
PROJECT: dict[str, Any] = PYPROJECT["project"]
ENGINE: dict[str, Any] = read_toml((REPOSITORY / "core" / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS: dict[str, list[str]] = {
    name: needed for name, needed in PROJECT["optional-dependencies"].items() if name != "all"
}
"""The extras, without ``all``."""

TOGETHER = frozenset(re.split(r"[\[,\]]", PROJECT["optional-dependencies"]["all"][0])[1:-1])
"""The extras that ``all`` includes."""
