"""object_seeker: finds an object by its name, drives to it or follows it, and describes visible objects.

``vision/go_to`` and ``vision/follow`` take a name, optionally with a colour (``red ball``, 红色的球).
``vision/stop`` ends the search, and the outcome is published on ``/voice/response``.
``vision/describe`` lists the visible objects.
``vision/go_to``, ``vision/follow`` and ``vision/describe`` have variants ``en`` and ``zh`` (``vision/go_to/zh``) for
the language of the answer.
"""

from __future__ import annotations

from functools import partial
from math import atan2, hypot, inf
from typing import Any

import numpy as np

from linkwright.diagnostics.translation import ENGLISH, LANGUAGES
from linkwright.geometry.single import Transform, invert, rotate, rpy_from_quaternion
from linkwright.graph import SENSOR_DATA_QOS, EndpointInfo, Graph
from linkwright.graph.endpoints.commander import Commander, describe_lost_publisher
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting
from linkwright.nodes.settings import bad_value, log_unknown, positive
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.vision.nodes.nav2_trip import Nav2Trip
from linkwright.vision.nodes.seen_objects import SeenObject, SeenObjects
from linkwright.vision.places.seeking import Phase, Seeker, SeekSettings, View
from linkwright.vision.places.words import Answer, ObjectRequest, Sighting, answer, described, requested

_DEPTH = 10
_PERIOD = 0.05
_SAME_PLACE = 0.6
"""Metres between two images of one object whose id has changed."""
_SEEN_NOW_SECONDS = 1.0
_SILENT_LASER_SECONDS = 1.0


