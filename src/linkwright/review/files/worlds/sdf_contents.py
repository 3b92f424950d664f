"""Summarize added SDF elements in one line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.plugins import format_contents, format_plugins
from linkwright.review.texts.element_values import format_own_content, format_values
from linkwright.xmltree import Element

_MAX_VALUES_OF_PLUGIN = 4
"""The maximum number of values of each plugin or sensor in the line about an added world or model."""
_WORLD = "world"
_ENGINES = ("ode", "bullet", "dart", "simbody")
"""The elements of ``<physics>`` with the settings of an engine."""
_INCLUDE = "include"
"""The tag of elements that have their name, or else their URI, as a child."""


def summarize_element(element: Element) -> Iterator[Phrase]:
    """Yield the models of a world or the links and joints of a model, plugins and sensors."""
    names = {
        tag: [_get_name(child) for child in element.elements(tag)] for tag in ("model", "include", "link", "joint")
    }
    models = [*names["model"], *names["include"]]
    if models:
        yield phrase("models {names}", names=joined_first(models, MAX_NAMES))
    if names["link"]:
        yield phrase("links {names}", names=joined_first(names["link"], MAX_NAMES))
    if names["joint"]:
        yield phrase("joints {names}", names=joined_first(names["joint"], MAX_NAMES))
    if element.tag == _WORLD:
        yield from _summarize_surroundings(element)
    yield from format_plugins(element, _MAX_VALUES_OF_PLUGIN)


def _summarize_surroundings(world: Element) -> Iterator[Phrase]:
    """Yield the lights, the steps of the physics and the gravity of a world."""
    lights = [_get_name(light) for light in world.elements("light")]
    if lights:
        yield phrase("lights {names}", names=joined_first(lights, MAX_NAMES))
    for physics in world.elements("physics"):
        values = format_values(physics, _MAX_VALUES_OF_PLUGIN, _ENGINES)
        if values is not None:
            yield phrase("physics {values}", values=values)
    for gravity in world.elements("gravity"):
        yield phrase("gravity {values}", values=gravity.text().strip())


def summarize_shapes_and_mass(model: Element) -> Iterator[Phrase]:
    """Yield the shapes of a model, and the total mass of the links that have a mass."""
    shapes: Counter[tuple[str, str]] = Counter()
    for element in model.walk():
        geometry = element.first("geometry") if element.tag in ("visual", "collision") else None
        for shape in () if geometry is None else geometry.elements():
            values = format_values(shape, _MAX_VALUES_OF_PLUGIN) or ""
            shapes[element.tag, f"{shape.tag} {values}".strip()] += 1
    texts = []
    for (tag, name), count in shapes.items():
        text = phrase("visual {shape}", shape=name) if tag == "visual" else phrase("collision {shape}", shape=name)
        texts.append(text if count == 1 else phrase("{part} ({count} times)", part=text, count=count))
    if texts:
        yield joined_first(texts, MAX_NAMES)
    masses = [
        element.text()
        for inertial in model.walk()
        if inertial.tag == "inertial"
        for element in inertial.elements("mass")
    ]
    try:
        mass = sum(float(text) for text in masses)
    except ValueError:
        return  # a template
    if masses:
        yield phrase("mass {mass:.4g} kg", mass=mass)


def _get_name(element: Element) -> str:
    """Return the name of an element; the last part of the URI for an unnamed include."""
    texts = (element.first(tag) for tag in ("name", "uri"))
    included = next((text.text().strip().rstrip("/") for text in texts if text is not None), "")
    return element.attributes.get("name") or included.rpartition("/")[2]


def join_contents(element: Element) -> str:
    """Return the attributes and texts of an element and all its descendants, without names."""
    return " ".join(filter(None, (f"{child.tag} {format_own_content(child)}" for child in element.walk())))


def format_added_element(path: str, element: Element) -> Phrase:
    """Return the line about an added element, with its values.

    Args:
        path: the path of the element, with the names of elements that were added with the same contents.
        element: the XML element.
    """
    contents = joined([*_list_place(element), *names]) if (names := list(summarize_element(element))) else None
    if contents is None:
        element, path = _find_only_descendant(element, path)
        contents = format_contents(element)
    text = phrase("{element} added", element=f"{path} {format_own_content(element)}".strip())
    return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)


def _list_place(element: Element) -> Iterator[str]:
    """Yield the address and the pose of an added model."""
    children = (element.first(tag) for tag in ("uri", "pose"))
    yield from (f"{child.tag} {' '.join(child.text().split())}" for child in children if child is not None)


def _find_only_descendant(element: Element, path: str) -> tuple[Element, str]:
    """Return the element that has the content of an element, with its path.

    For a nameless element without values, this is the first descendant with a value or several children.
    """
    children = list(element.elements())
    while len(children) == 1 and not (element.attributes or element.text().strip() or element.tag == _INCLUDE):
        element = children[0]
        path = " ".join(filter(None, (path, element.tag, element.attributes.get("name"))))
        children = list(element.elements())
    return element, path
