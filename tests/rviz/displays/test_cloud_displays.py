"""Displays of clouds, scans and single numbers, from topics to pages.

The tests cover PointCloud2, LaserScan and DepthCloud.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.messages import TFMessage, TransformStamped, get_message
from linkwright.rviz import RvizConfig
from tests.rviz.clouds.test_clouds import LaserScan, make_cloud, make_depth_image, make_scan, xyz_array
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

Temperature = get_message("sensor_msgs/msg/Temperature")
CameraInfo = get_message("sensor_msgs/msg/CameraInfo")
Image = get_message("sensor_msgs/msg/Image")
Point32 = get_message("geometry_msgs/msg/Point32")
ChannelFloat32 = get_message("sensor_msgs/msg/ChannelFloat32")
PointCloud = get_message("sensor_msgs/msg/PointCloud")
PointCloud2 = get_message("sensor_msgs/msg/PointCloud2")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/{cls}
      Enabled: true
      Name: Points
      Topic: {{Value: /points}}
{extra}
  Global Options:
    Fixed Frame: base
"""


def make_config(cls: str = "PointCloud2", **properties: str) -> RvizConfig:
    extra = "\n".join(f"      {name.replace('_', ' ')}: {value}" for name, value in properties.items())
    return RvizConfig.parse(FILE.format(cls=cls, extra=extra))


def make_colored_cloud(count: int = 2):
    array = xyz_array([(i, 0, 0) for i in range(count)], ("intensity", "f4"), ("rgb", "u4"))
    array["intensity"], array["rgb"] = np.arange(count), 0x102030
    return make_cloud(array)


def drawn_points(display) -> list[list[float]]:
    return [content.fields["positions"].reshape(-1, 3).tolist() for content in unpack_contents(display)]


def drawn_colors(display) -> list[list[int]]:
    (content,) = unpack_contents(display)
    return content.fields["colors"].reshape(-1, 4).tolist()


def status_rows(display) -> dict[str, dict]:
    return {row.name: row for row in display.properties.rows()}


async def test_cloud_is_sent_with_pose_of_its_frame():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        world.move({("base", "lidar"): (1, 2, 3, 0, 0, 0, 1)}, static=True)
        publisher.publish(make_cloud(xyz_array([(1, 0, 0)]), "lidar"))
        await world.settle()
        (content,) = unpack_contents(world.display("PointCloud2"))
        assert content.fields["kind"] == "cloud_points"
        assert content.fields["positions"].tolist() == [1, 0, 0]
        assert content.pose == [1, 2, 3, 0, 0, 0, 1]
        assert world.status("PointCloud2") == {
            "Topic": ("ok", "1 messages received"),
            "Transform": ("ok", "Transform OK"),
            "Points": ("ok", "Showing [1] points from [1] messages"),
        }


async def test_cloud_with_rgb_field_is_shown_in_color():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_colored_cloud())
        await world.settle()
        display = world.display("PointCloud2")
        assert display.properties.text("Color Transformer") == "RGB8"
        assert drawn_colors(display) == [[0x10, 0x20, 0x30, 255]] * 2
        assert world.viewer.config.text() == make_config().text()  # the choice was automatic, so the file is unchanged


async def test_color_transformers_are_limited_to_fields_of_cloud():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_cloud(xyz_array([(0, 0, 0)], ("intensity", "f4"))))
        await world.settle()
        message = await client.until("display_properties")
        rows = {row["name"]: row for row in message["properties"]}
        assert rows["Color Transformer"]["options"] == ["AxisColor", "FlatColor", "Intensity"]
        assert rows["Channel Name"]["options"] == ["x", "y", "z", "intensity"]


async def test_property_rows_follow_color_transformer():
    async with open_world(make_config(Color_Transformer="Intensity")) as world:
        display = world.display("PointCloud2")
        names = set(status_rows(display))
        assert {"Channel Name", "Use rainbow", "Invert Rainbow", "Autocompute Intensity Bounds"} <= names
        assert names.isdisjoint({"Min Color", "Min Intensity", "Axis", "Color"})
        display.set_property(("Use rainbow",), False)
        display.set_property(("Autocompute Intensity Bounds",), False)
        names = set(status_rows(display))
        assert {"Min Color", "Max Color", "Min Intensity", "Max Intensity"} <= names
        assert "Invert Rainbow" not in names
        display.set_property(("Color Transformer",), "AxisColor")
        names = set(status_rows(display))
        assert {"Axis", "Autocompute Value Bounds", "Use Fixed Frame"} <= names
        assert names.isdisjoint({"Channel Name", "Min Color", "Min Intensity"})


