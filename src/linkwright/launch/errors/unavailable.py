"""Errors because software of others is not installed here, told from mistakes of the user.

A launch leaves such a part out and goes on: the simulation of a robot is of use without move_group.
"""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageNotFoundError

_MARK = "is_unavailable"


def unavailable(error: LinkwrightError) -> LinkwrightError:
    """Mark an error: the package or program that it names is not installed, and does not look misspelt."""
    vars(error)[_MARK] = True
    return error


def is_unavailable(error: LinkwrightError) -> bool:
    """Whether an error was marked, see `unavailable`."""
    return bool(vars(error).get(_MARK))


def is_foreign(error: LinkwrightError) -> bool:
    """Whether an error, which kept a launch file from being read, is that a package or module of others is missing."""
    if isinstance(error, PackageNotFoundError):
        return not error.is_slip
    return isinstance(error, ModuleNotFoundError) or is_unavailable(error)
