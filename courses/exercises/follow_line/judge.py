# SPDX-License-Identifier: Apache-2.0
"""The judge of "Follow a line": a lap along a painted track, which differs from seed to seed."""

import numpy as np

from linkwright.learning.judging import Judge

POINTS = 160
WIDTH = 0.05  # m
REACHED = 0.30  # m: so near to a point of the track the robot counts as there
LOST = 0.60  # m from the track


class FollowLine(Judge):
    """The figure is the time since the start, and at the end that of the lap."""

    def arrange(self, scene):
        angles = np.linspace(0.0, 2.0 * np.pi, POINTS + 1)
        phases = self.random.uniform(-np.pi, np.pi, 2)
        radii = 1.8 + 0.35 * np.cos(2.0 * angles + phases[0]) + 0.12 * np.cos(3.0 * angles + phases[1])
        direction = self.random.choice([-1.0, 1.0])
        self.track = np.column_stack([radii * np.cos(angles), direction * radii * np.sin(angles)])
        scene.add_line("line", [tuple(point) for point in self.track], WIDTH)
        along = self.track[1] - self.track[0]
        yaw = float(np.arctan2(along[1], along[0]) + self.random.uniform(-0.15, 0.15))
        # The camera sees the floor half a meter ahead.
        x, y = self.track[0] + self.random.uniform(-0.03, 0.03, 2)
        scene.start = (float(x), float(y), yaw)

    def start(self):
        self.reached = 0

    def update(self):
        self.figure = self.time
        distances = np.hypot(*(self.track - self.pose()[:2]).T)
        if distances.min() > LOST:
            self.fail(en="the robot left the line", zh="机器人离开了线")
            return
        # Points count in their order, so that no short cut and no turning back helps.
        while self.reached < POINTS and distances[self.reached + 1] < REACHED:
            self.reached += 1
        self.progress = self.reached / POINTS
        if self.reached == POINTS:
            self.finish()
