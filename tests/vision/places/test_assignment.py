"""The assignment of least cost."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from linkwright.vision.places.assignment import assign


def find_lowest_cost(costs, max_cost):
    """Return the cost of the best assignment by exhaustive search.

    An unassigned element costs `max_cost`.
    """
    rows, columns = costs.shape
    padded = np.full((rows, columns + rows), max_cost)
    padded[:, :columns] = np.where(costs <= max_cost, costs, np.inf)
    return min(padded[range(rows), order].sum() for order in permutations(range(columns + rows), rows))


@pytest.mark.parametrize("seed", range(40))
def test_assignment_has_minimum_cost(seed):
    numbers = np.random.default_rng(seed)
    costs = numbers.random(numbers.integers(1, 5, 2))
    costs[numbers.random(costs.shape) < 0.2] = np.inf
    pairs = assign(costs, 0.8)
    assert len({row for row, _ in pairs}) == len({column for _, column in pairs}) == len(pairs)
    assert all(costs[pair] <= 0.8 for pair in pairs)
    unassigned_count = len(costs) - len(pairs)
    assert sum(costs[pair] for pair in pairs) + 0.8 * unassigned_count == pytest.approx(find_lowest_cost(costs, 0.8))


def test_empty_or_impossible_assignment_is_empty():
    assert assign(np.zeros((0, 3)), 1.0) == []
    assert assign(np.zeros((3, 0)), 1.0) == []
    assert assign(np.full((2, 2), np.inf), 1.0) == []
