"""Paths of the mesh and heightmap files of worlds and models."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.models import Model
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.shapes import Heightmap, Mesh


def shapes_of(model: Model) -> Iterator[Visual | Collision]:
    """Yield all visuals and collisions of a model and its nested models."""
    for link in model.links:
        yield from link.visuals
        yield from link.collisions
    for inner in model.models:
        yield from shapes_of(inner)


def mesh_files(models: Iterable[Model], finder: ResourceFinder) -> tuple[Path, ...]:
    """Return the existing mesh and heightmap files of models, each once."""
    found: dict[Path, None] = {}
    for shape in (item for model in models for item in shapes_of(model)):
        if isinstance(shape.geometry, Mesh | Heightmap) and shape.element is not None and shape.element.source:
            path = finder.file(shape.geometry.uri, Path(shape.element.source.name).parent)
            if not isinstance(path, Missing):
                found[path] = None
    return tuple(found)
