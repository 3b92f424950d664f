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
from launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.ros.parameters import evaluate_parameters
from linkwright.workspace import PackageFinder

Write = Callable[[str, str], Path]
URDF = '<robot name="r"><link name="base"/></robot>'


@pytest.fixture
def context() -> LaunchContext:
    made = LaunchContext()
    made.launch_configurations.update(number="3", truth="true", word="on", text="a: b", model="<robot> a: b\n</robot>")
    return made


def values(context: LaunchContext, *parameters: Any, node: str = "/talker") -> dict[str, Any]:
    return evaluate_parameters(context, parameters, node, None).values


class TestParameters:
    def test_python_values_stay_what_they_are(self, context: LaunchContext) -> None:
        given = {"a": 1, "b": 1.5, "c": True, "d": "true", "e": [1, 2], "f": ["x", "y"], "g": [1, 2.5], "h": ""}
        assert values(context, given) == {**given, "g": [1.0, 2.5]}

    def test_substitutions_follow_yaml(self, context: LaunchContext) -> None:
        found = values(
            context,
            {
                "a": LaunchConfiguration("number"),
                "b": LaunchConfiguration("truth"),
                "c": LaunchConfiguration("word"),
                "d": ["/", LaunchConfiguration("number")],
                "e": [[LaunchConfiguration("number")], ["y"]],
            },
        )
        assert found == {"a": 3, "b": True, "c": True, "d": "/3", "e": ["3", "y"]}

    @pytest.mark.parametrize(
        ("name", "kind", "value"),
        [
            ("number", None, 3),
            ("number", int, 3),
            ("number", float, 3.0),
            ("number", str, "3"),
            ("truth", bool, True),
            ("text", str, "a: b"),
            ("list", list[int], [1, 2]),
            ("list", list[float], [1.0, 2.0]),
            ("list", list[str], ["1", "2"]),
        ],
    )
    def test_typed_values(self, context: LaunchContext, name: str, kind: Any, value: Any) -> None:
        context.launch_configurations["list"] = "[1, 2]"
        found = values(context, {"p": ParameterValue(LaunchConfiguration(name), value_type=kind)})
        assert found == {"p": value}
        assert type(found["p"]) is type(value)

    def test_a_value_of_another_type(self, context: LaunchContext) -> None:
        with pytest.raises(LinkwrightError, match="not the int that is asked for"):
            values(context, {"p": ParameterValue(LaunchConfiguration("word"), value_type=int)})

    def test_nested_dictionaries_and_substituted_names(self, context: LaunchContext) -> None:
        found = values(context, {"zeros": {"joint": 1.0, ("n", LaunchConfiguration("number")): 2.0}, "a.b": 1})
        assert found == {"zeros.joint": 1.0, "zeros.n3": 2.0, "a.b": 1}

    def test_later_ones_win(self, context: LaunchContext) -> None:
        assert values(context, {"a": 1, "b": 1}, {"a": 2}, Parameter("b", 3)) == {"a": 2, "b": 3}

    def test_a_description_that_is_read_as_yaml_gives_one_error_with_the_fix(self, context: LaunchContext) -> None:
        with pytest.raises(LinkwrightError) as caught:
            values(context, {"robot_description": LaunchConfiguration("model")})
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "LAUNCH132"
        assert "parameter 'robot_description' is read as YAML" in diagnostic.message
        assert "ParameterValue(VALUE, value_type=str)" in (diagnostic.hint or "")
        assert diagnostic.span is not None
        assert diagnostic.span.file == __file__

    def test_a_description_without_colons_passes_unfolded(self, context: LaunchContext) -> None:
        text = '<robot name="r">\n  <link name="a"/>\n</robot>'
        context.launch_configurations["model"] = text
        assert values(context, {"robot_description": LaunchConfiguration("model")}) == {"robot_description": text}

    @pytest.mark.parametrize("value", ["{a: 1}", "[1, x]", "~"])
    def test_what_no_parameter_can_be(self, context: LaunchContext, value: str) -> None:
        context.launch_configurations["odd"] = value
        with pytest.raises(LinkwrightError, match="which no parameter can be"):
            values(context, {"p": LaunchConfiguration("odd")})

    def test_other_objects(self, context: LaunchContext) -> None:
        with pytest.raises(LinkwrightError, match="is of type object"):
            values(context, {"p": object()})
        with pytest.raises(LinkwrightError, match="is a Path") as caught:
            values(context, {"p": Path("/x")})
        assert caught.value.diagnostics[0].hint == "give it as text: str(PATH)"


