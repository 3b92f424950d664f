"""The content of World displays: the links of all models of a simulated world, and their poses."""

from __future__ import annotations

from typing import Literal

from msgspec import field

from linkwright.page.protocol.message import DataContent, Floats, Record
from linkwright.page.protocol.robot import LinkScene


class LightScene(Record):
    """A light of a world.

    `position` (m) and `direction`, a unit vector, are in the frame of the link named by `link`, or of the world.
    `color` is red, green, blue with the light's intensity. Of point and spot lights: `range` in m, and how the light
    fades: constant, linear, quadratic. `cone` is the inner and outer angle of a spot, in rad.
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
    """The directions of rays in one plane: `count` of them, from `first` on by `step`, in rad."""

    first: float
    step: float
    count: int


class LidarScene(Record):
    """A lidar of a world, with those of its rays that are drawn.

    `name` is its own with those of model and link, `position` (m) and `quaternion` (x y z w) are in the frame of the
    link. It looks along x; horizontal angles are about z, vertical ones upwards. `nearest` and `farthest` are its
    range, in m. `visualized` is whether its description asks to draw it.
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
    """A camera of a world; as `LidarScene`, and it looks along x with z up.

    `left`, `right`, `up` and `down` are the bounds of its image at a distance of 1; it sees from `near` to `far`, in m
    along x.
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
    """Fog of a world: its colour, red, green, blue; from `start` to `end` in m, or with `density` in 1/m."""

    color: list[float]
    start: float
    end: float
    density: float | None


class WorldScene(DataContent):
    """World: the content to draw; `revision` counts descriptions.

    `ambient` and `background` are colours, red, green, blue; `shadows` is whether lights cast any. `daylight` is that
    of its sky, from 0 at night to 1; None if there is no sky. `robots` are the models that are robots; `camera` is the
    pose that the world's file gives to the camera of a window, x y z qx qy qz qw in the frame of the world, looking
    along x; None if it gives none.
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
    """World: the poses of the links in the frame of the content, shape (N, 7): x y z qx qy qz qw, in the scene's order.

    Only for the scene of the same revision.
    """

    revision: int
    poses: Floats


class WorldRays(DataContent):
    """World: the lengths of the rays of the lidar with this name, m, shape (vertical * horizontal,).

    inf for rays that hit nothing, -inf for rays that hit an object that is too near to be measured.
    """

    lidar: str
    ranges: Floats
