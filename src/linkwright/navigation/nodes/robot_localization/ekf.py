"""robot_localization's ekf_node and ukf_node, which estimate pose and motion from sensors.

The nodes follow robot_localization 3.5 (ROS 2 Humble) and later, with these deliberate differences:

- When simulated time jumps back, such as on the reset of a world, the filter restarts even if ``reset_on_time_jump`` is
  false; the original would wait until time has caught up.
- A true value in ``_config`` for a quantity that the sensor does not provide is ignored, not measured as 0.
- Lookups of transforms never wait, so ``transform_timeout`` has no effect. Neither has ``debug``.
- ``process_noise_covariance`` and ``initial_estimate_covariance`` may be the 15 numbers of the diagonal.
- Sensors and their rules: see `linkwright.navigation.estimation.readings`.
"""

from __future__ import annotations

from math import isfinite
from typing import Any, ClassVar

import numpy as np

from linkwright.geometry.single import Transform, compose, normalized, quaternion_from_rpy
from linkwright.graph import TF_QOS, Duration, Graph, JumpThreshold, TransformException
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.estimation.estimator import Estimator
from linkwright.navigation.estimation.kalman import ExtendedKalmanFilter, KalmanFilter, UnscentedKalmanFilter
from linkwright.navigation.estimation.motion_model import ACCELERATION, ANGLES, POSE, POSITION, STATE_SIZE, TWIST
from linkwright.navigation.estimation.readings import PoseReader
from linkwright.navigation.nodes.robot_localization.configuration import read_configuration
from linkwright.navigation.nodes.robot_localization.sources import Source, SourceContext
from linkwright.nodes.diagnostic_updater import DiagnosticUpdater, Health, Level
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import log_unknown_parameters

_INITIAL_VARIANCE = 1e-6
"""The initial variance of the quantities that ``set_pose`` does not set."""


