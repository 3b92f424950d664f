"""Resolves ``<include>`` in worlds and models."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Protocol

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Phrase, Severity, phrase, term
from linkwright.sdf.actors import Actor
from linkwright.sdf.frames import FrameError
from linkwright.sdf.lights import Light
from linkwright.sdf.merging import merged
from linkwright.sdf.models import Include, Model
from linkwright.sdf.reader import Reading, read
from linkwright.sdf.resources import Missing, ResourceFinder
from linkwright.sdf.text import parse_as_gazebo
from linkwright.sdf.worlds import Sdf, World
from linkwright.xmltree.reader import read_bytes

_DEEPEST = 64
"""Models that include models that include models ...; files go no deeper."""
_MOST = 100_000
"""The greatest number of models from a file: where models include others twice each, few lines make more."""

Entity = Model | Light | Actor


@dataclass
class Included:
    """A file after its includes were resolved.

    Attributes:
        sdf: the file with its includes replaced by the included models; an include that cannot be resolved remains.
        diagnostics: errors in the included files, and includes of missing files.
        files: the files that were read, each once.
        entities: the entities that the includes of worlds name, by the ``id()`` of the include's element; None for a
            missing entity.
    """

    sdf: Sdf
    diagnostics: list[Diagnostic] = field(default_factory=list)
    files: dict[Path, None] = field(default_factory=dict)
    entities: dict[int, Entity | None] = field(default_factory=dict)


def resolve_includes(sdf: Sdf, path: Path, finder: ResourceFinder) -> Included:
    """Replace the includes of a file by the models, lights and actors that they name.

    Args:
        sdf: the parsed file.
        path: the path of the file.
        finder: finds models.
    """
    resolver = _Resolver(finder)
    worlds = tuple(resolver.world(world, path) for world in sdf.worlds)
    models = tuple(resolver.model(model, path, ()) for model in sdf.models)
    return Included(replace(sdf, worlds=worlds, models=models), resolver.diagnostics, resolver.files, resolver.entities)


class _Named(Protocol):
    @property
    def name(self) -> str: ...


def _names(*groups: Iterable[_Named]) -> set[str]:
    return {named.name for group in groups for named in group}


class _Resolver:
    def __init__(self, finder: ResourceFinder) -> None:
        self.diagnostics: list[Diagnostic] = []
        self.files: dict[Path, None] = {}
        self.entities: dict[int, Entity | None] = {}
        self._finder = finder
        self._readings: dict[Path, Reading | None] = {}
        self._count = 0

    def world(self, world: World, path: Path) -> World:
        models = [self.model(model, path, ()) for model in world.models]
        lights, actors, left = list(world.lights), list(world.actors), []
        names = _names(models, world.frames, world.joints)
        for include in world.includes:
            entity = self.entities[id(include.element)] = self._included(include, path, ())
            self._check_name(entity, include, names)
            if isinstance(entity, Model):
                models.append(entity)
            elif isinstance(entity, Light):
                lights.append(entity)
            elif isinstance(entity, Actor):
                actors.append(entity)
            else:
                left.append(include)
        populations = [
            replace(population, models=tuple(self.model(model, path, ()) for model in population.models[:1]))
            for population in world.populations
        ]
        return replace(
            world,
            models=tuple(models),
            lights=tuple(lights),
            actors=tuple(actors),
            includes=tuple(left),
            populations=tuple(populations),
        )

    def model(self, model: Model, path: Path, chain: tuple[Path, ...]) -> Model:
        if not (model.models or model.includes):
            return model
        inner = [self.model(nested, path, chain) for nested in model.models]
        parts: list[tuple[Include, Model]] = []
        left = []
        names = _names(model.links, model.joints, model.frames, inner)
        for include in model.includes:
            entity = self._included(include, path, chain)
            if not include.merge:
                self._check_name(entity, include, names)
            if not isinstance(entity, Model):
                left.append(include)
            elif include.merge:
                parts.append((include, entity))
            else:
                inner.append(entity)
        whole = replace(model, models=tuple(inner), includes=tuple(left))
        for include, part in parts:
            whole = self._merged(whole, part, include)
        return whole

    def _merged(self, whole: Model, part: Model, include: Include) -> Model:
        try:
            return merged(whole, part)
        except FrameError as error:
            message = phrase(
                "'{attribute}' names '{name}', which does not exist", attribute="placement_frame", name=error.name
            )
            self._report("SDF141", message, include, None, Severity.ERROR)
            return merged(whole, replace(part, placement_frame=""))

    def _included(self, include: Include, path: Path, chain: tuple[Path, ...]) -> Entity | None:
        """Return the included model, light or actor, with the changes of the include.

        If it is missing, report this and return None.
        """
        if not include.uri:
            return None  # The reader has reported it.
        found = self._finder.model(include.uri, path.parent)
        if isinstance(found, Missing):
            message = phrase("'{uri}' is left out: {reason}", uri=include.uri, reason=found.reason)
            self._report("SDF160", message, include, found.hint, found.severity)
            return None
        if found in chain or found == path or len(chain) >= _DEEPEST:
            self._report("SDF161", phrase("'{uri}' includes itself", uri=include.uri), include, None)
            return None
        self._count += 1
        if self._count > _MOST:
            if self._count == _MOST + 1:
                self._report("SDF161", phrase("more than {count} models are included", count=_MOST), include, None)
            return None
        reading = self._read(found, include)
        if reading is None or reading.sdf is None:
            return None
        sdf = reading.sdf
        if sdf.models:
            model = self.model(sdf.models[0], found, (*chain, path))
            return _apply_include(model, include)
        if sdf.lights or sdf.actors:
            entity: Light | Actor = sdf.lights[0] if sdf.lights else sdf.actors[0]
            return replace(entity, name=include.name or entity.name, pose=include.pose or entity.pose)
        self._report("SDF160", phrase("'{uri}' is left out: there is no model in it", uri=include.uri), include, None)
        return None

    def _check_name(self, entity: Entity | None, include: Include, names: set[str]) -> None:
        """Add the name of an included model to `names`, and report it if the name is already used."""
        if not isinstance(entity, Model):
            return
        if entity.name in names:
            hint = phrase("give it another name: <include><name>...</name>")
            message = phrase("{kind} '{name}' is defined twice", kind=term("model"), name=entity.name)
            self._report("SDF110", message, include, hint, Severity.ERROR)
        names.add(entity.name)

    def _read(self, path: Path, include: Include) -> Reading | None:
        """Read an included file, or return the cached result; None if the file cannot be read.

        The findings are added once, with a note that names the include.
        """
        if path in self._readings:
            return self._readings[path]
        self.files[path] = None
        found: tuple[Diagnostic, ...]
        reading = None
        try:
            document, found = parse_as_gazebo(read_bytes(path), str(path))
            reading = read(document)
            found = (*found, *reading.diagnostics)
        except LinkwrightError as error:
            found = error.diagnostics
        note = Note(phrase("included here"), include.element.span() if include.element else None)
        self.diagnostics += [diagnostic.with_changes(notes=(*diagnostic.notes, note)) for diagnostic in found]
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
        place = uri or element
        span = None if place is None else place.span()
        source = None if place is None else place.source
        self.diagnostics.append(Diagnostic(code, message, span, severity, hint=hint, source=source))


def _apply_include(model: Model, include: Include) -> Model:
    """Return a model with the changes of its include."""
    return replace(
        model,
        name=include.name or model.name,
        pose=model.pose if include.pose is None else include.pose,
        placement_frame=include.placement_frame or model.placement_frame,
        static=model.static if include.static is None else include.static,
        plugins=(*model.plugins, *include.plugins),
    )
