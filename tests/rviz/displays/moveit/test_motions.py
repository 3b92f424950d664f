"""Trajectory, RobotState and MotionPlanning."""

from __future__ import annotations

import math
from contextlib import asynccontextmanager

import pytest

from linkwright.descriptions import DescriptionLibrary
from linkwright.messages import get_message
from linkwright.page.files import MeshIndex
from linkwright.rviz.displays.moveit.robot import PosableRobot, UnusableStateError
from linkwright.rviz.displays.moveit.trajectory import compute_display_time_s, read_motion
from tests.rviz.displays.moveit.arm import (
    ARM,
    ObjectColor,
    make_attached_object,
    make_collision_object,
    make_config,
    make_robot_state,
    make_scene,
    make_trajectory,
)
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world
from tests.waiting import eventually

TOPIC = "/display_planned_path"
SLOW = ", State Display Time: 1000s"
FAST = ", State Display Time: 0.001s"
DisplayRobotState = get_message("moveit_msgs/msg/DisplayRobotState")


@asynccontextmanager
async def open_display(cls: str, message_type: str, topic: str, extra: str = ""):
    """Return a display and two functions.

    One publishes to the display, and the other returns the drawn markers.
    """
    async with open_world(make_config(cls, extra)) as world:
        world.describe(ARM)
        publisher = world.graph.create_node("talker").create_publisher(message_type, topic, 10)
        await world.settle()

        async def publish_and_settle(message) -> dict[str, dict]:
            publisher.publish(message)
            await world.settle()
            return shown_markers(world.viewer.displays[0])

        yield world, publish_and_settle


def moving_trajectory(extra: str = ""):
    return open_display("Trajectory", "moveit_msgs/msg/DisplayTrajectory", TOPIC, extra)


def robot_drawing() -> PosableRobot:
    return PosableRobot(DescriptionLibrary().read(ARM).robot, MeshIndex(None))


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("3x", 0.2), ("0.05 s", 0.05), ("0.05s", 0.05), ("0.1", 0.1), ("REALTIME", 0.6), ("0x", 0.2), ("soon", 0.2)],
)
def test_state_display_time_is_parsed(text, seconds):
    assert compute_display_time_s(text, 0.6) == pytest.approx(seconds)


def test_motion_starts_at_start_state_and_keeps_other_joints():
    motion = read_motion(robot_drawing(), make_trajectory(0.5, 1.0))
    assert [state.values for state in motion.states] == [
        {"shoulder": 0.0, "wrist": 0.5},
        {"shoulder": 0.5, "wrist": 0.5},
        {"shoulder": 1.0, "wrist": 0.5},
    ]
    assert motion.durations == pytest.approx([0.1, 0.1])
    assert motion.joints == {"shoulder"}


def test_invalid_motions_are_rejected():
    with pytest.raises(UnusableStateError, match="no states"):
        read_motion(robot_drawing(), make_trajectory())
    with pytest.raises(UnusableStateError, match="position of joint 'shoulder' must be finite, but is nan"):
        read_motion(robot_drawing(), make_trajectory(math.nan))
    short = make_trajectory(1.0)
    short.trajectory[0].joint_trajectory.points[0].positions = []
    with pytest.raises(UnusableStateError, match="1 joints, but 0 positions"):
        read_motion(robot_drawing(), short)


async def test_trajectory_properties_match_rviz():
    async with moving_trajectory() as (world, _):
        rows = {row.name: row for row in world.display("Trajectory").row().properties}
        assert {name: row.value for name, row in rows.items() if name != "Links"} == {
            "Robot Description": "robot_description",
            "Trajectory Topic": TOPIC,
            "Show Robot Visual": True,
            "Show Robot Collision": False,
            "Robot Alpha": 0.5,
            "State Display Time": "3x",
            "Loop Animation": False,
            "Show Trail": False,
            "Trail Step Size": 1,
            "Interrupt Display": False,
            "Robot Color": "#963296",
            "Color Enabled": False,
        }


async def test_trajectory_is_played_and_robot_disappears_at_end():
    async with moving_trajectory(FAST) as (world, publish_and_settle):
        places = []
        display = world.display("Trajectory")
        put = display.put

        def watched(group, shapes):
            shapes = list(shapes)
            places.extend(round(shape.pose[0], 3) for shape in shapes if shape.id == "Planned Path/hand")
            put(group, shapes)

        display.put = watched
        await publish_and_settle(make_trajectory(math.pi / 6, math.pi / 2))
        await eventually(lambda: not shown_markers(display))
        assert places == [0.0, 0.75, 1.5]


async def test_loop_animation_repeats_motion():
    async with moving_trajectory(FAST + ", Loop Animation: true") as (world, publish_and_settle):
        await publish_and_settle(make_trajectory(0.1))
        player = world.display("Trajectory")._player
        times = []
        step = player._step

        def counted():
            times.append(player._state_index)
            step()

        player._step = counted
        await eventually(lambda: len(times) > 5)
        assert set(times) == {0, 1}


