"""The shell: found programs, precedence of real ones, exit statuses and signals."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.shell import PROGRAMS, run_shell, shell_environment, write_programs

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the test uses POSIX commands")

BARE_PATH = "/usr/bin:/bin"


def write_script(folder: Path, name: str, text: str) -> Path:
    """Write an executable shell script."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / name
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


def run_in_shell(words: list[str], **variables: str) -> subprocess.CompletedProcess[str]:
    """Run ``linkwright shell -- WORDS`` as a user does."""
    environment = {"PATH": BARE_PATH, "HOME": os.environ.get("HOME", "/"), **variables}
    return subprocess.run(
        [sys.executable, "-m", "linkwright", "shell", "--", *words],
        capture_output=True,
        text=True,
        env=environment,
        timeout=60,
        check=False,
    )


def test_programs_are_found_in_shell() -> None:
    names = " ".join(PROGRAMS)
    result = run_in_shell(["sh", "-c", f"for name in {names}; do command -v $name || echo no $name; done"])
    assert len(result.stdout.splitlines()) == len(PROGRAMS)
    assert "no " not in result.stdout


def test_installed_program_takes_precedence(tmp_path: Path) -> None:
    write_script(tmp_path / "bin", "xacro", "echo the real one")
    result = run_in_shell(["xacro"], PATH=f"{tmp_path / 'bin'}:{BARE_PATH}")
    assert result.stdout == "the real one\n"


def test_python_is_linkwrights_without_installed_ros() -> None:
    result = run_in_shell(["python3", "-c", "import linkwright, sys; print(sys.prefix)"])
    assert result.stdout.strip() == sys.prefix


def test_path_keeps_order_with_installed_ros(tmp_path: Path) -> None:
    write_script(tmp_path / "opt", "ros2", "echo real ros2")
    folder = tmp_path / "programs"
    folder.mkdir()
    path = shell_environment(folder, {"PATH": f"{tmp_path / 'opt'}:{BARE_PATH}"})["PATH"].split(os.pathsep)
    assert path == [str(tmp_path / "opt"), *BARE_PATH.split(":"), str(folder)]


def test_nested_shell_does_not_extend_path_twice(tmp_path: Path) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    for folder in (first, second):
        folder.mkdir()
        write_programs(folder)
    outer_environment = shell_environment(first, {"PATH": BARE_PATH})
    inner_environment = shell_environment(second, outer_environment)
    assert str(first) not in inner_environment["PATH"].split(os.pathsep)
    assert inner_environment["PATH"].split(os.pathsep)[-1] == str(second)


def test_exit_status_is_that_of_command() -> None:
    assert run_in_shell(["sh", "-c", "exit 7"]).returncode == 7
    assert run_in_shell(["sh", "-c", "kill -TERM $$"]).returncode == 128 + signal.SIGTERM


def test_options_of_command_are_passed_on() -> None:
    assert run_in_shell(["sh", "-c", "echo $0 $1", "-h", "--help"]).stdout == "-h --help\n"


def test_unknown_command_is_reported_with_nearest_name() -> None:
    with pytest.raises(LinkwrightError) as caught:
        run_shell(["colcn"], {"PATH": BARE_PATH})
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "SHELL101"
    assert "colcon" in (diagnostic.hint or "")


def test_programs_of_rqt_are_commands() -> None:
    for name in ("rqt", "rqt_graph", "rqt_plot"):
        result = run_in_shell([name, "--help"])
        assert (result.returncode, result.stdout.splitlines()[0].split()[:2]) == (0, ["usage:", name])


def test_missing_ros_program_suggests_alternative() -> None:
    with pytest.raises(LinkwrightError) as caught:
        run_shell(["rqt_action"], {"PATH": BARE_PATH})
    (diagnostic,) = caught.value.diagnostics
    assert "ros2 action list" in (diagnostic.hint or "")


def type_in_bash(home: Path, lines: str) -> subprocess.CompletedProcess[str]:
    """Type lines in the interactive shell of a user with this home folder."""
    return subprocess.run(
        [sys.executable, "-m", "linkwright", "shell"],
        input=lines,
        capture_output=True,
        text=True,
        env={"PATH": BARE_PATH, "HOME": str(home), "SHELL": "/bin/bash"},
        timeout=60,
        check=False,
    )


def test_bashrc_that_sets_path_keeps_commands_available(tmp_path: Path) -> None:
    write_script(tmp_path / "opt", "ros2", "echo real ros2")
    (tmp_path / ".bashrc").write_text(f"export PATH={tmp_path / 'opt'}:{BARE_PATH}\nunset PYTHONPATH\n")
    result = type_in_bash(tmp_path, 'ros2; command -v check_urdf; echo "$PYTHONPATH"; exit 5\n')
    ros2, check_urdf, python_path = result.stdout.splitlines()
    assert ros2 == "real ros2"
    assert check_urdf.endswith("/check_urdf")
    assert "standins" in python_path
    assert result.returncode == 5


