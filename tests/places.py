"""Where things are in the repository, for tests."""

from __future__ import annotations

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "robots" / "my_robot_description"
TUTORIAL = (REPOSITORY.parent / "shared" / "tutorial").resolve()
"""The tutorial's files as published; not part of the repository, so tests of it run only where they are."""
