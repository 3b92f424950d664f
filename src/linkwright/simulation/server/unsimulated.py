"""Elements of SDF that a world may contain but that are not simulated."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.sdf.models import Model
from linkwright.sdf.reader import OPEN
from linkwright.sdf.worlds import World
from linkwright.simulation.plugins.registry import is_built_in
from linkwright.xmltree import Element

_NOWHERE = frozenset({"audio_source", "fluid_added_mass", "gripper", "particle_emitter", "projector", "soft_contact"})
_IN = frozenset({("actor", "animation"), ("geometry", "image")})
"""Pairs of elements: the first is simulated elsewhere, and not in the second."""
_WITHOUT_PLUGINS = frozenset({"actor", "visual"})


def unsimulated_elements(world: World) -> list[str]:
    """Return the names of the elements in a world that are not simulated, sorted.

    Examples are ``<projector>`` and ``libwalk.so in <actor>``.
    """
    return _named(_roots(world))


def unsimulated_in(model: Model) -> list[str]:
    """Return the names of the elements in a model that are not simulated, sorted."""
    elements = (part.element for part in (model, *_inside(model)))
    return _named(element for element in elements if element is not None)


def _named(roots: Iterable[Element]) -> list[str]:
    found: set[str] = set()
    for root in roots:
        pending = [root]
        while pending:
            element = pending.pop()
            for child in element.elements():
                name = _name(element, child)
                if name:
                    found.add(name)
                elif child.tag not in OPEN and child.tag != "state":
                    pending.append(child)
    return sorted(found)


def _name(parent: Element, child: Element) -> str:
    """Return the name of a child element that is not simulated; empty for a simulated one."""
    if child.tag in _NOWHERE:
        return f"<{child.tag}>"
    if parent.tag == "world" and child.tag == "joint" and child.first("sensor") is not None:
        return "<sensor> in <joint> of <world>"
    if (parent.tag, child.tag) in _IN:
        return f"<{child.tag}> in <{parent.tag}>"
    if child.tag == "plugin" and parent.tag in _WITHOUT_PLUGINS:
        filename = child.attributes.get("filename", "")
        return "" if is_built_in(filename) else f"{filename} in <{parent.tag}>"
    return ""


def _roots(world: World) -> Iterator[Element]:
    """Yield the element of the world, and the elements that were included from other files."""
    if world.element is not None:
        yield world.element
    own = None if world.element is None else world.element.source
    models = (*world.models, *(inner for model in world.models for inner in _inside(model)))
    elements = [*(model.element for model in models), *(actor.element for actor in world.actors)]
    for element in elements:
        if element is not None and element.source is not own:
            yield element


def _inside(model: Model) -> Iterator[Model]:
    for inner in model.models:
        yield inner
        yield from _inside(inner)
