"""Assign classes to the objects in a world."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.files.yaml_documents import YamlDocument, read_source
from linkwright.geometry.arrays import Array
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.bodies import VISUAL_GROUP
from linkwright.simulation.sensors.mount import part_of
from linkwright.simulation.simulation import Simulation

_NUMBER = re.compile(r"[ _-]*(?:clone)?[ _-]*\(?\d+\)?$")
_COLOURS = frozenset(
    ("red", "green", "blue", "yellow", "orange", "purple", "pink", "white", "black", "grey", "gray", "brown", "cyan")
)
_BACKGROUND = frozenset(
    ("ground", "plane", "floor", "floors", "wall", "walls", "room", "rooms", "house", "building", "road", "roads")
)
"""Words in the names of models that are surroundings, not objects."""
_LARGEST = 4.0
"""The width in m from which a static model is taken for surroundings, unless a file of classes names it."""
_TOUCHING = 0.02
"""The distance in m up to which shapes are one object."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """An object with its own label.

    Attributes:
        name: the model, or ``model::link::visual``.
        label: the index of its class.
        geoms: the names of its geoms in MuJoCo's model.
    """

    name: str
    label: int
    geoms: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ClassRules:
    """Rules that assign classes to models or visuals.

    Attributes:
        patterns: for each class, glob patterns that match names of models, or names of the models that they were
            included from. Patterns with ``::`` match names of visuals, ``model::link::visual``. The position of a class
            is its number.
    """

    patterns: Mapping[str, tuple[str, ...]]

    def class_of(self, *names: str) -> int | None:
        """Return the number of the first class that has a pattern for one of the names; None if there is none."""
        for number, patterns in enumerate(self.patterns.values()):
            if any(fnmatchcase(name, pattern) for name in names for pattern in patterns):
                return number
        return None


def read_classes(path: Path) -> ClassRules:
    """Read class rules from a YAML file.

    An entry is ``class: pattern``, ``class: [pattern, ...]``, or ``class:``, whose pattern is the name of the class.

    Raises:
        LinkwrightError: VISION201, the file cannot be read, or has other content.
    """
    document = YamlDocument(read_source(path, phrase("file of classes"), "VISION201"), "VISION201")
    root = document.root
    if not isinstance(root, yaml.MappingNode) or not root.value:
        raise _wrong(document, root)
    patterns: dict[str, tuple[str, ...]] = {}
    for key, value in root.value:
        if not isinstance(key, yaml.ScalarNode) or not key.value.strip() or key.value in patterns:
            raise _wrong(document, key)
        entries = value.value if isinstance(value, yaml.SequenceNode) else [value]
        if not entries or not all(isinstance(entry, yaml.ScalarNode) for entry in entries):
            raise _wrong(document, value)
        patterns[key.value] = tuple(str(entry.value) or key.value for entry in entries)
    return ClassRules(patterns)


def _wrong(document: YamlDocument, node: yaml.Node | None) -> LinkwrightError:
    hint = phrase("write for example `ball: [football, '*_ball']`, with each name only once")
    return document.error(phrase("classes must be names with patterns of model names"), node, hint)


def usual_class(name: str) -> str:
    """Return the class of a model by its name without a colour and a final number: ``red_ball_2`` gives ``ball``."""
    words = [word for word in re.split(r"[ _-]+", _NUMBER.sub("", name.lower())) if word]
    plain = [word for word in words if word not in _COLOURS]
    return "_".join(plain or words) or name


def usual_rules(simulations: list[Simulation]) -> ClassRules:
    """Return default classes for worlds, sorted by name: all models except surroundings.

    An included model has the name in its own file.
    """
    patterns: dict[str, set[str]] = {}
    for simulation in simulations:
        for name, model in simulation.scene.models.items():
            if not _is_background(simulation, name, model.model):
                patterns.setdefault(usual_class(own_name(model.model)), set()).update((name, own_name(model.model)))
    return ClassRules({name: tuple(sorted(found)) for name, found in sorted(patterns.items())})


def objects_of(simulation: Simulation, rules: ClassRules) -> list[SceneObject]:
    """Return the objects of a world.

    A model is one object. If the rules name visuals of a model, named visuals that touch each other are one object.
    """
    objects: list[SceneObject] = []
    visuals = _visuals(simulation)
    boxes = geom_boxes(simulation.model, simulation.data)
    for name, held in simulation.scene.models.items():
        geoms = visuals.get(name, {})
        whole = rules.class_of(name, own_name(held.model))
        if whole is not None:
            found = tuple(geom for part in geoms.values() for geom in part)
            objects += [SceneObject(name, whole, found)] if found else []
            continue
        named: dict[int, list[str]] = {}
        for part in geoms:
            label = rules.class_of(part)
            if label is not None:
                named.setdefault(label, []).append(part)
        for label, parts in named.items():
            for group in _touching(parts, geoms, simulation.model, boxes):
                objects.append(SceneObject(group[0], label, tuple(geom for part in group for geom in geoms[part])))
    return objects


def own_name(model: Model) -> str:
    """Return the name of a model in its own file, even if it is included under another name."""
    return (model.element.attributes.get("name") if model.element is not None else None) or model.name


def geom_boxes(model: Any, data: Any) -> Array:
    """Return the axis-aligned bounding boxes of all geoms in the world: corners in m, shape (geoms, 2, 3)."""
    turned = data.geom_xmat.reshape(-1, 3, 3)
    middle = data.geom_xpos + np.einsum("gij,gj->gi", turned, model.geom_aabb[:, :3])
    half = np.einsum("gij,gj->gi", np.abs(turned), model.geom_aabb[:, 3:])
    boxes: Array = np.stack([middle - half, middle + half], axis=1)
    return boxes


def _visuals(simulation: Simulation) -> dict[str, dict[str, list[str]]]:
    """Return the geoms of each visual by name, for each model."""
    found: dict[str, dict[str, list[str]]] = {}
    for geom in range(simulation.model.ngeom):
        if simulation.model.geom_group[geom] == VISUAL_GROUP:
            name = simulation.model.geom(geom).name
            part = part_of(name).partition("#")[0]
            found.setdefault(part.partition(SEPARATOR)[0], {}).setdefault(part, []).append(name)
    return found


def _is_background(simulation: Simulation, name: str, model: Model) -> bool:
    words = set(re.split(r"[ _-]+", own_name(model).lower()))
    if words & _BACKGROUND:
        return True
    numbers = [simulation.model.geom(geom).id for part in _visuals(simulation).get(name, {}).values() for geom in part]
    if not numbers:
        return True
    if (simulation.model.geom_type[numbers] == load_mujoco().mjtGeom.mjGEOM_PLANE).any():
        return True
    boxes = geom_boxes(simulation.model, simulation.data)[numbers]
    width = boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)
    return model.static and bool((width[:2] > _LARGEST).any())


def _touching(parts: list[str], geoms: Mapping[str, list[str]], model: Any, boxes: Array) -> Iterator[list[str]]:
    """Yield groups of visuals whose bounding boxes touch each other."""
    left = list(parts)
    around = {part: boxes[[model.geom(geom).id for geom in geoms[part]]] for part in parts}
    around = {part: np.stack([each[:, 0].min(axis=0), each[:, 1].max(axis=0)]) for part, each in around.items()}
    while left:
        group, waiting = [], [left.pop(0)]
        while waiting:
            part = waiting.pop(0)
            group.append(part)
            near = [other for other in left if _meet(around[part], around[other])]
            waiting += near
            left = [other for other in left if other not in near]
        yield group


def _meet(one: Array, other: Array) -> bool:
    return bool((one[0] <= other[1] + _TOUCHING).all() and (other[0] <= one[1] + _TOUCHING).all())
