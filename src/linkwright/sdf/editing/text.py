"""The text of a world, with its models and lights, their source elements and their poses."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Literal

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.single import Transform
from linkwright.sdf.actors import Actor
from linkwright.sdf.editing.errors import EditError
from linkwright.sdf.editing.shapes import SimpleShape, recognize_simple_shape
from linkwright.sdf.frames import FrameError, Frames, transform_of
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.joints import Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.models import Frame, Include, Model
from linkwright.sdf.old_versions import is_old
from linkwright.sdf.poses import AT_ORIGIN, SEPARATOR, WORLD, RawPose
from linkwright.sdf.reader import read
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.saved import with_saved_state
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import World
from linkwright.xmltree import Element
from linkwright.xmltree.patches import Replacement, apply

_match_numbered_name = re.compile(r"(.+?)_\d+").fullmatch


@dataclass(frozen=True, slots=True)
class Entity:
    """A model or light of a world.

    Attributes:
        name: the name in the world.
        kind: ``model`` or ``light``.
        element: the element that declares the entity.
        written: the entity as declared in the file, before includes and saved states are applied.
        model: the model, with its includes resolved; None for a light, and for an include that cannot be resolved.
        light: the light; None for a model.
        world_pose: the pose of the entity's frame in the world.
        shape: the shape of a model that consists of one simple shape; None for a light, an include or any other model.
    """

    name: str
    kind: Literal["model", "light"]
    element: Element
    written: Model | Light | Include
    model: Model | None
    light: Light | None
    world_pose: Transform
    shape: SimpleShape | None

    @property
    def pose(self) -> RawPose:
        """The entity's pose as written."""
        return self.written.pose or AT_ORIGIN

    @property
    def is_static(self) -> bool:
        """Whether the entity is a static model."""
        if self.model is not None:
            return self.model.static
        return isinstance(self.written, Include) and bool(self.written.static)

    @property
    def member_names(self) -> tuple[str, ...]:
        """The names of the nested models in a group, or no names for any other entity."""
        if not isinstance(self.written, Model) or self.model is None or self.written.links:
            return ()
        return tuple(model.name for model in self.model.models)


