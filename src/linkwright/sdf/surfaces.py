"""The element ``<surface>``: friction, restitution and stiffness of contacts.

Source of the elements and defaults: the SDFormat specification 1.12, ``surface.sdf``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from linkwright.geometry.single import Vector3
from linkwright.schema import AttributeRule, ElementRule
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR3, never_written, object_rule, value


@dataclass(frozen=True, slots=True)
class Friction:
    """The parameters of ODE's friction pyramid.

    Attributes:
        mu: the coefficient of Coulomb friction along `direction`.
        mu2: the coefficient perpendicular to `direction`.
        direction: the first friction direction in the frame of the collision, or in the frame `expressed_in`; zero lets
            the engine choose it.
        slip1: the slip velocity per force along `direction`, in m/s/N.
        slip2: the slip velocity per force perpendicular to `direction`, in m/s/N.
        expressed_in: the name of the frame of `direction`; empty for the frame of the collision.
    """

    mu: float = 1.0
    mu2: float = 1.0
    direction: Vector3 = (0.0, 0.0, 0.0)
    slip1: float = 0.0
    slip2: float = 0.0
    expressed_in: str = ""


@dataclass(frozen=True, slots=True)
class BulletFriction:
    """The friction coefficients for the physics engine Bullet."""

    friction: float = 1.0
    friction2: float = 1.0
    rolling_friction: float = 1.0


@dataclass(frozen=True, slots=True)
class TorsionalFriction:
    """Friction against rotation about the contact normal, with radii in meters."""

    coefficient: float = 1.0
    use_patch_radius: bool = True
    patch_radius: float = 0.0
    surface_radius: float = 0.0


@dataclass(frozen=True, slots=True)
class Contact:
    """The stiffness and damping of a contact in ODE.

    Attributes:
        soft_cfm: the constraint force mixing (CFM).
        soft_erp: the error reduction parameter (ERP): the fraction of the error that is corrected in a step.
        kp: the stiffness in N/m.
        kd: the damping in N s/m.
        max_vel: the maximum speed at which an overlap is corrected, in m/s.
        min_depth: the overlap in meters below which nothing is corrected.
    """

    soft_cfm: float = 0.0
    soft_erp: float = 0.2
    kp: float = 1e12
    kd: float = 1.0
    max_vel: float = 0.01
    min_depth: float = 0.0


@dataclass(frozen=True, slots=True)
class Surface:
    """The contact properties of a collision.

    Attributes:
        friction: friction for ODE; None if not specified.
        bullet_friction: friction for the engine Bullet; None if not specified.
        torsional: friction against rotation about the contact normal; None if not specified.
        contact: stiffness and damping; None if not specified.
        restitution: the fraction of the speed that remains after a bounce.
        bounce_threshold: the speed in m/s above which the collision bounces.
        collide_without_contact: whether contacts are reported without having an effect.
        collide_bitmask: selects other shapes: they collide if this mask shares a bit with their `category_bitmask`.
        category_bitmask: the bits that the collide masks of other shapes select.
    """

    friction: Friction | None = None
    bullet_friction: BulletFriction | None = None
    torsional: TorsionalFriction | None = None
    contact: Contact | None = None
    restitution: float = 0.0
    bounce_threshold: float = 100000.0
    collide_without_contact: bool = False
    collide_bitmask: int = 0xFFFF
    category_bitmask: int = 0xFFFF


DEFAULT_SURFACE = Surface()


@dataclass(frozen=True, slots=True)
class _FrictionGroup:
    ode: Friction | None
    bullet: BulletFriction | None
    torsional: TorsionalFriction | None


@dataclass(frozen=True, slots=True)
class _ContactGroup:
    ode: Contact | None = None
    collide_without_contact: bool = False
    collide_bitmask: int = 0xFFFF
    category_bitmask: int = 0xFFFF


@dataclass(frozen=True, slots=True)
class _Bounce:
    restitution: float = 0.0
    bounce_threshold: float = 100000.0


def _make_friction(mu: float, mu2: float, fdir1: tuple[Vector3, str] | None, slip1: float, slip2: float) -> Friction:
    direction, expressed_in = fdir1 or ((0.0, 0.0, 0.0), "")
    return Friction(mu, mu2, direction, slip1, slip2, expressed_in)


def _direction_with_frame(direction: Vector3, old: str, new: str) -> tuple[Vector3, str]:
    return direction, new or old


def _make_surface(friction: _FrictionGroup | None, contact: _ContactGroup | None, bounce: _Bounce | None) -> Surface:
    contact_group = contact or _ContactGroup(
        None, collide_without_contact=False, collide_bitmask=0xFFFF, category_bitmask=0xFFFF
    )
    bounce_values = bounce or _Bounce(0.0, 100000.0)
    return Surface(
        friction.ode if friction else None,
        friction.bullet if friction else None,
        friction.torsional if friction else None,
        contact_group.ode,
        bounce_values.restitution,
        bounce_values.bounce_threshold,
        contact_group.collide_without_contact,
        contact_group.collide_bitmask,
        contact_group.category_bitmask,
    )


_Group = TypeVar("_Group")


def _unless_default(group: _Group, default: _Group) -> _Group | None:
    """Return a group of values for writing, or None if all of them are the defaults."""
    return None if group == default else group


def _friction_group(surface: Surface) -> _FrictionGroup | None:
    group = _FrictionGroup(surface.friction, surface.bullet_friction, surface.torsional)
    return _unless_default(group, _FrictionGroup(None, None, None))


def _contact_group(surface: Surface) -> _ContactGroup | None:
    group = _ContactGroup(
        surface.contact, surface.collide_without_contact, surface.collide_bitmask, surface.category_bitmask
    )
    return _unless_default(group, _ContactGroup())


_ODE_FRICTION = object_rule(
    _make_friction,
    "ode",
    "the friction in ODE",
    value("mu", NUMBER, "the coefficient of Coulomb friction", default="1"),
    value("mu2", NUMBER, "the coefficient perpendicular to the first direction", default="1"),
    ElementRule(
        "fdir1",
        "the first friction direction",
        (
            AttributeRule(
                "gz:expressed_in",
                TEXT,
                "the frame of the direction",
                default="",
                field="new",
                get=lambda friction: friction.expressed_in,
            ),
            AttributeRule(
                "ignition:expressed_in", TEXT, "the frame of the direction", default="", field="old", get=never_written
            ),
        ),
        text=AttributeRule(
            "text",
            VECTOR3,
            "the direction",
            default="0 0 0",
            field="direction",
            get=lambda friction: friction.direction,
        ),
        make=_direction_with_frame,
        get=lambda friction: friction if any(friction.direction) or friction.expressed_in else None,
    ),
    value("slip1", NUMBER, "the slip velocity per force along the first direction", "m/s/N", default="0"),
    value("slip2", NUMBER, "the slip velocity per force perpendicular to it", "m/s/N", default="0"),
)

SURFACE = object_rule(
    _make_surface,
    "surface",
    "the contact properties of a collision",
    object_rule(
        _FrictionGroup,
        "friction",
        "the friction",
        _ODE_FRICTION,
        object_rule(
            BulletFriction,
            "bullet",
            "the friction in Bullet",
            value("friction", NUMBER, "the coefficient of Coulomb friction", default="1"),
            value("friction2", NUMBER, "the coefficient perpendicular to the first direction", default="1"),
            value("rolling_friction", NUMBER, "the coefficient of rolling friction", default="1"),
        ),
        object_rule(
            TorsionalFriction,
            "torsional",
            "the friction against rotation about the contact normal",
            value("coefficient", NUMBER, "the coefficient of torsional friction", default="1"),
            value("use_patch_radius", TRUTH, "whether to use patch_radius instead of surface_radius", default="true"),
            value("patch_radius", NUMBER, "the radius of the contact patch", "m", default="0"),
            value("surface_radius", NUMBER, "the radius of the surface at the contact", "m", default="0"),
        ),
        get=_friction_group,
    ),
    object_rule(
        _ContactGroup,
        "contact",
        "the stiffness, and the shapes that may touch",
        object_rule(
            Contact,
            "ode",
            "the stiffness and damping in ODE",
            value("soft_cfm", NUMBER, "the constraint force mixing", default="0"),
            value("soft_erp", NUMBER, "the fraction of the error that is corrected in a step", default="0.2"),
            value("kp", NUMBER, "the stiffness", "N/m", default="1e12"),
            value("kd", NUMBER, "the damping", "N s/m", default="1"),
            value("max_vel", NUMBER, "the maximum speed at which an overlap is corrected", "m/s", default="0.01"),
            value("min_depth", NUMBER, "the overlap below which nothing is corrected", "m", default="0"),
        ),
        value("collide_without_contact", TRUTH, "whether contacts are reported without an effect", default="false"),
        value("collide_bitmask", INTEGER, "the category bits of the shapes that collide", default="65535"),
        value("category_bitmask", INTEGER, "the bits that other shapes' collide_bitmask selects", default="65535"),
        get=_contact_group,
    ),
    object_rule(
        _Bounce,
        "bounce",
        "the bounce of the collision",
        value(
            "restitution_coefficient",
            NUMBER,
            "the fraction of the speed that remains after a bounce",
            default="0",
            field="restitution",
        ),
        value("threshold", NUMBER, "the minimum speed of a bounce", "m/s", default="100000", field="bounce_threshold"),
        get=lambda surface: _unless_default(_Bounce(surface.restitution, surface.bounce_threshold), _Bounce()),
    ),
    default=DEFAULT_SURFACE,
)
