"""Processes that a launch starts: output, exits, environment and signals."""

from __future__ import annotations

import os
import re
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from launch.actions import (
    EmitEvent,
    ExecuteProcess,
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.event_handlers import OnExecutionComplete, OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch.events import matches_action
from launch.events.process import ShutdownProcess, SignalProcess, matches_name
from launch.substitutions import LaunchConfiguration

from launch import LaunchContext, LaunchDescription

STUBBORN = """
import os, signal, time
signal.signal(signal.SIGINT, lambda *_: os.write(1, b'int\\n'))
signal.signal(signal.SIGTERM, lambda *_: os.write(1, b'term\\n'))
os.write(1, b'ready\\n')
time.sleep(60)
time.sleep(60)
time.sleep(60)
"""


def execute_python(program: str, **options: object) -> ExecuteProcess:
    options.setdefault("output", "screen")
    options.setdefault("name", "py")
    return ExecuteProcess(cmd=[sys.executable, "-c", program], **options)


def is_gone(pid: int) -> bool:
    deadline = time.monotonic() + 30.0
    while time.monotonic() < deadline:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        if "Z" in Path(f"/proc/{pid}/stat").read_text().split(")")[-1].split()[0]:
            return True
        time.sleep(0.01)
    return False


async def test_process_output_and_exit_are_logged(launch) -> None:
    result = await launch(
        execute_python("import sys; print('out'); print('err', file=sys.stderr); sys.stdout.write('rest')")
    )
    assert result.out.splitlines() == ["[py-1] out", "[py-1] rest"]
    assert "[INFO] [py-1]: process started with pid [" in result.err
    assert "[py-1] err" in result.err
    assert "[INFO] [py-1]: process has finished cleanly [pid " in result.err
    assert result.succeeded


async def test_process_names_are_numbered_in_order(launch) -> None:
    result = await launch(
        ExecuteProcess(cmd=["sh", "-c", "echo a"], output="screen"),
        ExecuteProcess(cmd=["sh", "-c", "sleep 0.1; echo b"], output="screen"),
    )
    assert result.out.splitlines() == ["[sh-1] a", "[sh-2] b"]


async def test_cwd_env_and_substitutions_are_applied(launch, tmp_path: Path) -> None:
    result = await launch(
        SetLaunchConfiguration("w", "x y"),
        ExecuteProcess(
            cmd=["sh", "-c", ["echo $PWD $A $B '", LaunchConfiguration("w"), "'"]],
            cwd=str(tmp_path),
            env={"A": "1"},
            additional_env={"B": LaunchConfiguration("w")},
            output="screen",
        ),
    )
    assert result.out == f"[sh-1] {tmp_path} 1 x y x y\n"


async def test_shell_command_is_run(launch) -> None:
    result = await launch(ExecuteProcess(cmd=[["echo ", "a", " && echo b"]], shell=True, output="screen"))
    assert result.out.splitlines() == ["[echo-1] a", "[echo-1] b"]


async def test_split_arguments_divides_substituted_words(launch) -> None:
    program = "import sys; print(sys.argv[1:])"
    words = ExecuteProcess(
        cmd=[sys.executable, "-c", repr(program), LaunchConfiguration("words")],
        name="py",
        output="screen",
        split_arguments=True,
    )
    result = await launch(SetLaunchConfiguration("words", "--name 'a b'"), words)
    assert result.out == "[py-1] ['--name', 'a b']\n"


async def test_prefix_and_log_cmd_are_applied(launch) -> None:
    result = await launch(ExecuteProcess(cmd=["x"], prefix="echo 'a b'", output="screen", name="n", log_cmd=True))
    assert result.out == "[n-1] a b x\n"
    assert "process details: cmd='echo a b x'" in result.err


async def test_emulate_tty_provides_pseudo_terminal(launch) -> None:
    program = "import sys; print(sys.stdout.isatty(), sys.stderr.isatty())"
    assert (await launch(execute_python(program, emulate_tty=True))).out == "[py-1] True True\n"
    assert (await launch(execute_python(program))).out == "[py-1] False False\n"


def read_process_logs(folder: Path) -> dict[str, list[str]]:
    """Return the output of processes in the log files of the only launch, without times."""
    (launch,) = [path for path in folder.iterdir() if not path.is_symlink()]
    lines_by_file = {path.name: sorted(path.read_text().splitlines()) for path in launch.iterdir()}
    of_processes = [line.partition(" ")[2] for line in lines_by_file.pop("launch.log")]
    of_processes = sorted(line for line in of_processes if line.startswith("[py-1]"))
    return {**lines_by_file, "launch.log": of_processes} if of_processes else lines_by_file


OWN_LOGS = {
    "py-1-stderr.log": ["[py-1] err"],
    "py-1-stdout.log": ["[py-1] out"],
    "py-1.log": ["[py-1] err", "[py-1] out"],
}


class TestOutput:
    PROGRAM = "import sys; print('out'); print('err', file=sys.stderr)"

    @pytest.mark.parametrize(
        ("mode", "out", "err", "files"),
        [
            ("screen", True, True, {}),
            ("log", False, True, {"launch.log": ["[py-1] err", "[py-1] out"]}),
            ("both", True, True, {"launch.log": ["[py-1] err", "[py-1] out"]}),
            ("own_log", False, False, OWN_LOGS),
            ("full", True, True, {**OWN_LOGS, "launch.log": ["[py-1] err", "[py-1] out"]}),
            ({"both": "own_log"}, False, False, {"py-1.log": ["[py-1] err", "[py-1] out"]}),
            ({"stdout": "screen", "stderr": {"log"}}, True, False, {"launch.log": ["[py-1] err"]}),
            ({"both": {"screen"}}, True, True, {}),
        ],
    )
    async def test_output_mode_selects_screen_and_log_files(
        self, launch, tmp_path: Path, mode: object, out: bool, err: bool, files: dict
    ) -> None:
        result = await launch(execute_python(self.PROGRAM, output=mode))
        assert ("[py-1] out" in result.out) is out
        assert ("[py-1] err" in result.err) is err
        assert read_process_logs(tmp_path / "ros_log") == files

    async def test_launch_log_contains_all_launcher_lines(self, launch, tmp_path: Path) -> None:
        result = await launch(execute_python("0"))
        folder = (tmp_path / "ros_log" / "latest").resolve()
        assert result.err.splitlines()[:2] == [
            f"[INFO] [launch]: All log files can be found below {folder}",
            "[INFO] [launch]: Default logging verbosity is set to INFO",
        ]
        assert folder.name.endswith(f"-{os.getpid()}")
        lines = (folder / "launch.log").read_text().splitlines()
        assert [re.sub(r"^\d{10}\.\d{7} ", "", line) for line in lines] == result.err.splitlines()

    async def test_log_formats_are_read_from_environment(
        self, launch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("OVERRIDE_LAUNCH_SCREEN_FORMAT", "{name}|{levelname}|{msg}")
        monkeypatch.setenv("OVERRIDE_LAUNCH_LOG_FORMAT", "{msg}")
        result = await launch(LogInfo(msg="hello"))
        assert "launch.user|INFO|hello" in result.err.splitlines()
        assert "hello" in (tmp_path / "ros_log" / "latest" / "launch.log").read_text().splitlines()

    async def test_unwritable_log_folder_is_reported_once(self, launch, tmp_path: Path, monkeypatch) -> None:
        (tmp_path / "file").write_text("")
        monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "file" / "logs"))
        result = await launch(execute_python("print('out')", output="both"))
        assert result.err.count("warning[LAUNCH145]") == 1
        assert "log files can be found" not in result.err
        assert result.out == "[py-1] out\n"
        assert result.succeeded

    async def test_process_output_override_is_read_from_environment(self, launch, monkeypatch) -> None:
        monkeypatch.setenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", "both")
        assert "[py-1] out" in (await launch(execute_python(self.PROGRAM, output="own_log"))).out

    async def test_unknown_output_mode_is_rejected(self, launch) -> None:
        result = await launch(execute_python("0", output="scren"))
        assert "error[LAUNCH141]: output destination 'scren' does not exist" in result.err
        assert "did you mean 'screen'?" in result.err

    async def test_output_format_and_cached_output_are_applied(self, launch) -> None:
        action = execute_python(
            self.PROGRAM, output_format="<{this.process_description.final_name}> {line}", cached_output=True
        )
        assert (await launch(action)).out == "<py-1> out\n"
        assert action.get_stdout() == "out\n"
        assert action.get_stderr() == "err\n"
        assert action.return_code == 0


