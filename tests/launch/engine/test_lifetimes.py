"""No process or thread remains after a launch, regardless of its end."""

from __future__ import annotations

import os
import random
import re
import signal
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest
from launch.actions import ExecuteProcess, OpaqueFunction, Shutdown, TimerAction
from launch_ros.actions import Node

from linkwright.launch.engine import guardian_program
from linkwright.launch.engine.guardian import Guardian
from tests.launch.launcher import Running, launch_file
from tests.waiting import eventually, wait_until

Write = Callable[[str, str], Path]
LAUNCH_VARIABLE = "LINKWRIGHT_LAUNCH"
SLEEPS = "import time; print('up', flush=True); time.sleep(60)"
TALKER = "Node(package='demo_nodes_cpp', executable='talker')"


def execute_process(program: str, **options: Any) -> ExecuteProcess:
    return ExecuteProcess(cmd=[sys.executable, "-c", program], name="py", output="screen", **options)


def make_sleeper(name: str) -> str:
    return f"ExecuteProcess(cmd=[sys.executable, '-c', {SLEEPS!r}, '{name}'], output='screen', name='{name}')"


def find_marked_processes(launcher: int) -> list[psutil.Process]:
    """Return the processes that a launcher has started, and their descendants."""
    return [candidate for candidate in psutil.process_iter() if _is_marked(candidate, f"launcher_{launcher}")]


def _is_marked(process: psutil.Process, mark: str) -> bool:
    try:
        return process.status() != psutil.STATUS_ZOMBIE and mark in process.environ().values()
    except psutil.Error:
        return False


def are_gone_within(seconds: float, launcher: int) -> bool:
    deadline = time.monotonic() + seconds
    while find_marked_processes(launcher):
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


@pytest.fixture
def start_marked(start: Callable[..., Running], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Running]:
    """Start a launcher whose processes have a variable in their environment.

    This includes the guardian.
    """
    numbers = iter(range(100))

    def started(*words: object) -> Running:
        identity = f"launcher_{os.getpid()}{next(numbers)}"
        monkeypatch.setenv("LW_TEST_LAUNCHER", identity)
        running = start(*words)
        running.identity = int(identity.rpartition("_")[2])
        return running

    return started


class TestKilled:
    def test_killed_launcher_takes_its_processes_with_it(
        self, start_marked: Callable[..., Running], write: Write
    ) -> None:
        fork = "import os, time; os.fork(); print('up', flush=True); time.sleep(60)"
        forking = f"ExecuteProcess(cmd=[sys.executable, '-c', {fork!r}], output='screen', name='c')"
        shell = "ExecuteProcess(cmd=['sleep 60; echo x'], shell=True)"
        running = start_marked(write("a.launch.py", launch_file(make_sleeper("a"), make_sleeper("b"), forking, shell)))
        running.until("[a-1] up")
        running.until("[b-2] up")
        running.until("[c-3] up")
        assert len(find_marked_processes(running.identity)) >= 6
        running.process.kill()
        running.process.wait()
        assert are_gone_within(30.0, running.identity)

    def test_processes_that_ignore_signals_are_killed(self, start_marked: Callable[..., Running], write: Write) -> None:
        stubborn = (
            "import signal, time\nfor n in (signal.SIGINT, signal.SIGTERM): signal.signal(n, signal.SIG_IGN)\n"
            "print('up', flush=True)\ntime.sleep(60)"
        )
        action = f"ExecuteProcess(cmd=[sys.executable, '-c', {stubborn!r}], output='screen', name='bad')"
        running = start_marked(write("a.launch.py", launch_file(action)))
        running.until("[bad-1] up")
        running.process.kill()
        running.process.wait()
        assert are_gone_within(30.0, running.identity)

    def test_temporary_files_are_removed(
        self, start_marked: Callable[..., Running], write: Write, tmp_path: Path
    ) -> None:
        program = "import sys; print('given', sys.argv[3], flush=True); import time; time.sleep(60)"
        write("python", f'#!/bin/sh\nexec {sys.executable} -c "{program}" "$@"\n').chmod(0o755)
        node = f"Node(executable='{tmp_path}/python', exec_name='n', parameters=[{{'a': 1}}], output='screen')"
        running = start_marked(write("a.launch.py", launch_file(node)))
        running.until("[n-1] given ")
        (path,) = re.findall(r"given (\S+)", running.out)
        assert Path(path).exists()
        running.process.kill()
        running.process.wait()
        assert are_gone_within(30.0, running.identity)
        assert not Path(path).parent.exists()

    @pytest.mark.slow
    def test_killed_launcher_leaves_no_process_at_any_time(
        self, start_marked: Callable[..., Running], write: Write
    ) -> None:
        path = write("a.launch.py", launch_file(make_sleeper("a"), TALKER, make_sleeper("b")))
        for delay in random.Random(4).sample([0.05 * step for step in range(1, 31)], 8):
            running = start_marked(path)
            time.sleep(delay)
            running.process.kill()
            running.process.wait()
            assert are_gone_within(30.0, running.identity), f"killed after {delay} s"

    async def test_killed_node_respawns(self, launch) -> None:
        pids: list[int] = []

        def kill(context: Any) -> None:
            pid = action.process_details["pid"]
            pids.append(pid)
            os.kill(pid, signal.SIGKILL)

        action = execute_process(SLEEPS, respawn=True)
        result = await launch(
            action,
            TimerAction(period=0.5, actions=[OpaqueFunction(function=kill)]),
            TimerAction(period=1.0, actions=[OpaqueFunction(function=kill)]),
            TimerAction(period=1.5, actions=[Shutdown()]),
        )
        assert len(set(pids)) == 2
        assert result.err.count("process started with pid") == 3
        assert result.err.count("exit code -9") == 2


