"""Layers of costmaps.

The tests cover inflation's formula, clearing and marking, maps, height levels, and denoising.
"""

from __future__ import annotations

from math import exp, hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.denoise_layer import DenoiseLayer
from linkwright.navigation.costmaps.footprints import make_circle
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.layered import LayeredCostmap
from linkwright.navigation.costmaps.observations import ObservationBuffer, Source
from linkwright.navigation.costmaps.obstacle_layer import HeightRange, ObstacleLayer
from linkwright.navigation.costmaps.range_layer import RangeLayer, RangeReading, RangeSettings
from linkwright.navigation.costmaps.static_layer import Interpretation, StaticLayer
from linkwright.navigation.costmaps.voxel_layer import VoxelLayer, Voxels
from linkwright.navigation.grids.grid import Grid

ROBOT_RADIUS_M = 0.2
SECOND_NS = 1_000_000_000
ROBOT_POSE = (2.05, 2.05, 0.0)


def empty_grid(size: float = 4.0, resolution: float = 0.1) -> Grid:
    cells = round(size / resolution)
    return Grid(cells=np.zeros((cells, cells), np.uint8), resolution=resolution)


def make_costmap(*layers, size: float = 4.0, **options) -> LayeredCostmap:
    return LayeredCostmap(empty_grid(size), layers, make_circle(ROBOT_RADIUS_M), **options)


def make_occupancy(rows: int = 40, columns: int = 40) -> Grid:
    return Grid(cells=np.zeros((rows, columns), np.int8), resolution=0.1)


class OverheadSensor:
    """A sensor above the center of a costmap, with the layer that it updates."""

    def __init__(self, kind=ObstacleLayer, *parameters, layers=(), **source) -> None:
        source_parameters = {"clearing": True, "max_obstacle_height": 2.0, **source}
        self.buffer = ObservationBuffer(Source(**source_parameters))
        self.layer = kind([self.buffer], HeightRange(), *parameters, footprint_clearing=False)
        self.costmap = make_costmap(self.layer, *layers)
        self.time_ns = 0

    def observe(self, *points, origin=(2.05, 2.05, 0.3)) -> np.ndarray:
        self.time_ns += SECOND_NS
        points = np.array([(*point, 0.3)[:3] if len(point) == 2 else point for point in points], float).reshape(-1, 3)
        self.buffer.add(np.array(origin, float), points, self.time_ns)
        return self.update()

    def update(self) -> np.ndarray:
        self.costmap.update(ROBOT_POSE, self.time_ns)
        return self.costmap.costmap.grid.cells


# --- inflation --------------------------------------------------------------------------------------------------------


def inflated_cells(*obstacles, **parameters) -> tuple[np.ndarray, float]:
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer, InflationLayer(Inflation(**parameters)))
    grid = make_occupancy()
    for row, column in obstacles:
        grid.cells[row, column] = 100
    layer.set_map(grid)
    robot.update(ROBOT_POSE, 0)
    return robot.costmap.grid.cells, robot.inscribed_radius


@settings(max_examples=30, deadline=None)
@given(
    obstacles=st.lists(st.tuples(st.integers(0, 39), st.integers(0, 39)), min_size=1, max_size=4),
    radius=st.floats(0.1, 1.2),
    factor=st.floats(0.5, 12.0),
)
def test_inflation_costs_follow_formula_of_nav2(obstacles, radius, factor):
    cells, inscribed = inflated_cells(*obstacles, inflation_radius=radius, cost_scaling_factor=factor)
    inflation_distance = np.ceil(radius / 0.1) * 0.1
    for row, column in np.ndindex(cells.shape):
        distance = 0.1 * min(hypot(row - obstacle[0], column - obstacle[1]) for obstacle in obstacles)
        if distance == 0.0:
            expected = LETHAL
        elif distance > inflation_distance + 1e-9:
            expected = FREE
        elif distance <= inscribed:
            expected = INSCRIBED
        else:
            expected = int(252 * exp(-factor * (distance - inscribed)))
        assert abs(int(cells[row, column]) - expected) <= (0 if expected in (FREE, LETHAL, INSCRIBED) else 1)


