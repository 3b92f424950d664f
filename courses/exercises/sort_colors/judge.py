# SPDX-License-Identifier: Apache-2.0
"""The judge of "Sort by color with an arm": six blocks on the floor, and a tile for each color."""

import math

from linkwright.learning.judging import Judge
from linkwright.learning.judging.scene import BLUE, GREEN, RED

UPPER_ARM, FOREARM = 0.35, 0.30  # m
BINS = {"red": (0.15, 0.45), "green": (-0.3, 0.4), "blue": (0.15, -0.45)}
COLORS = {"red": RED, "green": GREEN, "blue": BLUE}
BIN_RADIUS = 0.12  # m
REACH = 0.035  # m between the gripper and the middle of a block


class SortColors(Judge):
    """The figure is the number of blocks on the tiles of their colors, less those on other tiles."""

    TOPICS = (("/grip", "std_msgs/msg/Bool"),)

    def arrange(self, scene):
        for color, place in BINS.items():
            scene.add_tile(f"floor_{color}", place, 0.16, tuple(0.6 + 0.4 * value for value in COLORS[color]))
        self.blocks = {}
        for number, color in enumerate(self.random.permutation(["red", "green", "blue"] * 2), start=1):
            while True:
                place = self.random.uniform((0.25, -0.22), (0.5, 0.22))
                if all(math.dist(place, other) > 0.09 for other, _ in self.blocks.values()):
                    break
            self.blocks[f"block_{number}"] = (tuple(place), str(color))
            scene.add_block(f"block_{number}", place, 0.05, COLORS[str(color)])

    def start(self):
        self.held = None

    def gripper(self):
        """Return x and y of the gripper."""
        shoulder, elbow = (self.simulation.joint_state(f"arm::{joint}")[0] for joint in ("shoulder", "elbow"))
        x = UPPER_ARM * math.cos(shoulder) + FOREARM * math.cos(shoulder + elbow)
        return x, UPPER_ARM * math.sin(shoulder) + FOREARM * math.sin(shoulder + elbow)

    def update(self):
        if self.held is not None:
            self.move(self.held, self.gripper(), 0.1)
        right = wrong = 0
        for name, (place, color) in self.blocks.items():
            for other, middle in BINS.items():
                if name != self.held and math.dist(place, middle) < BIN_RADIUS:
                    right, wrong = right + (other == color), wrong + (other != color)
        self.figure = float(max(0, right - wrong))
        self.progress = self.figure / len(self.blocks)
        if right == len(self.blocks):
            self.finish()

    def move(self, name, place, height):
        """Put a block at a place."""
        self.blocks[name] = (place, self.blocks[name][1])
        self.simulation.set_model_pose(name, (*place, height, 0.0, 0.0, 0.0, 1.0))

    def on_message(self, topic, message):
        place = self.gripper()
        if message.data and self.held is None:
            name = min(self.blocks, key=lambda name: math.dist(place, self.blocks[name][0]))
            if math.dist(place, self.blocks[name][0]) < REACH:
                self.held = name
        elif not message.data and self.held is not None:
            self.move(self.held, place, 0.025)
            self.held = None

    def at_time_limit(self):
        self.finish()
