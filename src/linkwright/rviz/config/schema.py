"""Property declarations: names, kinds, defaults and bounds, and the validation of values.

A `PropertySpec` determines the row of the property in the page, its form in the .rviz file, and the valid values. Names
and defaults are the same as in RViz, and so is the clamping of numbers to their bounds.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import dataclass

from linkwright.diagnostics import phrase
from linkwright.page.protocol.configuration import PropertyKind, PropertyValue, RowDetails

Path = tuple[str, ...]

FIXED_FRAME = "<Fixed Frame>"
"""The value of a frame property that refers to the Fixed Frame, as in RViz."""

MAX_TEXT_LENGTH = 4096
"""The length of the longest string that is accepted from a page, in characters."""

_HEX_COLOR = re.compile(r"#[0-9a-fA-F]{6}")
_SHORT_COLOR = re.compile(r"#[0-9a-fA-F]{3}")
_RVIZ_COLOR = re.compile(r"([+-]?\d{1,6})\s*;\s*([+-]?\d{1,6})\s*;\s*([+-]?\d{1,6})\s*(;.*)?")
_YAML_NUMBER = re.compile(r"[+-]?\.(inf|nan)", re.IGNORECASE)
_INFINITY_SUBSTITUTE = 3.4028234663852886e38
"""The largest 32-bit float, which replaces infinity as in RViz, because JSON cannot represent infinity."""
_BOOLEANS = dict.fromkeys(("true", "1", "yes", "on"), True) | dict.fromkeys(("false", "", "0"), False)


@dataclass(frozen=True, slots=True)
class PropertySpec:
    """The declaration of a property.

    Attributes:
        name: the name that RViz shows, which is also the key in the file.
        kind: the kind of its values; a ``group`` has no value.
        default: the default value, as in RViz.
        description: the tooltip.
        options: the values of an ``enum``.
        minimum: the lower bound of an ``int`` or ``float``, inclusive.
        maximum: the upper bound of an ``int`` or ``float``, inclusive.
        messages: for a ``topic``, the message types of the topics that the page offers; by default the display's
            types.
        name_words: for a ``topic``, lower-case words; the page offers only topics with a name that contains at least
            one of them; by default it offers all.
        children: the rows below the property's row.
        when: the condition for this row to be shown: the path of another property of the display, and the value that it
            must have. The condition of that property must also hold.
        expanded: whether the children are shown at the start.
        nested: whether the file stores the value under ``Value``, because the key has children in the file.
        hidden: whether the property has a value in the file but no row in the page, as for properties that RViz hides.
        read_only: whether only the program sets the property; it is not stored in the file.
        details: the subject of the read-only rows that a page adds below this row, see `Property`.
    """

    name: str
    kind: PropertyKind
    default: PropertyValue = None
    description: str = ""
    options: tuple[str, ...] = ()
    minimum: float | None = None
    maximum: float | None = None
    messages: tuple[str, ...] = ()
    name_words: tuple[str, ...] = ()
    children: tuple[PropertySpec, ...] = ()
    when: tuple[tuple[str, ...], PropertyValue] | None = None
    expanded: bool = False
    nested: bool = False
    hidden: bool = False
    read_only: bool = False
    details: RowDetails | None = None


Schema = tuple[PropertySpec, ...]


def vector_spec(name: str, description: str) -> PropertySpec:
    """Return the declaration of a group with the float properties X, Y and Z in meters.

    The defaults are 0, as in RViz's VectorProperty.
    """
    return PropertySpec(
        name, "group", description=description, children=tuple(PropertySpec(axis, "float", 0.0) for axis in "XYZ")
    )


IS_BILLBOARDS = (("Line Style",), "Billboards")
"""The condition for a property of the line width, as a `PropertySpec.when`."""


def alpha(
    description: str = "Opacity: 0 is invisible.", default: float = 1.0, when: tuple[Path, str] | None = None
) -> PropertySpec:
    """Return the declaration of the property ``Alpha``, the opacity from 0 to 1."""
    return PropertySpec("Alpha", "float", default, description, minimum=0.0, maximum=1.0, when=when)


def length_spec(name: str, default: float, description: str, when: tuple[Path, str] | None = None) -> PropertySpec:
    """Return the declaration of a property for a length in meters."""
    return PropertySpec(name, "float", default, description, when=when)


def line_style_spec(*children: PropertySpec) -> PropertySpec:
    """Return the declaration of ``Line Style``: lines of one pixel, or billboards with a width."""
    return PropertySpec(
        "Line Style",
        "enum",
        "Lines",
        "Lines are one pixel wide; billboards have a width in meters.",
        options=("Lines", "Billboards"),
        children=children,
    )


def line_width_spec() -> PropertySpec:
    """Return the declaration of ``Line Width`` in meters.

    The property is shown only for lines drawn as billboards.
    """
    return PropertySpec(
        "Line Width", "float", 0.03, "Width of the lines, in meters.", minimum=0.001, when=IS_BILLBOARDS
    )


def accept_value(spec: PropertySpec, value: object) -> PropertyValue:
    """Return the value to store for a value sent by a page.

    The value is checked against the property's kind. Numbers are converted and clamped to the bounds.

    Raises:
        ValueError: the property does not accept the value; the message states the expected value.
    """
    if spec.read_only:
        raise ValueError("the property is read-only")
    accepted_value = _validate(spec, value)
    if accepted_value is None:
        raise ValueError(
            phrase(
                "{format}, not {value}",
                format=_EXPECTATIONS[spec.kind].format(options=", ".join(spec.options)),
                value=_shortened_repr(value),
            )
        )
    return accepted_value


def value_from_text(spec: PropertySpec, text: str) -> PropertyValue:
    """Return the value that a scalar of a .rviz file represents.

    Raises:
        ValueError: the text is not a valid value; the message states the expected value.
    """
    return accept_value(spec, _read_as_qt(spec, text.strip()))


def fallback_value(spec: PropertySpec) -> PropertyValue:
    """Return the value used for invalid text: true for a ``bool``, otherwise the default.

    Qt, and therefore RViz, reads every text as true except ``false``, ``0`` and an empty string; even ``no`` is true.
    """
    return True if spec.kind == "bool" else spec.default


def is_on(text: str) -> bool:
    """Return whether RViz reads the text of a check box as true. See `fallback_value`."""
    return _BOOLEANS.get(text.strip().lower(), True)


def value_to_text(spec: PropertySpec, value: PropertyValue) -> str:
    """Return the spelling of a value in a .rviz file."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        text = repr(value)
        mantissa, exponent, power = text.partition("e")
        return f"{mantissa}.0e{power}" if exponent and "." not in mantissa else text
    if spec.kind == "color" and isinstance(value, str):
        return "; ".join(str(int(value[start : start + 2], 16)) for start in (1, 3, 5))
    return str(value)


