"""What a World display draws: the links of all models of a simulated world, and where they are."""

from __future__ import annotations

from typing import Literal

from msgspec import field

from linkwright.viewer.protocol.binary import Floats
from linkwright.viewer.protocol.message import DataContent, Record
from linkwright.viewer.protocol.robot import LinkScene


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


class WorldScene(DataContent):
    """World: what is drawn; `revision` counts descriptions.

    `ambient` and `background` are colours, red, green, blue; `shadows` tells whether lights cast any.
    """

    revision: int
    name: str
    links: list[LinkScene]
    lights: list[LightScene]
    ambient: list[float]
    background: list[float]
    shadows: bool


class WorldPoses(DataContent):
    """World: where the links are in the frame of the content, shape (N, 7): x y z qx qy qz qw, in the scene's order.

    Only for the scene of the same revision.
    """

    revision: int
    poses: Floats
