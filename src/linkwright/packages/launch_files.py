"""The launch files of a package."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from linkwright.packages.share_layout import find_source

_LAUNCH_SUFFIXES = ("launch.py", "launch.xml", "launch.yaml", "launch.yml")
_MAX_DEPTH = 4
_BUILD_FOLDERS = ("build", "install", "log")


def is_launch_file_name(name: str) -> bool:
    """Return whether a file name denotes a launch file (``ros2launch.api.is_launch_file``)."""
    return name.endswith(_LAUNCH_SUFFIXES)


def find_launch_files_below(folder: Path) -> list[Path]:
    """Return the launch files in a folder and a few levels below, sorted by name.

    Hidden folders and the build folders of colcon are left out. A share folder may contain a file twice, at its path in
    the sources and at its installed path (see `share_layout`). Such a file is returned once.
    """
    launch_files: dict[str, Path] = {}
    for path in _iterate_launch_files(folder, _MAX_DEPTH):
        launch_files.setdefault(find_source(str(path)), path)
    return list(launch_files.values())


def _iterate_launch_files(folder: Path, depth: int) -> Iterator[Path]:
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return
    for entry in entries:
        if entry.is_dir():
            if depth and not entry.name.startswith(".") and entry.name not in _BUILD_FOLDERS:
                yield from _iterate_launch_files(entry, depth - 1)
        elif is_launch_file_name(entry.name):
            yield entry
