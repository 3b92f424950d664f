"""The MotionPlanning display: start and goal states, handles, and motions, with move_group on the same graph."""

from __future__ import annotations

import asyncio

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String, get_message, get_service
from linkwright.page.protocol.motion_planning import (
    AddSceneObject,
    AttachSceneObject,
    MoveSceneObject,
    RemoveSceneObject,
    SelectSceneObject,
)
from linkwright.planning.page.scene_edits import describe_objects, make_moved_object
from linkwright.rviz.displays.moveit.scene import Scene
from tests.planning.arms import SRDF, arm
from tests.planning.nodes.bench import closed_room
from tests.planning.page.bench import HANDLE, open_bench
from tests.rviz.displays.moveit.arm import make_collision_object, make_pose, make_scene

pytestmark = pytest.mark.extra("arm")

GREEN, ORANGE, RED = [0.0, 1.0, 0.0, 1.0], [250 / 255, 128 / 255, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0]
GHOSTS = ", Planning Request: {Query Start State: true}"
FAR_POSE = [3.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]


@pytest.fixture(autouse=True)
def _shapes_are_drawn(monkeypatch):
    """Draw the collision shapes of the test arm, which has no other shapes."""
    from linkwright.planning.page import display

    appearance = display.Appearance
    monkeypatch.setattr(display, "Appearance", lambda *args, **options: appearance(*args, **options, collision=True))


def moved(pose: list[float], z: float) -> list[float]:
    return [*pose[:2], pose[2] + z, *pose[3:]]


async def test_groups_and_states_come_from_parameter_of_move_group():
    async with open_bench() as bench:
        panel = bench.panel()
        assert (panel["groups"], panel["group"], panel["states"]) == (["arm", "gripper", "all"], "arm", ["ready"])
        assert panel["robot"] == arm().robot.name
        assert (panel["start"], panel["goal"]) == ("<current>", "<current>")
        request = next(row for row in bench.display.row().properties if row.name == "Planning Request")
        group = next(row for row in request.children if row.name == "Planning Group")
        assert group.options == ["arm", "gripper", "all"]


async def test_groups_come_from_topic_without_move_group():
    async with open_bench(with_move_group=False) as bench:
        await bench.until(lambda: bench.panel().get("missing") == "semantics")
        node = bench.world.graph.create_node("descriptions")
        publisher = node.create_publisher(String, "/robot_description_semantic", DESCRIPTION_QOS)
        publisher.publish(String(data=SRDF))
        await bench.until(lambda: bench.panel()["missing"] == "move_group")
        assert bench.panel()["groups"] == ["arm", "gripper", "all"]
        assert bench.world.status("MotionPlanning")["move_group"] == (
            "warn",
            "move_group does not respond; start it to plan",
        )
        publisher.publish(String(data="<robot name='elbow_arm'><group name='arm'><joint name='nose'/></group></robot>"))
        await bench.until(lambda: bench.panel()["missing"] == "semantics")
        assert "'nose'" in bench.world.status("MotionPlanning")["SRDF"][1]


async def test_request_properties_match_rviz():
    async with open_bench() as bench:
        rows = {row.name: row for row in bench.display.row().properties}
        assert {row.name: row.value for row in rows["Planning Request"].children} == {
            "Planning Group": "",
            "Show Workspace": False,
            "Query Start State": False,
            "Query Goal State": True,
            "Interactive Marker Size": 0.0,
            "Start State Color": "#00ff00",
            "Start State Alpha": 1.0,
            "Goal State Color": "#fa8000",
            "Goal State Alpha": 1.0,
            "Colliding Link Color": "#ff0000",
            "Joint Violation Color": "#ff00ff",
        }
        assert not [name for name in rows if name.startswith("MoveIt")]


async def test_settings_of_file_are_read_and_written():
    async with open_bench(", MoveIt_Planning_Time: 2, MoveIt_Use_Cartesian_Path: true") as bench:
        settings = bench.panel()["settings"]
        assert settings == {
            "planning_time": 2.0,
            "attempts": 10,
            "velocity_scaling": 0.1,
            "acceleration_scaling": 0.1,
            "cartesian": True,
            "collision_aware": True,
            "approximate": False,
        }
        bench.display.set_property(("Velocity_Scaling_Factor",), 0.5)
        await bench.until(lambda: bench.panel()["settings"]["velocity_scaling"] == 0.5)
        assert bench.display.config.section.scalar("Velocity_Scaling_Factor").text == "0.5"