def test_process_description_is_available_before_start() -> None:
    context = LaunchContext()
    context.launch_configurations["word"] = "b"
    action = ExecuteProcess(cmd=["echo", ["a", LaunchConfiguration("word")]], cwd="/", env={"A": "1"}, name="py")
    action.prepare(context)
    description = action.process_description
    assert description.final_name.startswith("py-")
    assert (description.final_cmd, description.final_cwd, description.final_env) == (["echo", "ab"], "/", {"A": "1"})


class TestFailures:
    async def test_exit_status_is_logged(self, launch) -> None:
        result = await launch(execute_python("raise SystemExit(3)"))
        assert "[ERROR] [py-1]: process has died [pid " in result.err
        assert "exit code 3, cmd '" in result.err
        assert result.succeeded  # as with ros2 launch

    async def test_missing_program_is_reported(self, launch) -> None:
        result = await launch(ExecuteProcess(cmd=["no-such-program --flag"]), LogInfo(msg="others go on"))
        assert "error[LAUNCH142]: process 'no-such-program --flag-1' cannot be started" in result.err
        assert "test_processes.py" in result.err
        assert "separate items of cmd" in result.err
        assert result.messages == ["others go on"]
        assert not result.succeeded

    async def test_missing_terminal_emulator_is_reported(self, launch, monkeypatch) -> None:
        monkeypatch.setenv("PATH", "/no/such/folder")
        result = await launch(execute_python("0", prefix="xterm -e"), LogInfo(msg="others go on"))
        assert "program 'xterm' does not exist" in result.err
        assert "install 'xterm'" in result.err
        assert "linkwright run" in result.err
        assert result.messages == ["others go on"]

    async def test_missing_working_directory_is_reported(self, launch) -> None:
        result = await launch(execute_python("0", cwd="/no/such/folder"))
        assert "folder '/no/such/folder' does not exist" in result.err

    async def test_empty_command_is_rejected(self, launch) -> None:
        assert "the command of the process is empty" in (await launch(ExecuteProcess(cmd=[""]))).err


