"""Comparison of models and their elements by content, regardless of form and position."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.plugins import Plugin
from linkwright.sdf.shapes import Heightmap, Mesh
from linkwright.xmltree import Element


def have_equal_content(first: Any, second: Any) -> bool:
    """Return whether two parsed elements of files, or tuples of elements, have equal content.

    Comments, whitespace and positions in the text are ignored. The parameters of plugins are compared as XML elements.
    For meshes with relative paths, the folders of the files must also be equal.
    """
    if first is second:
        return True
    if type(first) is not type(second):
        return False
    if isinstance(first, tuple):
        return len(first) == len(second) and all(map(have_equal_content, first, second))
    if not is_dataclass(first):
        return bool(first == second or (first != first and second != second))
    if isinstance(first, Plugin) and not _have_same_content(first.element, second.element):
        return False
    if isinstance(first, Visual | Collision) and _find_mesh_folder(first) != _find_mesh_folder(second):
        return False
    return all(
        have_equal_content(getattr(first, field.name), getattr(second, field.name))
        for field in fields(first)
        if field.compare
    )


def _have_same_content(first: Element | None, second: Element | None) -> bool:
    if first is None or second is None:
        return first is second
    return _list_content(first) == _list_content(second)


def _list_content(element: Element) -> tuple[object, ...]:
    children = tuple(map(_list_content, element.elements()))
    return element.tag, element.attributes, element.text().split(), children


def _find_mesh_folder(shape_element: Visual | Collision) -> Path | None:
    """Return the base folder of the path of an element's mesh, or None."""
    shape, element = shape_element.geometry, shape_element.element
    if not isinstance(shape, Mesh | Heightmap) or "://" in shape.uri or element is None or element.source is None:
        return None
    return Path(element.source.name).absolute().parent