async def test_ghosts_follow_current_state_until_they_are_set():
    async with open_bench(GHOSTS) as bench:
        await bench.until(lambda: "Goal State/palm" in bench.markers())
        first = bench.markers()
        assert first["Goal State/palm"]["color"] == pytest.approx(ORANGE)
        assert first["Start State/palm"]["color"] == pytest.approx(GREEN)
        assert "Goal State/base" not in first
        bench.choose("goal", "ready")
        await bench.until(lambda: bench.joints()["elbow"] == 1.2 and bench.joints()["lift"] == 0.4)
        set_goal = bench.markers()
        bench.publish_joints(pan=1.0)
        await bench.until(lambda: bench.markers()["Start State/palm"]["pose"] != first["Start State/palm"]["pose"])
        assert bench.markers()["Goal State/palm"]["pose"] == set_goal["Goal State/palm"]["pose"]
        assert bench.panel()["goal"] == "ready"
        bench.display.set_property(("Planning Request", "Query Goal State"), False)
        await bench.until(lambda: "Goal State/palm" not in bench.markers())
        assert f"marker {HANDLE}" not in bench.contents()


async def test_states_are_copied_and_chosen_at_random():
    async with open_bench() as bench:
        bench.choose("start", "ready")
        bench.choose("goal", "<same as start>")
        await bench.until(lambda: bench.panel()["goal"] == "<same as start>")
        assert bench.joints()["lift"] == 0.4
        bench.choose("goal", "<random>")
        await bench.until(lambda: bench.panel()["goal"] == "<random>")
        assert all(joint["lower"] <= joint["position"] <= joint["upper"] for joint in bench.panel()["joints"])
        bench.choose("goal", "<random valid>")
        await bench.until(lambda: bench.panel()["goal"] == "<random valid>" and not bench.panel()["colliding"])
        bench.choose("goal", "no such state")
        bench.choose("goal", "<current>")
        await bench.until(lambda: bench.panel()["goal"] == "<current>")
        assert bench.joints()["lift"] == 0.6


async def test_joints_of_goal_are_set_within_limits():
    async with open_bench() as bench:
        bench.set_joint("elbow", 0.5)
        bench.set_joint("pan", 9.0)
        bench.set_joint("nose", 1.0)
        await bench.until(lambda: bench.joints()["elbow"] == 0.5)
        assert bench.joints() == {"pan": 2.8, "lift": 0.6, "elbow": 0.5, "roll": 0.0, "bend": 1.0, "twist": 0.0}
        assert bench.panel()["goal"] == ""


async def test_colliding_links_are_red():
    async with open_bench() as bench:
        bench.choose("goal", "ready")
        node = bench.world.graph.create_node("shelves")
        client = node.create_client(get_service("moveit_msgs/srv/ApplyPlanningScene"), "/apply_planning_scene")
        scene = get_message("moveit_msgs/msg/PlanningScene")(is_diff=True)
        scene.robot_state.is_diff = True
        shelf = get_message("moveit_msgs/msg/CollisionObject")(id="shelf", operation=b"\x00")
        shelf.header.frame_id = "tool"
        shelf.primitives = [get_message("shape_msgs/msg/SolidPrimitive")(type=1, dimensions=[0.05, 0.05, 0.05])]
        shelf.pose.position.z = -0.05
        scene.world.collision_objects = [shelf]
        await bench.until(client.service_is_ready)
        bench.choose("goal", "<current>")
        client.call_async(client.srv_type.Request(scene=scene))
        await bench.until(lambda: "flange" in bench.panel()["colliding"])
        await bench.until(lambda: bench.markers()["Goal State/flange"]["color"] == pytest.approx(RED))
        assert bench.markers()["Goal State/forearm"]["color"] == pytest.approx(ORANGE)


async def test_dragged_handle_moves_goal_with_inverse_kinematics():
    async with open_bench() as bench:
        await bench.until(lambda: f"marker {HANDLE}" in bench.contents())
        assert [control["mode"] for control in bench.contents()[f"marker {HANDLE}"]["controls"]] == [
            *["rotate_axis", "move_axis"] * 3,
            "move_rotate_3d",
        ]
        pose, joints = bench.handle_pose(), bench.joints()
        for step in range(1, 6):  # of these, only the last must be handled
            bench.drag(moved(pose, -0.02 * step))
        await bench.until(lambda: bench.handle_pose() == pytest.approx(moved(pose, -0.1), abs=1e-3))
        assert bench.joints() != joints
        assert (bench.panel()["goal"], bench.panel()["unreachable"]) == ("", [])


