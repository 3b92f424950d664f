"""Layers of costmaps: the formula of inflation, what rays clear and points mark, maps, levels of height, specks."""

from __future__ import annotations

from math import exp, hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.costmaps.costmap import FREE, INSCRIBED, LETHAL, UNKNOWN
from linkwright.navigation.costmaps.denoise_layer import DenoiseLayer
from linkwright.navigation.costmaps.footprints import circle
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.layered import LayeredCostmap
from linkwright.navigation.costmaps.observations import ObservationBuffer, Source
from linkwright.navigation.costmaps.obstacle_layer import HeightRange, ObstacleLayer
from linkwright.navigation.costmaps.range_layer import RangeLayer, RangeReading, RangeSettings
from linkwright.navigation.costmaps.static_layer import Interpretation, StaticLayer
from linkwright.navigation.costmaps.voxel_layer import VoxelLayer, Voxels
from linkwright.navigation.grids.grid import Grid

RADIUS = 0.2
SECOND = 1_000_000_000
HERE = (2.05, 2.05, 0.0)


def blank(size: float = 4.0, resolution: float = 0.1) -> Grid:
    cells = round(size / resolution)
    return Grid(cells=np.zeros((cells, cells), np.uint8), resolution=resolution)


def costmap(*layers, size: float = 4.0, **more) -> LayeredCostmap:
    return LayeredCostmap(blank(size), layers, circle(RADIUS), **more)


def occupancy(rows: int = 40, columns: int = 40) -> Grid:
    return Grid(cells=np.zeros((rows, columns), np.int8), resolution=0.1)


class Eye:
    """A sensor above the middle of the costmap, and what is updated with it."""

    def __init__(self, kind=ObstacleLayer, *more, layers=(), **source) -> None:
        given = {"clearing": True, "max_obstacle_height": 2.0, **source}
        self.buffer = ObservationBuffer(Source(**given))
        self.layer = kind([self.buffer], HeightRange(), *more, footprint_clearing=False)
        self.costmap = costmap(self.layer, *layers)
        self.time_ns = 0

    def see(self, *points, origin=(2.05, 2.05, 0.3)) -> np.ndarray:
        self.time_ns += SECOND
        points = np.array([(*point, 0.3)[:3] if len(point) == 2 else point for point in points], float).reshape(-1, 3)
        self.buffer.add(np.array(origin, float), points, self.time_ns)
        return self.update()

    def update(self) -> np.ndarray:
        self.costmap.update(HERE, self.time_ns)
        return self.costmap.costmap.grid.cells


# --- inflation --------------------------------------------------------------------------------------------------------


def inflated(*obstacles, **parameters) -> tuple[np.ndarray, float]:
    layer = StaticLayer(Interpretation())
    scene = costmap(layer, InflationLayer(Inflation(**parameters)))
    grid = occupancy()
    for row, column in obstacles:
        grid.cells[row, column] = 100
    layer.set_map(grid)
    scene.update(HERE, 0)
    return scene.costmap.grid.cells, scene.inscribed_radius


@settings(max_examples=30, deadline=None)
@given(
    obstacles=st.lists(st.tuples(st.integers(0, 39), st.integers(0, 39)), min_size=1, max_size=4),
    radius=st.floats(0.1, 1.2),
    factor=st.floats(0.5, 12.0),
)
def test_inflation_costs_follow_formula_of_nav2(obstacles, radius, factor):
    cells, inscribed = inflated(*obstacles, inflation_radius=radius, cost_scaling_factor=factor)
    reach = np.ceil(radius / 0.1) * 0.1
    for row, column in np.ndindex(cells.shape):
        distance = 0.1 * min(hypot(row - obstacle[0], column - obstacle[1]) for obstacle in obstacles)
        if distance == 0.0:
            expected = LETHAL
        elif distance > reach + 1e-9:
            expected = FREE
        elif distance <= inscribed:
            expected = INSCRIBED
        else:
            expected = int(252 * exp(-factor * (distance - inscribed)))
        assert abs(int(cells[row, column]) - expected) <= (0 if expected in (FREE, LETHAL, INSCRIBED) else 1)


def test_partial_update_matches_full_update():
    layer = StaticLayer(Interpretation())
    scene = costmap(layer, InflationLayer(Inflation(inflation_radius=0.5)))
    grid = occupancy()
    grid.cells[5:9, 20] = 100
    layer.set_map(grid)
    scene.update(HERE, 0)
    eye = Eye(layers=[InflationLayer(Inflation(inflation_radius=0.5))])
    eye.see((2.55, 3.05), (1.05, 2.05))
    parts = eye.see((2.55, 3.05)).copy()
    eye.costmap.invalidate()
    assert np.array_equal(parts, eye.update())