def test_partial_update_matches_full_update():
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer, InflationLayer(Inflation(inflation_radius=0.5)))
    grid = make_occupancy()
    grid.cells[5:9, 20] = 100
    layer.set_map(grid)
    robot.update(ROBOT_POSE, 0)
    sensor = OverheadSensor(layers=[InflationLayer(Inflation(inflation_radius=0.5))])
    sensor.observe((2.55, 3.05), (1.05, 2.05))
    partial_cells = sensor.observe((2.55, 3.05)).copy()
    sensor.costmap.invalidate()
    assert np.array_equal(partial_cells, sensor.update())


def test_inflate_unknown_extends_inflation_into_unknown_cells():
    for inflate_unknown in (False, True):
        layer = StaticLayer(Interpretation(track_unknown_space=True))
        inflation = InflationLayer(Inflation(inflate_unknown=inflate_unknown, cost_scaling_factor=3.0))
        robot = make_costmap(layer, inflation, track_unknown=True)
        grid = make_occupancy()
        grid.cells[:] = -1
        grid.cells[20, 20] = 100
        layer.set_map(grid)
        robot.update(ROBOT_POSE, 0)
        cells = robot.costmap.grid.cells
        assert cells[20, 21] == INSCRIBED
        assert (cells[20, 24] == UNKNOWN) != inflate_unknown
        assert cells[0, 0] == UNKNOWN


# --- rays and points --------------------------------------------------------------------------------------------------


def test_obstacle_is_marked_and_cleared_by_passing_ray():
    sensor = OverheadSensor()
    assert sensor.observe((2.55, 2.05))[20, 25] == LETHAL
    assert sensor.observe((2.95, 2.05))[20].tolist()[20:31] == [0] * 9 + [LETHAL, 0]


def test_rays_clear_only_cells_they_pass():
    sensor = OverheadSensor()
    cells = sensor.observe((2.55, 2.05), (2.55, 2.55), (1.05, 1.05), (2.05, 3.05))
    marked = np.argwhere(cells == LETHAL).tolist()
    assert marked == [[10, 10], [20, 25], [25, 25], [30, 20]]
    sensor.layer.layer_grid.cells[:] = LETHAL
    sensor.observe((2.55, 2.05))
    assert np.argwhere(sensor.layer.layer_grid.cells != LETHAL).tolist() == [[20, column] for column in range(20, 25)]


def test_maximum_ranges_limit_marking_and_clearing():
    sensor = OverheadSensor(obstacle_max_range=1.0, raytrace_max_range=0.5)
    sensor.layer.layer_grid.cells[:] = LETHAL
    sensor.costmap.invalidate()
    cells = sensor.observe((3.55, 2.05))
    assert np.flatnonzero(cells[20] == FREE).tolist() == [20, 21, 22, 23, 24, 25]
    sensor = OverheadSensor(obstacle_max_range=1.0)
    assert not sensor.observe((3.55, 2.05)).any()


def test_minimum_ranges_limit_marking_and_clearing():
    sensor = OverheadSensor(obstacle_min_range=0.3, raytrace_min_range=0.3)
    sensor.layer.layer_grid.cells[20] = LETHAL
    cells = sensor.observe((2.25, 2.05), (3.05, 2.05))
    assert np.flatnonzero(cells[20, 20:] == FREE).tolist() == [3, 4, 5, 6, 7, 8, 9]


def test_points_outside_height_range_neither_mark_nor_clear():
    sensor = OverheadSensor(max_obstacle_height=1.0)
    sensor.layer.layer_grid.cells[20, 22] = LETHAL
    sensor.costmap.invalidate()
    cells = sensor.observe((2.55, 2.05, 1.5), (np.nan, 2.05, 0.2))
    assert np.argwhere(cells).tolist() == [[20, 22]]


