"""Points, vectors, poses, covariances and wrenches in another frame."""

from __future__ import annotations

from copy import deepcopy
from math import cos, pi, sin

import numpy as np
import pytest

from linkwright.graph.transforms.geometry import (
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
    do_transform_wrench,
    transform_covariance,
)
from linkwright.messages import get_message
from tests.graph.transforms.test_core import make_transform

TRANSFORM = make_transform("map", "base", 3, x=10.0, yaw=pi / 2)


def make_message(name):
    return get_message(f"geometry_msgs/msg/{name}")()


def approx_xyz(vector):
    return pytest.approx((vector.x, vector.y, vector.z), abs=1e-12)


def test_points_are_rotated_and_translated_and_vectors_rotated():
    point = make_message("PointStamped")
    point.point.x = 1.0
    before = deepcopy(TRANSFORM)
    transformed = do_transform_point(point, TRANSFORM)
    assert approx_xyz(transformed.point) == (10.0, 1.0, 0.0)
    assert (transformed.header.frame_id, transformed.header.stamp.sec) == ("map", 3)
    vector = make_message("Vector3Stamped")
    vector.vector.x = 2.0
    assert approx_xyz(do_transform_vector3(vector, TRANSFORM).vector) == (0.0, 2.0, 0.0)
    assert before == TRANSFORM


def test_poses_are_transformed():
    pose = make_message("PoseStamped")
    pose.pose.position.y = 1.0
    pose.pose.orientation.z, pose.pose.orientation.w = sin(pi / 4), cos(pi / 4)
    transformed = do_transform_pose_stamped(pose, TRANSFORM)
    assert approx_xyz(transformed.pose.position) == (9.0, 0.0, 0.0)
    assert transformed.pose.orientation.z == pytest.approx(1.0)
    assert do_transform_pose(pose, TRANSFORM) == transformed
    assert do_transform_pose(pose.pose, TRANSFORM) == transformed.pose
    pose.pose.orientation.z = pose.pose.orientation.w = 0.0
    assert do_transform_pose(pose.pose, TRANSFORM).orientation.z == pytest.approx(sin(pi / 4))


def test_covariances_rotate_with_pose():
    pose = make_message("PoseWithCovarianceStamped")
    pose.pose.covariance = np.diag([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).reshape(36)
    transformed = do_transform_pose_with_covariance_stamped(pose, TRANSFORM)
    assert np.diag(np.asarray(transformed.pose.covariance).reshape(6, 6)) == pytest.approx(
        [2.0, 1.0, 3.0, 5.0, 4.0, 6.0]
    )
    assert approx_xyz(transformed.pose.pose.position) == (10.0, 0.0, 0.0)
    assert transform_covariance(pose.pose.covariance, TRANSFORM).shape == (36,)


def test_wrenches_and_polygons_are_transformed():
    wrench = make_message("WrenchStamped")
    wrench.wrench.force.x, wrench.wrench.torque.y = 1.0, 1.0
    transformed = do_transform_wrench(wrench, TRANSFORM)
    assert approx_xyz(transformed.wrench.force) == (0.0, 1.0, 0.0)
    assert approx_xyz(transformed.wrench.torque) == (-1.0, 0.0, 0.0)
    polygon = make_message("PolygonStamped")
    polygon.polygon.points = [get_message("geometry_msgs/msg/Point32")(x=1.0)]
    (point,) = do_transform_polygon_stamped(polygon, TRANSFORM).polygon.points
    assert (point.x, point.y) == (pytest.approx(10.0), pytest.approx(1.0))
