"""The lessons of the shipped courses in parts, because a file of tests runs in one process."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.learning.course import Course, Lesson, find_courses_folder, load_course
from linkwright.learning.lesson_tests import test_lesson as run_lesson_tests
from linkwright.process.forked import ForkServer

COURSES = [load_course(file.parent) for file in sorted((find_courses_folder() or ()).glob("*/course.toml"))]
LESSONS = [
    pytest.param(course, lesson, id=f"{course.id}-{lesson.id}") for course in COURSES for lesson in course.lessons
]
_PARTS = 4


def lessons_of_part(number: int) -> list[Any]:
    """Return the parameters of every fourth lesson, from 0 to 3."""
    return LESSONS[number::_PARTS]


def expect_passes(course: Course, lesson: Lesson, check_server: ForkServer) -> None:
    """Run the tests of a lesson, and fail with the problems."""
    results = run_lesson_tests(course, lesson, check_server)
    problems = [f"{result.title}: {result.problem}" for result in results if result.problem]
    assert not problems, "\n".join(problems)  # pytest explains only assertions in test modules
