"""Displays of geometry messages.

The tests cover poses, Odometry, Path, Polygon, Range, TwistStamped, AccelStamped and Wrench.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world

INVALID_STATUS = ("error", "Message contained invalid floating point values (nans or infs)")


def make_config(cls: str, extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: rviz_default_plugins/{cls}, Enabled: true, Topic: {{Value: /topic}}{extra}}}\n"
    )


def create_publisher(world, cls: str):
    return world.graph.create_node("talker").create_publisher(get_message(world.display(cls).MESSAGE), "/topic", 10)


def make_message(cls: str, frame: str = "tip", **fields):
    instance = get_message(cls)(**fields)
    instance.header.frame_id = frame
    return instance


def make_pose(x: float, y: float = 0.0, w: float = 1.0):
    instance = get_message("geometry_msgs/msg/Pose")()
    instance.position.x, instance.position.y, instance.orientation.w = float(x), float(y), float(w)
    return instance


def make_odometry(x: float, w: float = 1.0):
    instance = make_message("nav_msgs/msg/Odometry")
    instance.pose.pose = make_pose(x, w=w)
    instance.pose.covariance = np.eye(6).ravel() * 0.25
    return instance


def status_rows(world, cls: str) -> dict[str, object]:
    return {row.name: row.value for row in world.display(cls).row().properties}


SIZES = {"Shaft Length": 1.0, "Shaft Radius": 0.05, "Head Length": 0.3, "Head Radius": 0.1}
SCREW = {"Alpha": 1.0, "Arrow Width": 0.5, "History Length": 1}
DEFAULTS = {
    "Pose": {"Shape": "Arrow", "Color": "#ff1900", "Alpha": 1.0, **SIZES},
    "PoseWithCovariance": {"Shape": "Arrow", "Color": "#ff1900", "Alpha": 1.0, **SIZES, "Covariance": True},
    "PoseArray": {"Shape": "Arrow (Flat)", "Color": "#ff1900", "Alpha": 1.0, "Arrow Length": 0.3},
    "Odometry": {
        "Position Tolerance": 0.1,
        "Angle Tolerance": 0.1,
        "Keep": 100,
        "Shape": "Arrow",
        "Covariance": True,
    },
    "Path": {
        "Line Style": "Lines",
        "Color": "#19ff00",
        "Alpha": 1.0,
        "Buffer Length": 1,
        "Offset": None,
        "Pose Style": "None",
    },
    "Polygon": {"Color": "#19ff00", "Alpha": 1.0},
    "Range": {"Color": "#ffffff", "Alpha": 0.5, "Buffer Length": 1},
    "TwistStamped": {
        "Linear Color": "#cc3333",
        "Angular Color": "#cccc33",
        "Linear Arrow Scale": 2.0,
        "Angular Arrow Scale": 2.0,
        "Hide Small Values": True,
        **SCREW,
    },
    "AccelStamped": {
        "Linear Color": "#cc3333",
        "Angular Color": "#cccc33",
        "Linear Arrow Scale": 2.0,
        "Angular Arrow Scale": 2.0,
        "Hide Small Values": True,
        **SCREW,
    },
    "Wrench": {
        "Accept NaN Values": False,
        "Force Color": "#cc3333",
        "Torque Color": "#cccc33",
        "Force Arrow Scale": 2.0,
        "Torque Arrow Scale": 2.0,
        **SCREW,
    },
}


@pytest.mark.parametrize("cls", DEFAULTS)
async def test_properties_and_defaults_match_rviz(cls):
    async with open_world(make_config(cls)) as world:
        assert status_rows(world, cls) == {"Topic": "/topic", **DEFAULTS[cls]}
        (topic,) = (row for row in world.display(cls).row().properties if row.name == "Topic")
        names = ["Depth", "History Policy", "Reliability Policy", "Durability Policy", "Filter size"]
        assert [row.name for row in topic.children] == names


async def test_only_properties_of_selected_shape_are_shown():
    async with open_world(make_config("Pose", ", Shape: Axes")) as world:
        assert status_rows(world, "Pose") == {
            "Topic": "/topic",
            "Shape": "Axes",
            "Axes Length": 1.0,
            "Axes Radius": 0.1,
        }
    async with open_world(make_config("Odometry")) as world:
        (shape,) = (row for row in world.display("Odometry").row().properties if row.name == "Shape")
        assert {row.name: row.value for row in shape.children} == {"Color": "#ff1900", "Alpha": 1.0, **SIZES}
    async with open_world(make_config("PoseArray", ", Shape: Arrow (3D)")) as world:
        values = {"Head Radius": 0.03, "Head Length": 0.07, "Shaft Radius": 0.01, "Shaft Length": 0.23}
        assert values.items() <= status_rows(world, "PoseArray").items()
    async with open_world(make_config("Path", ", Pose Style: Arrows, Line Style: Billboards")) as world:
        values = {"Line Width": 0.03, "Shaft Length": 0.1, "Head Length": 0.2, "Shaft Diameter": 0.1}
        assert {**values, "Head Diameter": 0.3, "Pose Color": "#ff55ff"}.items() <= status_rows(world, "Path").items()
        assert "Radius" not in status_rows(world, "Path")


async def test_covariance_properties_match_rviz():
    async with open_world(make_config("PoseWithCovariance")) as world:
        (covariance,) = (
            row for row in world.display("PoseWithCovariance").row().properties if row.name == "Covariance"
        )
        position, orientation = covariance.children
        assert {row.name: row.value for row in position.children} == {"Color": "#cc33cc", "Alpha": 0.3, "Scale": 1.0}
        assert {row.name: row.value for row in orientation.children} == {
            "Frame": "Local",
            "Color Style": "Unique",
            "Color": "#ffff7f",
            "Alpha": 0.5,
            "Offset": 1.0,
            "Scale": 1.0,
        }


async def test_pose_is_sent_with_pose_of_its_frame():
    async with open_world(make_config("Pose")) as world:
        world.move({("base", "tip"): (1, 2, 3, 0, 0, 0, 1)}, static=True)
        create_publisher(world, "Pose").publish(make_message("geometry_msgs/msg/PoseStamped", pose=make_pose(4)))
        await world.settle()
        (content,) = unpack_contents(world.display("Pose"))
        assert (content.frame, content.pose) == ("tip", [1, 2, 3, 0, 0, 0, 1])
        assert content.fields["poses"].tolist() == [4, 0, 0, 0, 0, 0, 1]
        assert content.fields["covariances"].size == 0
        assert world.status("Pose")["Transform"] == ("ok", "Transform OK")


async def test_pose_with_covariance_sends_covariance():
    async with open_world(make_config("PoseWithCovariance")) as world:
        world.move_arm()
        estimate = make_message("geometry_msgs/msg/PoseWithCovarianceStamped")
        estimate.pose.pose = make_pose(1)
        estimate.pose.covariance = np.arange(36.0)
        create_publisher(world, "PoseWithCovariance").publish(estimate)
        await world.settle()
        (content,) = unpack_contents(world.display("PoseWithCovariance"))
        assert content.fields["covariances"].tolist() == list(range(36))


async def test_all_poses_of_array_are_sent():
    async with open_world(make_config("PoseArray")) as world:
        world.move_arm()
        create_publisher(world, "PoseArray").publish(
            make_message("geometry_msgs/msg/PoseArray", poses=[make_pose(1), make_pose(2)])
        )
        await world.settle()
        (content,) = unpack_contents(world.display("PoseArray"))
        assert content.fields["poses"].reshape(-1, 7)[:, 0].tolist() == [1, 2]


async def test_nav2_particle_cloud_sends_weights():
    parsed = (
        make_config("PoseArray").text().replace("rviz_default_plugins/PoseArray", "nav2_rviz_plugins/ParticleCloud")
    )
    async with open_world(RvizConfig.parse(parsed)) as world:
        assert status_rows(world, "ParticleCloud") == {
            "Topic": "/topic",
            "Shape": "Arrow (Flat)",
            "Color": "#ff1900",
            "Alpha": 1.0,
            "Min Arrow Length": 0.02,
            "Max Arrow Length": 0.3,
            "Arrow Height Scale": 5.0,
        }
        world.move_arm()
        particle = get_message("nav2_msgs/msg/Particle")
        particles = [particle(pose=make_pose(1), weight=0.25), particle(pose=make_pose(2), weight=0.75)]
        out = create_publisher(world, "ParticleCloud")
        out.publish(make_message("nav2_msgs/msg/ParticleCloud", particles=particles))
        await world.settle()
        (content,) = unpack_contents(world.display("ParticleCloud"))
        assert content.fields["poses"].reshape(-1, 7)[:, 0].tolist() == [1, 2]
        assert content.fields["weights"].tolist() == [0.25, 0.75]
        out.publish(make_message("nav2_msgs/msg/ParticleCloud", particles=[particle(weight=math.nan)]))
        await world.settle()
        assert world.status("ParticleCloud")["Message"] == INVALID_STATUS


async def test_odometry_adds_arrow_after_distance_or_rotation():
    async with open_world(make_config("Odometry")) as world:
        world.move_arm()
        out = create_publisher(world, "Odometry")
        for x in (0.0, 0.05, 0.12, 0.15, 0.3):
            out.publish(make_odometry(x))
        await world.settle()
        turned = make_odometry(0.3)
        turned.pose.pose.orientation.z, turned.pose.pose.orientation.w = math.sin(0.1), math.cos(0.1)
        out.publish(turned)
        await world.settle()
        marks = [content.fields["poses"][0] for content in unpack_contents(world.display("Odometry"))]
        np.testing.assert_allclose(marks, [0, 0.12, 0.3, 0.3])


async def test_odometry_keep_limits_number_of_arrows():
    async with open_world(make_config("Odometry", ", Keep: 2")) as world:
        world.move_arm()
        out = create_publisher(world, "Odometry")
        for x in range(5):
            out.publish(make_odometry(x))
        await world.settle()
        display = world.display("Odometry")
        assert sorted(content.fields["poses"][0] for content in unpack_contents(display)) == [3, 4]
        display.set_property(("Keep",), 0)
        for x in range(5, 9):
            out.publish(make_odometry(x))
        await world.settle()
        assert [content.fields["poses"][0] for content in unpack_contents(display)] == [3, 4, 5, 6, 7, 8]
        display.set_property(("Keep",), 3)
        assert [content.fields["poses"][0] for content in unpack_contents(display)] == [6, 7, 8]


async def test_odometry_rejects_invalid_quaternion():
    async with open_world(make_config("Odometry")) as world:
        world.move_arm()
        out = create_publisher(world, "Odometry")
        out.publish(make_odometry(0, w=0.5))
        await world.settle()
        level, text = world.status("Odometry")["Message"]
        assert (level, text.startswith("Message contained unnormalized quaternion")) == ("error", True)
        assert unpack_contents(world.display("Odometry")) == []
        out.publish(make_odometry(0))
        await world.settle()
        assert "Message" not in world.status("Odometry")


async def test_path_buffer_length_keeps_last_paths():
    async with open_world(make_config("Path", ", Buffer Length: 2")) as world:
        world.move_arm()
        out = create_publisher(world, "Path")
        for count in (2, 3, 4):
            stamped = [make_message("geometry_msgs/msg/PoseStamped", pose=make_pose(x)) for x in range(count)]
            out.publish(make_message("nav_msgs/msg/Path", poses=stamped))
        await world.settle()
        paths = [content.fields["poses"].reshape(-1, 7) for content in unpack_contents(world.display("Path"))]
        assert sorted(map(len, paths)) == [3, 4]


async def test_polygon_is_sent_as_corners():
    async with open_world(make_config("Polygon")) as world:
        world.move_arm()
        polygon = make_message("geometry_msgs/msg/PolygonStamped")
        corner = get_message("geometry_msgs/msg/Point32")
        polygon.polygon.points = [corner(x=0.0, y=0.0, z=0.0), corner(x=1.0, y=0.0, z=0.0), corner(x=0.0, y=1.0, z=0.0)]
        create_publisher(world, "Polygon").publish(polygon)
        await world.settle()
        (content,) = unpack_contents(world.display("Polygon"))
        assert content.fields["points"].tolist() == [0, 0, 0, 1, 0, 0, 0, 1, 0]


@pytest.mark.parametrize(
    ("measured", "min_range", "max_range", "shown"),
    [
        (0.5, 0.1, 2.0, 0.5),
        (0.05, 0.1, 2.0, 0.0),
        (math.inf, 0.1, 2.0, 0.0),
        (-math.inf, 0.3, 0.3, 0.3),
        (math.inf, 0.3, 0.3, 0.0),
        (math.nan, 0.3, 0.3, 0.0),
    ],
)
async def test_range_length_is_zero_if_invalid(measured, min_range, max_range, shown):
    async with open_world(make_config("Range")) as world:
        world.move_arm()
        reading = make_message(
            "sensor_msgs/msg/Range", range=measured, min_range=min_range, max_range=max_range, field_of_view=0.2
        )
        create_publisher(world, "Range").publish(reading)
        await world.settle()
        (content,) = unpack_contents(world.display("Range"))
        assert content.fields["range"] == pytest.approx(shown)
        assert content.fields["field_of_view"] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("cls", "part", "linear", "angular"),
    [
        ("TwistStamped", "twist", "linear", "angular"),
        ("AccelStamped", "accel", "linear", "angular"),
        ("Wrench", "wrench", "force", "torque"),
    ],
)
async def test_linear_and_angular_vectors_are_sent(cls, part, linear, angular):
    async with open_world(make_config(cls)) as world:
        world.move_arm()
        vectors = make_message(world.display(cls).MESSAGE)
        getattr(getattr(vectors, part), linear).x = 1.5
        getattr(getattr(vectors, part), angular).z = -2.0
        out = create_publisher(world, cls)
        out.publish(vectors)
        await world.settle()
        (content,) = unpack_contents(world.display(cls))
        assert (content.fields["linear"], content.fields["angular"]) == ([1.5, 0, 0], [0, 0, -2.0])
        getattr(getattr(vectors, part), linear).y = math.nan
        out.publish(vectors)
        await world.settle()
        assert world.status(cls)["Message"] == INVALID_STATUS
        if cls != "Wrench":
            return
        world.display(cls).set_property(("Accept NaN Values",), True)
        out.publish(vectors)
        await world.settle()
        assert "Message" not in world.status(cls)


@pytest.mark.parametrize("cls", ["Pose", "PoseArray", "PoseWithCovariance", "Odometry", "Path", "Polygon"])
async def test_nonfinite_values_are_rejected(cls):
    async with open_world(make_config(cls)) as world:
        world.move_arm()
        instance = make_message(world.display(cls).MESSAGE)
        invalid_pose = make_pose(math.nan)
        if cls == "Pose":
            instance.pose = invalid_pose
        elif cls == "PoseArray":
            instance.poses = [invalid_pose]
        elif cls == "Path":
            instance.poses = [make_message("geometry_msgs/msg/PoseStamped", pose=invalid_pose)]
        elif cls == "Polygon":
            instance.polygon.points = [get_message("geometry_msgs/msg/Point32")(x=math.inf)]
        else:
            instance.pose.pose = invalid_pose
        create_publisher(world, cls).publish(instance)
        await world.settle()
        assert world.status(cls)["Message"] == INVALID_STATUS
        assert unpack_contents(world.display(cls)) == []
