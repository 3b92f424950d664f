"""Rules about materials: their colours and names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Severity, Span
from linkwright.lint.fix import remove_element
from linkwright.lint.meshes import material_element
from linkwright.lint.rule import Rule
from linkwright.lint.rules.geometry import shapes_of
from linkwright.lint.subject import Subject
from linkwright.urdf import Link, Material, Mesh, Visual
from linkwright.urdf.findings import Findings
from linkwright.urdf.materials import read_material
from linkwright.xmltree import Element


def definitions(subject: Subject) -> Iterator[Material]:
    """Every material that has a colour or texture, as it is written: those of the robot, then those in visuals."""
    elements = [*subject.elements("material")]
    for link in subject.elements("link"):
        for visual in link.elements("visual"):
            own = visual.first("material")
            elements += [own] if own is not None else []
    for element in elements:
        material = read_material(element, "", Findings())
        if material is not None and (material.rgba is not None or material.texture is not None):
            yield material


def visuals(subject: Subject) -> Iterator[tuple[Link, Visual]]:
    """Every visual with its link."""
    for link, shape in shapes_of(subject):
        if isinstance(shape, Visual):
            yield link, shape


class RedefinedMaterial(Rule):
    """A material that is defined again with another colour.

    ## Why

    The first definition of a name in the file holds for all of them, even over the colour written right in the visual.
    So the second colour is never seen: "RViz shows the wrong colour".

    ## Example

    ```xml
    <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
    ...
    <visual>
      <material name="grey"><color rgba="0.2 0.2 0.2 1"/></material>
    </visual>
    ```

    ## Use instead

    A name of its own for each colour, such as `dark_grey`.
    """

    code = "LW501"
    name = "material-redefined"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        first: dict[str, Material] = {}
        global_names = {element.attributes.get("name") for element in subject.elements("material")}
        told: set[tuple[object, ...]] = set()
        for material in definitions(subject):
            if not material.name:
                continue
            known = first.setdefault(material.name, material)
            same = (known.rgba, known.texture) == (material.rgba, material.texture)
            element = material.element
            if same or element is None or known.element is None:
                continue
            if material.name in global_names and element in set(subject.elements("material")):
                continue  # two at robot level: the reader refuses them
            key = (material.name, material.rgba, material.texture)
            if key in told:
                continue
            told.add(key)
            yield self.report(
                f"material '{material.name}' is defined again with another {_difference(known, material)}, "
                "which is never seen",
                element,
                "name",
                notes=[Note(f"the first definition, {_look(known)}, holds", known.element.span())],
                hint="give this one a name of its own, or leave its colour out",
            )


class InvisibleMaterial(Rule):
    """A colour with an alpha of zero.

    ## Why

    The fourth number is the opacity. With 0 the part is there and cannot be seen; in exports from CAD it often comes
    from a transparency of 0.

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

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for material in definitions(subject):
            element = material.element
            if material.rgba is not None and material.rgba[3] == 0 and element is not None:
                red, green, blue, _ = material.rgba
                yield self.report(
                    f"material '{material.name}' is fully transparent"
                    if material.name
                    else "this material is fully transparent",
                    element.first("color") or element,
                    "rgba",
                    hint=f"the last number is the opacity: write '{red:g} {green:g} {blue:g} 1' to see it",
                )


class EmptyReference(Rule):
    """A material with an empty name and no colour.

    ## Why

    It refers to nothing, so the part gets whatever colour the tool has for parts without one.

    ## Example

    ```xml
    <material name=""/>
    ```

    ## Use instead

    The name of a material, or a colour in it.
    """

    code = "LW506"
    name = "material-name-empty"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        for link in subject.elements("link"):
            for visual in link.elements("visual"):
                element = visual.first("material")
                if element is None or element.attributes.get("name") != "":
                    continue
                if element.first("color") is None and element.first("texture") is None:
                    yield self.report(
                        f"a material of link '{link.attributes.get('name', '')}' has neither a name nor a colour",
                        element,
                        "name",
                        hint="name a material, or leave it out",
                        fix=remove_element(element),
                    )


class UnusedMaterial(Rule):
    """A material that no visual uses.

    ## Why

    Palettes are written once and used in part, so this is harmless; but a material that was made for one part and is
    not used often means that the part names another one.

    ## Example

    ```xml
    <material name="orange"><color rgba="1 0.4 0 1"/></material>
    ```

    in a robot whose visuals use `yellow` only.

    ## Use instead

    Use it, or take it out.
    """

    code = "LW507"
    name = "material-unused"
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        used = {
            material.attributes.get("name")
            for link in subject.elements("link")
            for visual in link.elements("visual")
            for material in visual.elements("material")
        }
        for element in subject.elements("material"):
            name = element.attributes.get("name")
            if name and name not in used:
                yield self.report(
                    f"material '{name}' is not used",
                    element,
                    "name",
                    hint="use it, or take it out",
                    fix=None if element.origin is not None else remove_element(element, safe=False),
                )


class NoMaterial(Rule):
    """A visual of a simple shape or an STL mesh without a material.

    ## Why

    Such a shape has no colour of its own, and each tool chooses another one: RViz white or red, Gazebo grey.

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
        """See the class."""
        for link, visual in visuals(subject):
            geometry = visual.geometry
            plain = not isinstance(geometry, Mesh) or geometry.filename.lower().endswith(".stl")
            if plain and material_element(visual) is None:
                yield self.report(
                    f"a visual of link '{link.name}' has no material",
                    visual.element,
                    hint='add <material name="..."/>',
                )


class AlikeNames(Rule):
    """Two materials whose names differ in capitals only.

    ## Why

    `Grey` and `grey` are two materials to URDF. Where both exist, one was probably meant to be the other.

    ## Example

    ```xml
    <material name="Grey"><color rgba="0.5 0.5 0.5 1"/></material>
    <material name="grey"><color rgba="0.2 0.2 0.2 1"/></material>
    ```

    ## Use instead

    One of them; names in small letters, by custom.
    """

    code = "LW509"
    name = "material-names-alike"
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        """See the class."""
        first: dict[str, Material] = {}
        told: set[str] = set()
        for material in definitions(subject):
            known = first.setdefault(material.name.casefold(), material)
            if known.name != material.name and material.name not in told:
                told.add(material.name)
                yield self.report(
                    f"material '{material.name}' differs from '{known.name}' in capitals only",
                    material.element,
                    "name",
                    notes=[Note(f"'{known.name}' is defined here", _place(known.element))],
                    hint="use one name",
                )


def _difference(first: Material, second: Material) -> str:
    return "colour" if first.rgba != second.rgba else "texture"


def _look(material: Material) -> str:
    if material.rgba is not None:
        return f"'{' '.join(f'{part:g}' for part in material.rgba)}'"
    return f"'{material.texture}'"


def _place(element: Element | None) -> Span | None:
    return element.span() if element is not None else None
