"""The XML text of an ``<inertial>`` element."""

from __future__ import annotations

from linkwright.geometry.mass import MassProperties
from linkwright.urdf import Inertial

_DIGITS = 6
_ROUNDING = 1e-9
"""The fraction of the largest related number below which a number is a rounding error."""

Attributes = tuple[tuple[str, str], ...]


def inertial_parts(properties: MassProperties) -> tuple[tuple[str, Attributes], ...]:
    """Return the children of an ``<inertial>`` with their attributes, in document order.

    The axes are the link's axes. Numbers have six significant digits: the rounding is far smaller than the
    uncertainty of the shape, and keeps a valid tensor valid.
    """
    inertial = Inertial.of(properties)
    xyz = inertial.origin.xyz
    x, y, z = (
        _format_number(coordinate, 1.0) for coordinate in xyz
    )  # Round to nanometres; smaller differences are negligible.
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    moments = [getattr(inertial, name) for name in names]
    largest = max(abs(moment) for moment in moments)
    return (
        ("origin", (("xyz", f"{x} {y} {z}"), ("rpy", "0 0 0"))),
        ("mass", (("value", _format_number(inertial.mass, inertial.mass)),)),
        ("inertia", tuple((name, _format_number(value, largest)) for name, value in zip(names, moments, strict=True))),
    )


def inertial_block(properties: MassProperties, indent: str = "", step: str = "  ", newline: str = "\n") -> str:
    """Return an ``<inertial>`` element as text, without a final line break.

    Args:
        properties: the mass properties in the link frame.
        indent: the indentation of each line but the first.
        step: the additional indentation of the children.
        newline: the line break.
    """
    lines = ["<inertial>"]
    for tag, attributes in inertial_parts(properties):
        lines.append(f"{indent}{step}{empty_tag(tag, attributes)}")
    lines.append(f"{indent}</inertial>")
    return newline.join(lines)


def empty_tag(tag: str, attributes: Attributes) -> str:
    """Return the self-closing tag of an element whose attribute values are numbers.

    Numbers need no escaping.
    """
    return f"<{tag} " + " ".join(f'{name}="{value}"' for name, value in attributes) + "/>"


def _format_number(value: float, largest: float) -> str:
    if abs(value) <= _ROUNDING * abs(largest):
        return "0"
    return f"{value:.{_DIGITS}g}"
