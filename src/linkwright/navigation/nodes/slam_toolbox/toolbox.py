"""The mapping and localization of slam_toolbox's nodes.

A `Toolbox` processes scans, and publishes the map, the pose and the transform of odometry. Long computations run in
steps of some milliseconds, between which other callbacks run. A scan that arrives during a computation is dropped,
except by the synchronous node.
"""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from linkwright.geometry.single import Transform, quaternion_from_rpy, rotation_matrix, rpy_from_quaternion
from linkwright.graph import (
    LATCHED_QOS,
    SENSOR_DATA_QOS,
    TF_QOS,
    Duration,
    JumpThreshold,
    Node,
    Parameter,
    TransformException,
)
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import TFMessage, Time, TransformBatch, get_message
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.grids.occupancy import occupancy_message
from linkwright.navigation.nodes.slam_toolbox.markers import graph_markers
from linkwright.navigation.nodes.slam_toolbox.parameters import Settings
from linkwright.navigation.nodes.step_runner import StepRunner
from linkwright.navigation.slam.mapper import Mapper, Outcome
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.poses import FloatArray, compose, inverse
from linkwright.navigation.slam.scan import PlanarScan, planar_scan
from linkwright.navigation.slam.steps import Steps
from linkwright.navigation.slam.storage import graph_path, load_graph

_LOOKUP_PERIOD_S = 0.05
"""The seconds between lookups of a transform that a scan waits for, if no transforms are published."""
_MAX_QUIET_QUEUE = 10
_WARNING_PERIOD_S = 5.0


