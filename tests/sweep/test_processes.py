"""Sweeps in separate processes, which can die and be interrupted."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.sweep.execution import run_once
from linkwright.sweep.plan import plan_runs
from linkwright.sweep.scenario import load_scenario
from linkwright.sweep.workers import run_locally
from tests.begun import command_that_reports
from tests.sweep.scenarios import HEAD, SQUARES, write_scenario
from tests.waiting import wait_until

DYING = f"""import os, signal
from pathlib import Path
{HEAD}
@scenario(n=[1, 2, 3, 4])
def work(n):
    if n == 2 and not Path("died").exists():
        Path("died").write_text("")
        os.kill(os.getpid(), signal.SIGKILL)
    if n == 4:
        os.kill(os.getpid(), signal.SIGKILL)
    return {{"square": n * n}}
"""
HELD = f"""import time
from pathlib import Path
{HEAD}
@scenario(n=[1, 2, 3])
def work(n):
    while n == 2 and not Path("go").exists():
        Path("held").write_text("")
        time.sleep(0.01)
    return {{"square": n * n}}
"""
SIMULATED = f"""from linkwright.testing import SteppedSimulation
{HEAD}
@scenario(noise=[1.0], friction=[0.3, 1.0], seeds=2)
def drive(noise, friction, seed):
    robot = "package://my_robot_description/urdf/mbot_gazebo.xacro"
    with SteppedSimulation("empty", robot, noise=noise, friction=friction, seed=seed) as test:
        imu = test.record("/imu")
        test.drive(0.5, 0.2)
        test.advance(0.2)
        return {{"x": test.robot_pose()[0], "a": imu.last.linear_acceleration.x}}
"""


def run_scenario(path: Path, workers: int) -> dict[int, object]:
    outcomes = {}
    run_locally(
        path, plan_runs(load_scenario(path)), workers, lambda outcome: outcomes.setdefault(outcome.row, outcome)
    )
    return outcomes


def test_results_are_identical_in_any_process_and_order(tmp_path):
    path = write_scenario(tmp_path, SIMULATED)
    scenario = load_scenario(path)
    results_by_row = {run.row: run_once(scenario, run) for run in reversed(plan_runs(scenario))}
    assert run_scenario(path, 2) == results_by_row
    assert all(not outcome.error for outcome in results_by_row.values())
    assert len({outcome.results["a"] for outcome in results_by_row.values()}) == 4


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_dead_worker_process_is_replaced_and_run_retried_once(tmp_path):
    path = write_scenario(tmp_path, DYING)
    outcomes = run_scenario(path, 2)
    assert [outcomes[row].results.get("square") for row in (1, 2, 3, 4)] == [1, 4, 9, None]
    assert outcomes[4].error == "the process of the run was ended by SIGKILL, twice"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot send SIGINT to one process")
def test_interrupted_sweep_keeps_rows_and_resumes(tmp_path):
    write_scenario(tmp_path, HELD)
    words = ["sweep", "squares.py", "--workers", "1"]
    process = subprocess.Popen(
        command_that_reports("linkwright", *words), cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE
    )
    try:
        wait_until((tmp_path / "held").exists)
        os.kill(process.pid, signal.SIGINT)
        printed, output = process.communicate()
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 130
    assert b"2 runs are left; `--resume` continues the sweep" in output
    assert b"Created file squares.csv" in printed
    assert (tmp_path / "squares.csv").read_text() == "row,n,seed,square,error\n1,1,0,1,\n"
    (tmp_path / "go").write_text("")
    second_run = subprocess.run(
        [sys.executable, "-m", "linkwright", *words, "--resume"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
    )
    assert second_run.returncode == 0
    assert (tmp_path / "squares.csv").read_text() == "row,n,seed,square,error\n1,1,0,1,\n2,2,0,4,\n3,3,0,9,\n"


def test_sweep_command_writes_table_and_summary(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_scenario(tmp_path, SQUARES)
    assert main(["sweep", "squares.py", "n:=4,5", "--seeds", "1", "--workers", "1", "--out", "a/b.csv"]) == 0
    printed = capsys.readouterr()
    assert printed.out == f"Created file {Path('a', 'b.csv')}\nCreated file {Path('a', 'b.html')}\n"
    assert "2 runs in " in printed.err
    assert (tmp_path / "a" / "b.csv").read_text().splitlines()[2].startswith("2,5,")
    assert "linkwright sweep squares.py n:=4,5 --seeds 1 --rerun" not in (tmp_path / "a" / "b.html").read_text()
    assert Path.cwd() == tmp_path


def test_failed_run_exits_with_status_1(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_scenario(tmp_path, f"{HEAD}@scenario(n=[0, 1])\ndef f(n): return {{'x': 1 / n}}\n")
    assert main(["sweep", "squares.py", "--workers", "1"]) == 1
    assert "1 failed" in capsys.readouterr().err
    assert "--rerun 1</td>" in (tmp_path / "squares.html").read_text()


def test_rerun_repeats_row_by_number(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = write_scenario(tmp_path, SQUARES)
    fourth = plan_runs(load_scenario(path))[3]
    assert main(["sweep", "squares.py", "--rerun", "4"]) == 0
    drawn = fourth.parameters["drawn"]
    expected = f"n: 2\ndrawn: {drawn}\nseed: 1\nsquare: 4\nbig: False\nsum: {3 + drawn}\n"
    assert capsys.readouterr().out == expected
    assert main(["sweep", "squares.py", "--rerun", "7"]) == 1
    assert "SWEEP112" in capsys.readouterr().err
    write_scenario(tmp_path, f"{HEAD}@scenario(n=[0])\ndef f(n):\n    return 1 / n\n")
    assert main(["sweep", "squares.py", "--rerun", "1"]) == 1
    assert f'{path}", line 4, in f' in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["none.py"], "SWEEP101"),
        (["squares.py", "m:=1"], "SWEEP106"),
        (["squares.py", "m=1"], "CLI101"),
        (["squares.py", "--out", "a.txt"], "SWEEP110"),
        (["squares.py", "--out", "squares.py/a.csv"], "SWEEP110"),
        (["squares.py", "--resume"], "SWEEP109"),
    ],
)
def test_invalid_input_is_one_error(tmp_path, monkeypatch, capsys, words, code):
    monkeypatch.chdir(tmp_path)
    write_scenario(tmp_path, SQUARES)
    assert main(["sweep", *words]) == 1
    output = capsys.readouterr().err
    assert output.count("error[") == 1
    assert f"error[{code}]" in output
    assert [path.name for path in tmp_path.iterdir() if path.name != "__pycache__"] == ["squares.py"]
