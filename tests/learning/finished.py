"""The workspace of a learner after some lessons of a course."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path

from linkwright.learning.course import Lesson


def finish_lessons(lessons: Iterable[Lesson], workspace: Path) -> None:
    """Copy the initial files and the solutions of lessons.

    Their order is that in which a learner gets them.
    """
    for lesson in lessons:
        for source in (lesson.start, *(step.solution for step in lesson.steps)):
            if source.is_dir():
                shutil.copytree(source, workspace, dirs_exist_ok=True)