async def test_dragged_start_is_planned_from_and_not_executed_elsewhere():
    async with open_bench(GHOSTS) as bench:
        start = "start tool"
        await bench.until(lambda: f"marker {start}" in bench.contents())
        bench.choose("goal", "ready")
        pose = moved(bench.handle_pose(start), -0.1)
        bench.drag(pose, handle=start)
        await bench.until(lambda: bench.handle_pose(start) == pytest.approx(pose, abs=1e-3))
        assert (bench.panel()["start"], bench.panel()["goal"]) == ("", "ready")
        bench.command("plan_and_execute")
        await bench.until(lambda: bench.panel()["outcome"] == "execution_failed")
        assert bench.panel()["error"] == "CONTROL_FAILED"  # the robot is not at the start
        assert bench.followed == []


async def test_unreachable_pose_keeps_goal_and_is_reported():
    async with open_bench() as bench:
        await bench.until(lambda: f"marker {HANDLE}" in bench.contents())
        pose, joints = bench.handle_pose(), bench.joints()
        bench.drag(FAR_POSE)
        await bench.until(lambda: bench.panel()["unreachable"] == [HANDLE])
        assert bench.joints() == joints
        assert bench.world.status("MotionPlanning")["Inverse Kinematics"] == (
            "warn",
            "'tool' cannot reach the pose of its handle",
        )
        bench.drag(FAR_POSE, "mouse_up")
        await bench.until(lambda: bench.panel()["unreachable"] == [])
        assert bench.contents()[f"pose {HANDLE}"]["pose"] == pytest.approx(pose)


async def test_approximate_inverse_kinematics_stops_near_unreachable_pose():
    async with open_bench(", MoveIt_Allow_Approximate_IK: true") as bench:
        await bench.until(lambda: f"marker {HANDLE}" in bench.contents())
        pose = bench.handle_pose()
        target = [pose[0] + 2.0, *pose[1:]]
        bench.drag(target)
        await bench.until(lambda: bench.panel()["unreachable"] == [HANDLE])
        assert pose[0] + 0.02 < bench.handle_pose()[0] < target[0]


async def test_motion_is_planned_and_executed():
    async with open_bench() as bench:
        bench.choose("goal", "ready")
        bench.command("plan")
        await bench.until(lambda: bench.panel()["outcome"] == "planned")
        panel = bench.panel()
        assert panel["executable"]
        assert panel["planning_time"] > 0.0
        assert panel["duration"] > 0.0
        assert bench.followed == []
        bench.command("execute")
        await bench.until(lambda: bench.panel()["outcome"] == "executed")
        (trajectory,) = bench.followed
        positions = dict(zip(trajectory.joint_names, trajectory.points[-1].positions, strict=True))
        assert positions["lift"] == pytest.approx(0.4, abs=1e-3)
        assert not bench.panel()["executable"]
        bench.choose("goal", "<random valid>")
        await bench.until(lambda: bench.panel()["goal"] == "<random valid>")
        await bench.until(lambda: bench.session.current.values.get("lift") == pytest.approx(0.4, abs=1e-3))
        bench.command("plan_and_execute")
        await bench.until(lambda: bench.panel()["outcome"] == "executed" and len(bench.followed) == 2)


async def test_stop_cancels_planning():
    async with open_bench(", MoveIt_Planning_Time: 3600") as bench:
        assert await bench.session.client.apply_scene(closed_room())
        bench.publish_joints(pan=1.5, lift=1.2, elbow=0.6, bend=0.0)
        await bench.until(lambda: bench.session.current.values.get("pan") == pytest.approx(1.5))
        bench.set_joint("pan", -1.5)
        bench.command("plan_and_execute")
        await bench.until(lambda: bench.panel()["activity"] == "planning")
        await asyncio.sleep(0.2)
        bench.command("stop")
        await bench.until(lambda: bench.panel()["activity"] == "idle")
        assert bench.panel()["outcome"] == "stopped"
        assert not bench.panel()["executable"]
        assert bench.followed == []


async def test_stop_cancels_execution():
    async with open_bench() as bench:
        bench.is_slow = True
        bench.choose("goal", "ready")
        bench.command("plan_and_execute")
        await bench.until(lambda: bench.panel()["activity"] == "executing" and bench.followed)
        bench.command("plan")  # ignored while a motion is executed
        bench.command("stop")
        await bench.until(lambda: bench.panel()["activity"] == "idle")
        assert bench.panel()["outcome"] == "stopped"
        assert not bench.panel()["executable"]


