"""The teleop pad."""

from __future__ import annotations

from typing import Literal

from linkwright.viewer.protocol.message import PageMessage, Record, ServerMessage

TwistKind = Literal["auto", "Twist", "TwistStamped"]


class TeleopTarget(Record):
    """Where a pad publishes; `auto` takes the type that the topic's subscribers have, Twist where there are none."""

    topic: str
    kind: TwistKind
    frame_id: str


class TeleopState(ServerMessage):
    """The state of a pad: the type it publishes, how many listen, and why it does not publish, if so."""

    topic: str
    kind: str
    subscribers: int
    error: str | None


class AimTeleop(PageMessage):
    """The page opens its pad, or gives it another target; None closes it."""

    target: TeleopTarget | None


class Drive(PageMessage):
    """A velocity to publish now: m/s along x, y, z and rad/s around x, y, z. Comes again and again while one is held.

    When none comes for a while, or the page goes, zero is published.
    """

    linear: list[float]
    angular: list[float]
