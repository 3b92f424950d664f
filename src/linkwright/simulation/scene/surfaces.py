"""The surface of a geom: its friction, its stiffness, and its priority in contacts.

Source of the values: measurements with MuJoCo 4.0 of a robot with differential drive (straight lines, arcs, turns on
the spot), and the chapters "Contact" and "Solver parameters" of MuJoCo's documentation.
"""

from __future__ import annotations

from typing import Any

from linkwright.sdf.surfaces import Surface

_DEFAULT_FRICTION = 1.0
"""The coefficient of friction of a surface that does not specify one."""
_MIN_FRICTION = 1e-5
"""The minimum coefficient of friction in MuJoCo."""
_MAX_FRICTION = 1e3
FRICTIONLESS = 0.1
"""The coefficient below which a shape has no friction. Descriptions of casters use such values to mean none."""
_SOFT_SOLREF = (0.05, 1.0)
"""The time constant in s and the damping ratio of sliding shapes, so soft that adjacent wheels bear the load."""
_HARD_TIME_STEPS = 4.0
"""The time constant of the contacts of wheels, in time steps. Values below two are unstable."""
RESTITUTION_DATA = 2
"""The number of user values of a bouncing geom: the coefficient of restitution and the velocity threshold in m/s."""
_HARD_SOLIMP = (0.99, 0.999, 0.001, 0.5, 2.0)


def apply_surface(geom: Any, surface: Surface) -> None:
    """Apply the surface of a collision to a geom of MuJoCo.

    In a contact, Gazebo uses the lower of the two coefficients of friction. MuJoCo uses the higher coefficient, unless
    one of the two geoms has priority. Therefore a geom with lower friction gets a higher priority, so that its
    coefficient applies as in Gazebo.
    """
    mu = get_friction(surface)
    geom.friction = [min(max(mu, _MIN_FRICTION), _MAX_FRICTION), *geom.friction[1:]]
    geom.priority = _compute_priority(mu)
    if mu < FRICTIONLESS:
        make_slippery(geom)
    if surface.torsional is not None and surface.torsional.coefficient > 0:
        geom.condim = 4
        geom.friction = [
            geom.friction[0],
            surface.torsional.coefficient * _get_contact_patch_radius(surface),
            geom.friction[2],
        ]
    if surface.restitution > 0:
        geom.userdata = [min(surface.restitution, 1.0), surface.bounce_threshold]
    if surface.collide_without_contact:
        geom.contype = geom.conaffinity = 0


def get_friction(surface: Surface) -> float:
    """Return the lower of a surface's two coefficients of friction, or else the default.

    One coefficient is enough, because MuJoCo's friction is the same in all directions.
    """
    if surface.friction is not None:
        return max(min(surface.friction.mu, surface.friction.mu2), 0.0)
    return _DEFAULT_FRICTION


def get_grip(surface: Surface) -> float:
    """Return the higher of a surface's two coefficients of friction, or else the default.

    This coefficient applies to driven wheels, because their lower coefficient describes side slip.
    """
    if surface.friction is not None:
        return max(surface.friction.mu, surface.friction.mu2, 0.0)
    return _DEFAULT_FRICTION


def make_slippery(geom: Any) -> None:
    """Make a geom frictionless and soft like a caster, so that other geoms bear the load."""
    geom.condim = 1
    make_soft(geom)
    geom.priority = _compute_priority(0.0)


def make_frictionless(geom: Any, step: float) -> None:
    """Make a geom frictionless and hard, so that it bears load as a wheel does.

    Args:
        geom: the geom.
        step: the time step of the simulation in s.
    """
    geom.condim = 1
    make_wheel(geom, step)
    geom.priority = _compute_priority(0.0)


def make_soft(geom: Any) -> None:
    """Make the contact of a geom slightly soft, so that adjacent wheels bear the load."""
    geom.solref = list(_SOFT_SOLREF)


def make_wheel(geom: Any, step: float, grip: float | None = None) -> None:
    """Make the contacts of a geom hard, with priority over a ground of equal friction.

    As a wheel, the geom then rolls without slipping.

    Args:
        geom: the geom.
        step: the time step of the simulation in s.
        grip: the coefficient of friction; None to keep the current one.
    """
    if grip is not None:
        geom.friction = [min(max(grip, _MIN_FRICTION), _MAX_FRICTION), *geom.friction[1:]]
        geom.priority, geom.condim = _compute_priority(grip), max(geom.condim, 3)
    geom.solref = [_HARD_TIME_STEPS * step, 1.0]
    geom.solimp = list(_HARD_SOLIMP)
    geom.priority += 1


def _compute_priority(mu: float) -> int:
    return 2 * round(1e6 / (1.0 + mu))


def _get_contact_patch_radius(surface: Surface) -> float:
    """Return the radius in m of the contact patch of a surface with torsional friction.

    MuJoCo's coefficient of torsional friction is a length, the product of SDF's coefficient and this radius.
    """
    torsional = surface.torsional
    assert torsional is not None
    return max(torsional.patch_radius if torsional.use_patch_radius else torsional.surface_radius, 1e-3)
