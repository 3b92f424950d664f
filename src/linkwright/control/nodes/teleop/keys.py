"""The keys of teleop_twist_keyboard, in the layout of the ROS node."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase

INTERRUPT = "\x03"
"""The character of Ctrl-C, if the terminal does not turn it into a signal."""

_KEY_PATTERN = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|O.)?|.", re.DOTALL)


class Direction(NamedTuple):
    """A direction of motion, in fractions of the linear and angular speed.

    The components are forwards, to the left, up, and counterclockwise.
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    turn: float = 0.0


STILL = Direction()

DIRECTIONS = {
    "i": Direction(1.0),
    "o": Direction(1.0, turn=-1.0),
    "u": Direction(1.0, turn=1.0),
    "j": Direction(turn=1.0),
    "l": Direction(turn=-1.0),
    ",": Direction(-1.0),
    ".": Direction(-1.0, turn=1.0),
    "m": Direction(-1.0, turn=-1.0),
    "I": Direction(1.0),
    "O": Direction(1.0, -1.0),
    "U": Direction(1.0, 1.0),
    "J": Direction(y=1.0),
    "L": Direction(y=-1.0),
    "<": Direction(-1.0),
    ">": Direction(-1.0, -1.0),
    "M": Direction(-1.0, 1.0),
    "t": Direction(z=1.0),
    "b": Direction(z=-1.0),
}

SPEED_FACTORS = {
    "q": (1.1, 1.1),
    "z": (0.9, 0.9),
    "w": (1.1, 1.0),
    "x": (0.9, 1.0),
    "e": (1.0, 1.1),
    "c": (1.0, 0.9),
}
"""The factors for the linear and the angular speed, by key."""


def split_keys(text: str) -> Iterator[str]:
    """Return an iterator over the keys in a terminal's input.

    Some keys send several characters.
    """
    return (match[0] for match in _KEY_PATTERN.finditer(text))


def help_text() -> Phrase:
    """Return the text that explains the keys."""
    return phrase("""
Keys are published as velocities, Twist or TwistStamped.
---------------------------
Moving:
   u    i    o
   j    k    l
   m    ,    .

Sideways, for holonomic robots (with Shift):
---------------------------
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

any other key : stop

q/z : both speeds 10% faster/slower
w/x : only the linear speed
e/c : only the angular speed

CTRL-C to quit
""")


def format_speeds(speed: float, turn_speed: float) -> str:
    """Return the line that shows the current speeds, in m/s and rad/s."""
    return f"currently:\tspeed {speed}\tturn {turn_speed} "