async def test_color_and_trail_are_shown():
    async with moving_trajectory(SLOW + ", Show Trail: true, Color Enabled: true") as (world, publish_and_settle):
        drawn = await publish_and_settle(make_trajectory(0.1, 0.2, 0.3))
        hand_names = sorted(name for name in drawn if name.endswith("/hand"))
        assert hand_names == [
            "Planned Path 0/hand",
            "Planned Path 1/hand",
            "Planned Path 2/hand",
            "Planned Path 3/hand",
            "Planned Path/hand",
        ]
        assert drawn["Planned Path/base"]["color"] == pytest.approx([150 / 255, 50 / 255, 150 / 255, 0.5])
        display = world.display("Trajectory")
        display.set_property(("Trail Step Size",), 2)
        assert len([name for name in shown_markers(display) if name.endswith("/hand")]) == 3
        display.set_property(("Show Trail",), False)
        display.set_property(("Color Enabled",), False)
        (gray,) = [marker["color"] for name, marker in shown_markers(display).items() if name.endswith("/base")]
        assert gray == [0.5, 0.5, 0.5, 0.5]


async def test_new_motion_waits_unless_interrupt_display_is_set():
    async with moving_trajectory(SLOW) as (world, publish_and_settle):
        display = world.display("Trajectory")
        await publish_and_settle(make_trajectory(0.1))
        await publish_and_settle(make_trajectory(0.2, 0.3))
        assert len(display._player.motion.states) == 2
        display.set_property(("Interrupt Display",), True)
        await publish_and_settle(make_trajectory(0.2, 0.3))
        assert len(display._player.motion.states) == 3


async def test_invalid_motions_are_reported():
    async with moving_trajectory(", Interrupt Display: true") as (world, publish_and_settle):
        await publish_and_settle(make_trajectory(math.inf))
        assert world.status("Trajectory")["State"] == (
            "error",
            "The position of joint 'shoulder' must be finite, but is inf",
        )
        invalid_motion = make_trajectory(0.1)
        invalid_motion.trajectory[0].joint_trajectory.joint_names = ["elbow"]
        await publish_and_settle(invalid_motion)
        assert world.status("Trajectory")["Joints"] == ("warn", "The robot has no joint 'elbow'")
        await publish_and_settle(make_trajectory(0.1))
        assert "Joints" not in world.status("Trajectory")


async def test_robot_state_highlights_links():
    async with open_display("RobotState", "moveit_msgs/msg/DisplayRobotState", "/display_robot_state") as (
        world,
        publish_and_settle,
    ):
        red = ObjectColor(id="hand")
        red.color.r = red.color.a = 1.0
        unknown_color = ObjectColor(id="foot")
        message = DisplayRobotState(state=make_robot_state(shoulder=math.pi / 2), highlight_links=[red, unknown_color])
        message.state.attached_collision_objects = [
            make_attached_object("hand", make_collision_object("cup", frame="hand"))
        ]
        drawn = await publish_and_settle(message)
        assert drawn["Robot State/hand"]["color"] == [1, 0, 0, 1]
        assert drawn["Robot State/base"]["color"] == [0.5, 0.5, 0.5, 1]
        assert drawn["Robot State holds/cup"]["pose"][:3] == pytest.approx([1, 0, 0])
        assert world.status("RobotState")["Highlights"] == ("warn", "The robot has no link 'foot'")
        display = world.display("RobotState")
        display.set_property(("Show Highlights",), False)
        # RViz draws links without a color in red.
        assert shown_markers(display)["Robot State/hand"]["color"] == [1, 0, 0, 1]
        display.set_property(("Visual Enabled",), False)
        assert list(shown_markers(display)) == ["Robot State holds/cup"]
        assert await publish_and_settle(DisplayRobotState(hide=True)) == {}
        await publish_and_settle(DisplayRobotState(state=make_robot_state(shoulder=math.nan)))
        assert world.status("RobotState")["State"] == (
            "error",
            "The position of joint 'shoulder' must be finite, but is nan",
        )


async def test_motion_planning_shows_scene_trajectory_and_queries():
    extra = ", Scene Geometry: {Scene Display Time: 0.0001}, Planned Path: {State Display Time: 1000s}"
    kind, topic = "moveit_msgs/msg/DisplayTrajectory", TOPIC
    async with open_display("MotionPlanning", kind, topic, extra) as (world, publish_and_settle):
        display = world.display("MotionPlanning")
        node = world.graph.create_node("move_group")
        scenes = node.create_publisher("moveit_msgs/msg/PlanningScene", "/monitored_planning_scene", 10)
        scenes.publish(make_scene(make_collision_object("shelf"), robot=make_robot_state(shoulder=0.0)))
        await eventually(lambda: "Scene Robot/hand" in shown_markers(display))
        drawn = await publish_and_settle(make_trajectory(math.pi / 2))
        assert {"Scene Geometry/shelf", "Planned Path/base", "Goal State/hand"} <= set(drawn)
        assert not [name for name in drawn if name.startswith("Start State") or name == "Goal State/base"]
        assert drawn["Goal State/hand"]["pose"][:3] == pytest.approx([1.5, 0, 0])
        assert drawn["Goal State/hand"]["color"] == pytest.approx([250 / 255, 128 / 255, 0, 1])
        display.set_property(("Planning Request", "Query Start State"), True)
        display.set_property(("Planning Request", "Query Goal State"), False)
        drawn = shown_markers(display)
        assert drawn["Start State/hand"]["pose"][:3] == pytest.approx([0, 0, 1.5])
        assert "Goal State/hand" not in drawn
        display.set_property(("Planned Path", "Trajectory Topic"), "/other")
        assert not [name for name in shown_markers(display) if name.startswith("Planned Path")]
