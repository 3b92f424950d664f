"""What recordings are called."""

from __future__ import annotations

from pathlib import Path

SUFFIXES = {".mcap": "mcap", ".db3": "sqlite3"}
"""Of the files of a recording, with the names of their storages."""


def is_recording(path: Path) -> bool:
    """Whether a path is that of a recording, by its names: of its file, or of the folder with its metadata or files."""
    if not path.is_dir():
        return path.suffix in SUFFIXES
    return (path / "metadata.yaml").exists() or any(each.suffix in SUFFIXES for each in path.iterdir())
