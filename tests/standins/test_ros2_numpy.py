"""Messages as numpy arrays: ``ros2_numpy``."""

from __future__ import annotations

import numpy as np
import pytest
import ros2_numpy as rnp
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, Vector3
from nav_msgs.msg import MapMetaData, OccupancyGrid
from ros2_numpy import transformations
from ros2_numpy.registry import converts_from_numpy, converts_to_numpy
from sensor_msgs.msg import Image, PointCloud2, PointField
from std_msgs.msg import String

COLORED_POINT = [("x", np.float32), ("y", np.float32), ("z", np.float32), ("rgb", np.float32)]


def make_points():
    points = np.zeros(2, [("x", "f4"), ("y", "f4"), ("z", "f4"), ("r", "u1"), ("g", "u1"), ("b", "u1")])
    points[0] = (1, 2, 3, 255, 0, 7)
    points[1] = (4, np.nan, 6, 1, 2, 3)
    return points


class TestRegistry:
    def test_own_types_can_be_added(self):
        converts_to_numpy(String)(lambda msg, upper=False: np.array(list(msg.data.upper() if upper else msg.data)))
        converts_from_numpy(String)(lambda array: String(data="".join(array)))
        assert rnp.numpify(String(data="ab"), upper=True).tolist() == ["A", "B"]
        assert rnp.msgify(String, np.array(["c", "d"])).data == "cd"

    def test_errors_list_types_that_can_be_converted(self):
        with pytest.raises(ValueError, match=r"Unable to convert message Time - only supports .*PointField\[\]"):
            rnp.numpify(Time())
        with pytest.raises(ValueError, match=r"Unable to build message Time - only supports .*Image"):
            rnp.msgify(Time, np.zeros(2))
        with pytest.raises(ValueError, match="empty Collection"):
            rnp.numpify([])
        assert rnp.numpify(None) is None


class TestGeometry:
    def test_homogeneous_coordinates_of_points_are_divided_and_those_of_vectors_are_zero(self):
        assert rnp.numpify(Point(x=1.0, y=2.0, z=3.0), hom=True).tolist() == [1, 2, 3, 1]
        assert rnp.numpify(Vector3(x=1.0, y=2.0, z=3.0), hom=True).tolist() == [1, 2, 3, 0]
        assert rnp.msgify(Point, np.array([2.0, 4.0, 6.0, 2.0])) == Point(x=1.0, y=2.0, z=3.0)
        with pytest.raises(AssertionError, match="must be 0"):
            rnp.msgify(Vector3, np.array([0.0, 0.0, 0.0, 1.0]))

    def test_array_of_points_gives_array_of_messages(self):
        points = rnp.msgify(Point, np.array([[[2.0, 0.0, 4.0, 2.0]], [[3.0, 6.0, 9.0, 3.0]]]))
        assert points.shape == (2, 1)
        assert points[1, 0] == Point(x=1.0, y=2.0, z=3.0)
        assert rnp.msgify(Quaternion, np.eye(4))[3] == Quaternion(w=1.0)

    @pytest.mark.parametrize(("kind", "position", "rotation"), [
        (Transform, "translation", "rotation"), (Pose, "position", "orientation"),
    ])  # fmt: skip
    def test_matrices_are_transforms_and_poses(self, kind, position, rotation):
        matrix = transformations.euler_matrix(np.pi, 0, 0)
        matrix[:3, 3] = 1, 2, 3
        message = rnp.msgify(kind, matrix)
        assert (getattr(message, position).x, getattr(message, position).z) == (1, 3)
        assert abs(getattr(message, rotation).x) == pytest.approx(1)
        np.testing.assert_allclose(rnp.numpify(message) @ [0, 0, 1, 1], [1, 2, 2, 1], atol=1e-9)
        stacked = rnp.msgify(kind, np.stack([np.eye(4), matrix]))
        assert stacked[1] == message
        with pytest.raises(AssertionError, match=r"\(3, 3\)"):
            rnp.msgify(kind, np.eye(3))


class TestImages:
    @pytest.mark.parametrize(("encoding", "dtype", "shape"), [
        ("rgb8", np.uint8, (2, 3, 3)), ("mono8", np.uint8, (2, 3)), ("mono16", ">u2", (2, 3)),
        ("mono16", "<u2", (2, 3)), ("32FC1", np.float32, (2, 3)), ("bayer_rggb8", np.uint8, (2, 3)),
        ("64FC4", np.float64, (2, 3, 4)),
    ])  # fmt: skip
    def test_pixels_survive_both_conversions(self, encoding, dtype, shape):
        pixels = np.arange(np.prod(shape)).reshape(shape).astype(dtype)
        message = rnp.msgify(Image, pixels, encoding=encoding)
        assert (message.height, message.width, message.is_bigendian) == (2, 3, dtype == ">u2")
        assert message.step * message.height == len(message.data)
        np.testing.assert_equal(rnp.numpify(message), pixels)

    def test_padding_of_rows_is_left_out(self):
        message = Image(height=2, width=2, step=4, encoding="mono8", data=bytes([1, 2, 0, 0, 3, 4, 0, 0]))
        assert rnp.numpify(message).tolist() == [[1, 2], [3, 4]]

    def test_part_of_image_is_converted(self):
        pixels = np.arange(12, dtype=np.uint8).reshape(3, 4)
        assert rnp.numpify(rnp.msgify(Image, pixels[1:, ::2], "mono8")).tolist() == [[4, 6], [8, 10]]

    @pytest.mark.parametrize(("pixels", "encoding", "reason"), [
        (np.zeros((2, 2, 3), np.uint8), "mono8", "Array has 3 channels, mono8 requires 1"),
        (np.zeros((2, 2), np.float32), "mono8", "requires <class 'numpy.uint8'>"),
        (np.zeros(2, np.uint8), "mono8", "two or three dimensional"),
        (np.zeros((2, 2), np.uint8), "purple", "Unrecognized encoding purple"),
    ])  # fmt: skip
    def test_wrong_arrays_are_refused(self, pixels, encoding, reason):
        with pytest.raises(TypeError, match=reason):
            rnp.msgify(Image, pixels, encoding=encoding)