class WorldText:
    """The text of an SDF file, with the parsed content of its first world.

    Args:
        text: the content of the SDF file.
        path: the path of the file; relative addresses start from its folder.
        finder: finds the included models.
        reserved: names that new entities cannot have, because the running world uses them.

    Attributes:
        world: the world, with includes resolved and all poses from the last saved state.
        frames: the frames of `world`.
        entities: the models and lights of `world` by name, in the order of the text.

    Raises:
        LinkwrightError: the text is not XML.
        EditError: the text does not contain a world.
    """

    def __init__(self, text: str, path: Path, finder: ResourceFinder, reserved: frozenset[str] = frozenset()) -> None:
        self.text, self.path, self.finder, self.reserved = text, path, finder, reserved
        document, _ = parse_as_gazebo(text, str(path))
        if is_old(document.root):
            raise EditError(
                phrase(
                    "SDF older than 1.3 cannot be edited; convert '{path}' with 'linkwright convert' first",
                    path=str(path),
                )
            )
        reading = read(document)
        if reading.sdf is None or not reading.sdf.worlds or reading.sdf.worlds[0].element is None:
            raise EditError(phrase("there is no world in '{path}'", path=str(path)))
        self._written = reading.sdf.worlds[0]
        self.element: Element = reading.sdf.worlds[0].element
        self._included = resolve_includes(replace(reading.sdf, worlds=(self._written,)), path, finder)
        resolved_world = self._included.sdf.worlds[0]
        self.world: World = with_saved_state(resolved_world)
        self.frames = Frames(self.world)
        self._models = {model.name: model for model in reversed(self.world.models)}
        self._lights = {light.name: light for light in reversed(self.world.lights)}
        self.entities: Mapping[str, Entity] = dict(self._read_entities())

    @cached_property
    def used_names(self) -> frozenset[str]:
        """The names that a new entity cannot have."""
        world, state = self.world, self.world.states[-1] if self.world.states else None
        deleted_names = state.deletions.names if state is not None else ()
        other_entities: tuple[Actor | Frame | Joint, ...] = (*world.actors, *world.frames, *world.joints)
        return self.reserved.union({WORLD, *self.entities, *(item.name for item in other_entities), *deleted_names})

    @property
    def state(self) -> Element | None:
        """The last saved state, whose poses take precedence over the models' poses, or None."""
        return self.world.states[-1].element if self.world.states else None

    def entity(self, name: str) -> Entity:
        """Return the model or light with a name.

        Raises:
            EditError: there is no such model or light.
        """
        try:
            return self.entities[name]
        except KeyError:
            raise EditError(phrase("there is no model or light '{name}' in the world's file", name=name)) from None

    def apply_edits(self, edits: list[Replacement]) -> WorldText:
        """Return the world after applying edits to its text.

        Raises:
            EditError: the result is not a world, because the caller's edits are wrong.
        """
        return self.with_text(apply(self.text, edits))

    def with_text(self, text: str) -> WorldText:
        """Return the world that another text describes, with the same path and settings.

        Raises:
            EditError: the text is not a world.
        """
        if text == self.text:
            return self
        try:
            return WorldText(text, self.path, self.finder, self.reserved)
        except LinkwrightError as error:
            diagnostic = error.diagnostics[0]
            raise EditError(phrase("the result would not be valid SDF: {reason}", reason=diagnostic.message)) from None

    def choose_free_name(self, preferred_name: str, used_names: AbstractSet[str] | None = None) -> str:
        """Return the preferred name, or this name with the first free number if it is in use.

        `used_names` are the names in use; None for the names in this world.
        """
        used_names = self.used_names if used_names is None else used_names
        if preferred_name not in used_names:
            return preferred_name
        numbered_match = _match_numbered_name(preferred_name)
        stem = numbered_match[1] if numbered_match else preferred_name
        number = 2
        while f"{stem}_{number}" in used_names:
            number += 1
        return f"{stem}_{number}"

    def check_name(self, name: str) -> None:
        """Check that a new entity can have a name.

        Raises:
            EditError: the name is empty, already used, or reserved by SDF.
        """
        if not name.strip():
            raise EditError(phrase("a name cannot be empty"))
        if SEPARATOR in name or name == WORLD or (name.startswith("__") and name.endswith("__")):
            raise EditError(phrase("'{name}' cannot be used as a name: SDF reserves it", name=name))
        if name in self.used_names:
            raise EditError(phrase("an entity named '{name}' already exists", name=name))

    def _read_entities(self) -> Iterator[tuple[str, Entity]]:
        yielded_names: set[str] = set()
        state = self._written.states[-1] if self._written.states else None
        deleted_names = frozenset(state.deletions.names) if state is not None else frozenset[str]()
        written_entities: list[Model | Light | Include] = [
            *self._written.models,
            *self._written.lights,
            *self._written.includes,
        ]
        if state is not None:
            written_entities += [*state.insertions.models, *state.insertions.lights]
        for item in sorted(written_entities, key=lambda item: 0 if item.element is None else item.element.offset):
            entity = self._read_entity(item)
            if entity is not None and entity.name not in yielded_names and entity.name not in deleted_names:
                yielded_names.add(entity.name)
                yield entity.name, entity

    def _read_entity(self, written: Model | Light | Include) -> Entity | None:
        element = written.element
        assert element is not None, "it was read from the text"
        resolved = self._included.entities.get(id(element)) if isinstance(written, Include) else written
        if isinstance(resolved, Model):
            model = self._models.get(resolved.name, resolved)
            shape = recognize_simple_shape(written) if isinstance(written, Model) else None
            return Entity(resolved.name, "model", element, written, model, None, self._world_pose(model), shape)
        if isinstance(resolved, Light):
            light = self._lights.get(resolved.name, resolved)
            return Entity(resolved.name, "light", element, written, None, light, self._world_pose(light), None)
        if isinstance(written, Include) and resolved is None:
            name = written.name or written.uri.strip().rstrip("/").rpartition("/")[2]
            pose = written.pose or AT_ORIGIN
            return Entity(name, "model", element, written, None, None, transform_of(pose.pose), None)
        return None  # Actors cannot be edited.

    def _world_pose(self, entity: Model | Light) -> Transform:
        try:
            return self.frames.pose(entity.name) if isinstance(entity, Model) else self.frames.placed(entity.pose)
        except FrameError:
            return transform_of(entity.pose.pose)  # `check` reports the missing frame
