"""What recordings are called."""

from __future__ import annotations

from pathlib import Path

SUFFIXES = {".mcap": "mcap", ".db3": "sqlite3"}
"""Of the files of a recording, with the names of their storages."""

ROS1 = ".bag"
"""Of recordings of ROS 1, of which can only be said what makes them readable."""

PACKED = ".zstd"
"""Put behind the name of a file that is compressed as a whole."""


def storage_of(path: Path) -> str | None:
    """The storage of a recording's file, compressed or not, by its name; None for another file."""
    return SUFFIXES.get(Path(path.name.removesuffix(PACKED)).suffix)


def is_recording(path: Path) -> bool:
    """Whether a path is that of a recording, by its names: of its file, or of the folder with its metadata or files."""
    if not path.is_dir():
        return storage_of(path) is not None or path.suffix == ROS1
    return (path / "metadata.yaml").exists() or any(storage_of(each) is not None for each in path.iterdir())