class TestGrids:
    def test_unknown_cells_are_masked(self):
        info = MapMetaData(resolution=0.5)
        message = rnp.msgify(OccupancyGrid, np.array([[0, -1, 100], [0, 0, 0]], np.int8), info=info)
        assert (message.info.width, message.info.height, message.info.resolution) == (3, 2, 0.5)
        cells = rnp.numpify(message)
        assert cells[0, 1] is np.ma.masked
        assert cells[0, 2] == 100
        assert rnp.msgify(OccupancyGrid, cells).data == message.data
        with pytest.raises(TypeError, match="int8"):
            rnp.msgify(OccupancyGrid, np.zeros((2, 2)))
        with pytest.raises(TypeError, match="2D"):
            rnp.msgify(OccupancyGrid, np.zeros(2, np.int8))


class TestClouds:
    def test_structured_array_survives_both_conversions(self):
        points = np.zeros(3, [("x", np.float32), ("y", np.float64), ("vectors", np.float32, (3,))])
        points["vectors"] = np.arange(9).reshape(3, 3)
        message = rnp.msgify(PointCloud2, points, frame_id="map", stamp=Time(sec=5))
        assert (message.header.frame_id, message.header.stamp.sec, message.width, message.height) == ("map", 5, 3, 1)
        assert [(field.name, field.offset, field.count) for field in message.fields] == [
            ("x", 0, 1), ("y", 4, 1), ("vectors", 12, 3)]  # fmt: skip
        cloud = rnp.numpify(message)
        np.testing.assert_equal(cloud.view(np.ndarray), points)
        assert cloud[1]["vectors"].tolist() == [3, 4, 5]
        assert rnp.numpify(message, squeeze=False).shape == (1, 3)

    def test_gaps_between_fields_and_rows_are_skipped(self):
        fields = [PointField(name=name, offset=offset, datatype=PointField.UINT8, count=1)
                  for name, offset in (("b", 2), ("a", 0))]  # fmt: skip
        message = PointCloud2(height=2, width=1, fields=fields, point_step=3, row_step=4, data=bytes(range(8)))
        cloud = rnp.numpify(message)
        assert cloud.shape == (2, 1)
        assert (cloud["a"].tolist(), cloud["b"].tolist()) == ([[0], [4]], [[2], [6]])
        assert [name for name, _ in rnp.numpify(fields, point_step=4)] == ["a", "__1", "b", "__3"]

    def test_cloud_has_keys_of_later_distributions(self):
        points = rnp.point_cloud2.merge_rgb_fields(make_points())
        cloud = rnp.numpify(rnp.msgify(PointCloud2, points))
        assert cloud.keys() == ["xyz", "rgb"]
        assert "xyz" in cloud
        assert "intensity" not in cloud
        assert cloud.get("intensity") is None
        assert dict(cloud.items())["xyz"].dtype == np.float32
        np.testing.assert_equal(cloud["xyz"], [[1, 2, 3], [4, np.nan, 6]])
        assert cloud["rgb"].tolist() == [[255, 0, 7], [1, 2, 3]]

    def test_dictionary_becomes_cloud(self):
        cloud = {"xyz": np.array([[1.0, 2.0, 3.0]]), "rgb": np.array([[9, 8, 7]]), "intensity": np.array([[5]], "u2")}
        message = rnp.msgify(PointCloud2, cloud)
        assert message.header.frame_id == "base_link"
        assert message.header.stamp.sec > 0
        assert [(field.name, field.offset, field.datatype) for field in message.fields][3:] == [
            ("rgb", 12, PointField.UINT32), ("intensity", 16, PointField.UINT16)]  # fmt: skip
        read = rnp.numpify(message)
        assert (read["xyz"].tolist(), read["rgb"].tolist(), read["intensity"].tolist()) == (
            [[1, 2, 3]], [[9, 8, 7]], [5])  # fmt: skip

    def test_colors_are_packed_as_in_pcl_and_split(self):
        merged = rnp.point_cloud2.merge_rgb_fields(make_points())
        assert merged.dtype == COLORED_POINT
        assert merged["rgb"].view(np.uint32)[0] == 0xFF0007
        assert rnp.point_cloud2.split_rgb_field(merged).tobytes() == make_points().tobytes()

    def test_coordinates_without_invalid_points(self):
        message = rnp.msgify(PointCloud2, make_points())
        assert not message.is_dense
        assert rnp.point_cloud2.pointcloud2_to_xyz_array(message).tolist() == [[1, 2, 3]]
        assert rnp.point_cloud2.get_xyz_points(rnp.numpify(message), remove_nans=False).shape == (2, 3)

    def test_organized_cloud_keeps_its_shape(self):
        points = np.zeros((2, 4), COLORED_POINT)
        message = rnp.msgify(PointCloud2, points)
        assert (message.height, message.width, message.row_step) == (2, 4, 64)
        cloud = rnp.numpify(message)
        assert cloud.shape == (2, 4)
        assert cloud["xyz"].shape == (8, 3)
