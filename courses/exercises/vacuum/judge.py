# SPDX-License-Identifier: Apache-2.0
"""The judge of "Vacuum cleaner": the part of a room's floor that the robot has passed over."""

import numpy as np

from linkwright.learning.judging import Judge

CELL = 0.1  # m
REACH = 0.25  # m: the brush is a little wider than the robot
MARGIN = 0.15  # m beside walls and furniture that no brush reaches


class Vacuum(Judge):
    """The figure is the cleaned part of the floor, in percent, after the time limit."""

    def arrange(self, scene):
        length, width = self.random.uniform(4.4, 5.0), self.random.uniform(3.4, 4.0)
        scene.add_room([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)])
        # A cupboard stands against a wall.
        cupboard = self.random.uniform(0.6, 1.0)
        x = self.random.uniform(1.4, length - 1.4)
        scene.add_box("cupboard", (x, width - 0.25, 0.3), (cupboard, 0.5, 0.6))
        columns, rows = np.meshgrid(np.arange(CELL / 2, length, CELL), np.arange(CELL / 2, width, CELL))
        self.cells = np.column_stack([columns.ravel(), rows.ravel()])
        inner = (np.abs(self.cells - (length / 2, width / 2)) < (length / 2 - MARGIN, width / 2 - MARGIN)).all(axis=1)
        beside = np.abs(self.cells[:, 0] - x) > cupboard / 2 + MARGIN
        self.cells = self.cells[inner & (beside | (self.cells[:, 1] < width - 0.5 - MARGIN))]
        scene.start = (0.5, 0.5, self.random.uniform(-0.1, 0.1))

    def start(self):
        self.is_clean = np.zeros(len(self.cells), bool)
        self.columns, self.rows = np.ascontiguousarray(self.cells.T)

    def update(self):
        x, y, _ = self.pose()
        self.is_clean |= (self.columns - x) ** 2 + (self.rows - y) ** 2 < REACH**2
        self.progress = float(self.is_clean.mean())
        self.figure = 100.0 * self.progress
        if self.figure >= 99.0:
            self.finish()

    def at_time_limit(self):
        self.finish()
