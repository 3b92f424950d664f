"""The `Node` action: nodes in processes, and hosted nodes."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from launch.actions import EmitEvent, GroupAction, LogInfo, OpaqueFunction, RegisterEventHandler, Shutdown, TimerAction
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events import matches_action
from launch.events.process import ShutdownProcess
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap
from launch_ros.parameter_descriptions import Parameter, ParameterValue

from launch import LaunchContext
from linkwright.hosting.node_host import NodeHost
from linkwright.hosting.plans import HostedPlan
from linkwright.packages import PackageFinder

Write = Callable[[str, str], Path]
URDF = '<robot name="r"><link name="base"/></robot>'


@pytest.fixture
def ros(tmp_path: Path) -> PackageFinder:
    """Return a prefix with the package ``arm``.

    Its executable ``tell`` writes its command line as JSON.
    """
    share = tmp_path / "ros" / "share" / "arm"
    share.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>arm</name></package>")
    program = tmp_path / "ros" / "lib" / "arm" / "tell"
    program.parent.mkdir(parents=True)
    program.write_text(
        f"#!{sys.executable}\nimport json, sys\n"
        "files = {a: open(a).read() for a in sys.argv if a.endswith('.yaml')}\n"
        "print(json.dumps([sys.argv[1:], files]))\n"
    )
    program.chmod(0o755)
    return PackageFinder(start=tmp_path, environment={"AMENT_PREFIX_PATH": str(tmp_path / "ros")})


class TestProcessNodes:
    async def received_arguments(self, launch, ros: PackageFinder, *entities: Any) -> tuple[list[str], list[Any]]:
        result = await launch(*entities, finder=ros)
        assert result.succeeded, result.err
        (line,) = result.out.splitlines()
        words, files = json.loads(line.partition("] ")[2])
        return words, [yaml.safe_load(files[word]) for word in words if word in files]

    async def test_command_line_contains_names_parameters_and_remappings(self, launch, ros: PackageFinder) -> None:
        words, files = await self.received_arguments(
            launch,
            ros,
            SetParameter("global", 1),
            SetRemap("/a", "/b"),
            GroupAction(
                [
                    PushRosNamespace("robot"),
                    PushRosNamespace("left"),
                    Node(
                        package="arm",
                        executable="tell",
                        name="teller",
                        namespace="inner",
                        output="screen",
                        parameters=[{"own": LaunchConfiguration("x", default="2")}],
                        remappings=[("chatter", ["/t", "alk"])],
                        arguments=["--fast", LaunchConfiguration("x", default="1")],
                        ros_arguments=["--log-level", "debug"],
                    ),
                ]
            ),
        )
        assert words[:4] == ["--fast", "1", "--ros-args", "--log-level"]
        assert words[4:10] == ["debug", "--ros-args", "-r", "__node:=teller", "-r", "__ns:=/robot/left/inner"]
        assert words[10:13] == ["-p", "global:=1", "--params-file"]
        assert words[14:] == ["-r", "/a:=/b", "-r", "chatter:=/talk"]
        assert files == [{"/robot/left/inner/teller": {"ros__parameters": {"own": 2}}}]

    async def test_parameters_of_unnamed_node_use_wildcard_section(self, launch, ros: PackageFinder) -> None:
        node = Node(package="arm", executable="tell", output="screen", parameters=[{"a": 1}])
        words, files = await self.received_arguments(launch, ros, node)
        assert words[:2] == ["--ros-args", "--params-file"]
        assert files == [{"/**": {"ros__parameters": {"a": 1}}}]

    async def test_parameter_descriptions_become_p_arguments(self, launch, ros: PackageFinder) -> None:
        parameters = [Parameter("a", "x: y"), Parameter("b", [1.0, 2.5]), Parameter("c", True), Parameter("d", "1")]
        node = Node(package="arm", executable="tell", output="screen", parameters=parameters)
        words, _ = await self.received_arguments(launch, ros, node)
        assert words[1::2] == ["-p"] * 4
        assert words[2::2] == ["a:='x: y'", "b:=[1.0, 2.5]", "c:=true", "d:='1'"]

    async def test_ros_args_is_passed_without_arguments(self, launch, ros: PackageFinder) -> None:
        words, _ = await self.received_arguments(launch, ros, Node(package="arm", executable="tell", output="screen"))
        assert words == ["--ros-args"]

    async def test_absolute_namespace_overrides_pushed_namespace(self, launch, ros: PackageFinder) -> None:
        words, _ = await self.received_arguments(
            launch,
            ros,
            PushRosNamespace("robot"),
            Node(package="arm", executable="tell", output="screen", namespace="/own"),
        )
        assert words == ["--ros-args", "-r", "__ns:=/own"]

    async def test_parameter_files_are_passed_by_path(self, launch, ros: PackageFinder, write: Write) -> None:
        path = write("p.yaml", "/**: {ros__parameters: {a: 1}}")
        words, _ = await self.received_arguments(
            launch,
            ros,
            SetParametersFromFile(str(path)),
            Node(package="arm", executable="tell", output="screen", parameters=[str(path)]),
        )
        assert words == ["--ros-args", "--params-file", str(path), "--params-file", str(path)]

    async def test_missing_parameter_file_is_skipped_with_warning(
        self, launch, ros: PackageFinder, write: Write
    ) -> None:
        path = write("p.yaml", "/**: {ros__parameters: {a: 1}}")
        missing = path.with_name("q.yaml")
        node = Node(package="arm", executable="tell", output="screen", parameters=[str(missing), str(path)])
        result = await launch(node, finder=ros)
        assert "q.yaml' does not exist" in result.err
        assert "warning[LAUNCH133]" in result.err
        assert "test_node.py" in result.err
        assert json.loads(result.out.partition("] ")[2])[0] == ["--ros-args", "--params-file", str(path)]
        assert result.succeeded

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a: [1", "error[GRAPH212]"),
            ("talker: 5", "error[GRAPH212]"),
            ("a: {ros__params: {b: 1}}", "error[GRAPH212]"),
        ],
    )
    async def test_node_with_malformed_parameter_file_does_not_start(
        self, launch, ros: PackageFinder, write: Write, text: str, message: str
    ) -> None:
        path = write("p.yaml", text)
        failing = Node(package="arm", executable="tell", parameters=[str(path)], on_exit=LogInfo(msg="it has ended"))
        other = Node(package="arm", executable="tell", output="screen", arguments=["other"])
        result = await launch(failing, other, finder=ros)
        assert message in result.err
        assert "p.yaml:1" in result.err
        assert "[tell-1]: node has not started" in result.err
        assert "it has ended" in result.err
        assert result.err.count("process started") == 1
        assert "other" in result.out
        assert not result.succeeded

    async def test_hosted_node_with_malformed_parameter_file_does_not_start(self, launch, write: Write) -> None:
        path = write("p.yaml", "talker: 5")
        node = Node(package="demo_nodes_py", executable="talker", parameters=[str(path)])
        result = await launch(node, LogInfo(msg="the launch goes on"))
        assert "error[GRAPH212]" in result.err
        assert "started in the launcher's process" not in result.err
        assert "the launch goes on" in result.err
        assert not result.succeeded

    @pytest.mark.parametrize(
        ("section", "node", "message"),
        [
            ("tller", {"name": "teller"}, "did you mean '/tller'?"),
            ("teller", {"name": "teller", "namespace": "left"}, "has no section for node '/left/teller'"),
            ("left: {teller", {"name": "teller", "namespace": "left"}, ""),
            ("/**", {"name": "teller"}, ""),
            ("other", {}, ""),
        ],
    )
    async def test_parameter_file_without_section_for_node_is_reported(
        self, launch, ros: PackageFinder, write: Write, section: str, node: dict[str, str], message: str
    ) -> None:
        path = write("p.yaml", f"{section}: {{ros__parameters: {{a: 1}}}}" + "}" * section.count("{"))
        result = await launch(Node(package="arm", executable="tell", parameters=[str(path)], **node), finder=ros)
        assert ("warning[LAUNCH149]: parameter file" in result.err) is bool(message)
        assert message in result.err
        assert result.succeeded

    @pytest.mark.parametrize(
        ("package", "executable", "name"),
        [
            ("joint_state_publisher_gui", "joint_state_publisher_gui", "joint_state_publisher"),
            ("tf2_ros", "buffer_server", "tf_buffer"),
            ("tf2_ros", "tf2_monitor", "tf2_monitor_main"),
            ("image_tools", "cam2image", "cam2image"),
        ],
    )
    async def test_unnamed_node_reads_section_of_its_default_name(
        self, launch, write: Write, monkeypatch: pytest.MonkeyPatch, package: str, executable: str, name: str
    ) -> None:
        planned: list[HostedPlan] = []
        monkeypatch.setattr(NodeHost, "schedule_node", lambda _, plan: planned.append(plan))
        right = write("right.yaml", f"{name}: {{ros__parameters: {{a: 1}}}}\nother: {{ros__parameters: {{a: 2}}}}\n")
        other_file = write("wrong.yaml", f"{name}x: {{ros__parameters: {{b: 1}}}}\n")
        files = [str(right), str(other_file)]
        result = await launch(Node(package=package, executable=executable, parameters=files))
        assert [plan.parameters for plan in planned] == [{"a": 1}]
        assert result.err.count("warning[LAUNCH149]") == 1
        assert f"parameter file '{other_file}' has no section for node '/{name}'" in result.err

    async def test_temporary_files_are_removed_after_launch(self, launch, ros: PackageFinder) -> None:
        result = await launch(
            Node(package="arm", executable="tell", output="screen", parameters=[{"a": 1}]), finder=ros
        )
        (path,) = {word for word in result.out.replace('"', " ").split() if word.endswith(".yaml")}
        assert not Path(path).exists()  # noqa: ASYNC240

    async def test_node_without_package_runs_executable(self, launch) -> None:
        result = await launch(Node(executable=sys.executable, arguments=["-c", "print('here')"], output="screen"))
        assert result.out.endswith("] here\n")

    @pytest.mark.parametrize(
        ("package", "executable", "message", "hint"),
        [
            ("arm", "tel", "package 'arm' has no executable 'tel'", "did you mean 'tell'?"),
            ("arm", "xyzzy", "package 'arm' has no executable 'xyzzy'", "the package has tell"),
            ("amr", "tell", "package 'amr' of node executable 'tell' was not found", "did you mean 'arm'?"),
            ("robot_state_publishr", "x", "package 'robot_state_publishr'", "did you mean 'robot_state_publisher'"),
            ("rviz2", "rviz", "package 'rviz2' has no executable 'rviz'", "did you mean 'rviz2'?"),
            ("my_robot_description", "x", "has no executable 'x'", "add it to entry_points in setup.py"),
        ],
    )
    async def test_unknown_executables_are_reported_with_hint(
        self, launch, ros: PackageFinder, package: str, executable: str, message: str, hint: str
    ) -> None:
        result = await launch(Node(package=package, executable=executable), finder=ros)
        assert "error[LAUNCH131]" in result.err
        assert message in result.err
        assert hint in result.err
        assert "test_node.py" in result.err
        assert not result.succeeded


class TestHostedNodes:
    async def test_hosted_node_emits_events_and_logs_with_name(self, launch) -> None:
        node = Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            name="rsp",
            namespace="robot",
            parameters=[{"robot_description": URDF}],
        )
        result = await launch(
            node,
            RegisterEventHandler(OnProcessStart(target_action=node, on_start=[LogInfo(msg="started")])),
            RegisterEventHandler(OnProcessExit(target_action=node, on_exit=[LogInfo(msg="exited")])),
            TimerAction(period=0.05, actions=[Shutdown(reason="done")]),
        )
        assert result.messages == ["started", "exited"]
        assert "[INFO] [robot_state_publisher-1]: started in the launcher's process" in result.err
        assert "[robot_state_publisher-1] [INFO] [" in result.err
        assert "] [robot.rsp]: Robot initialized" in result.err
        assert node.node_name == "/robot/rsp"
        assert result.succeeded

    async def test_node_that_fails_to_start_is_reported(self, launch) -> None:
        result = await launch(
            Node(package="robot_state_publisher", executable="robot_state_publisher", on_exit=[LogInfo(msg="gone")]),
            LogInfo(msg="others go on"),
        )
        assert "error[NODE101]" in result.err
        assert "FATAL" not in result.err, "a FATAL message would report the same error twice"
        assert "[ERROR] [robot_state_publisher-1]: node has not started" in result.err
        assert result.messages == ["others go on", "gone"]
        assert not result.succeeded

    async def test_shutdown_process_ends_one_node(self, launch) -> None:
        node = Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=["--frame-id", "a", "--child-frame-id", "b"],
        )
        end = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(node)))
        result = await launch(node, TimerAction(period=0.02, actions=[end]))
        assert "[INFO] [static_transform_publisher-1]: has finished cleanly" in result.err
        assert result.succeeded

    async def test_parameter_file_reaches_hosted_node(self, launch, write: Write) -> None:
        path = write("p.yaml", "robot_state_publisher: {ros__parameters: {publish_frequency: 30.0}}")
        values_seen: list[float] = []

        def look(context: LaunchContext) -> None:
            for _, running in context.session.host._running.values():
                values_seen.append(running.node.get_parameter("publish_frequency").value)

        await launch(
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[str(path), {"robot_description": URDF}],
            ),
            TimerAction(period=0.02, actions=[OpaqueFunction(function=look), Shutdown()]),
        )
        assert values_seen == [30.0]

    async def test_source_positions_of_xacro_command_are_kept(self, launch, write: Write) -> None:
        path = write("r.urdf", "\n\n" + URDF)
        lines: list[int] = []

        def look(context: LaunchContext) -> None:
            (_, running), *_ = context.session.host._running.values()
            text = running.node.get_parameter("robot_description").value
            robot = context.session.descriptions.library.read(text).robot
            assert robot is not None
            span = robot.links["base"].element.span()
            assert span is not None
            assert span.file == str(path)
            lines.append(span.line)

        await launch(
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(Command(["xacro ", str(path)]), value_type=str)}],
            ),
            TimerAction(period=0.02, actions=[OpaqueFunction(function=look), Shutdown()]),
        )
        assert lines == [3]