async def test_cartesian_path_is_shown_and_scaled():
    drawn = ", Planned Path: {Show Robot Collision: true}"
    async with open_bench(f", MoveIt_Use_Cartesian_Path: true, Velocity_Scaling_Factor: 0.5{drawn}") as bench:
        await bench.until(lambda: f"marker {HANDLE}" in bench.contents())
        pose = bench.handle_pose()
        bench.drag(moved(pose, -0.1))
        await bench.until(lambda: bench.panel()["goal"] == "")
        bench.command("plan")
        await bench.until(lambda: bench.panel()["outcome"] == "planned")
        slow = bench.panel()["duration"]
        await bench.until(lambda: "Planned Path/palm" in bench.markers())
        bench.display.set_property(("Velocity_Scaling_Factor",), 1.0)
        bench.display.set_property(("Acceleration_Scaling_Factor",), 1.0)
        bench.command("plan")
        await bench.until(lambda: bench.panel()["duration"] != slow)
        assert slow > 2.0 * bench.panel()["duration"]


async def test_failed_plans_name_error_code():
    async with open_bench() as bench:
        bench.choose("goal", "ready")
        bench.session.queries["goal"].values["lift"] = 9.0
        bench.command("plan")
        await bench.until(lambda: bench.panel()["outcome"] == "planning_failed")
        assert bench.panel()["error"] in ("INVALID_GOAL_CONSTRAINTS", "GOAL_IN_COLLISION", "GOAL_CONSTRAINTS_VIOLATED")
        assert not bench.panel()["executable"]


async def test_pipelines_are_offered_and_chosen():
    async with open_bench() as bench:
        await bench.until(lambda: bench.panel()["pipelines"])
        assert [(pipeline["id"], pipeline["planners"]) for pipeline in bench.panel()["pipelines"]] == [
            ("ompl", ["RRTConnectkConfigDefault", "Unknown"]),
            ("pilz_industrial_motion_planner", ["PTP", "LIN", "CIRC"]),
            ("chomp", ["RRTConnect"]),
        ]


async def test_group_is_chosen_and_workspace_is_drawn():
    async with open_bench(", Planning Request: {Planning Group: gripper, Show Workspace: true}") as bench:
        panel = bench.panel()
        assert (panel["group"], panel["states"], [joint["name"] for joint in panel["joints"]]) == (
            "gripper",
            ["open"],
            ["left"],
        )
        assert [key for key in bench.contents() if key.startswith("marker")] == []
        assert bench.markers()["Workspace/box"]["scale"] == [2.0, 2.0, 2.0]
        bench.display.set_property(("Planning Request", "Planning Group"), "all")
        await bench.until(lambda: f"marker {HANDLE}" in bench.contents())
        bench.drag(moved(bench.handle_pose(), -0.05))
        await bench.until(lambda: bench.panel()["goal"] == "" and not bench.panel()["unreachable"])


async def test_disabled_display_disconnects():
    async with open_bench() as bench:
        bench.display.set_checked(False)
        bench.display.on_enabled_changed()
        assert bench.session.client is None
        bench.command("plan")
        bench.display.set_checked(True)
        bench.display.on_enabled_changed()
        await bench.until(lambda: bench.panel()["missing"] == "none" and bench.session.client is not None)


async def test_objects_are_added_moved_attached_and_removed():
    async with open_bench() as bench:
        identity = bench.display.id
        bench.display.receive(AddSceneObject(identity, "mug", "cylinder", [0.1, 0.03]))
        bench.display.receive(AddSceneObject(identity, "crate", "box", [0.1, 0.0, 0.1]))  # not a valid size
        await bench.until(lambda: bench.panel()["objects"])
        await bench.until(lambda: bench.markers().get("Scene Geometry/mug", {}).get("shape") == "cylinder")
        bench.display.receive(MoveSceneObject(identity, "mug", [0.1, 0.2, 0.3], [0.0, 0.0, 1.0]))
        await bench.until(lambda: bench.panel()["objects"][0]["position"] == pytest.approx([0.1, 0.2, 0.3]))
        assert bench.panel()["objects"][0]["rpy"] == pytest.approx([0.0, 0.0, 1.0])
        assert "tool" in bench.panel()["links"]
        bench.display.receive(AttachSceneObject(identity, "mug", "tool"))
        await bench.until(lambda: bench.panel()["objects"][0]["link"] == "tool")
        attached = bench.move_group._monitor.scene.attached["mug"]
        assert list(attached.touch_links) == ["flange", "left_finger", "right_finger", "tool"]
        bench.display.receive(AttachSceneObject(identity, "mug", ""))
        await bench.until(lambda: bench.panel()["objects"][0]["link"] == "")
        bench.display.receive(AttachSceneObject(identity, "mug", "tool"))
        await bench.until(lambda: bench.panel()["objects"][0]["link"] == "tool")
        bench.display.receive(RemoveSceneObject(identity, "mug"))
        await bench.until(lambda: not bench.panel()["objects"])
        assert bench.move_group._monitor.scene.objects == {}
        assert not bench.panel()["refused"]


