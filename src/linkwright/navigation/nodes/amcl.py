"""nav2's amcl, which localizes the robot on a map from laser scans and odometry.

The node has nav2's parameters, topics, services and log lines. Deliberate differences: the random seed is fixed, so the
same data give the same result; a persistent mismatch of scans and map is logged; clusters of particles are continuous
across +-pi in yaw; ``save_pose_rate`` and ``freespace_downsampling`` have no effect.
"""

from __future__ import annotations

from collections import deque
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform, compose, invert, quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import LATCHED_QOS, SENSOR_DATA_QOS, TF_QOS, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.grids.occupancy import BadGridError, grid_from_message
from linkwright.navigation.localization.beams import Beams, beams_from_scan
from linkwright.navigation.localization.motion_models import Pose, wrap_angle
from linkwright.navigation.localization.particle_filter import Estimate, ParticleFilter
from linkwright.navigation.localization.sensor_models import MapLikelihoods
from linkwright.navigation.nodes.amcl_parameters import declare_parameters, read_parameters
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer

_POSE_TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"
_MAX_QUEUED_SCANS = 10
_WARNING_PERIOD_S = 5.0
_SCAN_TIMEOUT_S = 15.0
_UNKNOWN_COVARIANCE = np.diag((0.25, 0.25, (np.pi / 12.0) ** 2))
_MIN_FIT = 0.3
"""A scan does not fit if at most this share of its beams ends near an obstacle of the map."""
_MAX_CONSECUTIVE_MISFITS = 5
"""A warning is logged after this number of consecutive scans that do not fit the map."""


