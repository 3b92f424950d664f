"""The conversion of an SDF model to a robot, as in ROS."""

from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from linkwright.descriptions import load
from linkwright.descriptions.service import DescriptionLibrary, examine_world
from linkwright.geometry.shapes import Box
from linkwright.geometry.single import IDENTITY, Transform, compose
from linkwright.sdf.frames import Frames, transform_of
from linkwright.sdf.from_urdf import model_from_robot
from linkwright.sdf.reader import read
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.to_urdf import robot_from_sdf
from linkwright.sdf.worlds import Sdf
from linkwright.urdf import Mesh, Mimic, Robot
from linkwright.urdf import read as read_urdf
from linkwright.urdf.plaintext import parse_as_urdfdom
from linkwright.urdf.writer import save

REPOSITORY = Path(__file__).parents[2]
ROBOTS = REPOSITORY / "robots"
PACKAGES = {"my_robot_description": ROBOTS / "my_robot_description"}
SHARED = REPOSITORY.parent / "shared" / "worlds"
BOX = "<geometry><box><size>1 2 3</size></box></geometry>"


def read_model(elements: str, start: str = "<model name='m'>"):
    text = f"<sdf version='1.11'>{start}{elements}</model></sdf>"
    document, _ = parse_as_gazebo(text.encode(), "robot.sdf")
    reading = read(document)
    assert reading.sdf is not None
    return robot_from_sdf(reading.sdf, document.root)


def convert_model(elements: str, start: str = "<model name='m'>") -> Robot:
    reading = read_model(elements, start)
    assert reading.diagnostics == ()
    assert reading.robot is not None
    return reading.robot


def test_link_frame_is_at_joint():
    robot = convert_model(
        "<link name='base'/>"
        f"<link name='arm'><pose>1 0 0 0 0 0</pose><visual name='v'>{BOX}<pose>0 0 0.5 0 0 0</pose></visual></link>"
        f"<joint name='j' type='prismatic'><pose>0 0 2 0 0 {pi / 2}</pose><parent>base</parent><child>arm</child>"
        "<axis><xyz expressed_in='__model__'>0 1 0</xyz><limit><lower>-1</lower><upper>2</upper></limit></axis></joint>"
    )
    joint, visual = robot.joints["j"], robot.links["arm"].visuals[0]
    assert joint.origin.xyz == pytest.approx((1.0, 0.0, 2.0))
    assert joint.axis == pytest.approx((1.0, 0.0, 0.0))
    assert (joint.limit.lower, joint.limit.upper) == (-1.0, 2.0)
    assert visual.origin.xyz == pytest.approx((0.0, 0.0, -1.5))
    assert visual.origin.rpy == pytest.approx((0.0, 0.0, -pi / 2))
    assert visual.geometry == Box((1.0, 2.0, 3.0))
    assert robot.links["arm"].inertial.origin.xyz == pytest.approx((0.0, 0.0, -2.0))


def test_joints_attach_to_frames_and_keep_urdf_properties():
    robot = convert_model(
        "<link name='a'/><link name='b'/><link name='c'/><frame name='hand' attached_to='a'/>"
        "<joint name='j' type='revolute'><parent>hand</parent><child>b</child><axis><xyz>0 0 1</xyz>"
        "<dynamics><damping>0.5</damping><friction>0.25</friction></dynamics></axis></joint>"
        "<joint name='k' type='revolute'><parent>b</parent><child>c</child><axis><xyz>0 0 1</xyz>"
        "<limit><lower>0</lower><upper>1</upper></limit>"
        "<mimic joint='j'><multiplier>2</multiplier><offset>1</offset>"
        "<reference>0.25</reference></mimic></axis></joint>"
    )
    first, second = robot.joints.values()
    assert (first.parent, first.type, first.limit) == ("a", "continuous", None)
    assert (first.dynamics.damping, first.dynamics.friction) == (0.5, 0.25)
    assert (second.type, second.mimic) == ("revolute", Mimic("j", 2.0, 0.5))


def test_unsupported_joints_become_floating_and_mesh_uris_are_preserved():
    robot = convert_model(
        "<link name='a'><visual name='v'><geometry><mesh><uri>model://m/a.dae</uri><scale>2 2 2</scale></mesh>"
        "</geometry>"
        "<material><ambient>1 0 0 1</ambient><diffuse>0.5 0 0 1</diffuse></material></visual></link><link name='b'/>"
        "<joint name='j' type='ball'><parent>a</parent><child>b</child></joint>"
    )
    visual = robot.links["a"].visuals[0]
    assert robot.joints["j"].type == "floating"
    assert visual.geometry == Mesh("model://m/a.dae", (2.0, 2.0, 2.0))
    assert visual.material.rgba == pytest.approx((0.8, 0.0, 0.0, 1.0))
    assert list(robot.materials) == [visual.material_name] == ["av"]


TWO_LINKS = "<link name='a'/><link name='b'/>"


def joint_text(parent: str, child: str, name: str = "j") -> str:
    return f"<joint name='{name}' type='fixed'><parent>{parent}</parent><child>{child}</child></joint>"


