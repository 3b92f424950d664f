"""The names of recordings' files and of topics, and the types of messages, that this package shares."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

TRANSFORMS, STATIC_TRANSFORMS = "/tf", "/tf_static"
TRANSFORMS_NS = 2_000_000_000
"""The time before a moment in which transforms are used: each message has only some of the frames."""

Recorded = tuple[str, int, bytes]
"""A message: its topic, when it was received, nanoseconds since the epoch, and its CDR bytes."""

SUFFIXES = {".mcap": "mcap", ".db3": "sqlite3"}
"""The suffixes of the files of a recording, with the names of their storages."""

METADATA = "metadata.yaml"
"""The file that describes the other files in the folder of a recording."""

ROS1 = ".bag"
"""The suffix of recordings of ROS 1, which are refused with a hint on converting them."""

PACKED = ".zstd"
"""Put behind the name of a file that is compressed as a whole."""

_NUMBERED = re.compile(r"(.+)_(0|[1-9][0-9]*)(\.mcap|\.db3)((?:\.zstd)?)")
"""The names that rosbag2 gives to the files of a recording; those that end with a time of day have a zero there."""


def numbered(folder: Path, number: int, suffix: str) -> Path:
    """Return the path of a file in a recording, named after the folder and a number that starts at 0."""
    return folder / f"{Path(folder.absolute()).name}_{number}{suffix}"


def storage_of(path: Path) -> str | None:
    """Return the storage format that the name of a file indicates, or None if it indicates none.

    The file may be compressed.
    """
    return SUFFIXES.get(Path(path.name.removesuffix(PACKED)).suffix)


def is_recording(path: Path) -> bool:
    """Return whether a path looks like a recording.

    A recording is a file with a suffix of recordings, or a folder with such files or a ``metadata.yaml``.
    """
    if not path.is_dir():
        return storage_of(path) is not None or path.suffix == ROS1
    return (path / METADATA).exists() or any(storage_of(entry) is not None for entry in path.iterdir())


def in_order(files: Sequence[Path]) -> list[Path]:
    """Return the files of a recording, sorted by number."""
    found = [(int(match[2]) if (match := _NUMBERED.fullmatch(file.name)) else 0, file) for file in files]
    return [each for _, each in sorted(found)]


def are_of_one_recording(files: Sequence[Path]) -> bool:
    """Return whether the names of files have consecutive numbers, as those of one recording do."""
    found = [_NUMBERED.fullmatch(file.name) for file in files]
    numbers = sorted(int(match[2]) for match in found if match is not None)
    alike = {(match[1], match[3], match[4]) for match in found if match is not None}
    return len(alike) == 1 and len(numbers) == len(files) == numbers[-1] - numbers[0] + 1
