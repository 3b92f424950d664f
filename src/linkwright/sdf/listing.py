"""The contents of an SDF file, listed as text."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Phrase, counted, joined, phrase, term
from linkwright.diagnostics.translation import localized
from linkwright.sdf.models import Model
from linkwright.sdf.worlds import Sdf, World


def list_contents(sdf: Sdf) -> str:
    """Return the worlds, models, lights and actors of a file, one per line.

    Each level is indented by two spaces.
    """
    lines: list[str] = []
    for world in sdf.worlds:
        lines += [_line(0, phrase("world {name}", name=world.name)), *_world_lines(world)]
    for model in sdf.models:
        lines += _model_lines(model, 0)
    return "".join(f"{line}\n" for line in (*lines, *_actor_and_light_lines(sdf, 0)))


def _world_lines(world: World) -> Iterator[str]:
    for model in world.models:
        yield from _model_lines(model, 1)
    yield from _actor_and_light_lines(world, 1)
    yield from (_line(1, phrase("{uri}: not found", uri=include.uri)) for include in world.includes)


def _actor_and_light_lines(owner: Sdf | World, level: int) -> Iterator[str]:
    yield from (_line(level, phrase("actor {name}", name=actor.name)) for actor in owner.actors)
    for light in owner.lights:
        yield _line(level, phrase("light {name}: {kind}", name=light.name, kind=term(light.type)))


def _model_lines(model: Model, level: int) -> Iterator[str]:
    sensors = sum(len(link.sensors) for link in model.links)
    counts = joined(
        [
            counted("{count} link", "{count} links", len(model.links)),
            *([counted("{count} joint", "{count} joints", len(model.joints))] if model.joints else []),
            *([counted("{count} sensor", "{count} sensors", sensors)] if sensors else []),
            *([counted("{count} plugin", "{count} plugins", len(model.plugins))] if model.plugins else []),
        ]
    )
    if model.static:
        yield _line(level, phrase("static model {name}: {parts}", name=model.name, parts=counts))
    else:
        yield _line(level, phrase("model {name}: {parts}", name=model.name, parts=counts))
    for nested_model in model.models:
        yield from _model_lines(nested_model, level + 1)
    yield from (_line(level + 1, phrase("{uri}: not found", uri=include.uri)) for include in model.includes)


def _line(level: int, text: Phrase) -> str:
    return "  " * level + localized(text)
