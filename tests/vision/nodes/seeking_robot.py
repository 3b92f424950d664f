"""mbot in an empty world with red balls, and the nodes that find them.

All run in one thread and in lock-step.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.geometry.single import compose, invert
from linkwright.messages import Time, get_message
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedSimulation
from linkwright.vision.nodes.detect_3d_node import Detect3DNode
from linkwright.vision.nodes.object_seeker import ObjectSeeker
from linkwright.vision.nodes.tracking_node import TrackingNode
from linkwright.vision.places.camera import make_camera_model
from tests.places import GAZEBO_PACKAGE
from tests.vision.nodes.color_detector import ColorDetector, detection

if TYPE_CHECKING:
    from typing_extensions import Self

ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"
BALL_RADIUS_M = 0.15
_BALL = """<sdf version="1.6"><model name="ball"><link name="link">
  <inertial><mass>0.5</mass><inertia><ixx>0.0075</ixx><iyy>0.0075</iyy><izz>0.0075</izz></inertia></inertial>
  <collision name="ball"><geometry><sphere><radius>0.15</radius></sphere></geometry></collision>
  <visual name="ball"><geometry><sphere><radius>0.15</radius></sphere></geometry>
  <material><ambient>0.78 0.05 0.06 1</ambient><diffuse>0.78 0.05 0.06 1</diffuse></material></visual>
</link></model></sdf>"""
_SIMULATED = {"use_sim_time": True}
_FOCAL, _WIDTH, _HEIGHT = 381.36, 640, 480
_IMAGE_PERIOD_S = 0.1


class SeekingRobot(SteppedSimulation):
    """A simulation of mbot, a ball, and the nodes that find it.

    Args:
        folder: the folder for the model of the ball.
        ball: the position of the ball in meters.
        images: whether a camera renders the ball; without images, its boxes are computed, which is much faster.
        laser: whether mbot has a laser.
        seeker: the parameters of the seeker.
        object_name: the class of the ball in detections.
    """

    def __init__(
        self,
        folder: Path,
        ball: tuple[float, float],
        *,
        images: bool = False,
        laser: bool = False,
        seeker: dict[str, Any] | None = None,
        object_name: str = "ball",
    ) -> None:
        arguments = {"camera": True, "laser": laser}
        world = GAZEBO_PACKAGE / "worlds" / "empty.world"
        super().__init__(world, ROBOT, arguments=arguments, robot_state_publisher=True, period=0.02)
        self._model = folder / "ball.sdf"
        self._model.write_text(_BALL)
        self._ball, self._images, self._seeker = ball, images, seeker or {}
        self._object_name = object_name
        self._visible = True

    def __enter__(self) -> Self:
        super().__enter__()
        self.put_ball(*self._ball)
        frame_parameters = {"target_frame": "odom", "ground_frame": "base_footprint", **_SIMULATED}
        names = [("detections", "tracking"), ("camera_info", "/camera/camera_info")]
        TrackingNode(self.graph, NodeOptions(namespace="/yolo", parameters=_SIMULATED))
        Detect3DNode(self.graph, NodeOptions(namespace="/yolo", parameters=frame_parameters, remappings=names))
        self.seeker = ObjectSeeker(
            self.graph,
            NodeOptions(
                parameters={**_SIMULATED, **self._seeker},
                remappings=[
                    ("tracking", "/yolo/tracking"),
                    ("detections_3d", "/yolo/detections_3d"),
                    ("image_raw", "/camera/image_raw" if self._images else "/nothing"),
                ],
            ),
        )
        self.said_messages = self.record("/voice/response")
        self.commands = self.record("/cmd_vel")
        self.places = self.record("/yolo/detections_3d")
        if self._images:
            ColorDetector(self.graph)
        else:
            self.detector = self.node.create_timer(_IMAGE_PERIOD_S, self._detect)
            self._detections = self.node.create_publisher(
                get_message("vision_msgs/msg/Detection2DArray"), "/yolo/detections", 10
            )
            self._info = self.node.create_publisher(
                get_message("sensor_msgs/msg/CameraInfo"), "/camera/camera_info", 10
            )
            self._rng = np.random.default_rng(3)
        self.advance(0.5)
        return self

    def put_ball(self, x: float, y: float) -> None:
        """Put a ball into the world."""
        self.spawn(self._model, "ball", pose=(x, y, BALL_RADIUS_M, 0.0, 0.0, 0.0))

    def hide(self) -> None:
        """Stop the detections of the ball."""
        self._visible = False

    def tell(self, topic: str, text: str) -> None:
        """Publish a text."""
        self.publish(topic, get_message("std_msgs/msg/String")(data=text))

    def tell_to_stop(self) -> None:
        """Publish the message that ends all seeking."""
        self.publish("/vision/stop", get_message("std_msgs/msg/Empty")())

    def spoken(self) -> list[str]:
        """Return the robot's utterances."""
        return [said_message.data for said_message in self.said_messages]

    def advance_until_said(self, word: str, seconds: float = 60.0) -> bool:
        """Advance the time until the robot says a text that contains a word."""
        for _ in range(round(seconds / 0.5)):
            self.advance(0.5)
            if any(word in text for text in self.spoken()):
                return True
        return False

    def distance(self) -> float:
        """Return the distance between the centers of the robot and the ball in meters."""
        x, y, *_ = self.robot_pose()
        ball = self.simulation.model_pose("ball")
        return math.dist((x, y), ball[:2])

    def _detect(self) -> None:
        """Publish the box of the ball as a detector does, with an error of about a pixel."""
        header = get_message("std_msgs/msg/Header")(frame_id="camera_optical_frame")
        now_ns = self.simulation.time
        header.stamp = Time.from_nanoseconds(now_ns)
        info = get_message("sensor_msgs/msg/CameraInfo")(header=header, width=_WIDTH, height=_HEIGHT)
        info.k = [_FOCAL, 0.0, 319.5, 0.0, _FOCAL, 239.5, 0.0, 0.0, 1.0]
        self._info.publish(info)
        array = get_message("vision_msgs/msg/Detection2DArray")(header=header)
        x, y, z, *_ = compose(invert(compose(self.robot_pose(), _CAMERA_POSE)), self.simulation.model_pose("ball"))
        camera = make_camera_model(_WIDTH, _HEIGHT, info.k)
        if self._visible and x > BALL_RADIUS_M:
            corners = np.array(
                [[-y - BALL_RADIUS_M, -z - BALL_RADIUS_M, x], [-y + BALL_RADIUS_M, -z + BALL_RADIUS_M, x]]
            )
            pixels = camera.pixels_from_points(corners).ravel() + self._rng.normal(0, 0.7, 4)
            left, top, right, bottom = np.clip(pixels, 0, [_WIDTH, _HEIGHT] * 2)
            if right - left > 5 and bottom - top > 5:
                array.detections.append(detection(header, left, top, right, bottom, self._object_name))
        self._detections.publish(array)


_CAMERA_POSE = (0.17, 0.0, 0.21, 0.0, 0.0, 0.0, 1.0)
