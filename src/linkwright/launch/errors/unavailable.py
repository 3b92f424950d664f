"""Mark errors that are caused by missing third-party software, not by the user.

A launch skips the parts whose software is missing, and continues. For example, the simulation of a robot is useful
even without move_group.
"""

from __future__ import annotations

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageNotFoundError

_MARK_ATTRIBUTE = "is_unavailable"


def mark_unavailable(error: LinkwrightError) -> LinkwrightError:
    """Mark an error as caused by missing third-party software, and return it.

    Callers do not mark errors about misspelled names.
    """
    vars(error)[_MARK_ATTRIBUTE] = True
    return error


def is_unavailable(error: LinkwrightError) -> bool:
    """Return whether `mark_unavailable` marked an error."""
    return bool(vars(error).get(_MARK_ATTRIBUTE))


def is_missing_third_party(error: LinkwrightError) -> bool:
    """Return whether an error reports a missing third-party package or module."""
    if isinstance(error, PackageNotFoundError):
        return not error.is_misspelling
    return isinstance(error, ModuleNotFoundError) or is_unavailable(error)
