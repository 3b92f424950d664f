"""Scenarios that run in both versions with the same seeds.

The tests cover noise, changes, bounds and errors.
"""

from __future__ import annotations

import pytest

from linkwright.cli import main
from linkwright.review import Review, open_versions
from linkwright.review.behavior import compare_behavior
from linkwright.review.reports import as_data, as_html, as_markdown
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


def scenario_text(**values: str) -> str:
    text = SCENARIO
    for name, value in {**VALUES, **values}.items():
        text = text.replace(name, value)
    return text


@pytest.fixture
def compare_scenario(package):
    """Run the scenario of the last two commits."""

    def run(seeds: int | None = None):
        versions = open_versions(package.root, "HEAD~1..HEAD")
        try:
            return compare_behavior(versions, "tests/drive.py", seeds)
        finally:
            versions.close()

    return run


@pytest.fixture
def compare_default_scenario(package, compare_scenario):
    def run(old: dict[str, str], new: dict[str, str], seeds: int | None = None):
        package.commit({"tests/drive.py": scenario_text(**old)})
        package.commit({"tests/drive.py": scenario_text(**new)})
        return compare_scenario(seeds)

    return run


def test_equal_results_are_not_reported(compare_default_scenario):
    assert compare_default_scenario({}, {"MODE": "'a' + ''"}).is_empty


def test_difference_beyond_noise_is_reported(compare_default_scenario):
    comparison = compare_default_scenario({"NOISE": "0.1"}, {"NOISE": "0.1", "OFFSET": "0.5"})
    (sentence,) = sentences(comparison)
    assert sentence == "lap: mean 7.548 -> 8.048, difference 0.5 to 0.5"


def test_difference_within_noise_is_marked(compare_default_scenario):
    comparison = compare_default_scenario({"NOISE": "0.1"}, {"NOISE": "(random.random(), random.random(), 0.1)[2]"})
    (sentence,) = sentences(comparison)
    assert sentence.endswith(", within the noise")


def test_violated_bound_is_breaking(compare_default_scenario):
    (change,) = compare_default_scenario({}, {"BOUND": "8"}).changes
    assert str(change.sentence) == "arrived: true in 20 -> 16 of 20 runs"
    assert str(change.reason) == "it was true in all runs of the old version"
    (change,) = compare_default_scenario({"BOUND": "8"}, {"BOUND": "5"}).changes
    assert change.reason is None


def test_runs_that_fail_are_breaking(compare_default_scenario):
    comparison = compare_default_scenario({}, {"FAILS": "True"})
    assert str(comparison.changes[0].sentence) == "0 -> 4 of 20 runs failed"
    assert comparison.changes[0].reason is not None


def test_changed_texts_are_counted_over_seeds(compare_default_scenario):
    assert sentences(compare_default_scenario({}, {"MODE": "'b'"}, seeds=3)) == ["mode: 6 of 6 values differ"]


def test_scenario_that_cannot_run_is_a_problem(compare_default_scenario):
    (problem,) = compare_default_scenario({}, {"FAILS": "}"}).problems
    assert str(problem.text).startswith("the scenario cannot run in the new version: ")


PATH_SCENARIO = """from linkwright.sweep import Uniform, scenario


@scenario(speed=[1.0, 2.0], gain=Uniform(0.5, 1.0), seeds=3)
def drive(speed, gain, seed):
    track = [(0.1 * step, 0.1 * step * speed, OFFSET * step * speed * (1 + seed)) for step in range(41)]
    return {"track": track, "still": [(0.0, 0.0, 0.0), (1.0, gain, 0.0)]}
"""


def test_paths_are_compared_for_each_listed_parameter(package, compare_scenario):
    package.commit({"tests/drive.py": PATH_SCENARIO.replace("OFFSET", "0.0")})
    package.commit({"tests/drive.py": PATH_SCENARIO.replace("OFFSET", "0.01")})
    scenario_comparison = compare_scenario()
    assert sentences(scenario_comparison) == [
        "track, speed=2.0: paths up to 2.4 m apart (seed 2, after 4 s), median of 3 runs 1.6 m",
        "track, speed=1.0: paths up to 1.2 m apart (seed 2, after 4 s), median of 3 runs 0.8 m",
    ]
    assert [comparison.parameters for comparison in scenario_comparison.paths] == ["speed=2.0", "speed=1.0"]


def test_paths_are_in_all_reports_with_the_same_bytes_twice(package, compare_scenario):
    package.commit({"tests/drive.py": PATH_SCENARIO.replace("OFFSET", "0.0")})
    package.commit({"tests/drive.py": PATH_SCENARIO.replace("OFFSET", "0.01")})
    reviews = [Review("a", "b", [compare_scenario()]) for _ in range(2)]
    first, second = (as_html(review) for review in reviews)
    assert first == second
    assert first.count("<figure class='plot'>") == 2
    assert "paths up to 2.4 m apart" in as_markdown(reviews[0])
    (data, _) = as_data(reviews[0])["subjects"][0]["paths"]
    assert (data["name"], data["parameters"]) == ("track", "speed=2.0")
    assert [(run["seed"], run["distance"], run["time"]) for run in data["runs"]] == [
        ("0", 0.8, 4.0),
        ("1", 1.6, 4.0),
        ("2", 2.4, 4.0),
    ]
    assert data["runs"][0]["new"][-1] == [4.0, 8.0, 0.8]


def test_path_of_a_simulated_robot_is_recorded(package, compare_scenario):
    text = """from linkwright.sweep import scenario
from linkwright.testing import SteppedSimulation


@scenario()
def drive():
    with SteppedSimulation("empty", "package://my_robot_description/urdf/mbot_gazebo.xacro") as test:
        test.drive(0.5, TURN)
        test.advance(1.0)
        return {}
"""
    package.commit({"tests/drive.py": text.replace("TURN", "0.0")})
    package.commit({"tests/drive.py": text.replace("TURN", "0.8")})
    (sentence,) = sentences(compare_scenario())
    assert sentence.startswith("robot: paths up to 0.")
    assert sentence.endswith(" m apart (seed 0, after 1 s)")


def test_scenarios_run_only_on_request(package, tmp_path, monkeypatch, capsys):
    mark = tmp_path / "ran"
    package.commit({"tests/drive.py": scenario_text()})
    package.commit({"tests/drive.py": f"open({str(mark)!r}, 'w')\n" + scenario_text(BOUND="3")})
    monkeypatch.chdir(package.root)
    assert main(["review", "HEAD~1..HEAD"]) == 0
    assert not mark.exists()
    assert main(["review", "HEAD~1..HEAD", "--scenario", "tests/drive.py", "--fail-on", "breaking"]) == 1
    assert mark.exists()
    assert "arrived: true in 20 -> 6 of 20 runs" in capsys.readouterr().out
    assert main(["review", "--scenario", "tests/none.py"]) == 1
    assert "error[REV104]" in capsys.readouterr().err