_EXPECTATIONS = {
    "group": phrase("no value is expected"),
    "bool": phrase("true or false is expected"),
    "int": phrase("an integer is expected"),
    "float": phrase("a finite number is expected"),
    "string": phrase("a string of at most {maximum_text} characters is expected", maximum_text=MAX_TEXT_LENGTH),
    "color": "a color such as #a0a0a4 is expected",
    "enum": "one of {options} is expected",
    "frame": phrase("the name of a frame is expected"),
    "topic": phrase("the name of a topic is expected"),
}


def _validate(spec: PropertySpec, value: object) -> PropertyValue:
    kind = spec.kind
    if kind == "bool":
        return value if isinstance(value, bool) else None
    if kind in ("int", "float"):
        return _accept_number(spec, value)
    if not isinstance(value, str) or len(value) > MAX_TEXT_LENGTH or kind == "group":
        return None
    if kind == "enum":
        return value if value in spec.options else None
    if kind == "color":
        return value.lower() if _HEX_COLOR.fullmatch(value) else None
    if kind == "frame":
        return value.strip().removeprefix("/") or None  # tf2 frame names have no leading slash; RViz strips it too
    return value


def _accept_number(spec: PropertySpec, value: object) -> int | float | None:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    if not math.isfinite(number):
        return None
    if spec.minimum is not None:
        number = max(number, float(spec.minimum))
    if spec.maximum is not None:
        number = min(number, float(spec.maximum))
    if spec.kind == "float":
        return number
    return int(number) if number.is_integer() and abs(number) < 2**53 else None


