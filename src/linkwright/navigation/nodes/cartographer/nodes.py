"""cartographer_node: mapping from the configuration files of cartographer_ros.

The mapper is the one of slam_toolbox's nodes, `linkwright.navigation.slam`. Differences:

- Scans are nodes of a graph; there is one submap, the whole map.
- Without odometry, scans are tracked against the latest scans. An IMU predicts rotations.
- Mapping in space, GPS, landmarks, pure localization and ``.pbstream`` files are not supported.
- When simulated time jumps back, such as on the reset of a world, the map starts from scratch.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, render
from linkwright.geometry.single import Transform, compose, quaternion_from_rpy
from linkwright.graph import TF_QOS, Duration, Graph, JumpThreshold, TransformException
from linkwright.messages import TFMessage, Time, TransformBatch, get_message
from linkwright.navigation.nodes.cartographer.configuration import CartographerOptions, load_configuration
from linkwright.navigation.nodes.cartographer.mapping import Mapping
from linkwright.navigation.nodes.cartographer.markers import (
    make_cloud,
    make_constraint_markers,
    make_trajectory_markers,
)
from linkwright.navigation.nodes.cartographer.sensors import Sensors
from linkwright.navigation.nodes.cartographer.services import CartographerServices
from linkwright.navigation.nodes.cartographer.trajectories import Trajectories
from linkwright.navigation.slam.poses import FloatArray, transform_points
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.nodes.flags import FlagValue, parse_flags
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters

_FLAGS: dict[str, FlagValue] = {
    "collect_metrics": False,
    "configuration_directory": "",
    "configuration_basename": "",
    "load_state_filename": "",
    "load_frozen_state": True,
    "start_trajectory_with_default_topics": True,
    "save_state_filename": "",
}
_USAGE = "cartographer_node -configuration_directory FOLDER -configuration_basename FILE.lua"
_MIN_POSE_PERIOD_S = 0.02
"""The shortest period of transforms. Configurations often ask for 5 ms, more than any of their readers needs."""
_WAITING_PERIOD_S = 0.05
"""The period at which waiting scans are looked at if no poses are published."""
_CONSTRAINT_PERIOD_S = 0.5


class CartographerNode(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: an argument is missing or invalid (NODE431, NODE432), the configuration is not valid (NAV601
            to NAV603), or SciPy is not installed (NAV101).
    """

    DEFAULT_NAME = "cartographer_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            flags = parse_flags(arguments, _FLAGS)
            self._options = self._load_options(flags)
            self._mapping = Mapping(self._node, self._options, self._on_scan)
            log_unknown_parameters(self._node)
        self._trajectories = Trajectories()
        self._services = CartographerServices(self)
        self._sensors = Sensors(self._node, self._options, self._mapping)
        self._last_stamp_ns = 0
        self._create_publishers()
        self._create_timers()
        if flags["start_trajectory_with_default_topics"]:
            self._trajectories.add(0)
            self._sensors.start()

    @property
    def mapping(self) -> Mapping:
        """The map and the pose of the robot."""
        return self._mapping

    @property
    def trajectories(self) -> Trajectories:
        """The trajectories of the map."""
        return self._trajectories

    @property
    def map_frame(self) -> str:
        """The frame of the map."""
        return self._options.map_frame

    def close(self) -> None:
        """Close the node."""
        self._jump_handle.unregister()
        self._sensors.close()
        self._mapping.close()
        super().close()

    # --- trajectories -------------------------------------------------------------------------------------------------

    def start_trajectory(self, options: CartographerOptions, pose: FloatArray | None) -> int:
        """Start a trajectory at a pose in the map, of shape (3,), or None, and return its number."""
        self.log_remarks(options)
        self._sensors.close()
        self._options = options
        if self._mapping.mapper.scans:
            self._mapping.begin_trajectory(options, pose)
        else:
            self._mapping.close()
            self._mapping = Mapping(self._node, options, self._on_scan)
        self._sensors = Sensors(self._node, options, self._mapping)
        self._sensors.start()
        return self._trajectories.add(len(self._mapping.mapper.scans))

    def finish_trajectory(self) -> None:
        """Finish the active trajectory."""
        for topic in self._sensors.topics:
            self._node.get_logger().info(f"Shutdown the subscriber of [{topic}]")
        self._sensors.stop()
        self._trajectories.finish()

    def _load_options(self, flags: dict[str, FlagValue]) -> CartographerOptions:
        for name in ("configuration_directory", "configuration_basename"):
            if not flags[name]:
                message = phrase("-{name} is missing", name=name)
                raise LinkwrightError(Diagnostic("NODE431", message, hint=phrase("usage: {usage}", usage=_USAGE)))
        for name in ("load_state_filename", "save_state_filename"):
            if flags[name]:
                self._node.get_logger().warning(
                    f"-{name} is ignored: Linkwright neither reads nor writes .pbstream files; map_saver_cli saves the"
                    " map, and amcl localizes in it"
                )
        options = load_configuration(str(flags["configuration_directory"]), str(flags["configuration_basename"]))
        self.log_remarks(options)
        return options

    def log_remarks(self, options: CartographerOptions) -> None:
        """Log the warnings about a configuration, and the options that have no effect."""
        logger = self._node.get_logger()
        for finding in options.findings:
            logger.warning(render(finding))
        if options.without_effect:
            logger.info(f"options of Cartographer without effect here: {', '.join(options.without_effect)}")

    # --- publishing ---------------------------------------------------------------------------------------------------

    def _create_publishers(self) -> None:
        node, markers = self._node, get_message("visualization_msgs/msg/MarkerArray")
        self._transforms = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._submap_list = node.create_publisher(
            get_message("cartographer_ros_msgs/msg/SubmapList"), "submap_list", 10
        )
        self._trajectory_list = node.create_publisher(markers, "trajectory_node_list", 10)
        self._landmarks = node.create_publisher(markers, "landmark_poses_list", 10)
        self._constraints = node.create_publisher(markers, "constraint_list", 10)
        self._matched_cloud = node.create_publisher(
            get_message("sensor_msgs/msg/PointCloud2"), "scan_matched_points2", 10
        )
        self._tracked_pose = (
            node.create_publisher(get_message("geometry_msgs/msg/PoseStamped"), "tracked_pose", 10)
            if self._options.publish_tracked_pose
            else None
        )

    def _create_timers(self) -> None:
        node, options = self._node, self._options
        pose_period = options.pose_publish_period_sec
        node.create_timer(
            max(pose_period, _MIN_POSE_PERIOD_S) if pose_period > 0 else _WAITING_PERIOD_S, self._on_timer
        )
        node.create_timer(options.submap_publish_period_sec, self._publish_submap_list)
        node.create_timer(max(options.trajectory_publish_period_sec, _MIN_POSE_PERIOD_S), self._publish_trajectories)
        node.create_timer(_CONSTRAINT_PERIOD_S, self._publish_constraints)
        self._jump_guard = node.create_guard_condition(self._on_time_jump)
        backward_jump = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        # Another thread receives /clock and sets the clock, but the map may only be reset in the node's thread.
        self._jump_handle = node.get_clock().create_jump_callback(
            backward_jump, post_callback=lambda _: self._jump_guard.trigger()
        )

    def _on_timer(self) -> None:
        self._mapping.process_next()
        scan = self._mapping.latest_scan
        if scan is None or self._trajectories.active is None or self._options.pose_publish_period_sec <= 0:
            return
        now_ns = max(self._node.get_clock().now_ns(), scan.stamp_ns)
        stamp_ns = now_ns if self._options.use_pose_extrapolator else scan.stamp_ns
        if stamp_ns == self._last_stamp_ns:
            return
        published = self._find_published_frame(stamp_ns)
        if published is None:
            return
        self._last_stamp_ns = stamp_ns
        if self._options.publish_to_tf:
            self._publish_transforms(stamp_ns, *published)
        if self._tracked_pose is not None:
            message = get_message("geometry_msgs/msg/PoseStamped")()
            message.header.frame_id = self._options.map_frame
            message.header.stamp = Time.from_nanoseconds(stamp_ns)
            _write_pose(message.pose, to_transform(self._mapping.find_pose(stamp_ns)))
            self._tracked_pose.publish(message)

    def _find_published_frame(self, now_ns: int) -> tuple[Transform, int] | None:
        """Return the pose of the published frame in the tracking frame, and the time of this pose, or None.

        Odometry moves the frame odom against the robot, so its pose belongs to the latest time at which it is known.
        """
        tracking, published = self._options.tracking_frame, self._options.published_frame
        if tracking == published:
            return (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0), now_ns
        try:
            pose, time_ns = self._sensors.buffer.lookup(tracking, published, 0)
        except TransformException as error:
            self._node.get_logger().warning(str(error), throttle_duration_sec=5.0)
            return None
        return pose, time_ns or now_ns

    def _publish_transforms(self, stamp_ns: int, published_in_tracking: Transform, time_ns: int) -> None:
        options, mapping = self._options, self._mapping
        if options.provide_odom_frame:
            local = compose(to_transform(mapping.find_local_pose(time_ns)), published_in_tracking)
            batch = TransformBatch(
                (options.map_frame, options.odom_frame),
                (options.odom_frame, options.published_frame),
                stamp_ns,
                np.array([to_transform(mapping.map_to_local), local]),
            )
        else:
            pose = compose(to_transform(mapping.find_pose(time_ns)), published_in_tracking)
            batch = TransformBatch((options.map_frame,), (options.published_frame,), stamp_ns, np.array([pose]))
        self._transforms.publish(TFMessage(batch=batch))

    def _on_scan(self, scan: PlanarScan | None) -> None:
        if scan is None or not self._matched_cloud.get_subscription_count():
            return
        points = transform_points(self._mapping.find_pose(scan.stamp_ns), scan.points)
        stamp = Time.from_nanoseconds(scan.stamp_ns)
        self._matched_cloud.publish(make_cloud(points, self._options.map_frame, stamp))

    def _publish_submap_list(self) -> None:
        message = get_message("cartographer_ros_msgs/msg/SubmapList")()
        message.header.frame_id = self._options.map_frame
        message.header.stamp = self._node.get_clock().now().to_msg()
        if not self._mapping.mapper.occupancy.is_empty:
            entry = get_message("cartographer_ros_msgs/msg/SubmapEntry")(submap_version=self._mapping.version)
            entry.pose.orientation.w = 1.0
            message.submap = [entry]
        self._submap_list.publish(message)

    def _publish_trajectories(self) -> None:
        if self._trajectory_list.get_subscription_count():
            poses = self._trajectories.split(self._mapping.mapper.graph.poses)
            stamp = self._node.get_clock().now().to_msg()
            self._trajectory_list.publish(make_trajectory_markers(poses, self._options.map_frame, stamp))

    def _publish_constraints(self) -> None:
        if self._constraints.get_subscription_count():
            stamp = self._node.get_clock().now().to_msg()
            graph = self._mapping.mapper.graph
            self._constraints.publish(make_constraint_markers(graph, self._options.map_frame, stamp))

    def _on_time_jump(self) -> None:
        if self._mapping.latest_scan is not None:
            self._node.get_logger().warning("Time has jumped back: the map starts from scratch.")
        self._sensors.buffer.clear()
        self._mapping.start_over()
        self._trajectories.start_over()


def to_transform(pose: FloatArray) -> Transform:
    """Return a pose in the plane, of shape (3,), as a transform."""
    x, y, yaw = (float(value) for value in pose)
    return (x, y, 0.0, *quaternion_from_rpy((0.0, 0.0, yaw)))


def _write_pose(message: Any, pose: Transform) -> None:
    position, orientation = message.position, message.orientation
    position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w = pose
