"""Content of the displays of points, poses, paths and what else a few numbers say."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.data import Floats
from linkwright.viewer.protocol.record import record


@record
class PointMarks:
    """PointStamped: points in the frame of the content, metres, shape (N, 3)."""

    positions: Floats
    kind: Literal["point_marks"] = "point_marks"


@record
class PoseMarks:
    """Pose, PoseArray, PoseWithCovariance, Odometry and Path: poses in the frame of the content.

    `poses` has shape (N, 7): x, y, z, qx, qy, qz, qw. `covariances` has shape (N, 36), row by row over x, y, z and the
    rotations about them, or (0,).
    """

    poses: Floats
    covariances: Floats
    kind: Literal["pose_marks"] = "pose_marks"


@record
class PolygonLine:
    """Polygon: its corners in the frame of the content, shape (N, 3)."""

    points: Floats
    kind: Literal["polygon_line"] = "polygon_line"


@record
class RangeCone:
    """Range: a cone along x of the frame of the content, metres and radians; no cone where `range` is 0."""

    range: float
    field_of_view: float
    kind: Literal["range_cone"] = "range_cone"


@record
class Screw:
    """TwistStamped, AccelStamped and Wrench: two vectors in the frame of the content, SI units."""

    linear: list[float]
    angular: list[float]
    kind: Literal["screw"] = "screw"


@record
class EffortRings:
    """Effort: a ring about each joint.

    `poses` has shape (N, 7), in the Fixed Frame, with z along the joint's axis; `efforts` and `limits` are in N m, of
    shape (N,).
    """

    joints: list[str]
    poses: Floats
    efforts: Floats
    limits: Floats
    kind: Literal["effort_rings"] = "effort_rings"
