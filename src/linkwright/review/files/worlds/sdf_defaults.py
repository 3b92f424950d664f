"""The defaults of SDF for elements that a file leaves out.

Source: the elements of SDFormat 1.9 (``sensor.sdf``, ``surface.sdf``, ``physics.sdf``, ``model.sdf``, ``link.sdf``).
"""

from __future__ import annotations

import re

_NAME = r"(?: \S+)*?"
_DEFAULTS = tuple(
    (re.compile(rf"(?:^|.* ){path}"), default)
    for path, default in (
        (rf"sensor{_NAME} update_rate", "0"),
        (rf"sensor{_NAME} always_on", "false"),
        (rf"sensor{_NAME} visualize", "false"),
        (r"contact ode max_vel", "0.01"),
        (r"contact ode min_depth", "0"),
        (r"contact ode kp", "1000000000000"),
        (r"contact ode kd", "1"),
        (r"friction ode mu", "1"),
        (r"friction ode mu2", "1"),
        (r"friction ode slip1", "0"),
        (r"friction ode slip2", "0"),
        (r"physics(?: \S+)? max_step_size", "0.001"),
        (r"physics(?: \S+)? real_time_factor", "1"),
        (r"physics(?: \S+)? real_time_update_rate", "1000"),
        (r"(?:model|include) \S+ static", "false"),
        (r"model \S+ self_collide", "false"),
        (r"link \S+ gravity", "true"),
        (r"link \S+ kinematic", "false"),
        (r"visual \S+ cast_shadows", "true"),
        (r"dynamics damping", "0"),
        (r"dynamics friction", "0"),
    )
)
"""The paths of elements with their defaults."""
_PLUGIN = re.compile(r"(?:^| )plugin ")
"""The start of a plugin, whose parameters are not of SDF."""


def find_default(path: str) -> str | None:
    """Return the value of an element that is left out, or None if it is unknown.

    Args:
        path: the tags and names of the element and its parents.
    """
    if _PLUGIN.search(path):
        return None
    return next((default for pattern, default in _DEFAULTS if pattern.fullmatch(path)), None)
