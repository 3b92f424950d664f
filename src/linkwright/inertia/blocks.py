"""The text of an ``<inertial>`` element."""

from __future__ import annotations

from linkwright.geometry.mass import MassProperties
from linkwright.inertia.inertial import to_inertial

_DIGITS = 6
_NOTHING = 1e-9
"""A number smaller than this part of the largest beside it is rounding."""

Attributes = tuple[tuple[str, str], ...]


def inertial_parts(properties: MassProperties) -> tuple[tuple[str, Attributes], ...]:
    """The children of ``<inertial>`` with their attributes, in the order in which they are written.

    The axes are those of the link. Numbers have six significant digits, which keeps a valid tensor valid to far better
    than its shape is known.
    """
    inertial = to_inertial(properties)
    xyz = inertial.origin.xyz
    x, y, z = (_number(part, 1.0) for part in xyz)  # a nanometre is nothing
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    moments = [getattr(inertial, name) for name in names]
    largest = max(abs(moment) for moment in moments)
    return (
        ("origin", (("xyz", f"{x} {y} {z}"), ("rpy", "0 0 0"))),
        ("mass", (("value", _number(inertial.mass, inertial.mass)),)),
        ("inertia", tuple((name, _number(value, largest)) for name, value in zip(names, moments, strict=True))),
    )


def inertial_block(properties: MassProperties, indent: str = "", step: str = "  ", newline: str = "\n") -> str:
    """An ``<inertial>`` element as text, without a line end after it.

    Args:
        properties: in the link frame.
        indent: before each line but the first.
        step: before the children, besides.
        newline: between the lines.
    """
    lines = ["<inertial>"]
    for tag, attributes in inertial_parts(properties):
        lines.append(f"{indent}{step}{start_tag(tag, attributes)}")
    lines.append(f"{indent}</inertial>")
    return newline.join(lines)


def start_tag(tag: str, attributes: Attributes) -> str:
    """An element without content; values need no escaping, they are numbers."""
    return f"<{tag} " + " ".join(f'{name}="{value}"' for name, value in attributes) + "/>"


def _number(value: float, largest: float) -> str:
    if abs(value) <= _NOTHING * abs(largest):
        return "0"
    return f"{value:.{_DIGITS}g}"
