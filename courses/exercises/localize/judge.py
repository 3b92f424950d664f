# SPDX-License-Identifier: Apache-2.0
"""The judge of "Localize by Monte Carlo": a known house, an unknown start, and an estimate on /estimate."""

import math

from linkwright.learning.judging import Judge

WALLS = (
    *((0, 0, 6, 0), (6, 0, 6, 5), (6, 5, 0, 5), (0, 5, 0, 0)),
    *((2.5, 0, 2.5, 1.5), (2.5, 2.7, 2.5, 5), (4.0, 3.0, 6, 3.0)),
)
JUDGED_FROM = 45.0  # s
UNKNOWN = 3.0  # m: the error without an estimate


class Localize(Judge):
    """The figure is the mean distance between the estimate and the robot in the last 15 s."""

    TOPICS = (("/estimate", "geometry_msgs/msg/PoseStamped"),)

    def arrange(self, scene):
        for number, (x1, y1, x2, y2) in enumerate(WALLS, start=1):
            scene.add_wall(f"wall_{number}", (x1, y1), (x2, y2))
        # Starts in the rooms, not at walls.
        rooms = ((0.7, 0.7, 1.8, 4.3), (3.2, 0.7, 5.3, 2.3), (4.6, 3.6, 5.4, 4.4))
        x1, y1, x2, y2 = rooms[int(self.random.integers(0, len(rooms)))]
        scene.start = (self.random.uniform(x1, x2), self.random.uniform(y1, y2), self.random.uniform(-math.pi, math.pi))

    def start(self):
        self.estimate = None
        self.errors = []

    def update(self):
        error = UNKNOWN if self.estimate is None else min(UNKNOWN, math.dist(self.estimate, self.pose()[:2]))
        if self.time > JUDGED_FROM:
            self.errors.append(error)
        self.figure = sum(self.errors) / len(self.errors) if self.errors else error
        self.progress = 1.0 - self.figure / UNKNOWN

    def on_message(self, topic, message):
        self.estimate = message.pose.position.x, message.pose.position.y

    def at_time_limit(self):
        self.finish()
