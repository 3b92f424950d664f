"""``linkwright run``."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.cli.exit_status import FINDINGS, USAGE
from tests.waiting import TIMEOUT_S

COMMAND = [sys.executable, "-c", "import sys; from linkwright.cli import main; sys.exit(main())", "run"]
NODE = """
import signal
import sys
import time


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(9))
    try:
        print(sys.argv[1:], flush=True)
        time.sleep(30 if "wait" in sys.argv else 0)
    except KeyboardInterrupt:
        return 4
    return 6
"""

Run = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder: a workspace with the package ``arm``, which is not built."""
    package = tmp_path / "src" / "arm"
    (package / "arm").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm</name></package>")
    (package / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='arm', packages=['arm'], entry_points={'console_scripts': ['wave = arm.wave:main']})\n"
    )
    (package / "arm" / "__init__.py").write_text("")
    (package / "arm" / "wave.py").write_text(NODE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "logs"))
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    return tmp_path


@pytest.fixture
def run_node() -> Iterator[Run]:
    running: list[subprocess.Popen[str]] = []

    def begin(*words: str) -> subprocess.Popen[str]:
        running.append(subprocess.Popen([*COMMAND, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
        return running[-1]

    yield begin
    for process in running:
        process.kill()
        process.communicate()


def test_entry_point_receives_arguments_and_returns_exit_status(run_node: Run) -> None:
    process = run_node("arm", "wave", "--fast", "-h", "--ros-args", "-r", "a:=b")
    out, err = process.communicate(timeout=60)
    assert out == "['--fast', '-h', '--ros-args', '-r', 'a:=b']\n", err
    assert process.returncode == 6


def test_package_whose_name_is_not_an_identifier_has_entry_points(run_node: Run, workspace: Path) -> None:
    package = workspace / "src" / "3d_arm"
    (package / "3d_arm").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>3d_arm</name></package>")
    (package / "setup.py").write_text(
        "from setuptools import setup\n"
        "setup(name='3d_arm', packages=['3d_arm'], entry_points={'console_scripts': ['wave = 3d_arm.wave:main']})\n"
    )
    (package / "3d_arm" / "__init__.py").write_text("")
    (package / "3d_arm" / "wave.py").write_text(NODE)
    process = run_node("3d_arm", "wave", "a")
    out, err = process.communicate(timeout=60)
    assert (out, process.returncode) == ("['a']\n", 6), err


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 4), (signal.SIGTERM, 9)])
def test_executable_receives_signals(run_node: Run, number: int, status: int) -> None:
    process = run_node("arm", "wave", "wait")
    assert process.stdout is not None
    assert process.stdout.readline() == "['wait']\n"
    process.send_signal(number)
    assert process.wait(60) == status


def test_prefix_precedes_executable(run_node: Run, workspace: Path) -> None:
    process = run_node("--prefix", "echo 'a b'", "arm", "wave", "c")
    out, _ = process.communicate(timeout=60)
    assert out.startswith(f"a b {workspace}")
    assert out.endswith("/lib/arm/wave c\n")


def test_run_starts_built_in_node(run_node: Run) -> None:
    process = run_node("demo_nodes_py", "talker_qos", "-n", "1", "--ros-args", "-r", "__node:=tk", "-r", "__ns:=/x")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 0
    assert '] [x.tk]: Publishing: "Hello World: 0"' in err


def test_built_in_node_ends_on_sigint(run_node: Run) -> None:
    process = run_node("demo_nodes_cpp", "talker")
    assert process.stderr is not None
    assert "Publishing" in process.stderr.readline()
    process.send_signal(signal.SIGINT)
    assert process.wait(TIMEOUT_S) == 0


def test_run_opens_panel_of_rqt_program(run_node: Run) -> None:
    process = run_node("--no-open", "rqt_graph", "rqt_graph", "--fast", "--ros-args", "-r", "__ns:=/x")
    assert process.stdout is not None
    assert process.stdout.readline().startswith("Viewer: http://127.0.0.1:")
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "rqt_graph has no argument '--fast'" in err


def test_missing_program_of_rqt_names_replacement(run_node: Run) -> None:
    process = run_node("rqt_action", "rqt_action")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "the page has no panel that replaces 'rqt_action'; run `ros2 action list -t`" in err


def test_run_starts_viewer(run_node: Run) -> None:
    process = run_node("--no-open", "rviz2", "rviz2")
    assert process.stdout is not None
    assert process.stdout.readline().startswith("Viewer: http://127.0.0.1:")
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130


@pytest.mark.parametrize(
    ("words", "message", "hint"),
    [
        (["arm", "wav"], "package 'arm' has no executable 'wav'", "did you mean 'wave'?"),
        (["amr", "wave"], "package 'amr' of node executable 'wave' was not found", "did you mean 'arm'?"),
        (["tf2_ros", "tf2_ecko"], "package 'tf2_ros' has no executable 'tf2_ecko'", "did you mean 'tf2_echo'"),
    ],
)
def test_unknown_packages_and_executables_are_reported(
    capsys: pytest.CaptureFixture[str], words: list[str], message: str, hint: str
) -> None:
    assert main(["run", *words]) == FINDINGS
    err = capsys.readouterr().err
    assert message in err
    assert hint in err


def test_missing_prefix_program_is_reported(run_node: Run) -> None:
    process = run_node("--prefix", "no-such-program", "arm", "wave")
    _, err = process.communicate(timeout=60)
    assert process.returncode == FINDINGS
    assert "error[CLI110]: 'no-such-program' cannot be run: No such file or directory" in err


def test_missing_arguments_are_usage_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "arm"]) == USAGE
    assert "usage: linkwright run [options] PACKAGE EXECUTABLE [ARGUMENT ...]" in capsys.readouterr().err


def test_killed_run_returns_signal(run_node: Run) -> None:
    process = run_node("arm", "wave", "wait")
    assert process.stdout is not None
    process.stdout.readline()
    os.kill(process.pid, signal.SIGKILL)
    assert process.wait(60) == -signal.SIGKILL
