"""The solutions of the exercises of this part score as they should, and results repeat."""

import pytest

from tests.learning.exercise_runs import ScoreTests, exercises_of_part

pytestmark = [pytest.mark.extra("sim"), pytest.mark.slow]


@pytest.mark.parametrize("name", exercises_of_part(1))
class TestScores(ScoreTests):
    pass
