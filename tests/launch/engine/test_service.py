"""A user's program that creates and runs a launch description."""

from __future__ import annotations

import asyncio
import queue
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    IncludeLaunchDescription,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    SetEnvironmentVariable,
    Shutdown,
    TimerAction,
)
from launch.event_handler import EventHandler
from launch.event_handlers import OnProcessExit, OnProcessStart, OnShutdown
from launch.events import ExecutionComplete
from launch.substitutions import ThisLaunchFile

from launch import Event, LaunchContext, LaunchDescription, LaunchIntrospector, LaunchService


@pytest.fixture(autouse=True)
def _isolated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


class Custom(Event):
    name = "test.Custom"


def run_service(*entities: Any) -> int:
    service = LaunchService()
    service.include_launch_description(LaunchDescription(entities))
    return service.run()


def test_log_file_name_and_logger_name_are_derived() -> None:
    assert LaunchService()._log_file_name == "launch.log"
    assert LaunchService(log_file_name="mine")._log_file_name == "mine.log"
    assert LaunchService(log_file_name="mine.log")._logger_name == "mine"


def test_run_executes_process_and_exit_handler() -> None:
    ended: list[int] = []
    process = ExecuteProcess(cmd=[sys.executable, "-c", "import sys; print('out'); sys.exit(3)"], cached_output=True)
    handler = OnProcessExit(target_action=process, on_exit=lambda event, context: ended.append(event.returncode))
    assert run_service(process, RegisterEventHandler(handler)) == 0
    assert ended == [3]
    assert process.return_code == 3
    assert process.get_stdout() == "out\n"
    assert process.process_details["cmd"][0] == sys.executable
    assert process.name.startswith(Path(sys.executable).name)


def test_exception_ends_processes_and_returns_1() -> None:
    ended: list[object] = []

    def fail(context: LaunchContext) -> None:
        raise ValueError("no")

    process = ExecuteProcess(
        cmd=[sys.executable, "-c", "import time; time.sleep(60)"], on_exit=lambda event, context: ended.append(event)
    )
    handler = OnProcessStart(target_action=process, on_start=[OpaqueFunction(function=fail)])
    assert run_service(RegisterEventHandler(handler), process) == 1
    assert len(ended) == 1


def test_events_are_handled_across_threads_and_repeated_runs() -> None:
    service = LaunchService()
    handled: queue.Queue[Any] = queue.Queue()
    service.include_launch_description(
        LaunchDescription(
            [
                RegisterEventHandler(
                    EventHandler(
                        matcher=lambda event: not isinstance(event, ExecutionComplete),
                        entities=OpaqueFunction(function=lambda context: handled.put(context.locals.event)),
                    )
                )
            ]
        )
    )
    service.emit_event(Custom())
    assert service.context._event_queue.qsize() == 2

    def others() -> None:
        handled.get(timeout=60.0)
        service.emit_event(Custom())
        handled.get(timeout=60.0)
        service.shutdown()

    thread = threading.Thread(target=others)
    thread.start()
    assert service.run(shutdown_when_idle=False) == 0
    thread.join()
    assert handled.get(block=False).name == "launch.events.Shutdown"
    service.emit_event(Custom())
    assert handled.qsize() == 0
    assert service.run() == 0
    assert [handled.get(block=False).name for _ in range(2)] == ["test.Custom", "launch.events.Shutdown"]


def test_timer_with_cancel_on_shutdown_false_outlasts_shutdown() -> None:
    reasons: list[str] = []
    listener = RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: reasons.append(event.reason)))
    assert (
        run_service(
            listener,
            TimerAction(period=0.05, actions=[Shutdown(reason="fast")]),
            TimerAction(period=0.1, actions=[Shutdown(reason="never")]),
            TimerAction(period=0.2, actions=[Shutdown(reason="slow")], cancel_on_shutdown=False),
        )
        == 0
    )
    assert reasons == ["fast", "slow"]


