# SPDX-License-Identifier: Apache-2.0
"""The judge of "Race two robots": two laps in a ring between walls, against a robot that weaves."""

import math

from linkwright.learning.judging import Judge
from linkwright.learning.judging.scene import BLUE

INNER, OUTER = 1.6, 3.4  # m: the radii of the walls
MIDDLE = (INNER + OUTER) / 2
SIDES = 16
LAPS = 2
SPEED = 0.36  # m/s
HEAD_START = 0.7  # rad
PERIOD = 0.02  # s


class Race(Judge):
    """The figure is the lead over the other robot along the middle of the track, when one of both arrives."""

    def arrange(self, scene):
        for name, radius in (("inner", INNER), ("outer", OUTER)):
            corners = [self.place(2 * math.pi * number / SIDES, radius) for number in range(SIDES + 1)]
            for number in range(SIDES):
                scene.add_wall(f"{name}_{number + 1}", corners[number], corners[number + 1])
        self.direction = float(self.random.choice([-1.0, 1.0]))
        self.phase = self.random.uniform(0.0, 2 * math.pi)
        scene.add_person("rival", self.rival_place(HEAD_START), BLUE)
        scene.start = (*self.place(0.0, MIDDLE), self.direction * math.pi / 2 + self.random.uniform(-0.2, 0.2))

    def place(self, angle, radius):
        """Return x and y at an angle around the middle of the ring."""
        return radius * math.cos(angle), radius * math.sin(angle)

    def rival_place(self, driven):
        """Return where the rival is after an angle."""
        return self.place(self.direction * driven, MIDDLE + 0.45 * math.sin(2.0 * driven + self.phase))

    def start(self):
        self.driven, self.rival = 0.0, HEAD_START
        self.angle = 0.0

    def update(self):
        x, y, _ = self.pose()
        angle = self.direction * math.atan2(y, x)
        self.driven += math.remainder(angle - self.angle, math.tau)
        self.angle = angle
        ahead = self.rival_place(self.rival + SPEED * PERIOD / MIDDLE)
        # The rival brakes for a robot in its way, as a good driver does.
        if math.dist(ahead, (x, y)) > 0.55 or self.driven < self.rival:
            self.rival += SPEED * PERIOD / MIDDLE
            self.simulation.set_model_pose("rival", (*ahead, 0.0, 0.0, 0.0, 0.0, 1.0))
        self.figure = MIDDLE * (self.driven - self.rival)
        self.progress = max(0.0, min(1.0, self.driven / (LAPS * math.tau)))
        if max(self.driven, self.rival) > LAPS * math.tau:
            if self.progress > 0.3:
                self.finish()
            else:
                self.fail(en="the other robot has arrived", zh="另一个机器人到达了终点")
