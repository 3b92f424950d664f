"""Points of clouds, scans and depth images, and their colors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.images import DecodedImage
from linkwright.messages import get_message
from linkwright.rviz.clouds import (
    BadCloudError,
    ColorSettings,
    DepthCamera,
    DepthCloudBuilder,
    Points,
    ScanProjector,
    compute_colors,
    deskew,
    find_supported_transformers,
    points_from_cloud,
)
from tests.work import lines_run

PointCloud2 = get_message("sensor_msgs/msg/PointCloud2")
PointField = get_message("sensor_msgs/msg/PointField")
LaserScan = get_message("sensor_msgs/msg/LaserScan")
Image = get_message("sensor_msgs/msg/Image")
CameraInfo = get_message("sensor_msgs/msg/CameraInfo")

DATATYPES = {"i1": 1, "u1": 2, "i2": 3, "u2": 4, "i4": 5, "u4": 6, "f4": 7, "f8": 8}
RED, MAGENTA, GREEN, BLUE = (255, 0, 0, 255), (255, 0, 255, 255), (0, 255, 0, 255), (0, 0, 255, 255)


def make_cloud(array: np.ndarray, frame: str = "base"):
    """Return a message with the fields of a structured array."""
    message = PointCloud2()
    message.header.frame_id = frame
    message.width, message.height = array.size, 1
    message.point_step, message.row_step = array.itemsize, array.nbytes
    message.is_bigendian = array.dtype[0].str.startswith(">")
    message.data = array.tobytes()
    message.fields = [
        PointField(name=name, offset=offset, datatype=DATATYPES[kind.str[1:]], count=1)
        for name, (kind, offset) in array.dtype.fields.items()
    ]
    return message


def xyz_array(points, *extra: tuple[str, str]) -> np.ndarray:
    array = np.zeros(len(points), np.dtype([("x", "f4"), ("y", "f4"), ("z", "f4"), *extra]))
    for axis, name in enumerate("xyz"):
        array[name] = [point[axis] for point in points]
    return array


def point_colors(points: Points, pose=None, **settings) -> list[tuple[int, ...]]:
    color_values, _ = compute_colors(points, ColorSettings(**settings), pose)
    return [tuple(int(part) for part in row) for row in color_values]


# --- PointCloud2 -----------------------------------------------------------------------------------------------------


def test_coordinates_and_channels_are_read():
    array = xyz_array([(1, 2, 3), (4, 5, 6)], ("intensity", "f8"), ("ring", "u2"))
    array["intensity"], array["ring"] = [0.25, 0.75], [7, 8]
    points = points_from_cloud(make_cloud(array))
    assert points.positions.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert {name: values.tolist() for name, values in points.channels.items()} == {
        "intensity": [0.25, 0.75],
        "ring": [7, 8],
    }


def test_coordinate_fields_may_have_any_offset():
    array = np.zeros(2, np.dtype([("z", "f4"), ("pad", "u1"), ("x", "f4"), ("y", "f4")]))
    array["x"], array["y"], array["z"] = [1, 2], [3, 4], [5, 6]
    assert points_from_cloud(make_cloud(array)).positions.tolist() == [[1, 3, 5], [2, 4, 6]]


def test_big_endian_clouds_are_read():
    array = np.zeros(1, np.dtype([("x", ">f4"), ("y", ">f4"), ("z", ">f4"), ("intensity", ">u2")]))
    array[0] = (1, 2, 3, 513)
    points = points_from_cloud(make_cloud(array))
    assert points.positions.tolist() == [[1, 2, 3]]
    assert points.channels["intensity"].tolist() == [513]


@pytest.mark.parametrize("invalid_value", [math.nan, math.inf, -math.inf])
def test_points_without_finite_coordinates_are_left_out(invalid_value):
    array = xyz_array([(1, 2, 3), (4, invalid_value, 6), (7, 8, 9)], ("intensity", "f4"))
    array["intensity"] = [1, 2, 3]
    points = points_from_cloud(make_cloud(array))
    assert points.positions.tolist() == [[1, 2, 3], [7, 8, 9]]
    assert points.channels["intensity"].tolist() == [1, 3]


def test_empty_cloud_is_accepted():
    assert len(points_from_cloud(make_cloud(xyz_array([])))) == 0


def test_size_mismatch_is_rejected_with_message_of_rviz():
    message = make_cloud(xyz_array([(1, 2, 3)]))
    message.width = 2
    with pytest.raises(BadCloudError) as refused:
        points_from_cloud(message)
    assert str(refused.value) == (
        "Data size (12 bytes) does not match width (2) times height (1) times point_step (12).  Dropping message."
    )


def test_field_outside_of_point_is_rejected():
    message = make_cloud(xyz_array([(1, 2, 3)]))
    message.fields[2].offset = 9
    with pytest.raises(BadCloudError, match="Field 'z' ends at byte 13, but a point has only 12 bytes"):
        points_from_cloud(message)


@pytest.mark.parametrize("change", ["no z", "z is a double", "z has a type that is none"])
def test_position_transformer_requires_float32_coordinates(change):
    message = make_cloud(xyz_array([(1, 2, 3)], ("w", "f4")))
    if change == "no z":
        message.fields = message.fields[:2]
    else:
        message.fields[2].datatype = 8 if change == "z is a double" else 99
    with pytest.raises(BadCloudError, match="No position transformer available for cloud"):
        points_from_cloud(message)


# --- colors ---------------------------------------------------------------------------------------------------------


def test_rainbow_goes_from_red_to_magenta():
    array = xyz_array([(0, 0, 0)] * 6, ("intensity", "f4"))
    array["intensity"] = [0, 1, 2, 3, 4, 5]
    points = points_from_cloud(make_cloud(array))
    yellow, cyan = (255, 255, 0, 255), (0, 255, 255, 255)
    assert point_colors(points) == [RED, yellow, GREEN, cyan, BLUE, MAGENTA]
    assert point_colors(points, inverted=True) == [MAGENTA, BLUE, cyan, GREEN, yellow, RED]


def test_intensity_bounds_are_computed_or_given():
    points = Points(np.zeros((3, 3), np.float32), {"intensity": np.array([10.0, 20.0, 30.0])})
    _, bounds = compute_colors(points, ColorSettings())
    assert bounds == (10.0, 30.0)
    assert point_colors(points, intensities=(20.0, 40.0))[:2] == [RED, RED]
    assert compute_colors(points, ColorSettings(intensities=(0.0, 1.0)))[1] is None


def test_intensity_interpolates_between_two_colors():
    points = Points(np.zeros((3, 3), np.float32), {"intensity": np.array([0.0, 1.0, 2.0])})
    mixed = point_colors(points, rainbow=False, darkest=(0, 0, 100), brightest=(200, 0, 100))
    assert mixed == [(0, 0, 100, 255), (100, 0, 100, 255), (200, 0, 100, 255)]


def test_equal_and_missing_intensities_give_one_color():
    points = Points(np.zeros((2, 3), np.float32), {"intensity": np.array([5.0, 5.0])})
    assert point_colors(points) == [RED, RED]
    assert point_colors(points, channel="other") == [(255, 255, 255, 255)] * 2
    other = Points(points.positions, {"intensities": np.array([0.0, 1.0])})
    assert point_colors(other) == [RED, MAGENTA]


def test_nonfinite_intensities_are_ignored():
    values = np.array([np.nan, 0.0, np.inf, 2.0])
    points = Points(np.zeros((4, 3), np.float32), {"intensity": values})
    color_values, bounds = compute_colors(points, ColorSettings())
    assert bounds == (0.0, 2.0)
    assert [tuple(row) for row in color_values.tolist()] == [RED, RED, MAGENTA, MAGENTA]


def test_axis_color_uses_fixed_frame_or_cloud_frame():
    points = Points(np.array([[0, 0, 0], [1, 0, 0]], np.float32))
    upright = np.array([0, 0, 10, 0, -math.sqrt(0.5), 0, math.sqrt(0.5)])  # x points up
    color_values, bounds = compute_colors(points, ColorSettings("AxisColor"), upright)
    np.testing.assert_allclose(bounds, (10.0, 11.0), atol=1e-5)
    assert [tuple(row) for row in color_values.tolist()] == [RED, MAGENTA]
    assert point_colors(points, upright, transformer="AxisColor", in_fixed_frame=False) == [RED, RED]
    assert point_colors(points, upright, transformer="AxisColor", in_fixed_frame=False, axis=0) == [RED, MAGENTA]


def test_packed_rgb_is_unpacked():
    array = xyz_array([(0, 0, 0)], ("rgb", "f4"))
    array["rgb"] = np.array([0x40102030], "<u4").view("<f4")
    points = points_from_cloud(make_cloud(array))
    assert find_supported_transformers(points)[0] == "RGB8"
    assert point_colors(points, transformer="RGB8") == [(0x10, 0x20, 0x30, 255)]
    with_alpha = xyz_array([(0, 0, 0)], ("rgba", "u4"))
    with_alpha["rgba"] = 0x40102030
    assert point_colors(points_from_cloud(make_cloud(with_alpha)), transformer="RGB8") == [(0x10, 0x20, 0x30, 0x40)]


def test_float_colors_are_converted():
    array = xyz_array([(0, 0, 0)], ("r", "f4"), ("g", "f4"), ("b", "f4"))
    array["r"], array["g"], array["b"] = 1.0, 0.5, 7.0
    points = points_from_cloud(make_cloud(array))
    assert "RGBF32" in find_supported_transformers(points)
    assert point_colors(points, transformer="RGBF32") == [(255, 127, 255, 255)]


def test_transformers_without_fields_are_not_offered():
    points = points_from_cloud(make_cloud(xyz_array([(0, 0, 0)])))
    assert find_supported_transformers(points) == ("Intensity", "AxisColor", "FlatColor")
    assert point_colors(points, transformer="FlatColor") == []


def test_coloring_effort_is_independent_of_cloud_size():
    rng = np.random.default_rng(1)

    def work(count):
        array = np.zeros(count, xyz_array(np.zeros((0, 3)), ("intensity", "f4")).dtype)
        for name in array.dtype.names:
            array[name] = rng.random(array.size)
        message = make_cloud(array)
        return lines_run(lambda: compute_colors(points_from_cloud(message), ColorSettings()))

    work(10)  # fills caches
    assert work(100) == work(100_000)


# --- LaserScan -------------------------------------------------------------------------------------------------------


def make_scan(ranges, intensities=(), **fields):
    message = LaserScan(
        angle_min=0.0,
        angle_increment=math.pi / 2,
        range_min=0.1,
        range_max=10.0,
        ranges=ranges,
        intensities=intensities,
    )
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def test_scan_ranges_become_points():
    points = ScanProjector().points(make_scan([1.0, 2.0, 3.0], [5.0, 6.0, 7.0]))
    np.testing.assert_allclose(points.positions, [[1, 0, 0], [0, 2, 0], [-3, 0, 0]], atol=1e-6)
    assert points.channels["intensity"].tolist() == [5, 6, 7]
    assert points.channels["index"].tolist() == [0, 1, 2]


def test_invalid_scan_ranges_are_omitted():
    points = ScanProjector().points(
        make_scan([1.0, math.inf, math.nan, 0.05, 10.0, 9.9], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    )
    assert points.channels["index"].tolist() == [0, 5]
    assert points.channels["intensity"].tolist() == [1, 6]


def test_intensities_of_wrong_length_are_ignored():
    assert "intensity" not in ScanProjector().points(make_scan([1.0, 2.0], [1.0])).channels


def test_nan_scan_angles_give_no_points():
    assert len(ScanProjector().points(make_scan([1.0, 2.0], angle_min=math.nan))) == 0


def test_scan_projector_follows_changed_angles():
    projector = ScanProjector()
    projector.points(make_scan([1.0, 1.0]))
    points = projector.points(make_scan([1.0, 1.0], angle_min=math.pi))
    np.testing.assert_allclose(points.positions, [[-1, 0, 0], [0, -1, 0]], atol=1e-6)


# --- depth images ----------------------------------------------------------------------------------------------------


def make_depth_image(values, encoding: str = "32FC1"):
    array = np.array(values, "<f4" if encoding == "32FC1" else "<u2")
    return Image(
        height=array.shape[0], width=array.shape[1], step=array.strides[0], encoding=encoding, data=array.tobytes()
    )


def make_camera_info(width: int = 2, height: int = 1, focal: float = 2.0) -> DepthCamera:
    info = CameraInfo(width=width, height=height)
    info.k = np.array([focal, 0, 0, 0, focal, 0, 0, 0, 1])
    info.p = np.array([focal, 0, 0, 0, 0, focal, 0, 0, 0, 0, 1, 0])
    return DepthCamera.of(info, width, height)


def test_depths_become_points_along_camera_rays():
    points = DepthCloudBuilder().points(make_depth_image([[2.0, 4.0]]), make_camera_info(), None)
    assert points.positions.tolist() == [[0, 0, 2], [2, 0, 4]]
    assert points.channels["rgb"].tolist() == [0xFFFFFF, 0xFFFFFF]
    assert make_camera_info().pixel_width == 0.5


def test_millimeters_become_meters_and_zero_depth_is_omitted():
    points = DepthCloudBuilder().points(make_depth_image([[0, 1500]], "16UC1"), make_camera_info(), None)
    np.testing.assert_allclose(points.positions, [[0.75, 0, 1.5]])
    assert len(DepthCloudBuilder().points(make_depth_image([[math.nan, math.inf]]), make_camera_info(), None)) == 0


def test_depth_points_have_colors_of_image():
    color = DecodedImage(np.array([[[1, 2, 3], [4, 5, 6]]], np.uint8))
    points = DepthCloudBuilder().points(make_depth_image([[math.nan, 1.0]]), make_camera_info(), color)
    assert points.channels["rgb"].tolist() == [0x040506]


def test_mismatched_images_are_rejected():
    builder = DepthCloudBuilder()
    with pytest.raises(BadCloudError, match=r"\(2x1\) does not match color image resolution \(1x1\)"):
        builder.points(make_depth_image([[1.0, 1.0]]), make_camera_info(), DecodedImage(np.zeros((1, 1), np.uint8)))
    with pytest.raises(BadCloudError, match="only 16 bit and float are supported"):
        builder.points(Image(width=1, height=1, step=1, encoding="mono8", data=b"1"), make_camera_info(1), None)
    short = make_depth_image([[1.0, 1.0]])
    short.data = b"1234"
    with pytest.raises(BadCloudError, match="too few for 2 x 1"):
        builder.points(short, make_camera_info(), None)
    with pytest.raises(BadCloudError, match="don't match: 3 x 1 vs 2 x 1"):
        DepthCamera.of(CameraInfo(width=2, height=1), 3, 1)
    with pytest.raises(BadCloudError, match="no focal length"):
        DepthCamera.of(CameraInfo(width=2, height=1), 2, 1)


def test_occluded_points_remain_for_a_while_at_half_color():
    builder = DepthCloudBuilder()
    color = DecodedImage(np.full((1, 1, 3), 200, np.uint8))
    view = make_camera_info(1)

    def depths(depth: float, now: float) -> list[float]:
        points = builder.points(make_depth_image([[depth]]), view, color, covered_timeout_s=10.0, now=now)
        return points.positions[:, 2].tolist()

    assert depths(4.0, 0.0) == [4.0]
    assert depths(2.0, 1.0) == [2.0, 4.0]
    assert depths(math.nan, 2.0) == [4.0]
    shown = builder.points(make_depth_image([[2.0]]), view, color, covered_timeout_s=10.0, now=3.0)
    assert shown.channels["rgb"].tolist() == [0xC8C8C8, 0x646464]
    assert depths(2.0, 20.0) == [2.0]


def test_deskew_places_rays_at_their_emission_pose():
    points = Points(np.array([[1, 0, 0]] * 3, np.float32), {"index": np.arange(3)})
    first = np.array([0.0, 0, 0, 0, 0, 0, 1])
    last = np.array([2.0, 0, 0, 0, 0, 1, 0])  # moved by two meters, and rotated by half a turn
    moved = deskew(points, np.array([0.0, 0.5, 1.0]), first, last).positions
    np.testing.assert_allclose(moved, [[1, 0, 0], [1, 1, 0], [1, 0, 0]], atol=1e-6)


def test_deskew_interpolates_along_shorter_rotation():
    points = Points(np.array([[1, 0, 0]], np.float32))
    identity = np.array([0.0, 0, 0, 0, 0, 0, 1])
    moved = deskew(points, np.array([0.5]), identity, -identity).positions
    np.testing.assert_allclose(moved, [[1, 0, 0]], atol=1e-6)
