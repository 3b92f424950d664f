# SPDX-License-Identifier: Apache-2.0
"""The judge of "Race two robots": two laps in a ring between walls, against the robot of another program."""

import math

from linkwright.learning.judging import Judge

INNER, OUTER = 1.6, 3.4  # m: the radii of the walls
MIDDLE = (INNER + OUTER) / 2
SIDES = 16
LAPS = 2
HEAD_START = 0.7  # rad
OWN, RIVAL = "mbot", "rival"


class Race(Judge):
    """The figure is the lead over the other robot along the middle of the track, when one of both arrives."""

    def arrange(self, scene):
        for name, radius in (("inner", INNER), ("outer", OUTER)):
            corners = [self.place(2 * math.pi * number / SIDES, radius) for number in range(SIDES + 1)]
            for number in range(SIDES):
                scene.add_wall(f"{name}_{number + 1}", corners[number], corners[number + 1])
        self.direction = float(self.random.choice([-1.0, 1.0]))
        scene.add_robot("rival.xacro", RIVAL, self.begin_at(HEAD_START))
        scene.start = self.begin_at(0.0)

    def begin_at(self, driven):
        """Return x, y and yaw of a robot on the middle of the track, after an angle."""
        angle = self.direction * driven
        yaw = angle + self.direction * math.pi / 2 + self.random.uniform(-0.2, 0.2)
        return (*self.place(angle, MIDDLE), yaw)

    def place(self, angle, radius):
        """Return x and y at an angle around the middle of the ring."""
        return radius * math.cos(angle), radius * math.sin(angle)

    def start(self):
        self.driven = {OWN: 0.0, RIVAL: HEAD_START}

    def touched_models(self, model=""):
        """Return the models that the robot touches, without a rival behind it, because the one behind has to brake."""
        is_ahead = math.remainder(self.driven[OWN] - self.driven[RIVAL], math.tau) > 0.0
        return super().touched_models(model) - ({RIVAL} if is_ahead else set())

    def update(self):
        for model, driven in self.driven.items():
            x, y, _ = self.pose(model)
            angle = self.direction * math.atan2(y, x)
            self.driven[model] = driven + math.remainder(angle - driven, math.tau)
        self.figure = MIDDLE * (self.driven[OWN] - self.driven[RIVAL])
        self.progress = max(0.0, min(1.0, self.driven[OWN] / (LAPS * math.tau)))
        if max(self.driven.values()) > LAPS * math.tau:
            if self.progress > 0.3:
                self.finish()
            else:
                self.fail(en="the other robot has arrived", zh="另一个机器人到达了终点")