class EkfNode(SingleNode):
    """The running ekf_node.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201) or the wrong number of values (NODE441),
            or two frames are the same (NODE442).
    """

    DEFAULT_NAME: ClassVar[str] = "ekf_filter_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._configuration = read_configuration(self._node)
            self._filter = self._make_filter()
            log_unknown_parameters(self._node)
        self._estimator = Estimator(self._filter, self._configuration.timing)
        self._is_enabled = self._configuration.is_initially_enabled
        self._is_toggled_on = True
        self._last_published_ns = -1
        self._clock = self._node.get_clock()
        self._context = SourceContext(self._node, self._configuration, self._estimator, self._on_old_message)
        self._sources = [Source(sensor, self._context) for sensor in self._configuration.sensors]
        self._create_interfaces()

    def _make_filter(self) -> KalmanFilter:
        return ExtendedKalmanFilter(self._configuration.filter)

    def _create_interfaces(self) -> None:
        node, pose = self._node, get_message("geometry_msgs/msg/PoseWithCovarianceStamped")
        self._publisher = node.create_publisher(get_message("nav_msgs/msg/Odometry"), "odometry/filtered", 10)
        self._tf_publisher = node.create_publisher(TFMessage, "/tf", TF_QOS)
        if self._configuration.publishes_acceleration:
            acceleration_class = get_message("geometry_msgs/msg/AccelWithCovarianceStamped")
            self._acceleration_publisher = node.create_publisher(acceleration_class, "accel/filtered", 10)
        if self._configuration.publishes_diagnostics:
            DiagnosticUpdater(node, "Filter diagnostic updater", self._check_health)
        if self._configuration.filter.control is not None:
            is_stamped: bool = node.get_parameter("stamped_control").value
            command_class = get_message(f"geometry_msgs/msg/Twist{'Stamped' if is_stamped else ''}")
            on_command = self._on_stamped_command if is_stamped else self._on_command
            node.create_subscription(command_class, "cmd_vel", on_command, 1)
        node.create_subscription(pose, "set_pose", self._set_pose, 1)
        node.create_service(get_service("robot_localization/srv/SetPose"), "set_pose", self._on_set_pose)
        node.create_service(get_service("robot_localization/srv/ToggleFilterProcessing"), "toggle", self._on_toggle)
        node.create_service(get_service("std_srvs/srv/Empty"), "enable", self._on_enable)
        backward_jump = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        # Another thread receives /clock and sets the clock, but the filter may only be reset in the node's thread.
        jump_guard = node.create_guard_condition(self._on_time_jump)
        self._jump_handle = self._clock.create_jump_callback(
            backward_jump, post_callback=lambda _: jump_guard.trigger()
        )
        node.create_timer(1.0 / self._configuration.frequency, self._update)

    def close(self) -> None:
        """Unregister the jump callback, and close the node."""
        self._jump_handle.unregister()
        super().close()

    # --- time --------------------------------------------------------------------------------------------------------

    def _on_time_jump(self) -> None:
        if self._filter.is_initialized:
            self._node.get_logger().warning("Time has jumped: the filter restarts.")
        self._reset()

    def _on_old_message(self) -> None:
        if self._configuration.reset_on_time_jump and self._node.get_parameter("use_sim_time").value:
            self._reset()

    def _reset(self) -> None:
        self._estimator.clear()
        self._filter.reset()
        self._context.poses.buffer.clear()
        self._context.ignored_until_ns = -1
        self._last_published_ns = -1
        for source in self._sources:
            source.reset(accept_older=True)

    def _update(self) -> None:
        now_ns = self._clock.now_ns()
        if not self._is_enabled:
            self._node.get_logger().info(
                f"Filter is disabled. To enable it call the {self._node.resolve_service_name('enable')} service",
                once=True,
            )
            return
        if self._is_toggled_on:
            self._estimator.advance(now_ns)
        else:
            self._estimator.clear()
            self._filter.time_ns = now_ns
        if self._filter.is_initialized:
            self._publish()

    # --- results -----------------------------------------------------------------------------------------------------

    def _publish(self) -> None:
        kalman, configuration = self._filter, self._configuration
        if not np.isfinite(kalman.state).all():
            self._node.get_logger().error(
                "Critical Error, NaNs were detected in the output state of the filter. This was likely due to poorly "
                "conditioned process, noise, or sensor covariances. The filter restarts."
            )
            self._reset()
            return
        if kalman.time_ns <= self._last_published_ns and not configuration.publishes_corrections:
            return
        self._last_published_ns = kalman.time_ns
        roll, pitch, yaw = (float(angle) for angle in kalman.state[ANGLES])
        x, y, z = (float(coordinate) for coordinate in kalman.state[POSITION])
        pose: Transform = (x, y, z, *quaternion_from_rpy((roll, pitch, yaw)))
        if configuration.publishes_tf:
            self._publish_transform(pose)
        self._publisher.publish(self._make_odometry_message(pose))
        if configuration.publishes_acceleration:
            self._acceleration_publisher.publish(self._make_acceleration_message())

    def _publish_transform(self, base_in_world: Transform) -> None:
        frames = self._configuration.frames
        parent, child, pose = frames.world, frames.output, base_in_world
        if frames.world == frames.map:
            try:
                odom_in_base, _ = self._context.poses.buffer.lookup(frames.base, frames.odom, 0)
            except TransformException as error:
                self._node.get_logger().error(
                    f"Could not obtain transform from {frames.odom}->{frames.base}: {error}", throttle_duration_sec=5.0
                )
                return
            child, pose = frames.odom, compose(base_in_world, odom_in_base)
        stamp_ns = self._filter.time_ns + self._configuration.transform_offset_ns
        batch = TransformBatch((parent,), (child,), stamp_ns, np.array([pose]))
        self._tf_publisher.publish(TFMessage(batch=batch))

    def _make_odometry_message(self, pose: Transform) -> Any:
        kalman, frames = self._filter, self._configuration.frames
        message = get_message("nav_msgs/msg/Odometry")()
        message.header.stamp = Time.from_nanoseconds(kalman.time_ns)
        message.header.frame_id, message.child_frame_id = frames.world, frames.output
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w = pose
        linear, angular = message.twist.twist.linear, message.twist.twist.angular
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = kalman.state[TWIST].tolist()
        message.pose.covariance = kalman.covariance[POSE, POSE].reshape(36)
        message.twist.covariance = kalman.covariance[TWIST, TWIST].reshape(36)
        return message

    def _make_acceleration_message(self) -> Any:
        kalman = self._filter
        message = get_message("geometry_msgs/msg/AccelWithCovarianceStamped")()
        message.header.stamp = Time.from_nanoseconds(kalman.time_ns)
        message.header.frame_id = self._configuration.frames.output
        linear = message.accel.accel.linear
        linear.x, linear.y, linear.z = kalman.state[ACCELERATION].tolist()
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = kalman.covariance[ACCELERATION, ACCELERATION]
        message.accel.covariance = covariance.reshape(36)
        return message

    def _check_health(self) -> Health:
        if not self._filter.is_initialized:
            return Health(Level.WARN, "No measurement has been received yet.")
        return Health(Level.OK, "The robot_localization state estimation node appears to be functioning properly.")

    # --- commands ----------------------------------------------------------------------------------------------------

    def _on_command(self, message: Any) -> None:
        self._set_command(message, self._clock.now_ns())

    def _on_stamped_command(self, message: Any) -> None:
        frame, base = message.header.frame_id, self._configuration.frames.base
        if frame not in ("", base):
            self._node.get_logger().warning(
                f"Commanded velocities must be given in the robot's body frame ({base}). Message frame was {frame}",
                throttle_duration_sec=5.0,
            )
            return
        self._set_command(message.twist, message.header.stamp.nanoseconds)

    def _set_command(self, twist: Any, stamp_ns: int) -> None:
        linear, angular = twist.linear, twist.angular
        command = np.array((linear.x, linear.y, linear.z, angular.x, angular.y, angular.z))
        if np.isfinite(command).all():
            self._filter.command = (command, stamp_ns)

    def _set_pose(self, message: Any) -> None:
        frames, stamp_ns = self._configuration.frames, message.header.stamp.nanoseconds
        frame = message.header.frame_id or frames.world
        sensor = self._context.poses.pose(frames.world, frame, stamp_ns)
        if sensor is None:
            return
        position, orientation = message.pose.pose.position, message.pose.pose.orientation
        quaternion = normalized(orientation.x, orientation.y, orientation.z, orientation.w)
        pose: Transform = (position.x, position.y, position.z, *quaternion)
        if not all(isfinite(number) for number in pose):
            self._node.get_logger().error("set_pose: the pose has values that are not finite, so it is ignored")
            return
        reader = PoseReader((True,) * STATE_SIZE, two_d=self._configuration.two_d)
        covariance = np.asarray(message.pose.covariance, dtype=np.float64).reshape(6, 6)
        reading = reader.read(pose, covariance, sensor, stamp_ns)
        assert reading is not None, "only a differential sensor has no first reading"
        self._estimator.clear()
        for source in self._sources:
            source.reset(accept_older=False)
        self._context.ignored_until_ns = stamp_ns
        self._filter.state = reading.values
        self._filter.covariance = np.eye(STATE_SIZE) * _INITIAL_VARIANCE
        self._filter.covariance[POSE, POSE] = reading.covariance[POSE, POSE]
        self._filter.time_ns = self._clock.now_ns()

    def _on_set_pose(self, request: Any, response: Any) -> Any:
        self._set_pose(request.pose)
        return response

    def _on_toggle(self, request: Any, response: Any) -> Any:
        response.status = bool(request.on) != self._is_toggled_on
        if response.status:
            self._is_toggled_on = bool(request.on)
            self._node.get_logger().info(f"Toggling filter measurement filtering to {'On' if request.on else 'Off'}.")
        else:
            self._node.get_logger().warning(
                "Service was called to toggle filter processing but state was already as requested."
            )
        return response

    def _on_enable(self, request: Any, response: Any) -> Any:
        if self._is_enabled:
            self._node.get_logger().warning(
                "Asking for enabling filter service, but the filter was already enabled! Use param disabled_at_startup."
            )
        else:
            self._node.get_logger().info("Enabling filter...")
            self._is_enabled = True
        return response


class UkfNode(EkfNode):
    """The running ukf_node, which raises the same errors as `EkfNode`."""

    DEFAULT_NAME: ClassVar[str] = "ukf_filter_node"

    def _make_filter(self) -> KalmanFilter:
        declare = self._node.declare_parameter
        alpha, kappa, beta = (
            float(declare(name, default).value) for name, default in (("alpha", 0.001), ("kappa", 0.0), ("beta", 2.0))
        )
        return UnscentedKalmanFilter(self._configuration.filter, alpha=alpha, kappa=kappa, beta=beta)
