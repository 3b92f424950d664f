"""The displays of Autoware: paths, objects, planning factors, histories and the polar grid."""

from __future__ import annotations

import math
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
import pytest

from linkwright.rviz import RvizConfig
from tests.rviz.displays import autoware_messages as street
from tests.viewer.contents import shown_markers
from tests.viewer.scene import open_world

FILE = """\
Visualization Manager:
  Displays:
    - {{Class: "{cls}", Enabled: true, Name: Street, Topic: {{Value: /street}}{extra}}}
  Global Options:
    Fixed Frame: base
"""


@asynccontextmanager
async def shown(cls: str, *messages: Any, extra: str = "") -> Any:
    """Publish messages to a display, and yield the world, the display and a function that reads its markers."""
    text = FILE.format(cls=cls, extra=f", {extra}" if extra else "")
    async with open_world(RvizConfig.parse(text)) as world:
        world.move_arm()
        await world.settle()
        if messages:
            publisher = world.graph.create_node("car").create_publisher(type(messages[0]), "/street", 10)
            await world.settle()
            for message in messages:
                publisher.publish(message)
                await world.settle()
        (display,) = world.viewer.displays
        yield world, display, lambda: shown_markers(display) if len(display._store) else {}


def status_of(display: Any) -> dict[str, tuple[str, str]]:
    return {row.name: (row.level, row.text) for row in display.status}


def corners_of(marker: dict) -> np.ndarray:
    return np.asarray(marker["points"]).reshape(-1, 3)


def colors_of(marker: dict) -> np.ndarray:
    return np.asarray(marker["colors"]).reshape(-1, 4)


async def test_trajectory_is_a_band_of_the_vehicles_width_colored_by_velocity():
    async with shown("rviz_plugins/Trajectory", street.make_trajectory()) as (_, display, markers):
        assert set(markers()) == {"path/0", "velocity/0"}
        band = corners_of(markers()["path/0"]).reshape(-1, 6, 3)
        assert len(band) == 20
        np.testing.assert_allclose(band[0, :2], [(0, -0.915, 0), (0, 0.915, 0)], atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(band[:, 0] - band[:, 1], axis=1), 1.83, rtol=1e-5)
        colors = colors_of(markers()["path/0"]).reshape(-1, 6, 4)
        np.testing.assert_allclose(colors[0, 0, :3], np.array([0x3F, 0x2E, 0xE3]) / 255, atol=1e-6)
        np.testing.assert_allclose(colors[-1, -1, :3], np.array([0x00, 0xE6, 0x78]) / 255, atol=1e-6)
        line = corners_of(markers()["velocity/0"])
        np.testing.assert_allclose(line[:, 2], 0.3 * np.linspace(0, 4, 21), atol=1e-6)
        for path, value in ((("View Path", "Constant Width"), True), (("View Path", "Fade Out Distance"), 5.0)):
            display.set_property(path, value)
        band = corners_of(markers()["path/0"]).reshape(-1, 6, 3)
        np.testing.assert_allclose(np.linalg.norm(band[:, 0] - band[:, 1], axis=1), 2.0, rtol=1e-5)
        opacities = colors_of(markers()["path/0"]).reshape(-1, 6, 4)[:, 5, 3]
        assert opacities[-1] == 0
        assert opacities[0] == 1
        assert 0 < opacities[-4] < 1


async def test_path_has_bounds_footprints_disks_and_texts():
    async with shown("rviz_plugins/Path", street.make_path()) as (_, display, markers):
        assert corners_of(markers()["drivable area/1"]).tolist() == [[0, -2, 0], [5, -2, 0]]
        for name in ("View Footprint", "View Point", "View Text Velocity", "View Text Slope"):
            display.set_property((name,), True)
        first = corners_of(markers()["footprint/0"])[:8]
        assert first.max(axis=0).tolist() == pytest.approx([4.77 - 1.03, 0.915, 0])
        assert first.min(axis=0).tolist() == pytest.approx([-1.03, -0.915, 0])
        assert len(corners_of(markers()["points/0"])) == 21 * 8 * 3
        assert markers()["velocity text/20"]["text"] == "4.00"
        assert markers()["slope text/3"]["text"] == "0.00"
        display.set_property(("View Drivable Area",), False)
        assert "drivable area/1" not in markers()


async def test_lane_numbers_are_written_at_the_points_of_a_path():
    points = [
        street.make("autoware_internal_planning_msgs/PathPointWithLaneId", point=point, lane_ids=[7, 8])
        for point in street.make_points("PathPoint", 3)
    ]
    message = street.stamped("autoware_internal_planning_msgs/PathWithLaneId", points=points)
    async with shown("rviz_plugins/PathWithLaneId", message) as (_, _, markers):
        assert markers()["lanes/2"]["text"] == "7, 8"
        assert "path/0" in markers()


