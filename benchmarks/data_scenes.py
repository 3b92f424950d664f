"""Scenes with one display of data, with which viewers are measured.

Usage: ``python -m benchmarks.data_scenes NAME``, which publishes and shows a scene.

The program prints the page's address as `linkwright` does, and ends with Ctrl-C. The messages are created in advance,
so the cost of the process is the cost of sending them through the viewer.
"""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.robots import make_tree_robot
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS, TF_QOS, Graph
from linkwright.messages import String, TFMessage, TransformBatch, get_message
from linkwright.packages import PackageFinder
from linkwright.rviz import RvizConfig
from linkwright.viewer import Viewer

TOPIC = "/data"
FRAME = "link_0"
MESSAGE_COUNT = 8
"""The number of different messages that are sent in turn, so that each shows something new."""

_FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/{cls}
      Enabled: true
      Name: Data
      Topic: {{Value: {topic}}}
{others}
  Global Options: {{Fixed Frame: {frame}, Frame Rate: 30}}
  Views:
    Current: {{Class: rviz_default_plugins/Orbit, Distance: 12, Pitch: 0.6, Yaw: 0.8}}
"""
_ROBOT = """\
    - Class: rviz_default_plugins/RobotModel
      Description Topic: {Value: /robot_description}
      Enabled: true
      Name: RobotModel
    - Class: rviz_default_plugins/TF
      Enabled: true
      Name: TF
"""


@dataclass(frozen=True)
class Scene:
    """One display of data at a steady rate, beside a robot whose links all move.

    Attributes:
        display: the class of the display.
        messages: returns the messages that are published in turn.
        rate: the number of messages per second.
        links: the number of links of the robot; 0 for no robot.
        frame_rate: the number of transforms per second of each link.
    """

    display: str
    messages: Callable[[], list[Any]]
    rate: float
    links: int = 0
    frame_rate: float = 30.0

    @property
    def make_config(self) -> RvizConfig:
        """Return the .rviz file."""
        robot_display = _ROBOT if self.links else ""
        return RvizConfig.parse(_FILE.format(cls=self.display, topic=TOPIC, robot_display=robot_display, frame=FRAME))


def make_clouds(points: int = 100_000) -> list[Any]:
    """Return clouds like a lidar's: points of a wavy floor, each with an intensity."""
    chance = np.random.default_rng(1)
    messages = []
    for turn in range(MESSAGE_COUNT):
        array = np.zeros(points, dtype=[("x", "f4"), ("y", "f4"), ("z", "f4"), ("intensity", "f4")])
        array["x"], array["y"] = chance.uniform(-5, 5, points), chance.uniform(-5, 5, points)
        array["z"] = 0.3 * np.sin(array["x"] + turn) * np.cos(array["y"])
        array["intensity"] = array["z"]
        message = _make_message("sensor_msgs/msg/PointCloud2", height=1, width=points, point_step=16, is_dense=True)
        field = get_message("sensor_msgs/msg/PointField")
        message.fields = [
            field(name=name, offset=4 * at, datatype=field.FLOAT32, count=1)
            for at, name in enumerate(("x", "y", "z", "intensity"))
        ]
        message.row_step, message.data = 16 * points, array.tobytes()
        messages.append(message)
    return messages


def make_markers(count: int = 1000) -> list[Any]:
    """Return arrays of moving cubes."""
    marker, color = get_message("visualization_msgs/msg/Marker"), get_message("std_msgs/msg/ColorRGBA")
    messages = []
    for turn in range(MESSAGE_COUNT):
        array = get_message("visualization_msgs/msg/MarkerArray")()
        for number in range(count):
            cube = marker(ns="bench", id=number, type=marker.CUBE, color=color(r=1.0, g=number / count, b=0.2, a=1.0))
            cube.header.frame_id = FRAME
            cube.pose.position.x, cube.pose.position.y = number % 32 * 0.3 - 5, number // 32 * 0.3 - 5
            cube.pose.position.z = float(np.sin(number + turn))
            cube.pose.orientation.w = 1.0
            cube.scale.x = cube.scale.y = cube.scale.z = 0.1
            array.markers.append(cube)
        messages.append(array)
    return messages


