"""What a World display draws: the links of all models of a simulated world, and where they are."""

from __future__ import annotations

from linkwright.viewer.protocol.binary import Floats
from linkwright.viewer.protocol.message import DataContent
from linkwright.viewer.protocol.robot import LinkScene


class WorldScene(DataContent):
    """World: what is drawn; `revision` counts descriptions."""

    revision: int
    name: str
    links: list[LinkScene]


class WorldPoses(DataContent):
    """World: where the links are in the frame of the content, shape (N, 7): x y z qx qy qz qw, in the scene's order.

    Only for the scene of the same revision.
    """

    revision: int
    poses: Floats
