"""Component containers, and the nodes that a launch loads into them."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.actions import GroupAction, OpaqueFunction, SetLaunchConfiguration, Shutdown, TimerAction
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration
from launch_ros.actions import (
    ComposableNodeContainer,
    LoadComposableNodes,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
)
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request
from launch_ros.descriptions import ComposableNode, ParameterValue
from launch_ros.utilities import get_node_name_count

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder
from tests.launch.ending import end_when, has_printed, run_when

Write = Callable[[str, str], Path]
URDF = '<robot name="r"><link name="base"/></robot>'


def make_container(*nodes: ComposableNode, **options: Any) -> ComposableNodeContainer:
    options.setdefault("namespace", "")
    return ComposableNodeContainer(
        package="rclcpp_components",
        executable="component_container",
        name="box",
        composable_node_descriptions=list(nodes),
        **options,
    )


def make_talker(**options: Any) -> ComposableNode:
    return ComposableNode(package="composition", plugin="composition::Talker", **options)


def load_request(node: ComposableNode, *actions: Any, **configurations: str) -> Any:
    context = LaunchContext()
    context.launch_configurations.update(configurations)
    for action in actions:
        action.execute(context)
    return get_composable_node_load_request(node, context)


class TestRequests:
    def test_load_request_contains_names_and_remap_rules(self) -> None:
        request = load_request(
            make_talker(name="tk", namespace="inner", remappings=[("chatter", "talk")]),
            PushRosNamespace("outer"),
            SetRemap("a", "b"),
        )
        assert (request.package_name, request.plugin_name) == ("composition", "composition::Talker")
        assert (request.node_name, request.node_namespace) == ("tk", "/outer/inner")
        assert list(request.remap_rules) == ["a:=b", "chatter:=talk"]

    def test_parameters_are_merged_in_order(self, write: Write) -> None:
        path = write("p.yaml", "/ns/tk: {ros__parameters: {c: 9}}\n/**: {ros__parameters: {c: 1, d: [1.5]}}\n")
        request = load_request(
            make_talker(name="tk", namespace="ns", parameters=[{"b": {"x": LaunchConfiguration("v")}}, path]),
            SetParameter("a", "text"),
            SetParametersFromFile(str(path)),
            v="true",
        )
        parameters = [(parameter.name, parameter.value) for parameter in request.parameters]
        assert [name for name, _ in parameters] == ["a", "c", "d", "b.x", "c", "d"]
        assert parameters[0][1].string_value == "text"
        # The name of a node takes precedence over a pattern, in any order.
        assert parameters[1][1].integer_value == 9
        assert list(parameters[2][1].double_array_value) == [1.5]
        assert parameters[3][1].bool_value is True

    def test_extra_arguments_are_passed(self) -> None:
        request = load_request(make_talker(extra_arguments=[{"use_intra_process_comms": True}]))
        assert request.extra_arguments[0].name == "use_intra_process_comms"
        assert request.extra_arguments[0].value.bool_value is True

    def test_false_condition_skips_component(self) -> None:
        assert load_request(make_talker(condition=IfCondition("false"))) is None

    def test_malformed_wildcard_in_parameter_file_is_rejected(self, write: Write) -> None:
        path = write("p.yaml", "/***: {ros__parameters: {a: 1}}")
        with pytest.raises(RuntimeError) as caught:
            load_request(make_talker(name="tk", parameters=[str(path)]))
        assert isinstance(caught.value, LinkwrightError)
        assert "'/***' is not a node name" in caught.value.diagnostics[0].message

    @pytest.mark.parametrize(
        ("section", "names", "message"),
        [
            ("/tkr", {"name": "tk"}, "has no section for node"),
            ("/tk", {"name": "tk", "namespace": "ns"}, "has no section for node '/ns/tk'"),
            ("/ns/tk", {"name": "tk", "namespace": "ns"}, ""),
            ("/**", {"name": "tk"}, ""),
            ("/other", {}, ""),  # the default name, which the code of the node sets, is unknown
        ],
    )
    def test_parameter_file_without_section_for_node_is_reported(
        self, write: Write, capsys: pytest.CaptureFixture[str], section: str, names: dict[str, str], message: str
    ) -> None:
        path = write("p.yaml", f"{section}: {{ros__parameters: {{a: 1}}}}")
        load_request(make_talker(parameters=[str(path)], **names))
        output = capsys.readouterr().err
        assert ("warning[LAUNCH149]" in output) is bool(message)
        assert message in output
        assert not message or "test_components.py" in output


class TestContainers:
    async def test_builtin_components_run_in_launcher_process(self, launch) -> None:
        components: dict[str, Any] = {}

        def look(context: LaunchContext) -> None:
            components["nodes"] = context.session.host.graph.node_names()
            components["counts"] = [
                get_node_name_count(context, name) for name in ("/ns/box", "/a/tk", "/robot_state_publisher")
            ]

        result = await launch(
            make_container(
                make_talker(name="tk", namespace="a"),
                ComposableNode(
                    package="robot_state_publisher",
                    plugin="robot_state_publisher::RobotStatePublisher",
                    parameters=[{"robot_description": URDF}],
                ),
                ComposableNode(
                    package="tf2_ros",
                    plugin="tf2_ros::StaticTransformBroadcasterNode",
                    name="fixed",
                    parameters=[{"frame_id": "a", "child_frame_id": "b", "translation.x": 1.5, "rotation.w": 1.0}],
                ),
                namespace="ns",
            ),
            run_when(
                has_printed("translation: (", "Robot initialized", "'/a/tk'", "'/fixed'", "'/robot_state_publisher'"),
                OpaqueFunction(function=look),
                Shutdown(),
            ),
        )
        assert result.succeeded, result.err
        assert {"/ns/box", "/a/tk", "/robot_state_publisher", "/fixed"} <= set(components["nodes"])
        assert components["counts"] == [1, 1, 1]
        assert "Loaded node '/a/tk' in container '/ns/box'" in result.err
        assert "[component_container-1] [INFO] [" in result.err
        assert "] [robot_state_publisher]: Robot initialized" in result.err
        assert "translation: ('1.500000', '0.000000', '0.000000')" in result.err
        assert "[launch] [" not in result.err

    async def test_components_are_loaded_into_container_by_name(self, launch) -> None:
        listener = ComposableNode(package="composition", plugin="composition::Listener", name="ear")
        result = await launch(
            LoadComposableNodes(target_container="box", composable_node_descriptions=[listener]),
            TimerAction(period=0.1, actions=[make_container()]),
            end_when(has_printed("Loaded node")),
        )
        assert "Loaded node '/ear' in container '/box'" in result.err

    async def test_launch_scope_applies_to_components_loaded_later(self, launch) -> None:
        group = GroupAction(
            [
                SetLaunchConfiguration("name", "inside"),
                PushRosNamespace("scope"),
                make_container(make_talker(name=LaunchConfiguration("name"), namespace="n")),
            ]
        )
        result = await launch(group, end_when(has_printed("Loaded node")))
        assert "Loaded node '/scope/n/inside' in container '/scope/box'" in result.err

    async def test_unknown_plugin_suggests_name_and_line(self, launch) -> None:
        misspelled = ComposableNode(package="composition", plugin="composition::Talkr", name="tk")
        result = await launch(
            make_container(misspelled, make_talker(name="other")), end_when(has_printed("LAUNCH139", "Loaded node"))
        )
        assert (
            "error[LAUNCH139]: Failed to load node 'tk' of type 'composition::Talkr' in container '/box'" in result.err
        )
        assert "did you mean 'composition::Talker'" in result.err
        assert "test_components.py" in result.err
        assert "Loaded node '/other' in container '/box'" in result.err
        assert not result.succeeded

    async def test_shutdown_abandons_wait_for_container(self, launch) -> None:
        result = await launch(
            LoadComposableNodes(target_container="/nobody", composable_node_descriptions=[make_talker()]),
            TimerAction(period=0.1, actions=[Shutdown()]),
        )
        assert "Abandoning wait for the '/nobody/_container/load_node' service, due to shutdown." in result.err

    async def test_duplicate_node_names_are_reported(self, launch) -> None:
        result = await launch(make_container(make_talker(name="box")), end_when(has_printed("there are now at least")))
        assert "there are now at least 2 nodes with the name /box created within this launch context" in result.err

    async def test_container_lists_and_unloads_nodes(self, launch) -> None:
        responses: list[Any] = []

        def ask(context: LaunchContext) -> None:
            node = context.session.host.launcher_node

            async def work() -> None:
                for kind, name, fill in (
                    ("ListNodes", "list_nodes", None),
                    ("UnloadNode", "unload_node", 7),
                    ("UnloadNode", "unload_node", 1),
                    ("ListNodes", "list_nodes", None),
                ):
                    client = node.create_client(f"composition_interfaces/srv/{kind}", f"/box/_container/{name}")
                    request = client.srv_type.Request()
                    if fill is not None:
                        request.unique_id = fill
                    responses.append(await client.call_async(request))

            context.session.spawn(work())

        await launch(
            make_container(make_talker(name="a"), make_talker(name="b")),
            run_when(has_printed("Loaded node '/b'"), OpaqueFunction(function=ask)),
            end_when(lambda _: len(responses) == 4),
        )
        listed, missing, unloaded, remaining = responses
        assert list(listed.full_node_names) == ["/a", "/b"]
        assert list(listed.unique_ids) == [1, 2]
        assert missing.success is False
        assert missing.error_message == "No node found with unique_id: 7"
        assert unloaded.success is True
        assert list(remaining.full_node_names) == ["/b"]

    async def test_composed_model_is_reloaded(self, launch, write: Write) -> None:
        path = write("r.urdf", URDF)
        texts: list[str] = []

        def description(context: LaunchContext) -> str:
            ((_, box),) = context.session.host._running.values()
            (node,) = box.loaded.values()
            return node.node.get_parameter("robot_description").value

        def is_reloaded(context: LaunchContext) -> bool:
            """Save the file until the change is noticed.

            Watching begins after the node is loaded.
            """
            if not texts:
                return False
            if not path.read_text().count("trunk") or time.time() - path.stat().st_mtime > 1.0:
                path.write_text(URDF.replace("base", "trunk"))
            return description(context) != texts[0]

        def look(context: LaunchContext) -> None:
            texts.append(description(context))

        model = ParameterValue(Command(["xacro ", str(path)]), value_type=str)
        publisher = ComposableNode(
            package="robot_state_publisher",
            plugin="robot_state_publisher::RobotStatePublisher",
            parameters=[{"robot_description": model}],
        )
        await launch(
            make_container(publisher),
            run_when(has_printed("Loaded node"), OpaqueFunction(function=look)),
            run_when(is_reloaded, OpaqueFunction(function=look), Shutdown()),
        )
        assert '"base"' in texts[0]
        assert '"trunk"' in texts[1]

    async def test_installed_container_is_used_for_foreign_components(self, launch, write: Write) -> None:
        write("ros/share/rclcpp_components/package.xml", "<package><name>rclcpp_components</name></package>")
        real = write("ros/lib/rclcpp_components/component_container", "#!/bin/sh\necho real $@\n")
        real.chmod(0o755)
        prefix = real.parents[2]
        finder = PackageFinder(start=prefix, environment={"AMENT_PREFIX_PATH": str(prefix)})
        theirs = ComposableNode(package="camera", plugin="camera::Driver")
        result = await launch(
            make_container(theirs, output="screen"), end_when(has_printed("real --ros")), finder=finder
        )
        assert "[component_container-1] real --ros-args -r __node:=box -r __ns:=/" in result.out
        result = await launch(
            make_container(make_talker()), end_when(has_printed("started in the launcher")), finder=finder
        )
        assert "[component_container-1]: started in the launcher's process" in result.err
