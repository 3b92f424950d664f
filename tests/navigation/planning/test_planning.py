"""Planning: shortest paths, clearance, mazes, and the reasons of failures."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL, MAX_PASSABLE, UNKNOWN, Costmap
from linkwright.navigation.costmaps.inflation_layer import Inflation
from linkwright.navigation.grids.distances import distance_field
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.planning.planner import PlanError, Problem, Settings, plan, run_to_end
from linkwright.navigation.planning.potential import NEUTRAL_COST, compute_crossing_prices, compute_potential
from linkwright.navigation.planning.smoothing import Smoothing, smooth_path

RESOLUTION_M = 0.1


def make_costmap(cells) -> Costmap:
    return Costmap(Grid(cells=np.asarray(cells, np.uint8), resolution=RESOLUTION_M))


def costmap_of_text(*rows: str) -> Costmap:
    """Return a costmap of characters: # lethal, o inscribed, ? unknown.

    The last row is at y = 0.
    """
    costs = {"#": LETHAL, "o": INSCRIBED, "?": UNKNOWN, ".": 0}
    return make_costmap([[costs[character] for character in row] for row in reversed(rows)])


def inflated_costmap(obstacles) -> Costmap:
    distances = distance_field(obstacles, RESOLUTION_M)
    costs = Inflation(inflation_radius=0.6, cost_scaling_factor=3.0).compute_costs(distances, 0.2)
    return make_costmap(np.where(distances > 0.6, 0, costs))


def plan_path(robot: Costmap, start, goal, **settings) -> np.ndarray:
    return run_to_end(plan(robot, (*start, 0.0)[:3], (*goal, 0.0)[:3], Settings(**settings)))


def path_length(path: np.ndarray) -> float:
    return float(np.hypot(*np.diff(path[:, :2], axis=0).T).sum())


def highest_cost(robot: Costmap, path: np.ndarray) -> int:
    """Return the highest known cost on the straight lines between a path's points."""
    share = np.linspace(0.0, 1.0, 21)[:, None, None]
    costs = robot.cost_at(path[None, :-1, :2] * (1 - share) + path[None, 1:, :2] * share)
    return int(np.where(costs == UNKNOWN, 0, costs).max())


def dijkstra(crossing_cost: np.ndarray, source: tuple[int, int]) -> np.ndarray:
    """Return the costs of the cheapest paths from a cell.

    Paths follow rows, columns and diagonals that cut no corner of an obstacle.
    """
    rows, columns = crossing_cost.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    begins, ends, weights = [], [], []
    for row_step, column_step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        margin, step = max(0, -column_step), max(0, column_step)
        a = (slice(0, rows - row_step), slice(margin, columns - step))
        b = (slice(row_step, rows), slice(margin + column_step, columns - step + column_step))
        with np.errstate(invalid="ignore"):
            weight = hypot(row_step, column_step) * (crossing_cost[a] + crossing_cost[b]) / 2.0
        if row_step and column_step:  # a diagonal step must not cut a corner
            target_slice = (slice(0, rows - row_step), slice(margin + column_step, columns - step + column_step))
            below = (slice(row_step, rows), slice(margin, columns - step))
            weight = np.where(np.isfinite(crossing_cost[target_slice] + crossing_cost[below]), weight, np.inf)
        is_finite = np.isfinite(weight)
        begins.append(number[a][is_finite])
        ends.append(number[b][is_finite])
        weights.append(weight[is_finite])
    graph = load_scipy("sparse").coo_matrix(
        (np.concatenate(weights), (np.concatenate(begins), np.concatenate(ends))), shape=(number.size, number.size)
    )
    path_costs = load_scipy("sparse.csgraph").dijkstra(graph.tocsr(), directed=False, indices=number[source])
    return np.asarray(path_costs).reshape(rows, columns)


