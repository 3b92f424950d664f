"""The package of worlds: made by its tool, free of findings, and fit for the robot."""

from __future__ import annotations

import ast
import math
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

from linkwright.cli.command import main
from linkwright.descriptions import load
from tests.places import GAZEBO_PACKAGE, PACKAGE
from tests.repository_tools import TOOLS, load_tool

WORLDS = sorted((GAZEBO_PACKAGE / "worlds").glob("*.world"))
MODELS = sorted((GAZEBO_PACKAGE / "models").iterdir())
LAUNCH_FILES = sorted((GAZEBO_PACKAGE / "launch").glob("*.launch.py"))
ROBOT_HEIGHT_M = 0.4
START_RADIUS_M = 0.3
"""The radius of the free area around the origin in meters; mbot's radius is 0.2."""


@pytest.fixture(scope="module")
def tool() -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(TOOLS))
        yield load_tool("make_gazebo_worlds")


def test_files_match_generator_output(tool: ModuleType) -> None:
    written = tool.generate()
    for name, text in written.items():
        assert (GAZEBO_PACKAGE / name).read_text(encoding="utf-8") == text, name
    for folder in ("models", "worlds"):
        existing_files = {
            path.relative_to(GAZEBO_PACKAGE).as_posix() for path in (GAZEBO_PACKAGE / folder).rglob("*.*")
        }
        assert existing_files == {name for name in written if name.startswith(folder)}


def test_generator_check_reports_stale_file(
    tool: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(tool, "PACKAGE", tmp_path)
    assert tool.main(["--check"]) == 1
    assert "is stale" in capsys.readouterr().err
    assert tool.main([]) == 0
    assert tool.main(["--check"]) == 0


def test_worlds_are_those_of_the_documentation() -> None:
    names = {"empty", "obstacles", "house", "maze", "playground", "line_track", "table"}
    assert {path.stem for path in WORLDS} == names


@pytest.mark.parametrize("path", [*WORLDS, *(model / "model.sdf" for model in MODELS), GAZEBO_PACKAGE], ids=str)
def test_worlds_have_no_findings(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--strict", str(path)]) == 0
    shown = capsys.readouterr()
    assert "not found" not in shown.out + shown.err


@pytest.mark.parametrize("path", WORLDS, ids=lambda path: path.stem)
def test_robot_start_area_is_free(path: Path) -> None:
    for name, x, y, yaw, size in read_solid_boxes(path):
        # The origin in the axes of the box, and its distance from the box.
        forward, sideways = (-x * math.cos(yaw) - y * math.sin(yaw), x * math.sin(yaw) - y * math.cos(yaw))
        distance = math.hypot(max(abs(forward) - size[0] / 2, 0), max(abs(sideways) - size[1] / 2, 0))
        assert distance > START_RADIUS_M, name
    for include in ET.parse(path).getroot().iter("include"):
        x, y = map(float, include.findtext("pose", "0 0").split()[:2])
        assert math.hypot(x, y) > START_RADIUS_M + 0.4, include.findtext("name")


def read_solid_boxes(path: Path) -> Iterator[tuple[str, float, float, float, tuple[float, ...]]]:
    """Return the boxes of a world with which the robot can collide.

    Each has a name, x, y, yaw and size in meters and radians.
    """
    for model in ET.parse(path).getroot().iter("model"):
        model_x, model_y, model_z, _, _, model_yaw = map(float, model.findtext("pose", "0 0 0 0 0 0").split())
        cosine, sine = math.cos(model_yaw), math.sin(model_yaw)
        for collision in model.iter("collision"):
            text = collision.findtext("geometry/box/size")
            if text is None:
                continue
            x, y, z, _, _, yaw = map(float, collision.findtext("pose", "0 0 0 0 0 0").split())
            size = tuple(map(float, text.split()))
            if model_z + z - size[2] / 2 < ROBOT_HEIGHT_M:
                x, y = model_x + cosine * x - sine * y, model_y + sine * x + cosine * y
                yield f"{model.get('name')}/{collision.get('name')}", x, y, model_yaw + yaw, size


def test_maze_cells_are_reachable_and_one_is_exit() -> None:
    cell, size = 1.1, 9
    boxes = list(read_solid_boxes(GAZEBO_PACKAGE / "worlds" / "maze.world"))

    def is_open(start: tuple[int, int], end: tuple[int, int]) -> bool:
        x, y = ((a + b) / 2 * cell for a, b in zip(start, end, strict=True))
        for _, box_x, box_y, yaw, (length, width, _) in boxes:
            along_y = abs(math.sin(yaw)) > 0.5
            half_size = (width / 2, length / 2) if along_y else (length / 2, width / 2)
            if abs(x - box_x) < half_size[0] and abs(y - box_y) < half_size[1]:
                return False
        return True

    reached, pending, ways_out = {(0, 0)}, [(0, 0)], []
    while pending:
        current_cell = pending.pop()
        for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            neighbor = (current_cell[0] + step[0], current_cell[1] + step[1])
            if not is_open(current_cell, neighbor):
                continue
            if not all(0 <= value < size for value in neighbor):
                ways_out.append(neighbor)
            elif neighbor not in reached:
                reached.add(neighbor)
                pending.append(neighbor)
    assert len(reached) == size * size
    assert ways_out == [(size, size - 1)]


def test_bridge_covers_all_robot_topics() -> None:
    bridged = {entry["gz_topic_name"]: entry for entry in bridge_entries()}
    robot = load(
        PACKAGE / "urdf" / "mbot_gazebo.xacro",
        arguments={"camera": "true", "kinect": "true", "laser": "true", "simulator": "gz"},
    )
    topics = {
        element.text().strip()
        for extension in robot.extensions
        for element in extension.walk()
        if element.tag in ("topic", "odom_topic", "tf_topic")
    }
    topics = (topics - {"kinect"}) | {f"kinect/{name}" for name in ("image", "depth_image", "points", "camera_info")}
    assert set(bridged) == topics | {"clock", "camera/camera_info"}
    assert {name for name, entry in bridged.items() if entry["direction"] == "ROS_TO_GZ"} == {"cmd_vel"}


def bridge_entries() -> list[dict[str, Any]]:
    text = (GAZEBO_PACKAGE / "config" / "bridge.yaml").read_text(encoding="utf-8")
    return list(yaml.safe_load(text))


@pytest.mark.parametrize("name", ["mbot", "mbot_camera", "mbot_kinect", "mbot_laser"])
def test_rviz_topics_are_bridged(name: str) -> None:
    text = (GAZEBO_PACKAGE / "rviz" / f"{name}.rviz").read_text(encoding="utf-8")
    displays = yaml.safe_load(text)["Visualization Manager"]["Displays"]
    shown = {display["Topic"]["Value"].lstrip("/") for display in displays if "Topic" in display}
    assert shown <= {entry["ros_topic_name"] for entry in bridge_entries()}
    assert "odom" in shown


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=lambda path: path.name)
def test_manifest_declares_launch_file_dependencies(path: Path) -> None:
    manifest = ET.parse(GAZEBO_PACKAGE / "package.xml").getroot()
    named = {element.text for element in manifest.iter("exec_depend")} | {manifest.findtext("name")}
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported = {
        node.module.split(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module
    }
    required_packages = {
        node.args[0].value
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in ("FindPackageShare", "get_package_share_path")
        and isinstance(node.args[0], ast.Constant)
    }
    started = {
        keyword.value.value
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        for keyword in node.keywords
        if keyword.arg == "package" and isinstance(keyword.value, ast.Constant)
    }
    assert imported | required_packages | started <= named
