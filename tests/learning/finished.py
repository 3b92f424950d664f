"""The workspace of a learner after some lessons of a course."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from linkwright.learning.course import Lesson


def finish(lessons: Iterable[Lesson], workspace: Path) -> None:
    """Copy the files to begin with and the solutions of lessons, as a learner gets them one after another."""
    for lesson in lessons:
        for source in (lesson.start, *(step.solution for step in lesson.steps)):
            if source.is_dir():
                shutil.copytree(source, workspace, dirs_exist_ok=True)