def make_rooms(seed: int, size: int = 60) -> np.ndarray:
    rng = np.random.default_rng(seed)
    obstacles = np.zeros((size, size), np.bool_)
    for _ in range(8):
        row, column = rng.integers(5, size - 15, 2)
        if rng.random() < 0.5:
            obstacles[row : row + 2, column : column + rng.integers(8, 25)] = True
        else:
            obstacles[row : row + rng.integers(8, 25), column : column + 2] = True
    obstacles[:5, :5] = obstacles[-5:, -5:] = False
    return obstacles


# --- potentials -------------------------------------------------------------------------------------------------------


def test_potential_in_open_space_is_distance():
    potential = run_to_end(compute_potential(np.full((81, 81), NEUTRAL_COST), (40, 40)))
    rows, columns = np.ogrid[:81, :81]
    truth = NEUTRAL_COST * np.hypot(rows - 40, columns - 40)
    is_far = truth > 20 * NEUTRAL_COST
    assert (potential[is_far] >= truth[is_far] - 1e-6).all()
    assert (potential[is_far] <= 1.05 * truth[is_far]).all()


@pytest.mark.parametrize("seed", range(12))
def test_potential_matches_dijkstra(seed):
    crossing_costs = compute_crossing_prices(inflated_costmap(make_rooms(seed)).grid.cells)
    potential, truth = run_to_end(compute_potential(crossing_costs, (2, 2))), dijkstra(crossing_costs, (2, 2))
    is_reached = np.isfinite(potential)
    assert np.array_equal(np.isfinite(truth), is_reached)
    is_far = is_reached & (truth > 10 * NEUTRAL_COST)
    between_middles = potential[is_far] - crossing_costs[is_far] / 2.0 - crossing_costs[2, 2] / 2.0
    assert (between_middles <= 1.15 * truth[is_far]).all()  # first order, with the largest error near the start
    assert (potential[is_far] >= 0.9 * truth[is_far]).all()  # not limited to eight directions


@settings(max_examples=20, deadline=None)
@given(obstacles=st.integers(0, 10_000).map(lambda seed: np.random.default_rng(seed).random((25, 25)) < 0.35))
def test_potential_reaches_exactly_connected_cells(obstacles):
    obstacles[12, 12] = False
    potential = run_to_end(compute_potential(np.where(obstacles, np.inf, NEUTRAL_COST), (12, 12)))
    groups, _ = load_scipy("ndimage").label(~obstacles)
    assert np.array_equal(np.isfinite(potential), groups == groups[12, 12])


@pytest.mark.parametrize("seed", range(6))
def test_heuristic_search_gives_same_cost(seed):
    crossing_costs = compute_crossing_prices(inflated_costmap(make_rooms(seed)).grid.cells)
    full_potential = run_to_end(compute_potential(crossing_costs, (2, 2)))
    for heuristic in (False, True):
        directed_potential = run_to_end(compute_potential(crossing_costs, (2, 2), (57, 57), heuristic=heuristic))
        assert directed_potential[57, 57] == pytest.approx(full_potential[57, 57], rel=1e-3)
        assert np.isfinite(directed_potential).sum() <= np.isfinite(full_potential).sum()


# --- plans ------------------------------------------------------------------------------------------------------------


def test_plan_in_open_space_is_straight():
    path = plan_path(make_costmap(np.zeros((80, 80))), (0.55, 0.55), (7.05, 4.75, 1.0))
    assert path[0, :2].tolist() == [0.55, 0.55]
    assert path[-1].tolist() == [7.05, 4.75, 1.0]
    assert path_length(path) == pytest.approx(hypot(6.5, 4.2), rel=0.01)
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max() < 2 * RESOLUTION_M


