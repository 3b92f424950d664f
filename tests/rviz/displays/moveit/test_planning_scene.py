"""PlanningScene: the robot, its attached objects, and its surroundings."""

from __future__ import annotations

import math
import struct
from contextlib import asynccontextmanager

import numpy as np
import pytest
import yaml

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import get_message, get_service
from tests.rviz.displays.moveit.arm import (
    ARM,
    ObjectColor,
    SolidPrimitive,
    as_signed_bytes,
    make_attached_object,
    make_collision_object,
    make_config,
    make_pose,
    make_primitive,
    make_robot_state,
    make_scene,
)
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world
from tests.waiting import eventually

TOPIC = "/monitored_planning_scene"
FAST = ", Scene Geometry: {Scene Display Time: 0.0001}"
REMOVE, APPEND, MOVE = b"\x01", b"\x02", b"\x03"


class SceneSource:
    """The publisher of move_group's planning scene."""

    def __init__(self, world, topic: str = TOPIC) -> None:
        self.world = world
        self.node = world.graph.create_node("move_group")
        self.publisher = self.node.create_publisher("moveit_msgs/msg/PlanningScene", topic, 10)

    async def publish_scene(self, message) -> dict[str, dict]:
        """Publish a scene, and return the drawing."""
        self.publisher.publish(message)
        await self.world.settle()
        display = self.world.viewer.displays[0]
        await eventually(lambda: display._draw_timer is None)
        return shown_markers(display)


@asynccontextmanager
async def planning_scene_world(extra: str = FAST, cls: str = "PlanningScene", text: str = ARM):
    async with open_world(make_config(cls, extra)) as world:
        if text:
            world.describe(text)
        source = SceneSource(world)
        await world.settle()
        yield world, source


async def test_planning_scene_properties_match_rviz():
    async with planning_scene_world("") as (world, _):
        rows = {row.name: row for row in world.display("PlanningScene").row().properties}
        assert {name: row.value for name, row in rows.items() if row.kind != "group"} == {
            "Move Group Namespace": "",
            "Robot Description": "robot_description",
            "Planning Scene Topic": TOPIC,
        }
        assert {row.name: row.value for row in rows["Scene Geometry"].children} == {
            "Scene Name": "(noname)",
            "Show Scene Geometry": True,
            "Scene Alpha": 0.9,
            "Scene Color": "#32e632",
            "Voxel Rendering": "Occupied Voxels",
            "Voxel Coloring": "Z-Axis",
            "Scene Display Time": 0.01,
        }
        robot = {row.name: row for row in rows["Scene Robot"].children}
        assert robot.pop("Links").children[1].name == "base"
        assert {name: row.value for name, row in robot.items()} == {
            "Show Robot Visual": True,
            "Show Robot Collision": False,
            "Robot Alpha": 1.0,
            "Attached Body Color": "#963296",
        }


async def test_robot_state_of_scene_overrides_tf():
    async with planning_scene_world() as (_, source):
        shown = await source.publish_scene(make_scene(robot=make_robot_state(shoulder=math.pi / 2, wrist=0.5)))
        hand = shown["Scene Robot/hand"]
        assert hand["frame"] == "base"
        np.testing.assert_allclose(hand["pose"][:3], [1.5, 0, 0], atol=1e-9)
        assert shown["Scene Robot/base"]["color"] == [0.5, 0.5, 0.5, 1.0]
        assert "Scene Robot/tip" not in shown


