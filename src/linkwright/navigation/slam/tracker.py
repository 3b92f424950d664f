"""A tracker that estimates the motion of a robot without odometry, from its scans alone.

Each scan is matched against the latest key scans, from the pose that the last velocity predicts, as in Cartographer's
local SLAM.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from linkwright.navigation.slam.matching import match_scan
from linkwright.navigation.slam.poses import FloatArray, compose, relative_pose
from linkwright.navigation.slam.reference import Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search
from linkwright.navigation.slam.steps import Steps
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_KEY_DISTANCE_M, _KEY_ANGLE_RAD = 0.2, 0.15
"""The motion after which a scan becomes a key scan."""
_KEY_COUNT = 10
_MIN_INLIER_FRACTION = 0.4
"""The minimum fraction of a scan's points that must fit."""
_SEARCH = Search(dimension=0.3, angle_offset=0.25)
_MAX_PREDICTION_S = 0.5
"""The longest time for which a velocity predicts the pose."""


class ScanTracker:
    """The pose of a robot in the frame of its first scan."""

    def __init__(self) -> None:
        self._keys: deque[tuple[PlanarScan, FloatArray]] = deque(maxlen=_KEY_COUNT)
        self._reference: Reference | None = None
        self._pose: FloatArray = np.zeros(3)
        self._velocity: FloatArray = np.zeros(3)
        self._stamp_ns: int | None = None

    def predict(self, time_ns: int, rotation: float | None = None) -> FloatArray:
        """Return the pose at a time, of shape (3,), predicted by the last velocity.

        Args:
            time_ns: the time.
            rotation: the rotation since the last scan, if a gyroscope measured it.
        """
        if self._stamp_ns is None:
            return self._pose
        seconds = min((time_ns - self._stamp_ns) / NANOSECONDS_PER_SECOND, _MAX_PREDICTION_S)
        motion: FloatArray = self._velocity * max(seconds, 0.0)
        if rotation is not None:
            motion[2] = rotation
        half_turn = np.array((0.0, 0.0, motion[2] / 2))
        straight = np.array((motion[0], motion[1], motion[2] / 2))
        return compose(compose(self._pose, half_turn), straight)

    @property
    def stamp_ns(self) -> int | None:
        """The time of the last scan, or None before the first scan."""
        return self._stamp_ns

    def track(self, scan: PlanarScan, rotation: float | None = None) -> Steps[FloatArray]:
        """Return the pose at a scan, of shape (3,), in steps.

        Args:
            scan: the laser scan in the frame of the robot.
            rotation: the rotation since the last scan, if a gyroscope measured it.
        """
        pose = self.predict(scan.stamp_ns, rotation)
        if self._keys:
            if self._reference is None:
                self._reference = Reference([key for key, _ in self._keys], np.array([pose for _, pose in self._keys]))
                yield
            match = yield from match_scan(self._reference, scan, pose, _SEARCH)
            if match is not None and match.inliers >= _MIN_INLIER_FRACTION:
                pose = match.pose
        self._update(scan, pose)
        return pose

    def _update(self, scan: PlanarScan, pose: FloatArray) -> None:
        if self._stamp_ns is not None and scan.stamp_ns > self._stamp_ns:
            motion = relative_pose(self._pose, pose)
            # The prediction turns by one half before and after the straight motion.
            cos, sin = np.cos(motion[2] / 2), np.sin(motion[2] / 2)
            straight = np.array((cos * motion[0] + sin * motion[1], cos * motion[1] - sin * motion[0], motion[2]))
            self._velocity = straight * (NANOSECONDS_PER_SECOND / (scan.stamp_ns - self._stamp_ns))
        self._pose, self._stamp_ns = pose, scan.stamp_ns
        if self._keys:
            since_key = relative_pose(self._keys[-1][1], pose)
            if np.hypot(since_key[0], since_key[1]) < _KEY_DISTANCE_M and abs(since_key[2]) < _KEY_ANGLE_RAD:
                return
        self._keys.append((scan, pose))
        self._reference = None
