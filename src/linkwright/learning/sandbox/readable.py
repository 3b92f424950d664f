"""The files that every run may read.

They are Python, Linkwright, and the system's programs, libraries and settings.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import linkwright
from linkwright.packages.finder import find_shipped_folder

_SYSTEM_FOLDERS = (
    "/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/libx32", "/nix/store", "/gnu/store",
    "/System", "/Library",
)  # fmt: skip
_SETTINGS_NAMES = (
    "alternatives", "ca-certificates", "crypto-policies", "fonts", "glvnd", "group", "host.conf", "hosts",
    "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "locale.alias", "localtime", "mime.types", "nsswitch.conf",
    "os-release", "passwd", "pki", "protocols", "resolv.conf", "services", "ssl", "timezone",
)  # fmt: skip
_STATE_PATHS = (
    "/sys/devices/system",
    "/proc/cpuinfo",
    "/proc/meminfo",
    "/proc/stat",
    "/proc/version",
    "/proc/filesystems",
)


def permit_reading(folder: Path) -> None:
    """Allow all users to read a folder that contains only folders and regular files."""
    for path in (folder, *folder.rglob("*")):
        path.chmod(0o755 if path.is_dir() else 0o644 | path.stat().st_mode & 0o111)


def list_readable_paths() -> list[str]:
    """Return the existing paths that every run may read."""
    installation = [sys.prefix, sys.exec_prefix, sys.base_prefix, sys.base_exec_prefix]
    packages = [str(path) for folder in linkwright.__path__ for path in (Path(folder).parent, Path(folder))]
    shipped = [str(folder) for folder in [find_shipped_folder()] if folder is not None]
    interpreter = [sys.executable, os.path.realpath(sys.executable)]
    settings = [f"/etc/{name}" for name in _SETTINGS_NAMES]
    paths = dict.fromkeys(
        [*installation, *interpreter, *packages, *shipped, *_SYSTEM_FOLDERS, *settings, *_STATE_PATHS]
    )
    return [os.path.abspath(path) for path in paths if path and Path(path).exists()]
