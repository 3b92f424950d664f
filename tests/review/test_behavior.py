"""Scenarios that run in both versions with the same seeds: noise, changes, bounds and errors."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from linkwright.review import open_versions
from linkwright.review.behavior import compare_behavior
from tests.review.conftest import sentences

SCENARIO = """import random
from linkwright.sweep import scenario


@scenario(speed=[1.0, 2.0], seeds=10)
def drive(speed, seed):
    if FAILS and seed > 7:
        raise RuntimeError("stuck")
    lap = 10.0 / speed + OFFSET + NOISE * random.random()
    return {"lap": lap, "arrived": seed < BOUND, "mode": MODE, "same": speed}
"""
VALUES = {"FAILS": "False", "OFFSET": "0.0", "NOISE": "0.0", "BOUND": "99", "MODE": "'a'"}


def text_with(**values: str) -> str:
    text = SCENARIO
    for name, value in {**VALUES, **values}.items():
        text = text.replace(name, value)
    return text


@pytest.fixture
def compared(package):
    def run(old: dict[str, str], new: dict[str, str], seeds: int | None = None):
        package.commit({"tests/drive.py": text_with(**old)})
        package.commit({"tests/drive.py": text_with(**new)})
        versions = open_versions(package.root, "HEAD~1..HEAD")
        try:
            return compare_behavior(versions, "tests/drive.py", seeds)
        finally:
            versions.close()

    return run


def test_equal_results_are_not_reported(compared):
    assert compared({}, {"MODE": "'a' + ''"}).is_empty


def test_difference_beyond_noise_is_reported(compared):
    found = compared({"NOISE": "0.1"}, {"NOISE": "0.1", "OFFSET": "0.5"})
    (sentence,) = sentences(found)
    assert sentence == "lap: mean 7.548 -> 8.048, difference 0.5 to 0.5"


def test_difference_within_noise_is_marked(compared):
    found = compared({"NOISE": "0.1"}, {"NOISE": "(random.random(), random.random(), 0.1)[2]"})
    (sentence,) = sentences(found)
    assert sentence.endswith(", within the noise")


def test_violated_bound_is_breaking(compared):
    (change,) = compared({}, {"BOUND": "8"}).changes
    assert str(change.sentence) == "arrived: true in 20 -> 16 of 20 runs"
    assert str(change.reason) == "it was true in all runs of the old version"
    (change,) = compared({"BOUND": "8"}, {"BOUND": "5"}).changes
    assert change.reason is None


def test_runs_that_fail_are_breaking(compared):
    found = compared({}, {"FAILS": "True"})
    assert str(found.changes[0].sentence) == "0 -> 4 of 20 runs failed"
    assert found.changes[0].reason is not None


def test_changed_texts_are_counted_over_seeds(compared):
    assert sentences(compared({}, {"MODE": "'b'"}, seeds=3)) == ["mode: 6 of 6 values differ"]


def test_scenario_that_cannot_run_is_a_problem(compared):
    (problem,) = compared({}, {"FAILS": "}"}).problems
    assert str(problem.text).startswith("the scenario cannot run in the new version: ")


def test_scenarios_run_only_on_request(package, tmp_path, monkeypatch, capsys):
    mark = tmp_path / "ran"
    package.commit({"tests/drive.py": text_with()})
    package.commit({"tests/drive.py": f"open({str(mark)!r}, 'w')\n" + text_with(BOUND="3")})
    monkeypatch.chdir(package.root)
    assert main(["review", "HEAD~1..HEAD"]) == 0
    assert not mark.exists()
    assert main(["review", "HEAD~1..HEAD", "--scenario", "tests/drive.py", "--fail-on", "breaking"]) == 1
    assert mark.exists()
    assert "arrived: true in 20 -> 6 of 20 runs" in capsys.readouterr().out
    assert main(["review", "--scenario", "tests/none.py"]) == 1
    assert "error[REV104]" in capsys.readouterr().err
