"""octomap_server: a box and a floor in space, read back from the octrees, markers, clouds and the map from above."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.octrees import build_levels, codes_of_keys, encode_levels, encode_octree, keys_of_codes
from linkwright.graph import SENSOR_DATA_QOS, STATIC_TF_PUBLISHER_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.grids.occupancy import grid_from_message
from linkwright.nodes import NodeOptions
from linkwright.perception.nodes.octomap_server import OctomapServer, OctomapServerStatic
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points
from linkwright.perception.octomaps.occupancy import OccupancyOctree, SensorModel, log_odds
from linkwright.perception.octomaps.rays import find_passed_cells
from linkwright.rviz.displays.moveit.octree import read_octree
from linkwright.testing import SteppedGraph

RESOLUTION = 0.1
SENSOR = np.array((0.05, 0.05, 1.05))


def wall_points():
    """Return points of a wall 2 m in front of the sensor."""
    y, z = np.meshgrid(np.arange(-0.95, 1.0, 0.1), np.arange(0.05, 2.0, 0.1))
    return np.stack([np.full(y.size, 2.05), y.ravel(), z.ravel()], axis=-1)


def cells_of(message):
    return read_octree(
        data=bytes(message.data.tobytes()), binary=message.binary, kind=message.id, resolution=message.resolution
    )


class Mapper:
    """A node with a sensor at a fixed place, and what the node publishes."""

    def __init__(self, test, **parameters):
        self.test = test
        OctomapServer(test.graph, NodeOptions(parameters={"resolution": RESOLUTION, **parameters}))
        node = test.create_node("camera")
        static = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        poses = [(*SENSOR, 0, 0, 0, 1), (0, 0, 0, 0, 0, 0, 1)]
        static.publish(TFMessage(batch=TransformBatch(("map", "map"), ("lens", "base_footprint"), 0, np.array(poses))))
        self._clouds = node.create_publisher(get_message("sensor_msgs/msg/PointCloud2"), "/cloud_in", SENSOR_DATA_QOS)
        self.records = {
            name: test.record(f"/{name}")
            for name in (
                *("occupied_cells_vis_array", "free_cells_vis_array", "octomap_binary", "octomap_full"),
                *("octomap_point_cloud_centers", "projected_map"),
            )
        }
        test.settle()

    def see(self, points, frame="lens"):
        values = np.asarray(points, float) - (SENSOR if frame == "lens" else 0)
        field = get_message("sensor_msgs/msg/PointField")
        message = get_message("sensor_msgs/msg/PointCloud2")()
        message.header.frame_id, message.header.stamp = frame, Time.from_nanoseconds(self.test.clock.now_ns())
        message.fields = [field(name=name, offset=8 * i, datatype=8, count=1) for i, name in enumerate("xyz")]
        message.height, message.width = 1, len(values)
        message.point_step, message.row_step = 24, 24 * len(values)
        message.data = np.frombuffer(values.astype("<f8").tobytes(), np.uint8)
        self._clouds.publish(message)
        self.test.advance(0.1)

    def last(self, name):
        return self.records[name].last


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


def test_wall_is_occupied_and_the_space_before_it_is_free(test):
    mapper = Mapper(test)
    mapper.see(wall_points())
    for name in ("octomap_binary", "octomap_full"):
        message = mapper.last(name)
        assert (message.header.frame_id, message.id, message.binary) == ("map", "OcTree", name == "octomap_binary")
        cells = cells_of(message)
        occupied, free = cells.select(cells.probabilities > 0.5), cells.select(cells.probabilities < 0.5)
        assert (occupied.sizes**3).sum() == pytest.approx(400 * RESOLUTION**3)
        assert np.abs(occupied.centers[:, 0] - 2.05).max() < 0.1
        assert len(free.centers) > 100
        assert (free.centers[:, 0] < 2.0).all()
    assert cells.probabilities.max() == pytest.approx(0.7)
    assert cells.probabilities.min() == pytest.approx(0.4)


def test_markers_cloud_and_projection_have_the_occupied_cells(test):
    mapper = Mapper(test, publish_free_space=True, use_height_map=True, compress_map=False)
    mapper.see(wall_points())
    markers = mapper.last("occupied_cells_vis_array").markers
    assert [marker.action for marker in markers] == [2] * 16 + [0]
    (finest,) = markers[16:]
    assert (finest.scale.x, len(finest.points), len(finest.colors)) == (pytest.approx(RESOLUTION), 400, 400)
    heights = [point.z for point in finest.points]
    top, bottom = (finest.colors[heights.index(value)] for value in (max(heights), min(heights)))
    assert (top.r, top.g, top.b) == (1.0, 0.0, 0.0)
    assert bottom.b == 1.0
    points = read_points(mapper.last("octomap_point_cloud_centers"))
    np.testing.assert_allclose(np.sort(points, axis=0), np.sort(wall_points(), axis=0), atol=1e-5)
    assert len(mapper.last("free_cells_vis_array").markers[16].points) > 100
    grid = grid_from_message(mapper.last("projected_map"))
    column = grid.cells[:, -1]
    assert (column == 100).sum() == 20
    assert (grid.cells == 0).sum() > 50
    assert grid.x + grid.columns * RESOLUTION == pytest.approx(2.1)


def test_repeated_views_saturate_and_a_removed_wall_disappears(test):
    mapper = Mapper(test)
    for _ in range(8):
        mapper.see(wall_points())
    cells = cells_of(mapper.last("octomap_full"))
    assert (cells.probabilities.max(), cells.probabilities.min()) == (pytest.approx(0.97), pytest.approx(0.12))
    behind = SENSOR + (wall_points() - SENSOR) * 2
    for _ in range(12):
        mapper.see(behind)
    cells = cells_of(mapper.last("octomap_binary"))
    occupied = cells.select(cells.probabilities > 0.5)
    assert (np.abs(occupied.centers[:, 0] - 2.05) > 0.5).mean() > 0.9


def test_far_points_only_free_cells(test):
    mapper = Mapper(test, **{"sensor_model.max_range": 1.5})
    mapper.see(wall_points())
    cells = cells_of(mapper.last("octomap_binary"))
    assert (cells.probabilities < 0.5).all()
    assert np.linalg.norm(cells.centers - SENSOR, axis=1).max() < 1.5 + RESOLUTION


def test_ground_is_free_and_heights_are_limited(test):
    x, y = np.meshgrid(np.arange(0.5, 2.0, 0.05), np.arange(-1.0, 1.0, 0.05))
    floor = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.02)], axis=-1)
    mapper = Mapper(test, filter_ground_plane=True, point_cloud_max_z=1.5, occupancy_max_z=1.2)
    mapper.see(np.concatenate([floor, wall_points()]))
    cells = cells_of(mapper.last("octomap_binary"))
    occupied = cells.select(cells.probabilities > 0.5)
    assert np.abs(occupied.centers[:, 0] - 2.05).max() < 0.1
    assert occupied.centers[:, 2].max() < 1.6
    shown = read_points(mapper.last("octomap_point_cloud_centers"))
    assert shown[:, 2].max() < 1.3


def test_speckles_are_hidden(test):
    mapper = Mapper(test, filter_speckles=True)
    mapper.see(np.concatenate([wall_points(), [(1.05, 0.85, 1.85)]]))
    assert len(read_points(mapper.last("octomap_point_cloud_centers"))) == 400


def test_services_return_clear_and_reset_the_map(test):
    mapper = Mapper(test)
    mapper.see(wall_points())
    get = get_service("octomap_msgs/srv/GetOctomap").Request
    answers = [test.call(f"/octomap_{kind}", get()).map for kind in ("binary", "full")]
    assert [answer.binary for answer in answers] == [True, False]
    query = get_service("octomap_msgs/srv/BoundingBoxQuery").Request()
    query.min.x, query.min.y, query.min.z, query.max.x, query.max.y, query.max.z = 1.9, -2.0, 0.0, 2.5, 2.0, 1.0
    test.call("/octomap_server/clear_bbox", query)
    cells = cells_of(mapper.last("octomap_binary"))
    assert (cells.select(cells.probabilities > 0.5).sizes ** 3).sum() == pytest.approx(200 * RESOLUTION**3)
    test.call("/octomap_server/reset", get_service("std_srvs/srv/Empty").Request())
    assert len(mapper.last("octomap_binary").data) == 0
    assert mapper.last("projected_map").info.width == 0
    assert all(marker.action == marker.DELETE for marker in mapper.last("occupied_cells_vis_array").markers)


@pytest.mark.parametrize(("name", "value"), [("resolution", 0.0), ("sensor_model.hit", 1.0), ("sensor_model.min", 0.0)])
def test_invalid_values_are_errors(test, name, value):
    with pytest.raises(LinkwrightError) as error:
        OctomapServer(test.graph, NodeOptions(parameters={name: value}))
    assert error.value.diagnostics[0].code == "NODE433"


def test_static_server_offers_the_map_of_a_file(test, tmp_path):
    data, _ = encode_octree((3, 0, -2), np.full((4, 4, 4), 2))
    path = tmp_path / "box.bt"
    path.write_bytes(b"# Octomap OcTree binary file\n# a box\nid OcTree\nsize 9\nres 0.25\ndata\n" + data)
    OctomapServerStatic(test.graph, NodeOptions(parameters={"octomap_path": str(path), "frame_id": "house"}))
    octomap = test.call("/octomap_binary", get_service("octomap_msgs/srv/GetOctomap").Request()).map
    assert (octomap.header.frame_id, octomap.resolution) == ("house", 0.25)
    assert (cells_of(octomap).sizes ** 3).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("content", [None, b"", b"id OcTree\nres 0.1\ndata\n", b"# Octomap OcTree file\nres x\ndata\n"])
def test_files_that_are_no_maps_are_errors(test, tmp_path, content):
    path = tmp_path / "map.bt"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(LinkwrightError) as error:
        OctomapServerStatic(test.graph, NodeOptions(parameters={"octomap_path": str(path)}))
    assert error.value.diagnostics[0].code == "NODE435"


def test_rays_pass_all_cells_between_their_ends():
    ends = np.random.default_rng(3).uniform(-3, 3, (200, 3))
    cells = {tuple(cell) for cell in find_passed_cells(SENSOR, ends, RESOLUTION).tolist()}
    shares = np.linspace(0, 1, 400, endpoint=False)[:, None]
    for end in ends:
        sampled = np.floor((SENSOR + shares * (end - SENSOR)) / RESOLUTION).astype(int)
        last = np.floor(end / RESOLUTION).astype(int)
        assert {tuple(cell) for cell in sampled.tolist()} - {tuple(last.tolist())} <= cells


def test_full_form_is_read_back_with_merged_cells():
    rng = np.random.default_rng(5)
    keys = np.unique(rng.integers(-6, 6, (300, 3)), axis=0)
    block = np.argwhere(np.ones((4, 4, 4), int)) + 8
    codes, _ = codes_of_keys(np.concatenate([keys, block]))
    codes = np.sort(codes)
    assert (np.sort(codes_of_keys(keys_of_codes(codes))[0]) == codes).all()
    is_block = (keys_of_codes(codes) >= 8).all(axis=1)
    values = np.where(is_block, np.float32(1.5), rng.uniform(-2, 3, len(codes)).astype(np.float32))
    cells = read_octree(data=encode_levels(build_levels(codes, values)), binary=False, kind="OcTree", resolution=1.0)
    assert (cells.sizes**3).sum() == len(codes)
    (merged,) = cells.centers[cells.sizes == 4.0]
    assert merged.tolist() == [10.0, 10.0, 10.0]
    single = cells.select(cells.sizes == 1.0)
    found = dict(zip(map(tuple, np.floor(single.centers).astype(int).tolist()), single.probabilities, strict=True))
    for key, value in zip(keys_of_codes(codes[~is_block]).tolist(), values[~is_block], strict=True):
        assert log_odds(found[tuple(key)]) == pytest.approx(value, abs=1e-4)


def test_one_more_view_costs_no_repeated_cells():
    octree = OccupancyOctree(RESOLUTION, SensorModel())
    octree.insert(SENSOR, wall_points(), np.zeros((0, 3)))
    count = len(octree.codes)
    octree.insert(SENSOR, wall_points(), np.zeros((0, 3)))
    assert len(octree.codes) == count
    assert (np.diff(octree.codes) > 0).all()
