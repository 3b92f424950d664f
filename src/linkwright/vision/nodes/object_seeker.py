"""object_seeker: finds an object by name, drives to it or follows it, and lists objects.

``vision/go_to`` and ``vision/follow`` receive a name, optionally with a color (``red ball``, 红色的球).
``vision/stop`` ends the search. The outcome is published on ``/voice/response``.
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
from linkwright.graph.endpoints.command_guard import CommandGuard, describe_lost_publisher
from linkwright.messages import get_message
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, invalid_value_error, log_unknown_parameters
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.vision.nodes.nav2_trip import Nav2Trip
from linkwright.vision.nodes.seen_objects import SeenObject, SeenObjects
from linkwright.vision.places.object_requests import (
    Answer,
    ObjectRequest,
    Sighting,
    describe_sightings,
    make_answer_phrase,
    parse_request,
)
from linkwright.vision.places.seeker import Observation, Phase, Seeker, SeekSettings

_QUEUE_DEPTH = 10
_STEP_S = 0.05
_MAX_SAME_OBJECT_DISTANCE_M = 0.6
"""The maximum distance in m at which a detection with a new ID is still the same object."""
_MAX_DETECTION_AGE_S = 1.0
_MAX_SCAN_AGE_S = 1.0


class ObjectSeeker(SingleNode):
    """The object_seeker node.

    Parameters: ``distance`` (from the robot's center to the object's nearest side, m), ``max_linear_velocity`` (m/s),
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
        with handle_start_errors(node):
            self._declare()
            log_unknown_parameters(node)
        self._poses = FramePoses(node, "the position of the robot is unknown:")
        self._seen_objects = SeenObjects(node, self._poses, self._fixed)
        self._request: ObjectRequest | None = None
        self._answer_language = self._language
        self._target: SeenObject | None = None
        self._start_ns = 0
        self._scan: Any = None
        text = get_message("std_msgs/msg/String")
        self._trip = Nav2Trip(node, self._on_trip_end) if self._uses_nav2 else None
        self._velocity = VelocityTopic(node, "cmd_vel", frame_id=self._base)
        self._response = node.create_publisher(text, "/voice/response", _QUEUE_DEPTH)
        self._command_guard = CommandGuard(self._on_commander_lost)
        node.create_subscription("std_msgs/msg/Empty", "vision/stop", lambda _: self._stop(), _QUEUE_DEPTH)
        node.create_subscription(get_message("sensor_msgs/msg/LaserScan"), "scan", self._receive_scan, SENSOR_DATA_QOS)
        for name, language in (("", None), *((f"/{language}", language) for language in LANGUAGES)):
            for topic, follow in (("vision/go_to", False), ("vision/follow", True)):
                callback = self._command_guard.tracking_callback(partial(self._begin, language, follow))
                self._command_guard.watch(node.create_subscription(text, topic + name, callback, _QUEUE_DEPTH))
            describe_in_language = partial(self._describe, language or self._language)
            node.create_service("std_srvs/srv/Trigger", f"vision/describe{name}", describe_in_language)
        node.create_timer(_STEP_S, self._step)

    def close(self) -> None:
        """Stop the robot, and close the node."""
        if self._seeker.phase is not Phase.IDLE:
            self._velocity.stop()
        self._cancel_trip()
        super().close()

    def _declare(self) -> None:
        defaults = SeekSettings()
        self._seeker = Seeker(
            SeekSettings(
                distance=self._declare_positive("distance", defaults.distance),
                speed=self._declare_positive("max_linear_velocity", defaults.speed),
                turn_speed=self._declare_positive("max_angular_velocity", defaults.turn_speed),
                lost_timeout=self._declare_positive("lost_time", defaults.lost_timeout),
                obstacle_distance=self._declare_positive("obstacle_distance", defaults.obstacle_distance),
                blocked_timeout=self._declare_positive("blocked_time", defaults.blocked_timeout),
            )
        )
        self._robot_radius = self._declare_positive("robot_radius", 0.22)
        self._base: str = self._node.declare_parameter("base_frame", "base_link").value
        self._fixed: str = self._node.declare_parameter("fixed_frame", "odom").value
        self._uses_nav2: bool = self._node.declare_parameter("use_nav2", False).value
        self._language: str = self._node.declare_parameter("language", "en").value
        if self._language not in LANGUAGES:
            raise invalid_value_error("language", self._language, self._node.get_name(), LANGUAGES)

    def _declare_positive(self, name: str, default: float) -> float:
        return check_positive(self._node, name, self._node.declare_parameter(name, default).value)

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _begin(self, language: str | None, follow: bool, message: Any) -> None:
        """Seek the object that a message names.

        If `language` is None, answer in the language of the message.
        """
        request = parse_request(message.data)
        if request is None:
            self._node.get_logger().warning(f"'{message.data}' does not name an object; say 'ball' or 'red ball'")
            return
        self._answer_language = language or (self._language if request.language == ENGLISH else request.language)
        if self._seeker.phase is Phase.IDLE:
            self._velocity.update_type()
        self._cancel_trip()
        self._request, self._target, self._start_ns = request, None, self._now_ns()
        self._seeker.begin(follow=follow)
        self._answer(Answer.SEARCHING)

    def _stop(self) -> None:
        if self._seeker.phase is not Phase.IDLE:
            self._seeker.stop()
            self._cancel_trip()
            self._velocity.stop()
            self._answer(Answer.STOPPED)

    def _on_commander_lost(self, publisher: EndpointInfo) -> None:
        if self._seeker.phase is not Phase.IDLE:
            self._node.get_logger().warning(describe_lost_publisher(publisher))
            self._stop()

    def _receive_scan(self, scan: Any) -> None:
        self._scan = scan

    def _describe(self, language: str, _request: Any, response: Any) -> Any:
        pose = self._poses.pose(self._fixed, self._base, 0)
        oldest_ns = self._now_ns() - round(_MAX_DETECTION_AGE_S * 1e9)
        if (
            pose is None
            or self._seen_objects.last_detections_ns is None
            or self._seen_objects.last_detections_ns < oldest_ns
        ):
            objects = []
        else:
            objects = [
                Sighting(seen_object.name, seen_object.color, *_to_robot_frame(pose, seen_object))
                for seen_object in self._seen_objects.objects
            ]
        response.success, response.message = True, describe_sightings(objects, language)
        self._node.get_logger().info(response.message)
        return response

    def _step(self) -> None:
        if self._seeker.phase is Phase.IDLE or (self._trip is not None and self._trip.is_under_way):
            return
        command = self._seeker.step(self._make_observation())
        if command.event is not None:
            self._answer(command.event)
        if command.event is Answer.FOUND and self._begin_trip():
            self._velocity.stop()
            return
        self._velocity.publish((command.linear, 0.0, 0.0), (0.0, 0.0, command.angular))

    def _begin_trip(self) -> bool:
        """Send nav2 to the found object, or return False if nav2 is not configured or available."""
        trip, target = self._trip, self._target
        pose = self._poses.pose(self._fixed, self._base, 0)
        if trip is None or target is None or pose is None or self._seeker.follows_object or not trip.is_served:
            return False
        distance = self._seeker.settings.distance + target.radius
        trip.begin(self._fixed, (pose[0], pose[1]), (target.x, target.y), distance)
        return True

    def _on_trip_end(self, is_reached: bool) -> None:
        self._seeker.stop()
        self._answer(Answer.ARRIVED if is_reached else Answer.BLOCKED)

    def _cancel_trip(self) -> None:
        if self._trip is not None:
            self._trip.cancel()

    def _make_observation(self) -> Observation:
        now_ns = self._now_ns()
        last_ns = max(self._seen_objects.last_detections_ns or 0, self._start_ns)
        time_since_detections = (now_ns - last_ns) / 1e9
        pose = self._poses.pose(self._fixed, self._base, 0)
        if pose is None:
            return Observation(now_ns / 1e9, 0.0, time_since_detections=inf)
        heading = rpy_from_quaternion(pose[3:])[2]
        self._target = self._choose_object(pose) or self._target
        free_distance = self._find_free_distance(now_ns)
        if self._target is None:
            return Observation(
                now_ns / 1e9, heading, time_since_detections=time_since_detections, free_distance=free_distance
            )
        ahead, left = _to_robot_frame(pose, self._target)
        return Observation(
            now_ns / 1e9,
            heading,
            bearing=atan2(left, ahead),
            surface_distance=hypot(ahead, left) - self._target.radius,
            age=(now_ns - self._target.seen_ns) / 1e9,
            time_since_detections=time_since_detections,
            free_distance=free_distance,
        )

    def _choose_object(self, pose: Transform) -> SeenObject | None:
        """Return the object to drive to, or None.

        The previous target has priority. Until the robot drives to it, the nearest matching object can replace it.
        """
        assert self._request is not None, "there is a request while the robot seeks"
        candidates = [
            seen_object
            for seen_object in self._seen_objects.objects
            if self._request.matches(seen_object.name, seen_object.color, seen_object.aspect_ratio, seen_object.score)
        ]
        previous = self._target
        if previous is not None:
            same_id = [candidate for candidate in candidates if candidate.id and candidate.id == previous.id]
            nearby = [
                candidate
                for candidate in candidates
                if hypot(candidate.x - previous.x, candidate.y - previous.y) < _MAX_SAME_OBJECT_DISTANCE_M
            ]
            if same_id or nearby or self._seeker.phase is Phase.APPROACHING:
                candidates = same_id or nearby
        return min(candidates, key=lambda candidate: hypot(*_to_robot_frame(pose, candidate)), default=None)

    def _find_free_distance(self, now_ns: int) -> float:
        """Return the distance in m to the nearest point ahead, or 0 if scans have stopped.

        The distance is measured from the robot's center. It is infinite before the first scan, or if the pose is
        unknown.
        """
        scan = self._scan
        if scan is None:
            return inf
        if now_ns - scan.header.stamp.nanoseconds > _MAX_SCAN_AGE_S * 1e9:
            return 0.0
        pose = self._poses.pose(self._base, scan.header.frame_id, 0)
        if pose is None:
            return inf
        ranges = np.asarray(scan.ranges, np.float64)
        angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
        is_valid = np.isfinite(ranges) & (ranges >= scan.range_min) & (ranges <= scan.range_max)
        yaw = angles[is_valid] + rpy_from_quaternion(pose[3:])[2]
        x, y = pose[0] + ranges[is_valid] * np.cos(yaw), pose[1] + ranges[is_valid] * np.sin(yaw)
        return float(x[(x > 0) & (np.abs(y) < self._robot_radius)].min(initial=inf))

    def _answer(self, event: Answer) -> None:
        if self._request is not None:
            self._speak(make_answer_phrase(event, self._request, self._answer_language))

    def _speak(self, text: str) -> None:
        self._node.get_logger().info(text)
        self._response.publish(get_message("std_msgs/msg/String")(data=text))


def _to_robot_frame(pose: Transform, seen_object: SeenObject) -> tuple[float, float]:
    """Return how far an object is ahead of the robot and to its left, in meters."""
    x, y, _, *rotation = invert(pose)
    ahead, left, _ = rotate((rotation[0], rotation[1], rotation[2], rotation[3]), (seen_object.x, seen_object.y, 0.0))
    return ahead + x, left + y
