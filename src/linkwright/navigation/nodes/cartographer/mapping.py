"""The mapping of cartographer_node: local motion, the map, and the robot's pose in the map.

A scan that arrives during a computation waits, and a newer scan of the same topic replaces it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.graph import Node
from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.nodes.cartographer.configuration import CartographerOptions
from linkwright.navigation.nodes.cartographer.histories import OdometryHistory, RotationHistory
from linkwright.navigation.nodes.step_runner import StepRunner
from linkwright.navigation.slam.mapper import Mapper, Outcome
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.poses import FloatArray, compose, inverse
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.steps import Steps
from linkwright.navigation.slam.tracker import ScanTracker
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_WARNING_PERIOD_S = 5.0
_MIN_PASS_THROUGH = 0
"""A cell is known as soon as one ray reached it, as in Cartographer."""


class Mapping:
    """The map and the pose of a robot.

    Args:
        node: the node whose clock and callbacks are used.
        options: the options of the trajectory.
        on_scan: called after each processed scan, with the scan that was added to the map, or None.

    Attributes:
        mapper: the graph of scans and the map.
        version: the number of changes of the map.
        map_to_local: the pose of the local frame, in which the motion is smooth, in the map, of shape (3,).
        latest_scan: the last scan, or None before the first scan.

    Raises:
        LinkwrightError: NAV101, SciPy is not installed.
    """

    def __init__(self, node: Node, options: CartographerOptions, on_scan: Callable[[PlanarScan | None], None]) -> None:
        for subpackage in ("ndimage", "sparse", "sparse.linalg", "spatial"):
            load_scipy(subpackage)  # If SciPy is missing, NAV101 is raised here and not at the first scan.
        self._node, self._options, self._on_scan = node, options, on_scan
        self._runner = StepRunner(node)
        self.version = 0
        self._reset_trajectory()
        self.mapper = self._create_mapper()

    def _create_mapper(self) -> Mapper:
        return Mapper(self._options.mapper, OccupancyMap(self._options.resolution, _MIN_PASS_THROUGH))

    def _reset_trajectory(self) -> None:
        self.map_to_local: FloatArray = np.zeros(3)
        self.latest_scan: PlanarScan | None = None
        self._odometry, self._rotations, self._tracker = OdometryHistory(), RotationHistory(), ScanTracker()
        self._waiting: dict[str, tuple[PlanarScan, int]] = {}
        self._order: list[str] = []

    def start_over(self) -> None:
        """Drop the map."""
        self._runner.drop()
        self._reset_trajectory()
        self.mapper = self._create_mapper()
        self.version += 1

    def begin_trajectory(self, options: CartographerOptions, pose: FloatArray | None) -> None:
        """Continue the map from a pose, of shape (3,), or from the first pose of the map."""
        self._runner.drop()
        self._reset_trajectory()
        self._options = options
        self.mapper.settings = options.mapper
        self.mapper.begin_session(pose)

    def close(self) -> None:
        """End the computation."""
        self._runner.close()

    # --- measurements -------------------------------------------------------------------------------------------------

    def add_odometry(self, stamp_ns: int, pose: FloatArray) -> None:
        """Add the pose of the tracking frame by odometry, of shape (3,)."""
        self._odometry.add(stamp_ns, pose)
        self.process_next()

    def add_rotation(self, stamp_ns: int, rate: float) -> None:
        """Add a rate of rotation about the vertical axis, in rad/s."""
        self._rotations.add(stamp_ns, rate)

    def add_scan(self, topic: str, scan: PlanarScan) -> None:
        """Process a scan in the tracking frame as soon as possible."""
        self._waiting[topic] = scan, self._node.get_clock().now_ns()
        self.process_next()

    def process_next(self) -> None:
        """Process a waiting scan, unless a scan is being processed or the odometry at its time is not known yet.

        The topic whose last processed scan is the oldest takes its turn.
        """
        if self._runner.is_busy or not self._waiting:
            return
        topics = sorted(self._waiting, key=lambda topic: self._order.index(topic) if topic in self._order else -1)
        for topic in topics:
            scan, received_ns = self._waiting[topic]
            if self._is_ready(scan, received_ns):
                del self._waiting[topic]
                self._order = [*(other for other in self._order if other != topic), topic]
                self._runner.start(self._process(scan), self._finish)
                return

    def _is_ready(self, scan: PlanarScan, received_ns: int) -> bool:
        if not self._options.use_odometry:
            return True
        latest_ns = self._odometry.latest_ns
        if latest_ns is None:
            self._node.get_logger().warning(
                "Queue waiting for data: (0, odom)", throttle_duration_sec=_WARNING_PERIOD_S
            )
            return False
        waited_ns = self._node.get_clock().now_ns() - received_ns
        timeout_ns = self._options.lookup_transform_timeout_sec * NANOSECONDS_PER_SECOND
        return latest_ns >= scan.stamp_ns or waited_ns >= timeout_ns

    # --- processing in steps ------------------------------------------------------------------------------------------

    def _process(self, scan: PlanarScan) -> Steps[tuple[PlanarScan, FloatArray, Outcome | None]]:
        if self._options.use_odometry:
            local_pose = self._odometry.find_pose(scan.stamp_ns)
        else:
            since = self._tracker.stamp_ns
            rotation = None if since is None else self._rotations.find_rotation(since, scan.stamp_ns)
            local_pose = yield from self._tracker.track(scan, rotation)
        outcome = None
        if self.mapper.should_process(local_pose, scan.stamp_ns):
            outcome = yield from self.mapper.process(scan, local_pose)
        return scan, local_pose, outcome

    def _finish(self, result: tuple[PlanarScan, FloatArray, Outcome | None]) -> None:
        scan, local_pose, outcome = result
        self.latest_scan = scan
        if outcome is not None:
            self.map_to_local = compose(outcome.pose, inverse(local_pose))
            self.version += 1
            if outcome.loop_count:
                self._node.get_logger().info(
                    f"closed a loop after {len(self.mapper.scans)} scans", throttle_duration_sec=_WARNING_PERIOD_S
                )
        self._on_scan(scan if outcome is not None else None)
        if not self._runner.is_busy:
            self.process_next()

    # --- poses --------------------------------------------------------------------------------------------------------

    def find_local_pose(self, time_ns: int) -> FloatArray:
        """Return the pose of the tracking frame in the local frame at a time, of shape (3,)."""
        if self._options.use_odometry:
            return self._odometry.find_pose(time_ns)
        return self._tracker.predict(time_ns)

    def find_pose(self, time_ns: int) -> FloatArray:
        """Return the pose of the tracking frame in the map at a time, of shape (3,)."""
        return compose(self.map_to_local, self.find_local_pose(time_ns))
