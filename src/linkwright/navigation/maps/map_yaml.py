"""The YAML file of a map: image, resolution, origin, and the meaning of pixels.

The keys, their meanings and the required keys are the same as in nav2_map_server. Errors have a line and column. Two
rules are stricter than in nav2: the resolution must be greater than 0, and thresholds must be between 0 and 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import isfinite
from pathlib import Path

import yaml

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    SourceText,
    did_you_mean,
    phrase,
)
from linkwright.files.yaml_documents import YamlDocument, read_source

_REQUIRED_KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh")
_TRUE_WORDS = frozenset({"true", "yes", "on", "y"})
_FALSE_WORDS = frozenset({"false", "no", "off", "n"})


class MapMode(Enum):
    """The modes of conversion between pixels and cells."""

    TRINARY = "trinary"
    SCALE = "scale"
    RAW = "raw"


@dataclass(frozen=True, slots=True, kw_only=True)
class MapYaml:
    """The content of a map's YAML file.

    Attributes:
        image: the path of the image.
        resolution: the side of a cell, in meters.
        origin: x and y of the lower left corner in the frame of the map, in meters, and yaw, in radians.
        negate: whether white is occupied and black is free.
        occupied_thresh: the darkness above which a pixel is occupied, 0 to 1.
        free_thresh: the darkness below which a pixel is free, 0 to 1.
        mode: how pixels are converted to cells.
    """

    image: Path
    resolution: float
    origin: tuple[float, float, float]
    negate: bool
    occupied_thresh: float
    free_thresh: float
    mode: MapMode = MapMode.TRINARY


def read_map_yaml(path: str | Path) -> MapYaml:
    """Read a map's YAML file, and resolve the image's path relative to the file.

    Raises:
        LinkwrightError: NAV201, the file cannot be read; NAV202, the content is invalid.
    """
    if not str(path):
        raise LinkwrightError(Diagnostic("NAV201", phrase("YAML file name is empty, can't load!")))
    path = Path(path)
    return _Reader(read_source(path, phrase("map file"), "NAV201")).read(path)


class _Reader:
    """A parser of one YAML file of a map."""

    def __init__(self, source: SourceText) -> None:
        self._document = YamlDocument(source, "NAV202")
        self._nodes: dict[str, yaml.Node] = {}

    def read(self, path: Path) -> MapYaml:
        self._collect_keys()
        missing = [key for key in _REQUIRED_KEYS if key not in self._nodes]
        if missing:
            hint = did_you_mean(missing[0], [key for key in self._nodes if key not in _REQUIRED_KEYS])
            raise self._make_error(phrase("'{key}' is missing in the map", key=missing[0]), None, hint)
        origin = self._read_origin()
        return MapYaml(
            image=path.parent / self._read_text("image"),
            resolution=self._read_resolution(),
            origin=(origin[0], origin[1], origin[2]),
            negate=self._read_negate(),
            occupied_thresh=self._read_threshold("occupied_thresh"),
            free_thresh=self._read_threshold("free_thresh"),
            mode=self._read_mode(),
        )

    def _collect_keys(self) -> None:
        root = self._document.root
        if not isinstance(root, yaml.MappingNode):
            message = phrase(
                "the YAML file of a map must be a mapping with the keys {names}", names=", ".join(_REQUIRED_KEYS)
            )
            raise self._make_error(message, root)
        for key, value in root.value:
            if isinstance(key, yaml.ScalarNode):
                self._nodes.setdefault(key.value, value)

    def _read_text(self, key: str) -> str:
        node = self._nodes[key]
        if not isinstance(node, yaml.ScalarNode) or not node.value:
            raise self._make_error(phrase("'{key}' must be a file name", key=key), node)
        return str(node.value)

    def _parse_number(self, node: yaml.Node, key: str) -> float:
        try:
            value = float(node.value) if isinstance(node, yaml.ScalarNode) else None
        except ValueError:
            value = None
        if value is None or not isfinite(value):
            raise self._make_error(phrase("'{key}' must be a number", key=key), node)
        return value

    def _read_resolution(self) -> float:
        node = self._nodes["resolution"]
        value = self._parse_number(node, "resolution")
        if not value > 0.0:
            raise self._make_error(phrase("'resolution' must be more than 0 (meters per pixel)"), node)
        return value

    def _read_origin(self) -> list[float]:
        node = self._nodes["origin"]
        if not isinstance(node, yaml.SequenceNode):
            raise self._make_error(phrase("'origin' must be a list of x, y and yaw"), node)
        if len(node.value) != 3:
            message = phrase("'origin' must have 3 values (x, y, yaw), but has {count}", count=len(node.value))
            raise self._make_error(message, node)
        return [self._parse_number(number, "origin") for number in node.value]

    def _read_threshold(self, key: str) -> float:
        node = self._nodes[key]
        value = self._parse_number(node, key)
        if not 0.0 <= value <= 1.0:
            hint = phrase("write 0.65 for 65 %") if value > 1.0 else None
            raise self._make_error(phrase("'{key}' must be between 0 and 1", key=key), node, hint)
        return value

    def _read_negate(self) -> bool:
        node = self._nodes["negate"]
        text = str(node.value).lower() if isinstance(node, yaml.ScalarNode) else ""
        if text in _TRUE_WORDS or text in _FALSE_WORDS:
            return text in _TRUE_WORDS
        try:
            return int(text) != 0
        except ValueError:
            raise self._make_error(phrase("'negate' must be 0 or 1"), node) from None

    def _read_mode(self) -> MapMode:
        node = self._nodes.get("mode")
        if node is None:
            return MapMode.TRINARY
        text = str(node.value) if isinstance(node, yaml.ScalarNode) else ""
        mode_names = [map_mode.value for map_mode in MapMode]
        if text not in mode_names:
            message = phrase("'mode' must be one of {known}", known=", ".join(mode_names))
            raise self._make_error(message, node, did_you_mean(text, mode_names))
        return MapMode(text)

    def _make_error(self, message: Phrase, node: yaml.Node | None, hint: Phrase | None = None) -> LinkwrightError:
        return self._document.error(message, node, hint)