async def test_primitives_planes_and_meshes_are_drawn():
    async with planning_scene_world() as (world, source):
        many = make_collision_object(
            "many",
            make_primitive(SolidPrimitive.BOX, 1, 2, 3),
            make_primitive(SolidPrimitive.SPHERE, 0.5),
            make_primitive(SolidPrimitive.CYLINDER, 2, 0.5),
            make_primitive(SolidPrimitive.CONE, 2, 0.5),
            object_pose=make_pose(x=5.0),
        )
        many.primitive_poses = [make_pose(), make_pose(y=1.0), make_pose(y=2.0), make_pose(y=3.0)]
        mesh = get_message("shape_msgs/msg/Mesh")()
        mesh.vertices = [
            get_message("geometry_msgs/msg/Point")(x=float(x), y=float(y)) for x, y in ((0, 0), (1, 0), (0, 1))
        ]
        mesh.triangles = [get_message("shape_msgs/msg/MeshTriangle")(vertex_indices=[0, 1, 2])]
        many.meshes = [mesh]
        many.planes = [get_message("shape_msgs/msg/Plane")(coef=[0.0, 0.0, 2.0, -2.0])]
        shown = await source.publish_scene(make_scene(many))
        kinds = {name: marker["shape"] for name, marker in shown.items()}
        assert kinds == {
            "Scene Geometry/many": "cube",
            "Scene Geometry/many primitive 1": "sphere",
            "Scene Geometry/many primitive 2": "cylinder",
            "Scene Geometry/many primitive 3": "triangle_list",
            "Scene Geometry/many mesh 0": "triangle_list",
            "Scene Geometry/many plane 0": "triangle_list",
        }
        assert shown["Scene Geometry/many"]["scale"] == [1, 2, 3]
        assert shown["Scene Geometry/many primitive 1"]["pose"][:3] == [5, 1, 0]
        assert shown["Scene Geometry/many primitive 2"]["scale"] == [1, 1, 2]
        cone = shown["Scene Geometry/many primitive 3"]["points"].reshape(-1, 3)
        assert (cone[:, 2].min(), cone[:, 2].max()) == (-1, 1)
        plane = shown["Scene Geometry/many plane 0"]["points"].reshape(-1, 3)
        assert plane[:, 2].tolist() == [1] * 6
        assert shown["Scene Geometry/many"]["color"] == pytest.approx([50 / 255, 230 / 255, 50 / 255, 0.9])
        assert world.status("PlanningScene")["Transform"] == ("ok", "Transform OK")


async def test_objects_are_added_moved_appended_and_removed():
    async with planning_scene_world() as (world, source):
        assert list(await source.publish_scene(make_scene(make_collision_object("a"), make_collision_object("b")))) == [
            "Scene Geometry/a",
            "Scene Geometry/b",
        ]
        moved = await source.publish_scene(
            make_scene(make_collision_object("a", object_pose=make_pose(z=2.0), operation=MOVE), diff=True)
        )
        assert moved["Scene Geometry/a"]["pose"][:3] == [0, 0, 2]
        grown = await source.publish_scene(
            make_scene(make_collision_object("b", make_primitive(2, 1), operation=APPEND), diff=True)
        )
        assert "Scene Geometry/b primitive 1" in grown
        left = await source.publish_scene(make_scene(make_collision_object("b", operation=REMOVE), diff=True))
        assert list(left) == ["Scene Geometry/a"]
        await source.publish_scene(make_scene(make_collision_object("missing", operation=MOVE), diff=True))
        assert world.status("PlanningScene")["missing"] == (
            "error",
            "Object 'missing' cannot be moved, because it does not exist",
        )
        assert await source.publish_scene(make_scene(make_collision_object("", operation=REMOVE), diff=True)) == {}
        assert list(await source.publish_scene(make_scene(make_collision_object("c")))) == ["Scene Geometry/c"]
        assert "missing" not in world.status("PlanningScene")


