# SPDX-License-Identifier: Apache-2.0
"""The judge of "Park": a gap between two parked boxes at a kerb, whose place and length differ from seed to seed."""

import math

from linkwright.learning.judging import Judge
from linkwright.learning.judging.scene import BLUE, RED

KERB = -1.2  # m: the y of the wall on the right
DEPTH = 0.7  # m: of the parked boxes
STANDING = 0.02  # m/s


class Park(Judge):
    """The figure is the distance of the robot from the middle of the gap, once it stands there for two seconds."""

    def arrange(self, scene):
        begin = self.random.uniform(2.0, 3.0)
        gap = self.random.uniform(1.0, 1.3)
        y = KERB + DEPTH / 2 + 0.05
        for name, x, length, color in (("red_car", begin - 0.5, 1.0, RED), ("blue_car", begin + gap + 0.5, 1.0, BLUE)):
            scene.add_box(name, (x, y, 0.25), (length, DEPTH, 0.5), color)
        scene.add_wall("kerb", (-1.0, KERB), (6.0, KERB))
        scene.start = (0.0, self.random.uniform(-0.1, 0.1), self.random.uniform(-0.1, 0.1))
        self.spot = (begin + gap / 2, y)

    def start(self):
        self.last = self.pose()
        self.first = math.dist(self.last[:2], self.spot)
        self.standing_since = 0.0

    def update(self):
        pose = self.pose()
        self.figure = math.dist(pose[:2], self.spot)
        self.progress = max(0.0, 1.0 - self.figure / self.first)
        moved = math.dist(pose[:2], self.last[:2]) + abs(math.remainder(pose[2] - self.last[2], math.tau))
        if moved > STANDING * 0.02 or self.figure > 0.5:
            self.standing_since = self.time
        self.last = pose
        if self.time - self.standing_since > 2.0:
            angle = math.degrees(abs(math.remainder(pose[2], math.pi)))
            if angle > 15.0:
                self.penalize(
                    10.0,
                    en=f"the robot stands {angle:.0f} degrees aslant: -10",
                    zh=f"机器人斜了 {angle:.0f} 度：-10",
                )
            self.finish()