def test_inflate_unknown_extends_inflation_into_unknown_cells():
    for inflate_unknown in (False, True):
        layer = StaticLayer(Interpretation(track_unknown_space=True))
        inflation = InflationLayer(Inflation(inflate_unknown=inflate_unknown, cost_scaling_factor=3.0))
        scene = costmap(layer, inflation, track_unknown=True)
        grid = occupancy()
        grid.cells[:] = -1
        grid.cells[20, 20] = 100
        layer.set_map(grid)
        scene.update(HERE, 0)
        cells = scene.costmap.grid.cells
        assert cells[20, 21] == INSCRIBED
        assert (cells[20, 24] == UNKNOWN) != inflate_unknown
        assert cells[0, 0] == UNKNOWN


# --- rays and points --------------------------------------------------------------------------------------------------


def test_obstacle_is_marked_and_cleared_by_passing_ray():
    eye = Eye()
    assert eye.see((2.55, 2.05))[20, 25] == LETHAL
    assert eye.see((2.95, 2.05))[20].tolist()[20:31] == [0] * 9 + [LETHAL, 0]


def test_rays_clear_only_cells_they_pass():
    eye = Eye()
    cells = eye.see((2.55, 2.05), (2.55, 2.55), (1.05, 1.05), (2.05, 3.05))
    marked = np.argwhere(cells == LETHAL).tolist()
    assert marked == [[10, 10], [20, 25], [25, 25], [30, 20]]
    eye.layer.layer_grid.cells[:] = LETHAL
    eye.see((2.55, 2.05))
    assert np.argwhere(eye.layer.layer_grid.cells != LETHAL).tolist() == [[20, column] for column in range(20, 25)]


def test_maximum_ranges_limit_marking_and_clearing():
    eye = Eye(obstacle_max_range=1.0, raytrace_max_range=0.5)
    eye.layer.layer_grid.cells[:] = LETHAL
    eye.costmap.invalidate()
    cells = eye.see((3.55, 2.05))
    assert np.flatnonzero(cells[20] == FREE).tolist() == [20, 21, 22, 23, 24, 25]
    eye = Eye(obstacle_max_range=1.0)
    assert not eye.see((3.55, 2.05)).any()


def test_minimum_ranges_limit_marking_and_clearing():
    eye = Eye(obstacle_min_range=0.3, raytrace_min_range=0.3)
    eye.layer.layer_grid.cells[20] = LETHAL
    cells = eye.see((2.25, 2.05), (3.05, 2.05))
    assert np.flatnonzero(cells[20, 20:] == FREE).tolist() == [3, 4, 5, 6, 7, 8, 9]


def test_points_outside_height_range_neither_mark_nor_clear():
    eye = Eye(max_obstacle_height=1.0)
    eye.layer.layer_grid.cells[20, 22] = LETHAL
    eye.costmap.invalidate()
    cells = eye.see((2.55, 2.05, 1.5), (np.nan, 2.05, 0.2))
    assert np.argwhere(cells).tolist() == [[20, 22]]


def test_ray_that_leaves_costmap_clears_up_to_its_edge():
    eye = Eye(raytrace_max_range=9.0)
    eye.layer.layer_grid.cells[20] = LETHAL
    cells = eye.see((9.0, 2.05))
    assert np.flatnonzero(cells[20] == FREE).tolist() == list(range(20, 40))


def test_observation_persistence_keeps_points():
    eye = Eye(observation_persistence=1.5, clearing=False)
    eye.see((2.55, 2.05))
    eye.see((3.05, 2.05))
    eye.layer.layer_grid.cells[:] = FREE
    assert eye.update()[20, [25, 30]].tolist() == [LETHAL, LETHAL]
    eye.layer.layer_grid.cells[:] = FREE
    eye.costmap.invalidate()
    assert eye.see()[20, [25, 30]].tolist() == [FREE, LETHAL]


def test_silent_sensor_makes_costmap_outdated():
    eye = Eye(expected_update_rate=1.0)
    assert not eye.costmap.is_current(0)
    eye.see((2.55, 2.05))
    assert eye.costmap.is_current(eye.time_ns + SECOND)
    assert not eye.costmap.is_current(eye.time_ns + 2 * SECOND)


def test_footprint_of_robot_is_cleared():
    buffer = ObservationBuffer(Source(max_obstacle_height=2.0))
    scene = costmap(ObstacleLayer([buffer], HeightRange()))
    buffer.add(np.array([2.05, 2.05, 0.3]), np.array([[2.15, 2.05, 0.3], [2.45, 2.05, 0.3]]), 0)
    scene.update(HERE, 0)
    assert np.argwhere(scene.costmap.grid.cells).tolist() == [[20, 24]]


# --- levels of height -------------------------------------------------------------------------------------------------


