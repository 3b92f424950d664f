"""The owner of a code file: Linkwright, the user, or an installed library."""

from __future__ import annotations

import os
import sysconfig
from pathlib import Path

_LINKWRIGHT_FOLDER = str(Path(__file__).parents[2]) + os.sep
_SHIPPED_PACKAGES = _LINKWRIGHT_FOLDER + "robots" + os.sep
_LIBRARY_FOLDERS = tuple({sysconfig.get_path("stdlib"), sysconfig.get_path("purelib"), sysconfig.get_path("platlib")})


def is_linkwright_file(filename: str) -> bool:
    """Return whether a program file belongs to Linkwright, except to a shipped robot package."""
    return filename.startswith(_LINKWRIGHT_FOLDER) and not filename.startswith(_SHIPPED_PACKAGES)


def is_user_file(filename: str) -> bool:
    """Return whether a program file belongs to the user, not to Linkwright or a library."""
    if filename.startswith("<") or is_linkwright_file(filename):
        return False
    return not filename.startswith(tuple(folder for folder in _LIBRARY_FOLDERS if folder))
