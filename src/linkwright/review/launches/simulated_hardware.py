"""Find arguments of launch files that newly choose the hardware of the robot, or a simulation of it, by default."""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase

_SIMULATED = re.compile(
    r"(?:(?:use|is|enable|in|with)_)?"
    r"(?:sim|simulat(?:e|ed|ion|or)|gazebo|fake_execution|(?:fake|mock|dummy|sim|simulated)_(?:hardware|components|robot|system|controllers?))"
    r"(?:_mode|_only)?"
)
"""The names of arguments that replace the hardware by a simulation."""
_TRUE = frozenset({"true", "1", "yes", "on"})
_FALSE = frozenset({"false", "0", "no", "off"})


def find_hardware_reason(name: str, old: str, new: str) -> Phrase | None:
    """Return the reason why another default is breaking that switches between hardware and a simulation.

    Args:
        name: the name of the argument.
        old: its old default.
        new: its new default.
    """
    before, after = old.strip().lower(), new.strip().lower()
    if _SIMULATED.fullmatch(name.lower()) is None:
        return None
    if before in _TRUE and after in _FALSE:
        return phrase("by default, the hardware of the robot is used instead of a simulation")
    if before in _FALSE and after in _TRUE:
        return phrase("by default, a simulation is used instead of the hardware of the robot")
    return None
