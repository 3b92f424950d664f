"""Marks on errors that distinguish missing third-party software from mistakes of the user.

A launch skips a part whose software is missing and continues: the simulation of a robot is useful even without
move_group.
"""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageNotFoundError

_MARK = "is_unavailable"


def mark_unavailable(error: LinkwrightError) -> LinkwrightError:
    """Mark an error as caused by missing third-party software, and return the error.

    Errors about misspelt names are not marked.
    """
    vars(error)[_MARK] = True
    return error


def is_unavailable(error: LinkwrightError) -> bool:
    """Return whether an error was marked by `mark_unavailable`."""
    return bool(vars(error).get(_MARK))


def is_missing_third_party(error: LinkwrightError) -> bool:
    """Return whether an error is about a missing third-party package or module."""
    if isinstance(error, PackageNotFoundError):
        return not error.is_slip
    return isinstance(error, ModuleNotFoundError) or is_unavailable(error)
