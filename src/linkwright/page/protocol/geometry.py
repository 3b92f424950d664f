"""Content of the displays for points, poses, paths and other small data."""

from __future__ import annotations

from linkwright.page.protocol.message import Bytes, DataContent, Floats


class PointMarks(DataContent):
    """The points of PointStamped in the frame of the content, meters, shape (N, 3)."""

    positions: Floats


class PoseMarks(DataContent):
    """Poses of the displays of poses, Odometry and Path, in the frame of the content.

    `poses` has shape (N, 7): x, y, z, qx, qy, qz, qw. `covariances` has shape (N, 36): the rows of the 6 x 6 matrix
    over x, y, z and the rotations about these axes. The shape is (0,) if there are no covariances.
    """

    poses: Floats
    covariances: Floats


class ParticleMarks(DataContent):
    """The particles of ParticleCloud: poses as in `PoseMarks`, and their weights, shape (N,)."""

    poses: Floats
    weights: Floats


class PolygonLine(DataContent):
    """The corners of Polygon in the frame of the content, meters, shape (N, 3)."""

    points: Floats


class GridSurface(DataContent):
    """The surface of GridMap: the centers of the cells in the frame of the content, row by row.

    `points` has shape (rows * columns, 3). `colors` has shape (rows * columns, 4): red, green, blue, and 0 for a
    missing cell. If `filled` is false, only lines are drawn.
    """

    rows: int
    columns: int
    points: Floats
    colors: Bytes
    filled: bool


class RangeCone(DataContent):
    """The cone of Range, along x in the frame of the content, meters and radians.

    There is no cone if `range` is 0.
    """

    range: float
    field_of_view: float


class Screw(DataContent):
    """The vectors of TwistStamped, AccelStamped or Wrench.

    SI units, in the frame of the content.
    """

    linear: list[float]
    angular: list[float]


class EffortRings(DataContent):
    """The rings of Effort, one around each joint.

    `poses` has shape (N, 7), in the Fixed Frame, with z along the joint's axis. `efforts` and `limits` are in N m and
    have shape (N,).
    """

    joints: list[str]
    poses: Floats
    efforts: Floats
    limits: Floats
