"""slam_gmapping, with scans of known walls and a stepped clock."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import get_service
from linkwright.navigation.grids.occupancy import grid_from_message
from linkwright.navigation.nodes.gmapping import SlamGmapping
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph
from tests.navigation.nodes.test_slam_toolbox import PATH, Robot, is_map_of_walls, map_to_odom, planar_pose
from tests.navigation.slam.scenes import add_drift


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


def start_node(test, **parameters):
    parameters = {"base_frame": "base_footprint", "linearUpdate": 0.5, "map_update_interval": 2.0, **parameters}
    return SlamGmapping(test.graph, NodeOptions(parameters=parameters))


def test_map_is_made_and_odometry_is_corrected(test):
    start_node(test)
    maps, sizes, tf = test.record("/map"), test.record("/map_metadata"), test.record("/tf")
    odometry = add_drift(relative_pose(PATH[0], PATH), 1.04, 0.05)
    Robot(test).go(PATH, odometry)
    assert is_map_of_walls(maps.last)
    assert sizes.last == maps.last.info
    true = relative_pose(PATH[0], PATH[-1])
    assert np.hypot(*(odometry[-1] - true)[:2]) > 0.2
    assert compose(planar_pose(map_to_odom(tf).transform), odometry[-1]) == pytest.approx(true, abs=0.05)
    answer = test.call("/dynamic_map", get_service("nav_msgs/srv/GetMap").Request())
    assert is_map_of_walls(answer.map)


def test_parameters_have_gmappings_names(test):
    start_node(test, delta=0.1, maxUrange=2.0, maxRange=12.0, occ_thresh=0.25, particles=5)
    maps = test.record("/map")
    Robot(test).go(PATH[:12], relative_pose(PATH[0], PATH[:12]))
    grid = grid_from_message(maps.last)
    assert grid.resolution == pytest.approx(0.1)
    assert max(grid.columns, grid.rows) * 0.1 < 10.0  # two meters around the drive
    assert not [record.text for record in test.log if record.level.name == "WARN"]


@pytest.mark.parametrize(("name", "value"), [("delta", 0.0), ("maxUrange", -1.0), ("map_update_interval", 0.0)])
def test_invalid_values_are_errors(test, name, value):
    with pytest.raises(LinkwrightError) as error:
        start_node(test, **{name: value})
    assert error.value.diagnostics[0].code == "NODE433"
