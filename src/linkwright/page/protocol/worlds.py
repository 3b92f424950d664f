"""The content of World displays: the links of all models, and their poses."""

from __future__ import annotations

from typing import Literal

from msgspec import field

from linkwright.page.protocol.message import DataContent, Floats, Record
from linkwright.page.protocol.robot import LinkScene


class LightScene(Record):
    """A light of a world.

    `position` (m) and `direction` (a unit vector) are in the frame of the link that `link` names, or in the world
    frame. `color` is red, green, blue, multiplied by the light's intensity. Point and spot lights have a `range` in m,
    and constant, linear and quadratic attenuation. `cone` is the inner and outer angle of a spot light, in rad.
    """

    kind: Literal["directional", "point", "spot"]
    link: str | None
    position: list[float]
    direction: list[float]
    color: list[float]
    shadows: bool
    range: float = 0.0
    fading: list[float] = field(default_factory=lambda: [1.0, 0.0, 0.0])
    cone: list[float] = field(default_factory=lambda: [0.0, 0.0])


class RayAngles(Record):
    """The directions of rays in a plane: `count` angles from `first` in steps of `step`, in rad."""

    first: float
    step: float
    count: int


class LidarScene(Record):
    """A lidar of a world, and the rays of the lidar that are drawn.

    `name` includes the names of model and link. `position` (m) and `quaternion` (x y z w) are in the frame of the link.
    The lidar looks along x. Horizontal angles are about z, vertical angles are positive upwards. `nearest` and
    `farthest` are the limits of the lidar's range, in m. `visualized` is whether the description requests that the
    rays are drawn.
    """

    name: str
    link: str
    position: list[float]
    quaternion: list[float]
    visualized: bool
    horizontal: RayAngles
    vertical: RayAngles
    nearest: float
    farthest: float


class CameraScene(Record):
    """A camera of a world. The camera looks along x, with z up.

    Common fields are as in `LidarScene`.

    `left`, `right`, `up` and `down` are the bounds of the image at a distance of 1. `near` and `far` are the
    clipping distances along x, in m.
    """

    name: str
    link: str
    position: list[float]
    quaternion: list[float]
    visualized: bool
    left: float
    right: float
    up: float
    down: float
    near: float
    far: float


class FogScene(Record):
    """The fog of a world: its color (red, green, blue) and its range.

    The range is from `start` to `end` in m, or given by a `density` in 1/m.
    """

    color: list[float]
    start: float
    end: float
    density: float | None


class WorldScene(DataContent):
    """The drawable content of a World display. `revision` is the number of descriptions so far.

    `ambient` and `background` are colors: red, green, blue. `shadows` is whether lights cast shadows. `daylight` is
    the brightness of the sky, from 0 at night to 1, or None if there is no sky. `robots` are the names of the models
    that count as robots. `camera` is the initial camera pose in the world's file, x y z qx qy qz qw in the world frame,
    looking along x, or None if the file sets none.
    """

    revision: int
    name: str
    links: list[LinkScene]
    lights: list[LightScene]
    ambient: list[float]
    background: list[float]
    shadows: bool
    lidars: list[LidarScene]
    cameras: list[CameraScene]
    robots: list[str] = field(default_factory=list)
    camera: list[float] | None = None
    daylight: float | None = None
    fog: FogScene | None = None


class WorldPoses(DataContent):
    """The poses of the links of a World display, in the order of `WorldScene`.

    The poses are in the frame of the content, shape (N, 7): x y z qx qy qz qw. They apply only to the scene with the
    same revision.
    """

    revision: int
    poses: Floats


class WorldRays(DataContent):
    """The measured ray lengths of a lidar in m, shape (vertical * horizontal,).

    The length is inf for a ray that hits no object, and -inf for a ray with an object that is too near to be measured.
    """

    lidar: str
    ranges: Floats


class WorldWater(DataContent):
    """The surface of the water in a world.

    `level` is the height of calm water in the world frame, in m. The waves grow from the time 0 with the time constant
    `growth_time`, in s. `waves` are Gerstner waves, flat, six numbers each: amplitude in m, angular frequency in rad/s,
    wavenumber in rad/m, steepness from 0 to 1, and x and y of the direction. Their time is that of `WorldPoses`.
    """

    level: float
    growth_time: float
    waves: list[float]
