"""RealSense cameras: images of four sensors, depths in millimeters, and the point cloud."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server

WALL = (
    '<model name="wall"><static>true</static><pose>2 0 1 0 0 0</pose><link name="l"><visual name="v"><geometry><box>'
    "<size>0.2 10 10</size></box></geometry><material><diffuse>1 0 0 1</diffuse><ambient>1 0 0 1</ambient></material>"
    "</visual></link></model>"
)
TOPICS = "".join(f"<{name}TopicName>{{0}}{name}/image_raw</{name}TopicName>" for name in ("color", "depth"))


def camera(name: str, kind: str, image_format: str) -> str:
    image = f"<image><width>16</width><height>12</height><format>{image_format}</format></image>"
    return (
        f'<sensor name="d435_{name}" type="{kind}"><update_rate>10</update_rate><camera><horizontal_fov>1.0'
        f"</horizontal_fov>{image}<clip><near>0.1</near><far>100</far></clip></camera></sensor>"
    )


def robot(prefix: str = "camera/", parameters: str = "", *, sensors: str = "color ired1 ired2 depth") -> str:
    formats = {"color": "RGB_INT8", "ired1": "L_INT8", "ired2": "L_INT8", "depth": "R8G8B8"}
    cameras = "".join(camera(name, "depth" if name == "depth" else "camera", formats[name]) for name in sensors.split())
    return (
        '<model name="robot"><static>true</static><pose>0 0 1 0 0 0</pose><link name="d435"><inertial><mass>1</mass>'
        f'</inertial>{cameras}</link><plugin name="camera" filename="librealsense_gazebo_plugin.so">'
        f"<prefix>d435_</prefix>{TOPICS.format(prefix)}<colorOpticalframeName>color_optical</colorOpticalframeName>"
        f"<depthOpticalframeName>depth_optical</depthOpticalframeName>{parameters}</plugin></model>"
    )


async def record(text: str, *topics: str) -> list:
    """Return the last messages of topics after half a second."""
    async with running_server(WALL, text) as (server, graph, log):
        recordings = [Recording(graph, server.node, topic) for topic in topics]
        server.advance(SECOND_NS // 2)
        await graph.settle()
        assert all(record.level.name == "INFO" for record in log), [record.text for record in log]
        assert all(len(recording) == 5 for recording in recordings)
        return [recording.last for recording in recordings]


@pytest.mark.parametrize("prefix", ["camera/", ""])
async def test_images_are_published_below_the_name_of_the_plugin(prefix):
    topics = ("color/image_raw", "ired1/image_raw", "color/camera_info")
    color, infrared, info = await record(robot(prefix), *(f"/camera/{topic}" for topic in topics))
    assert (color.encoding, color.header.frame_id) == ("rgb8", "color_optical")
    red, green, blue = np.array(color.data).reshape(12, 16, 3)[6, 8].tolist()
    assert red > 100 > max(green, blue)
    assert (infrared.encoding, infrared.step) == ("8UC1", 16)
    assert (info.width, info.header.frame_id) == (16, "color_optical")


async def test_depths_are_millimeters_in_the_range():
    (depth,) = await record(robot(), "/camera/depth/image_raw")
    assert (depth.encoding, depth.header.frame_id, depth.step) == ("16UC1", "depth_optical", 32)
    values = np.array(depth.data).view("<u2").reshape(12, 16)
    assert values == pytest.approx(np.full((12, 16), 1900), abs=10)
    (near,) = await record(robot(parameters="<rangeMaxDepth>1.5</rangeMaxDepth>"), "/camera/depth/image_raw")
    assert not np.array(near.data).any()


async def test_point_cloud_is_in_the_optical_frame_and_cut_off():
    cloud_parameters = "<pointCloud>true</pointCloud><pointCloudTopicName>depth/color/points</pointCloudTopicName>"
    (cloud,) = await record(robot(parameters=cloud_parameters), "/camera/depth/color/points")
    points = np.array(cloud.data).view("<f4").reshape(12, 16, 8)
    assert points[..., 2] == pytest.approx(np.full((12, 16), 1.9), abs=0.01)
    assert points[0, 0, 0] < 0.0 < points[-1, -1, 0]
    assert points[0, 0, 1] < 0.0 < points[-1, -1, 1]
    cut_off = f"{cloud_parameters}<pointCloudCutoffMax>1.0</pointCloudCutoffMax>"
    (cloud,) = await record(robot(parameters=cut_off), "/camera/depth/color/points")
    assert np.isnan(np.array(cloud.data).view("<f4").reshape(12, 16, 8)[..., 2]).all()


async def test_missing_sensor_is_told_of():
    async with running_server(robot(sensors="color ired1 depth")) as (_, __, log):
        assert "plugin 'camera': there is no sensor 'd435_ired2'" in log[0].text
