"""Marks on errors that tell missing software of others from mistakes of the user.

A launch skips such a part and continues: the simulation of a robot is useful without move_group.
"""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageNotFoundError

_MARK = "is_unavailable"


def unavailable(error: LinkwrightError) -> LinkwrightError:
    """Mark an error whose package or program is not installed and not misspelt."""
    vars(error)[_MARK] = True
    return error


def is_unavailable(error: LinkwrightError) -> bool:
    """Return whether an error was marked, see `unavailable`."""
    return bool(vars(error).get(_MARK))


def is_foreign(error: LinkwrightError) -> bool:
    """Return whether an error on reading a launch file is about a missing package or module of others."""
    if isinstance(error, PackageNotFoundError):
        return not error.is_slip
    return isinstance(error, ModuleNotFoundError) or is_unavailable(error)