async def test_color_change_redraws_last_message():
    async with open_world(make_config(Color_Transformer="Intensity")) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_colored_cloud())
        await world.settle()
        display = world.display("PointCloud2")
        assert drawn_colors(display) == [[255, 0, 0, 255], [255, 0, 255, 255]]
        display.set_property(("Invert Rainbow",), True)
        assert drawn_colors(display) == [[255, 0, 255, 255], [255, 0, 0, 255]]
        display.set_property(("Color Transformer",), "FlatColor")
        assert drawn_colors(display) == []


async def test_computed_bounds_initialize_manual_bounds():
    async with open_world(make_config(Color_Transformer="Intensity")) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_colored_cloud(6))
        await world.settle()
        display = world.display("PointCloud2")
        display.set_property(("Autocompute Intensity Bounds",), False)
        assert (display.properties.number("Min Intensity"), display.properties.number("Max Intensity")) == (0.0, 5.0)


async def test_malformed_message_is_reported_and_last_cloud_remains():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_colored_cloud())
        broken = make_colored_cloud()
        broken.width = 7
        publisher.publish(broken)
        await world.settle()
        level, text = world.status("PointCloud2")["Message"]
        assert (level, text[:20]) == ("error", "Data size (40 bytes)")
        assert len(drawn_points(world.display("PointCloud2"))[0]) == 2
        publisher.publish(make_colored_cloud(3))
        await world.settle()
        assert "Message" not in world.status("PointCloud2")


async def test_points_remain_for_decay_time():
    async with open_world(make_config(Decay_Time="0.3")) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        display = world.display("PointCloud2")
        publisher.publish(make_colored_cloud(1))
        publisher.publish(make_colored_cloud(2))
        await world.settle()
        assert [len(cloud) for cloud in drawn_points(display)] == [1, 2]
        assert world.status("PointCloud2")["Points"][1].startswith("Showing [")
        await eventually(lambda: drawn_points(display) == [])
        none = ("ok", "Showing [0] points from [0] messages")
        await eventually(lambda: world.status("PointCloud2")["Points"] == none)


async def test_zero_decay_time_keeps_only_newest_message():
    async with open_world(make_config(Decay_Time="60")) as world, open_page(world.viewer) as client:
        await client.opened()
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        display = world.display("PointCloud2")
        for count in (1, 2, 3):
            publisher.publish(make_colored_cloud(count))
        await world.settle()
        display.set_property(("Decay Time",), 0)
        assert [len(cloud) for cloud in drawn_points(display)] == [3]
        publisher.publish(make_colored_cloud(4))
        await world.settle()
        assert [len(cloud) for cloud in drawn_points(display)] == [4]


async def test_page_receives_fields_of_selected_point():
    async with open_world(make_config()) as world, open_page(world.viewer) as client:
        await client.opened()
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        publisher.publish(make_colored_cloud())
        await world.settle()
        identity = world.display("PointCloud2").id
        await client.send("request_point", display=identity, key="", index=7)
        await client.send("request_point", display=identity, key="", index=1)
        response = await client.until("point_fields")
        assert (response["index"], response["fields"]) == (1, {"intensity": 1.0, "rgb": "#10203000"})


async def test_laser_scan_is_shown():
    async with open_world(make_config("LaserScan")) as world:
        publisher = world.graph.create_node("laser").create_publisher(LaserScan, "/points", 5)
        message = make_scan([1.0, 2.0], [1.0, 2.0])
        message.header.frame_id = "base"
        publisher.publish(message)
        await world.settle()
        np.testing.assert_allclose(drawn_points(world.display("LaserScan"))[0], [[1, 0, 0], [0, 2, 0]], atol=1e-6)
        assert world.display("LaserScan").properties.text("Color Transformer") == "Intensity"


@pytest.mark.parametrize(
    ("ranges", "expected"),
    [
        ([math.nan, math.nan], "All 2 ranges are NaN: the sensor measured nothing"),
        (
            [0.05, 12.5],
            "All ranges, 0.05 to 12.50 m, are outside the range limits of the message, 0.10 to 10.00 m",
        ),
        ([math.inf, math.inf], None),
        ([math.nan, math.inf], None),
        ([], None),
        ([math.nan, 2.0], None),
    ],
)
async def test_scan_without_valid_rays_is_reported_unless_all_out_of_range(ranges, expected):
    async with open_world(make_config("LaserScan")) as world:
        publisher = world.graph.create_node("laser").create_publisher(LaserScan, "/points", 5)
        message = make_scan(ranges)
        message.header.frame_id = "base"
        publisher.publish(message)
        await world.settle()
        level, text = world.status("LaserScan").get("Values", (None, ""))
        assert (level, text.partition(":")[0]) == (("warn", expected.partition(":")[0]) if expected else (None, ""))
        message.ranges = [1.0, 2.0]
        publisher.publish(message)
        await world.settle()
        assert "Values" not in world.status("LaserScan")