@pytest.mark.parametrize("seed", range(25))
def test_plans_avoid_obstacles_at_near_optimal_cost(seed):
    robot = inflated_costmap(make_rooms(seed))
    crossing_costs = compute_crossing_prices(robot.grid.cells)
    if not np.isfinite(crossing_costs[[2, 57], [2, 57]]).all():
        return
    truth = dijkstra(crossing_costs, (2, 2))[57, 57]
    try:
        path = plan_path(robot, (0.25, 0.25), (5.75, 5.75), tolerance=0.0)
    except PlanError:
        assert not np.isfinite(run_to_end(compute_potential(crossing_costs, (2, 2)))[57, 57])
        return
    assert highest_cost(robot, path) <= MAX_PASSABLE
    midpoints = (path[1:, :2] + path[:-1, :2]) / 2.0
    cells = robot.grid.cells_of(midpoints)
    steps = np.hypot(*np.diff(path[:, :2], axis=0).T) / RESOLUTION_M
    assert (crossing_costs[cells[:, 0], cells[:, 1]] * steps).sum() <= 1.06 * truth + 2 * NEUTRAL_COST


def test_plan_passes_through_maze():
    robot = costmap_of_text(
        "###########",
        "#.........#",
        "#.#######.#",
        "#.#.....#.#",
        "#.#.###.#.#",
        "#.#.#...#.#",
        "#.#.#####.#",
        "#.#.......#",
        "#.#########",
        "#.........#",
        "###########",
    )
    path = plan_path(robot, (0.95, 0.15), (0.55, 0.55))
    assert highest_cost(robot, path) == 0
    assert path[-1, :2].tolist() == [0.55, 0.55]
    assert path_length(path) > 2.5


def test_plan_does_not_pass_between_diagonal_corners():
    robot = costmap_of_text("...#..", "...#..", "...#..", "..#...", "..#...", "..#...")
    with pytest.raises(PlanError, match=r"Failed to create plan with tolerance of: 0\.000000"):
        plan_path(robot, (0.05, 0.05), (0.55, 0.55), tolerance=0.0)


def test_unknown_cells_are_crossed_only_if_allowed():
    robot = costmap_of_text("..??..", "..??..", "..??..")
    assert path_length(plan_path(robot, (0.05, 0.15), (0.55, 0.15))) == pytest.approx(0.5, rel=0.05)
    with pytest.raises(PlanError):
        plan_path(robot, (0.05, 0.15), (0.55, 0.15), allow_unknown=False, tolerance=0.0)


def test_known_cells_are_preferred_to_unknown_cells():
    robot = make_costmap(np.zeros((40, 40)))
    robot.grid.cells[5:35, 15:25] = UNKNOWN
    path = plan_path(robot, (0.55, 0.95), (3.55, 0.95))
    assert (robot.cost_at(path[:, :2]) != UNKNOWN).all()


@settings(max_examples=40, deadline=None)
@given(obstacles=st.integers(0, 10_000).map(lambda seed: np.random.default_rng(seed).random((25, 25)) < 0.3))
def test_plan_never_touches_obstacle(obstacles):
    obstacles[[1, 23], [1, 23]] = False
    robot = make_costmap(np.where(obstacles, LETHAL, 0))
    try:
        path = plan_path(robot, (0.11, 0.19), (2.39, 2.31), tolerance=0.0)
    except PlanError:
        return
    assert highest_cost(robot, path) == 0


# --- goals that cannot be reached -------------------------------------------------------------------------------------


def planning_failure(robot, start, goal, **settings) -> Problem:
    with pytest.raises(PlanError) as error:
        plan_path(robot, start, goal, **settings)
    return error.value.problem


def test_goal_near_wall_is_moved_within_tolerance():
    obstacles = np.zeros((40, 40), np.bool_)
    obstacles[:, 20] = True
    robot = inflated_costmap(obstacles)
    path = plan_path(robot, (0.55, 2.05), (1.85, 2.05))
    assert path[-1, 0] == pytest.approx(1.75)
    assert highest_cost(robot, path) <= MAX_PASSABLE
    assert planning_failure(robot, (0.55, 2.05), (1.85, 2.05), tolerance=0.0) is Problem.GOAL_OCCUPIED


def test_goal_inside_wall_is_rejected():
    obstacles = np.zeros((40, 40), np.bool_)
    obstacles[:, 18:23] = True
    robot = inflated_costmap(obstacles)
    robot.grid.cells[:, 19:22] = INSCRIBED  # sensors see only the outside of a wall
    assert planning_failure(robot, (0.55, 2.05), (1.85, 2.05)) is Problem.GOAL_OCCUPIED
    assert planning_failure(robot, (0.55, 2.05), (2.05, 2.05)) is Problem.GOAL_OCCUPIED


