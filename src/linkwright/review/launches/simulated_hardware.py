"""Find arguments whose defaults newly choose the hardware of the robot or another simulation, or activate nothing."""

from __future__ import annotations

import re
from collections.abc import Iterable

from linkwright.diagnostics import Phrase, phrase

_SIMULATED = re.compile(
    r"(?:(?:use|is|enable|in|with)_)?"
    r"(?:sim|simulat(?:e|ed|ion|or)|gazebo|fake_execution|(?:fake|mock|dummy|sim|simulated)_(?:hardware|components|robot|system|controllers?))"
    r"(?:_mode|_only)?"
)
"""The names of arguments that replace the hardware by a simulation."""
_PAUSED = re.compile(r"(?:start_)?paused?")
"""The names of arguments with which a simulation starts paused."""
_AUTOSTART = "autostart"
"""The argument and parameter with which the managers of lifecycle nodes, such as those of Nav2, activate the nodes."""
_CLOCK_SOURCE = re.compile(
    r"sim(?![a-z])|simulat|gazebo|ignition|(?<![a-z])(?:gz|ign)(?![a-z])|webots|isaac|mujoco|coppelia|vrep|stage|unity"
    r"|flatland|carla|airsim|bag(?![a-z])|rosbag|clock|replay|player|demo|test|example",
    re.IGNORECASE,
)
"""A name of a file or program that may publish ``/clock``, or that is used together with such a program."""
_TRUE = frozenset({"true", "1", "yes", "on"})
_FALSE = frozenset({"false", "0", "no", "off"})


def find_hardware_reason(name: str, old: str, new: str) -> Phrase | None:
    """Return the reason why another default is breaking that switches between hardware and a simulation, or pauses it.

    So is one with which the nodes do not become active.

    Args:
        name: the name of the argument.
        old: its old default.
        new: its new default.
    """
    before, after = old.strip().lower(), new.strip().lower()
    if _PAUSED.fullmatch(name.lower()) is not None and before in _FALSE and after in _TRUE:
        return phrase("the simulation starts paused")
    if name == _AUTOSTART and before in _TRUE and after in _FALSE:
        return phrase("the nodes wait for a program that activates or starts them")
    if _SIMULATED.fullmatch(name.lower()) is None:
        return None
    if before in _TRUE and after in _FALSE:
        return phrase("by default, the hardware of the robot is used instead of a simulation")
    if before in _FALSE and after in _TRUE:
        return phrase("by default, a simulation is used instead of the hardware of the robot")
    return None


def find_clock_reason(name: str, old: str, new: str, names: Iterable[str]) -> Phrase | None:
    """Return the reason why a default that chooses simulated time is breaking, or None if it is not.

    Args:
        name: the name of the argument.
        old: its old default.
        new: its new default.
        names: the path of the launch file, and the names of its included files and programs.
    """
    before, after = old.strip().lower(), new.strip().lower()
    if name != "use_sim_time" or before not in _FALSE or after not in _TRUE:
        return None
    if any(_CLOCK_SOURCE.search(text.replace("use_sim_time", "")) for text in names):
        return None
    return phrase("by default, timers of the nodes only run if a simulation or recording publishes '/clock'")
