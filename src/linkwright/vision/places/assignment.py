"""Minimum-cost assignment (Hungarian method)."""

from __future__ import annotations

import numpy as np

from linkwright.vision.places.camera import Floats


def assign(costs: Floats, max_cost: float) -> list[tuple[int, int]]:
    """Return the pairs of rows and columns with minimum total cost.

    No pair costs more than `max_cost`. An unpaired row costs `max_cost`, so that a good pair is never replaced by two
    bad ones.

    Args:
        costs: shape ``(rows, columns)``; infinite for forbidden pairs.
        max_cost: the maximum cost of a pair.

    Returns:
        The pairs, sorted by row.

    Source: the Hungarian method with shortest augmenting paths (Jonker and Volgenant, 1987).
    """
    rows, columns = costs.shape
    if not rows or not columns:
        return []
    # Add a dummy column for each row; a row assigned to it is left unpaired.
    padded = np.full((rows, columns + rows), max_cost, np.float64)
    padded[:, :columns] = np.where(costs <= max_cost, costs, 2.0 * abs(max_cost) * rows + 1e6)
    row_of_column = _assign_columns(padded)
    pairs = [(row, column) for column, row in enumerate(row_of_column[:columns]) if row >= 0]
    return sorted((row, column) for row, column in pairs if costs[row, column] <= max_cost)


def _assign_columns(costs: Floats) -> list[int]:
    """Return the row assigned to each column, or -1, at minimum total cost.

    There must not be more rows than columns.
    """
    rows, columns = costs.shape
    row_prices, column_prices = np.zeros(rows), np.zeros(columns)
    row_of_column = [-1] * columns
    for row in range(rows):
        shortest_costs = np.full(columns, np.inf)
        previous_column = np.full(columns, -1)
        is_visited = np.zeros(columns, dtype=bool)
        current_row, column, path_cost = row, -1, 0.0
        while True:
            costs_through = path_cost + costs[current_row] - row_prices[current_row] - column_prices
            is_shorter = ~is_visited & (costs_through < shortest_costs)
            shortest_costs[is_shorter] = costs_through[is_shorter]
            previous_column[is_shorter] = column
            column = int(np.argmin(np.where(is_visited, np.inf, shortest_costs)))
            path_cost = float(shortest_costs[column])
            is_visited[column] = True
            if row_of_column[column] < 0:
                break
            current_row = row_of_column[column]
        visited = np.flatnonzero(is_visited)
        row_prices[row] += path_cost
        for visited_column in visited:
            if row_of_column[visited_column] >= 0:
                row_prices[row_of_column[visited_column]] += path_cost - shortest_costs[visited_column]
            column_prices[visited_column] -= path_cost - shortest_costs[visited_column]
        while column >= 0:
            previous = int(previous_column[column])
            row_of_column[column] = row if previous < 0 else row_of_column[previous]
            column = previous
    return row_of_column