async def test_cloud_of_nan_points_is_reported():
    async with open_world(make_config()) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud2, "/points", 5)
        message = make_colored_cloud()
        message.data = b"\xff" * len(message.data)
        publisher.publish(message)
        await world.settle()
        assert world.status("PointCloud2")["Values"] == ("warn", "All 2 points are NaN or infinite")


async def test_scan_of_moving_scanner_is_deskewed():
    async with open_world(make_config("LaserScan")) as world:
        node = world.graph.create_node("laser")
        publisher = node.create_publisher(LaserScan, "/points", 5)
        tf = node.create_publisher(TFMessage, "/tf", 10)
        for second, x in ((100, 0.0), (102, 4.0)):
            transform = TransformStamped()
            transform.header.frame_id, transform.child_frame_id = "base", "laser"
            transform.header.stamp.sec = second
            transform.transform.translation.x = x
            transform.transform.rotation.w = 1.0
            tf.publish(TFMessage(transforms=[transform]))
        await world.settle()
        message = make_scan([1.0, 1.0, 1.0], time_increment=1.0, angle_increment=0.0)
        message.header.frame_id, message.header.stamp.sec = "laser", 100
        publisher.publish(message)
        await world.settle()
        np.testing.assert_allclose(
            drawn_points(world.display("LaserScan"))[0], [[1, 0, 0], [3, 0, 0], [5, 0, 0]], atol=1e-6
        )
        assert unpack_contents(world.display("LaserScan"))[0].pose == [0, 0, 0, 0, 0, 0, 1]


@pytest.mark.parametrize(
    ("cls", "field", "value", "color"),
    [
        ("FluidPressure", "fluid_pressure", 98000.0, [255, 0, 0, 255]),
        ("Illuminance", "illuminance", 1000.0, [255, 0, 255, 255]),
        ("RelativeHumidity", "relative_humidity", 0.0, [255, 0, 0, 255]),
        ("Temperature", "temperature", 100.0, [255, 0, 0, 255]),
    ],
)
async def test_scalar_message_is_a_colored_point(cls, field, value, color):
    async with open_world(make_config(cls)) as world:
        message_type = get_message(f"sensor_msgs/msg/{cls}")
        publisher = world.graph.create_node("sensor").create_publisher(message_type, "/points", 5)
        message = message_type(**{field: value})
        message.header.frame_id = "base"
        publisher.publish(message)
        await world.settle()
        display = world.display(cls)
        assert drawn_points(display) == [[[0, 0, 0]]]
        assert drawn_colors(display) == [color]
        names = set(status_rows(display))
        assert {"Use rainbow", "Min Intensity", "Max Intensity", "Decay Time"} <= names
        assert names.isdisjoint({"Color Transformer", "Channel Name", "Autocompute Intensity Bounds"})


async def test_hidden_properties_of_file_are_applied():
    async with open_world(make_config("Temperature", Color_Transformer="FlatColor")) as world:
        display = world.display("Temperature")
        assert display.properties.text("Color Transformer") == "FlatColor"
        assert "Color Transformer" not in status_rows(display)


def make_camera_info(width: int, height: int):
    info = CameraInfo(width=width, height=height)
    info.k = np.array([2.0, 0, 0, 0, 2.0, 0, 0, 0, 1])
    info.p = np.array([2.0, 0, 0, 0, 0, 2.0, 0, 0, 0, 0, 1, 0])
    return info


def with_frame(message, frame: str = "base"):
    message.header.frame_id = frame
    return message


