"""Scenarios, and their runs."""

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.sweep.execution import run_once
from linkwright.sweep.plan import compute_fingerprint, plan_runs, replace_values
from linkwright.sweep.scenario import load_scenario
from tests.sweep.scenarios import HEAD, SQUARES, load_scenario_text, write_scenario


def test_scenario_runs_each_value_with_each_seed(tmp_path):
    runs = plan_runs(load_scenario_text(tmp_path))
    assert [run.row for run in runs] == [1, 2, 3, 4, 5, 6]
    assert [(run.parameters["n"], run.seed) for run in runs] == [(1, 0), (1, 1), (2, 0), (2, 1), (3, 0), (3, 1)]
    assert list(runs[0].parameters) == ["n", "drawn"]


def test_drawn_values_depend_only_on_seed_and_name(tmp_path):
    scenario = load_scenario_text(tmp_path)
    drawn = {run.seed: run.parameters["drawn"] for run in plan_runs(scenario)}
    assert all(run.parameters["drawn"] == drawn[run.seed] for run in plan_runs(scenario))
    assert len(set(drawn.values())) == 2
    longer_plan = plan_runs(replace_values(scenario, {"n": "7"}, 50))
    assert {run.seed: run.parameters["drawn"] for run in longer_plan}.items() >= drawn.items()
    assert all(0.0 <= run.parameters["drawn"] < 1.0 for run in longer_plan)


def test_command_line_values_are_parsed_as_yaml(tmp_path):
    text = f"{HEAD}\n@scenario(world=['empty'], laser=[True], mass=Normal(1.0, 0.1))\ndef f(world, laser, mass): ...\n"
    scenario = replace_values(
        load_scenario_text(tmp_path, text), {"world": "maze,house", "laser": "true,false", "mass": "1.5"}, None
    )
    assert {name: list(values) for name, values in scenario.parameters.items()} == {
        "world": ["maze", "house"],
        "laser": [True, False],
        "mass": [1.5],
    }


def test_run_outcome_contains_function_results(tmp_path):
    scenario = load_scenario_text(tmp_path)
    last = plan_runs(scenario)[-1]
    outcome = run_once(scenario, last)
    assert (outcome.row, outcome.error) == (6, "")
    assert outcome.results == {"square": 9, "big": True, "sum": 4 + last.parameters["drawn"]}
    assert run_once(scenario, last) == outcome


def test_python_and_numpy_random_generators_use_seed(tmp_path):
    text = f"""import random
import numpy
{HEAD}
@scenario(seeds=2)
def draw():
    return {{"python": random.random(), "numpy": numpy.random.rand(), "array": numpy.float64(0.5)}}
"""
    scenario = load_scenario_text(tmp_path, text)
    first, second = (run_once(scenario, run).results for run in plan_runs(scenario))
    assert first == run_once(scenario, plan_runs(scenario)[0]).results
    assert first["python"] != second["python"]
    assert first["numpy"] != second["numpy"]
    assert type(first["array"]) is float


@pytest.mark.parametrize(
    ("body", "error"),
    [
        ("1 / 0", "ZeroDivisionError: division by zero (squares.py:5)"),
        ("raise SystemExit(3)", "SystemExit: 3 (squares.py:5)"),
        ("return 3", "BadResultError: the scenario must return a dict, not int"),
        (
            "return {'x': [1]}",
            "BadResultError: result 'x' must be a number, text, True, False or a path of (time, x, y), not list",
        ),
        ("return {'n': 1}", "BadResultError: a result cannot be named 'n': use text that is not a column's name"),
        ("from linkwright.descriptions import load; load('<robot')", "XML203 <robot_description>:1:1"),
    ],
)
def test_run_failure_is_recorded_as_outcome(tmp_path, body, error):
    scenario = load_scenario_text(tmp_path, f"{HEAD}\n@scenario(n=[1])\ndef f(n):\n    {body}\n")
    outcome = run_once(scenario, plan_runs(scenario)[0])
    assert outcome.error.startswith(error)
    assert outcome.results == {}


