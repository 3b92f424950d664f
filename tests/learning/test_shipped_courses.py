"""Each lesson of the shipped courses passes its own tests, in both languages and with enough cases."""

import pytest

from linkwright.diagnostics.translation import LANGUAGES
from linkwright.learning.course import courses_folder, load_course
from linkwright.learning.lesson_tests import load_cases
from linkwright.learning.lesson_tests import test_lesson as run_lesson_tests

COURSES = [load_course(file.parent) for file in sorted((courses_folder() or ()).glob("*/course.toml"))]
LESSONS = [
    pytest.param(course, lesson, id=f"{course.id}-{lesson.id}") for course in COURSES for lesson in course.lessons
]


@pytest.mark.parametrize(("course", "lesson"), LESSONS)
def test_a_lesson_passes_its_tests(course, lesson):
    problems = [f"{result.title}: {result.problem}" for result in run_lesson_tests(course, lesson) if result.problem]
    assert not problems


@pytest.mark.parametrize(("course", "lesson"), LESSONS)
def test_a_lesson_is_in_all_languages_with_equal_code(course, lesson):
    assert set(lesson.texts) == set(LANGUAGES)
    blocks = [text.path.read_text(encoding="utf-8").split("```")[1::2] for text in lesson.texts.values()]
    assert blocks[0] == blocks[1]


@pytest.mark.parametrize(("course", "lesson"), [param for param in LESSONS if "robot" in param.id])
def test_a_lesson_has_right_and_wrong_solutions(course, lesson):
    cases = load_cases(lesson)
    assert sum(case.says is None for case in cases) >= 3
    assert sum(case.says is not None for case in cases) >= 5
    assert all(step.text("en").hints for step in lesson.steps)