def test_bash_completes_commands_and_reports_missing_programs(tmp_path: Path) -> None:
    result = type_in_bash(tmp_path, "complete -p linkwright ros2; rosdep update; echo $?\n")
    assert [line.rpartition(" ")[2] for line in result.stdout.splitlines()] == ["linkwright", "ros2", "127"]
    assert "command 'rosdep' does not exist" in result.stderr


def test_installed_ros2_keeps_its_completion(tmp_path: Path) -> None:
    write_script(tmp_path / "opt", "ros2", "echo real ros2")
    (tmp_path / ".bashrc").write_text(f"export PATH={tmp_path / 'opt'}:{BARE_PATH}\n")
    assert "ros2" not in type_in_bash(tmp_path, "complete -p | grep linkwright\n").stdout


@pytest.mark.parametrize("start", ["", f"export PATH={BARE_PATH}\n", 'export PATH="$PATH:/opt/ros/bin"\n'])
def test_program_folders_are_on_path_once(tmp_path: Path, start: str) -> None:
    (tmp_path / ".bashrc").write_text(start)
    path, mark = type_in_bash(tmp_path, 'echo "$PATH"; echo "$LINKWRIGHT_SHELL"\n').stdout.splitlines()
    parts = path.split(os.pathsep)
    assert parts[0] == str(Path(sys.executable).parent)
    assert parts[-1] == mark
    assert len(set(parts)) == len(parts)


def start_in_shell(command: str, folder: Path) -> subprocess.Popen[str]:
    """Run a command of sh in Linkwright's shell.

    It runs in its own session, so that both can receive Ctrl-C.
    """
    return subprocess.Popen(
        [sys.executable, "-m", "linkwright", "shell", "--", "sh", "-c", command],
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
        cwd=folder,
    )


def test_sigterm_is_forwarded_and_program_folder_removed(tmp_path: Path) -> None:
    result = tmp_path / "told"
    command = f'trap "echo ended > {result}; exit 3" TERM; echo $LINKWRIGHT_SHELL; while :; do sleep 0.05; done'
    with start_in_shell(command, tmp_path) as process:
        assert process.stdout is not None
        folder = Path(process.stdout.readline().strip())
        assert (folder / "ros2").exists()
        process.terminate()
        assert process.wait(timeout=60) == 3
    assert result.read_text() == "ended\n"
    assert not folder.exists()


def test_ctrl_c_reaches_command(tmp_path: Path) -> None:
    command = 'trap "exit 4" INT; echo ready; while :; do sleep 0.05; done'
    with start_in_shell(command, tmp_path) as process:
        assert process.stdout is not None
        process.stdout.readline()
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(timeout=60) == 4


def test_sigint_to_shell_alone_reaches_command(tmp_path: Path) -> None:
    """The signal comes from ``kill -INT``, or from the parent of the shell.

    A signal to the group arrives only once.
    """
    command = "trap 'echo heard' INT; echo ready; while :; do sleep 0.05; done"
    with start_in_shell(command, tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "heard\n"
        os.killpg(process.pid, signal.SIGINT)
        assert process.stdout.readline() == "heard\n"
        process.terminate()
        assert process.wait(timeout=60) == 128 + signal.SIGTERM
        assert process.stdout.read() == ""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux signals a process when its parent was killed")
def test_command_ends_when_shell_is_killed(tmp_path: Path) -> None:
    with start_in_shell("echo ready; exec sleep 600", tmp_path) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.kill()
        assert process.stdout.read() == ""  # the pipe ends when all its writers have ended


def test_ctrl_c_at_end_of_command_keeps_its_status(monkeypatch: pytest.MonkeyPatch) -> None:
    wait = os.waitpid

    def interrupted(pid: int, options: int) -> tuple[int, int]:
        result = wait(pid, options)
        signal.raise_signal(signal.SIGINT)
        return result

    monkeypatch.setattr(os, "waitpid", interrupted)
    assert run_shell(["sh", "-c", "exit 4"]) == 4
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_ignored_signals_stay_ignored_in_command(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ignored signals are inherited, as with nohup."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        assert run_shell(["sh", "-c", "kill -HUP $$; exit 4"]) == 4
    finally:
        signal.signal(signal.SIGHUP, before)


def test_sigterm_during_command_start_is_forwarded(monkeypatch: pytest.MonkeyPatch) -> None:
    class Hurried(subprocess.Popen[bytes]):
        def __init__(self, *words: Any, **options: Any) -> None:
            super().__init__(*words, **options)
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(subprocess, "Popen", Hurried)
    assert run_shell(["sleep", "60"]) == 128 + signal.SIGTERM
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
