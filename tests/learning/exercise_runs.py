"""The scores of the exercises' solutions, tested in parts, because a file of tests runs in one process."""

from __future__ import annotations

from functools import cache
from statistics import mean

from linkwright.learning.judging.exercise import find_exercise, list_exercise_names
from linkwright.learning.judging.runs import RunResult, judge_program

_SEEDS = (0, 1, 2)
_PARTS = 4


def exercises_of_part(number: int) -> list[str]:
    """Return the names of every fourth exercise in the order of names, from 0 to 3."""
    return sorted(list_exercise_names())[number::_PARTS]


@cache
def _run_reference(name: str, seed: int) -> RunResult:
    """Return the result of the reference solution, which several tests use."""
    exercise = find_exercise(name)
    return next(judge_program(exercise, exercise.solution("reference"), [seed]))


class ScoreTests:
    """The solutions of an exercise score as they should, and results repeat.

    A class of each part has this base, with the names of its exercises as parameters.
    """

    def test_reference_solution_scores_over_90_with_every_seed(self, name: str) -> None:
        results = [_run_reference(name, seed) for seed in _SEEDS]
        assert [result.error for result in results] == [None] * len(_SEEDS)
        assert min(result.score for result in results) > 90.0, [result.data for result in results]

    def test_simple_solution_scores_about_half(self, name: str) -> None:
        exercise = find_exercise(name)
        results = list(judge_program(exercise, exercise.solution("simple"), _SEEDS))
        assert [result.error for result in results] == [None] * len(_SEEDS)
        assert 30.0 < mean(result.score for result in results) < 70.0, [result.data for result in results]

    def test_template_runs_and_scores_below_10(self, name: str) -> None:
        exercise = find_exercise(name)
        (result,) = judge_program(exercise, exercise.template, [0])
        assert result.error is None, result.error
        assert result.score < 10.0, result.data

    def test_two_runs_are_bit_identical(self, name: str) -> None:
        exercise = find_exercise(name)
        first, second = _run_reference(name, 2), next(judge_program(exercise, exercise.solution("reference"), [2]))
        assert first is not second
        assert first == second, (first, second)
