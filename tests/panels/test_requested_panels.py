"""The panels that programs of rqt open: their displays and plotted fields."""

from __future__ import annotations

import pytest

from linkwright.messages import get_message
from linkwright.panels.panel_request import PanelRequest
from linkwright.panels.plotted_fields import find_numeric_fields, split_fields, split_topic
from linkwright.panels.requested_panels import RequestedPanelsFeature
from linkwright.rviz import RvizConfig
from tests.viewer.scene import World, open_page, open_world

IMAGE, TF = "rviz_default_plugins/Image", "rviz_default_plugins/TF"
ODOMETRY, FLOAT = get_message("nav_msgs/msg/Odometry"), get_message("std_msgs/msg/Float64")
IMAGE_FILE = f"""\
Visualization Manager:
  Displays:
    - Class: {IMAGE}
      Enabled: false
      Name: Front
      Topic:
        Value: /front
"""


def requested(world: World, request: PanelRequest) -> None:
    world.viewer.add_feature(RequestedPanelsFeature).add(request)


@pytest.mark.parametrize(
    ("text", "fields"),
    [
        ("/odom/x", ["/odom/x"]),
        ("/odom/linear/x:y:z", ["/odom/linear/x", "/odom/linear/y", "/odom/linear/z"]),
        ("/joint_states/position[0]", ["/joint_states/position[0]"]),
    ],
)
def test_colon_separates_fields_of_one_message(text: str, fields: list[str]):
    assert split_fields(text) == fields


def test_longest_existing_topic_is_the_topic_of_a_field():
    topics = ["/odom", "/odom/filtered", "/other"]
    assert split_topic("/odom/twist/linear/x", topics) == ("/odom", "twist.linear.x")
    assert split_topic("/odom/filtered/twist.linear.x", topics) == ("/odom/filtered", "twist.linear.x")
    assert split_topic("/other", topics) == ("/other", "")
    assert split_topic("/missing/x", topics) is None


def test_numbers_directly_in_a_message_are_plotted():
    assert list(find_numeric_fields("twist.twist.linear.x", ODOMETRY)) == ["twist.twist.linear.x"]
    linear = "twist.twist.linear"
    assert list(find_numeric_fields(linear, ODOMETRY)) == [f"{linear}.x", f"{linear}.y", f"{linear}.z"]
    assert list(find_numeric_fields("", FLOAT)) == ["data"]
    assert list(find_numeric_fields("speed", ODOMETRY)) == ["speed"], "the plot shows the reason"


async def test_fields_are_plotted_as_soon_as_their_topics_exist():
    async with open_world() as world:
        node = world.graph.create_node("base")
        node.create_publisher(FLOAT, "/current", 10)
        requested(world, PanelRequest("plot", fields=("/current/data", "/odom/twist/twist/linear/x:y")))
        async with open_page(world.viewer) as client:
            (panel,) = (await client.until("requested_panels"))["panels"]
            assert (panel["panel"], panel["series"]) == ("plot", [{"topic": "/current", "path": "data"}])
            node.create_publisher(ODOMETRY, "/odom", 10)
            (panel,) = (await client.until("requested_panels"))["panels"]
            paths = [series["path"] for series in panel["series"]]
            assert paths == ["data", "twist.twist.linear.x", "twist.twist.linear.y"]


async def test_image_display_receives_from_every_publisher():
    async with open_world() as world:
        requested(world, PanelRequest("image", IMAGE, topic="/camera/image_raw"))
        display = world.display("Image")
        assert display.properties.text("Topic") == "/camera/image_raw"
        assert display.properties.text("Topic", "Reliability Policy") == "Best Effort"
        assert not world.viewer.manager.history.has_unsaved_edits
        async with open_page(world.viewer) as client:
            (panel,) = (await client.until("requested_panels"))["panels"]
            assert (panel["panel"], panel["display"]) == ("image", display.id)


async def test_display_of_the_file_is_enabled_instead_of_a_second_one():
    async with open_world(RvizConfig.parse(IMAGE_FILE)) as world:
        (display,) = world.viewer.displays
        requested(world, PanelRequest("image", IMAGE, topic="/front"))
        assert world.viewer.displays == [display]
        assert display.enabled
        requested(world, PanelRequest("displays", IMAGE))
        assert [shown.properties.text("Topic") for shown in world.viewer.displays] == ["/front", ""]


async def test_tree_of_frames_uses_the_tf_display_of_the_file():
    async with open_world() as world:
        requested(world, PanelRequest("displays", TF))
        requested(world, PanelRequest("displays", TF))
        assert sum(display.CLASS == TF for display in world.viewer.displays) == 1


async def test_panels_open_after_those_of_the_file_and_in_open_pages():
    async with open_world() as world, open_page(world.viewer) as client:
        await client.opened()
        velocities = {"topic": "/drive", "stamped": True, "linear": 1.0, "angular": None}
        requested(world, PanelRequest("teleop", topic="/drive", stamped=True, linear=1.0))
        (teleop,) = (await client.until("requested_panels"))["panels"]
        requested(world, PanelRequest("parameters", node="/arm"))
        assert (teleop["panel"], teleop["velocities"]) == ("teleop", velocities)
        async with open_page(world.viewer) as later:
            kinds = list(await later.opened())
            assert kinds.index("configuration") < kinds.index("requested_panels")
            panels = next(message for message in later.messages if message["type"] == "requested_panels")["panels"]
            assert [(panel["panel"], panel["node"]) for panel in panels] == [("teleop", None), ("parameters", "/arm")]
