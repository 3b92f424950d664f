"""Lookup of the mesh and heightmap files that models use."""

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
    for nested_model in model.models:
        yield from shapes_of(nested_model)


def find_mesh_files(models: Iterable[Model], finder: ResourceFinder) -> tuple[Path, ...]:
    """Return the existing mesh and heightmap files of models, without duplicates."""
    paths: dict[Path, None] = {}
    for shape in (model_shape for model in models for model_shape in shapes_of(model)):
        if isinstance(shape.geometry, Mesh | Heightmap) and shape.element is not None and shape.element.source:
            path = finder.file(shape.geometry.uri, Path(shape.element.source.name).parent)
            if not isinstance(path, Missing):
                paths[path] = None
    return tuple(paths)
