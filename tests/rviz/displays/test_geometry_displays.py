"""Pose, PoseArray, PoseWithCovariance, Odometry, Path, Polygon, Range, TwistStamped, AccelStamped and Wrench."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.rviz import RvizConfig
from tests.viewer.contents import contents
from tests.viewer.scene import world

INVALID = ("error", "Message contained invalid floating point values (nans or infs)")


def config(cls: str, extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: rviz_default_plugins/{cls}, Enabled: true, Topic: {{Value: /topic}}{extra}}}\n"
    )


def publisher(w, cls: str):
    return w.graph.create_node("talker").create_publisher(get_message(w.display(cls).MESSAGE), "/topic", 10)


def message(cls: str, frame: str = "tip", **fields):
    made = get_message(cls)(**fields)
    made.header.frame_id = frame
    return made


def pose(x: float, y: float = 0.0, w: float = 1.0):
    made = get_message("geometry_msgs/msg/Pose")()
    made.position.x, made.position.y, made.orientation.w = float(x), float(y), float(w)
    return made


def odometry(x: float, w: float = 1.0):
    made = message("nav_msgs/msg/Odometry")
    made.pose.pose = pose(x, w=w)
    made.pose.covariance = np.eye(6).ravel() * 0.25
    return made


def rows(w, cls: str) -> dict[str, object]:
    return {row.name: row.value for row in w.display(cls).row().properties}


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
    async with world(config(cls)) as w:
        assert rows(w, cls) == {"Topic": "/topic", **DEFAULTS[cls]}
        (topic,) = (row for row in w.display(cls).row().properties if row.name == "Topic")
        names = ["Depth", "History Policy", "Reliability Policy", "Durability Policy", "Filter size"]
        assert [row.name for row in topic.children] == names


async def test_only_properties_of_selected_shape_are_shown():
    async with world(config("Pose", ", Shape: Axes")) as w:
        assert rows(w, "Pose") == {"Topic": "/topic", "Shape": "Axes", "Axes Length": 1.0, "Axes Radius": 0.1}
    async with world(config("Odometry")) as w:
        (shape,) = (row for row in w.display("Odometry").row().properties if row.name == "Shape")
        assert {row.name: row.value for row in shape.children} == {"Color": "#ff1900", "Alpha": 1.0, **SIZES}
    async with world(config("PoseArray", ", Shape: Arrow (3D)")) as w:
        values = {"Head Radius": 0.03, "Head Length": 0.07, "Shaft Radius": 0.01, "Shaft Length": 0.23}
        assert values.items() <= rows(w, "PoseArray").items()
    async with world(config("Path", ", Pose Style: Arrows, Line Style: Billboards")) as w:
        values = {"Line Width": 0.03, "Shaft Length": 0.1, "Head Length": 0.2, "Shaft Diameter": 0.1}
        assert {**values, "Head Diameter": 0.3, "Pose Color": "#ff55ff"}.items() <= rows(w, "Path").items()
        assert "Radius" not in rows(w, "Path")


async def test_covariance_properties_match_rviz():
    async with world(config("PoseWithCovariance")) as w:
        (covariance,) = (row for row in w.display("PoseWithCovariance").row().properties if row.name == "Covariance")
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
    async with world(config("Pose")) as w:
        w.move({("base", "tip"): (1, 2, 3, 0, 0, 0, 1)}, static=True)
        publisher(w, "Pose").publish(message("geometry_msgs/msg/PoseStamped", pose=pose(4)))
        await w.settle()
        (content,) = contents(w.display("Pose"))
        assert (content.frame, content.pose) == ("tip", [1, 2, 3, 0, 0, 0, 1])
        assert content.fields["poses"].tolist() == [4, 0, 0, 0, 0, 0, 1]
        assert content.fields["covariances"].size == 0
        assert w.status("Pose")["Transform"] == ("ok", "Transform OK")


async def test_pose_with_covariance_sends_covariance():
    async with world(config("PoseWithCovariance")) as w:
        w.move_arm()
        made = message("geometry_msgs/msg/PoseWithCovarianceStamped")
        made.pose.pose = pose(1)
        made.pose.covariance = np.arange(36.0)
        publisher(w, "PoseWithCovariance").publish(made)
        await w.settle()
        (content,) = contents(w.display("PoseWithCovariance"))
        assert content.fields["covariances"].tolist() == list(range(36))


async def test_all_poses_of_array_are_sent():
    async with world(config("PoseArray")) as w:
        w.move_arm()
        publisher(w, "PoseArray").publish(message("geometry_msgs/msg/PoseArray", poses=[pose(1), pose(2)]))
        await w.settle()
        (content,) = contents(w.display("PoseArray"))
        assert content.fields["poses"].reshape(-1, 7)[:, 0].tolist() == [1, 2]


async def test_nav2_particle_cloud_sends_weights():
    parsed = config("PoseArray").text().replace("rviz_default_plugins/PoseArray", "nav2_rviz_plugins/ParticleCloud")
    async with world(RvizConfig.parse(parsed)) as w:
        assert rows(w, "ParticleCloud") == {
            "Topic": "/topic",
            "Shape": "Arrow (Flat)",
            "Color": "#ff1900",
            "Alpha": 1.0,
            "Min Arrow Length": 0.02,
            "Max Arrow Length": 0.3,
            "Arrow Height Scale": 5.0,
        }
        w.move_arm()
        particle = get_message("nav2_msgs/msg/Particle")
        particles = [particle(pose=pose(1), weight=0.25), particle(pose=pose(2), weight=0.75)]
        out = publisher(w, "ParticleCloud")
        out.publish(message("nav2_msgs/msg/ParticleCloud", particles=particles))
        await w.settle()
        (content,) = contents(w.display("ParticleCloud"))
        assert content.fields["poses"].reshape(-1, 7)[:, 0].tolist() == [1, 2]
        assert content.fields["weights"].tolist() == [0.25, 0.75]
        out.publish(message("nav2_msgs/msg/ParticleCloud", particles=[particle(weight=math.nan)]))
        await w.settle()
        assert w.status("ParticleCloud")["Message"] == INVALID


async def test_odometry_adds_arrow_after_distance_or_rotation():
    async with world(config("Odometry")) as w:
        w.move_arm()
        out = publisher(w, "Odometry")
        for x in (0.0, 0.05, 0.12, 0.15, 0.3):
            out.publish(odometry(x))
        await w.settle()
        turned = odometry(0.3)
        turned.pose.pose.orientation.z, turned.pose.pose.orientation.w = math.sin(0.1), math.cos(0.1)
        out.publish(turned)
        await w.settle()
        marks = [content.fields["poses"][0] for content in contents(w.display("Odometry"))]
        np.testing.assert_allclose(marks, [0, 0.12, 0.3, 0.3])


async def test_odometry_keep_limits_number_of_arrows():
    async with world(config("Odometry", ", Keep: 2")) as w:
        w.move_arm()
        out = publisher(w, "Odometry")
        for x in range(5):
            out.publish(odometry(x))
        await w.settle()
        display = w.display("Odometry")
        assert sorted(content.fields["poses"][0] for content in contents(display)) == [3, 4]
        display.set_property(("Keep",), 0)
        for x in range(5, 9):
            out.publish(odometry(x))
        await w.settle()
        assert [content.fields["poses"][0] for content in contents(display)] == [3, 4, 5, 6, 7, 8]
        display.set_property(("Keep",), 3)
        assert [content.fields["poses"][0] for content in contents(display)] == [6, 7, 8]


async def test_odometry_rejects_invalid_quaternion():
    async with world(config("Odometry")) as w:
        w.move_arm()
        out = publisher(w, "Odometry")
        out.publish(odometry(0, w=0.5))
        await w.settle()
        level, text = w.status("Odometry")["Message"]
        assert (level, text.startswith("Message contained unnormalized quaternion")) == ("error", True)
        assert contents(w.display("Odometry")) == []
        out.publish(odometry(0))
        await w.settle()
        assert "Message" not in w.status("Odometry")


async def test_path_buffer_length_keeps_last_paths():
    async with world(config("Path", ", Buffer Length: 2")) as w:
        w.move_arm()
        out = publisher(w, "Path")
        for count in (2, 3, 4):
            stamped = [message("geometry_msgs/msg/PoseStamped", pose=pose(x)) for x in range(count)]
            out.publish(message("nav_msgs/msg/Path", poses=stamped))
        await w.settle()
        paths = [content.fields["poses"].reshape(-1, 7) for content in contents(w.display("Path"))]
        assert sorted(map(len, paths)) == [3, 4]


async def test_polygon_is_sent_as_corners():
    async with world(config("Polygon")) as w:
        w.move_arm()
        made = message("geometry_msgs/msg/PolygonStamped")
        corner = get_message("geometry_msgs/msg/Point32")
        made.polygon.points = [corner(x=0.0, y=0.0, z=0.0), corner(x=1.0, y=0.0, z=0.0), corner(x=0.0, y=1.0, z=0.0)]
        publisher(w, "Polygon").publish(made)
        await w.settle()
        (content,) = contents(w.display("Polygon"))
        assert content.fields["points"].tolist() == [0, 0, 0, 1, 0, 0, 0, 1, 0]


@pytest.mark.parametrize(
    ("measured", "least", "most", "shown"),
    [
        (0.5, 0.1, 2.0, 0.5),
        (0.05, 0.1, 2.0, 0.0),
        (math.inf, 0.1, 2.0, 0.0),
        (-math.inf, 0.3, 0.3, 0.3),
        (math.inf, 0.3, 0.3, 0.0),
        (math.nan, 0.3, 0.3, 0.0),
    ],
)
async def test_range_length_is_zero_if_invalid(measured, least, most, shown):
    async with world(config("Range")) as w:
        w.move_arm()
        made = message("sensor_msgs/msg/Range", range=measured, min_range=least, max_range=most, field_of_view=0.2)
        publisher(w, "Range").publish(made)
        await w.settle()
        (content,) = contents(w.display("Range"))
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
    async with world(config(cls)) as w:
        w.move_arm()
        made = message(w.display(cls).MESSAGE)
        getattr(getattr(made, part), linear).x = 1.5
        getattr(getattr(made, part), angular).z = -2.0
        out = publisher(w, cls)
        out.publish(made)
        await w.settle()
        (content,) = contents(w.display(cls))
        assert (content.fields["linear"], content.fields["angular"]) == ([1.5, 0, 0], [0, 0, -2.0])
        getattr(getattr(made, part), linear).y = math.nan
        out.publish(made)
        await w.settle()
        assert w.status(cls)["Message"] == INVALID
        if cls != "Wrench":
            return
        w.display(cls).set_property(("Accept NaN Values",), True)
        out.publish(made)
        await w.settle()
        assert "Message" not in w.status(cls)


@pytest.mark.parametrize("cls", ["Pose", "PoseArray", "PoseWithCovariance", "Odometry", "Path", "Polygon"])
async def test_nonfinite_values_are_rejected(cls):
    async with world(config(cls)) as w:
        w.move_arm()
        made = message(w.display(cls).MESSAGE)
        bad = pose(math.nan)
        if cls == "Pose":
            made.pose = bad
        elif cls == "PoseArray":
            made.poses = [bad]
        elif cls == "Path":
            made.poses = [message("geometry_msgs/msg/PoseStamped", pose=bad)]
        elif cls == "Polygon":
            made.polygon.points = [get_message("geometry_msgs/msg/Point32")(x=math.inf)]
        else:
            made.pose.pose = bad
        publisher(w, cls).publish(made)
        await w.settle()
        assert w.status(cls)["Message"] == INVALID
        assert contents(w.display(cls)) == []