class AmclNode(ManagedNode):
    """The managed node of amcl."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        declare_parameters(self)
        self._pose: Pose | None = None
        self._covariance: NDArray[np.float64] = _UNKNOWN_COVARIANCE
        self._map: MapLikelihoods | None = None
        self._is_localizing = self._has_begun = self._is_update_requested = False
        self._update_count = self._misfit_count = 0
        self._odometry: Pose = (0.0, 0.0, 0.0)
        self.add_post_set_parameters_callback(lambda _: self._apply_parameters())

    def configure(self) -> None:
        """Read the parameters, and create the topics and the services.

        Raises:
            LinkwrightError: NODE433, a parameter has an invalid value.
        """
        self._settings = read_parameters(self)
        if self._settings.parameters.always_reset_initial_pose:
            self._pose = None
        self._map = None
        self._filter = ParticleFilter(self._settings.filter)
        self._queued_scans: deque[Any] = deque(maxlen=_MAX_QUEUED_SCANS)
        self._map_to_odom: Transform | None = None
        self._initialize_particles(self._pose, self._covariance)
        self._create_interfaces()

    def _create_interfaces(self) -> None:
        settings, register = self._settings, self.register
        self._buffer = BufferCore(logger=self.get_logger().get_child("tf2"))
        listener = TransformListener(self, self)
        register(_DestroyableListener(listener))
        self._cloud_publisher = register(
            self.create_publisher(get_message("nav2_msgs/msg/ParticleCloud"), "particle_cloud", SENSOR_DATA_QOS)
        )
        pose, scan = get_message(_POSE_TYPE), get_message("sensor_msgs/msg/LaserScan")
        self._pose_publisher = register(self.create_publisher(pose, "amcl_pose", LATCHED_QOS))
        self._transforms = register(self.create_publisher(TFMessage, "/tf", TF_QOS))
        register(self.create_subscription(pose, "initialpose", self._on_initial_pose, 10))
        grid = get_message("nav_msgs/msg/OccupancyGrid")
        register(self.create_subscription(grid, settings.parameters.map_topic, self._on_map, LATCHED_QOS))
        register(self.create_subscription(scan, settings.parameters.scan_topic, self._on_scan, SENSOR_DATA_QOS))
        empty_type = get_service("std_srvs/srv/Empty")
        register(self.create_service(empty_type, "reinitialize_global_localization", self._on_global_localization))
        register(self.create_service(empty_type, "request_nomotion_update", self._on_no_motion))
        initial_pose_type = get_service("nav2_msgs/srv/SetInitialPose")
        register(self.create_service(initial_pose_type, "set_initial_pose", self._on_set_initial_pose))

    def activate(self) -> None:
        """Start localizing, from the initial pose if one is set."""
        self._last_scan_ns = self.get_clock().now().nanoseconds
        self._scan_timer = self.create_timer(_SCAN_TIMEOUT_S, self._check_scan_timeout)
        if self._settings.initial_pose is not None:
            self._set_pose(self._settings.initial_pose, np.zeros((3, 3)))
        self._is_localizing = True

    def deactivate(self) -> None:
        """Stop localizing, and keep the estimated pose."""
        self._is_localizing = False
        self._scan_timer.destroy()
        self._queued_scans.clear()

    def cleanup(self) -> None:
        """Drop the map."""
        self._map = None
        self._is_localizing = False

    # --- input -------------------------------------------------------------------------------------------------------

    def update(self, message: TFMessage, *, static: bool, now_ns: int) -> None:
        """Add transforms to the buffer, and process queued scans."""
        self._buffer.update(message, static=static, now_ns=now_ns)
        if self._queued_scans:
            self._process_scans()

    def _on_map(self, message: Any) -> None:
        if self._map is not None and self._settings.parameters.first_map_only:
            return
        try:
            grid = grid_from_message(message)
        except BadGridError as error:
            self.get_logger().error(f"the message on '{self._settings.parameters.map_topic}' is not a map: {error}")
            return
        self.get_logger().info(f"Received a {grid.columns} X {grid.rows} map @ {grid.resolution:.3f} m/pix")
        if message.header.frame_id != self._settings.global_frame:
            self.get_logger().warning(
                f"Frame_id of map received:'{message.header.frame_id}' doesn't match "
                f"global_frame_id:'{self._settings.global_frame}'. "
                "This could cause issues with reading published topics"
            )
        self._map = MapLikelihoods(grid, self._settings.laser)

    def _on_scan(self, message: Any) -> None:
        if not self._is_localizing:
            return
        self._last_scan_ns = self.get_clock().now().nanoseconds
        if self._map is None:
            topic = self.resolve_topic_name(self._settings.parameters.map_topic)
            hint = "" if self.count_publishers(topic) else f" No node publishes on '{topic}'."
            self.get_logger().warning(f"Waiting for map....{hint}", throttle_duration_sec=_WARNING_PERIOD_S)
            return
        self._queued_scans.append(message)
        self._process_scans()

    def _check_scan_timeout(self) -> None:
        silent_seconds = (self.get_clock().now().nanoseconds - self._last_scan_ns) / 1e9
        if silent_seconds >= _SCAN_TIMEOUT_S:
            self.get_logger().warning(
                "No laser scan received (and thus no pose updates have been published) for "
                f"{silent_seconds:.1f} seconds. "
                f"Verify that data is being published on the {self._settings.parameters.scan_topic} topic."
            )

    def _process_scans(self) -> None:
        """Process the queued scans whose transforms are available.

        Other scans stay queued until the transform tolerance has passed.
        """
        while self._queued_scans:
            scan = self._queued_scans[0]
            stamp_ns = scan.header.stamp.nanoseconds
            try:
                robot_in_odom, _ = self._buffer.lookup(self._settings.odom_frame, self._settings.base_frame, stamp_ns)
                laser, _ = self._buffer.lookup(
                    self._settings.base_frame, scan.header.frame_id.removeprefix("/"), stamp_ns
                )
            except TransformException as error:
                is_late = (
                    self.get_clock().now().nanoseconds - stamp_ns > self._settings.parameters.transform_tolerance * 1e9
                )
                if not is_late and len(self._queued_scans) < _MAX_QUEUED_SCANS:
                    return
                self._queued_scans.popleft()
                self.get_logger().error(
                    f"Couldn't determine robot's pose associated with laser scan: {error}",
                    throttle_duration_sec=_WARNING_PERIOD_S,
                )
                continue
            self._queued_scans.popleft()
            settings = self._settings
            beams = beams_from_scan(
                scan,
                laser,
                settings.parameters.max_beams,
                settings.parameters.laser_min_range,
                settings.parameters.laser_max_range,
            )
            self._update(beams, robot_in_odom, stamp_ns)

    # --- the filter --------------------------------------------------------------------------------------------------

    def _update(self, beams: Beams, robot_in_odom: Transform, stamp_ns: int) -> None:
        assert self._map is not None, "scans wait for the map"
        settings, odometry = self._settings, _planar_pose_from_transform(robot_in_odom)
        must_update = not self._has_begun or self._is_update_requested or self._has_moved(odometry)
        if self._has_begun and must_update:
            settings.motion_model(self._filter.particles, self._odometry, odometry, settings.noise, self._filter.random)
        must_publish = not self._has_begun
        self._has_begun, self._is_update_requested = True, False
        if must_update:
            self._odometry = odometry
            beam_skipping = settings.beam_skipping if self._filter.has_converged() else None
            self._filter.update_weights(
                self._map.compute_likelihoods(
                    settings.parameters.laser_model_type, self._filter.particles, beams, beam_skipping
                )
            )
            self._update_count += 1
            if self._update_count % settings.parameters.resample_interval == 0:
                grid = self._map
                self._filter.resample(lambda count: grid.draw_random_poses(count, self._filter.random))
                must_publish = True
            self._publish_cloud(stamp_ns)
        if must_publish:
            self._publish(self._filter.estimate(), beams, robot_in_odom, stamp_ns)
        self._broadcast(stamp_ns)

    def _has_moved(self, odometry: Pose) -> bool:
        previous, settings = self._odometry, self._settings
        return (
            abs(odometry[0] - previous[0]) > settings.parameters.update_min_d
            or abs(odometry[1] - previous[1]) > settings.parameters.update_min_d
            or abs(wrap_angle(odometry[2] - previous[2])) > settings.parameters.update_min_a
        )

    def _initialize_particles(self, pose: Pose | None, covariance: NDArray[np.float64]) -> None:
        """Initialize the particles around a pose, or around the map's origin if the pose is None."""
        self._pose, self._covariance = pose, covariance
        self._filter.draw_around(pose or (0.0, 0.0, 0.0), covariance)
        self._reset()

    def _reset(self) -> None:
        self._has_begun = self._is_update_requested = False
        self._update_count = self._misfit_count = 0

    def _apply_parameters(self) -> None:
        """Apply changed parameters to the configured node.

        The frames and topics stay the same.
        """
        if not hasattr(self, "_settings"):
            return
        previous, self._settings = self._settings, read_parameters(self)
        self._filter.settings = self._settings.filter
        if self._map is not None and previous.laser != self._settings.laser:
            self._map = MapLikelihoods(self._map.grid, self._settings.laser)

    # --- output ------------------------------------------------------------------------------------------------------

    def _publish(self, estimate: Estimate, beams: Beams, robot_in_odom: Transform, stamp_ns: int) -> None:
        if self._pose is None:
            self.get_logger().warning(
                "AMCL cannot publish a pose or update the transform. Please set the initial pose...",
                throttle_duration_sec=_WARNING_PERIOD_S,
            )
            return
        self._pose, self._covariance = estimate.pose, estimate.covariance
        self._map_to_odom = compose(_transform_from_planar_pose(estimate.pose), invert(robot_in_odom))
        message = get_message(_POSE_TYPE)()
        message.header.frame_id = self._settings.global_frame
        message.header.stamp = Time.from_nanoseconds(stamp_ns)
        _write_pose(message.pose.pose, estimate.pose)
        covariance = np.zeros((6, 6))
        covariance[:2, :2] = estimate.covariance[:2, :2]
        covariance[5, 5] = estimate.covariance[2, 2]
        message.pose.covariance = covariance.reshape(36)
        self._pose_publisher.publish(message)
        self._check_fit(estimate, beams)

    def _check_fit(self, estimate: Estimate, beams: Beams) -> None:
        """Warn if several consecutive scans did not match the map."""
        assert self._map is not None, "there is an estimate"
        fit = self._map.compute_matching_share(estimate.pose, beams)
        if fit is None:
            return
        self._misfit_count = 0 if fit > _MIN_FIT else self._misfit_count + 1
        if self._misfit_count >= _MAX_CONSECUTIVE_MISFITS:
            self.get_logger().warning(
                f"only {fit:.0%} of the beams end near an obstacle of the map: the pose or the map is wrong. "
                "Set the pose with 2D Pose Estimate, or call /reinitialize_global_localization and drive",
                throttle_duration_sec=_SCAN_TIMEOUT_S,
            )

    def _publish_cloud(self, stamp_ns: int) -> None:
        if self._pose is None or not self._cloud_publisher.get_subscription_count():
            return
        message = get_message("nav2_msgs/msg/ParticleCloud")()
        message.header.frame_id = self._settings.global_frame
        message.header.stamp = Time.from_nanoseconds(stamp_ns)
        particle_class = get_message("nav2_msgs/msg/Particle")
        for (x, y, yaw), weight in zip(self._filter.particles.tolist(), self._filter.weights.tolist(), strict=True):
            particle = particle_class(weight=weight)
            _write_pose(particle.pose, (x, y, yaw))
            message.particles.append(particle)
        self._cloud_publisher.publish(message)

    def _broadcast(self, stamp_ns: int) -> None:
        if self._map_to_odom is None or not self._settings.parameters.tf_broadcast:
            return
        valid_until_ns = stamp_ns + round(self._settings.parameters.transform_tolerance * 1e9)
        frames = (self._settings.global_frame,), (self._settings.odom_frame,)
        self._transforms.publish(
            TFMessage(batch=TransformBatch(*frames, valid_until_ns, np.array([self._map_to_odom])))
        )

    # --- commands ----------------------------------------------------------------------------------------------------

    def _on_initial_pose(self, message: Any) -> None:
        logger, frame = self.get_logger(), message.header.frame_id.removeprefix("/")
        logger.info("initialPoseReceived")
        if not frame:
            logger.warning("Received initial pose with empty frame_id. You should always supply a frame_id.")
            return
        if frame != self._settings.global_frame:
            logger.warning(
                f'Ignoring initial pose in frame "{frame}"; initial poses must be in the global frame, '
                f'"{self._settings.global_frame}"'
            )
            return
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        pose = (
            position.x,
            position.y,
            rpy_from_quaternion((orientation.x, orientation.y, orientation.z, orientation.w))[2],
        )
        covariance = np.asarray(message.pose.covariance, np.float64).reshape(6, 6)[np.ix_((0, 1, 5), (0, 1, 5))]
        if not all(map(isfinite, pose)) or not np.isfinite(covariance).all():
            logger.error("Received initial pose contains NaNs or Infs! Ignoring as invalid!")
            return
        covariance[2, :2] = covariance[:2, 2] = 0.0  # nav2 also ignores these covariances.
        self._set_pose(self._move_by_odometry(pose, message.header.stamp.nanoseconds), covariance)
        if not self._is_localizing:
            logger.warning("Received initial pose request, but AMCL is not yet in the active state")

    def _move_by_odometry(self, pose: Pose, stamp_ns: int) -> Pose:
        """Return an earlier pose, moved by the odometry since its time.

        The pose is returned unchanged if its time is 0 or the odometry is unknown.
        """
        if not stamp_ns:
            return pose
        try:
            old_pose, _ = self._buffer.lookup(self._settings.odom_frame, self._settings.base_frame, stamp_ns)
            new_pose, _ = self._buffer.lookup(self._settings.odom_frame, self._settings.base_frame, 0)
        except TransformException:
            return pose
        return _planar_pose_from_transform(
            compose(_transform_from_planar_pose(pose), compose(invert(old_pose), new_pose))
        )

    def _set_pose(self, pose: Pose, covariance: NDArray[np.float64]) -> None:
        seconds = self.get_clock().now().nanoseconds / 1e9
        self.get_logger().info(f"Setting pose ({seconds:.6f}): {pose[0]:.3f} {pose[1]:.3f} {pose[2]:.3f}")
        self._initialize_particles(pose, covariance)

    def _on_set_initial_pose(self, request: Any, response: Any) -> Any:
        self._on_initial_pose(request.pose)
        return response

    def _on_global_localization(self, _request: Any, response: Any) -> Any:
        if self._map is None:
            self.get_logger().error("There is no map yet, so the robot cannot be placed on it")
            return response
        self.get_logger().info("Initializing with uniform distribution")
        self._filter.set_particles(
            self._map.draw_random_poses(self._settings.filter.max_particles, self._filter.random)
        )
        self._reset()
        self._pose = self._pose or (0.0, 0.0, 0.0)
        self.get_logger().info("Global initialization done!")
        return response

    def _on_no_motion(self, _request: Any, response: Any) -> Any:
        self.get_logger().info("Requesting no-motion update")
        self._is_update_requested = True
        return response


class _DestroyableListener:
    """A wrapper that removes a transform listener when the node is cleaned up."""

    def __init__(self, listener: TransformListener) -> None:
        self._listener = listener

    def destroy(self) -> None:
        """Remove the subscriptions of the listener."""
        self._listener.unregister()


def _planar_pose_from_transform(pose: Transform) -> Pose:
    return pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]


def _transform_from_planar_pose(pose: Pose) -> Transform:
    return (pose[0], pose[1], 0.0, *quaternion_from_rpy((0.0, 0.0, pose[2])))


def _write_pose(message: Any, pose: Pose) -> None:
    message.position.x, message.position.y = pose[0], pose[1]
    orientation = message.orientation
    orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy((0.0, 0.0, pose[2]))


class Amcl(ManagedServer):
    """The running amcl node."""

    NODE = AmclNode
    DEFAULT_NAME = "amcl"
