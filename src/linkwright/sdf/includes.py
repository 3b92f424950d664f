"""Resolve ``<include>`` in worlds and models."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol, TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, phrase, term
from linkwright.sdf.actors import Actor
from linkwright.sdf.frames import FrameError
from linkwright.sdf.lights import Light
from linkwright.sdf.merging import merge_models
from linkwright.sdf.models import Include, Model
from linkwright.sdf.reader import Reading, read
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import Sdf, World
from linkwright.xmltree.reader import read_bytes

_MAX_DEPTH = 64
"""The maximum depth of nested includes."""
_MAX_MODELS = 100_000
"""The maximum number of included models.

A few lines can create billions of models if each model includes another one twice.
"""

Entity = Model | Light | Actor
Owner = TypeVar("Owner", World, Sdf)


@dataclass
class Included:
    """A file after its includes were resolved.

    Attributes:
        sdf: the file with its includes replaced by the included models; an include that cannot be resolved remains.
        diagnostics: errors in the included files, and includes of missing files.
        files: the files that were read, in order, as keys.
        entities: the entity for each include of a world or file, by the ``id()`` of the include's element; None if it
            could not be loaded.
    """

    sdf: Sdf
    diagnostics: list[Diagnostic] = field(default_factory=list)
    files: dict[Path, None] = field(default_factory=dict)
    entities: dict[int, Entity | None] = field(default_factory=dict)


def resolve_includes(sdf: Sdf, path: Path, finder: ResourceFinder) -> Included:
    """Replace the includes of a file with the models, lights and actors that they name.

    Args:
        sdf: the content of the file.
        path: the path of the file; relative addresses start from its folder.
        finder: finds the files of included models.
    """
    resolver = _Resolver(finder)
    worlds = tuple(resolver.world(world, path) for world in sdf.worlds)
    resolved = resolver.add_included(replace(sdf, worlds=worlds), path)
    return Included(resolved, resolver.diagnostics, resolver.files, resolver.entities)


class _Named(Protocol):
    @property
    def name(self) -> str: ...


def _collect_names(*groups: Iterable[_Named]) -> set[str]:
    return {entity.name for group in groups for entity in group}


class _Resolver:
    def __init__(self, finder: ResourceFinder) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.files: dict[Path, None] = {}
        self.entities: dict[int, Entity | None] = {}
        self._finder = finder
        self._readings: dict[Path, Reading | None] = {}
        self._paths: dict[tuple[str, Path], Path | Missing] = {}
        self._count = 0

    def world(self, world: World, path: Path) -> World:
        populations = [
            replace(population, models=tuple(self.model(model, path, ()) for model in population.models[:1]))
            for population in world.populations
        ]
        other_names = _collect_names(world.frames, world.joints)
        return replace(self.add_included(world, path, other_names), populations=tuple(populations))

    def add_included(self, owner: Owner, path: Path, other_names: Iterable[str] = ()) -> Owner:
        """Return a world or file with its models resolved, and with the models, lights and actors that it includes.

        `other_names` are the names of the owner's frames and joints.
        """
        models = [self.model(model, path, ()) for model in owner.models]
        lights, actors, unresolved_includes = list(owner.lights), list(owner.actors), []
        names = _collect_names(models) | {*other_names}
        for include in owner.includes:
            entity = self.entities[id(include.element)] = self._load_entity(include, path, ())
            self._check_name(entity, include, names)
            if isinstance(entity, Model):
                models.append(entity)
            elif isinstance(entity, Light):
                lights.append(entity)
            elif isinstance(entity, Actor):
                actors.append(entity)
            else:
                unresolved_includes.append(include)
        return replace(
            owner,
            models=tuple(models),
            lights=tuple(lights),
            actors=tuple(actors),
            includes=tuple(unresolved_includes),
        )

    def model(self, model: Model, path: Path, chain: tuple[Path, ...]) -> Model:
        if not (model.models or model.includes):
            return model
        nested_models = [self.model(nested, path, chain) for nested in model.models]
        merged_models: list[tuple[Include, Model]] = []
        unresolved_includes = []
        names = _collect_names(model.links, model.joints, model.frames, nested_models)
        for include in model.includes:
            entity = self._load_entity(include, path, chain)
            if not include.merge:
                self._check_name(entity, include, names)
            if not isinstance(entity, Model):
                unresolved_includes.append(include)
            elif include.merge:
                merged_models.append((include, entity))
            else:
                nested_models.append(entity)
        resolved_model = replace(model, models=tuple(nested_models), includes=tuple(unresolved_includes))
        for include, merged_model in merged_models:
            resolved_model = self._merge_model(resolved_model, merged_model, include)
        return resolved_model

    def _merge_model(self, enclosing_model: Model, included_model: Model, include: Include) -> Model:
        try:
            return merge_models(enclosing_model, included_model)
        except FrameError as error:
            message = phrase(
                "'{attribute}' refers to '{name}', which does not exist", attribute="placement_frame", name=error.name
            )
            self._report("SDF141", message, include, None, Severity.ERROR)
            return merge_models(enclosing_model, replace(included_model, placement_frame=""))

    def _load_entity(self, include: Include, path: Path, chain: tuple[Path, ...]) -> Entity | None:
        """Return the included model, light or actor, with the changes that the include makes.

        If it cannot be loaded, report this and return None.
        """
        if not include.uri:
            return None  # The reader has reported the missing address.
        model_path = self._find_model(include.uri, path.parent)
        if isinstance(model_path, Missing):
            message = phrase("'{uri}' is left out: {reason}", uri=include.uri, reason=model_path.reason)
            self._report("SDF160", message, include, model_path.hint, model_path.severity)
            return None
        if model_path in chain or model_path == path or len(chain) >= _MAX_DEPTH:
            self._report("SDF161", phrase("'{name}' includes itself", name=include.uri), include, None)
            return None
        self._count += 1
        if self._count > _MAX_MODELS:
            if self._count == _MAX_MODELS + 1:
                self._report(
                    "SDF161", phrase("more than {count} models are included", count=_MAX_MODELS), include, None
                )
            return None
        reading = self._read(model_path, include)
        if reading is None or reading.sdf is None:
            return None
        sdf = reading.sdf
        if sdf.models:
            model = self.model(sdf.models[0], model_path, (*chain, path))
            return _apply_include(model, include)
        if sdf.lights or sdf.actors:
            entity: Light | Actor = sdf.lights[0] if sdf.lights else sdf.actors[0]
            return replace(entity, name=include.name or entity.name, pose=include.pose or entity.pose)
        self._report(
            "SDF160",
            phrase("'{uri}' is left out because it does not contain a model", uri=include.uri),
            include,
            None,
        )
        return None

    def _find_model(self, uri: str, folder: Path) -> Path | Missing:
        """Return the file of a model, which is searched for once."""
        key = uri, folder
        if key not in self._paths:
            self._paths[key] = self._finder.model(uri, folder)
        return self._paths[key]

    def _check_name(self, entity: Entity | None, include: Include, names: set[str]) -> None:
        """Report an included model whose name is in `names`, and add its name to `names`."""
        if not isinstance(entity, Model):
            return
        if entity.name in names:
            hint = phrase("give it another name: <include><name>...</name>")
            message = phrase("{kind} '{name}' is defined twice", kind=term("model"), name=entity.name)
            self._report("SDF110", message, include, hint, Severity.ERROR)
        names.add(entity.name)

    def _read(self, path: Path, include: Include) -> Reading | None:
        """Return an included file, read or from the cache, or None if it cannot be read.

        Findings in the file are reported once, with a note at the position of the include.
        """
        if path in self._readings:
            return self._readings[path]
        self.files[path] = None
        diagnostics: tuple[Diagnostic, ...]
        reading = None
        try:
            document, diagnostics = parse_as_gazebo(read_bytes(path), str(path))
            reading = read(document)
            diagnostics = (*diagnostics, *reading.diagnostics)
        except LinkwrightError as error:
            diagnostics = error.diagnostics
        note = Note(phrase("included here"), include.element.span() if include.element else None)
        self.diagnostics += [diagnostic.with_changes(notes=(*diagnostic.notes, note)) for diagnostic in diagnostics]
        self._readings[path] = reading
        return reading

    def _report(
        self,
        code: str,
        message: Phrase,
        include: Include,
        hint: Phrase | None,
        severity: Severity = Severity.WARNING,
    ) -> None:
        element = include.element
        uri = None if element is None else element.first("uri")
        located_element = uri or element
        span = None if located_element is None else located_element.span()
        source = None if located_element is None else located_element.source
        self.diagnostics.append(Diagnostic(code, message, span, severity, hint=hint, source=source))


def _apply_include(model: Model, include: Include) -> Model:
    """Return a model with the name, pose and other settings that its include overrides."""
    return replace(
        model,
        name=include.name or model.name,
        pose=model.pose if include.pose is None else include.pose,
        placement_frame=include.placement_frame or model.placement_frame,
        static=model.static if include.static is None else include.static,
        plugins=(*model.plugins, *include.plugins),
    )
