"""Nodes that run in the process of the launcher, or isolated in separate processes."""

from __future__ import annotations

import asyncio
import re
import socket
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from launch.actions import (
    ExecuteProcess,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import Shutdown as ShutdownEvent
from launch.substitutions import Command, EnvironmentVariable
from launch.utilities import perform_substitutions
from launch_ros.actions import Node, RosTimer, SetROSLogDir, SetUseSimTime

from launch import LaunchContext
from linkwright.hosting.network import Network
from tests.domains import own_domain
from tests.launch.ending import end_when, has_printed

Write = Callable[[str, str], Path]


def make_talker(**options: Any) -> Node:
    return Node(package="demo_nodes_cpp", executable="talker", **options)


def read_prefixed(prefix: str, pattern: str) -> list[Any]:
    configurations = {"launch-prefix": prefix, "launch-prefix-filter": pattern}
    return [SetLaunchConfiguration(name, value) for name, value in configurations.items()]


class TestProcessChoice:
    async def test_isolated_nodes_run_as_processes(self, launch) -> None:
        start_handler = RegisterEventHandler(
            OnProcessExit(on_exit=lambda event, _: LogInfo(msg=f"{event.process_name} {event.returncode}"))
        )
        speaks = end_when(has_printed("] [tk]: Publishing: 'Hello World: 1'"))
        result = await launch(make_talker(name="tk"), start_handler, speaks, session_options={"isolate": True})
        assert "[INFO] [talker-1]: process started with pid [" in result.err
        assert "[talker-1] [INFO] [" in result.err
        assert "] [tk]: Publishing: 'Hello World: 1'" in result.err
        assert result.messages == ["talker-1 0"]

    @pytest.mark.parametrize(
        ("options", "before"),
        [
            ({"prefix": "env LW=1"}, []),
            ({"additional_env": {"ROS_DOMAIN_ID": str(own_domain())}}, []),
            (
                {},
                [SetLaunchConfiguration("launch-prefix", "env"), SetLaunchConfiguration("launch-prefix-filter", "tal")],
            ),
        ],
    )
    async def test_node_with_prefix_or_own_domain_runs_as_process(
        self, launch, options: Any, before: list[Any]
    ) -> None:
        result = await launch(*before, make_talker(**options), end_when(has_printed("[talker-1]: process started")))
        assert "[INFO] [talker-1]: process started with pid [" in result.err

    @pytest.mark.parametrize(
        ("options", "before"),
        [
            ({"additional_env": {"DISPLAY": ":1"}, "emulate_tty": True, "respawn": True}, []),
            ({}, read_prefixed("env", "x")),
        ],
    )
    async def test_irrelevant_options_keep_node_in_launcher_process(
        self, launch, options: Any, before: list[Any]
    ) -> None:
        result = await launch(*before, make_talker(**options), end_when(has_printed("[talker-1]: started in")))
        assert "[INFO] [talker-1]: started in the launcher's process" in result.err


class TestOutput:
    async def test_output_option_selects_log_destination(self, launch, tmp_path: Path) -> None:
        logs = {
            "quiet-1-stderr.log": "[talker]: Publishing: 'Hello World: 1'",
            "launch.log": "[loud]: Publishing: 'Hello",
        }

        def are_written(_: LaunchContext) -> bool:
            folder = tmp_path / "ros_log" / "latest"
            return all((folder / name).is_file() and text in (folder / name).read_text() for name, text in logs.items())

        log_only, both_outputs = (
            make_talker(output="own_log", exec_name="quiet"),
            make_talker(name="loud", output="both"),
        )
        result = await launch(log_only, both_outputs, end_when(are_written))
        assert are_written(result.session.context)
        assert "[quiet-1] [INFO]" not in result.err
        assert "[talker-2] [INFO] [" in result.err

    async def test_finished_node_emits_process_exit(self, launch) -> None:
        node = Node(package="demo_nodes_py", executable="talker_qos", arguments=["--number_of_cycles", "1"])
        result = await launch(
            node, RegisterEventHandler(OnProcessExit(target_action=node, on_exit=[LogInfo(msg="over")]))
        )
        assert result.messages == ["over"]
        assert "[INFO] [talker_qos-1]: has finished cleanly" in result.err
        assert node.return_code == 0

    async def test_command_reads_parameter_of_node_in_launcher_process(self, launch) -> None:
        texts: list[str] = []

        def read(context: LaunchContext) -> None:
            arguments = ("--hide-type /talker use_sim_time", "talker use_sim_time", "/talker other")
            commands = [Command(f"ros2 param get {words}") for words in arguments]
            texts.extend(perform_substitutions(context, [command]) for command in commands)

        talker = Node(package="demo_nodes_py", executable="talker", name="talker")
        await launch(talker, TimerAction(period=0.1, actions=[OpaqueFunction(function=read), Shutdown()]))
        assert texts == ["False\n", "Boolean value is: False\n", "Parameter not set.\n"]

    @pytest.mark.parametrize("ends", [True, False])
    async def test_node_waits_for_file_that_process_writes(self, launch, tmp_path: Path, ends: bool) -> None:
        path = tmp_path / "map.yaml"
        wait = "" if ends else "; time.sleep(60)"
        program = f"import sys, time; time.sleep(0.5); open(sys.argv[1], 'w').write('image: a.png'){wait}"
        writer = ExecuteProcess(cmd=[sys.executable, "-c", program, str(path)])
        reader = Node(package="demo_nodes_py", executable="talker", parameters=[{"file": str(path)}])
        found: list[bool] = []
        started = OnProcessStart(target_action=reader, on_start=lambda *_: found.append(path.exists()) or Shutdown())
        result = await launch(RegisterEventHandler(started), reader, writer)
        assert found == [True]
        assert f"waiting for '{path}'" in result.err

    async def test_node_does_not_wait_for_missing_file_that_no_process_writes(self, launch) -> None:
        reader = Node(package="demo_nodes_py", executable="talker", parameters=[{"file": "/no/such/file"}])
        result = await launch(reader, RegisterEventHandler(OnProcessStart(on_start=Shutdown())))
        assert "waiting for" not in result.err

    async def test_finished_node_respawns(self, launch) -> None:
        node = Node(
            package="demo_nodes_py",
            executable="talker_qos",
            arguments=["-n", "1"],
            respawn=True,
            respawn_delay=0.1,
            respawn_max_retries=2,
        )
        result = await launch(node)
        assert result.err.count("started in the launcher's process") == 3
        assert result.err.count("[talker_qos-1]: has finished cleanly") == 3

    async def test_pending_respawn_is_canceled_at_shutdown(self, launch) -> None:
        node = Node(
            package="demo_nodes_py", executable="talker_qos", arguments=["-n", "1"], respawn=True, respawn_delay=60.0
        )
        start_s = time.monotonic()
        result = await launch(node, end_when(has_printed("has finished cleanly")))
        assert result.err.count("started in the launcher's process") == 1
        assert time.monotonic() - start_s < 60.0

    async def test_invalid_node_arguments_fail_launch(self, launch) -> None:
        node = Node(package="demo_nodes_py", executable="talker_qos", arguments=["--number_of_cycles", "x"])
        result = await launch(node)
        assert "error[NODE602]" in result.err
        assert not result.succeeded


class TestManyNodes:
    async def test_five_hundred_nodes_start_in_one_launch(self, launch) -> None:
        started_numbers: list[int] = []

        def look(context: LaunchContext) -> None:
            started_numbers.append(len(context.session.host.graph.node_names()))

        nodes = [
            Node(
                package="tf2_ros",
                executable="static_transform_publisher",
                name=f"n{number}",
                arguments=["--frame-id", "a", "--child-frame-id", f"b{number}"],
                output="log",
            )
            for number in range(500)
        ]
        last = OnProcessStart(target_action=nodes[-1], on_start=[OpaqueFunction(function=look), Shutdown()])
        result = await launch(*nodes, RegisterEventHandler(last))
        assert result.succeeded, result.err[-2000:]
        assert result.err.count("has finished cleanly") == 500
        assert started_numbers[0] >= 500

    async def test_event_loop_runs_between_node_starts(self, launch) -> None:
        counts: list[int] = []

        async def watch(context: LaunchContext) -> None:
            while not counts or counts[-1] < 100:
                counts.append(sum(name.startswith("/n") for name in context.session.host.graph.node_names()))
                await asyncio.sleep(0)
            context.emit_event_sync(ShutdownEvent())

        nodes = [make_talker(name=f"n{number}") for number in range(100)]
        await launch(OpaqueCoroutine(coroutine=watch), *nodes)
        assert all(later - before <= 1 for before, later in pairwise(counts))


class TestScope:
    async def test_set_ros_log_dir_sets_environment_variable(self, launch, tmp_path: Path) -> None:
        result = await launch(
            SetROSLogDir("inner"),
            LogInfo(msg=EnvironmentVariable("ROS_LOG_DIR")),
            SetROSLogDir("/elsewhere"),
            LogInfo(msg=EnvironmentVariable("ROS_LOG_DIR")),
        )
        assert result.messages == [str(tmp_path / "ros_log" / "inner"), "/elsewhere"]

    async def test_ros_timer_runs_actions_after_period(self, launch) -> None:
        start_s = time.monotonic()
        result = await launch(RosTimer(period=0.3, actions=[LogInfo(msg="now")]))
        assert result.messages == ["now"]
        assert time.monotonic() - start_s >= 0.3

    async def test_ros_timer_can_be_canceled(self, launch) -> None:
        timer = RosTimer(period=60.0, actions=[LogInfo(msg="never")])
        result = await launch(
            timer, TimerAction(period=0.1, actions=[OpaqueFunction(function=lambda _: timer.cancel())])
        )
        assert result.messages == []

    async def test_ros_timer_follows_simulated_time(self, launch) -> None:
        def publish(context: LaunchContext) -> None:
            from linkwright.messages import get_message

            clock = get_message("rosgraph_msgs/msg/Clock")
            node = context.session.host.graph.create_node("simulator")
            publisher = node.create_publisher(clock, "/clock", 10)
            now = [0]

            def tick() -> None:
                now[0] += 100
                message = clock()
                message.clock.sec = now[0]
                publisher.publish(message)

            node.create_timer(0.05, tick)

        result = await launch(
            OpaqueFunction(function=publish),
            RosTimer(period=500.0, actions=[LogInfo(msg="simulated"), Shutdown()]),
            SetUseSimTime(True),
        )
        assert result.messages == ["simulated"]


class TestNetwork:
    async def test_network_is_joined_only_if_nodes_are_launched(self, launch, monkeypatch: pytest.MonkeyPatch) -> None:
        joined: list[float] = []
        monkeypatch.setattr(Network, "_join", lambda self: joined.append(time.monotonic()))
        monkeypatch.delenv("LINKWRIGHT_DDS")
        await launch(LogInfo(msg="no nodes"))
        assert joined == []
        speaks = has_printed("Publishing: 'Hello World: 1'")
        await launch(make_talker(), end_when(speaks))
        assert len(joined) == 1
        await launch(make_talker(), end_when(speaks), session_options={"network": False})
        monkeypatch.setenv("LINKWRIGHT_DDS", "0")
        await launch(make_talker(), end_when(speaks))
        assert len(joined) == 1

    async def test_viewer_starts_before_network_is_joined(self, launch, monkeypatch: pytest.MonkeyPatch) -> None:
        joined: list[float] = []
        monkeypatch.setattr(Network, "_join", lambda self: joined.append(time.monotonic()))
        monkeypatch.delenv("LINKWRIGHT_DDS")
        start_s = time.monotonic()
        await launch(make_talker(), Node(package="rviz2", executable="rviz2"), end_when(lambda _: joined))
        assert joined[0] - start_s > 0.7


async def test_requested_port_is_used_by_only_one_viewer(launch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    viewers = [Node(package="rviz2", executable="rviz2", name=name) for name in ("one", "other")]
    result = await launch(*viewers, end_when(has_printed("Viewer: ", times=2)), session_options={"port": port})
    assert result.succeeded, result.err
    pages = re.findall(r"Viewer: http://127\.0\.0\.1:(\d+)/", result.out)
    assert str(port) in pages
    assert len(set(pages)) == 2