def _read_as_qt(spec: PropertySpec, text: str) -> object:
    """Return the value that Qt reads from a text.

    Text that Qt cannot read is returned unchanged, and `accept_value` rejects it.
    """
    kind = spec.kind
    if kind == "bool":
        return _BOOLEANS.get(text.lower(), text)
    if kind in ("int", "float"):
        return _parse_number(spec, text)
    if kind == "color":
        return _parse_color(text)
    return text


def _parse_number(spec: PropertySpec, text: str) -> object:
    if "_" in text or not text.isascii():
        return text  # Python accepts these numbers, but Qt does not
    try:
        number = float(text.replace(".", "", 1) if _YAML_NUMBER.fullmatch(text) else text)
    except ValueError:
        return text
    if math.isnan(number):
        return spec.default  # RViz writes NaN when its camera has an invalid pose, and nothing could be drawn with NaN
    return number if math.isfinite(number) else math.copysign(_INFINITY_SUBSTITUTE, number)


def _parse_color(text: str) -> str:
    match = _RVIZ_COLOR.fullmatch(text)
    if match:  # a fourth number, such as alpha, is ignored
        return "#" + "".join(f"{min(max(int(component), 0), 255):02x}" for component in match.groups()[:3])
    if _SHORT_COLOR.fullmatch(text):
        return "#" + "".join(2 * digit for digit in text[1:])
    if text.isalpha():
        import webcolors  # type: ignore[import-untyped]  # untyped; imported late, because names are rare

        with suppress(ValueError):
            return str(webcolors.name_to_hex(text))  # webcolors and Qt both know the color names of SVG
    return text


def _shortened_repr(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


SYSTEM_DEFAULT = "System Default"
FILTER_SIZE = "Filter size"


def topic_spec(
    name: str = "Topic",
    default: str = "",
    description: str = "The topic to subscribe to.",
    *,
    depth: int = 5,
    durability: str = "Volatile",
    filter_size: int | None = None,
    durability_help: str = "Whether to receive messages that were published before.",
    when: tuple[Path, str] | None = None,
    messages: tuple[str, ...] = (),
) -> PropertySpec:
    """Return the declaration of a topic property whose children are its quality of service.

    Args:
        name: the name of the property.
        default: the default topic.
        description: the tooltip.
        depth: the default of the queue size, as in RViz.
        durability: the default of the durability policy, as in RViz.
        filter_size: default number of messages that are queued until their transforms are available; None for a display
            without such a queue.
        durability_help: the tooltip of ``Durability Policy``.
        when: the condition of the row, see `PropertySpec.when`.
        messages: the message types of the topics that the page offers, see `PropertySpec.messages`.
    """
    children = [
        PropertySpec("Depth", "int", depth, "The size of the message queue.", minimum=1, maximum=1000),
        PropertySpec(
            "History Policy",
            "enum",
            "Keep Last",
            "Whether the queue keeps only the last messages, or all.",
            options=("Keep Last", "Keep All", SYSTEM_DEFAULT),
        ),
        PropertySpec(
            "Reliability Policy",
            "enum",
            "Reliable",
            "Whether every message must arrive, or may be lost.",
            options=("Reliable", "Best Effort", SYSTEM_DEFAULT),
        ),
        PropertySpec(
            "Durability Policy",
            "enum",
            durability,
            durability_help,
            options=("Volatile", "Transient Local", SYSTEM_DEFAULT),
        ),
    ]
    if filter_size is not None:
        children.append(
            PropertySpec(
                FILTER_SIZE,
                "int",
                filter_size,
                "The number of messages that may wait for their transforms.",
                minimum=1,
                maximum=1000,
            )
        )
    return PropertySpec(name, "topic", default, description, messages=messages, children=tuple(children), when=when)