async def test_path_that_is_not_finite_is_refused():
    message = street.make_trajectory()
    message.points[3].pose.position.x = math.nan
    async with shown("rviz_plugins/Trajectory", message) as (_, display, markers):
        assert markers() == {}
        assert "invalid floating point" in status_of(display)["Message"][1]


async def test_objects_have_shapes_texts_vectors_and_uncertainties():
    async with shown("autoware_perception_rviz_plugin/DetectedObjects", street.make_detected()) as (
        _,
        display,
        markers,
    ):
        box = corners_of(markers()["shape/0"])
        assert box.max(axis=0).tolist() == [2, 1, 0.75]
        assert len(box) == 2 * (4 + 4 + 4 + 2), "twelve edges, and two that mark the front"
        assert len(corners_of(markers()["shape/2"])) == 2 * 12
        assert markers()["label/0"]["text"] == "CAR"
        assert corners_of(markers()["twist/0"]).tolist() == [[0, 0, 0], [3, 0, 0]]
        ellipse = markers()["position covariance/0"]
        # The smaller deviation is 0.2 m; within 2.448 deviations are 95 %.
        assert sorted(ellipse["scale"][:2]) == pytest.approx([2 * 2.4477 * 0.2, 2 * 2.4477 * 0.5], rel=1e-4)
        assert markers()["shape/0"]["color"] == pytest.approx([1, 1, 1, 0.999])
        display.set_property(("Per Class Color",), True)
        assert markers()["shape/0"]["color"][:3] == pytest.approx([30 / 255, 144 / 255, 1])
        for kind, counts in (("Skeleton 2D", (12, 40, 8)), ("None", None)):
            display.set_property(("Shape", "Shape Type"), kind)
            found = [len(corners_of(marker)) for name, marker in sorted(markers().items()) if name.startswith("shape/")]
            assert found == list(counts or ())
        display.set_property(("Shape", "Shape Type"), "Fill")
        assert markers()["shape/0"]["shape"] == "cube"
        assert markers()["shape/1"]["scale"] == pytest.approx([0.8, 0.8, 1.5])
        assert len(corners_of(markers()["shape/2"])) == 4 * 9
        for path in (
            ("Vector", "Yaw Rate"),
            ("Covariance", "Yaw"),
            ("Covariance", "Twist"),
            ("Covariance", "Yaw Rate"),
        ):
            display.set_property(path, True)
        assert {"yaw rate/0", "yaw covariance/0", "twist covariance/0", "yaw rate covariance/0"} <= set(markers())
        arc = corners_of(markers()["yaw rate/0"])
        assert math.atan2(arc[-2][1], arc[-2][0]) == pytest.approx(0.5)


async def test_tracked_objects_have_ids_and_are_selected_by_motion():
    async with shown("autoware_perception_rviz_plugin/TrackedObjects", street.make_tracked()) as (_, display, markers):
        assert markers()["uuid/0"]["text"] == "0001"
        display.set_property(("Text", "Acceleration"), True)
        assert markers()["acceleration/0"]["text"] == "1.0[m/s^2]"
        display.set_property(("Text", "Velocity"), True)
        assert markers()["velocity/0"]["text"] == "10[km/h]"
        display.set_property(("Dynamic Status",), "Static")
        assert {name for name in markers() if name.startswith("shape/")} == {"shape/1"}


async def test_predicted_objects_have_paths_with_probabilities():
    message = street.make_predicted()
    async with shown("autoware_perception_rviz_plugin/PredictedObjects", message) as (_, display, markers):
        assert corners_of(markers()["path/0"])[-1].tolist() == [10, -10, 0]
        assert markers()["path confidence/1"]["text"] == "0.30"
        display.set_property(("Path", "Path Footprint"), True)
        assert len(corners_of(markers()["path footprint/0"])) == 6 * 8
        display.set_property(("Path", "Path Resolution"), "Simple")
        assert len(corners_of(markers()["path/0"])) == 3


async def test_planning_factor_is_a_wall_with_the_module_and_the_reason():
    cls = "tier4_planning_factor_rviz_plugin/PlanningFactorRvizPlugin"
    async with shown(cls, street.make_factors()) as (_, display, markers):
        wall = markers()["stop wall/0"]
        assert wall["pose"][:3] == pytest.approx([5, 1, 1])
        assert wall["scale"] == pytest.approx([0.1, 5, 2])
        assert markers()["stop wall text/0"]["text"] == "crosswalk (pedestrian)"
        assert len(markers()) == 2
        display.set_property(("BaseLink to Front",), 3.0)
        assert markers()["stop wall/0"]["pose"][:3] == pytest.approx([5, 4, 1])
        display.set_property(("Show Safety Factors",), True)
        assert markers()["safety text/1"]["text"] == "crosswalk"
        red, green, *_ = markers()["safety arrow/1"]["color"]
        assert red > green


