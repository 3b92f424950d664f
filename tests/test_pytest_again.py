"""The tests that CI runs again, and those that it does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.repository_tools import load_tool

FLAKY = """
from pathlib import Path

def test_a():
    pass

def test_b():
    runs = Path("runs")
    runs.write_text((runs.read_text() if runs.exists() else "") + "x")
    assert len(runs.read_text()) not in FAILING
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # pytest starts faster without plugins
    return tmp_path


def write(project: Path, text: str) -> None:
    (project / "test_it.py").write_text(text)


def run(*arguments: str) -> int:
    return int(load_tool("pytest_again").main(["-q", *arguments]))


def test_passing_test_runs_once(project, capfd):
    write(project, FLAKY.replace("FAILING", "()"))
    assert run() == 0
    assert (project / "runs").read_text() == "x"
    assert "UNSTEADY" not in capfd.readouterr().out


def test_flaky_test_is_rerun_three_times_and_named(project, capfd):
    write(project, FLAKY.replace("FAILING", "(1,)"))
    assert run() == 0
    assert (project / "runs").read_text() == "xxxx"
    output = capfd.readouterr().out
    assert "1 failed, 1 passed" in output
    assert output.rstrip().endswith("UNSTEADY: failed once, then passed 3 times over:\n  test_it.py::test_b")


@pytest.mark.parametrize("failing", ["(1, 2)", "(1, 4)", "range(9)"])
def test_run_fails_if_test_fails_twice(project, failing):
    write(project, FLAKY.replace("FAILING", failing))
    assert run() == 1


def test_many_failures_are_final(project):
    write(
        project,
        "import pytest\n@pytest.mark.parametrize('n', range(11))\n"
        "def test(n):\n    open('runs', 'a').write('x')\n    assert len(open('runs').read()) > 11\n",
    )
    assert run() == 1
    assert (project / "runs").read_text() == "x" * 11


def test_aborted_run_is_final(project):
    write(project, "import pytest\ndef test_a(): assert 0\ndef test_b(): pytest.exit('stop', 3)\n")
    assert run() == 3


def test_collection_error_is_final(project):
    write(project, "import nothing_like_it\n")
    assert run() != 0
