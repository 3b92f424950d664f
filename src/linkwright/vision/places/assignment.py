"""Minimum-cost assignment (Hungarian method)."""

from __future__ import annotations

import numpy as np

from linkwright.vision.places.camera import Floats


def assign(costs: Floats, most: float) -> list[tuple[int, int]]:
    """Return pairs of rows and columns of minimum total cost; no pair costs more than `most`.

    To stay alone costs as much as `most` does, so that a pair is never made at the price of two bad ones.

    Args:
        costs: shape ``(rows, columns)``; infinite for pairs that must not be.
        most: the cost of a pair that is only just made.

    Returns:
        The pairs, by rows.

    Source: the Hungarian method with shortest augmenting paths (Jonker and Volgenant, 1987).
    """
    rows, columns = costs.shape
    if not rows or not columns:
        return []
    # Add a dummy column for each row; a row assigned to it is left unpaired.
    padded = np.full((rows, columns + rows), most, np.float64)
    padded[:, :columns] = np.where(costs <= most, costs, 2.0 * abs(most) * rows + 1e6)
    owner = _owners(padded)
    pairs = [(row, column) for column, row in enumerate(owner[:columns]) if row >= 0]
    return sorted((row, column) for row, column in pairs if costs[row, column] <= most)


def _owners(costs: Floats) -> list[int]:
    """Return the row of each column in the minimum-cost assignment, -1 for none; rows must not exceed columns."""
    rows, columns = costs.shape
    row_prices, column_prices = np.zeros(rows), np.zeros(columns)
    owner = [-1] * columns
    for row in range(rows):
        shortest = np.full(columns, np.inf)
        before = np.full(columns, -1)
        done = np.zeros(columns, dtype=bool)
        current, column, reached = row, -1, 0.0
        while True:
            through = reached + costs[current] - row_prices[current] - column_prices
            better = ~done & (through < shortest)
            shortest[better] = through[better]
            before[better] = column
            column = int(np.argmin(np.where(done, np.inf, shortest)))
            reached = float(shortest[column])
            done[column] = True
            if owner[column] < 0:
                break
            current = owner[column]
        visited = np.flatnonzero(done)
        row_prices[row] += reached
        for each in visited:
            if owner[each] >= 0:
                row_prices[owner[each]] += reached - shortest[each]
            column_prices[each] -= reached - shortest[each]
        while column >= 0:
            previous = int(before[column])
            owner[column] = row if previous < 0 else owner[previous]
            column = previous
    return owner
