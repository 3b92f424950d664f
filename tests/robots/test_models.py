"""mbot's five models are the tutorial's robot.

They are compared with recorded facts, and with the published files if these exist.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from linkwright.descriptions import load
from linkwright.packages import PackageFinder
from linkwright.urdf import Mesh, Robot, Visual
from tests.places import PACKAGE, PUBLISHED

TUTORIAL: dict[str, Any] = json.loads((Path(__file__).parent / "tutorial.json").read_text(encoding="utf-8"))
"""The published tutorial's models: numbers of joints and visuals, and the values of its .rviz file."""

WHEELS_AND_CASTERS = ["base_link", "left_wheel_link", "right_wheel_link", "front_caster_link", "back_caster_link"]
LINKS = {
    "mbot_base.urdf": WHEELS_AND_CASTERS,
    "mbot_with_camera.urdf": [*WHEELS_AND_CASTERS, "camera_link"],
    "mbot_with_kinect.urdf": [*WHEELS_AND_CASTERS, "kinect_link"],
    "mbot_with_laser.urdf": [*WHEELS_AND_CASTERS, "laser_link"],
    "mbot_base.xacro": [
        *WHEELS_AND_CASTERS,
        "base_link_upper",
        "kinect_link",
        "laser_link",
        "pillar_0.05_0.05",
        "pillar_-0.05_0.05",
        "pillar_-0.05_-0.05",
        "pillar_0.05_-0.05",
    ],
}
SENSORS = {
    "camera_gazebo.xacro": ("camera_gazebo", "camera_link", "camera"),
    "kinect_gazebo.xacro": ("kinect_gazebo", "kinect_link", "depth"),
    "lidar_gazebo.xacro": ("lidar_gazebo", "laser_link", "ray"),
    "imu_gazebo.xacro": ("imu_gazebo", "imu_link", "imu"),
}


def load_model(name: str) -> Robot:
    return load(PACKAGE / "urdf" / name)


@pytest.mark.parametrize("name", LINKS)
def test_models_have_expected_links(name: str) -> None:
    robot = load_model(name)
    assert robot.name == "mbot"
    assert robot.root == "base_link"
    assert sorted(robot.links) == sorted(LINKS[name])
    assert len(robot.joints) == len(robot.links) - 1
    assert all(len(link.visuals) == 1 for link in robot.links.values())


@pytest.mark.parametrize("name", LINKS)
def test_wheels_and_casters_rotate_about_y_and_rest_is_fixed(name: str) -> None:
    robot = load_model(name)
    turning = {joint.name for joint in robot.joints.values() if joint.type == "continuous"}
    assert turning == {"left_wheel_joint", "right_wheel_joint", "front_caster_joint", "back_caster_joint"}
    assert {robot.joints[joint].axis for joint in turning} == {(0.0, 1.0, 0.0)}
    assert {joint.type for joint in robot.joints.values()} <= {"continuous", "fixed"}
    assert {joint.parent for joint in robot.joints.values()} == {"base_link"}


@pytest.mark.parametrize("name", LINKS)
def test_wheels_and_casters_reach_same_ground(name: str) -> None:
    robot = load_model(name)
    assert robot.joints["left_wheel_joint"].origin.xyz == pytest.approx((0.0, 0.19, -0.05))
    assert robot.joints["right_wheel_joint"].origin.xyz == pytest.approx((0.0, -0.19, -0.05))
    wheel = robot.links["left_wheel_link"].visuals[0].geometry
    caster = robot.links["front_caster_link"].visuals[0].geometry
    ground = robot.joints["left_wheel_joint"].origin.xyz[2] - wheel.radius  # type: ignore[union-attr]
    assert robot.joints["front_caster_joint"].origin.xyz[2] - caster.radius == pytest.approx(ground)  # type: ignore[union-attr]


def test_upper_deck_is_centered_0_32_m_above_base_link() -> None:
    robot = load_model("mbot_base.xacro")
    joint = robot.joints["base_link_to_upper"]
    plate = robot.links["base_link_upper"].visuals[0]
    assert joint.origin.xyz[2] + plate.origin.xyz[2] == pytest.approx(0.32)
    assert plate.material is not None
    assert plate.material.rgba == (1.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("name", LINKS)
def test_visuals_except_mesh_have_color(name: str) -> None:
    for link in load_model(name).links.values():
        (visual,) = link.visuals
        colored = visual.material is not None and visual.material.rgba is not None
        assert colored != isinstance(visual.geometry, Mesh), link.name


@pytest.mark.parametrize("name", ["mbot_with_kinect.urdf", "mbot_base.xacro"])
def test_kinect_mesh_is_in_package(name: str) -> None:
    (visual,) = load_model(name).links["kinect_link"].visuals
    assert isinstance(visual.geometry, Mesh)
    finder = PackageFinder(start=PACKAGE, environment={})
    assert finder.resolve(visual.geometry.filename) == PACKAGE / "meshes" / "kinect.dae"


@pytest.mark.parametrize("name", SENSORS)
def test_sensor_macros_attach_sensor_to_link(name: str, tmp_path: Path) -> None:
    macro, link, kind = SENSORS[name]
    model = tmp_path / "robot.xacro"
    model.write_text(
        f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
          <xacro:include filename="$(find my_robot_description)/urdf/sensor/{name}"/>
          <link name="{link}"/>
          <xacro:{macro} link="{link}"/>
        </robot>""",
        encoding="utf-8",
    )
    robot = load(model, packages={"my_robot_description": PACKAGE})
    (gazebo,) = robot.extensions
    assert gazebo.attributes["reference"] == link
    sensor = next(gazebo.elements())
    assert sensor.attributes["type"] == kind


@pytest.mark.parametrize("name", LINKS)
def test_models_match_tutorial_facts(name: str) -> None:
    assert _robot_facts(load_model(name)) == _approximate(TUTORIAL["models"][name])


@pytest.mark.skipif(not PUBLISHED.is_dir(), reason="the published files of the tutorial are missing")
@pytest.mark.parametrize("name", LINKS)
def test_tutorial_facts_match_published_files(name: str) -> None:
    assert _robot_facts(load(PUBLISHED / "urdf" / name)) == TUTORIAL["models"][name]


def _robot_facts(robot: Robot) -> dict[str, Any]:
    return {"joints": _joint_facts(robot), "visuals": _visual_facts_by_link(robot)}


def _joint_facts(robot: Robot) -> dict[str, list[Any]]:
    return {
        name: [joint.type, joint.parent, joint.child, *joint.origin.xyz, *joint.origin.rpy, *joint.axis]
        for name, joint in robot.joints.items()
    }


def _visual_facts_by_link(robot: Robot) -> dict[str, list[Any]]:
    return {name: [_visual_facts(visual) for visual in link.visuals] for name, link in robot.links.items()}


def _visual_facts(visual: Visual) -> list[Any]:
    color = list(visual.material.rgba) if visual.material and visual.material.rgba else None
    shape = type(visual.geometry).__name__
    return [shape, *_shape_numbers(visual.geometry), *visual.origin.xyz, *visual.origin.rpy, visual.material_name, color]


def _shape_numbers(geometry: Any) -> list[Any]:
    values = [getattr(geometry, name) for name in geometry.__dataclass_fields__]
    return [number for value in values for number in (value if isinstance(value, tuple) else (value,))]


def _approximate(value: Any) -> Any:
    """Return the same structure; each number accepts a difference of a ten-millionth."""
    if isinstance(value, dict):
        return {key: _approximate(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(_approximate(item) for item in value)
    return pytest.approx(value, abs=1e-7) if isinstance(value, float) else value
