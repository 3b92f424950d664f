"""Render single images with their labels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, missing_extra, phrase
from linkwright.packages import PackageFinder
from linkwright.sdf.models import Model
from linkwright.simulation.rendering.renderer import Channels
from linkwright.simulation.server.worlds import load_world
from linkwright.simulation.simulation import Simulation
from linkwright.vision.datasets.appearance import LensEffects, fill_backdrop, paint_surfaces, set_lights
from linkwright.vision.datasets.arrangement import arrange
from linkwright.vision.datasets.classes import (
    ClassRules,
    find_objects,
    get_original_name,
    make_default_rules,
    read_classes,
)
from linkwright.vision.datasets.labels import Label, label_image
from linkwright.vision.datasets.options import SPLITS, Options
from linkwright.vision.datasets.randomized_world import RandomizedWorld

IMAGES_PER_PATTERN_SET = 50
"""The number of consecutive images that use the same patterns."""
_SPLIT_BLOCK = 20
"""The number of consecutive images over which the fractions of the splits hold."""
_PATTERN_STREAM, _IMAGE_STREAM, _SPLIT_STREAM = range(3)
"""Independent streams of random numbers for patterns, images and splits."""


@dataclass(frozen=True, slots=True)
class DatasetInput:
    """The worlds and options of a dataset.

    Attributes:
        worlds: the files or the names of worlds.
        added_models: the files of robots or models to add to each world.
        classes: the file of class rules; None for one class per model.
        options: how images are made.
    """

    worlds: tuple[str, ...]
    added_models: tuple[str, ...]
    classes: str | None
    options: Options


@dataclass(frozen=True, slots=True)
class LabeledImage:
    """An image with its labels.

    Attributes:
        index: the number of the image.
        split: ``train``, ``val`` or ``test``.
        data: the encoded image file.
        labels: the labels of its objects.
    """

    index: int
    split: str
    data: bytes
    labels: tuple[Label, ...]


class DatasetRenderer:
    """The renderer and labeler of the images of a dataset.

    An image depends only on its number and the seed.

    Args:
        source: the worlds and options.

    Attributes:
        classes: the names of the classes.
        unused: the names of classes that have no object in any world.
        worlds: the files of the worlds.
        render_method: the rendering method, for the card.

    Raises:
        LinkwrightError: VISION202 there is nothing to label; VISION204 Pillow is missing; an error in a world.
    """

    def __init__(self, source: DatasetInput) -> None:
        self._options = source.options
        self._pillow_image = _load_pillow()
        worlds = [load_world(name) for name in source.worlds]
        self.worlds = tuple(world.path for world in worlds)
        added_models = [_load_model(Path(path)) for path in source.added_models]
        simulations = [Simulation(world.world, world.finder) for world in worlds]
        for simulation in simulations:
            for model in added_models:
                simulation.spawn(model, _find_free_name(model.name, simulation))
            simulation.refresh()
        rules = make_default_rules(simulations) if source.classes is None else read_classes(Path(source.classes))
        self.classes = tuple(rules.patterns)
        _add_models_of_other_worlds(simulations, rules)
        objects = [find_objects(simulation, rules) for simulation in simulations]
        for path, world_objects in zip(source.worlds, objects, strict=True):
            if not world_objects:
                raise _no_objects_error(path, source.classes)
        used_labels = {scene_object.label for image_objects in objects for scene_object in image_objects}
        self.unused = tuple(name for index, name in enumerate(self.classes) if index not in used_labels)
        self._randomized_worlds = [
            RandomizedWorld(simulation, image_objects, self._options.copies, self._options.distractors)
            for simulation, image_objects in zip(simulations, objects, strict=True)
        ]
        self.render_method = self._randomized_worlds[0].renderer.method
        self._pattern_sets: dict[int, int] = {}
        self._lens = LensEffects()

    def render_image(self, index: int) -> LabeledImage:
        """Render the image with a number, and return it with its labels."""
        options, world_index = self._options, index % len(self._randomized_worlds)
        world, pattern_set = self._randomized_worlds[world_index], index // IMAGES_PER_PATTERN_SET
        if self._pattern_sets.get(world_index) != pattern_set:
            world.set_patterns(np.random.default_rng((options.seed, _PATTERN_STREAM, pattern_set, world_index)))
            self._pattern_sets[world_index] = pattern_set
        generator = np.random.default_rng((options.seed, _IMAGE_STREAM, index))
        world.reset()
        arrangement = arrange(world, options, generator)
        if "lights" not in options.fixed_properties:
            set_lights(world, generator)
        if "colors" not in options.fixed_properties:
            paint_surfaces(world, arrangement, generator)
        image = world.renderer.render(arrangement.optics, arrangement.pose, Channels.COLOR | Channels.GEOMS)
        assert image.color is not None
        assert image.geoms is not None
        labels = label_image(world, arrangement, image.geoms, options.min_size, options.min_visible)
        color = image.color
        if "lights" not in options.fixed_properties:
            fill_backdrop(color, image.geoms, generator)
        if "lens" not in options.fixed_properties:
            color = self._lens.apply(color, generator)
        return LabeledImage(index, choose_split(index, options), self._encode(color, generator), tuple(labels))

    def close(self) -> None:
        """Release the renderers."""
        for world in self._randomized_worlds:
            world.close()

    def _encode(self, color: Any, generator: np.random.Generator) -> bytes:
        file = BytesIO()
        image = self._pillow_image.fromarray(color)
        if self._options.image_format == "png":
            image.save(file, "PNG", compress_level=1)
        else:
            quality = 92 if "lens" in self._options.fixed_properties else int(generator.integers(60, 96))
            image.save(file, "JPEG", quality=quality)
        return file.getvalue()


def choose_split(index: int, options: Options) -> str:
    """Return the split of an image.

    The fractions of the splits hold for each block of twenty consecutive images.
    """
    block, position = divmod(index, _SPLIT_BLOCK)
    order = np.random.default_rng((options.seed, _SPLIT_STREAM, block)).permutation(_SPLIT_BLOCK)
    share = (int(order[position]) + 0.5) / _SPLIT_BLOCK
    for name, end in zip(SPLITS, np.cumsum(options.splits).tolist(), strict=True):
        if share < end:
            return name
    return SPLITS[0]


def _load_model(path: Path) -> Model:
    from linkwright.descriptions.conversion import as_sdf

    converted = as_sdf(path, PackageFinder(start=[path.absolute().parent, Path.cwd()]), folder=Path.cwd())
    if converted.sdf is None:
        raise LinkwrightError(*converted.diagnostics)
    model = converted.sdf.models[0] if converted.sdf.models else None
    if model is None or not any(link.visuals for link in model.links):
        message = phrase("'{path}' has no model with visuals", path=str(path))
        hint = phrase("add URDF or xacro whose links have an <inertial>, or SDF with a <model>")
        raise LinkwrightError(Diagnostic("VISION203", message, hint=hint))
    return model


def _add_models_of_other_worlds(simulations: Sequence[Simulation], rules: ClassRules) -> None:
    """Add the labeled models of each world to all other worlds."""
    models_by_world = [dict(simulation.scene.models) for simulation in simulations]
    for simulation in simulations:
        model_names = {get_original_name(scene_model.model) for scene_model in simulation.scene.models.values()}
        for models in models_by_world:
            for name, scene_model in models.items():
                model_name = get_original_name(scene_model.model)
                if (
                    model_name not in model_names
                    and name not in simulation.scene.models
                    and _is_labeled(name, scene_model.model, rules)
                ):
                    simulation.spawn(scene_model.model, name, scene_model.pose)
                    model_names.add(model_name)
        simulation.refresh()


def _is_labeled(name: str, model: Model, rules: ClassRules) -> bool:
    """Return whether a model, or each of its visuals, has a class in the rules."""
    if rules.find_class_number(name, get_original_name(model)) is not None:
        return True
    parts = [f"{name}::{link.name}::{visual.name}" for link in model.links for visual in link.visuals]
    return bool(parts) and all(rules.find_class_number(part) is not None for part in parts)


def _find_free_name(name: str, simulation: Simulation) -> str:
    number, candidate = 2, name
    while candidate in simulation.scene.models:
        candidate, number = f"{name}_{number}", number + 1
    return candidate


def _no_objects_error(world: str, classes: str | None) -> LinkwrightError:
    message = phrase("there is no object to label in the world '{world}'", world=world)
    hint = (
        phrase(
            "choose models or visuals with --classes, or add models with --add: the world contains "
            "only surroundings, such as ground and walls"
        )
        if classes is None
        else phrase(
            "change the patterns in '{file}', which match no name of a model or visual in the world", file=classes
        )
    )
    return LinkwrightError(Diagnostic("VISION202", message, hint=hint))


def _load_pillow() -> Any:
    try:
        from PIL import Image  # imported here because it is an extra
    except ModuleNotFoundError as error:
        raise missing_extra("VISION204", error) from None
    return Image
