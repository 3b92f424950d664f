"""Lift models that are spawned inside the ground.

Some launch files spawn robots at a height of 0 although their origin is above the wheels, or into worlds in which the
ground is a thick plate. Contacts would push such a robot out of the ground within a few steps, so fast that a light
robot would topple.
"""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic, Severity, phrase
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.simulation import Simulation

_MIN_DEPTH, _MAX_DEPTH = 0.002, 0.3
"""The depths in m between which a model is lifted. Smaller depths are harmless, and greater depths may be intended."""
_MIN_UPWARD_COMPONENT = 0.7
"""The minimum vertical component of a contact's normal, so that a wall does not lift a model that it contains."""


def lift_onto_ground(simulation: Simulation, name: str) -> None:
    """Lift a free model until it no longer penetrates static bodies.

    Depths of at most 2 mm and of at least 0.3 m are ignored.

    Raises:
        KeyError: there is no such model.
    """
    if not simulation.free_links(name):
        return
    height = _compute_lift_height(simulation, name)
    if not _MIN_DEPTH < height < _MAX_DEPTH:
        return
    x, y, z, *rotation = simulation.model_pose(name)
    qx, qy, qz, qw = rotation
    simulation.set_initial_poses({name: (x, y, z + height, qx, qy, qz, qw)})


def find_collision_warnings(simulation: Simulation, name: str) -> list[Diagnostic]:
    """Return a warning (SIM143) if a free model has no collisions, or else an empty list.

    Raises:
        KeyError: there is no such model.
    """
    tree_links = simulation.scene.models[name].structure.links
    links = [link.link.link for link in tree_links]
    if any(link.collisions for link in links) or not any(link.gravity for link in links):
        return []
    if not simulation.free_links(name):
        return []
    message = phrase("no link of '{name}' has a <collision>, so the model has no contacts and falls", name=name)
    hint = phrase(
        "give each of its links a <collision>, or run `linkwright drive FILE`, which infers masses "
        "and collisions, and writes them to the file with --write"
    )
    element = next((link.element for link in links if link.element is not None), None)
    span, source = (None, None) if element is None else (element.span(), element.source)
    return [Diagnostic("SIM143", message, span, severity=Severity.WARNING, hint=hint, source=source)]


def _compute_lift_height(simulation: Simulation, name: str) -> float:
    """Return the height in m by which a model must be lifted to leave the ground.

    The height is 0 if the model is not inside the ground.
    """
    simulation.refresh()
    model, data = simulation.model, simulation.data
    own_bodies = {simulation.body(tree_link.link.name) for tree_link in simulation.scene.models[name].structure.links}
    load_mujoco().mj_collision(model, data)
    height = 0.0
    for contact in data.contact:
        bodies = [int(model.geom_bodyid[geom]) for geom in contact.geom]
        is_own = [body in own_bodies for body in bodies]
        if is_own[0] == is_own[1] or model.body_weldid[bodies[is_own.index(False)]] != 0:
            continue
        upward_component = float(contact.frame[2]) * (1.0 if is_own[1] else -1.0)  # The normal points from geom 1 to 2.
        if upward_component > _MIN_UPWARD_COMPONENT:
            height = max(height, -float(contact.dist) / upward_component)
    return height