async def test_refused_object_is_reported():
    async with open_bench() as bench:
        bench.display.receive(AddSceneObject(bench.display.id, "palm", "sphere", [0.1]))  # the name of a link
        await bench.until(lambda: bench.panel()["refused"])
        assert bench.panel()["objects"] == []


def test_pose_of_object_includes_that_of_its_shape():
    scene = Scene()
    lamp = make_collision_object("lamp", object_pose=make_pose(x=1.0))
    lamp.primitive_poses = [make_pose(z=0.5)]
    scene.apply(make_scene(lamp))
    (description,) = describe_objects(scene)
    assert description.position == [1.0, 0.0, 0.5]
    moved = make_moved_object(MoveSceneObject("", "lamp", [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]), scene)
    assert moved.world.collision_objects[0].pose.position.z == 1.5


async def test_selected_object_is_dragged_by_its_handle():
    async with open_bench() as bench:
        identity, handle = bench.display.id, "object mug"
        bench.display.receive(AddSceneObject(identity, "mug", "cylinder", [0.1, 0.03]))
        await bench.until(lambda: bench.panel()["objects"])
        assert f"marker {handle}" not in bench.contents()
        bench.display.receive(SelectSceneObject(identity, "mug"))
        await bench.until(lambda: f"marker {handle}" in bench.contents())
        assert bench.handle_pose(handle)[:3] == pytest.approx(bench.panel()["objects"][0]["position"])
        for step in range(5):  # Poses that wait are left out, except the last one.
            bench.drag([0.1 * step, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0], handle=handle)
        bench.drag([0.4, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0], "mouse_up", handle)
        await bench.until(lambda: bench.panel()["objects"][0]["position"] == pytest.approx([0.4, 0.2, 0.3]))
        await bench.until(lambda: bench.handle_pose(handle)[:3] == pytest.approx([0.4, 0.2, 0.3]))
        bench.drag([float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], handle=handle)
        bench.display.receive(AttachSceneObject(identity, "mug", "tool"))  # It then moves with the link.
        await bench.until(lambda: f"marker {handle}" not in bench.contents())
        bench.display.receive(AttachSceneObject(identity, "mug", ""))
        await bench.until(lambda: f"marker {handle}" in bench.contents())
        bench.display.receive(SelectSceneObject(identity, ""))
        await bench.until(lambda: f"marker {handle}" not in bench.contents())


async def test_handle_returns_to_an_object_that_is_not_moved(monkeypatch):
    async with open_bench() as bench:
        identity, handle = bench.display.id, "object mug"
        bench.display.receive(AddSceneObject(identity, "mug", "sphere", [0.1]))
        bench.display.receive(SelectSceneObject(identity, "mug"))
        await bench.until(lambda: f"marker {handle}" in bench.contents())
        place = bench.handle_pose(handle)

        async def refuse(_difference: object) -> bool:
            return False

        monkeypatch.setattr(bench.session.client, "apply_scene", refuse)
        bench.drag([2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], handle=handle)
        bench.drag([2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], "mouse_up", handle)
        await bench.until(lambda: f"pose {handle}" in bench.contents())
        assert bench.handle_pose(handle) == place
        assert bench.panel()["refused"]


async def test_panel_tells_whether_the_goal_state_has_a_handle():
    async with open_bench() as bench:
        assert bench.panel()["draggable"]
        bench.display.set_property(("Planning Request", "Query Goal State"), False)
        await bench.until(lambda: not bench.panel()["draggable"])
        bench.display.set_property(("Planning Request", "Query Goal State"), True)
        await bench.until(lambda: bench.panel()["draggable"])
        bench.display.set_property(("Planning Request", "Planning Group"), "gripper")  # It has no tip.
        await bench.until(lambda: not bench.panel()["draggable"])
