"""The folders in which the program stores data of the user.

Source: the XDG Base Directory Specification.
"""

from __future__ import annotations

import os
from pathlib import Path

SHARES_SUBFOLDER = "shares"
"""The cache subfolder for share folders of packages that are not built.

See `linkwright.packages.share_layout`.
"""

PREFIXES_SUBFOLDER = "prefixes"
"""The subfolder of `SHARES_SUBFOLDER` for install prefixes of packages that are not built."""


_DEFAULT_FOLDERS = {"CACHE": ".cache", "CONFIG": ".config", "DATA": ".local/share", "STATE": ".local/state"}


def cache_folder() -> Path:
    """Return the folder for data that can be recreated.

    The folder is ``XDG_CACHE_HOME/linkwright`` or ``~/.cache/linkwright``.
    """
    return _find_folder("CACHE")


def config_folder() -> Path:
    """Return the folder for the user's settings.

    The folder is ``XDG_CONFIG_HOME/linkwright`` or ``~/.config/linkwright``.
    """
    return _find_folder("CONFIG")


def data_folder() -> Path:
    """Return the folder for installed data, such as models.

    The folder is ``XDG_DATA_HOME/linkwright`` or ``~/.local/share/linkwright``.
    """
    return _find_folder("DATA")


def state_folder() -> Path:
    """Return the folder for data that persists between runs.

    The folder is ``XDG_STATE_HOME/linkwright`` or ``~/.local/state/linkwright``.
    """
    return _find_folder("STATE")


def _find_folder(kind: str) -> Path:
    base_folder = os.environ.get(f"XDG_{kind}_HOME")
    return (Path(base_folder) if base_folder else Path.home() / _DEFAULT_FOLDERS[kind]) / "linkwright"
