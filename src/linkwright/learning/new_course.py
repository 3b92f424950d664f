"""Create a course from the shipped example."""

from __future__ import annotations

import shutil
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.learning.course import find_course

EXAMPLE = "example"


def create_course(folder: Path) -> list[Path]:
    """Create a course as a copy of the example, which passes ``linkwright learn test``.

    Returns:
        The files of the new course.

    Raises:
        LinkwrightError: LEARN111, a file cannot be written; LEARN115, the folder exists and is not empty.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        message = phrase("'{folder}' exists and is not an empty folder", folder=display_path(folder))
        raise LinkwrightError(Diagnostic("LEARN115", message, hint=phrase("pass a new folder")))
    try:
        shutil.copytree(find_course(EXAMPLE), folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    except (OSError, shutil.Error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = phrase("cannot write '{path}': {error}", path=display_path(folder), error=reason)
        raise LinkwrightError(Diagnostic("LEARN111", message)) from None
    return sorted(path for path in folder.rglob("*") if path.is_file())
