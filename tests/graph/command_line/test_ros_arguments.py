"""The `--ros-args` of a command line: remappings, parameters and logging."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LogLevel
from linkwright.graph.command_line.ros_arguments import RemapRule, parse, remove_ros_arguments


def test_ros_arguments_are_separated_from_other_arguments(tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text("node:\n  ros__parameters:\n    rate: 30\n    zeros: {a: 1.0}\n", encoding="utf-8")
    words = [
        *("robot.urdf", "--ros-args", "-r", "a:=b", "--remap", "__ns:=/x", "-p", "delta:=0.5"),
        *("--param", "s:=[a, b]", "--params-file", str(file), "--log-level", "node:=DEBUG", "--", "-r", "last"),
        *("--ros-args", "-r", "c:=d"),
    ]
    ros = parse(words)
    assert ros.non_ros_arguments == ["robot.urdf", "-r", "last"]
    assert ros.remappings_for("node") == [("a", "b"), ("__ns", "/x"), ("c", "d")]
    assert ros.parameters_for("/node") == {"delta": 0.5, "s": ["a", "b"], "rate": 30, "zeros.a": 1.0}
    assert ros.parameters_for("/x/node") == {"delta": 0.5, "s": ["a", "b"]}
    assert (ros.log_level, ros.log_levels) == (None, {"node": LogLevel.DEBUG})
    assert remove_ros_arguments(words) == ros.non_ros_arguments


def test_remap_rules_and_parameters_can_target_one_node():
    ros = parse(
        [
            *("--ros-args", "-r", "talker:chatter:=/c", "-r", "talker:__ns:=/t", "-r", "x:=y", "-r", "talker:/a:=/b"),
            *("-r", "rostopic://s:=t", "-r", "talker:rosservice://s:=t"),
            *("-p", "talker:rate:=3", "-p", "/robot/talker:rate:=4", "-p", "/**:all:=true", "-p", "a.b:=yes"),
        ]
    )
    assert ros.remap_rules[0] == RemapRule("talker", "chatter", "/c")
    assert ros.remappings_for("talker") == [
        *(("chatter", "/c"), ("__ns", "/t"), ("x", "y"), ("/a", "/b"), ("rostopic://s", "t"), ("rosservice://s", "t")),
    ]
    assert ros.remappings_for("listener") == [("x", "y"), ("rostopic://s", "t")]
    assert ros.parameters_for("/talker") == {"rate": 3, "all": True, "a.b": True}
    assert ros.parameters_for("/robot/talker") == {"rate": 4, "all": True, "a.b": True}


def test_logging_and_enclave_arguments_are_parsed():
    ros = parse(
        [
            *("--ros-args", "--log-level", "warn", "--log-config-file", "log.conf", "--enclave", "/a/b"),
            *("--disable-rosout-logs", "--enable-stdout-logs", "--disable-external-lib-logs"),
        ]
    )
    assert ros.log_level is LogLevel.WARN
    assert (ros.log_config_file, ros.enclave) == ("log.conf", "/a/b")
    assert (ros.rosout_logs, ros.stdout_logs, ros.external_lib_logs) == (False, True, False)
    assert parse([]).rosout_logs is None


@pytest.mark.parametrize(
    ("arguments", "message", "hint"),
    [
        (["--remapp", "a:=b"], "unknown ROS argument '--remapp'", "did you mean '--remap'?"),
        (["a:=b"], "unknown ROS argument 'a:=b'", "write -p a:=b or -r a:=b"),
        (["__node:=b"], "unknown ROS argument '__node:=b'", "write -r __node:=b"),
        (["-r"], "ROS argument '-r' needs a value", "write -r from:=to"),
        (["-p", "--"], "ROS argument '-p' needs a value", "write -p name:=value"),
        (["-r", "a=b"], "'a=b' is not a remapping rule", "write from:=to"),
        (["-p", "rate:30"], "'rate:30' is not a parameter", "write name:=value"),
        (
            ["--log-level", "loud"],
            "unknown log level 'loud'",
            "the levels are unset, debug, info, warn, error, fatal",
        ),
        (["--log-level", "a:=debgu"], "unknown log level 'debgu'", "did you mean 'debug'?"),
        (["-e", "x"], "'x' is not a valid enclave", "write a name that begins with a slash, such as /robot/talker"),
    ],
)
def test_invalid_ros_arguments_are_rejected(arguments, message, hint):
    with pytest.raises(LinkwrightError) as caught:
        parse(["--ros-args", *arguments])
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.message, diagnostic.hint) == ("GRAPH221", message, hint)


def test_missing_parameter_files_and_invalid_values_are_rejected(tmp_path):
    with pytest.raises(LinkwrightError, match=r"parameter file '.*gone.yaml' does not exist"):
        parse(["--ros-args", "--params-file", str(tmp_path / "gone.yaml")])
    with pytest.raises(LinkwrightError, match="parameter file is not YAML"):
        parse(["--ros-args", "-p", "rate:=["])
