"""Lifts models that are spawned inside the ground.

Launch files spawn robots at a height of 0 although their origin is above the wheels, or into worlds whose ground is a
thick plate. Contacts would push such a robot out of the ground within a few steps, fast enough to throw a light one
over.
"""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.simulation import Simulation

_LEAST, _MOST = 0.002, 0.3
"""Depths in m between which a model is lifted: smaller ones do no harm, greater ones may be intended."""
_UPWARD = 0.7
"""The least vertical component of a contact's direction; a wall does not lift a model inside it."""


def lift_onto_ground(simulation: Simulation, name: str) -> None:
    """Lift a free model until it no longer penetrates static bodies.

    Very small and very large depths are ignored.

    Raises:
        KeyError: there is no such model.
    """
    if not simulation.free_links(name):
        return
    height = _depth(simulation, name)
    if not _LEAST < height < _MOST:
        return
    x, y, z, *rotation = simulation.model_pose(name)
    qx, qy, qz, qw = rotation
    simulation.place({name: (x, y, z + height, qx, qy, qz, qw)})


def collision_warnings(simulation: Simulation, name: str) -> list[Diagnostic]:
    """Return a warning (SIM143) if a free model has no collisions, otherwise an empty list.

    Raises:
        KeyError: there is no such model.
    """
    held = simulation.scene.models[name].structure.links
    links = [link.link.link for link in held]
    if any(link.collisions for link in links) or not any(link.gravity for link in links):
        return []
    if not simulation.free_links(name):
        return []
    message = phrase("no link of '{name}' has a <collision>, so it touches nothing and falls", name=name)
    hint = phrase(
        "give each of its links a <collision>, or run `linkwright drive FILE`, which infers masses "
        "and collisions, and writes them to the file with --write"
    )
    element = next((link.element for link in links if link.element is not None), None)
    span, source = (None, None) if element is None else (element.span(), element.source)
    return [Diagnostic("SIM143", message, span, severity=Severity.WARNING, hint=hint, source=source)]


def _depth(simulation: Simulation, name: str) -> float:
    """Return the height in m by which a model has to be lifted; 0 if it is not inside the ground."""
    simulation.refresh()
    model, data = simulation.model, simulation.data
    own = {simulation.body(held.link.name) for held in simulation.scene.models[name].structure.links}
    load_mujoco().mj_collision(model, data)
    depth = 0.0
    for contact in data.contact:
        bodies = [int(model.geom_bodyid[geom]) for geom in contact.geom]
        is_own = [body in own for body in bodies]
        if is_own[0] == is_own[1] or model.body_weldid[bodies[is_own.index(False)]] != 0:
            continue
        up = float(contact.frame[2]) * (1.0 if is_own[1] else -1.0)  # The normal points from geom 1 to 2.
        if up > _UPWARD:
            depth = max(depth, -float(contact.dist) / up)
    return depth