async def test_attached_object_moves_with_its_link():
    async with planning_scene_world() as (_, source):
        robot = make_robot_state(shoulder=0.0, wrist=0.0)
        robot.attached_collision_objects = [
            make_attached_object("hand", make_collision_object("cup", frame="hand", object_pose=make_pose(x=0.1)))
        ]
        shown = await source.publish_scene(make_scene(make_collision_object("cup"), robot=robot))
        assert shown["Scene Robot holds/cup"]["pose"][:3] == pytest.approx([0.1, 0, 1])
        assert shown["Scene Robot holds/cup"]["color"] == pytest.approx([150 / 255, 50 / 255, 150 / 255, 1])
        assert "Scene Geometry/cup" not in shown
        shown = await source.publish_scene(make_scene(robot=make_robot_state(shoulder=0.0, wrist=1.0), diff=True))
        assert shown["Scene Robot holds/cup"]["pose"][:3] == pytest.approx([0.1, 0, 2])
        released = make_robot_state()
        released.attached_collision_objects = [
            make_attached_object("hand", make_collision_object("cup", operation=REMOVE))
        ]
        assert "Scene Robot holds/cup" not in await source.publish_scene(make_scene(robot=released, diff=True))


async def test_objects_have_colors_of_scene():
    async with planning_scene_world() as (_, source):
        color = ObjectColor(id="a")
        color.color.b, color.color.a = 1.0, 0.25
        shown = await source.publish_scene(
            make_scene(make_collision_object("a"), make_collision_object("b"), object_colors=[color])
        )
        assert shown["Scene Geometry/a"]["color"] == [0, 0, 1, 0.25]
        assert shown["Scene Geometry/b"]["color"][3] == 0.9


