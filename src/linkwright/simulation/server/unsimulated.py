"""Elements and plugins of SDF worlds that are not simulated, and what to use instead."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from linkwright.diagnostics import Phrase, display_path, joined, phrase
from linkwright.sdf.figures import ACTOR_WALK_LIBRARY
from linkwright.sdf.models import Model
from linkwright.sdf.plugins import library_name
from linkwright.sdf.reader import OPEN_TAGS
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.alternatives import find_alternative
from linkwright.simulation.plugins.registry import is_built_in
from linkwright.simulation.plugins.sources import find_plugin_sources
from linkwright.xmltree import Element

_UNSIMULATED = frozenset(
    {"audio_source", "fluid_added_mass", "gripper", "particle_emitter", "projector", "soft_contact"}
)
_SIMULATED_BY = {"gz-sim-particle-emitter-system": ("<particle_emitter>",)}
"""The elements that are simulated in worlds with a plugin."""
_UNSIMULATED_IN = frozenset({("actor", "animation"), ("geometry", "image")})
"""Pairs of a parent and a child: the child is simulated in other elements, but not in this parent."""
_PLUGINS_NOT_SIMULATED = frozenset({"actor"})


def report_unsimulated_plugins(
    names: Mapping[str, bool], finder: ResourceFinder, report: Callable[[Phrase], object]
) -> None:
    """Report plugins and sensors that are not simulated, each with what to use instead.

    Args:
        names: the libraries as written and the types of sensors, each with whether it is a library.
        finder: finds the packages that may contain the sources of the plugins.
        report: called with each message.
    """
    report(phrase("plugins and sensors that are not simulated: {names}", names=joined([*names])))
    others = []
    for name, is_library in names.items():
        if (alternative := find_alternative(name)) is not None:
            report(phrase("instead of {name}, use {alternative}", name=name, alternative=alternative))
        elif is_library:
            others.append(name)
    if not others:
        return
    sources = find_plugin_sources({library_name(name) for name in others}, finder.packages())
    for name in others:
        if (source := sources.get(library_name(name))) is not None:
            report(
                phrase(
                    "{name} is C++ of the package '{package}', which is not loaded: write the plugin in Python, as "
                    "docs/own-plugins.md describes, from {file}",
                    name=name,
                    package=source.package,
                    file=display_path(source.file),
                )
            )
    unknown = [name for name in others if library_name(name) not in sources]
    if unknown:
        report(
            phrase(
                "no package here contains the source of {names}: a plugin in Python can do the work, as "
                "docs/own-plugins.md describes",
                names=joined(unknown),
            )
        )


def find_unsimulated_elements(world: World) -> list[str]:
    """Return the names of the elements in a world that are not simulated, sorted.

    Examples are ``<projector>`` and ``libwalk.so in <actor>``.
    """
    return _collect_unsimulated_names(_find_roots(world), world)


def find_unsimulated_model_elements(model: Model, world: World) -> list[str]:
    """Return the names of the elements in a model of a world that are not simulated, sorted."""
    elements = (part.element for part in (model, *_find_nested_models(model)))
    return _collect_unsimulated_names((element for element in elements if element is not None), world)


def _collect_unsimulated_names(roots: Iterable[Element], world: World) -> list[str]:
    libraries = {library_name(plugin.filename) for plugin in world.plugins}
    names: set[str] = set()
    for root in roots:
        pending = [root]
        while pending:
            element = pending.pop()
            for child in element.elements():
                name = _describe_unsimulated(element, child)
                if name:
                    names.add(name)
                elif child.tag not in OPEN_TAGS and child.tag != "state":
                    pending.append(child)
    return sorted(names.difference(*(_SIMULATED_BY.get(library, ()) for library in libraries)))


def _describe_unsimulated(parent: Element, child: Element) -> str:
    """Return the name of an unsimulated child element, or an empty string if it is simulated."""
    if child.tag in _UNSIMULATED:
        return f"<{child.tag}>"
    if parent.tag == "world" and child.tag == "joint" and child.first("sensor") is not None:
        return "<sensor> in <joint> of <world>"
    if (parent.tag, child.tag) in _UNSIMULATED_IN:
        return f"<{child.tag}> in <{parent.tag}>"
    if child.tag == "plugin" and parent.tag in _PLUGINS_NOT_SIMULATED:
        filename = child.attributes.get("filename", "")
        return (
            ""
            if is_built_in(filename) or library_name(filename) == ACTOR_WALK_LIBRARY
            else f"{filename} in <{parent.tag}>"
        )
    return ""


def _find_roots(world: World) -> Iterator[Element]:
    """Yield the element of the world, and the elements included from other files."""
    if world.element is not None:
        yield world.element
    world_source = None if world.element is None else world.element.source
    models = (*world.models, *(nested_model for model in world.models for nested_model in _find_nested_models(model)))
    elements = [*(model.element for model in models), *(actor.element for actor in world.actors)]
    for element in elements:
        if element is not None and element.source is not world_source:
            yield element


def _find_nested_models(model: Model) -> Iterator[Model]:
    for nested_model in model.models:
        yield nested_model
        yield from _find_nested_models(nested_model)
