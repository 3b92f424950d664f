# SPDX-License-Identifier: Apache-2.0
"""The judge of "Avoid obstacles": from one end of a hall to the other, with other obstacles for each seed."""

from linkwright.learning.judging import Judge

LENGTH, WIDTH = 12.0, 4.0  # m
ROWS = (2.0, 3.8, 5.6, 7.4, 9.2)  # m: where the obstacles stand


class AvoidObstacles(Judge):
    """The figure is the time since the start."""

    def arrange(self, scene):
        half = WIDTH / 2
        scene.add_room([(-1.0, -half), (LENGTH, -half), (LENGTH, half), (-1.0, half)])
        for number, x in enumerate(ROWS, start=1):
            y = self.random.uniform(-1.0, 1.0)
            radius = self.random.uniform(0.25, 0.4)
            scene.add_cylinder(f"column_{number}", (x, y, 0.3), radius, 0.6)
            # A second one, where the gaps stay wider than a meter.
            side = -1.0 if y > 0.0 else 1.0
            size = self.random.uniform(0.2, 0.5)
            scene.add_box(f"box_{number}", (x + 0.3, side * (half - size / 2 - 0.05), 0.3), (0.4, size, 0.6))
        scene.start = (0.0, self.random.uniform(-0.8, 0.8), self.random.uniform(-0.3, 0.3))

    def update(self):
        x, _, _ = self.pose()
        self.figure = self.time
        self.progress = max(self.progress, min(x / (LENGTH - 1.0), 1.0))
        if x > LENGTH - 1.0:
            self.finish()
