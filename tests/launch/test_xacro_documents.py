"""The functions of xacro that launch files in Python call."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from launch.actions import LogInfo, OpaqueFunction, Shutdown, TimerAction
from launch_ros.actions import Node

import xacro
from linkwright.diagnostics import LinkwrightError

Write = Callable[[str, str], Path]
MODEL = (
    '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    '<xacro:arg name="link" default="x"/><link name="$(arg link)"/></robot>'
)


def test_process_file_expands_model(write: Write) -> None:
    path = write("a.xacro", MODEL)
    assert '<link name="x"/>' in xacro.process_file(str(path)).toxml()
    assert '<link name="y"/>' in xacro.process_file(path, mappings={"link": "y"}).toprettyxml(indent="  ")
    assert '<link name="1"/>' in xacro.process(path, mappings={"link": 1})


def test_parse_and_process_doc_expand_model(write: Write) -> None:
    with write("a.xacro", MODEL).open() as file:
        document = xacro.parse(file)
    assert "$(arg link)" in document.toxml()
    xacro.process_doc(document, mappings={"link": "z"})
    assert '<link name="z"/>' in document.toxml()
    with pytest.raises(TypeError, match="expected a file or its path, got 3"):
        xacro.parse(3)


def test_xacro_error_has_location(write: Write) -> None:
    with pytest.raises(LinkwrightError) as caught:
        xacro.process_file(write("a.xacro", MODEL.replace("$(arg link)", "${nothing}")))
    assert caught.value.diagnostics[0].span is not None


async def test_opaque_function_builds_node_from_expanded_xacro(launch, write: Write) -> None:
    path = write("a.xacro", MODEL)

    def build(context: object) -> list[object]:
        text = xacro.process_file(str(path), mappings={"link": "base"}).toxml()
        node = Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": text}],
            on_exit=LogInfo(msg="over"),
        )
        return [node]

    def check(context: object) -> None:
        descriptions = context.session.descriptions
        (_, running), *_ = context.session.host._running.values()
        text = running.node.get_parameter("robot_description").value
        robot = descriptions.library.read(text).robot
        assert robot is not None
        assert robot.root == "base"

    result = await launch(
        OpaqueFunction(function=build), TimerAction(period=0.05, actions=[OpaqueFunction(function=check), Shutdown()])
    )
    assert result.succeeded, result.err


def test_parsed_document_depends_only_on_files(write: Write) -> None:
    with write("a.xacro", MODEL).open() as file:
        document = xacro.parse(file)
    xacro.process_doc(document)
    assert all(path.is_file() for path in document.expansion.dependencies)