class TestParameterFiles:
    FILE = """
/**:
  ros__parameters:
    everywhere: 1
    deep: {x: 1}
talker:
  ros__parameters: {own: 2}
/robot:
  talker:
    ros__parameters: {own: 3}
/robot/*:
  ros__parameters: {star: 4}
listener:
  ros__parameters: {own: 5}
"""

    @pytest.mark.parametrize(
        ("node", "expected"),
        [
            ("/talker", {"everywhere": 1, "deep.x": 1, "own": 2}),
            ("/robot/talker", {"everywhere": 1, "deep.x": 1, "own": 3, "star": 4}),
            ("/other", {"everywhere": 1, "deep.x": 1}),
        ],
    )
    def test_sections_by_name(self, context: LaunchContext, write: Write, node: str, expected: dict) -> None:
        path = write("p.yaml", self.FILE)
        assert values(context, str(path), node=node) == expected
        assert values(context, path, node=node) == expected
        assert values(context, ParameterFile(path), node=node) == expected

    def test_substitutions_inside(self, context: LaunchContext, write: Write) -> None:
        path = write(
            "p.yaml",
            "/**: {ros__parameters: {a: $(var number), b: $(env LW_NONE x), c: '$(var n$(var word) d)', "
            "d: $(find-pkg-share my_robot_description)}}",
        )
        found = values(context, ParameterFile(path, allow_substs=True))
        assert found["a"] == 3
        assert found["b"] == "x"
        assert found["c"] == "d"
        assert found["d"].endswith("my_robot_description")

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a: [", "is not YAML"),
            ("a: 1", "names no node with 'ros__parameters' below it"),
            ("/**: {ros__parameters: {a: $(var nmber)}}", "launch configuration 'nmber' is not set"),
            ("/**: {ros__parameters: {a: $(vra number)}}", "substitution '$(vra number)' is unknown"),
        ],
    )
    def test_faults(self, context: LaunchContext, write: Write, text: str, message: str) -> None:
        with pytest.raises(LinkwrightError) as caught:
            values(context, ParameterFile(write("p.yaml", text), allow_substs=True))
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "LAUNCH133"
        assert message in diagnostic.message
        assert diagnostic.span is not None

    def test_a_missing_file(self, context: LaunchContext, tmp_path: Path) -> None:
        with pytest.raises(LinkwrightError, match="does not exist"):
            values(context, str(tmp_path / "none.yaml"))

    def test_an_empty_file(self, context: LaunchContext, write: Write) -> None:
        assert values(context, str(write("p.yaml", ""))) == {}


