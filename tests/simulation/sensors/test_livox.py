"""Lidars of Livox: rays along a recorded pattern."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.testing import Recording
from tests.simulation.test_plugins import SECOND_NS, running_server
from tests.simulation.worlds import GROUND, box

PATTERN = "Time/s,Azimuth/deg,Zenith/deg\n0.0,0,90\n0.1,90,90\n0.2,180,90\n0.3,0,180\n0.4,0,45\n"
FIELDS = ["x", "y", "z", "intensity", "tag", "line"]
WALLS = box("front", "3.5 0 1 0 0 0"), box("left", "0 4.5 1 0 0 0")
RANGE = "<ray><range><min>0.1</min><max>20</max></range></ray>"


@pytest.fixture
def pattern_file(tmp_path):
    path = tmp_path / "pattern.csv"
    path.write_text(PATTERN)
    return path


def robot(parameters: str, filename: str = "liblivox_laser_simulation.so") -> str:
    plugin = f'<plugin name="livox" filename="{filename}">{RANGE}{parameters}</plugin>'
    sensor = f'<sensor name="mid" type="ray"><pose>0 0 0.5 0 0 0</pose><update_rate>10</update_rate>{plugin}</sensor>'
    return (
        f'<model name="robot"><static>true</static><pose>0 0 0.5 0 0 0</pose><link name="base">{sensor}</link></model>'
    )


async def record(text: str, topic: str, seconds: float = 0.45) -> list:
    async with running_server(GROUND, *WALLS, text, gravity="0 0 0") as (server, graph, log):
        recording = Recording(graph, graph.create_node("listener"), topic)
        await graph.settle()
        server.advance(int(seconds * SECOND_NS))
        await graph.settle()
        assert not log
        return list(recording)


def points(message) -> np.ndarray:
    return np.array([(point.x, point.y, point.z) for point in message.points])


FRONT, LEFT, NOTHING, DOWN = (3.0, 0.0, 0.0), (0.0, 4.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, -1.0)


async def test_scans_continue_the_pattern_and_start_over_at_its_end(pattern_file):
    parameters = f"<csv_file_name>{pattern_file}</csv_file_name><samples>4</samples><ros_topic>points</ros_topic>"
    first, second, *_ = await record(robot(parameters), "/points")
    assert points(first) == pytest.approx(np.array([FRONT, LEFT, NOTHING, DOWN]), abs=1e-6)
    assert points(second) == pytest.approx(np.array([NOTHING, FRONT, LEFT, NOTHING]), abs=1e-6)
    assert first.header.frame_id == "mid"


async def test_downsampling_skips_directions(pattern_file):
    parameters = f"<csv_file_name>{pattern_file}</csv_file_name><samples>4</samples><downsample>3</downsample>"
    first, second, *_ = await record(robot(parameters), "/scan")
    assert points(first) == pytest.approx(np.array([FRONT, DOWN]), abs=1e-6)
    assert points(second) == pytest.approx(np.array([NOTHING, NOTHING]), abs=1e-6)


@pytest.mark.parametrize(
    ("filename", "parameters", "topic"),
    [
        ("liblivox_laser_simulation.so", "<publish_pointcloud_type>2</publish_pointcloud_type>", "/scan"),
        ("libros2_livox.so", "<topic>/mid360</topic>", "/mid360"),
        ("libros2_livox.so", "<topic>/mid360</topic>", "/mid360_PointCloud2"),
    ],
)
async def test_cloud_has_the_fields_of_the_driver(pattern_file, filename, parameters, topic):
    text = robot(f"<csv_file_name>{pattern_file}</csv_file_name><samples>2</samples>{parameters}", filename)
    cloud, *_ = await record(text, topic)
    assert [field.name for field in cloud.fields] == FIELDS
    coordinates = np.array(cloud.data, np.uint8).reshape(cloud.width, cloud.point_step)[:, :12].copy()
    assert coordinates.view(np.float32) == pytest.approx(np.array([FRONT, LEFT]), abs=1e-6)


async def test_transform_leads_from_the_link_to_the_sensor(pattern_file):
    parameters = f"<csv_file_name>{pattern_file}</csv_file_name><samples>1</samples>"
    async with running_server(GROUND, robot(parameters)) as (server, graph, _):
        node = graph.create_node("listener")
        Recording(graph, node, "/scan")
        transforms = Recording(graph, node, "/tf")
        await graph.settle()
        server.advance(SECOND_NS // 5)
        await graph.settle()
        (transform,) = transforms.last.transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("base", "mid")
        assert transform.transform.translation.z == 0.5


@pytest.mark.parametrize(
    ("text", "parameters", "reason"),
    [
        (None, "", "cannot be read: "),
        ("Time,Azimuth\n1,2\n", "", "cannot be read: no line has a time, an azimuth and a zenith angle"),
        (PATTERN, "<samples>0</samples>", "<samples> and <downsample> must be positive"),
    ],
)
async def test_pattern_that_cannot_be_used_is_told_of(tmp_path, text, parameters, reason):
    path = tmp_path / "pattern.csv"
    if text is not None:
        path.write_text(text)
    async with running_server(robot(f"<csv_file_name>{path}</csv_file_name>{parameters}")) as (_, __, log):
        assert reason in log[0].text