async def test_depth_image_is_shown_once_camera_info_arrives():
    topics = {"Depth_Map_Topic": "/depth/image", "Size_(m)": "0.5"}
    async with open_world(make_config("DepthCloud", **topics)) as world:
        node = world.graph.create_node("camera")
        depths = node.create_publisher(Image, "/depth/image", 5)
        infos = node.create_publisher(CameraInfo, "/depth/camera_info", 5)
        depths.publish(with_frame(make_depth_image([[2.0, 4.0]])))
        await world.settle()
        display = world.display("DepthCloud")
        assert unpack_contents(display) == []
        assert world.status("DepthCloud")["Depth Camera Info"] == (
            "warn",
            "No CameraInfo received on [/depth/camera_info]",
        )
        infos.publish(make_camera_info(2, 1))
        await world.settle()
        (content,) = unpack_contents(display)
        assert content.fields["positions"].reshape(-1, 3).tolist() == [[0, 0, 2], [2, 0, 4]]
        assert content.fields["pixel"] == 0.5
        assert world.status("DepthCloud")["Depth Image Size"] == ("ok", "2 x 1")
        display.set_property(("Auto Size", "Auto Size Factor"), 3.0)
        assert unpack_contents(display)[0].fields["pixel"] == 1.5
        display.set_property(("Auto Size",), False)
        assert unpack_contents(display)[0].fields["pixel"] == 0.0


async def test_depth_image_waits_for_color_image():
    topics = {"Depth_Map_Topic": "/depth/image", "Color_Image_Topic": "/color/image"}
    async with open_world(make_config("DepthCloud", **topics)) as world:
        node = world.graph.create_node("camera")
        depths = node.create_publisher(Image, "/depth/image", 5)
        color = node.create_publisher(Image, "/color/image", 5)
        node.create_publisher(CameraInfo, "/depth/camera_info", 5).publish(make_camera_info(2, 1))
        depths.publish(with_frame(make_depth_image([[2.0, 4.0]])))
        await world.settle()
        display = world.display("DepthCloud")
        assert unpack_contents(display) == []
        image = Image(width=2, height=1, step=6, encoding="rgb8", data=bytes([1, 2, 3, 4, 5, 6]))
        color.publish(with_frame(image, "other"))
        await world.settle()
        assert drawn_colors(display) == [[1, 2, 3, 255], [4, 5, 6, 255]]
        text = "Depth image frame id [base] doesn't match color image frame id [other]"
        assert world.status("DepthCloud")["Message"] == ("warn", text)


async def test_depth_image_and_camera_info_size_mismatch_is_reported():
    async with open_world(make_config("DepthCloud", Depth_Map_Topic="/depth/image")) as world:
        node = world.graph.create_node("camera")
        node.create_publisher(CameraInfo, "/depth/camera_info", 5).publish(make_camera_info(5, 5))
        node.create_publisher(Image, "/depth/image", 5).publish(with_frame(make_depth_image([[2.0, 4.0]])))
        await world.settle()
        level, text = world.status("DepthCloud")["Message"]
        assert (level, text.split(":")[0]) == ("error", "Error updating depth cloud")


def make_legacy_cloud(*points: tuple[float, float, float], intensity: list[float]) -> PointCloud:
    message = PointCloud(points=[Point32(x=x, y=y, z=z) for x, y, z in points])
    message.header.frame_id = "base"
    message.channels = [ChannelFloat32(name="intensity", values=intensity)]
    return message


async def test_legacy_point_cloud_is_shown():
    async with open_world(make_config("PointCloud", Color_Transformer="Intensity", Channel_Name="intensity")) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud, "/points", 5)
        publisher.publish(
            make_legacy_cloud((1.0, 0.0, 0.0), (float("nan"), 0.0, 0.0), (2.0, 0.0, 0.0), intensity=[0.0, 5.0, 1.0])
        )
        await world.settle()
        display = world.display("PointCloud")
        assert drawn_points(display) == [[[1, 0, 0], [2, 0, 0]]]
        first, second = drawn_colors(display)
        assert first != second


async def test_channel_of_wrong_length_is_reported():
    async with open_world(make_config("PointCloud")) as world:
        publisher = world.graph.create_node("lidar").create_publisher(PointCloud, "/points", 5)
        publisher.publish(make_legacy_cloud((1.0, 0.0, 0.0), intensity=[1.0, 2.0]))
        await world.settle()
        assert world.status("PointCloud")["Message"] == (
            "error",
            "Channel 'intensity' has 2 values for 1 points.  Dropping message.",
        )


async def test_depth_topics_are_filtered_by_name_unless_disabled():
    async with open_world(make_config("DepthCloud")) as world:
        display = world.display("DepthCloud")
        rows = status_rows(display)
        assert (rows["Depth Map Topic"].topics.words, rows["CameraInfo Topic"].topics.messages) == (
            ["depth"],
            ["sensor_msgs/msg/CameraInfo"],
        )
        display.set_property(("Topic Filter",), False)
        assert status_rows(display)["Depth Map Topic"].topics.words == []