def test_goal_behind_wall_is_not_replaced_by_one_before_it():
    obstacles = np.zeros((40, 40), np.bool_)
    obstacles[:, 20] = True
    assert (
        planning_failure(inflated_costmap(obstacles), (0.55, 2.05), (2.35, 2.05), tolerance=1.0)
        is Problem.NO_VALID_PATH
    )


def test_start_and_goal_outside_map_are_rejected():
    robot = make_costmap(np.zeros((10, 10)))
    assert planning_failure(robot, (-0.1, 0.5), (0.5, 0.5)) is Problem.START_OUTSIDE_MAP
    assert planning_failure(robot, (0.5, 0.5), (0.5, 1.5)) is Problem.GOAL_OUTSIDE_MAP


def test_start_in_obstacle_is_rejected_and_start_near_it_is_left():
    obstacles = np.zeros((40, 40), np.bool_)
    obstacles[20] = True
    robot = inflated_costmap(obstacles)
    assert planning_failure(robot, (1.05, 2.05), (3.05, 3.55)) is Problem.START_OCCUPIED
    path = plan_path(robot, (1.05, 2.15), (3.05, 2.45))
    inscribed_points = path[robot.cost_at(path[:, :2]) == INSCRIBED]
    assert (inscribed_points[:, 0] < 1.3).all()
    assert path_length(path) < 3.0
    assert highest_cost(robot, path) <= INSCRIBED


# --- smoothing --------------------------------------------------------------------------------------------------------


def make_corner() -> np.ndarray:
    offsets = np.arange(0.05, 2.0, 0.05)
    return np.concatenate(
        (
            np.column_stack((offsets, np.full_like(offsets, 0.05))),
            np.column_stack((np.full_like(offsets, 2.0), offsets + 0.05)),
        )
    )


def total_bend(points: np.ndarray) -> float:
    segments = np.diff(points, axis=0)
    angles = np.diff(np.unwrap(np.arctan2(segments[:, 1], segments[:, 0])))
    return float(np.abs(angles).max())


def test_smoothing_rounds_corner_and_keeps_ends():
    smooth_poses, complete = smooth_path(make_corner(), Smoothing())
    assert complete
    assert total_bend(smooth_poses) < 0.5 * total_bend(make_corner())
    assert smooth_poses[[0, -1]] == pytest.approx(make_corner()[[0, -1]])


def test_smoothing_matches_relaxation():
    smooth_poses, _ = smooth_path(make_corner(), Smoothing(do_refinement=False))
    reference, original = make_corner(), make_corner()
    for _ in range(500):
        neighbor_sum = reference[:-2] + reference[2:]
        reference[1:-1] += 0.2 * (original[1:-1] - reference[1:-1]) + 0.3 * (neighbor_sum - 2.0 * reference[1:-1])
    assert smooth_poses == pytest.approx(reference, abs=1e-9)


def test_smoothing_avoids_obstacles():
    robot = make_costmap(np.zeros((25, 25)))
    robot.grid.cells[1:10, 10:20] = LETHAL  # inside of the corner
    smooth_poses, complete = smooth_path(make_corner(), Smoothing(), robot)
    assert not complete
    assert (robot.cost_at(smooth_poses) == 0).all()


def test_smoothing_keeps_cusps():
    way_out = np.column_stack((np.arange(0.0, 1.0, 0.1), np.zeros(10)))
    way_back = np.column_stack((np.arange(0.8, 0.0, -0.1), np.linspace(0.02, 0.3, 8)))
    points = np.concatenate((way_out, way_back))
    smooth_poses, _ = smooth_path(points, Smoothing())
    assert smooth_poses[9] == pytest.approx(points[9])
    without_inversion, _ = smooth_path(points, Smoothing(enforce_path_inversion=False))
    assert without_inversion[9] != pytest.approx(points[9])