@pytest.fixture
def ros(tmp_path: Path) -> PackageFinder:
    """A prefix with the package ``arm``, whose executable ``tell`` writes its command line as JSON."""
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
    async def told(self, launch, ros: PackageFinder, *entities: Any) -> tuple[list[str], list[Any]]:
        done = await launch(*entities, finder=ros)
        assert done.succeeded, done.err
        (line,) = done.out.splitlines()
        words, files = json.loads(line.partition("] ")[2])
        return words, [yaml.safe_load(files[word]) for word in words if word in files]

    async def test_command_line(self, launch, ros: PackageFinder) -> None:
        words, files = await self.told(
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
        assert words[:6] == ["--fast", "1", "--ros-args", "-r", "__node:=teller", "-r"]
        assert words[6] == "__ns:=/robot/left/inner"
        assert words[9:] == ["-r", "/a:=/b", "-r", "chatter:=/talk", "--log-level", "debug"]
        assert files == [{"/**": {"ros__parameters": {"global": 1, "own": 2}}}]

    async def test_no_ros_arguments_where_none_are_needed(self, launch, ros: PackageFinder) -> None:
        words, _ = await self.told(launch, ros, Node(package="arm", executable="tell", output="screen"))
        assert words == []

    async def test_an_absolute_namespace(self, launch, ros: PackageFinder) -> None:
        words, _ = await self.told(
            launch,
            ros,
            PushRosNamespace("robot"),
            Node(package="arm", executable="tell", output="screen", namespace="/own"),
        )
        assert words == ["--ros-args", "-r", "__ns:=/own"]

    async def test_parameter_files_are_passed_by_path(self, launch, ros: PackageFinder, write: Write) -> None:
        path = write("p.yaml", "/**: {ros__parameters: {a: 1}}")
        words, _ = await self.told(
            launch,
            ros,
            SetParametersFromFile(str(path)),
            Node(package="arm", executable="tell", output="screen", parameters=[str(path)]),
        )
        assert words == ["--ros-args", "--params-file", str(path), "--params-file", str(path)]

    async def test_temporary_files_go_with_the_launch(self, launch, ros: PackageFinder) -> None:
        done = await launch(Node(package="arm", executable="tell", output="screen", parameters=[{"a": 1}]), finder=ros)
        (path,) = {word for word in done.out.replace('"', " ").split() if word.endswith(".yaml")}
        assert not Path(path).exists()  # noqa: ASYNC240

    async def test_a_node_without_a_package(self, launch) -> None:
        done = await launch(Node(executable=sys.executable, arguments=["-c", "print('here')"], output="screen"))
        assert done.out.endswith("] here\n")

    @pytest.mark.parametrize(
        ("package", "executable", "message", "hint"),
        [
            ("arm", "tel", "package 'arm' has no executable 'tel'", "did you mean 'tell'?"),
            ("arm", "xyzzy", "package 'arm' has no executable 'xyzzy'", "it has: tell"),
            ("amr", "tell", "package 'amr' of node executable 'tell' not found", "did you mean 'arm'?"),
            ("robot_state_publishr", "x", "package 'robot_state_publishr'", "did you mean 'robot_state_publisher'"),
            ("rviz2", "rviz", "package 'rviz2' has no executable 'rviz'", "did you mean 'rviz2'?"),
            ("my_robot_description", "x", "has no executable 'x'", "build it with 'colcon build'"),
        ],
    )
    async def test_unknown_executables(
        self, launch, ros: PackageFinder, package: str, executable: str, message: str, hint: str
    ) -> None:
        done = await launch(Node(package=package, executable=executable), finder=ros)
        assert "error[LAUNCH131]" in done.err
        assert message in done.err
        assert hint in done.err
        assert "test_node.py" in done.err
        assert not done.succeeded


class TestHostedNodes:
    async def test_events_names_and_logs(self, launch) -> None:
        node = Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            name="rsp",
            namespace="robot",
            parameters=[{"robot_description": URDF}],
        )
        done = await launch(
            node,
            RegisterEventHandler(OnProcessStart(target_action=node, on_start=[LogInfo(msg="started")])),
            RegisterEventHandler(OnProcessExit(target_action=node, on_exit=[LogInfo(msg="exited")])),
            TimerAction(period=0.05, actions=[Shutdown(reason="done")]),
        )
        assert done.messages == ["started", "exited"]
        assert "[INFO] [robot_state_publisher-1]: started in the launcher's process" in done.err
        assert "[robot_state_publisher-1] [INFO] [" in done.err
        assert "] [robot.rsp]: Robot initialized" in done.err
        assert node.node_name == "/robot/rsp"
        assert done.succeeded

    async def test_a_node_that_cannot_start(self, launch) -> None:
        done = await launch(
            Node(package="robot_state_publisher", executable="robot_state_publisher", on_exit=[LogInfo(msg="gone")]),
            LogInfo(msg="others go on"),
        )
        assert "error[NODE101]" in done.err
        assert "[ERROR] [robot_state_publisher-1]: node has not started" in done.err
        assert done.messages == ["others go on", "gone"]
        assert not done.succeeded

    async def test_shutdown_process_ends_one(self, launch) -> None:
        node = Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=["--frame-id", "a", "--child-frame-id", "b"],
        )
        end = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(node)))
        done = await launch(node, TimerAction(period=0.02, actions=[end]))
        assert "[INFO] [static_transform_publisher-1]: has finished cleanly" in done.err
        assert done.succeeded

    async def test_parameters_of_a_file_reach_it(self, launch, write: Write) -> None:
        path = write("p.yaml", "robot_state_publisher: {ros__parameters: {publish_frequency: 30.0}}")
        seen: list[float] = []

        def look(context: LaunchContext) -> None:
            for _, running in context.session.host._running.values():
                seen.append(running.node.get_parameter("publish_frequency").value)

        await launch(
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[str(path), {"robot_description": URDF}],
            ),
            TimerAction(period=0.02, actions=[OpaqueFunction(function=look), Shutdown()]),
        )
        assert seen == [30.0]

    async def test_positions_of_a_command_reach_the_library(self, launch, write: Write) -> None:
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
