"""Costmap filters: keepout zones raise costs after all layers, speed limits follow the robot."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.filters import KeepoutFilter, SpeedFilter, SpeedScale
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.static_layer import Interpretation, StaticLayer
from linkwright.navigation.grids.grid import Grid
from tests.navigation.costmaps.test_layers import ROBOT_POSE, make_costmap, make_occupancy

HERE = (0.0, 0.0, 0.0)


def make_keepout(mask: Grid | None = None, pose=HERE) -> KeepoutFilter:
    keepout = KeepoutFilter(lambda: pose)
    if mask is not None:
        keepout.set_map(mask)
    return keepout


@pytest.mark.parametrize(("value", "cost"), [(0, FREE), (1, 3), (50, 127), (75, 191), (100, LETHAL), (-1, FREE)])
def test_costs_of_mask_are_proportional_to_values(value, cost):
    mask = make_occupancy()
    mask.cells[5, 6] = value
    costmap = make_costmap(filters=[make_keepout(mask)])
    assert costmap.update(ROBOT_POSE, 0)
    assert costmap.costmap.grid.cells[5, 6] == cost


def test_mask_raises_known_costs_and_fills_unknown_cells():
    known = make_occupancy()
    known.cells[1, :] = 100
    known.cells[2, :] = -1
    static = StaticLayer(Interpretation(track_unknown_space=True))
    static.set_map(known)
    mask = make_occupancy()
    mask.cells[:, 7] = 50
    mask.cells[:, 8] = -1
    costmap = make_costmap(static, filters=[make_keepout(mask)], track_unknown=True)
    costmap.update(ROBOT_POSE, 0)
    assert costmap.costmap.grid.cells[:4, 7].tolist() == [127, LETHAL, 127, 127]
    assert costmap.costmap.grid.cells[:4, 8].tolist() == [FREE, LETHAL, UNKNOWN, FREE]


def test_keepout_zone_is_not_inflated_by_later_updates():
    obstacle, mask = make_occupancy(), make_occupancy()
    obstacle.cells[30, 30] = 100
    mask.cells[10, 10] = 100
    static = StaticLayer(Interpretation())
    static.set_map(obstacle)
    costmap = make_costmap(static, InflationLayer(Inflation(inflation_radius=0.5)), filters=[make_keepout(mask)])
    costmap.update(ROBOT_POSE, 0)
    costmap.invalidate()
    costmap.update(ROBOT_POSE, 1)
    cells = costmap.costmap.grid.cells
    assert (cells[10, 10], cells[10, 11]) == (LETHAL, FREE)
    assert (cells[30, 30], cells[30, 31]) == (LETHAL, INSCRIBED)


def test_new_mask_and_disabled_filter_take_effect():
    keepout = make_keepout()
    costmap = make_costmap(filters=[keepout])
    costmap.update(ROBOT_POSE, 0)
    assert costmap.is_current(0)
    mask = make_occupancy()
    mask.cells[3, 3] = 100
    keepout.set_map(mask)
    assert costmap.update(ROBOT_POSE, 1)
    assert costmap.costmap.grid.cells[3, 3] == LETHAL
    keepout.enabled = False
    assert costmap.update(ROBOT_POSE, 2)
    assert costmap.costmap.grid.cells[3, 3] == FREE
    keepout.enabled = True
    costmap.update(ROBOT_POSE, 3)
    assert costmap.costmap.grid.cells[3, 3] == LETHAL
    assert not costmap.update(ROBOT_POSE, 4)


def test_mask_in_another_frame_is_transformed():
    mask = make_occupancy()
    mask.cells[20, 10] = 100
    costmap = make_costmap(filters=[make_keepout(mask, (1.0, 0.0, 0.0))])  # costmap (0, y) is (1, y) in the mask
    costmap.update(ROBOT_POSE, 0)
    assert np.argwhere(costmap.costmap.grid.cells == LETHAL).tolist() == [[20, 0]]


@pytest.mark.parametrize(
    ("scale", "value", "limit"),
    [
        (SpeedScale(100.0, -1.0, is_percentage=True), 30, 70.0),
        (SpeedScale(0.0, 2.0, is_percentage=True), 60, 0.0),
        (SpeedScale(0.5, 0.01, is_percentage=False), 50, 1.0),
        (SpeedScale(-1.0, 0.01, is_percentage=False), 50, 0.0),
        (SpeedScale(0.5, 0.01, is_percentage=False), 0, 0.0),
    ],
)
def test_speed_limit_is_linear_in_value(scale, value, limit):
    assert scale.limit(value) == pytest.approx(limit)


def test_speed_limit_is_published_where_it_changes():
    limits: list[tuple[float, bool]] = []
    speed = SpeedFilter(lambda: HERE, lambda limit, is_percentage: limits.append((limit, is_percentage)))
    costmap = make_costmap(filters=[speed])
    costmap.update((0.55, 0.55, 0.0), 0)
    mask = make_occupancy()
    mask.cells[5, 5:7] = 40
    mask.cells[5, 7] = -1
    speed.mask, speed.scale = mask, SpeedScale(100.0, -1.0, is_percentage=True)
    for x in (0.55, 0.65, 0.75, 0.85, 9.0):
        costmap.update((x, 0.55, 0.0), 1)
    assert limits == [(60.0, True), (0.0, True)]
    assert (costmap.costmap.grid.cells == FREE).all()
