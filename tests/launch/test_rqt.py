"""Programs of rqt in launch files: they open panels of the launch's page."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.actions import IncludeLaunchDescription, LogInfo, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.events.process import ShutdownProcess
from launch_ros.actions import Node

from launch import LaunchContext
from linkwright.panels.requested_panels import RequestedPanelsFeature
from tests.launch.ending import end_when, has_printed, run_when

Write = Callable[[str, str], Path]


def make_rqt_node(name: str, *arguments: str, **options: Any) -> Node:
    return Node(package=name, executable=name, arguments=list(arguments), **options)


def end_node(node: Node) -> OpaqueFunction:
    """Return the action that ends a node."""
    event = ShutdownProcess(process_matcher=lambda action: action is node)
    return OpaqueFunction(function=lambda context: context.emit_event_sync(event))


class Panels:
    """The panels that the viewers of a launch have opened, as the launch ends."""

    def __init__(self, count: int) -> None:
        self._count = count
        self.opened: list[list[str]] = []

    def look(self, context: LaunchContext) -> bool:
        viewers = [viewer for _, viewer in context.session.host._viewers._viewers.values()]
        features = [viewer.add_feature(RequestedPanelsFeature) for viewer in viewers]
        self.opened = [[panel.panel for panel in feature._panels] for feature in features]
        return sum(map(len, self.opened)) >= self._count

    @property
    def ends_launch(self) -> OpaqueFunction:
        return end_when(self.look)


async def test_all_programs_open_panels_of_one_page(launch) -> None:
    panels = Panels(3)
    programs = [
        make_rqt_node("rqt_plot", "/odom/twist/twist/linear/x:y"),
        make_rqt_node("rqt_gui"),
        make_rqt_node("rqt_image_view", "/camera/image_raw"),
        make_rqt_node("rqt_graph"),
    ]
    result = await launch(*programs, panels.ends_launch)
    assert result.succeeded, result.err
    assert panels.opened == [["plot", "image", "graph"]]
    assert result.out.count("Viewer: ") == 1


@pytest.mark.parametrize("is_first", [True, False])
async def test_programs_use_the_page_of_rviz(launch, is_first: bool) -> None:
    panels = Panels(2)
    programs = [Node(package="rviz2", executable="rviz2"), make_rqt_node("rqt_topic"), make_rqt_node("rqt_console")]
    result = await launch(*(programs if is_first else reversed(programs)), panels.ends_launch)
    assert result.succeeded, result.err
    assert sorted(panels.opened[0]) == ["log", "topics"]
    assert result.out.count("Viewer: ") == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.launch.xml", '<launch><node pkg="rqt_plot" exec="rqt_plot" args="/a/x /a/y"/></launch>'),
        ("a.launch.yaml", "launch:\n- node: {pkg: rqt_plot, exec: rqt_plot, args: /a/x /a/y}\n"),
    ],
)
async def test_xml_and_yaml_files_open_panels(launch, write: Write, name: str, text: str) -> None:
    panels = Panels(1)
    result = await launch(IncludeLaunchDescription(str(write(name, text))), panels.ends_launch)
    assert result.succeeded, result.err
    assert panels.opened == [["plot"]]


async def test_unknown_argument_is_named_and_launch_continues(launch) -> None:
    result = await launch(make_rqt_node("rqt_graph", "--fast"), end_when(has_printed("has no argument")))
    assert result.succeeded, result.err
    assert "warning[LAUNCH144]: rqt_graph has no argument '--fast'" in result.err


async def test_programs_report_start_and_end(launch) -> None:
    panels = Panels(2)
    handlers = [
        RegisterEventHandler(OnProcessStart(on_start=lambda event, _: LogInfo(msg=f"started {event.process_name}"))),
        RegisterEventHandler(OnProcessExit(on_exit=lambda event, _: LogInfo(msg=f"ended {event.process_name}"))),
    ]
    result = await launch(*handlers, make_rqt_node("rqt_graph"), make_rqt_node("rqt_topic"), panels.ends_launch)
    assert sorted(result.messages) == [
        "ended rqt_graph-1",
        "ended rqt_topic-2",
        "started rqt_graph-1",
        "started rqt_topic-2",
    ]


async def test_launch_ends_with_its_last_program(launch) -> None:
    """The page serves the programs that remain, and ends with the last one."""
    panels = Panels(2)
    graph, topic = make_rqt_node("rqt_graph"), make_rqt_node("rqt_topic")

    one_ended = has_printed("[rqt_graph-1]: has finished cleanly")
    result = await launch(graph, topic, run_when(panels.look, end_node(graph)), run_when(one_ended, end_node(topic)))
    assert result.succeeded, result.err
    lines = [line for line in result.err.splitlines() if "has finished cleanly" in line]
    assert ["rqt_graph-1]" in lines[0], "rqt_topic-2]" in lines[1], "rqt_graph-1-page]" in lines[2]] == [True] * 3


async def test_programs_end_with_the_page_of_rviz(launch) -> None:
    panels = Panels(1)
    rviz = Node(package="rviz2", executable="rviz2")
    result = await launch(rviz, make_rqt_node("rqt_topic"), run_when(panels.look, end_node(rviz)))
    assert result.succeeded, result.err
    assert "[rqt_topic-2]: has finished cleanly" in result.err


@pytest.mark.parametrize(
    ("name", "replacement"),
    [
        ("rqt_action", "ros2 action list"),
        ("rqt_srv", "ros2 interface show"),
    ],
)
async def test_program_without_panel_is_skipped_with_its_replacement(launch, name: str, replacement: str) -> None:
    talker = Node(package="demo_nodes_cpp", executable="talker")
    result = await launch(make_rqt_node(name), talker, end_when(has_printed("Publishing", replacement)))
    assert result.succeeded, result.err
    (line,) = [line for line in result.err.splitlines() if replacement in line]
    assert f"the page has no panel that replaces '{name}'" in line


async def test_isolated_launch_opens_panels_in_its_page(launch) -> None:
    panels = Panels(1)
    result = await launch(make_rqt_node("rqt_graph"), panels.ends_launch, session_options={"isolate": True})
    assert result.succeeded, result.err
    assert panels.opened == [["graph"]]