class ObjectSeeker(SingleNode):
    """The object_seeker node.

    Parameters: ``distance`` (from the robot's centre to the object's nearest side, m), ``max_linear_velocity`` (m/s),
    ``max_angular_velocity`` (rad/s), ``lost_time`` (s), ``obstacle_distance`` (m), ``blocked_time`` (s),
    ``robot_radius`` (m), ``base_frame``, ``fixed_frame``, ``use_nav2`` (use ``navigate_to_pose`` once the object is
    seen, if a server is available), ``language`` (en or zh; a request in Chinese is always answered in Chinese).

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "object_seeker"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with starting(node):
            self._declare()
            log_unknown(node)
        self._poses = FramePoses(node, "it is not known where the robot is:")
        self._seen = SeenObjects(node, self._poses, self._fixed)
        self._request: ObjectRequest | None = None
        self._answers_in = self._language
        self._target: SeenObject | None = None
        self._began_ns = 0
        self._scan: Any = None
        text = get_message("std_msgs/msg/String")
        self._trip = Nav2Trip(node, self._trip_ended) if self._by_nav2 else None
        self._velocity = VelocityTopic(node, "cmd_vel", frame_id=self._base)
        self._response = node.create_publisher(text, "/voice/response", _DEPTH)
        self._commander = Commander(self._commander_lost)
        node.create_subscription("std_msgs/msg/Empty", "vision/stop", lambda _: self._stop(), _DEPTH)
        node.create_subscription(get_message("sensor_msgs/msg/LaserScan"), "scan", self._feel, SENSOR_DATA_QOS)
        for name, language in (("", None), *((f"/{language}", language) for language in LANGUAGES)):
            for topic, follow in (("vision/go_to", False), ("vision/follow", True)):
                callback = self._commander.tracking_callback(partial(self._begin, language, follow))
                self._commander.watch(node.create_subscription(text, topic + name, callback, _DEPTH))
            answer_in = partial(self._describe, language or self._language)
            node.create_service("std_srvs/srv/Trigger", f"vision/describe{name}", answer_in)
        node.create_timer(_PERIOD, self._step)

    def close(self) -> None:
        """Stop the robot, and close the node."""
        if self._seeker.phase is not Phase.IDLE:
            self._velocity.stop()
        self._cancel_trip()
        super().close()

    def _declare(self) -> None:
        usual = SeekSettings()
        self._seeker = Seeker(
            SeekSettings(
                distance=self._positive("distance", usual.distance),
                speed=self._positive("max_linear_velocity", usual.speed),
                turn_speed=self._positive("max_angular_velocity", usual.turn_speed),
                lost_time=self._positive("lost_time", usual.lost_time),
                obstacle_distance=self._positive("obstacle_distance", usual.obstacle_distance),
                blocked_time=self._positive("blocked_time", usual.blocked_time),
            )
        )
        self._radius = self._positive("robot_radius", 0.22)
        self._base: str = self._node.declare_parameter("base_frame", "base_link").value
        self._fixed: str = self._node.declare_parameter("fixed_frame", "odom").value
        self._by_nav2: bool = self._node.declare_parameter("use_nav2", False).value
        self._language: str = self._node.declare_parameter("language", "en").value
        if self._language not in LANGUAGES:
            raise bad_value("language", self._language, self._node.get_name(), LANGUAGES)

    def _positive(self, name: str, usual: float) -> float:
        return positive(self._node, name, self._node.declare_parameter(name, usual).value)

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _begin(self, language: str | None, follow: bool, message: Any) -> None:
        """Seek the object that a message names, and answer in a language; None means the language of the message."""
        request = requested(message.data)
        if request is None:
            self._node.get_logger().warning(f"'{message.data}' names nothing to go to; say 'ball' or 'red ball'")
            return
        self._answers_in = language or (self._language if request.language == ENGLISH else request.language)
        if self._seeker.phase is Phase.IDLE:
            self._velocity.review()
        self._cancel_trip()
        self._request, self._target, self._began_ns = request, None, self._now_ns()
        self._seeker.begin(follow=follow)
        self._answer(Answer.LOOKING)

    def _stop(self) -> None:
        if self._seeker.phase is not Phase.IDLE:
            self._seeker.stop()
            self._cancel_trip()
            self._velocity.stop()
            self._answer(Answer.STOPPED)

    def _commander_lost(self, publisher: EndpointInfo) -> None:
        if self._seeker.phase is not Phase.IDLE:
            self._node.get_logger().warning(describe_lost_publisher(publisher))
            self._stop()

    def _feel(self, scan: Any) -> None:
        self._scan = scan

    def _describe(self, language: str, _request: Any, response: Any) -> Any:
        pose = self._poses.pose(self._fixed, self._base, 0)
        since = self._now_ns() - round(_SEEN_NOW_SECONDS * 1e9)
        if pose is None or self._seen.heard_ns is None or self._seen.heard_ns < since:
            objects = []
        else:
            objects = [
                Sighting(seen_object.name, seen_object.colour, *_within(pose, seen_object))
                for seen_object in self._seen.objects
            ]
        response.success, response.message = True, described(objects, language)
        self._node.get_logger().info(response.message)
        return response

    def _step(self) -> None:
        if self._seeker.phase is Phase.IDLE or (self._trip is not None and self._trip.is_under_way):
            return
        move = self._seeker.step(self._view())
        if move.event is not None:
            self._answer(move.event)
        if move.event is Answer.FOUND and self._begin_trip():
            self._velocity.stop()
            return
        self._velocity.publish((move.linear, 0.0, 0.0), (0.0, 0.0, move.angular))

    def _begin_trip(self) -> bool:
        """Drive to the found object by nav2, and return whether nav2 is configured and available."""
        trip, target = self._trip, self._target
        pose = self._poses.pose(self._fixed, self._base, 0)
        if trip is None or target is None or pose is None or self._seeker.follow or not trip.is_served:
            return False
        distance = self._seeker.settings.distance + target.radius
        trip.begin(self._fixed, (pose[0], pose[1]), (target.x, target.y), distance)
        return True

    def _trip_ended(self, reached: bool) -> None:
        self._seeker.stop()
        self._answer(Answer.ARRIVED if reached else Answer.BLOCKED)

    def _cancel_trip(self) -> None:
        if self._trip is not None:
            self._trip.cancel()

    def _view(self) -> View:
        now_ns = self._now_ns()
        heard_ns = max(self._seen.heard_ns or 0, self._began_ns)
        silence = (now_ns - heard_ns) / 1e9
        pose = self._poses.pose(self._fixed, self._base, 0)
        if pose is None:
            return View(now_ns / 1e9, 0.0, silence=inf)
        heading = rpy_from_quaternion(pose[3:])[2]
        self._target = self._chosen(pose) or self._target
        free = self._free(now_ns)
        if self._target is None:
            return View(now_ns / 1e9, heading, silence=silence, free=free)
        ahead, left = _within(pose, self._target)
        return View(
            now_ns / 1e9,
            heading,
            bearing=atan2(left, ahead),
            surface=hypot(ahead, left) - self._target.radius,
            seen_ago=(now_ns - self._target.seen_ns) / 1e9,
            silence=silence,
            free=free,
        )

    def _chosen(self, pose: Transform) -> SeenObject | None:
        """Return the seen object to drive to: the same as before, or else the nearest."""
        assert self._request is not None, "it is asked for while it seeks"
        fitting = [
            seen_object
            for seen_object in self._seen.objects
            if self._request.is_it(seen_object.name, seen_object.colour, seen_object.shape, seen_object.score)
        ]
        before = self._target
        if before is not None:
            same = [candidate for candidate in fitting if candidate.id and candidate.id == before.id]
            near = [
                candidate
                for candidate in fitting
                if hypot(candidate.x - before.x, candidate.y - before.y) < _SAME_PLACE
            ]
            if same or near or self._seeker.phase is Phase.GOING:
                fitting = same or near
        return min(fitting, key=lambda candidate: hypot(*_within(pose, candidate)), default=None)

    def _free(self, now_ns: int) -> float:
        """Return the distance in m from the robot's centre to the nearest point ahead; 0 if the laser is silent."""
        scan = self._scan
        if scan is None:
            return inf
        if now_ns - scan.header.stamp.nanoseconds > _SILENT_LASER_SECONDS * 1e9:
            return 0.0
        pose = self._poses.pose(self._base, scan.header.frame_id, 0)
        if pose is None:
            return inf
        ranges = np.asarray(scan.ranges, np.float64)
        angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
        known = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        yaw = angles[known] + rpy_from_quaternion(pose[3:])[2]
        x, y = pose[0] + ranges[known] * np.cos(yaw), pose[1] + ranges[known] * np.sin(yaw)
        return float(x[(x > 0) & (np.abs(y) < self._radius)].min(initial=inf))

    def _answer(self, event: Answer) -> None:
        if self._request is not None:
            self._speak(answer(event, self._request, self._answers_in))

    def _speak(self, text: str) -> None:
        self._node.get_logger().info(text)
        self._response.publish(get_message("std_msgs/msg/String")(data=text))


def _within(pose: Transform, seen_object: SeenObject) -> tuple[float, float]:
    """Return an object's distances ahead of the robot and to its left, metres."""
    x, y, _, *turn = invert(pose)
    ahead, left, _ = rotate((turn[0], turn[1], turn[2], turn[3]), (seen_object.x, seen_object.y, 0.0))
    return ahead + x, left + y
