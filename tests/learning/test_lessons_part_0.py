"""Each lesson of this part passes its own tests."""

import pytest

from tests.learning.lesson_runs import expect_passes, lessons_of_part


@pytest.mark.timeout(3000)  # some lessons have fifty cases, each in a process
@pytest.mark.parametrize(("course", "lesson"), lessons_of_part(0))
def test_lesson_passes_its_tests(course, lesson, check_server):
    expect_passes(course, lesson, check_server)
