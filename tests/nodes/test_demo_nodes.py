"""The demo nodes: services, and the images of a camera."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.nodes.add_two_ints import AddTwoIntsClient, AddTwoIntsServer
from linkwright.nodes.demo_camera import DemoCamera


async def test_add_two_ints_client_waits_for_server_and_ends(harness, logged):
    client = AddTwoIntsClient(harness.graph, NodeOptions())
    await harness.clock.advance(2.5)
    assert logged("INFO") == ["service not available, waiting again..."] * 2
    AddTwoIntsServer(harness.graph, NodeOptions())
    await harness.clock.advance(0.1)
    assert logged("INFO")[2:] == ["Incoming request\na: 2 b: 3", "Result of add_two_ints: 5"]
    assert client.finished.result() == 0
    client.close()


async def test_demo_camera_image_changes(harness):
    images = []
    harness.node.create_subscription(get_message("sensor_msgs/msg/Image"), "/image", images.append, 10)
    DemoCamera(harness.graph, harness.options({"width": 64, "height": 48, "frequency": 10.0}))
    await harness.clock.advance(0.21)
    assert len(images) == 2
    first, second = (np.asarray(image.data).reshape(48, 64, 3) for image in images)
    assert (images[0].encoding, images[0].step, images[0].header.frame_id) == ("bgr8", 192, "camera_frame")
    assert (np.roll(first, 4, axis=1) == second).all()
    assert len(np.unique(first[0], axis=0)) == 8


@pytest.mark.parametrize(
    ("parameters", "message"),
    [({"width": 0}, "parameter 'width' must be more than 0"), ({"reliability": "maybe"}, "parameter 'reliability'")],
)
async def test_invalid_demo_camera_parameters_are_rejected(harness, parameters, message):
    with pytest.raises(LinkwrightError, match=message):
        DemoCamera(harness.graph, harness.options(parameters))
