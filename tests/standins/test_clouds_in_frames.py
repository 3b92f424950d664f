"""Point clouds in another frame, by the stand-in of tf2."""

from __future__ import annotations

import numpy as np
import pytest
import rclpy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header
from tf2_sensor_msgs import do_transform_cloud, transform_points
from tf_transformations import quaternion_from_euler


@pytest.fixture
def rotated_transform():
    """Return a transform of one meter along x and a quarter turn around z."""
    transform = TransformStamped(child_frame_id="lidar")
    transform.header.frame_id = "base"
    transform.transform.translation.x = 1.0
    rotation = transform.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = quaternion_from_euler(0, 0, np.pi / 2)
    return transform


def test_transform_points_applies_transform(rotated_transform):
    for transform in (rotated_transform, rotated_transform.transform):
        np.testing.assert_allclose(
            transform_points([[1, 0, 0], [0, 0, 2]], transform), [[1, 1, 0], [1, 0, 2]], atol=1e-12
        )


def test_transformed_cloud_keeps_other_fields(rotated_transform):
    fields = [
        PointField(name=name, offset=4 * index, datatype=7, count=1) for index, name in enumerate(["x", "y", "z", "i"])
    ]
    cloud = point_cloud2.create_cloud(Header(frame_id="lidar"), fields, [(1.0, 0.0, 0.0, 7.0), (0.0, 0.0, 2.0, 8.0)])
    moved = do_transform_cloud(cloud, rotated_transform)
    assert moved.header.frame_id == "base"
    assert (moved.width, moved.point_step, list(moved.fields)) == (2, 16, fields)
    points = [list(point) for point in point_cloud2.read_points(moved)]
    np.testing.assert_allclose(points, [[1, 1, 0, 7], [1, 0, 2, 8]], atol=1e-6)


def test_buffer_transforms_clouds(rotated_transform, monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    buffer = tf2_ros.Buffer()
    buffer.set_transform_static(rotated_transform, "test")
    cloud = point_cloud2.create_cloud_xyz32(Header(frame_id="lidar"), [(1.0, 0.0, 0.0)])
    moved = buffer.transform(cloud, "base", rclpy.duration.Duration(seconds=0))
    np.testing.assert_allclose([list(point) for point in point_cloud2.read_points(moved)], [[1, 1, 0]], atol=1e-6)