class Toolbox:
    """The mapping or localization of a node while it is configured.

    Args:
        node: the ROS node that has the topics and timers.
        settings: the parameters.
        keeps_all_scans: whether scans that arrive during a computation are queued instead of dropped.
        localizes: whether the robot is only localized, without changing the map.

    Attributes:
        node: the ROS node that has the topics and timers.
        settings: the parameters.
        mapper: the map and the robot's pose in it.
        localizes: whether the robot is only localized.
        queue: the queued scans, with the odometry poses at the scans.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed; NAV501, the initial map cannot be read.
    """

    def __init__(self, node: Node, settings: Settings, *, keeps_all_scans: bool, localizes: bool) -> None:
        for subpackage in ("ndimage", "sparse", "sparse.linalg", "spatial"):
            load_scipy(subpackage)  # If SciPy is missing, NAV101 is raised here and not at the first scan.
        self.node, self.settings, self.localizes = node, settings, localizes
        self.mapper = self._create_mapper()
        self.queue: deque[tuple[PlanarScan, FloatArray]] = deque()
        self._keeps_all_scans = keeps_all_scans
        self._pending_scan: tuple[Any, int] | None = None
        self._processed_odometry: FloatArray | None = None
        self._map_to_odom: FloatArray = np.zeros(3)
        self._latest_stamp_ns: int | None = None
        self._scan_count = 0
        self._is_active: list[Any] = []
        self._has_published = False
        self._runner = StepRunner(node)
        if settings.map_file_name:
            self.load(settings.map_file_name, settings.start)
        self._buffer = BufferCore(
            Duration(nanoseconds=settings.tf_buffer_ns), logger=node.get_logger().get_child("tf2")
        )
        self._listener = TransformListener(self._buffer, node)
        message, name = get_message, settings.map_name
        self._pose_publisher = node.create_publisher(message("geometry_msgs/msg/PoseWithCovarianceStamped"), "pose", 10)
        self._map_publisher = node.create_publisher(message("nav_msgs/msg/OccupancyGrid"), name, LATCHED_QOS)
        self._metadata_publisher = node.create_publisher(
            message("nav_msgs/msg/MapMetaData"), f"{name}_metadata", LATCHED_QOS
        )
        markers_class = message("visualization_msgs/msg/MarkerArray")
        self._graph_publisher = node.create_publisher(markers_class, "slam_toolbox/graph_visualization", 1)
        self._transforms = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._jump_guard = node.create_guard_condition(self._on_time_jump)

    def start(self) -> None:
        """Subscribe to scans, and start publishing."""
        node, settings = self.node, self.settings
        scan_type = get_message("sensor_msgs/msg/LaserScan")
        self._is_active = [
            node.create_subscription(scan_type, settings.scan_topic, self._on_scan, SENSOR_DATA_QOS),
            node.create_timer(settings.transform_period or _LOOKUP_PERIOD_S, self._on_timer),
            node.create_timer(settings.map_update_interval, self.publish_map),
        ]
        backward_jump = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        # Another thread receives /clock and sets the clock, but the map may only be reset in the node's thread.
        self._jump_handle = node.get_clock().create_jump_callback(
            backward_jump, post_callback=lambda _: self._jump_guard.trigger()
        )
        if self.mapper.scans and not self._runner.is_busy:
            self._start_work(self._redraw())

    def stop(self) -> None:
        """Stop mapping, and keep the map."""
        if self._is_active:
            self._jump_handle.unregister()
        for endpoint in self._is_active:
            endpoint.destroy()
        self._is_active = []
        self._pending_scan = None
        self.queue.clear()

    def close(self) -> None:
        """Remove all publishers, subscriptions and timers."""
        self.stop()
        self._runner.close()
        self._listener.unregister()
        endpoints = (
            self._pose_publisher,
            self._map_publisher,
            self._metadata_publisher,
            self._graph_publisher,
            self._transforms,
            self._jump_guard,
        )
        for endpoint in endpoints:
            endpoint.destroy()

    def _create_mapper(self) -> Mapper:
        settings = self.settings
        occupancy = OccupancyMap(settings.resolution, settings.min_pass_through, settings.occupancy_threshold)
        return Mapper(settings.mapper, occupancy)

    # --- requests of services and topics ------------------------------------------------------------------------------

    def reset(self) -> None:
        """Start a new map, or restart localization in the same map."""
        self._runner.drop()
        self._pending_scan = None
        self.queue.clear()
        if self.localizes:
            self.mapper.begin_session(self.settings.start)
        else:
            self.mapper = self._create_mapper()
        self._map_to_odom = np.zeros(3)
        self._has_published = False

    def load(self, name: str, start: FloatArray | None) -> None:
        """Load a saved graph, and start at a pose in it.

        Args:
            name: the path of the graph.
            start: the robot's pose, of shape (3,); None for the pose of the graph's first scan.

        Raises:
            LinkwrightError: NAV501, the graph cannot be read.
        """
        mapper = self._create_mapper()
        load_graph(mapper, graph_path(name))
        mapper.begin_session(start)
        self._runner.drop()
        self.queue.clear()
        self.mapper, self._has_published = mapper, False
        if self._is_active:
            self._start_work(self._redraw())

    def start_session(self, pose: FloatArray) -> None:
        """Start a session at a pose, of shape (3,), in the map.

        The next scan is matched around this pose.
        """
        self._runner.drop()
        self.queue.clear()
        self.mapper.begin_session(pose)

    def grid(self) -> Grid | None:
        """Return the current map, or None if no cell is known."""
        return self.mapper.occupancy.grid()

    def make_map_message(self) -> Any | None:
        """Return the current map as a nav_msgs/OccupancyGrid, or None if no cell is known."""
        grid = self.grid()
        if grid is None:
            return None
        stamp = (
            Time.from_nanoseconds(self._latest_stamp_ns)
            if self._latest_stamp_ns is not None
            else self.node.get_clock().now().to_msg()
        )
        return occupancy_message(grid, self.settings.map_frame, stamp)

    # --- scans -------------------------------------------------------------------------------------------------------

    def _on_scan(self, message: Any) -> None:
        self._scan_count += 1
        self._latest_stamp_ns = message.header.stamp.nanoseconds
        if self._scan_count % self.settings.throttle_scans == 0 and self._pending_scan is None:
            self._pending_scan = (message, self.node.get_clock().now_ns())
            self._accept_scan()

    def _accept_scan(self) -> None:
        """Queue the pending scan if its transform is available, or drop the scan after the timeout."""
        if self._pending_scan is None:
            return
        message, received_ns = self._pending_scan
        settings, stamp_ns = self.settings, message.header.stamp.nanoseconds
        try:
            base, _ = self._buffer.lookup(settings.odom_frame, settings.base_frame, stamp_ns)
            laser, _ = self._buffer.lookup(settings.base_frame, message.header.frame_id, 0)
        except TransformException as error:
            if self.node.get_clock().now_ns() - received_ns >= settings.transform_timeout_ns:
                self._pending_scan = None
                self.node.get_logger().warning(
                    f"Failed to compute odom pose, scans are dropped: {error}", throttle_duration_sec=_WARNING_PERIOD_S
                )
            return
        self._pending_scan = None
        self._queue_scan(message, _planar_pose_from_transform(base), laser)

    def _queue_scan(self, message: Any, odometry: FloatArray, laser: Transform) -> None:
        if self._processed_odometry is not None and self.node.get_parameter("paused_new_measurements").value:
            return
        is_busy = self._runner.is_busy
        if is_busy and not self._keeps_all_scans:
            return
        last_queued = (self.queue[-1][1], self.queue[-1][0].stamp_ns) if self.queue else None
        if not self.mapper.should_process(odometry, message.header.stamp.nanoseconds, last_queued):
            return
        self.queue.append((self._planar_scan_from_message(message, laser), odometry))
        if len(self.queue) > _MAX_QUIET_QUEUE:
            self.node.get_logger().warning(
                f"Queue size has grown to: {len(self.queue)}. Recommend stopping until message is gone if online "
                "mapping.",
                throttle_duration_sec=_WARNING_PERIOD_S,
            )
        if not is_busy:
            self._process_next_scan()

    def _planar_scan_from_message(self, message: Any, laser: Transform) -> PlanarScan:
        ranges = np.array(message.ranges, dtype=np.float64)
        angles = message.angle_min + np.arange(len(ranges)) * message.angle_increment
        mounting = np.array(rotation_matrix(laser[3:])), np.array(laser[:3])
        limits = (message.range_min, message.range_max)
        stamp_ns = message.header.stamp.nanoseconds
        return planar_scan(ranges, angles, limits, self.settings.ranges, mounting, stamp_ns)

    # --- processing in steps -----------------------------------------------------------------------------------------

    def _process_next_scan(self) -> None:
        if not self.queue:
            return
        scan, odometry = self.queue.popleft()
        if self.localizes and not self.mapper.scans:
            self.node.get_logger().error(
                "There is no map to localize in: set map_file_name, or call slam_toolbox/deserialize_map",
                throttle_duration_sec=_WARNING_PERIOD_S,
            )
            return
        self._processed_odometry = odometry
        self._start_work(
            self.mapper.localize(scan, odometry) if self.localizes else self.mapper.process(scan, odometry)
        )

    def _start_work(self, work: Steps[Any]) -> None:
        self._runner.start(work, self._finish_work)

    def _finish_work(self, outcome: Outcome | None) -> None:
        if outcome is not None:
            self._publish_outcome(outcome)
        elif not self._has_published:
            self.publish_map()
        if not self._runner.is_busy:
            self._process_next_scan()

    def _redraw(self) -> Steps[None]:
        yield from self.mapper.redraw()

    def _publish_outcome(self, outcome: Outcome) -> None:
        assert self._processed_odometry is not None, "a scan was processed"
        self._map_to_odom = compose(outcome.pose, inverse(self._processed_odometry))
        if outcome.loop_count:
            self.node.get_logger().info(
                f"closed a loop after {len(self.mapper.scans)} scans", throttle_duration_sec=_WARNING_PERIOD_S
            )
        message = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")()
        message.header.frame_id = self.settings.map_frame
        message.header.stamp = Time.from_nanoseconds(self.mapper.latest_ns)
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        position.x, position.y = float(outcome.pose[0]), float(outcome.pose[1])
        quaternion = quaternion_from_rpy((0.0, 0.0, float(outcome.pose[2])))
        orientation.x, orientation.y, orientation.z, orientation.w = quaternion
        cos, sin = np.cos(outcome.pose[2]), np.sin(outcome.pose[2])
        axes = np.array(((cos, -sin), (sin, cos)))
        covariance = np.zeros((6, 6))
        covariance[:2, :2] = axes @ outcome.covariance[:2, :2] @ axes.T * self.settings.position_covariance_scale
        covariance[5, 5] = outcome.covariance[2, 2] * self.settings.yaw_covariance_scale
        message.pose.covariance = covariance.reshape(36)
        self._pose_publisher.publish(message)
        if not self._has_published:
            self.publish_map()

    # --- periodic publishing ------------------------------------------------------------------------------------------

    def publish_map(self) -> None:
        """Publish the map and its metadata if a map exists, and the graph if it has subscribers."""
        message = self.make_map_message()
        if message is None:
            return
        self._has_published = True
        self._map_publisher.publish(message)
        self._metadata_publisher.publish(message.info)
        if self._graph_publisher.get_subscription_count():
            self._graph_publisher.publish(
                graph_markers(self.mapper.graph, self.settings.map_frame, message.header.stamp)
            )

    def _on_timer(self) -> None:
        self._accept_scan()
        if self._latest_stamp_ns is None or not self.settings.transform_period:
            return
        x, y, yaw = (float(value) for value in self._map_to_odom)
        pose: Transform = (x, y, 0.0, *quaternion_from_rpy((0.0, 0.0, yaw)))
        settings, stamp_ns = self.settings, self._latest_stamp_ns + self.settings.transform_timeout_ns
        batch = TransformBatch((settings.map_frame,), (settings.odom_frame,), stamp_ns, np.array([pose]))
        self._transforms.publish(TFMessage(batch=batch))

    def _on_time_jump(self) -> None:
        if self._latest_stamp_ns is not None:
            self.node.get_logger().warning("Time has jumped back: the map starts from scratch.")
        self._buffer.clear()
        self._latest_stamp_ns, self._processed_odometry = None, None
        self.reset()

    def set_paused(self, is_paused: bool) -> None:
        """Pause or resume the processing of scans."""
        self.node.set_parameters([Parameter("paused_new_measurements", value=is_paused)])


def _planar_pose_from_transform(pose: Transform) -> FloatArray:
    """Return the x, y and yaw of a 3D pose."""
    return np.array((pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]))
