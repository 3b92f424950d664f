"""The colors of detection classes, the same in all displays."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

import yaml

from linkwright.diagnostics import foreign, phrase
from linkwright.images.color_words import find_rgb

Color: TypeAlias = tuple[int, int, int]

KNOWN_COLORS: dict[str, Color] = {
    "car": (255, 165, 0),
    "person": (0, 0, 255),
    "cyclist": (255, 255, 0),
    "motorcycle": (230, 230, 250),
}
"""The classes with fixed colors in vision_msgs_rviz_plugins."""

UNCLASSIFIED_COLOR: Color = (255, 22, 80)
"""The color of detections without a class, as in vision_msgs_rviz_plugins."""

_PALETTE: tuple[Color, ...] = (
    (230, 25, 75),
    (60, 180, 75),
    (255, 225, 25),
    (67, 133, 255),
    (245, 130, 48),
    (178, 80, 220),
    (66, 212, 244),
    (240, 50, 230),
    (191, 239, 69),
    (250, 170, 190),
    (70, 190, 180),
    (200, 130, 60),
)


def choose_class_color(name: str, table: Mapping[str, Color]) -> Color:
    """Return the color of a detection class.

    The color is the first that is found in the table, in vision_msgs_rviz_plugins, as a color word in the name, or
    in a palette. Detections without a class have the color `UNCLASSIFIED_COLOR`.
    """
    if not name:
        return UNCLASSIFIED_COLOR
    lower_name = name.lower()
    color = table.get(lower_name) or KNOWN_COLORS.get(lower_name) or find_rgb(name)
    return color or _PALETTE[zlib.crc32(name.encode()) % len(_PALETTE)]


def read_class_colors(path: str) -> dict[str, Color]:
    """Return the color table in a YAML file, with class names in lower case.

    An entry is ``NAME: {r: 255, g: 165, b: 0}``.

    Raises:
        ValueError: the file cannot be read, or does not contain such a table; the message gives the reason.
    """
    try:
        document = yaml.safe_load(Path(path).expanduser().read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(phrase("cannot read '{path}': {reason}", path=path, reason=foreign(error.strerror))) from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        reason = " ".join(str(error).split())
        raise ValueError(phrase("cannot read '{path}': {reason}", path=path, reason=foreign(reason))) from None
    if not isinstance(document, dict) or not all(_is_color(color) for color in document.values()):
        raise ValueError(
            phrase("'{path}' is not a table of colors: write entries such as 'ball: {{r: 255, g: 0, b: 0}}'", path=path)
        )
    return {str(name).lower(): (color["r"], color["g"], color["b"]) for name, color in document.items()}


def _is_color(value: object) -> bool:
    if not isinstance(value, dict):
        return False
    components = [value.get(part) for part in "rgb"]
    return all(isinstance(part, int) and 0 <= part <= 255 for part in components)