class TestInterrupted:
    @pytest.mark.slow
    def test_interrupt_during_startup_ends_cleanly(self, start_marked: Callable[..., Running], write: Write) -> None:
        path = write("a.launch.py", launch_file(make_sleeper("a"), TALKER, make_sleeper("b")))
        start_s = time.monotonic()
        running = start_marked(path)
        running.until("[b-3] up")
        duration_s = time.monotonic() - start_s
        running.end()
        for delay in [duration_s * step / 16 for step in range(16)]:
            running = start_marked(path)
            wait_until(lambda running=running: running.has_begun)
            time.sleep(delay)
            status, _ = running.end()
            assert status == 130, f"interrupted after {delay:.2f} s:\n{running.err}"
            assert not re.search(r"^Traceback", running.err, re.MULTILINE), running.err
            assert are_gone_within(30.0, running.identity), f"interrupted after {delay:.2f} s:\n{running.err}"

    @pytest.mark.parametrize("given", ["", ", sigterm_timeout='8'"])
    def test_interrupted_process_has_time_to_save_file(
        self, start_marked: Callable[..., Running], write: Write, given: str
    ) -> None:
        slow = (
            "import time\ntry:\n    print('up', flush=True); time.sleep(60)\n"
            "except KeyboardInterrupt:\n    time.sleep(2.2); print('saved', flush=True)"
        )
        options = f"output='screen', name='slow'{given}"
        running = start_marked(
            write("a.launch.py", launch_file(f"ExecuteProcess(cmd=[sys.executable, '-c', {slow!r}], {options})"))
        )
        running.until("[slow-1] up")
        status, seconds = running.end()
        assert status == 130
        assert seconds > 2.0
        assert "[slow-1] saved" in running.out


class TestCounts:
    async def test_launch_leaves_no_threads_or_processes(self, launch, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.delenv("LINKWRIGHT_DDS")
        me = psutil.Process()
        await launch()  # creates the objects that all launches share
        threads, children = set(threading.enumerate()), {child.pid for child in me.children(recursive=True)}
        counts: list[tuple[int, int]] = []

        def look(_: Any) -> None:
            counts.append((threading.active_count(), len(me.children(recursive=True))))

        result = await launch(
            Node(package="demo_nodes_cpp", executable="talker"),
            Node(package="rviz2", executable="rviz2"),
            execute_process(SLEEPS),
            execute_process("print('done')"),
            TimerAction(period=1.5, actions=[OpaqueFunction(function=look), Shutdown()]),
        )
        assert result.succeeded, result.err
        assert counts[0][1] >= len(children) + 2  # the program and the guardian

        def left() -> list[object]:
            new_threads = [
                thread for thread in threading.enumerate() if thread not in threads and not _is_pooled(thread)
            ]
            return [*new_threads, *(child for child in me.children(recursive=True) if child.pid not in children)]

        await eventually(lambda: not left(), what=lambda: f"left behind: {left()}")


def _is_pooled(thread: threading.Thread) -> bool:
    """Return whether a thread belongs to the thread pool of the event loop.

    The pool ends with the loop.
    """
    return re.match(r"asyncio_\d+|waitpid-\d+", thread.name) is not None


class TestGuardian:
    def test_guardian_ends_with_launch(self) -> None:
        guardian = Guardian()
        guardian.start_and_mark({})
        process = guardian._process
        assert process is not None
        guardian.watch(1)
        guardian.close()
        assert process.returncode == 0
        guardian.close()  # a second call has no effect
        assert guardian.start_and_mark({})[LAUNCH_VARIABLE]
        assert guardian._process is None

    def test_killed_guardian_is_tolerated(self) -> None:
        guardian = Guardian()
        guardian.start_and_mark({})
        assert guardian._process is not None
        guardian._process.kill()
        guardian._process.wait()
        guardian.watch(1)
        guardian.release(1)
        guardian.close()

    def test_missing_process_groups_are_ignored(self) -> None:
        guardian_program.end_groups({2**22 - 3})
        assert guardian_program.find_marked_groups(b"LINKWRIGHT_LAUNCH=no-such-launch") == set()
