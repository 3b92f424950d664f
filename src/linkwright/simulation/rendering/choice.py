"""Selects the first renderer that works on this machine."""

from __future__ import annotations

import os

from linkwright.simulation.rendering.opengl import BACKENDS, OpenGlRenderer
from linkwright.simulation.rendering.ray_casters import Caster, EmbreeCaster, MujocoCaster
from linkwright.simulation.rendering.ray_renderer import RayRenderer
from linkwright.simulation.rendering.renderer import Renderer
from linkwright.simulation.simulation import Simulation

WAYS = (*BACKENDS, "embree", "mujoco")


def make_renderer(simulation: Simulation, way: str = "") -> Renderer:
    """Create a renderer of a simulation, for use in this thread.

    Args:
        simulation: the simulation of the world.
        way: one of `WAYS`; by default the backend that the environment variable ``MUJOCO_GL`` names, or else the first
            that works on this machine.

    Raises:
        Exception: of any class, if the requested way does not work on this machine.
    """
    if way:
        return _made(simulation, way)
    asked = os.environ.get("MUJOCO_GL", "").lower()
    ways = (asked, *WAYS) if asked in BACKENDS else WAYS[2:] if asked in ("off", "disable", "disabled") else WAYS
    for item in ways:
        try:
            return _made(simulation, item)
        except Exception:  # noqa: BLE001, PERF203, S112 - a missing library fails in many ways
            continue
    raise AssertionError("MuJoCo's rays need nothing, and never fail")


def _made(simulation: Simulation, way: str) -> Renderer:
    if way in BACKENDS:
        return OpenGlRenderer(simulation, way)
    caster: Caster = EmbreeCaster(simulation) if way == "embree" else MujocoCaster(simulation)
    return RayRenderer(simulation, caster)
