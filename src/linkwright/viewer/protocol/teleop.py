"""The teleop pad."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.record import record

TwistKind = Literal["auto", "Twist", "TwistStamped"]


@record
class TeleopTarget:
    """Where a pad publishes; `auto` takes the type that the topic's subscribers have, Twist where there are none."""

    topic: str
    kind: TwistKind
    frame_id: str


@record
class TeleopState:
    """What became of a pad's target: the type it publishes, how many listen, and why it does not publish, if so."""

    topic: str
    kind: str
    subscribers: int
    error: str | None
    type: Literal["teleop_state"] = "teleop_state"


@record
class AimTeleop:
    """The page opens its pad, or gives it another target; None closes it."""

    target: TeleopTarget | None
    type: Literal["aim_teleop"] = "aim_teleop"


@record
class Drive:
    """A velocity to publish now: m/s along x, y, z and rad/s around x, y, z. Comes again and again while one is held.

    When none comes for a while, or the page goes, zero is published.
    """

    linear: list[float]
    angular: list[float]
    type: Literal["drive"] = "drive"
