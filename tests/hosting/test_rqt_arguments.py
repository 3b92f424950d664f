"""The programs of rqt: the panel that each opens, and their arguments."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from linkwright.graph import Graph
from linkwright.hosting.panel_node import PanelNode
from linkwright.hosting.plans import HostedPlan, opens_page
from linkwright.hosting.rqt_arguments import format_usage, read_rqt_arguments
from linkwright.hosting.rqt_programs import PANEL_PROGRAMS, find_panel_program, find_replacement
from linkwright.nodes import NodeOptions
from linkwright.panels.panel_request import PanelRequest

IMAGE, TF = "rviz_default_plugins/Image", "rviz_default_plugins/TF"


async def make_node(program: str, *arguments: str, namespace: str = "/", **parameters: object) -> PanelNode:
    """Return the node of a program, which its arguments and parameters configure."""
    package = "rqt" if program == "rqt" else program
    graph = Graph()
    plan = HostedPlan(None, f"{program}-1", package, program, None, namespace)
    options = NodeOptions(namespace=namespace, arguments=list(arguments), parameters=dict(parameters))
    try:
        return PanelNode(graph, plan, options)
    finally:
        await graph.close()


@pytest.mark.parametrize(
    ("words", "request_"),
    [
        ("rqt_graph", PanelRequest("graph")),
        ("rqt_topic", PanelRequest("topics")),
        ("rqt_console", PanelRequest("log")),
        ("rqt_reconfigure", PanelRequest("parameters")),
        ("rqt_reconfigure talker", PanelRequest("parameters", node="/talker")),
        ("rqt_tf_tree", PanelRequest("displays", TF)),
        ("rqt_image_view camera/image_raw", PanelRequest("image", IMAGE, topic="/camera/image_raw")),
        ("rqt_image_view /a --ros-args -r /a:=/b", PanelRequest("image", IMAGE, topic="/b")),
        ("rqt_image_view", PanelRequest("displays", IMAGE)),
        ("image_view", PanelRequest("image", IMAGE, topic="/image")),
        ("image_view --ros-args -r image:=/camera/image_raw", PanelRequest("image", IMAGE, topic="/camera/image_raw")),
        ("rqt_plot", PanelRequest("plot")),
        ("rqt_plot /odom/x:y pose/z", PanelRequest("plot", fields=("/odom/x:y", "/pose/z"))),
        ("rqt", None),
        ("rqt_gui", None),
        ("rqt_bag", None),
        ("rqt_controller_manager", PanelRequest("controllers")),
        ("rqt_joint_trajectory_controller", PanelRequest("trajectories")),
        ("rqt_publisher", PanelRequest("publishers")),
        ("rqt_service_caller", PanelRequest("services")),
        ("rqt -s rqt_publisher/Publisher --force-discover", PanelRequest("publishers")),
        ("rqt --standalone rqt_graph.ros_graph.RosGraph", PanelRequest("graph")),
        ("rqt_gui -s rqt_image_view/ImageView --args /a", PanelRequest("image", IMAGE, topic="/a")),
        ("rqt -s rqt_plot --clear-config -e --args /a/x", PanelRequest("plot", fields=("/a/x",))),
        ("rqt_robot_steering", PanelRequest("teleop", topic="/cmd_vel")),
        ("rqt_robot_steering --ros-args -r cmd_vel:=/base/cmd_vel", PanelRequest("teleop", topic="/base/cmd_vel")),
    ],
)
async def test_program_opens_panel_with_its_arguments(words: str, request_: PanelRequest | None) -> None:
    node = await make_node(*words.split())
    assert node.requests == (() if request_ is None else (request_,))
    assert node.findings == []


async def test_topics_have_the_namespace_of_the_node() -> None:
    node = await make_node("rqt_image_view", "image_raw", namespace="/front")
    assert node.requests == (PanelRequest("image", IMAGE, topic="/front/image_raw"),)
    node = await make_node("rqt_plot", "odom/x", namespace="/front")
    assert node.requests == (PanelRequest("plot", fields=("/front/odom/x",)),)


async def test_parameters_of_rqt_robot_steering_configure_the_panel() -> None:
    limits = {"default_vx_max": 1, "default_vw_max": 1.5, "default_vx_min": -1.0}
    node = await make_node("rqt_robot_steering", default_topic="drive", default_stamped=True, **limits)
    assert node.requests == (PanelRequest("teleop", topic="/drive", stamped=True, linear=1.0, angular=1.5),)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("rqt_graph --depht 2", "rqt_graph has no argument '--depht'"),
        ("rqt_topic /a", "rqt_topic has no argument '/a'"),
        ("rqt_image_view /a /b", "rqt_image_view has no argument '/b'"),
        ("rqt -s", "argument '-s' of rqt needs a value"),
        ("rqt -s rqt_shell", "the page has no panel for the rqt plugin 'rqt_shell'"),
        ("rqt --perspective mine", "rqt ignores the perspective 'mine'"),
        ("rqt --perspective-file no.perspective", "cannot read the perspective 'no.perspective': No such file"),
        ("rqt_bag walk.mcap", "rqt_bag ignores 'walk.mcap'"),
    ],
)
async def test_argument_without_effect_is_named(words: str, message: str) -> None:
    node = await make_node(*words.split())
    assert str(node.findings[0].message).startswith(message)
    assert {finding.code for finding in node.findings} == {"LAUNCH144"}


PERSPECTIVE = {
    "groups": {
        "pluginmanager": {
            "keys": {
                "running-plugins": {
                    "repr": "{u'rqt_plot/Plot': [1, 2], 'rqt_image_view/ImageView': [1], 'rqt_shell/Shell': [1]}"
                }
            },
            "groups": {
                "plugin__rqt_plot__Plot__1": {
                    "groups": {"plugin": {"keys": {"topics": {"repr": "['/odom/x', '/a/y']"}}}}
                },
                "plugin__rqt_image_view__ImageView__1": {
                    "groups": {"plugin": {"keys": {"topic": {"repr": "u'/camera/image'"}}}}
                },
            },
        }
    }
}


async def test_perspective_file_opens_panels_of_its_plugins(tmp_path: Path) -> None:
    file = tmp_path / "robot.perspective"
    file.write_text(json.dumps(PERSPECTIVE))
    node = await make_node("rqt", "--perspective-file", str(file))
    assert node.requests == (
        PanelRequest("plot", fields=("/odom/x", "/a/y")),
        PanelRequest("plot"),
        PanelRequest("image", IMAGE, topic="/camera/image"),
    )
    assert [str(finding.message) for finding in node.findings] == [
        "the page has no panel for the rqt plugin 'rqt_shell/Shell'"
    ]


@pytest.mark.parametrize("text", ["[", "{}", '{"groups": 3}'])
async def test_file_that_is_no_perspective_is_named(tmp_path: Path, text: str) -> None:
    file = tmp_path / "robot.perspective"
    file.write_text(text)
    (finding,) = (await make_node("rqt", "--perspective-file", str(file))).findings
    assert str(finding.message).startswith(f"cannot read the perspective '{file}'")


def test_misspelled_option_has_a_suggestion() -> None:
    program = PANEL_PROGRAMS["rqt", "rqt"]
    (finding,) = read_rqt_arguments("rqt", program, ["--standalon"]).findings
    assert "'--standalone'" in (finding.hint or "")


def test_missing_programs_have_a_replacement() -> None:
    assert "ros2 action list" in (find_replacement("rqt_action") or "")
    assert "Panels" in (find_replacement("rqt_something_else") or "")
    assert find_replacement("plotjuggler") is None


def test_page_replaces_rviz_and_the_programs_of_the_table() -> None:
    assert opens_page("rviz2", "rviz2")
    assert all(opens_page(*program) for program in PANEL_PROGRAMS)
    assert not opens_page("rqt_shell", "rqt_shell")
    assert find_panel_program(None, "rqt") is None


def test_usage_names_the_arguments() -> None:
    assert "rqt_plot [TOPIC/FIELD" in format_usage("rqt_plot", PANEL_PROGRAMS["rqt_plot", "rqt_plot"])
    assert "[-s PLUGIN]" in format_usage("rqt", PANEL_PROGRAMS["rqt", "rqt"])
