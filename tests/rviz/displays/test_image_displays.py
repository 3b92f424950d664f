"""Image and Camera, from topics to pages."""

from __future__ import annotations

import math
from io import BytesIO

import numpy as np
import PIL.Image
import pytest

from linkwright.messages import get_message
from linkwright.page.protocol.images import ImageSize
from linkwright.rviz import RvizConfig
from tests.images.test_images import Image, image
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_page, open_world
from tests.waiting import eventually

CameraInfo = get_message("sensor_msgs/msg/CameraInfo")
CompressedImage = get_message("sensor_msgs/msg/CompressedImage")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Name: Floor
      Enabled: true
    - Class: rviz_common/Group
      Name: Sensors
      Enabled: true
      Displays:
        - {Class: rviz_default_plugins/Grid, Name: Wall, Enabled: true}
    - Class: rviz_default_plugins/CLS
      Enabled: true
      Name: Eye
      Topic: {Value: TOPIC}
  Global Options:
    Fixed Frame: base
"""


def make_config(cls: str, topic: str = "/camera/image") -> RvizConfig:
    return RvizConfig.parse(FILE.replace("CLS", cls).replace("TOPIC", topic))


def make_small_image(*values: int, frame: str = "base"):
    message = image("mono8", len(values), 1, bytes(values))
    message.header.frame_id = frame
    return message


def row_names(display) -> set[str]:
    return {row.name for row in display.properties.rows()}


async def test_image_is_sent():
    async with open_world(make_config("Image")) as world:
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(make_small_image(1, 2, 3))
        await world.settle()
        (content,) = unpack_contents(world.display("Image"))
        fields = content.fields
        assert (fields["kind"], fields["encoding"], fields["width"], fields["height"]) == ("image_frame", "gray", 3, 1)
        assert fields["data"].tolist() == [1, 2, 3]
        assert fields["camera"] is None
        assert world.status("Image") == {"Topic": ("ok", "1 messages received")}


async def test_image_is_reduced_to_panel_size():
    async with open_world(make_config("Image")) as world:
        display = world.display("Image")

        async def sizes() -> list[tuple[int, int]]:
            await world.settle()
            return [(content.fields["columns"], content.fields["rows"]) for content in unpack_contents(display)]

        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(image("mono8", 64, 48, bytes(64 * 48)))
        assert await sizes() == [(64, 48)]
        display.receive(ImageSize(display.id, 30, 18))
        publisher.publish(image("mono8", 64, 48, bytes(64 * 48)))
        assert await sizes() == [(32, 24)]
        display.receive(ImageSize(display.id, 40, 48))  # the last image is sent again, with more pixels
        assert await sizes() == [(64, 48)]


async def test_nothing_is_sent_while_panel_is_hidden():
    async with open_world(make_config("Image")) as world:
        display = world.display("Image")
        display.receive(ImageSize(display.id, 0, 0))
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(make_small_image(1, 2, 3))
        await world.settle()
        assert unpack_contents(display) == []
        display.receive(ImageSize(display.id, 3, 1))
        (content,) = unpack_contents(display)
        assert content.fields["data"].tolist() == [1, 2, 3]


async def test_hidden_panel_unsubscribes_after_one_image():
    async with open_world(make_config("Image")) as world:
        display = world.display("Image")
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        assert publisher.get_subscription_count() == 1
        display.receive(ImageSize(display.id, 0, 0))
        publisher.publish(make_small_image(1, 2, 3))
        await world.settle()
        assert publisher.get_subscription_count() == 0
        display.receive(ImageSize(display.id, 3, 1))
        assert publisher.get_subscription_count() == 1
        assert world.status("Image")["Topic"] == ("ok", "1 messages received"), "earlier messages are still counted"
        publisher.publish(make_small_image(4, 5, 6))
        await world.settle()
        (content,) = unpack_contents(display)
        assert content.fields["data"].tolist() == [4, 5, 6]
        display.receive(ImageSize(display.id, 0, 0))
        assert publisher.get_subscription_count() == 0
        display.set_checked(False)
        display.on_enabled_changed()
        display.receive(ImageSize(display.id, 3, 1))
        assert publisher.get_subscription_count() == 0


async def test_panel_of_closed_page_is_ignored():
    async with open_world(make_config("Image")) as world:
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(make_small_image(1, 2, 3))
        async with open_page(world.viewer) as only_client:
            await only_client.send("image_size", display=world.display("Image").id, width=30, height=18)
            await eventually(lambda: world.display("Image")._panel)
            assert publisher.get_subscription_count() == 1
        await eventually(lambda: publisher.get_subscription_count() == 0)


async def test_largest_panel_determines_image_size(monkeypatch):
    async with open_world(make_config("Image")) as world, open_page(world.viewer) as first:
        display = world.display("Image")
        messages: list[ImageSize] = []
        monkeypatch.setattr(display, "receive", messages.append)

        async def wait_for_size(width: int, height: int) -> None:
            await eventually(lambda: messages and messages[-1] == ImageSize(display.id, width, height))

        await first.send("image_size", display=display.id, width=30, height=18)
        await wait_for_size(30, 18)
        async with open_page(world.viewer) as second:
            await second.send("image_size", display=display.id, width=20, height=50)
            await wait_for_size(30, 50)
        await wait_for_size(30, 18)


async def test_unsupported_encoding_is_reported():
    async with open_world(make_config("Image")) as world:
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(image("64FC1", 1, 1, bytes(8)))
        await world.settle()
        assert world.status("Image")["Image"] == ("error", "Unsupported image encoding [64FC1]")
        publisher.publish(make_small_image(1))
        await world.settle()
        assert "Image" not in world.status("Image")


async def test_range_properties_are_shown_for_16_bit_images():
    async with open_world(make_config("Image")) as world:
        display = world.display("Image")
        assert row_names(display) == {"Topic"}
        publisher = world.graph.create_node("camera").create_publisher(Image, "/camera/image", 5)
        publisher.publish(image("16UC1", 2, 1, np.array([0, 1000], "<u2").tobytes()))
        await world.settle()
        assert row_names(display) == {"Topic", "Normalize Range", "Median window"}
        assert unpack_contents(display)[0].fields["data"].tolist() == [0, 255]
        display.set_property(("Normalize Range",), False)
        assert row_names(display) == {"Topic", "Normalize Range", "Min Value", "Max Value"}
        display.set_property(("Max Value",), 2000.0)
        assert unpack_contents(display)[0].fields["data"].tolist() == [0, 127]


async def test_compressed_image_is_sent_unchanged():
    async with open_world(make_config("Image", "/camera/image/compressed")) as world:
        publisher = world.graph.create_node("camera").create_publisher(CompressedImage, "/camera/image/compressed", 5)
        data = b"\xff\xd8\xff\xe0" + bytes(30)
        publisher.publish(CompressedImage(format="jpeg", data=data))
        await world.settle()
        (content,) = unpack_contents(world.display("Image"))
        assert content.fields["encoding"] == "file"
        assert content.fields["data"].tobytes() == data
        assert world.status("Image")["Image"] == ("error", "The image file is truncated")
        publisher.publish(CompressedImage(format="jpeg", data=data + b"\xff\xd9"))
        await world.settle()
        assert "Image" not in world.status("Image")
        publisher.publish(CompressedImage(format="h264", data=b"0000"))
        await world.settle()
        text = "Browsers do not support the image format 'h264'"
        assert world.status("Image")["Image"] == ("error", text)


@pytest.mark.parametrize("comes_first", ["publisher", "display"])
async def test_compressed_images_are_accepted_on_any_topic(comes_first):
    data = b"\xff\xd8\xff\xe0\xff\xd9"
    async with open_world(make_config("Image", "" if comes_first == "publisher" else "/front/jpeg")) as world:
        publisher = world.graph.create_node("camera").create_publisher(CompressedImage, "/front/jpeg", 5)
        display = world.display("Image")
        if comes_first == "publisher":
            display.set_property(("Topic",), "/front/jpeg")
        await eventually(lambda: publisher.get_subscription_count() == 1)
        publisher.publish(CompressedImage(format="jpeg", data=data))
        await world.settle()
        assert unpack_contents(display)[0].fields["data"].tobytes() == data
        assert world.status("Image")["Topic"] == ("ok", "1 messages received")


async def test_compressed_depths_are_accepted_on_any_topic():
    async with open_world(make_config("Image", "/front/depths")) as world:
        publisher = world.graph.create_node("camera").create_publisher(CompressedImage, "/front/depths", 5)
        await eventually(lambda: publisher.get_subscription_count() == 1)
        file = BytesIO()
        PIL.Image.fromarray(np.array([[0, 1000]], np.uint16)).save(file, "png")
        publisher.publish(CompressedImage(format="16UC1; compressedDepth png", data=bytes(12) + file.getvalue()))
        await world.settle()
        assert unpack_contents(world.display("Image"))[0].fields["data"].tolist() == [0, 255]


def make_camera_info(width: int = 4, height: int = 2, **fields):
    message = CameraInfo(width=width, height=height)
    message.p = np.array([100.0, 0, 2, -10, 0, 50, 1, 0, 0, 0, 1, 0])
    for name, value in fields.items():
        setattr(message, name, value)
    return message


async def test_camera_display_waits_for_camera_info():
    async with open_world(make_config("Camera")) as world:
        node = world.graph.create_node("camera")
        images = node.create_publisher(Image, "/camera/image", 5)
        infos = node.create_publisher(CameraInfo, "/camera/camera_info", 5)
        world.move({("base", "camera"): (1, 2, 3, 0, 0, 0, 1)}, static=True)
        images.publish(make_small_image(1, 2, frame="camera"))
        await world.settle()
        text = "No CameraInfo received on [/camera/camera_info]. Topic may not exist."
        assert world.status("Camera")["Camera Info"] == ("warn", text)
        infos.publish(make_camera_info())
        await world.settle()
        (content,) = unpack_contents(world.display("Camera"))
        assert content.pose == [1, 2, 3, 0, 0, 0, 1]
        assert content.fields["camera"] == {
            "width": 4.0,
            "height": 2.0,
            "focal_x": 100.0,
            "focal_y": 50.0,
            "center_x": 2.0,
            "center_y": 1.0,
            "offset_x": 0.1,
            "offset_y": 0.0,
        }
        assert world.status("Camera")["Camera Info"] == ("ok", "OK")


async def test_malformed_camera_info_is_reported():
    async with open_world(make_config("Camera")) as world:
        node = world.graph.create_node("camera")
        images = node.create_publisher(Image, "/camera/image", 5)
        infos = node.create_publisher(CameraInfo, "/camera/camera_info", 5)

        async def status(message) -> tuple[str, str]:
            infos.publish(message)
            images.publish(make_small_image(1, 2))
            await world.settle()
            assert unpack_contents(world.display("Camera"))[0].fields["camera"] is None
            return world.status("Camera")["Camera Info"]

        invalid_info = make_camera_info()
        invalid_info.p[0] = math.nan
        assert await status(invalid_info) == ("error", "Contains invalid floating point values (nans or infs)")
        invalid_info = make_camera_info()
        invalid_info.p[0] = 0.0
        assert (await status(invalid_info))[0] == "error"
        empty = make_camera_info(0, 0)
        infos.publish(empty)
        images.publish(make_small_image())
        await world.settle()
        assert world.status("Camera")["Camera Info"][1].startswith("Could not determine width/height of image")


async def test_other_displays_can_be_hidden_from_camera():
    async with open_world(make_config("Camera")) as world, open_page(world.viewer) as client:
        await client.opened()
        display = world.display("Camera")

        def boxes() -> list:
            (row,) = (row for row in display.properties.rows() if row.name == "Visibility")
            return [(child.name, [below.name for below in child.children]) for child in row.children]

        assert boxes() == [("Floor", []), ("Sensors", ["Wall"])]
        display.set_property(("Visibility", "Sensors", "Wall"), False)
        assert not display.properties.flag("Visibility", "Sensors", "Wall")
        world.viewer.manager.tree.rename(world.viewer.displays[0], "Ground")
        assert boxes()[0] == ("Ground", [])
