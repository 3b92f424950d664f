# SPDX-License-Identifier: Apache-2.0
"""The judge of "Follow a person": a person in red walks through a hall, and the robot shall stay behind."""

import math

from linkwright.learning.judging import Judge

HALF_WIDTH = 4.0  # m: of the hall
NEAREST, FARTHEST = 0.6, 1.6  # m between the middles of robot and person
FACING = math.radians(40.0)
SPEED = 0.35  # m/s
PERIOD = 0.02  # s


class FollowPerson(Judge):
    """The figure is the part of the time for which the robot is at the right distance and faces the person."""

    def arrange(self, scene):
        half = HALF_WIDTH
        scene.add_room([(-half, -half), (half, -half), (half, half), (-half, half)])
        self.places = [(-1.0, 0.0)]
        while len(self.places) < 20:
            place = tuple(self.random.uniform(-2.8, 2.8, 2))
            if math.dist(place, self.places[-1]) > 2.0:
                self.places.append(place)
        scene.add_person("person", self.places[0])
        scene.start = (-2.2, 0.0, self.random.uniform(-0.4, 0.4))

    def start(self):
        self.person = self.places.pop(0)
        self.heading = self.waited = 0.0
        self.updates = self.good = 0

    def update(self):
        self.walk()
        x, y, yaw = self.pose()
        distance = math.dist((x, y), self.person)
        direction = math.atan2(self.person[1] - y, self.person[0] - x)
        self.updates += 1
        self.good += NEAREST < distance < FARTHEST and abs(math.remainder(direction - yaw, math.tau)) < FACING
        self.figure = 100.0 * self.good / self.updates
        self.progress = self.time / self.exercise.time_limit * self.figure / 100.0

    def walk(self):
        """Move the person towards the next place, and to another one if the robot stands in its way for 2 s."""
        target = self.places[0]
        wanted = math.atan2(target[1] - self.person[1], target[0] - self.person[0])
        turn = math.remainder(wanted - self.heading, math.tau)
        self.heading += max(-1.5 * PERIOD, min(1.5 * PERIOD, turn))
        step = SPEED * PERIOD * max(0.0, math.cos(turn))
        ahead = (self.person[0] + step * math.cos(self.heading), self.person[1] + step * math.sin(self.heading))
        robot = self.pose()[:2]
        if math.dist(ahead, robot) > 0.55 or math.dist(ahead, robot) > math.dist(self.person, robot):
            self.person, self.waited = ahead, 0.0
            self.simulation.set_model_pose("person", (*ahead, 0.0, 0.0, 0.0, 0.0, 1.0))
        else:
            self.waited += PERIOD
        if math.dist(self.person, target) < 0.2 or self.waited > 2.0:
            self.places.append(self.places.pop(0))

    def at_time_limit(self):
        self.finish()
