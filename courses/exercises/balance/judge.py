# SPDX-License-Identifier: Apache-2.0
"""The judge of "Balance a pole": a pole on a cart, which is pushed from time to time, harder each time."""

import math

from linkwright.learning.judging import Judge

SLIDER, HINGE = "cart::slider", "cart::hinge"
FALLEN = math.radians(35.0)
RAIL_END = 2.0  # m
PUSH_PERIOD = 6.0  # s


class Balance(Judge):
    """The figure is the time for which the pole is upright and the cart on the rail."""

    def start(self):
        self.simulation.set_joint_position(HINGE, float(self.random.choice([-1, 1]) * self.random.uniform(0.08, 0.15)))
        self.pushes = [PUSH_PERIOD * number + self.random.uniform(-1.0, 1.0) for number in range(1, 9)]
        self.strength = 0.15  # rad/s

    def update(self):
        self.figure = self.time
        self.progress = self.time / self.exercise.time_limit
        position, _ = self.simulation.joint_state(SLIDER)
        angle, _ = self.simulation.joint_state(HINGE)
        if self.time < 0.2:
            return
        if abs(angle) > FALLEN:
            self.finish(en="the pole has fallen", zh="杆倒了")
        elif abs(position) > RAIL_END:
            self.finish(en="the cart has reached the end of the rail", zh="小车到了轨道的尽头")
        elif self.pushes and self.time > self.pushes[0]:
            self.pushes.pop(0)
            self.simulation.data.joint(HINGE).qvel[0] += self.random.choice([-1.0, 1.0]) * self.strength
            self.simulation.mark_moved()
            self.strength += 0.1

    def at_time_limit(self):
        self.finish()
