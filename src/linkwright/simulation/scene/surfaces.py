"""Surfaces of shapes: friction, stiffness, and the priority of their parameters in contacts.

Source of the figures: measurements with MuJoCo 4.0 of a robot with differential drive (straight on, arcs, turns on the
spot), and the chapters "Contact" and "Solver parameters" of MuJoCo's documentation.
"""

from __future__ import annotations

from typing import Any

from linkwright.sdf.surfaces import Surface

_USUAL_FRICTION = 1.0
_LEAST = 1e-5
"""MuJoCo has no friction coefficients of less."""
_GREATEST = 1e3
FRICTIONLESS = 0.1
"""At and below it a shape slides: descriptions of casters use such small friction to mean none."""
_SOFT = (0.05, 1.0)
"""Time constant in s and damping ratio of sliding shapes: soft enough to leave the load to the wheels beside them."""
_HARD_STEPS = 4.0
"""The time constant of wheels, in steps; two are the least that is stable."""
RESTITUTION_DATA = 2
"""The length of a bouncing geom's user data: its coefficient of restitution, and its threshold."""
_HARD_IMPEDANCE = (0.99, 0.999, 0.001, 0.5, 2.0)


def apply_surface(geom: Any, surface: Surface) -> None:
    """Apply the surface of a collision to a geom of MuJoCo.

    In a contact, Gazebo uses the lower of the two frictions. MuJoCo uses the higher one, unless one of the two geoms
    has priority. A geom with lower friction therefore gets a higher priority, which has the same effect as in
    Gazebo.
    """
    mu = friction_of(surface)
    geom.friction = [min(max(mu, _LEAST), _GREATEST), *geom.friction[1:]]
    geom.priority = _priority(mu)
    if mu < FRICTIONLESS:
        make_slippery(geom)
    if surface.torsional is not None and surface.torsional.coefficient > 0:
        geom.condim = 4
        geom.friction = [
            geom.friction[0],
            surface.torsional.coefficient * _contact_patch_radius(surface),
            geom.friction[2],
        ]
    if surface.restitution > 0:
        geom.userdata = [min(surface.restitution, 1.0), surface.bounce_threshold]
    if surface.collide_without_contact:
        geom.contype = geom.conaffinity = 0


def friction_of(surface: Surface) -> float:
    """Return the lower of the two coefficients of friction of a surface, or the default.

    MuJoCo's friction is the same in all directions.
    """
    if surface.friction is not None:
        return max(min(surface.friction.mu, surface.friction.mu2), 0.0)
    return _USUAL_FRICTION


def grip_of(surface: Surface) -> float:
    """Return the higher of the two coefficients of friction of a surface, for a driven wheel.

    The lower coefficient is meant for side slip.
    """
    if surface.friction is not None:
        return max(surface.friction.mu, surface.friction.mu2, 0.0)
    return _USUAL_FRICTION


def make_slippery(geom: Any) -> None:
    """Make a geom frictionless and soft, so that, like a caster, it leaves the load to other geoms."""
    geom.condim = 1
    make_soft(geom)
    geom.priority = _priority(0.0)


def make_frictionless(geom: Any, step: float) -> None:
    """Make a geom frictionless and hard, so that it bears load as a wheel does.

    Args:
        geom: the geom.
        step: the time step of the simulation in s.
    """
    geom.condim = 1
    make_wheel(geom, step)
    geom.priority = _priority(0.0)


def make_soft(geom: Any) -> None:
    """Make the contact of a geom slightly soft, so that adjacent wheels bear the load."""
    geom.solref = list(_SOFT)


def make_wheel(geom: Any, step: float, grip: float | None = None) -> None:
    """Make the contact of a geom hard, with priority over a ground of equal friction.

    The geom then rolls without slipping.

    Args:
        geom: the geom.
        step: the time step of the simulation in s.
        grip: the coefficient of friction; None to keep the current one.
    """
    if grip is not None:
        geom.friction = [min(max(grip, _LEAST), _GREATEST), *geom.friction[1:]]
        geom.priority, geom.condim = _priority(grip), max(geom.condim, 3)
    geom.solref = [_HARD_STEPS * step, 1.0]
    geom.solimp = list(_HARD_IMPEDANCE)
    geom.priority += 1


def _priority(mu: float) -> int:
    return 2 * round(1e6 / (1.0 + mu))


def _contact_patch_radius(surface: Surface) -> float:
    """Return the radius of the contact patch in m.

    MuJoCo's coefficient of torsional friction is a length: SDF's coefficient multiplied by this radius.
    """
    torsional = surface.torsional
    assert torsional is not None
    return max(torsional.patch_radius if torsional.use_patch_radius else torsional.surface_radius, 1e-3)
