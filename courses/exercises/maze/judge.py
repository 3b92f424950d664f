# SPDX-License-Identifier: Apache-2.0
"""The judge of "Find the way through a maze": a maze without loops, which differs from seed to seed."""

import math

from linkwright.learning.judging import Judge

COLUMNS, ROWS = 4, 4
CELL = 1.2  # m
SIDES = ((1, 0), (0, 1), (-1, 0), (0, -1))


class Maze(Judge):
    """The figure is the time since the start."""

    def arrange(self, scene):
        open_sides = self.carve()
        quarter = int(self.random.integers(0, 4))
        right, left = (self.tour(open_sides, quarter, side) for side in (-1, 1))
        # Where it takes a follower of the right wall as long as one of the left wall, so that no rule is lucky.
        self.exit = min(right, key=lambda cell: abs(right[cell] - COLUMNS * ROWS) + abs(left[cell] - COLUMNS * ROWS))
        number = 0
        for column in range(COLUMNS + 1):
            for row in range(ROWS + 1):
                x, y = column * CELL, row * CELL
                for (dx, dy), sides in (((1, 0), ((0, 0), (0, -1))), ((0, 1), ((0, 0), (-1, 0)))):
                    cells = [(column + c, row + r) for c, r in sides]
                    if column + dx > COLUMNS or row + dy > ROWS or frozenset(cells) in open_sides:
                        continue
                    number += 1
                    scene.add_wall(f"wall_{number}", (x, y), (x + dx * CELL, y + dy * CELL))
        scene.add_tile("exit", self.middle(self.exit), 0.8)
        scene.start = (*self.middle((0, 0)), quarter * math.pi / 2)

    def carve(self):
        """Return the open sides between cells."""
        visited, stack, open_sides = {(0, 0)}, [(0, 0)], set()
        while stack:
            column, row = stack[-1]
            neighbors = [(column + dx, row + dy) for dx, dy in SIDES]
            new = [(c, r) for c, r in neighbors if 0 <= c < COLUMNS and 0 <= r < ROWS and (c, r) not in visited]
            if not new:
                stack.pop()
                continue
            cell = new[int(self.random.integers(0, len(new)))]
            open_sides.add(frozenset([(column, row), cell]))
            visited.add(cell)
            stack.append(cell)
        return open_sides

    def tour(self, open_sides, quarter, side):
        """Return after how many steps a follower of the wall on one side comes to each cell."""
        cell, steps = (0, 0), {(0, 0): 0}
        for step in range(1, 2 * COLUMNS * ROWS):
            for turn in (side, 0, -side, 2):
                dx, dy = SIDES[(quarter + turn) % 4]
                following = (cell[0] + dx, cell[1] + dy)
                if frozenset([cell, following]) in open_sides:
                    cell, quarter = following, (quarter + turn) % 4
                    steps.setdefault(cell, step)
                    break
        return steps

    def middle(self, cell):
        """Return x and y of the middle of a cell."""
        return (cell[0] + 0.5) * CELL, (cell[1] + 0.5) * CELL

    def start(self):
        self.nearest = self.first = math.dist(self.pose()[:2], self.middle(self.exit))

    def update(self):
        self.figure = self.time
        distance = math.dist(self.pose()[:2], self.middle(self.exit))
        self.nearest = min(self.nearest, distance)
        self.progress = 1.0 - self.nearest / self.first
        if distance < 0.4:
            self.finish()
