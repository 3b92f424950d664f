"""Compare maps: the settings in YAML, the size, and the changed cells of the image."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import LinkwrightError, Phrase, joined, phrase
from linkwright.navigation.maps.images import read_image
from linkwright.navigation.maps.map_yaml import MapYaml, read_map_yaml
from linkwright.review.changes import Figure
from linkwright.review.file_pair import FilePair
from linkwright.review.texts.list_changes import change_text
from linkwright.review.versions import Version

IMAGE_SUFFIXES = (".pgm", ".png", ".bmp", ".jpg", ".jpeg", ".gif")
"""The name endings of files that can be the image of a map."""
_KEY_PATTERNS = tuple(re.compile(rf"^{key}\s*:", re.MULTILINE) for key in ("image", "resolution", "origin"))
_MAX_YAML_BYTES = 100_000
_MAX_YAML_FILES = 100
"""The maximum number of YAML files in a folder that are searched for the map of an image."""


def is_map(file: Path) -> bool:
    """Return whether a YAML file describes a map."""
    try:
        if file.stat().st_size > _MAX_YAML_BYTES:
            return False
        text = file.read_text("utf-8", errors="replace")
    except OSError:
        return False
    return all(key.search(text) for key in _KEY_PATTERNS)


def find_map_of_image(version: Version, path: str) -> str | None:
    """Return the path of the map for an image in the same folder; None if there is none."""
    file = version.file(path)
    if PurePosixPath(path).suffix.lower() not in IMAGE_SUFFIXES:
        return None
    for yaml_file in sorted(file.parent.glob("*.y*ml"))[:_MAX_YAML_FILES]:
        if (
            is_map(yaml_file)
            and _try_read_map_yaml(yaml_file) is not None
            and read_map_yaml(yaml_file).image.name == file.name
        ):
            return version.relative(yaml_file)
    return None


def map_contents(version: Version, path: str) -> Phrase | None:
    """Return the image, size, resolution and origin of a map.

    Raises:
        LinkwrightError: the YAML file does not describe a map.
    """
    content = read_map_yaml(version.file(path))
    size = _format_size(content)
    parts: list[Phrase | str] = [content.image.name, *([size] if size else [])]
    parts.append(phrase("resolution {resolution} m", resolution=f"{content.resolution:g}"))
    parts.append(phrase("origin {origin}", origin=_format_numbers(content.origin)))
    return joined(parts)


def compare_map_files(pair: FilePair) -> None:
    """Compare two versions of a map: its settings, and its image."""
    maps = pair.read(read_map_yaml)
    if maps is None:
        return
    for name, old_text, new_text in _pair_settings(*maps):
        if old_text != new_text:
            pair.add(change_text(name, old_text, new_text), None)
    old_size, new_size = (_format_size(content) for content in maps)
    if old_size and new_size and str(old_size) != str(new_size):
        pair.figures.append(Figure(phrase("size of the map"), str(old_size), str(new_size)))
    old_image, new_image = (_try_read_cells(content.image) for content in maps)
    if old_image is not None and new_image is not None and old_image.shape == new_image.shape:
        _compare_cells(pair, old_image, new_image)


def _pair_settings(old: MapYaml, new: MapYaml) -> Iterator[tuple[str, str, str]]:
    yield "image", old.image.name, new.image.name
    yield "resolution", f"{old.resolution:g} m", f"{new.resolution:g} m"
    yield "origin", _format_numbers(old.origin), _format_numbers(new.origin)
    yield "negate", str(old.negate).lower(), str(new.negate).lower()
    yield "occupied_thresh", f"{old.occupied_thresh:g}", f"{new.occupied_thresh:g}"
    yield "free_thresh", f"{old.free_thresh:g}", f"{new.free_thresh:g}"
    yield "mode", old.mode.value, new.mode.value


def _format_numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:g}" for value in values)


def _try_read_map_yaml(file: Path) -> MapYaml | None:
    try:
        return read_map_yaml(file)
    except LinkwrightError:
        return None


def _format_size(content: MapYaml) -> Phrase | None:
    """Return the size of a map in cells and in meters, or None if its image cannot be read."""
    image = _try_read_cells(content.image)
    if image is None:
        return None
    rows, columns = image.shape
    width, height = (f"{count * content.resolution:g}" for count in (columns, rows))
    return phrase(
        "{columns} x {rows} cells ({width} x {height} m)", columns=columns, rows=rows, width=width, height=height
    )


def compare_maps(pair: FilePair) -> None:
    """Compare two versions of an image that no YAML file describes as a map, cell by cell."""
    images = pair.read(_read_cells)
    if images is None:
        return
    old, new = images
    if old.shape != new.shape:
        old_text, new_text = (f"{image.shape[1]} x {image.shape[0]}" for image in images)
        pair.figures.append(Figure(phrase("size of the map"), old_text, new_text, "cells"))
        return
    if not _compare_cells(pair, old, new):
        pair.add(phrase("contents changed, with the same cells"), None)


def _compare_cells(pair: FilePair, old: NDArray[np.uint8], new: NDArray[np.uint8]) -> bool:
    """Report how many cells differ and where, and return whether there are any."""
    rows, columns = np.nonzero(old != new)
    if not len(rows):
        return False
    text = phrase(
        "{share:.2g} % of the cells changed, in columns {left} to {right} and rows {top} to {bottom} of the image",
        share=100.0 * len(rows) / old.size,
        left=int(columns.min()),
        right=int(columns.max()),
        top=int(rows.min()),
        bottom=int(rows.max()),
    )
    pair.add(text, None)
    return True


def _try_read_cells(file: Path) -> NDArray[np.uint8] | None:
    """Return the brightness of the cells; None for an unreadable image.

    An example is a Git LFS pointer.
    """
    try:
        return _read_cells(file)
    except (LinkwrightError, OSError):
        return None


def _read_cells(file: Path) -> NDArray[np.uint8]:
    """Return the brightness of the cells, 0 to 255, shape (rows, columns), which is the same in all image formats."""
    return np.rint(255.0 * read_image(file).shade).astype(np.uint8)
