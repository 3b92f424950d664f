"""Point clouds as arrays: ``sensor_msgs_py``."""

from __future__ import annotations

import math

import numpy as np
import pytest
from sensor_msgs.msg import PointField
from sensor_msgs_py import point_cloud2
from std_msgs.msg import Header

NAN = float("nan")


def make_field(name, offset, datatype=PointField.FLOAT32, count=1):
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


@pytest.fixture
def cloud():
    points = [(1.0, 2.0, 3.0), (4.0, NAN, 6.0), (7.0, 8.0, 9.0), (10.0, 11.0, 12.0)]
    return point_cloud2.create_cloud_xyz32(Header(frame_id="map"), points)


def test_create_cloud_xyz32_packs_three_coordinates(cloud):
    assert (cloud.header.frame_id, cloud.width, cloud.height, cloud.point_step, cloud.row_step) == ("map", 4, 1, 12, 48)
    assert [(field.name, field.offset) for field in cloud.fields] == [("x", 0), ("y", 4), ("z", 8)]
    assert len(cloud.data) == 48
    assert point_cloud2.read_points(cloud)["z"].tolist() == [3, 6, 9, 12]


def test_read_points_selects_points_and_fields(cloud):
    assert point_cloud2.read_points(cloud, skip_nans=True)["x"].tolist() == [1, 7, 10]
    assert point_cloud2.read_points(cloud, ("z", "x"), uvs=[2, 0]).tolist() == [(9, 7), (3, 1)]
    assert point_cloud2.read_points(cloud, uvs=[(3, 0)]).tolist() == [(10, 11, 12)]
    with pytest.raises(AssertionError, match=r"no field \['intensity'\]"):
        point_cloud2.read_points(cloud, ["intensity"])


def test_points_are_read_as_tuples_and_matrix(cloud):
    second = point_cloud2.read_points_list(cloud)[1]
    assert (second.x, math.isnan(second.y), second.z) == (4.0, True, 6.0)
    matrix = point_cloud2.read_points_numpy(cloud, ["x", "z"])
    assert matrix.dtype == np.float32
    assert matrix.tolist() == [[1, 3], [4, 6], [7, 9], [10, 12]]


def test_cloud_from_matrix_can_be_organized():
    matrix = np.arange(18, dtype=np.float32).reshape(3, 2, 3)
    cloud = point_cloud2.create_cloud_xyz32(Header(), matrix)
    assert (cloud.width, cloud.height) == (3, 2)
    read = point_cloud2.read_points(cloud, reshape_organized_cloud=True)
    assert read.shape == (3, 2)
    assert read["y"].tolist() == matrix[..., 1].tolist()


def test_mixed_field_types_with_gaps_are_read():
    fields = [make_field("x", 0), make_field("rgb", 8, PointField.UINT8, 3), make_field("", 12, PointField.FLOAT64)]
    cloud = point_cloud2.create_cloud(Header(), fields, [(1.5, 1, 2, 3, 0.25)], step=32)
    assert (cloud.point_step, len(cloud.data)) == (32, 32)
    read = point_cloud2.read_points(cloud)
    assert read.dtype.names == ("x", "rgb_0", "rgb_1", "rgb_2", "unnamed_field_2")
    assert read.tolist() == [(1.5, 1, 2, 3, 0.25)]
    with pytest.raises(AssertionError, match="different types"):
        point_cloud2.read_points_numpy(cloud)
    round_trip = point_cloud2.create_cloud(Header(), fields, read)
    assert round_trip.data == cloud.data[:20]
    assert not any(round_trip.data[4:8]), "bytes without a field are zero"


def test_padded_rows_and_big_endian_are_read():
    cloud = point_cloud2.create_cloud_xyz32(Header(), [(0.0, 0.0, 0.0)] * 4)
    rows = np.zeros((2, 7), ">f4")
    rows[:, :6] = np.arange(12).reshape(2, 6)
    cloud.width, cloud.height, cloud.row_step, cloud.is_bigendian = 2, 2, 28, True
    cloud.data = np.frombuffer(rows.tobytes(), np.uint8)
    assert point_cloud2.read_points(cloud)["x"].tolist() == [0, 3, 6, 9]


def test_points_with_wrong_fields_are_rejected():
    with pytest.raises(AssertionError, match="2 values, but there are 3 fields"):
        point_cloud2.create_cloud_xyz32(Header(), np.zeros((5, 2)))
    with pytest.raises(AssertionError, match="but the fields have the type"):
        point_cloud2.create_cloud_xyz32(Header(), np.zeros(3, [("x", "f8"), ("y", "f8"), ("z", "f8")]))
