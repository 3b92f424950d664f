# SPDX-License-Identifier: Apache-2.0
"""The judge of "Map a house": three rooms whose sizes and doors differ from seed to seed."""

import math

import numpy as np

from linkwright.learning.judging import Judge

OCCUPIED, FREE = 65, 35
NEAR = 0.2  # m between a wall and the occupied cell that shows it


class MapHouse(Judge):
    """The figure is how well the last map agrees with the house, in percent."""

    TOPICS = (("/map", "nav_msgs/msg/OccupancyGrid"),)

    def arrange(self, scene):
        length, width = self.random.uniform(5.5, 6.5), self.random.uniform(4.5, 5.5)
        across, along = self.random.uniform(2.6, 3.0), width / 2 + self.random.uniform(-0.2, 0.2)
        door_x, door_1, door_2 = across + 0.8, *self.random.uniform(0.9, 1.2, 2)
        corners = [(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)]
        walls = [(corner, corners[number - 3]) for number, corner in enumerate(corners)]
        # A wall across with two doors, and one along the right half with one.
        walls += [((across, 0), (across, door_1 - 0.6)), ((across, door_1 + 0.5), (across, width - door_2 - 0.5))]
        walls += [((across, width - door_2 + 0.6), (across, width)), ((door_x + 0.8, along), (length, along))]
        for number, (begin, end) in enumerate(walls, start=1):
            scene.add_wall(f"wall_{number}", begin, end)
        scene.start = (0.8, width / 2, self.random.uniform(-0.2, 0.2))
        self.pose_at_start = scene.start
        self.wall_points = np.array([point for wall in walls for point in along_wall(*wall)])
        rooms = np.stack(np.meshgrid(np.arange(0.3, length - 0.2, 0.2), np.arange(0.3, width - 0.2, 0.2)), -1)
        rooms = rooms.reshape(-1, 2)
        self.free_points = rooms[nearest(rooms, self.wall_points) > 0.2]

    def update(self):
        self.progress = self.figure / 100.0 * self.time / self.exercise.time_limit

    def on_message(self, topic, message):
        info = message.info
        cells = np.array(message.data).reshape(info.height, info.width)
        x, y, yaw = self.pose_at_start
        # The map begins where the robot began: with x ahead.
        turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
        origin = np.array([info.origin.position.x, info.origin.position.y])
        rows, columns = np.nonzero(cells >= OCCUPIED)
        occupied = (np.column_stack([columns, rows]) + 0.5) * info.resolution + origin
        occupied = occupied @ turn.T + (x, y)
        if not len(occupied):
            return
        seen = float((nearest(self.wall_points, occupied) < NEAR).mean())
        right = float((nearest(occupied, self.wall_points) < NEAR).mean())
        places = np.floor(((self.free_points - (x, y)) @ turn - origin) / info.resolution).astype(int)
        inside = ((places >= 0) & (places < (info.width, info.height))).all(axis=1)
        values = cells[places[inside, 1], places[inside, 0]]
        free = float(((values >= 0) & (values <= FREE)).sum() / len(places))
        self.figure = 100.0 * right * (seen + free) / 2

    def at_time_limit(self):
        self.finish()


def along_wall(begin, end):
    """Return points of a wall, a tenth of a meter apart."""
    count = max(2, round(math.dist(begin, end) / 0.1))
    return [tuple(np.array(begin) + (np.array(end) - begin) * part) for part in np.linspace(0.0, 1.0, count)]


def nearest(points, others):
    """Return the distance from each point to the nearest of other points."""
    (x, y), (other_x, other_y) = points.T, others.T
    return np.sqrt(((x[:, None] - other_x) ** 2 + (y[:, None] - other_y) ** 2).min(axis=1))