class TestHandlers:
    async def test_process_start_io_and_exit_handlers_run(self, launch) -> None:
        first, second = execute_python("import os; os.write(1, b'hello\\n')", output="log"), execute_python("0")
        result = await launch(
            first,
            RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg="started")])),
            RegisterEventHandler(
                OnProcessIO(target_action=first, on_stdout=lambda event: LogInfo(msg=event.text.decode().strip()))
            ),
            RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[LogInfo(msg="exited"), second])),
            RegisterEventHandler(
                OnProcessExit(
                    target_action=second,
                    on_exit=lambda event, _: LogInfo(msg=f"{event.process_name} {event.returncode}"),
                )
            ),
        )
        assert result.messages == ["started", "hello", "exited", "py-2 0"]

    async def test_handle_once_runs_handler_once(self, launch) -> None:
        result = await launch(
            RegisterEventHandler(OnProcessExit(on_exit=LogInfo(msg="one"), handle_once=True)),
            execute_python("0"),
            execute_python("0"),
        )
        assert result.messages == ["one"]

    async def test_on_exit_shutdown_ends_other_processes(self, launch) -> None:
        result = await launch(
            execute_python("import time; time.sleep(60)", name="other"),
            TimerAction(period=0.3, actions=[execute_python("0", on_exit=Shutdown(reason="over"))]),
            RegisterEventHandler(OnShutdown(on_shutdown=lambda event, _: LogInfo(msg=event.reason))),
        )
        assert result.messages == ["over"]
        assert "process[py-2] was required: shutting down launched system" in result.err
        assert "sending signal 'SIGINT' to process[other-1]" in result.err

    async def test_wrong_on_exit_is_reported_when_process_ends(self, launch) -> None:
        action: Any = LaunchConfiguration("on_exit")
        result = await launch(execute_python("print('ran', flush=True)", on_exit=action, output="screen"))
        assert "ran" in result.out
        assert "expected launch actions, got" in result.err

    async def test_on_exit_accepts_function(self, launch) -> None:
        result = await launch(
            execute_python("raise SystemExit(4)", on_exit=lambda event, _: LogInfo(msg=f"rc {event.returncode}"))
        )
        assert result.messages == ["rc 4"]

    async def test_target_action_must_be_execute_process(self) -> None:
        with pytest.raises(TypeError, match="target_action must be an ExecuteProcess"):
            OnProcessExit(target_action="talker", on_exit=[])

    async def test_execution_complete_is_emitted_when_process_has_ended(self, launch) -> None:
        first, second = LogInfo(msg="first"), execute_python("0", on_exit=[LogInfo(msg="exited")])
        third = OpaqueFunction(function=lambda _: None)
        result = await launch(
            RegisterEventHandler(OnExecutionComplete(target_action=first, on_completion=[LogInfo(msg="then"), second])),
            RegisterEventHandler(OnExecutionComplete(target_action=second, on_completion=lambda *_: third)),
            RegisterEventHandler(OnExecutionComplete(target_action=third, on_completion=[LogInfo(msg="last")])),
            first,
        )
        assert result.messages[:2] == ["first", "then"]
        assert sorted(result.messages[2:]) == ["exited", "last"]

    async def test_completion_handler_ignores_its_own_actions(self, launch) -> None:
        result = await launch(RegisterEventHandler(OnExecutionComplete(on_completion=[LogInfo(msg="x")])))
        assert result.messages == ["x"]