INVALID_SCENARIOS = {
    "SWEEP102 squares.py:1:5 the file is not valid Python: invalid syntax": "def :\n",
    "SWEEP102 squares.py:2:1 the scenario cannot be loaded: ZeroDivisionError: division by zero": "\n1 / 0\n",
    "SWEEP102 squares.py:1:1 the scenario cannot be loaded: ModuleNotFoundError: No module named 'nothing_of_this'": (
        "import nothing_of_this\n"
    ),
    "SWEEP103  no function in 'squares.py' is a scenario": HEAD,
    "SWEEP103 squares.py:7:1 'squares.py' contains 2 scenarios, but must contain one": (
        f"{SQUARES}\n@scenario()\ndef other(): ...\n"
    ),
    "SWEEP104 squares.py:2:1 the function 'f' does not accept 'm'": f"{HEAD}@scenario(m=[1])\ndef f(): ...\n",
    "SWEEP104 squares.py:2:1 the function 'f' needs 'm', which @scenario does not set": (
        f"{HEAD}@scenario()\ndef f(m, k=1, seed=0): ...\n"
    ),
    "SWEEP104 squares.py:2:1 a parameter cannot be named 'row': the table already has this column": (
        f"{HEAD}@scenario(row=[1])\ndef f(row): ...\n"
    ),
    "SWEEP105 squares.py:2:1 parameter 'm' has no values": f"{HEAD}@scenario(m=[])\ndef f(m): ...\n",
    "SWEEP105 squares.py:2:1 the values of parameter 'm' must be a list, a Uniform or a Normal": (
        f"{HEAD}@scenario(m='maze')\ndef f(m): ...\n"
    ),
    "SWEEP105 squares.py:2:1 a value of parameter 'm' must be a number, text, True or False, not dict": (
        f"{HEAD}@scenario(m=[{{}}])\ndef f(m): ...\n"
    ),
    "SWEEP105 squares.py:2:1 the distribution of parameter 'm' must have finite numbers": (
        f"{HEAD}@scenario(m=Uniform(0, float('inf')))\ndef f(m): ...\n"
    ),
    "SWEEP105 squares.py:2:1 the seeds must be a positive number of seeds, or a list of integers of at least 0": (
        f"{HEAD}@scenario(seeds=0)\ndef f(): ...\n"
    ),
}


@pytest.mark.parametrize(("message", "text"), INVALID_SCENARIOS.items(), ids=range(len(INVALID_SCENARIOS)))
def test_invalid_scenario_is_one_error(tmp_path, monkeypatch, message, text):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LinkwrightError) as raised:
        load_scenario_text(tmp_path, text)
    (diagnostic,) = raised.value.diagnostics
    assert f"{diagnostic.code} {diagnostic.span or ''} {diagnostic.message}" == message


@pytest.mark.parametrize("name", ["none.py", "drive.yaml", "."])
def test_scenario_must_be_a_python_file(tmp_path, name):
    (tmp_path / "drive.yaml").write_text("a: 1")
    with pytest.raises(LinkwrightError) as raised:
        load_scenario(tmp_path / name)
    assert raised.value.diagnostics[0].code == "SWEEP101"


@pytest.mark.parametrize(
    ("words", "code"), [({"m": "1"}, "SWEEP106"), ({"n": ""}, "SWEEP105"), ({"n": "]"}, "SWEEP105")]
)
def test_invalid_command_line_values_are_rejected(tmp_path, words, code):
    with pytest.raises(LinkwrightError) as raised:
        replace_values(load_scenario_text(tmp_path), words, None)
    assert raised.value.diagnostics[0].code == code


def test_fingerprint_depends_on_file_and_values(tmp_path):
    scenario = load_scenario_text(tmp_path)
    fingerprint_of_plan = compute_fingerprint(scenario, plan_runs(scenario))
    assert fingerprint_of_plan == compute_fingerprint(scenario, plan_runs(scenario))
    assert fingerprint_of_plan != compute_fingerprint(scenario, plan_runs(replace_values(scenario, {}, 1)))
    write_scenario(tmp_path, f"{SQUARES}\n# changed\n")
    assert fingerprint_of_plan != compute_fingerprint(scenario, plan_runs(scenario))