def make_images(width: int = 640, height: int = 480) -> list[Any]:
    """Return images of a camera that pans over a textured wall."""
    chance = np.random.default_rng(2)
    rough = chance.uniform(0, 255, (height // 8, width // 8, 3))
    wall = np.kron(rough, np.ones((8, 8, 1))) + chance.normal(0, 6, (height, width, 3))
    pixels = np.clip(wall, 0, 255).astype(np.uint8)
    messages = []
    for turn in range(MESSAGE_COUNT):
        message = _make_message("sensor_msgs/msg/Image", width=width, height=height, encoding="rgb8", step=3 * width)
        message.data = np.roll(pixels, 8 * turn, axis=1).tobytes()
        messages.append(message)
    return messages


def make_scans(beams: int = 720) -> list[Any]:
    """Return scans of a slightly irregular round room."""
    angles = np.linspace(-np.pi, np.pi, beams, endpoint=False)
    messages = []
    for turn in range(MESSAGE_COUNT):
        message = _make_message("sensor_msgs/msg/LaserScan", angle_min=-np.pi, angle_max=np.pi, range_max=30.0)
        message.angle_increment = 2 * np.pi / beams
        message.ranges = (4 + np.sin(3 * angles + 0.2 * turn)).astype(np.float32).tolist()
        messages.append(message)
    return messages


SCENES = {
    "points": Scene("PointCloud2", make_clouds, rate=10),
    "markers": Scene("MarkerArray", make_markers, rate=10),
    "image": Scene("Image", make_images, rate=30),
    "scan": Scene("LaserScan", make_scans, rate=10, links=500),
}


def _make_message(name: str, **values: Any) -> Any:
    message = get_message(name)(**values)
    message.header.frame_id = FRAME
    return message


class FramePublisher:
    """Publishes a tree of moving frames, all in one message."""

    def __init__(self, graph: Graph, links: int) -> None:
        self._tf = graph.create_node("publisher").create_publisher(TFMessage, "/tf", TF_QOS)
        self._parents = tuple(f"link_{number // 2}" for number in range(1, links))
        self._children = tuple(f"link_{number}" for number in range(1, links))
        self._poses = np.tile([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (links - 1, 1))

    def publish(self, turn: int) -> None:
        """Publish the poses of the frames in a turn."""
        poses = self._poses.copy()
        poses[:, 2] = 0.01 * turn
        self._tf.publish(TFMessage(batch=TransformBatch(self._parents, self._children, time.time_ns(), poses)))


async def call_at_rate(rate: float, act: Callable[[int], object], seconds: float = float("inf")) -> None:
    """Call a function with 0, 1, 2, ... at a rate per second."""
    start, turn = time.perf_counter(), 0
    while turn < seconds * rate:
        act(turn)
        turn += 1
        await asyncio.sleep(max(0.0, start + turn / rate - time.perf_counter()))


async def show(scene: Scene) -> None:
    """Publish and show until Ctrl-C."""
    graph, library = Graph(on_log=lambda _: None), DescriptionLibrary()
    viewer = Viewer(graph, library=library, finder=PackageFinder(), config=scene.make_config, port=0)
    await viewer.start()
    node = graph.create_node("sensor")
    messages = scene.messages()
    publisher = node.create_publisher(type(messages[0]), TOPIC, 10)
    tasks = [call_at_rate(scene.rate, lambda turn: publisher.publish(messages[turn % len(messages)]))]
    if scene.links:
        node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(
            String(data=make_tree_robot(scene.links))
        )
        tasks.append(call_at_rate(scene.frame_rate, FramePublisher(graph, scene.links).publish))
    ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGINT, ended.set)
    running = [asyncio.ensure_future(task) for task in tasks]
    print(f"Viewer: {viewer.url}", flush=True)
    await ended.wait()
    for pending_task in running:
        pending_task.cancel()
    await asyncio.gather(*running, return_exceptions=True)
    await viewer.close()
    await graph.close()


if __name__ == "__main__":
    asyncio.run(show(SCENES[sys.argv[1]]))