class TestProcessExits:
    async def test_respawn_repeats_up_to_max_retries(self, launch) -> None:
        result = await launch(execute_python("print('up')", respawn=True, respawn_delay=0.01, respawn_max_retries=2))
        assert result.out == "[py-1] up\n" * 3

    async def test_failing_action_ends_processes_that_are_starting(self, launch) -> None:
        start_s = time.monotonic()
        result = await launch(
            execute_python("import time; time.sleep(60)"),
            execute_python("import time; time.sleep(60)"),
            LogInfo(msg=LaunchConfiguration("x")),
        )
        assert time.monotonic() - start_s < 60.0
        assert not result.succeeded

    async def test_failing_action_ends_started_process_and_runs_on_exit(self, launch) -> None:
        result = await launch(
            execute_python("import time; time.sleep(60)", on_exit=LogInfo(msg="exited")),
            LogInfo(msg=LaunchConfiguration("x")),
        )
        assert result.messages == ["exited"]
        assert "sending signal 'SIGINT' to process[py-1]" in result.err

    async def test_pending_respawn_is_canceled_at_shutdown(self, launch) -> None:
        start_s = time.monotonic()
        result = await launch(
            execute_python("0", respawn=True, respawn_delay=60.0),
            TimerAction(period=0.3, actions=[Shutdown(reason="over")]),
        )
        assert time.monotonic() - start_s < 60.0
        assert result.err.count("process started") == 1

    async def test_shutdown_escalates_to_sigterm_and_sigkill(self, launch) -> None:
        action = execute_python(STUBBORN, sigterm_timeout=0.15, sigkill_timeout="0.15")
        result = await launch(
            action,
            RegisterEventHandler(
                OnProcessIO(
                    on_stdout=lambda event: (
                        EmitEvent(event=ShutdownProcess(process_matcher=matches_action(action)))
                        if b"ready" in event.text
                        else None
                    )
                )
            ),
        )
        assert result.out.splitlines() == ["[py-1] ready", "[py-1] int", "[py-1] term"]
        assert "escalating to 'SIGTERM'" in result.err
        assert "escalating to 'SIGKILL'" in result.err
        assert action.return_code == -9

    async def test_signal_process_event_sends_signal(self, launch) -> None:
        action = execute_python("import time; print('ready', flush=True); time.sleep(60)")
        result = await launch(
            action,
            RegisterEventHandler(
                OnProcessIO(
                    on_stdout=lambda _: EmitEvent(
                        event=SignalProcess(signal_number="SIGTERM", process_matcher=matches_name("py-1"))
                    )
                )
            ),
        )
        assert action.return_code == -15
        assert "sending signal 'SIGTERM' to process[py-1]" in result.err

    async def test_grandchildren_are_ended_with_launch(self, launch, tmp_path: Path) -> None:
        pid_file = tmp_path / "pid"
        program = f"sleep 60 & echo $! > {pid_file}; exit 0"
        start_s = time.monotonic()
        result = await launch(ExecuteProcess(cmd=["sh", "-c", program], output="screen"))
        assert result.succeeded
        assert time.monotonic() - start_s < 60.0
        assert is_gone(int(pid_file.read_text()))


def test_actions_can_be_added_to_launch_description() -> None:
    description = LaunchDescription()
    description.add_action(LogInfo(msg="a"))
    description.add_entity(LogInfo(msg="b"))
    assert len(description.entities) == 2
