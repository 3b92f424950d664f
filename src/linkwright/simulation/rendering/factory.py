"""Create the first renderer that works on this machine."""

from __future__ import annotations

import os

from linkwright.simulation.rendering.opengl import BACKENDS, OpenGlRenderer
from linkwright.simulation.rendering.ray_casters import Caster, EmbreeCaster, MujocoCaster
from linkwright.simulation.rendering.ray_renderer import RayRenderer
from linkwright.simulation.rendering.renderer import Renderer
from linkwright.simulation.simulation import Simulation

METHODS = (*BACKENDS, "embree", "mujoco")


def make_renderer(simulation: Simulation, method: str = "") -> Renderer:
    """Create a renderer of a simulation, for use in this thread.

    Args:
        simulation: the simulation of the world.
        method: one of `METHODS`; if empty, the backend that the environment variable ``MUJOCO_GL`` names or, if it does
            not work, the first method that works on this machine.

    Raises:
        Exception: of any class, if the requested method does not work on this machine.
    """
    if method:
        return _create_renderer(simulation, method)
    requested_backend = os.environ.get("MUJOCO_GL", "").lower()
    candidates = (
        (requested_backend, *METHODS)
        if requested_backend in BACKENDS
        else METHODS[2:]
        if requested_backend in ("off", "disable", "disabled")
        else METHODS
    )
    for candidate in candidates:
        try:
            return _create_renderer(simulation, candidate)
        except Exception:  # noqa: BLE001, PERF203, S112 - a missing library may raise anything
            continue
    raise AssertionError("MuJoCo's ray caster needs no other library, and never fails")


def _create_renderer(simulation: Simulation, method: str) -> Renderer:
    if method in BACKENDS:
        return OpenGlRenderer(simulation, method)
    caster: Caster = EmbreeCaster(simulation) if method == "embree" else MujocoCaster(simulation)
    return RayRenderer(simulation, caster)
