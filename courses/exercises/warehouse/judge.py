# SPDX-License-Identifier: Apache-2.0
"""The judge of "Warehouse with a shelf": a shelf that the robot lifts from below, carries to a tile, and sets down."""

import math

from linkwright.learning.judging import Judge
from linkwright.learning.judging.scene import YELLOW

GOAL = (7.0, 2.5)
HALF_SHELF = 0.4  # m from the middle of the shelf to a leg
REACH = 0.12  # m between the middles of robot and shelf
TOLERANCE = 0.3  # m from the middle of the tile


class Warehouse(Judge):
    """The figure is the time until the shelf stands on the tile."""

    TOPICS = (("/lift", "std_msgs/msg/Bool"),)

    def arrange(self, scene):
        scene.add_room([(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)])
        scene.add_tile("tile", GOAL, 2 * TOLERANCE)
        self.shelf = (self.random.uniform(2.8, 3.8), self.random.uniform(1.6, 3.4))
        self.shelf_yaw = self.random.uniform(-0.5, 0.5)
        scene.add_table("shelf", self.shelf, self.shelf_yaw, HALF_SHELF, YELLOW)
        scene.start = (0.8, 2.5, 0.0)

    def start(self):
        self.is_lifted = False
        self.first = math.dist(self.shelf, GOAL)
        self.offset = (0.0, 0.0, 0.0)

    def update(self):
        self.figure = self.time
        if self.is_lifted:
            x, y, yaw = self.pose()
            ahead, aside, turn = self.offset
            cos, sin = math.cos(yaw), math.sin(yaw)
            self.shelf = (x + ahead * cos - aside * sin, y + ahead * sin + aside * cos)
            self.shelf_yaw = yaw + turn
            half = self.shelf_yaw / 2
            self.simulation.set_model_pose("shelf", (*self.shelf, 0.05, 0.0, 0.0, math.sin(half), math.cos(half)))
        self.progress = max(0.0, min(1.0, 1.0 - math.dist(self.shelf, GOAL) / self.first))
        if not self.is_lifted and math.dist(self.shelf, GOAL) < TOLERANCE:
            self.finish()

    def on_message(self, topic, message):
        x, y, yaw = self.pose()
        if message.data and not self.is_lifted:
            dx, dy = self.shelf[0] - x, self.shelf[1] - y
            if math.hypot(dx, dy) > REACH:
                self.note(
                    en=f"the shelf is {math.hypot(dx, dy):.2f} m from the robot, and not lifted",
                    zh=f"货架离机器人 {math.hypot(dx, dy):.2f} m，没有抬起",
                )
                return
            cos, sin = math.cos(yaw), math.sin(yaw)
            self.offset = (dx * cos + dy * sin, dy * cos - dx * sin, self.shelf_yaw - yaw)
        self.is_lifted = bool(message.data)
