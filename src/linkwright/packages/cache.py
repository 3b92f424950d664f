"""The folder of the user's cache."""

from __future__ import annotations

import os
from pathlib import Path

SHARES = "shares"
"""Where in it the share folders of packages are that are not built; see `linkwright.packages.share_layout`."""


def cache_folder() -> Path:
    """``XDG_CACHE_HOME/linkwright`` or ``~/.cache/linkwright``."""
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "linkwright"