def test_opaque_coroutine_is_awaited_or_canceled() -> None:
    import asyncio

    messages: list[str] = []

    async def work(context: LaunchContext, word: str) -> None:
        await asyncio.sleep(0.05)
        messages.append(word)

    async def for_ever() -> None:
        try:
            await asyncio.sleep(60)
        finally:
            messages.append("cancelled")

    assert run_service(OpaqueCoroutine(coroutine=work, args=["done"])) == 0
    assert (
        run_service(
            OpaqueCoroutine(coroutine=for_ever, ignore_context=True), TimerAction(period=0.1, actions=[Shutdown()])
        )
        == 0
    )
    assert messages == ["done", "cancelled"]
    with pytest.raises(TypeError):
        OpaqueCoroutine(coroutine=print)


def test_filename_substitution_is_scoped_to_its_launch_file(tmp_path: Path) -> None:
    inner_file = tmp_path / "inner.launch.xml"
    inner_file.write_text('<launch><set_env name="INNER" value="$(filename)"/></launch>')
    outer_file = tmp_path / "outer.launch.yaml"
    outer_file.write_text(
        "launch:\n- include: {file: $(dirname)/inner.launch.xml}\n- set_env: {name: OUTER, value: $(filename)}\n"
    )
    service = LaunchService()
    service.include_launch_description(LaunchDescription([IncludeLaunchDescription(str(outer_file))]))
    assert service.run() == 0
    assert service.context.environment["INNER"] == str(inner_file)
    assert service.context.environment["OUTER"] == str(outer_file)
    assert run_service(IncludeLaunchDescription(str(outer_file)), SetEnvironmentVariable("X", ThisLaunchFile())) == 1


def test_emit_event_rejects_other_types() -> None:
    with pytest.raises(TypeError):
        EmitEvent(event="x")  # type: ignore[arg-type]


def test_introspector_output_has_no_memory_addresses() -> None:
    def make_nodes(context: LaunchContext) -> list[Any]:
        return []

    text = LaunchIntrospector().format_launch_description(
        LaunchDescription(
            [
                DeclareLaunchArgument("sim", default_value="false", description="Use it"),
                OpaqueFunction(function=make_nodes),
                TimerAction(period=2.0, actions=[LogInfo(msg=["a", "b"])]),
                ExecuteProcess(cmd=["ls", "-l"], cwd="/"),
            ]
        )
    )
    assert text.splitlines() == [
        "LaunchDescription(4 entities)",
        "├── DeclareLaunchArgument('sim', default_value='false', description='Use it')",
        "├── OpaqueFunction(function=make_nodes)",
        "├── TimerAction(period=2.0, actions=<actions>)",
        "│   └── LogInfo('a' + 'b')",
        "└── ExecuteProcess(cmd=['ls', '-l'], cwd='/', env=None, shell=False)",
    ]


def test_user_program_runs_launch_service(tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(
        "import sys\n"
        "from launch import LaunchDescription, LaunchService\n"
        "from launch.actions import ExecuteProcess, LogInfo\n"
        "service = LaunchService(argv=sys.argv[1:])\n"
        "service.include_launch_description(LaunchDescription([LogInfo(msg='here'),\n"
        "    ExecuteProcess(cmd=['echo', 'there'], output='screen')]))\n"
        "sys.exit(service.run())\n"
    )
    start = (
        "import sys; from linkwright.standins import activate; activate(); import runpy; runpy.run_path(sys.argv[1])"
    )
    result = subprocess.run(
        [sys.executable, "-c", start, str(program)], capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stderr
    assert "[echo-1] there" in result.stdout
    assert "[INFO] [launch.user]: here" in result.stderr


def test_service_can_be_shut_down_between_loop_runs() -> None:
    loop = asyncio.new_event_loop()
    service = LaunchService()
    running = loop.create_task(service.run_async(shutdown_when_idle=False))
    loop.run_until_complete(asyncio.sleep(0.0))
    loop.run_until_complete(service.shutdown())
    assert loop.run_until_complete(running) == 0
    loop.close()
