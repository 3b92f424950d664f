"""Forked programs behave as separate processes do."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import pytest

from linkwright.process import fork_server, forked
from tests.forked import ForkServer, Program, start_process
from tests.places import PACKAGE
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.skipif(not forked.IS_POSSIBLE, reason="programs are forked on Linux only")

ROBOT = PACKAGE / "urdf" / "mbot_base.xacro"
QUIET = {**os.environ, "LINKWRIGHT_DDS": "0", "NO_COLOR": "1"}


@pytest.fixture(params=["forked", "fresh"])
def start(request, fork_server):
    return fork_server.start if request.param == "forked" else start_process


def ended(program: Program) -> tuple[str, int]:
    with program.stdout:
        return program.stdout.read(), program.wait(TIMEOUT_S)


def test_forked_program_returns_output_and_status(start, tmp_path):
    printed, status = ended(start(["xacro", str(ROBOT)], cwd=tmp_path, env=QUIET))
    assert printed.rstrip().endswith("</robot>")
    assert status == 0
    printed, status = ended(start(["check", "absent.urdf"], cwd=tmp_path, env=QUIET))
    assert "absent.urdf" in printed
    assert status == 1
    printed, status = ended(start(["vew"], cwd=tmp_path, env=QUIET))
    assert "did you mean" in printed
    assert status == 2


def test_forked_program_has_own_folder_environment_and_input(start, tmp_path):
    launch = tmp_path / "told.launch.py"
    launch.write_text(
        "import os, sys\n"
        "print('folder', os.getcwd(), 'first', sys.path[0], 'word', os.environ.get('A_WORD'), 'argv', sys.argv[1:])\n"
        "print('home', os.environ.get('HOME'), 'input', repr(sys.stdin.read()))\n"
        "from launch import LaunchDescription\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription()\n"
    )
    words = ["launch", "told.launch.py", "--no-open"]
    env = {**QUIET, "A_WORD": "here"}
    del env["HOME"]
    printed, status = ended(start(words, cwd=tmp_path, env=env))
    assert status == 0, printed
    assert f"folder {tmp_path} first {tmp_path} word here argv {words}" in printed
    assert "home None input ''" in printed


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -signal.SIGKILL)]
)
def test_signals_end_forked_program(start, tmp_path, number, status):
    program = start(["view", str(ROBOT), "--no-open"], cwd=tmp_path, env={**QUIET, "PYTHONUNBUFFERED": "1"})
    with program.stdout:
        assert any(line.startswith("Viewer: ") for line in program.stdout)
        assert program.poll() is None
        with pytest.raises(subprocess.TimeoutExpired):
            program.wait(0.01)
        program.send_signal(number)
        program.stdout.read()
        assert program.wait(TIMEOUT_S) == status
        assert program.poll() == status
        program.send_signal(number)  # no effect on an ended program


def test_forked_programs_run_in_parallel(fork_server, tmp_path):
    first, second = (fork_server.start(["view", str(ROBOT), "--no-open"], cwd=tmp_path, env=QUIET) for _ in range(2))
    forgotten = fork_server.start(["--version"], cwd=tmp_path, env=QUIET)
    printed_of_forgotten = forgotten.stdout
    del forgotten
    with first.stdout, second.stdout, printed_of_forgotten:
        printed_of_forgotten.read()
        second.terminate()
        second.wait(TIMEOUT_S)
        assert first.poll() is None
        assert ended(fork_server.start(["--version"], cwd=tmp_path, env=QUIET))[1] == 0
        first.kill()
        assert first.wait(TIMEOUT_S) == -signal.SIGKILL


def test_programs_start_as_processes_if_fork_server_fails(tmp_path, monkeypatch):
    monkeypatch.setattr(forked, "_MODULE", "no_such_module")
    server = ForkServer()
    program = server.start(["--version"], cwd=tmp_path, env=QUIET)
    assert isinstance(program.process, subprocess.Popen)
    assert ended(program)[1] == 0
    server.close()


def test_fork_server_is_ready_after_imports():
    server = forked.ForkServer(["linkwright.process.nanoseconds"])
    assert not server.is_ready
    server.prepare()
    wait_until(lambda: server.is_ready)
    server.close()
    assert not server.is_ready


def test_fork_server_calls_functions_and_skips_failures(monkeypatch):
    calls = []
    module = SimpleNamespace(fail=lambda: 1 / 0, call=lambda: calls.append("call"))
    monkeypatch.setitem(sys.modules, "preparing_module", module)
    fork_server._call_all(["preparing_module:fail", "preparing_module:absent", "preparing_module:call"])
    assert calls == ["call"]


def test_killed_fork_server_is_replaced(tmp_path):
    server = ForkServer()
    program = server.start(["view", str(ROBOT), "--no-open"], cwd=tmp_path, env={**QUIET, "PYTHONUNBUFFERED": "1"})
    with program.stdout:
        assert any(line.startswith("Viewer: ") for line in program.stdout)
        server._server._process.kill()
        server._server._process.wait()
        assert program.wait(TIMEOUT_S) == -signal.SIGKILL  # its status is unknown without the server
        os.kill(program.pid, signal.SIGTERM)
    second_run = server.start(["--version"], cwd=tmp_path, env=QUIET)
    assert isinstance(second_run.process, forked.ForkedProcess)
    assert ended(second_run)[1] == 0
    server.close()


def test_forked_programs_survive_end_of_server(tmp_path):
    server = ForkServer()
    program = server.start(["view", str(ROBOT), "--no-open"], cwd=tmp_path, env={**QUIET, "PYTHONUNBUFFERED": "1"})
    with program.stdout:
        assert any(line.startswith("Viewer: ") for line in program.stdout)
        server.close()
        os.kill(program.pid, 0)
        os.kill(program.pid, signal.SIGTERM)
        wait_until(lambda: program.stdout.read() == "")