async def test_octomap_cells_follow_render_properties():
    async with planning_scene_world() as (world, source):
        message = make_scene()
        octomap = message.world.octomap
        octomap.header.frame_id, octomap.origin = "base", make_pose(z=1.0)
        octomap.octomap.id, octomap.octomap.binary, octomap.octomap.resolution = "OcTree", True, 0.1
        octomap.octomap.data = as_signed_bytes(struct.pack("<H", 0b10_01_00_00_00_00_00_00))
        shown = await source.publish_scene(message)
        (name,) = shown
        assert (shown[name]["shape"], len(shown[name]["points"]) // 3) == ("cube_list", 1)
        assert shown[name]["pose"][:3] == [0, 0, 1]
        display = world.display("PlanningScene")
        display.set_property(("Scene Geometry", "Voxel Rendering"), "All Voxels")
        (cells,) = shown_markers(display).values()
        assert len(cells["points"]) // 3 == 2
        display.set_property(("Scene Geometry", "Show Scene Geometry"), False)
        assert shown_markers(display) == {}
        octomap.octomap.data = [1]
        await source.publish_scene(message)
        assert world.status("PlanningScene")["<octomap>"] == (
            "error",
            "The data of the octomap ends too early, after 1 bytes",
        )


async def test_changed_properties_take_effect_at_once():
    async with planning_scene_world() as (world, source):
        await source.publish_scene(make_scene(make_collision_object("a"), robot=make_robot_state(shoulder=0.0)))
        display = world.display("PlanningScene")
        display.set_property(("Scene Geometry", "Scene Color"), "#ff0000")
        display.set_property(("Scene Robot", "Robot Alpha"), 0.5)
        display.set_property(("Scene Robot", "Links", "hand"), False)
        display.set_property(("Scene Robot", "Links", "upper", "Alpha"), 0.5)
        display.set_property(("Scene Robot", "Show Robot Collision"), True)
        shown = shown_markers(display)
        assert shown["Scene Geometry/a"]["color"] == [1, 0, 0, 0.9]
        assert shown["Scene Robot/base"]["color"] == [0.5, 0.5, 0.5, 0.5]
        assert "Scene Robot/hand" not in shown
        assert shown["Scene Robot/upper"]["color"][3] == 0.25
        assert shown["Scene Robot/upper 1"]["shape"] == "cube"
        display.set_property(("Scene Robot", "Links", "All Links Enabled"), False)
        assert [name for name in shown_markers(display) if name.startswith("Scene Robot")] == []


async def test_full_scene_is_requested_when_move_group_appears():
    async with open_world(make_config("PlanningScene", FAST)) as world:
        world.describe(ARM)
        await world.settle()
        node = world.graph.create_node("move_group")
        requests = []

        def respond(request, response):
            requests.append(request.components.components)
            response.scene = make_scene(
                make_collision_object("shelf"), robot=make_robot_state(shoulder=1.0), name="kitchen"
            )
            return response

        node.create_service(get_service("moveit_msgs/srv/GetPlanningScene"), "/get_planning_scene", respond)
        display = world.display("PlanningScene")
        await eventually(lambda: "Scene Geometry/shelf" in shown_markers(display))
        assert "Scene Robot/hand" in shown_markers(display)
        (components,) = requests
        assert components & 16
        rows = {row.name: row for row in display.row().properties}
        assert rows["Scene Geometry"].children[0].value == "kitchen"


async def test_move_group_namespace_selects_service_and_description():
    extra = ", Move Group Namespace: left, Planning Scene Topic: /left/scene"
    async with open_world(make_config("PlanningScene", extra)) as world:
        node = world.graph.create_node("left")
        node.create_publisher("std_msgs/msg/String", "/left/robot_description", DESCRIPTION_QOS).publish(
            get_message("std_msgs/msg/String")(data=ARM)
        )
        node.create_service(
            get_service("moveit_msgs/srv/GetPlanningScene"),
            "/left/get_planning_scene",
            lambda _, response: response,
        )
        display = world.display("PlanningScene")
        await eventually(lambda: display.scene.has_full_scene)
        assert world.status("PlanningScene")["URDF"] == ("ok", "URDF parsed OK")


async def test_invalid_scenes_are_reported_and_next_valid_one_is_drawn():
    async with planning_scene_world() as (world, source):
        nan = make_collision_object("nan", object_pose=make_pose(x=math.nan))
        short = make_collision_object("short", make_primitive(SolidPrimitive.BOX, 1, 1))
        kind = make_collision_object("kind", make_primitive(9, 1, 1, 1))
        poses = make_collision_object("poses")
        poses.primitive_poses = [make_pose(), make_pose()]
        mesh = make_collision_object("mesh")
        mesh.meshes = [get_message("shape_msgs/msg/Mesh")()]
        mesh.meshes[0].triangles = [get_message("shape_msgs/msg/MeshTriangle")(vertex_indices=[0, 1, 7])]
        plane = make_collision_object("plane")
        plane.planes = [get_message("shape_msgs/msg/Plane")(coef=[0.0, 0.0, 0.0, 1.0])]
        robot = make_robot_state(shoulder=0.0, elbow=1.0)
        robot.attached_collision_objects = [
            make_attached_object("foot", make_collision_object("ball", frame="foot")),
            make_attached_object("hand", make_collision_object("e")),
        ]
        robot.attached_collision_objects[1].object.primitives = []
        shown = await source.publish_scene(
            make_scene(nan, short, kind, poses, mesh, plane, make_collision_object("good"), robot=robot)
        )
        assert [name for name in shown if name.startswith("Scene Geometry")] == ["Scene Geometry/good"]
        status = world.status("PlanningScene")
        assert status["nan"] == ("error", "Contains invalid floating point values (nans or infs)")
        assert status["short"] == ("error", "A primitive of type 1 needs 3 dimensions, but has 2")
        assert status["kind"] == ("error", "Primitives of type 9 are not supported")
        assert status["poses"] == (
            "error",
            "The object has 1 shapes of kind primitive, but 2 poses",
        )
        assert status["mesh"] == ("error", "A triangle of a mesh refers to vertex 7, but the mesh has only 0 vertices")
        assert status["plane"] == ("error", "The normal of a plane is zero or not finite")
        assert status["ball"] == ("error", "The robot has no link 'foot' for the attached object 'ball'")
        assert status["e"] == ("error", "The attached object 'e' has no shapes")
        assert status["Joints"] == ("warn", "The robot has no joint 'elbow'")
        await source.publish_scene(
            make_scene(make_collision_object("good", frame="nowhere"), robot=make_robot_state(shoulder=math.inf))
        )
        status = world.status("PlanningScene")
        assert status["State"] == ("error", "The position of joint 'shoulder' must be finite, but is inf")
        assert status["Transform"] == ("error", "No transform from [nowhere] to [base]")
        uneven = make_robot_state(shoulder=0.0)
        uneven.joint_state.position = []
        await source.publish_scene(make_scene(robot=uneven))
        assert world.status("PlanningScene")["State"] == ("error", "The state has 1 joints, but 0 positions")
        await source.publish_scene(make_scene(make_collision_object("good"), robot=make_robot_state(shoulder=0.5)))
        assert set(world.status("PlanningScene")) == {"Topic", "URDF", "Transform"}


async def test_objects_are_drawn_before_robot_description_arrives():
    async with planning_scene_world(text="") as (world, source):
        shown = await source.publish_scene(make_scene(make_collision_object("a"), robot=make_robot_state(shoulder=1.0)))
        assert list(shown) == ["Scene Geometry/a"]
        assert world.status("PlanningScene")["URDF"] == (
            "warn",
            "No description was received on topic 'robot_description' yet",
        )
        world.describe("<robot>")
        await world.settle()
        assert world.status("PlanningScene")["URDF"] == ("error", "URDF failed Model parse")
        world.describe(ARM)
        await world.settle()
        assert "Scene Robot/hand" in shown_markers(world.display("PlanningScene"))


async def test_virtual_joint_places_root_link():
    async with planning_scene_world() as (world, source):
        world.move({("map", "base"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        robot = make_robot_state(shoulder=0.0)
        robot.multi_dof_joint_state.header.frame_id = "map"
        robot.multi_dof_joint_state.joint_names = ["virtual_joint"]
        transform = get_message("geometry_msgs/msg/Transform")()
        transform.translation.y = 3.0
        robot.multi_dof_joint_state.transforms = [transform]
        shown = await source.publish_scene(make_scene(robot=robot))
        assert (shown["Scene Robot/base"]["frame"], shown["Scene Robot/base"]["pose"][:3]) == ("map", [0, 3, 0])


async def test_page_receives_only_changed_objects():
    async with planning_scene_world() as (world, source):
        await source.publish_scene(
            make_scene(make_collision_object("a"), make_collision_object("b"), robot=make_robot_state(shoulder=0.0))
        )
        (store,) = world.display("PlanningScene").data()
        _, revision = store.since(0)
        await source.publish_scene(
            make_scene(make_collision_object("a"), make_collision_object("b"), robot=make_robot_state(shoulder=0.0))
        )
        assert store.since(revision)[0] is None


@pytest.mark.parametrize("cls", ["PlanningScene", "Trajectory", "RobotState", "MotionPlanning"])
async def test_planning_scene_file_is_saved_unchanged(cls):
    text = yaml.safe_dump(
        {
            "Visualization Manager": {
                "Displays": [
                    {
                        "Class": f"moveit_rviz_plugin/{cls}",
                        "Enabled": True,
                        "MoveIt_Planning_Time": 5,
                        "Name": cls,
                        "Planned Path": {"Links": {"All Links Enabled": True, "gone": {"Alpha": 1, "Value": True}}},
                        "Planning Metrics": {"Payload": 1},
                        "Planning Request": {"Planning Group": "arm"},
                        "Robot Description": "robot_description",
                        "Scene Robot": {"Links": {"hand": {"Alpha": 1, "Show Axes": False, "Value": True}}},
                        "Value": True,
                    }
                ],
                "Global Options": {"Fixed Frame": "base"},
            }
        }
    )
    async with open_world(type(make_config(cls)).parse(text)) as world:
        world.describe(ARM)
        await world.settle()
        display = world.viewer.displays[0]
        assert display.row().supported
        assert world.viewer.config.text() == text


async def test_disabled_link_is_written_like_rviz():
    async with planning_scene_world() as (world, _):
        world.display("PlanningScene").set_property(("Scene Robot", "Links", "hand"), False)
        (entry,) = yaml.safe_load(world.viewer.config.text())["Visualization Manager"]["Displays"]
        assert entry["Scene Robot"] == {"Links": {"hand": {"Value": False}}}
