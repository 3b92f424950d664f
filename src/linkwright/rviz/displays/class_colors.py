"""The colours of detection classes: a class name has the same colour wherever it is shown."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

import yaml

from linkwright.diagnostics import foreign, phrase
from linkwright.images.colour_words import paint_of

Color: TypeAlias = tuple[int, int, int]

KNOWN: dict[str, Color] = {
    "car": (255, 165, 0),
    "person": (0, 0, 255),
    "cyclist": (255, 255, 0),
    "motorcycle": (230, 230, 250),
}
"""The classes to which vision_msgs_rviz_plugins gives fixed colours."""

UNNAMED: Color = (255, 22, 80)
"""The colour of detections without a class, as in vision_msgs_rviz_plugins."""

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


def class_color(name: str, table: Mapping[str, Color]) -> Color:
    """Return the colour of a detection class.

    The colour is taken from the table, or else from vision_msgs_rviz_plugins, from a colour word in the name, or from a
    palette. Detections without a class have the colour `UNNAMED`.
    """
    if not name:
        return UNNAMED
    lower = name.lower()
    known = table.get(lower) or KNOWN.get(lower) or paint_of(name)
    return known or _PALETTE[zlib.crc32(name.encode()) % len(_PALETTE)]


def read_class_colors(path: str) -> dict[str, Color]:
    """Return the colour table in a YAML file, with class names in lower case.

    An entry is ``NAME: {r: 255, g: 165, b: 0}``.

    Raises:
        ValueError: the file cannot be read, or is not such a table; the message gives the reason.
    """
    try:
        document = yaml.safe_load(Path(path).expanduser().read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(phrase("cannot read '{path}': {reason}", path=path, reason=foreign(error.strerror))) from None
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        text = " ".join(str(error).split())
        raise ValueError(phrase("cannot read '{path}': {reason}", path=path, reason=foreign(text))) from None
    if not isinstance(document, dict) or not all(_is_color(color) for color in document.values()):
        raise ValueError(phrase("'{path}' contains no colours, such as: 'ball: {{r: 255, g: 0, b: 0}}'", path=path))
    return {str(name).lower(): (color["r"], color["g"], color["b"]) for name, color in document.items()}


def _is_color(value: object) -> bool:
    if not isinstance(value, dict):
        return False
    parts = [value.get(part) for part in "rgb"]
    return all(isinstance(part, int) and 0 <= part <= 255 for part in parts)
