"""Rules about materials: their colors and names."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, Span, phrase
from linkwright.lint.fix import remove_element
from linkwright.lint.meshes import material_element
from linkwright.lint.rule import Rule
from linkwright.lint.rules.geometry import iterate_shapes
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.urdf import Link, Material, Mesh, Visual
from linkwright.urdf.reader import read_material
from linkwright.urdf.report import UrdfReport
from linkwright.xmltree import Element

_INVISIBLE_NAME = lazy_pattern(r"invisib|transparen|hidden|unseen|clear|none|null|empty|dummy", re.IGNORECASE)

_MAX_COLOR_DIFFERENCE = 0.1001
"""The largest difference of a channel from 0 to 1 at which colors look alike, with room for rounding."""


def iterate_definitions(subject: Subject) -> Iterator[Material]:
    """Yield every material with a color or texture, first at robot level, then in visuals."""
    elements = [*subject.elements("material")]
    for link in subject.elements("link"):
        for visual in link.elements("visual"):
            material_child = visual.first("material")
            elements += [material_child] if material_child is not None else []
    for element in elements:
        material = read_material(element, element, UrdfReport())
        if material is not None and (material.rgba is not None or material.texture is not None):
            yield material


def iterate_visuals(subject: Subject) -> Iterator[tuple[Link, Visual]]:
    """Yield every visual with its link."""
    for link, shape in iterate_shapes(subject):
        if isinstance(shape, Visual):
            yield link, shape


class RedefinedMaterial(Rule):
    """A material that is defined again with a different color.

    ## Why

    The first definition of a name in the file applies to all uses of the name, even to a visual that defines another
    color. Therefore, the second color is never shown, and users complain that RViz shows the wrong color. If the two
    colors look the same, the finding is only informational.

    ## Example

    ```xml
    <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
    ...
    <visual>
      <material name="grey"><color rgba="0.2 0.2 0.2 1"/></material>
    </visual>
    ```

    ## Use instead

    Give each color its own name, such as `dark_gray`.
    """

    code = "LW501"
    name = "material-redefined"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        first_definitions: dict[str, Material] = {}
        global_names = {element.attributes.get("name") for element in subject.elements("material")}
        reported_keys: set[tuple[object, ...]] = set()
        for material in iterate_definitions(subject):
            if not material.name:
                continue
            first_definition = first_definitions.setdefault(material.name, material)
            is_same = (first_definition.rgba, first_definition.texture) == (material.rgba, material.texture)
            element = material.element
            if is_same or element is None or first_definition.element is None:
                continue
            if material.name in global_names and element in set(subject.elements("material")):
                continue  # the reader reports two definitions at robot level
            key = (material.name, material.rgba, material.texture)
            if key in reported_keys:
                continue
            reported_keys.add(key)
            yield self.report(
                phrase(
                    "material '{name}' is defined again with another {difference}, which is never shown",
                    name=material.name,
                    difference=_describe_difference(first_definition, material),
                ),
                element,
                "name",
                notes=[
                    Note(
                        phrase(
                            "the first definition, '{color}', is used", color=_describe_appearance(first_definition)
                        ),
                        first_definition.element.span(),
                    )
                ],
                hint=phrase("give this material another name, or leave its color out"),
                severity=Severity.INFO if _looks_alike(first_definition, material) else None,
            )


class InvisibleMaterial(Rule):
    """A color with an alpha of zero.

    ## Why

    The fourth number is the opacity. With 0, the part exists but is invisible. CAD exporters often confuse the opacity
    with a transparency of 0. If a material is defined twice, the first definition counts. A material whose name shows
    that it is invisible is not reported.

    ## Example

    ```xml
    <color rgba="0.8 0.1 0.1 0"/>
    ```

    ## Use instead

    ```xml
    <color rgba="0.8 0.1 0.1 1"/>
    ```
    """

    code = "LW502"
    name = "material-invisible"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        checked_names: set[str] = set()
        for material in iterate_definitions(subject):
            element = material.element
            if material.name:
                if material.name in checked_names or _INVISIBLE_NAME.search(material.name):
                    continue
                checked_names.add(material.name)
            if material.rgba is not None and material.rgba[3] == 0 and element is not None:
                red, green, blue, _ = material.rgba
                yield self.report(
                    phrase("material '{name}' is fully transparent", name=material.name)
                    if material.name
                    else phrase("this material is fully transparent"),
                    element.first("color") or element,
                    "rgba",
                    hint=phrase(
                        "the last number is the opacity: write '{red:g} {green:g} {blue:g} 1' to see it",
                        red=red,
                        green=green,
                        blue=blue,
                    ),
                )


class EmptyReference(Rule):
    """A material with an empty name and no color.

    ## Why

    The material refers to nothing, so each tool shows the part in its default color.

    ## Example

    ```xml
    <material name=""/>
    ```

    ## Use instead

    Write the name of a material, or add a `<color>` to the element.
    """

    code = "LW506"
    name = "material-name-empty"
    holds_for_parts = True

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link in subject.elements("link"):
            for visual in link.elements("visual"):
                element = visual.first("material")
                if element is None or element.attributes.get("name") != "":
                    continue
                if element.first("color") is None and element.first("texture") is None:
                    yield self.report(
                        phrase(
                            "a material of link '{link}' has neither a name nor a color",
                            link=link.attributes.get("name", ""),
                        ),
                        element,
                        "name",
                        hint=phrase("give the name of a material, or remove the element"),
                        fix=remove_element(element),
                    )


class UnusedMaterial(Rule):
    """A material that no visual uses.

    ## Why

    Often, a robot only uses some colors of a palette, which is harmless. However, if the material was intended for one
    part, this part probably names the wrong material.

    ## Example

    ```xml
    <material name="orange"><color rgba="1 0.4 0 1"/></material>
    ```

    in a robot whose visuals use `yellow` only.

    ## Use instead

    Use the material, or remove it.
    """

    code = "LW507"
    name = "material-unused"
    needs_all_sets = True
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        used_names = {
            material.attributes.get("name")
            for link in subject.elements("link")
            for visual in link.elements("visual")
            for material in visual.elements("material")
        }
        for element in subject.elements("material"):
            name = element.attributes.get("name")
            if name and name not in used_names:
                yield self.report(
                    phrase("material '{name}' is not used", name=name),
                    element,
                    "name",
                    hint=phrase("use it, or remove it"),
                    fix=None if element.origin is not None else remove_element(element, safe=False),
                )


class NoMaterial(Rule):
    """A visual of a simple shape or an STL mesh without a material.

    ## Why

    Such a shape has no color, and each tool chooses a different one: RViz white or red, Gazebo gray.

    ## Example

    ```xml
    <visual>
      <geometry><box size="0.1 0.1 0.1"/></geometry>
    </visual>
    ```

    ## Use instead

    ```xml
    <visual>
      <geometry><box size="0.1 0.1 0.1"/></geometry>
      <material name="grey"/>
    </visual>
    ```
    """

    code = "LW508"
    name = "visual-without-material"
    severity = Severity.INFO
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, visual in iterate_visuals(subject):
            geometry = visual.geometry
            has_no_color = not isinstance(geometry, Mesh) or geometry.filename.lower().endswith(".stl")
            if has_no_color and material_element(visual) is None:
                yield self.report(
                    phrase("a visual of link '{name}' has no material", name=link.name),
                    visual.element,
                    hint=phrase('add <material name="..."/>'),
                )


class MaterialNamesDifferInCase(Rule):
    """Two materials whose names differ only in upper and lower case.

    ## Why

    `Gray` and `gray` are two different materials in URDF. If both exist, probably only one was intended.

    ## Example

    ```xml
    <material name="Grey"><color rgba="0.5 0.5 0.5 1"/></material>
    <material name="grey"><color rgba="0.2 0.2 0.2 1"/></material>
    ```

    ## Use instead

    Write the same name everywhere. By convention, names are lower case.
    """

    code = "LW509"
    name = "material-names-alike"
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        first_materials: dict[str, Material] = {}
        reported_names: set[str] = set()
        for material in iterate_definitions(subject):
            first_material = first_materials.setdefault(material.name.casefold(), material)
            if first_material.name != material.name and material.name not in reported_names:
                reported_names.add(material.name)
                yield self.report(
                    phrase(
                        "material '{name}' differs from '{known_name}' only in upper and lower case",
                        name=material.name,
                        known_name=first_material.name,
                    ),
                    material.element,
                    "name",
                    notes=[
                        Note(
                            phrase("'{name}' is defined here", name=first_material.name),
                            _find_span(first_material.element),
                        )
                    ],
                    hint=phrase("use the same name in both places"),
                )


def _describe_difference(first: Material, second: Material) -> Phrase:
    return phrase("color") if first.rgba != second.rgba else phrase("texture")


def _looks_alike(first: Material, second: Material) -> bool:
    """Return whether two colors can only be distinguished side by side."""
    if first.rgba is None or second.rgba is None or first.texture != second.texture:
        return False
    return all(
        abs(first_channel - second_channel) <= _MAX_COLOR_DIFFERENCE
        for first_channel, second_channel in zip(first.rgba, second.rgba, strict=True)
    )


def _describe_appearance(material: Material) -> str:
    if material.rgba is not None:
        return " ".join(f"{channel:g}" for channel in material.rgba)
    return str(material.texture)


def _find_span(element: Element | None) -> Span | None:
    return element.span() if element is not None else None
