"""The classes of the objects in a world."""

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
from linkwright.simulation.sensors.mount import get_part_name
from linkwright.simulation.simulation import Simulation

_NUMBER_SUFFIX = re.compile(r"[ _-]*(?:clone)?[ _-]*\(?\d+\)?$")
_COLOR_WORDS = frozenset(
    ("red", "green", "blue", "yellow", "orange", "purple", "pink", "white", "black", "grey", "gray", "brown", "cyan")
)
_BACKGROUND_WORDS = frozenset(
    ("ground", "plane", "floor", "floors", "wall", "walls", "room", "rooms", "house", "building", "road", "roads")
)
"""Words in the names of models that are surroundings, not objects."""
_MAX_OBJECT_WIDTH_M = 4.0
"""The width in m above which a static model is part of the surroundings, unless a file of classes names it."""
_MAX_GAP_M = 0.02
"""The maximum gap in m between visuals that form one object."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """An object of a world that gets one label.

    Attributes:
        name: the name of the model, or ``model::link::visual``.
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
        patterns: for each class, glob patterns that match the name of a model, or the name of an included model in
            its own file. Patterns with ``::`` match visuals, ``model::link::visual``. The position of a class
            is its number.
    """

    patterns: Mapping[str, tuple[str, ...]]

    def find_class_number(self, *names: str) -> int | None:
        """Return the number of the first class with a pattern that matches a name, or None."""
        for index, patterns in enumerate(self.patterns.values()):
            if any(fnmatchcase(name, pattern) for name in names for pattern in patterns):
                return index
        return None


def read_classes(path: Path) -> ClassRules:
    """Read class rules from a YAML file.

    An entry is ``class: pattern``, ``class: [pattern, ...]``, or ``class:``, where the class name is the pattern.

    Raises:
        LinkwrightError: VISION201, the file cannot be read, or has other content.
    """
    document = YamlDocument(read_source(path, phrase("file of classes"), "VISION201"), "VISION201")
    root = document.root
    if not isinstance(root, yaml.MappingNode) or not root.value:
        raise _invalid_classes_error(document, root)
    patterns: dict[str, tuple[str, ...]] = {}
    for key, value in root.value:
        if not isinstance(key, yaml.ScalarNode) or not key.value.strip() or key.value in patterns:
            raise _invalid_classes_error(document, key)
        entries = value.value if isinstance(value, yaml.SequenceNode) else [value]
        if not entries or not all(isinstance(entry, yaml.ScalarNode) for entry in entries):
            raise _invalid_classes_error(document, value)
        patterns[key.value] = tuple(str(entry.value) or key.value for entry in entries)
    return ClassRules(patterns)


def _invalid_classes_error(document: YamlDocument, node: yaml.Node | None) -> LinkwrightError:
    hint = phrase("write for example `ball: [football, '*_ball']`, with each name only once")
    return document.error(phrase("a class file must map class names to patterns of model names"), node, hint)


def derive_class(name: str) -> str:
    """Return the class for a model name, such as ``ball`` for ``red_ball_2``.

    The class is the name in lower case, without colors and final number.
    """
    words = [word for word in re.split(r"[ _-]+", _NUMBER_SUFFIX.sub("", name.lower())) if word]
    words_without_colors = [word for word in words if word not in _COLOR_WORDS]
    return "_".join(words_without_colors or words) or name


def make_default_rules(simulations: list[Simulation]) -> ClassRules:
    """Return default class rules for worlds, with a class for each model except surroundings.

    The classes are sorted by name. For an included model, the name in its own file determines the class.
    """
    patterns: dict[str, set[str]] = {}
    for simulation in simulations:
        for name, model in simulation.scene.models.items():
            if not _is_background(simulation, name, model.model):
                patterns.setdefault(derive_class(get_original_name(model.model)), set()).update(
                    (name, get_original_name(model.model))
                )
    return ClassRules({name: tuple(sorted(names)) for name, names in sorted(patterns.items())})


def find_objects(simulation: Simulation, rules: ClassRules) -> list[SceneObject]:
    """Return the objects of a world.

    A model with a class is one object. If the rules name visuals of a model, visuals that touch are one object.
    """
    objects: list[SceneObject] = []
    visuals = _list_geoms_by_visual(simulation)
    boxes = compute_geom_boxes(simulation.model, simulation.data)
    for name, scene_model in simulation.scene.models.items():
        geoms = visuals.get(name, {})
        model_label = rules.find_class_number(name, get_original_name(scene_model.model))
        if model_label is not None:
            geom_names = tuple(geom for part in geoms.values() for geom in part)
            objects += [SceneObject(name, model_label, geom_names)] if geom_names else []
            continue
        visuals_by_label: dict[int, list[str]] = {}
        for visual in geoms:
            label = rules.find_class_number(visual)
            if label is not None:
                visuals_by_label.setdefault(label, []).append(visual)
        for label, visuals_of_label in visuals_by_label.items():
            for group in _group_touching_visuals(visuals_of_label, geoms, simulation.model, boxes):
                objects.append(SceneObject(group[0], label, tuple(geom for part in group for geom in geoms[part])))
    return objects


def get_original_name(model: Model) -> str:
    """Return the name of a model in its own file, even if it is included under another name."""
    return (model.element.attributes.get("name") if model.element is not None else None) or model.name


def compute_geom_boxes(model: Any, data: Any) -> Array:
    """Return the axis-aligned boxes of all geoms in world coordinates.

    The corners are in m, and the shape is (geoms, 2, 3).
    """
    rotations = data.geom_xmat.reshape(-1, 3, 3)
    centers = data.geom_xpos + np.einsum("gij,gj->gi", rotations, model.geom_aabb[:, :3])
    half_sizes = np.einsum("gij,gj->gi", np.abs(rotations), model.geom_aabb[:, 3:])
    boxes: Array = np.stack([centers - half_sizes, centers + half_sizes], axis=1)
    return boxes


def _list_geoms_by_visual(simulation: Simulation) -> dict[str, dict[str, list[str]]]:
    """Return the names of the geoms of each visual, by model and visual."""
    visuals: dict[str, dict[str, list[str]]] = {}
    for geom in range(simulation.model.ngeom):
        if simulation.model.geom_group[geom] == VISUAL_GROUP:
            name = simulation.model.geom(geom).name
            visual = get_part_name(name).partition("#")[0]
            visuals.setdefault(visual.partition(SEPARATOR)[0], {}).setdefault(visual, []).append(name)
    return visuals


def _is_background(simulation: Simulation, name: str, model: Model) -> bool:
    words = set(re.split(r"[ _-]+", get_original_name(model).lower()))
    if words & _BACKGROUND_WORDS:
        return True
    geom_ids = [
        simulation.model.geom(geom).id
        for part in _list_geoms_by_visual(simulation).get(name, {}).values()
        for geom in part
    ]
    if not geom_ids:
        return True
    if (simulation.model.geom_type[geom_ids] == load_mujoco().mjtGeom.mjGEOM_PLANE).any():
        return True
    boxes = compute_geom_boxes(simulation.model, simulation.data)[geom_ids]
    extent = boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)
    return model.static and bool((extent[:2] > _MAX_OBJECT_WIDTH_M).any())


def _group_touching_visuals(
    visuals: list[str], geoms: Mapping[str, list[str]], model: Any, boxes: Array
) -> Iterator[list[str]]:
    """Yield groups of visuals whose bounding boxes touch each other."""
    remaining = list(visuals)
    bounds = {part: boxes[[model.geom(geom).id for geom in geoms[part]]] for part in visuals}
    bounds = {
        part: np.stack([visual_boxes[:, 0].min(axis=0), visual_boxes[:, 1].max(axis=0)])
        for part, visual_boxes in bounds.items()
    }
    while remaining:
        group, queue = [], [remaining.pop(0)]
        while queue:
            visual = queue.pop(0)
            group.append(visual)
            neighbors = [other for other in remaining if _do_boxes_touch(bounds[visual], bounds[other])]
            queue += neighbors
            remaining = [other for other in remaining if other not in neighbors]
        yield group


def _do_boxes_touch(first: Array, second: Array) -> bool:
    return bool((first[0] <= second[1] + _MAX_GAP_M).all() and (second[0] <= first[1] + _MAX_GAP_M).all())