@pytest.mark.parametrize(
    ("inside", "start", "message"),
    [
        (TWO_LINKS, "<model name='m'>", "neither link 'b' nor the root link 'a' has a parent"),
        (TWO_LINKS + joint_text("b", "a"), "<model name='m'>", "the canonical link 'a' is the child of joint 'j'"),
        (
            TWO_LINKS + joint_text("a", "b") + joint_text("a", "b", "k"),
            "<model name='m'>",
            "link 'b' is the child of two joints",
        ),
        (TWO_LINKS + joint_text("world", "a"), "<model name='m'>", "joint 'j' connects the model to the world"),
        (
            TWO_LINKS + "<link name='c'/>" + joint_text("b", "c") + joint_text("c", "b", "k"),
            "<model name='m'>",
            "link 'b' is its own descendant in the tree of joints",
        ),
        (
            "<pose>1 0 0 0 0 0</pose><link name='a'/>",
            "<model name='m'>",
            "the model has a <pose>, which URDF does not support",
        ),
        ("<link name='a'/><model name='in'><link name='x'/></model>", "<model name='m'>", "contains another model"),
        ("", "<model name='m'>", "the model has no link"),
        (
            "<link name='a'><collision name='floor'><geometry><plane/></geometry></collision></link>",
            "<model name='m'>",
            "'floor' has the shape <plane>",
        ),
        (
            TWO_LINKS + "<joint name='j' type='revolute'><parent>a</parent><child>b</child></joint>",
            "<model name='m'>",
            "joint 'j' has no <axis>",
        ),
        ("<link name='a'/></model><model name='n'><link name='a'/>", "<model name='m'>", "it contains 2 models"),
        (TWO_LINKS + joint_text("a", "nowhere"), "<model name='m'>", "there is no frame 'nowhere'"),
    ],
)
def test_model_unsuitable_as_robot_is_rejected_once_with_location(inside, start, message):
    reading = read_model(inside, start)
    assert reading.robot is None
    (diagnostic,) = reading.diagnostics
    assert diagnostic.code == "SDF180"
    assert message in str(diagnostic.message)
    assert diagnostic.span is not None


def test_canonical_link_becomes_root():
    robot = convert_model(TWO_LINKS + joint_text("b", "a"), "<model name='m' canonical_link='b'>")
    assert robot.root == "b"


def test_description_topic_can_contain_sdf():
    library = DescriptionLibrary()
    text = f"<?xml version='1.0'?>\n<sdf version='1.9'><model name='m'>{TWO_LINKS}{joint_text('a', 'b')}</model></sdf>"
    reading = library.read(text)
    assert reading.robot is not None
    assert list(reading.robot.links) == ["a", "b"]
    assert library.read("<sdf version='1.9'><model name='m'/></sdf>").robot is None


def _link_poses(robot: Robot, root: Transform) -> dict[str, Transform]:
    """Return the poses of links with all joints at zero."""
    poses, remaining_joints = {robot.root: root}, list(robot.joints.values())
    while remaining_joints:
        joint = next(joint for joint in remaining_joints if joint.parent in poses)
        remaining_joints.remove(joint)
        poses[joint.child] = compose(poses[joint.parent], transform_of(joint.origin))
    return poses


def test_urdf_survives_conversion_to_sdf_and_back():
    original = load(ROBOTS / "my_robot_description/urdf/mbot_gazebo.xacro", packages=PACKAGES)
    model = model_from_robot(original, lump_fixed_joints=False).model
    converted = robot_from_sdf(Sdf("1.11", models=(model,)), original.element).robot
    assert (set(converted.links), set(converted.joints)) == (set(original.links), set(original.joints))
    first, second = _link_poses(original, IDENTITY), _link_poses(converted, IDENTITY)
    for name, pose in first.items():
        assert second[name] == pytest.approx(pose, abs=1e-9)
    assert {joint.name: joint.type for joint in original.joints.values()} == {
        joint.name: joint.type for joint in converted.joints.values()
    }
    saved_robot = read_urdf(parse_as_urdfdom(save(converted), "robot.urdf")[0]).robot
    assert (list(saved_robot.links), list(saved_robot.joints)) == (list(converted.links), list(converted.joints))


@pytest.mark.skipif(not SHARED.is_dir(), reason="the collection of models is missing")
def test_visuals_of_shared_models_keep_poses():
    robots = 0
    for path in sorted(SHARED.rglob("model*.sdf")):
        sdf = examine_world(path).sdf
        if not sdf.models:
            continue
        reading, model = robot_from_sdf(sdf, sdf.models[0].element), sdf.models[0]
        if reading.robot is None:
            assert [diagnostic.code for diagnostic in reading.diagnostics] == ["SDF180"]
            continue
        robots += 1
        frames = Frames(model)
        link_poses = _link_poses(reading.robot, frames.pose(reading.robot.root))
        for link in model.links:
            for old, new in zip(link.visuals, reading.robot.links[link.name].visuals, strict=True):
                expected = compose(frames.pose(link.name), frames.in_link(old.pose, link.name))
                link_pose = compose(link_poses[link.name], transform_of(new.origin))
                assert link_pose[:3] == pytest.approx(expected[:3], abs=1e-9)
                assert abs(sum(a * b for a, b in zip(link_pose[3:], expected[3:], strict=True))) == pytest.approx(1.0)
    assert robots > 0