def test_ray_that_leaves_costmap_clears_up_to_its_edge():
    sensor = OverheadSensor(raytrace_max_range=9.0)
    sensor.layer.layer_grid.cells[20] = LETHAL
    cells = sensor.observe((9.0, 2.05))
    assert np.flatnonzero(cells[20] == FREE).tolist() == list(range(20, 40))


def test_observation_persistence_keeps_points():
    sensor = OverheadSensor(observation_persistence=1.5, clearing=False)
    sensor.observe((2.55, 2.05))
    sensor.observe((3.05, 2.05))
    sensor.layer.layer_grid.cells[:] = FREE
    assert sensor.update()[20, [25, 30]].tolist() == [LETHAL, LETHAL]
    sensor.layer.layer_grid.cells[:] = FREE
    sensor.costmap.invalidate()
    assert sensor.observe()[20, [25, 30]].tolist() == [FREE, LETHAL]


def test_silent_sensor_makes_costmap_outdated():
    sensor = OverheadSensor(expected_update_rate=1.0)
    assert not sensor.costmap.is_current(0)
    sensor.observe((2.55, 2.05))
    assert sensor.costmap.is_current(sensor.time_ns + SECOND_NS)
    assert not sensor.costmap.is_current(sensor.time_ns + 2 * SECOND_NS)


def test_footprint_of_robot_is_cleared():
    buffer = ObservationBuffer(Source(max_obstacle_height=2.0))
    robot = make_costmap(ObstacleLayer([buffer], HeightRange()))
    buffer.add(np.array([2.05, 2.05, 0.3]), np.array([[2.15, 2.05, 0.3], [2.45, 2.05, 0.3]]), 0)
    robot.update(ROBOT_POSE, 0)
    assert np.argwhere(robot.costmap.grid.cells).tolist() == [[20, 24]]


# --- levels of height -------------------------------------------------------------------------------------------------


