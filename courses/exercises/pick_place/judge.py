# SPDX-License-Identifier: Apache-2.0
"""The judge of "Pick and place by order": four blocks on a table, and two orders to place one of them."""

import math
from typing import NamedTuple

from linkwright.learning.judging import Judge
from linkwright.learning.judging.scene import BLUE, GREEN, RED, YELLOW
from linkwright.messages import String

TABLE, BLOCK, MASS = 0.3, 0.04, 0.06  # m, m, kg
COLORS = {"red": RED, "green": GREEN, "blue": BLUE, "yellow": YELLOW}
CHINESE = {"red": "红色", "green": "绿色", "blue": "蓝色", "yellow": "黄色"}
BLOCKS = (0.53, -0.27), (0.61, 0.27)  # m: where blocks lie at the start; farther away, the fingers hide them
PLACES = (0.53, -0.3), (0.64, 0.3)  # m: where they are ordered to
GAP = 0.11  # m between the middles of two blocks or places
TRIES = 100
TOLERANCE = 0.03  # m
WRONG_BLOCK_COST = 20.0
STEP, REST = 0.02, 0.4  # s


class Order(NamedTuple):
    """A color, and the place for the block of this color."""

    color: str
    place: tuple[float, float]


class PickPlace(Judge):
    """The figure is the number of blocks that lie where they were ordered to."""

    PUBLISHED = (("/order", "std_msgs/msg/String"),)

    def arrange(self, scene):
        places = None
        while places is None:
            places = self.choose_places()
        self.starts = dict(zip(COLORS, places, strict=False))
        for color, (x, y) in self.starts.items():
            yaw = self.random.uniform(-0.7, 0.7)
            size = (BLOCK, BLOCK, BLOCK)
            scene.add_box(color, (x, y, TABLE + BLOCK / 2), size, COLORS[color], yaw=yaw, mass=MASS)
        colors = self.random.permutation(list(COLORS))[:2]
        self.orders = [Order(str(color), place) for color, place in zip(colors, places[len(COLORS) :], strict=True)]

    def choose_places(self):
        """Return places for the blocks and for the orders, or None if the first ones leave no room for others."""
        chosen = []
        for corners in (*[BLOCKS] * len(COLORS), PLACES, PLACES):
            for _ in range(TRIES):
                place = tuple(round(float(value), 3) for value in self.random.uniform(*corners))
                if all(math.dist(place, other) > GAP for other in chosen):
                    chosen.append(place)
                    break
            else:
                return None
        return chosen

    def start(self):
        self.number = 0
        self.moved = set()
        self.rested = self.announced = 0.0
        self.lying = dict(self.starts)
        self.announce()

    def announce(self):
        """Publish the current order; this is repeated each second."""
        color, (x, y) = self.orders[self.number]
        self.publish("/order", String(data=f"{color} {x:.3f} {y:.3f}"))
        self.announced = self.time

    def touched_models(self, model=""):
        """Return what the robot touches, without the block that it has to take, and without those of earlier orders."""
        ordered = {order.color for order in self.orders[: self.number + 1]}
        return super().touched_models(model) - (set() if model else ordered)

    def update(self):
        if self.time - self.announced > 1.0:
            self.announce()
        self.look_at_others()
        color, place = self.orders[self.number]
        if self.height(color) < TABLE - BLOCK:
            self.figure, self.progress = float(self.number), self.number / len(self.orders)
            self.finish(en=f"the {color} block fell from the table", zh=f"{CHINESE[color]}积木从桌上掉了下去")
            return
        lies = abs(self.height(color) - TABLE - BLOCK / 2) < 0.005 and self.touched_models(color) <= {"table"}
        is_done = lies and math.dist(self.pose(color)[:2], place) < TOLERANCE
        self.rested = self.rested + STEP if is_done else 0.0
        if self.rested >= REST:
            self.lying[color] = self.pose(color)[:2]
            self.number, self.rested = self.number + 1, 0.0
            self.figure, self.progress = float(self.number), self.number / len(self.orders)
            if self.number == len(self.orders):
                self.finish()
            else:
                self.announce()

    def look_at_others(self):
        """Subtract points for each block that is moved without an order, once."""
        ordered = self.orders[self.number].color
        for color in COLORS:
            if color == ordered or color in self.moved:
                continue
            if math.dist(self.pose(color)[:2], self.lying[color]) > TOLERANCE:
                self.moved.add(color)
                self.penalize(
                    WRONG_BLOCK_COST,
                    en=f"the robot moved the {color} block, but the order was for the {ordered} one: "
                    f"-{WRONG_BLOCK_COST:g}",
                    zh=f"机器人移动了{CHINESE[color]}积木，而订单要的是{CHINESE[ordered]}积木：-{WRONG_BLOCK_COST:g}",
                )

    def at_time_limit(self):
        """Count the blocks that are placed, and tell where the block of the current order is."""
        color, (x, y) = self.orders[self.number]
        actual = self.pose(color)[:2]
        height = self.height(color) - TABLE - BLOCK / 2
        away = math.dist(actual, (x, y))
        if height > BLOCK / 2:
            en, zh = f"is still in the air, {height:.2f} m above the table", f"仍在空中，离桌面 {height:.2f} m"
        elif math.dist(actual, self.starts[color]) < TOLERANCE:
            en, zh = "is still where it was", "仍在原处"
        elif away < TOLERANCE:
            en, zh = "is at its place, but was not released", "在指定的位置，但夹爪没有松开"
        else:
            en, zh = f"lies {away:.2f} m from its place", f"离指定的位置还有 {away:.2f} m"
        self.finish(
            en=f"order {self.number + 1}, {color} to {x:g}, {y:g}: the block {en}",
            zh=f"订单 {self.number + 1}，{CHINESE[color]}放到 {x:g}, {y:g}：积木{zh}",
        )
