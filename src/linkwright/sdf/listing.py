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
        lines += [_format_line(0, phrase("world {name}", name=world.name)), *_format_world(world)]
    for model in sdf.models:
        lines += _format_model(model, 0)
    return "".join(f"{line}\n" for line in (*lines, *_format_actors_and_lights(sdf, 0)))


def _format_world(world: World) -> Iterator[str]:
    for model in world.models:
        yield from _format_model(model, 1)
    yield from _format_actors_and_lights(world, 1)
    yield from (_format_line(1, phrase("{uri}: not found", uri=include.uri)) for include in world.includes)


def _format_actors_and_lights(owner: Sdf | World, level: int) -> Iterator[str]:
    yield from (_format_line(level, phrase("actor {name}", name=actor.name)) for actor in owner.actors)
    for light in owner.lights:
        yield _format_line(level, phrase("light {name}: {kind}", name=light.name, kind=term(light.type)))


def _format_model(model: Model, level: int) -> Iterator[str]:
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
        yield _format_line(level, phrase("static model {name}: {parts}", name=model.name, parts=counts))
    else:
        yield _format_line(level, phrase("model {name}: {parts}", name=model.name, parts=counts))
    for nested_model in model.models:
        yield from _format_model(nested_model, level + 1)
    yield from (_format_line(level + 1, phrase("{uri}: not found", uri=include.uri)) for include in model.includes)


def _format_line(level: int, text: Phrase) -> str:
    return "  " * level + localized(text)