def test_voxel_layer_keeps_obstacle_below_ray():
    sensor = OverheadSensor(VoxelLayer, Voxels())
    assert sensor.observe((2.55, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 25] == LETHAL
    assert sensor.observe((2.95, 2.05, 0.5), origin=(2.05, 2.05, 0.5))[20, 25] == LETHAL
    assert sensor.observe((2.95, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 25] == FREE


def test_descending_ray_clears_voxels_it_passes():
    sensor = OverheadSensor(VoxelLayer, Voxels())
    sensor.observe((2.55, 2.05, 0.5), (2.85, 2.05, 0.5), origin=(2.05, 2.05, 0.5))
    cells = sensor.observe((3.05, 2.05, 0.2), origin=(2.05, 2.05, 0.8))
    assert cells[20, 25] == FREE  # the ray passes at a height of 0.5 m
    assert cells[20, 28] == LETHAL  # the ray passes at 0.32 m, above the obstacle


def test_voxel_columns_with_few_observations_are_unknown():
    sensor = OverheadSensor(VoxelLayer, Voxels(unknown_threshold=8))
    sensor.costmap = make_costmap(sensor.layer, track_unknown=True)
    assert sensor.observe((2.55, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 22] == UNKNOWN
    assert sensor.observe((2.55, 2.05, 0.3), origin=(2.05, 2.05, 0.3))[20, 22] == FREE


# --- maps -------------------------------------------------------------------------------------------------------------


def test_map_values_become_costs():
    def compute_costs(**parameters):
        return (
            Interpretation(**parameters).cost_table()[np.array([0, 50, 99, 100, -1], np.int8).astype(np.uint8)].tolist()
        )

    assert compute_costs() == [FREE, FREE, FREE, LETHAL, FREE]
    assert compute_costs(track_unknown_space=True, lethal_threshold=50) == [FREE, LETHAL, LETHAL, LETHAL, UNKNOWN]
    assert compute_costs(trinary=False) == [0, 127, 251, LETHAL, FREE]


def test_rotated_map_is_placed_in_costmap_frame():
    layer = StaticLayer(Interpretation(), pose=lambda: (0.0, 4.0, -np.pi / 2))
    robot = make_costmap(layer)
    grid = make_occupancy()
    grid.cells[0, 39] = 100  # x 3.95, y 0.05 in the map
    layer.set_map(grid)
    robot.update(ROBOT_POSE, 0)
    assert np.argwhere(robot.costmap.grid.cells).tolist() == [[39, 39]]


@given(x=st.integers(-50, 50), y=st.integers(-50, 50))
def test_map_with_offset_is_placed_in_costmap(x, y):
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer)
    grid = make_occupancy(20, 30)
    grid.cells[:] = np.where(np.random.default_rng(0).random((20, 30)) < 0.5, 100, 0)
    grid.x, grid.y = 0.1 * x, 0.1 * y
    layer.set_map(grid)
    robot.update(ROBOT_POSE, 0)
    rows, columns = np.mgrid[:40, :40]
    map_cells = np.stack((rows - y, columns - x), axis=-1)
    is_inside = grid.contains(map_cells)
    expected = np.zeros((40, 40), np.uint8)
    expected[is_inside] = np.where(grid.cells[map_cells[is_inside][:, 0], map_cells[is_inside][:, 1]] == 100, LETHAL, 0)
    assert np.array_equal(robot.costmap.grid.cells, expected)


def test_map_update_changes_part_of_static_layer():
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer)
    assert not layer.update_map(0, 0, np.array([[100]], np.int8))
    layer.set_map(make_occupancy())
    robot.update(ROBOT_POSE, 0)
    assert layer.update_map(3, 4, np.array([[100]], np.int8))
    assert not layer.update_map(39, 39, np.array([[100, 100]], np.int8))
    robot.update(ROBOT_POSE, 0)
    assert np.argwhere(robot.costmap.grid.cells).tolist() == [[3, 4]]


def test_costmap_without_map_is_not_current():
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer)
    robot.update(ROBOT_POSE, 0)
    assert not robot.is_current(0)
    layer.set_map(make_occupancy())
    robot.update(ROBOT_POSE, 0)
    assert robot.is_current(0)
    assert not robot.update(ROBOT_POSE, 0)


# --- ranges -----------------------------------------------------------------------------------------------------------


class RangeSensor:
    """A range sensor with its costmap."""

    def __init__(self, **settings) -> None:
        self.layer = RangeLayer(RangeSettings(**settings))
        self.costmap = make_costmap(self.layer)

    def measure(self, distance: float, *, free: bool = False, times: int = 5) -> np.ndarray:
        for _ in range(times):
            self.layer.add(RangeReading(1.05, 2.05, 0.0, distance, 0.5, free, SECOND_NS))
        self.costmap.update(ROBOT_POSE, SECOND_NS)
        return self.costmap.costmap.grid.cells


def test_repeated_sonar_readings_mark_and_clear_obstacle():
    sonar = RangeSensor()
    assert sonar.measure(1.0)[20, 20] == LETHAL
    assert not sonar.costmap.costmap.grid.cells[20, 10:18].any()
    cells = sonar.measure(2.0, times=12)
    assert cells[20, 20] == FREE
    assert cells[20, 30] == LETHAL


def test_sonar_marks_only_cells_in_its_cone():
    sonar = RangeSensor()
    marked = np.argwhere(sonar.measure(1.0) == LETHAL)
    angles = np.arctan2(marked[:, 0] - 20, marked[:, 1] - 10)
    assert np.abs(angles).max() <= 0.25 + 0.05
    assert (marked[:, 1] > 15).all()
    assert (sonar.layer.layer_grid.cells[:, :10] == 127).all()


def test_sonar_reading_without_echo_clears_cone():
    sonar = RangeSensor()
    sonar.measure(1.0)
    assert not (sonar.measure(2.0, free=True, times=1)[18:23, 15:28] == LETHAL).any()


