"""Import of SciPy, a dependency of the extra ``navigation``."""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

from linkwright.diagnostics import missing_extra


@cache
def load_scipy(subpackage: str) -> Any:
    """Import a subpackage of SciPy, such as ``ndimage``, as an untyped module.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed.
    """
    try:
        return import_module(f"scipy.{subpackage}")
    except ModuleNotFoundError as error:
        raise missing_extra("NAV101", error) from None
