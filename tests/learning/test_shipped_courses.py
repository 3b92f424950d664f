"""Each lesson of the shipped courses has equal code in all languages, and enough cases."""

import pytest

from linkwright.diagnostics.translation import LANGUAGES
from linkwright.learning.lesson_tests import load_cases
from tests.learning.lesson_runs import LESSONS


@pytest.mark.parametrize(("course", "lesson"), LESSONS)
def test_lesson_has_all_languages_with_equal_code(course, lesson):
    assert set(lesson.texts) == set(LANGUAGES)
    blocks = [text.path.read_text(encoding="utf-8").split("```")[1::2] for text in lesson.texts.values()]
    assert blocks[0] == blocks[1]


@pytest.mark.parametrize(("course", "lesson"), [param for param in LESSONS if "robot" in param.id])
def test_lesson_has_right_and_wrong_solutions(course, lesson):
    cases = load_cases(lesson)
    assert sum(case.says is None for case in cases) >= 3
    assert sum(case.says is not None for case in cases) >= 5
    assert all(step.text("en").hints for step in lesson.steps)
