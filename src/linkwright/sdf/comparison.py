"""Compares parts of models for equal content, regardless of how and where they were written."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.plugins import Plugin
from linkwright.sdf.shapes import Heightmap, Mesh
from linkwright.xmltree import Element


def alike(one: Any, other: Any) -> bool:
    """Return whether two parsed parts of a file, or tuples of parts, have equal content.

    Comments, whitespace and positions in the text are ignored. Parameters of plugins are compared in their elements.
    The folders of files are compared where parts name meshes by relative paths.
    """
    if one is other:
        return True
    if type(one) is not type(other):
        return False
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(alike, one, other))
    if not is_dataclass(one):
        return bool(one == other or (one != one and other != other))
    if isinstance(one, Plugin) and not _same_elements(one.element, other.element):
        return False
    if isinstance(one, Visual | Collision) and _folder(one) != _folder(other):
        return False
    return all(alike(getattr(one, field.name), getattr(other, field.name)) for field in fields(one) if field.compare)


def _same_elements(one: Element | None, other: Element | None) -> bool:
    if one is None or other is None:
        return one is other
    return _content(one) == _content(other)


def _content(element: Element) -> tuple[object, ...]:
    inside = tuple(map(_content, element.elements()))
    return element.tag, element.attributes, element.text().split(), inside


def _folder(part: Visual | Collision) -> Path | None:
    """Return the folder to which a part's mesh path is relative; None if there is no such path."""
    shape, element = part.geometry, part.element
    if not isinstance(shape, Mesh | Heightmap) or "://" in shape.uri or element is None or element.source is None:
        return None
    return Path(element.source.name).absolute().parent