def test_voxel_layer_keeps_obstacle_below_ray():
    eye = Eye(VoxelLayer, Voxels())
    assert eye.see((2.55, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 25] == LETHAL
    assert eye.see((2.95, 2.05, 0.5), origin=(2.05, 2.05, 0.5))[20, 25] == LETHAL
    assert eye.see((2.95, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 25] == FREE


def test_descending_ray_clears_voxels_it_passes():
    eye = Eye(VoxelLayer, Voxels())
    eye.see((2.55, 2.05, 0.5), (2.85, 2.05, 0.5), origin=(2.05, 2.05, 0.5))
    cells = eye.see((3.05, 2.05, 0.2), origin=(2.05, 2.05, 0.8))
    assert cells[20, 25] == FREE  # passed at 0.5 m
    assert cells[20, 28] == LETHAL  # at 0.32 m


def test_voxel_columns_with_few_observations_are_unknown():
    eye = Eye(VoxelLayer, Voxels(unknown_threshold=8))
    eye.costmap = costmap(eye.layer, track_unknown=True)
    assert eye.see((2.55, 2.05, 0.1), origin=(2.05, 2.05, 0.1))[20, 22] == UNKNOWN
    assert eye.see((2.55, 2.05, 0.3), origin=(2.05, 2.05, 0.3))[20, 22] == FREE


# --- maps -------------------------------------------------------------------------------------------------------------


def test_map_values_become_costs():
    def costs(**parameters):
        return Interpretation(**parameters).table()[np.array([0, 50, 99, 100, -1], np.int8).astype(np.uint8)].tolist()

    assert costs() == [FREE, FREE, FREE, LETHAL, FREE]
    assert costs(track_unknown_space=True, lethal_threshold=50) == [FREE, LETHAL, LETHAL, LETHAL, UNKNOWN]
    assert costs(trinary=False) == [0, 127, 251, LETHAL, FREE]


def test_rotated_map_is_placed_in_costmap_frame():
    layer = StaticLayer(Interpretation(), pose=lambda: (0.0, 4.0, -np.pi / 2))
    scene = costmap(layer)
    grid = occupancy()
    grid.cells[0, 39] = 100  # x 3.95, y 0.05 in the map
    layer.set_map(grid)
    scene.update(HERE, 0)
    assert np.argwhere(scene.costmap.grid.cells).tolist() == [[39, 39]]


@given(x=st.integers(-50, 50), y=st.integers(-50, 50))
def test_map_with_offset_is_placed_in_costmap(x, y):
    layer = StaticLayer(Interpretation())
    scene = costmap(layer)
    grid = occupancy(20, 30)
    grid.cells[:] = np.where(np.random.default_rng(0).random((20, 30)) < 0.5, 100, 0)
    grid.x, grid.y = 0.1 * x, 0.1 * y
    layer.set_map(grid)
    scene.update(HERE, 0)
    rows, columns = np.mgrid[:40, :40]
    there = np.stack((rows - y, columns - x), axis=-1)
    inside = grid.contains(there)
    expected = np.zeros((40, 40), np.uint8)
    expected[inside] = np.where(grid.cells[there[inside][:, 0], there[inside][:, 1]] == 100, LETHAL, 0)
    assert np.array_equal(scene.costmap.grid.cells, expected)


def test_map_update_changes_part_of_static_layer():
    layer = StaticLayer(Interpretation())
    scene = costmap(layer)
    assert not layer.update_map(0, 0, np.array([[100]], np.int8))
    layer.set_map(occupancy())
    scene.update(HERE, 0)
    assert layer.update_map(3, 4, np.array([[100]], np.int8))
    assert not layer.update_map(39, 39, np.array([[100, 100]], np.int8))
    scene.update(HERE, 0)
    assert np.argwhere(scene.costmap.grid.cells).tolist() == [[3, 4]]


def test_costmap_without_map_is_not_current():
    layer = StaticLayer(Interpretation())
    scene = costmap(layer)
    scene.update(HERE, 0)
    assert not scene.is_current(0)
    layer.set_map(occupancy())
    scene.update(HERE, 0)
    assert scene.is_current(0)
    assert not scene.update(HERE, 0)


# --- ranges -----------------------------------------------------------------------------------------------------------


class Sonar:
    """A sensor that measures one distance, and a costmap."""

    def __init__(self, **settings) -> None:
        self.layer = RangeLayer(RangeSettings(**settings))
        self.costmap = costmap(self.layer)

    def measure(self, distance: float, *, free: bool = False, times: int = 5) -> np.ndarray:
        for _ in range(times):
            self.layer.add(RangeReading(1.05, 2.05, 0.0, distance, 0.5, free, SECOND))
        self.costmap.update(HERE, SECOND)
        return self.costmap.costmap.grid.cells


def test_repeated_sonar_readings_mark_and_clear_obstacle():
    sonar = Sonar()
    assert sonar.measure(1.0)[20, 20] == LETHAL
    assert not sonar.costmap.costmap.grid.cells[20, 10:18].any()
    cells = sonar.measure(2.0, times=12)
    assert cells[20, 20] == FREE
    assert cells[20, 30] == LETHAL


def test_sonar_marks_only_cells_in_its_cone():
    sonar = Sonar()
    marked = np.argwhere(sonar.measure(1.0) == LETHAL)
    angles = np.arctan2(marked[:, 0] - 20, marked[:, 1] - 10)
    assert np.abs(angles).max() <= 0.25 + 0.05
    assert (marked[:, 1] > 15).all()
    assert (sonar.layer.layer_grid.cells[:, :10] == 127).all()


def test_sonar_reading_without_echo_clears_cone():
    sonar = Sonar()
    sonar.measure(1.0)
    assert not (sonar.measure(2.0, free=True, times=1)[18:23, 15:28] == LETHAL).any()


def test_silent_sonar_makes_costmap_outdated():
    sonar = Sonar(no_readings_timeout=1.0)
    assert not sonar.costmap.is_current(SECOND)
    sonar.measure(1.0)
    assert sonar.costmap.is_current(2 * SECOND)
    assert not sonar.costmap.is_current(3 * SECOND)


def test_clearing_resets_sonar_likelihoods():
    sonar = Sonar()
    sonar.measure(1.0)
    sonar.costmap.clear_around(HERE, 9.0)
    sonar.costmap.update(HERE, SECOND)
    assert not sonar.costmap.costmap.grid.cells.any()
    assert (sonar.layer.layer_grid.cells == 127).all()


# --- specks -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("connectivity", "left"), [(8, 5), (4, 3)])
def test_denoise_layer_removes_small_groups(connectivity, left):
    layer = StaticLayer(Interpretation())
    scene = costmap(layer, DenoiseLayer(2, connectivity))
    grid = occupancy()
    grid.cells[10, 10] = 100
    grid.cells[[20, 21], [20, 21]] = 100
    grid.cells[30, 3:6] = 100
    layer.set_map(grid)
    scene.update(HERE, 0)
    assert np.count_nonzero(scene.costmap.grid.cells) == left


# --- windows that move, and clearing ----------------------------------------------------------------------------------


def test_rolling_window_keeps_observations():
    buffer = ObservationBuffer(Source(max_obstacle_height=2.0))
    layer = ObstacleLayer([buffer], HeightRange(), footprint_clearing=False)
    scene = costmap(layer, is_rolling=True, size=2.0)
    scene.update((0.0, 0.0, 0.0), 0)
    buffer.add(np.array([0.0, 0.0, 0.3]), np.array([[0.55, 0.25, 0.3]]), 0)
    scene.update((0.0, 0.0, 0.0), 0)
    assert scene.costmap.cost_at(np.array([0.55, 0.25])) == LETHAL
    buffer.add(np.array([0.0, 0.0, 0.3]), np.zeros((0, 3)), 0)
    scene.update((0.73, -0.31, 0.0), 0)
    grid = scene.costmap.grid
    assert scene.costmap.cost_at(np.array([0.55, 0.25])) == LETHAL
    assert np.count_nonzero(grid.cells) == 1
    assert abs(grid.x + 1.0 - 0.73) < 0.1 + 1e-9
    scene.update((9.0, 0.0, 0.0), 0)
    assert not scene.costmap.grid.cells.any()


def test_clear_around_clears_inside_or_outside_of_window():
    for kind, more in ((ObstacleLayer, ()), (VoxelLayer, (Voxels(),))):
        eye = Eye(kind, *more)
        eye.see((2.55, 2.05), (3.55, 2.05))
        eye.buffer.add(np.array([2.05, 2.05, 0.3]), np.zeros((0, 3)), 0)
        eye.costmap.clear_around(HERE, 1.4, clear_outside=True)
        assert np.argwhere(eye.update() == LETHAL).tolist() == [[20, 25]]
        eye.costmap.clear_around(HERE, 1.4)
        assert not (eye.update() == LETHAL).any()


def test_clearing_removes_observations_and_keeps_map():
    layer = StaticLayer(Interpretation())
    eye = Eye(layers=[])
    scene = LayeredCostmap(blank(), [layer, eye.layer], circle(RADIUS))
    grid = occupancy()
    grid.cells[3, 3] = 100
    layer.set_map(grid)
    eye.costmap = scene
    eye.see((2.55, 2.05))
    eye.buffer.add(np.array([2.05, 2.05, 0.3]), np.zeros((0, 3)), 0)
    scene.clear_entirely()
    assert not scene.is_current(0)
    assert np.argwhere(eye.update()).tolist() == [[3, 3]]
    assert scene.is_current(0)