def make_poses(xs: list[float], kind: str = "PoseStamped") -> list[Any]:
    messages = []
    for x in xs:
        message = street.stamped(f"geometry_msgs/{kind}")
        street.place(message.pose if kind == "PoseStamped" else message.pose.pose, x, 0.0)
        messages.append(message)
    return messages


async def test_pose_history_is_a_line_of_the_last_poses():
    async with shown("rviz_plugins::PoseHistory", *make_poses([1, 2, 3, 4]), extra="Buffer Size: 3") as parts:
        _, display, markers = parts
        assert corners_of(markers()["history/0"])[:, 0].tolist() == [2, 3, 4]
        display.set_property(("Line", "Color"), "#00ff00")
        assert corners_of(markers()["history/0"])[:, 0].tolist() == [2, 3, 4], "a property adds no pose"
        assert markers()["history/0"]["color"][:3] == [0, 1, 0]
        display.set_property(("Buffer Size",), 2)
        assert corners_of(markers()["history/0"])[:, 0].tolist() == [3, 4]


async def test_pose_history_starts_anew_in_another_frame():
    first, second, third = make_poses([1, 2, 3])
    second.header.frame_id = third.header.frame_id = "tip"
    async with shown("rviz_plugins::PoseHistory", first, second, third) as (_, _, markers):
        assert len(corners_of(markers()["history/0"])) == 2


async def test_colored_history_takes_the_values_of_another_topic():
    cls = "rviz_plugins::ColoredPoseWithCovarianceHistory"
    async with shown(cls, extra="Value Topic: /value") as (world, display, markers):
        poses = make_poses([1, 2, 3], "PoseWithCovarianceStamped")
        node = world.graph.create_node("car")
        values = [street.make("autoware_internal_debug_msgs/Float32Stamped", data=value) for value in (0.0, 5.0, 10.0)]
        pose_publisher = node.create_publisher(type(poses[0]), "/street", 10)
        value_publisher = node.create_publisher(type(values[0]), "/value", 10)
        await world.settle()
        for value, pose in zip(values, poses, strict=True):
            value_publisher.publish(value)
            await world.settle()
            pose_publisher.publish(pose)
            await world.settle()
        assert colors_of(markers()["history/0"]).tolist() == [[0, 0, 1, 1], [0.5, 0, 0.5, 1], [1, 0, 0, 1]]
        display.set_property(("Auto Set Min/Max",), False)
        display.set_property(("Path", "Greater Color"), "#ffffff")
        assert colors_of(markers()["history/0"]).tolist() == [[0, 0, 1, 1], [1, 1, 1, 1], [1, 1, 1, 1]]
        assert status_of(display)["Value Topic"] == ("ok", "OK")
        display.set_property(("Value Topic",), "")
        assert status_of(display)["Value Topic"][0] == "error"


async def test_pose_with_id_has_axes_and_a_text():
    message = street.stamped("autoware_planning_msgs/PoseWithUuidStamped")
    street.place(message.pose, 1.0, 2.0, 0.0, math.pi / 2)
    message.uuid.uuid = np.arange(16, dtype=np.uint8)
    async with shown("rviz_plugins/PoseWithUuidStamped", message) as (_, display, markers):
        np.testing.assert_allclose(corners_of(markers()["axes/0"]), [(1, 2, 0), (1, 3.5, 0)], atol=1e-6)
        display.set_property(("UUID",), True)
        assert markers()["id/0"]["text"] == "000102030405060708090a0b0c0d0e0f"


async def test_polar_grid_has_circles_and_a_wave_around_its_frame():
    extra = "Reference Frame: tip, Max Range: 30, Delta Range: 10"
    async with shown("rviz_plugins/PolarGridDisplay", extra=extra) as (world, display, markers):
        assert set(markers()) == {"circles/1", "circles/2", "circles/3", "wave/0"}
        np.testing.assert_allclose(np.linalg.norm(corners_of(markers()["circles/2"]), axis=1), 20, rtol=1e-6)
        assert markers()["circles/3"]["frame"] == "tip"
        assert markers()["circles/3"]["color"][3] == pytest.approx(0.01)
        radius = np.linalg.norm(corners_of(markers()["wave/0"])[0])
        await world.settle()
        display.set_property(("Wave Velocity",), 0.0)
        assert radius < 30
        assert set(markers()) == {"circles/1", "circles/2", "circles/3"}
        display.set_checked(False)
        display.on_enabled_changed()
        assert markers() == {}