def test_silent_sonar_makes_costmap_outdated():
    sonar = RangeSensor(no_readings_timeout=1.0)
    assert not sonar.costmap.is_current(SECOND_NS)
    sonar.measure(1.0)
    assert sonar.costmap.is_current(2 * SECOND_NS)
    assert not sonar.costmap.is_current(3 * SECOND_NS)


def test_clearing_resets_sonar_likelihoods():
    sonar = RangeSensor()
    sonar.measure(1.0)
    sonar.costmap.clear_around(ROBOT_POSE, 9.0)
    sonar.costmap.update(ROBOT_POSE, SECOND_NS)
    assert not sonar.costmap.costmap.grid.cells.any()
    assert (sonar.layer.layer_grid.cells == 127).all()


# --- specks -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("connectivity", "remaining"), [(8, 5), (4, 3)])
def test_denoise_layer_removes_small_groups(connectivity, remaining):
    layer = StaticLayer(Interpretation())
    robot = make_costmap(layer, DenoiseLayer(2, connectivity))
    grid = make_occupancy()
    grid.cells[10, 10] = 100
    grid.cells[[20, 21], [20, 21]] = 100
    grid.cells[30, 3:6] = 100
    layer.set_map(grid)
    robot.update(ROBOT_POSE, 0)
    assert np.count_nonzero(robot.costmap.grid.cells) == remaining


# --- windows that move, and clearing ----------------------------------------------------------------------------------


def test_rolling_window_keeps_observations():
    buffer = ObservationBuffer(Source(max_obstacle_height=2.0))
    layer = ObstacleLayer([buffer], HeightRange(), footprint_clearing=False)
    robot = make_costmap(layer, is_rolling=True, size=2.0)
    robot.update((0.0, 0.0, 0.0), 0)
    buffer.add(np.array([0.0, 0.0, 0.3]), np.array([[0.55, 0.25, 0.3]]), 0)
    robot.update((0.0, 0.0, 0.0), 0)
    assert robot.costmap.cost_at(np.array([0.55, 0.25])) == LETHAL
    buffer.add(np.array([0.0, 0.0, 0.3]), np.zeros((0, 3)), 0)
    robot.update((0.73, -0.31, 0.0), 0)
    grid = robot.costmap.grid
    assert robot.costmap.cost_at(np.array([0.55, 0.25])) == LETHAL
    assert np.count_nonzero(grid.cells) == 1
    assert abs(grid.x + 1.0 - 0.73) < 0.1 + 1e-9
    robot.update((9.0, 0.0, 0.0), 0)
    assert not robot.costmap.grid.cells.any()


def test_clear_around_clears_inside_or_outside_of_window():
    for layer_type, arguments in ((ObstacleLayer, ()), (VoxelLayer, (Voxels(),))):
        sensor = OverheadSensor(layer_type, *arguments)
        sensor.observe((2.55, 2.05), (3.55, 2.05))
        sensor.buffer.add(np.array([2.05, 2.05, 0.3]), np.zeros((0, 3)), 0)
        sensor.costmap.clear_around(ROBOT_POSE, 1.4, clear_outside=True)
        assert np.argwhere(sensor.update() == LETHAL).tolist() == [[20, 25]]
        sensor.costmap.clear_around(ROBOT_POSE, 1.4)
        assert not (sensor.update() == LETHAL).any()


def test_clearing_removes_observations_and_keeps_map():
    layer = StaticLayer(Interpretation())
    sensor = OverheadSensor(layers=[])
    robot = LayeredCostmap(empty_grid(), [layer, sensor.layer], make_circle(ROBOT_RADIUS_M))
    grid = make_occupancy()
    grid.cells[3, 3] = 100
    layer.set_map(grid)
    sensor.costmap = robot
    sensor.observe((2.55, 2.05))
    sensor.buffer.add(np.array([2.05, 2.05, 0.3]), np.zeros((0, 3)), 0)
    robot.clear_entirely()
    assert not robot.is_current(0)
    assert np.argwhere(sensor.update()).tolist() == [[3, 3]]
    assert robot.is_current(0)
