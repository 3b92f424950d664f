"""Make single images with their labels."""

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
from linkwright.vision.datasets.arranging import arrange
from linkwright.vision.datasets.classes import ClassRules, objects_of, own_name, read_classes, usual_rules
from linkwright.vision.datasets.labels import Label, label_image
from linkwright.vision.datasets.looks import Camera, backdrop, light, paint
from linkwright.vision.datasets.options import SPLITS, Options
from linkwright.vision.datasets.stage import Stage

CHAPTER = 50
"""The number of consecutive images that share their patterns."""
_BLOCK = 20
"""The number of consecutive images in which the splits have their shares."""
_PATTERNS, _IMAGE, _SPLIT = range(3)
"""Streams of random numbers; each image has its own for each."""


@dataclass(frozen=True, slots=True)
class Source:
    """The worlds and options of a dataset.

    Attributes:
        worlds: the files of worlds, or their names.
        added: the files of robots or models to add to each world.
        classes: the file of class rules; None for one class per model.
        options: the options of making images.
    """

    worlds: tuple[str, ...]
    added: tuple[str, ...]
    classes: str | None
    options: Options


@dataclass(frozen=True, slots=True)
class LabelledImage:
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


class Studio:
    """Makes the images of a dataset; each image depends only on its number and the seed.

    Args:
        source: the worlds and options.

    Attributes:
        classes: the names of the classes.
        unused: the names of classes without an object in the worlds.
        worlds: the files of the worlds.
        way: the rendering method.

    Raises:
        LinkwrightError: VISION202 there is nothing to label; VISION204 Pillow is missing; an error in a world.
    """

    def __init__(self, source: Source) -> None:
        self._options = source.options
        self._image = _pillow()
        loaded = [load_world(name) for name in source.worlds]
        self.worlds = tuple(world.path for world in loaded)
        added = [_model_of(Path(path)) for path in source.added]
        simulations = [Simulation(world.world, world.finder) for world in loaded]
        for simulation in simulations:
            for model in added:
                simulation.spawn(model, _free_name(model.name, simulation))
            simulation.refresh()
        rules = usual_rules(simulations) if source.classes is None else read_classes(Path(source.classes))
        self.classes = tuple(rules.patterns)
        _share(simulations, rules)
        objects = [objects_of(simulation, rules) for simulation in simulations]
        for path, found in zip(source.worlds, objects, strict=True):
            if not found:
                raise _nothing(path, source.classes)
        used = {scene_object.label for found in objects for scene_object in found}
        self.unused = tuple(name for number, name in enumerate(self.classes) if number not in used)
        self._stages = [
            Stage(simulation, found, self._options.copies, self._options.distractors)
            for simulation, found in zip(simulations, objects, strict=True)
        ]
        self.way = self._stages[0].renderer.way
        self._chapters: dict[int, int] = {}
        self._camera = Camera()

    def make(self, index: int) -> LabelledImage:
        """Return an image with its labels, by its number."""
        options, which = self._options, index % len(self._stages)
        stage, chapter = self._stages[which], index // CHAPTER
        if self._chapters.get(which) != chapter:
            stage.set_patterns(np.random.default_rng((options.seed, _PATTERNS, chapter, which)))
            self._chapters[which] = chapter
        generator = np.random.default_rng((options.seed, _IMAGE, index))
        stage.begin()
        shot = arrange(stage, options, generator)
        if "lights" not in options.kept:
            light(stage, generator)
        if "colours" not in options.kept:
            paint(stage, shot, generator)
        image = stage.renderer.render(shot.optics, shot.pose, Channels.COLOUR | Channels.GEOMS)
        assert image.colour is not None
        assert image.geoms is not None
        labels = label_image(stage, shot, image.geoms, options.least_size, options.least_visible)
        colour = image.colour
        if "lights" not in options.kept:
            backdrop(colour, image.geoms, generator)
        if "lens" not in options.kept:
            colour = self._camera.develop(colour, generator)
        return LabelledImage(index, split_of(index, options), self._encoded(colour, generator), tuple(labels))

    def close(self) -> None:
        """Release the renderers."""
        for stage in self._stages:
            stage.close()

    def _encoded(self, colour: Any, generator: np.random.Generator) -> bytes:
        file = BytesIO()
        image = self._image.fromarray(colour)
        if self._options.form == "png":
            image.save(file, "PNG", compress_level=1)
        else:
            quality = 92 if "lens" in self._options.kept else int(generator.integers(60, 96))
            image.save(file, "JPEG", quality=quality)
        return file.getvalue()


def split_of(index: int, options: Options) -> str:
    """Return the split of an image. The shares of the splits hold for every twenty consecutive images."""
    block, place = divmod(index, _BLOCK)
    order = np.random.default_rng((options.seed, _SPLIT, block)).permutation(_BLOCK)
    share = (int(order[place]) + 0.5) / _BLOCK
    for name, end in zip(SPLITS, np.cumsum(options.splits).tolist(), strict=True):
        if share < end:
            return name
    return SPLITS[0]


def _model_of(path: Path) -> Model:
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


def _share(simulations: Sequence[Simulation], rules: ClassRules) -> None:
    """Add the labelled models of each world to all other worlds."""
    everything = [dict(simulation.scene.models) for simulation in simulations]
    for simulation in simulations:
        kinds = {own_name(held.model) for held in simulation.scene.models.values()}
        for models in everything:
            for name, held in models.items():
                own = own_name(held.model)
                if own not in kinds and name not in simulation.scene.models and _is_labelled(name, held.model, rules):
                    simulation.spawn(held.model, name, held.pose)
                    kinds.add(own)
        simulation.refresh()


def _is_labelled(name: str, model: Model, rules: ClassRules) -> bool:
    """Return whether a model, or each of its visuals, has a class."""
    if rules.class_of(name, own_name(model)) is not None:
        return True
    parts = [f"{name}::{link.name}::{visual.name}" for link in model.links for visual in link.visuals]
    return bool(parts) and all(rules.class_of(part) is not None for part in parts)


def _free_name(name: str, simulation: Simulation) -> str:
    number, free = 2, name
    while free in simulation.scene.models:
        free, number = f"{name}_{number}", number + 1
    return free


def _nothing(world: str, classes: str | None) -> LinkwrightError:
    message = phrase("there is no object to label in the world '{world}'", world=world)
    hint = (
        phrase(
            "all its models are ground, walls or the like; name models or visuals with --classes, or add "
            "some with --add"
        )
        if classes is None
        else phrase("none of its models or visuals has a name that fits a pattern in '{file}'", file=classes)
    )
    return LinkwrightError(Diagnostic("VISION202", message, hint=hint))


def _pillow() -> Any:
    try:
        from PIL import Image  # not above: an extra
    except ModuleNotFoundError as error:
        raise missing_extra("VISION204", error) from None
    return Image
