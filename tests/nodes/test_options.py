import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LogLevel
from linkwright.nodes import EXECUTABLES, NodeOptions
from linkwright.nodes.options import create_node
from linkwright.nodes.ros_arguments import split_ros_arguments
from tests.nodes.stage import joint, robot


@pytest.mark.parametrize("executable", EXECUTABLES, ids="/".join)
async def test_every_executable_starts_and_ends(stage, executable):
    options = NodeOptions(
        name="mine",
        namespace="/robot",
        parameters={"robot_description": robot(joint("a"))},
        arguments=["--frame-id", "a", "--child-frame-id", "b"] if executable[0] == "tf2_ros" else [],
        library=stage.library,
    )
    running = EXECUTABLES[executable](stage.graph, options)
    assert running.node.get_fully_qualified_name() == "/robot/mine"
    running.close()
    running.close()
    await stage.clock.advance(1.0)
    assert stage.graph.node_names() == ["/audience"]


def test_ros_arguments_are_told_from_others(tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text("node:\n  ros__parameters:\n    rate: 30\n    zeros: {a: 1.0}\n", encoding="utf-8")
    ros, others = split_ros_arguments(
        [
            *("robot.urdf", "--ros-args", "-r", "a:=b", "--remap", "__ns:=/x", "-p", "delta:=0.5"),
            *("--param", "s:=[a, b]", "--params-file", str(file), "--log-level", "node:=DEBUG", "--", "-r", "last"),
        ]
    )
    assert others == ["robot.urdf", "-r", "last"]
    assert ros.remappings == [("a", "b"), ("__ns", "/x")]
    assert ros.parameters == {"delta": 0.5, "s": ["a", "b"], "rate": 30, "zeros": {"a": 1.0}}
    assert ros.log_level is LogLevel.DEBUG


@pytest.mark.parametrize(
    ("arguments", "message", "hint"),
    [
        (["--remapp", "a:=b"], "unknown ROS argument '--remapp'", "did you mean '--remap'?"),
        (["-r"], "ROS argument '-r' needs a value", None),
        (["-r", "a=b"], "'a=b' is not a remapping rule", "write from:=to"),
        (["-p", "rate:30"], "'rate:30' is not a parameter", "write name:=value"),
        (["-p", "rate:=["], "the value of parameter 'rate' is not valid YAML: '['", None),
        (["--log-level", "loud"], "unknown log level 'loud'", "the levels are debug, info, warn, error, fatal"),
        (
            ["--params-file", "gone.yaml"],
            "parameter file 'gone.yaml' cannot be read: No such file or directory",
            None,
        ),
    ],
)
def test_wrong_ros_arguments(arguments, message, hint):
    with pytest.raises(LinkwrightError) as caught:
        split_ros_arguments(["--ros-args", *arguments])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.message, diagnostic.hint) == ("NODE001", message, hint)


@pytest.mark.parametrize("content", ["rate: 30", "node: {rate: 30}", "- a", "node: {ros__parameters: 3}", ""])
def test_parameter_files_of_another_form(tmp_path, content):
    path = tmp_path / "parameters.yaml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(LinkwrightError, match="has not the form of one"):
        split_ros_arguments(["--ros-args", "--params-file", str(path)])


def test_a_parameter_file_that_is_not_yaml(tmp_path):
    path = tmp_path / "parameters.yaml"
    path.write_text("a: [", encoding="utf-8")
    with pytest.raises(LinkwrightError, match="is not valid YAML"):
        split_ros_arguments(["--ros-args", "--params-file", str(path)])


async def test_the_log_level_reaches_the_node(graph):
    node, others = create_node(graph, NodeOptions(arguments=["--ros-args", "--log-level", "warn"]), "node")
    assert node.get_logger().level is LogLevel.WARN
    assert others == []
