"""Names of files, topics and types that the modules of recordings share."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

TRANSFORMS, STATIC_TRANSFORMS = "/tf", "/tf_static"
TRANSFORMS_NS = 2_000_000_000
"""The length, in ns, of the interval whose transforms form the state at its end.

A single message contains only some of the frames.
"""

Recorded = tuple[str, int, bytes]
"""A message: its topic, its reception time in nanoseconds since the epoch, and its serialized data."""

SUFFIXES = {".mcap": "mcap", ".db3": "sqlite3"}
"""The suffixes of files of recordings, with the storage format of each."""

METADATA_FILE = "metadata.yaml"
"""The name of the file that describes the other files in the folder of a recording."""

ROS1_SUFFIX = ".bag"
"""The suffix of ROS 1 recordings. They are rejected with a hint on how to convert them."""

COMPRESSED_SUFFIX = ".zstd"
"""The suffix of a file that is compressed as a whole."""

_NUMBERED_NAME = re.compile(r"(.+)_(0|[1-9][0-9]*)(\.mcap|\.db3)((?:\.zstd)?)")
"""The pattern of the names that rosbag2 gives to files: a base name, a number, a suffix, and a compression suffix."""


def make_numbered_path(folder: Path, number: int, suffix: str) -> Path:
    """Return the path of a file in a recording.

    Its name consists of the folder's name, a number from 0 and a suffix.
    """
    return folder / f"{Path(folder.absolute()).name}_{number}{suffix}"


def find_storage_format(path: Path) -> str | None:
    """Return the storage format that the name of a file indicates.

    Return None if the file is not a file of a recording.

    The name may end with the suffix of compressed files.
    """
    return SUFFIXES.get(Path(path.name.removesuffix(COMPRESSED_SUFFIX)).suffix)


def is_recording(path: Path) -> bool:
    """Return whether a path looks like a recording, without opening it.

    A recording is a file with a suffix of recordings, or a folder with such files or a ``metadata.yaml``.
    """
    if not path.is_dir():
        return find_storage_format(path) is not None or path.suffix == ROS1_SUFFIX
    return (path / METADATA_FILE).exists() or any(find_storage_format(entry) is not None for entry in path.iterdir())


def sort_by_number(files: Sequence[Path]) -> list[Path]:
    """Return the files of a recording in the order of their numbers."""
    numbered_files = [(int(match[2]) if (match := _NUMBERED_NAME.fullmatch(file.name)) else 0, file) for file in files]
    return [file for _, file in sorted(numbered_files)]


def belong_together(files: Sequence[Path]) -> bool:
    """Return whether files have one base name and consecutive numbers, as in a recording."""
    matches = [_NUMBERED_NAME.fullmatch(file.name) for file in files]
    numbers = sorted(int(match[2]) for match in matches if match is not None)
    base_names = {(match[1], match[3], match[4]) for match in matches if match is not None}
    return len(base_names) == 1 and len(numbers) == len(files) == numbers[-1] - numbers[0] + 1
