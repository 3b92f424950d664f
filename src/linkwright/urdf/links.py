"""Reading links: inertia, shapes and materials, by urdfdom's rules.

A part of a link that cannot be read does not make urdfdom refuse the model. The link stays, without that part and
without all that comes after it in the order inertial, visuals, collisions. So does ours; the error is reported.
"""

from __future__ import annotations

from linkwright.diagnostics import Note
from linkwright.urdf import schema
from linkwright.urdf.explain import explain_attributes, explain_missing_child, shape_hint
from linkwright.urdf.findings import Findings
from linkwright.urdf.materials import MaterialTable, read_material
from linkwright.urdf.model import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    Link,
    Material,
    Mesh,
    Pose,
    Sphere,
    Visual,
)
from linkwright.urdf.origins import read_origin
from linkwright.urdf.values import number, numbers, vector3
from linkwright.xmltree import Element

_Draft = tuple[Geometry, Pose, str, Material | None, Element]
"""A visual whose material is not resolved yet."""

_SIZES = {"box": ("size",), "cylinder": ("radius", "length"), "capsule": ("radius", "length"), "sphere": ("radius",)}


def first_children(element: Element) -> dict[str, Element]:
    """Tag -> the first child element of that tag."""
    first: dict[str, Element] = {}
    for child in element.children:
        if isinstance(child, Element) and child.tag not in first:
            first[child.tag] = child
    return first


def read_link(element: Element, materials: MaterialTable, findings: Findings) -> Link:
    """A link with what could be read of it; materials defined in it become known."""
    name = element.attributes.get("name")
    if name is None:
        findings.error("URDF120", "a link has no 'name'", element, hint='add name="..."')
        return Link("", element=element)
    owner = f"link '{name}'"
    before = len(findings)
    inertial_element: Element | None = None
    visual_elements: list[Element] = []
    collision_elements: list[Element] = []
    for child in element.children:
        if isinstance(child, Element):
            tag = child.tag
            if tag == "visual":
                visual_elements.append(child)
            elif tag == "collision":
                collision_elements.append(child)
            elif tag == "inertial" and inertial_element is None:
                inertial_element = child
    inertial = None if inertial_element is None else _read_inertial(inertial_element, owner, findings)
    whole = inertial_element is None or inertial is not None
    drafts: list[_Draft] = []
    collisions: list[Collision] = []
    for child in visual_elements:
        draft = _read_visual(child, owner, findings)
        whole = whole and draft is not None
        if whole and draft is not None:
            drafts.append(draft)
    for child in collision_elements:
        collision = _read_collision(child, owner, findings)
        whole = whole and collision is not None
        if whole and collision is not None:
            collisions.append(collision)
    if not whole:
        lost = [] if inertial_element is None or inertial is not None else ["its <inertial>"]
        lost_visuals, lost_collisions = len(visual_elements) - len(drafts), len(collision_elements) - len(collisions)
        lost += [f"{lost_visuals} <visual>"] if lost_visuals else []
        lost += [f"{lost_collisions} <collision>"] if lost_collisions else []
        findings.annotate(before, Note(f"{owner} is left without {', '.join(lost)}, as in urdfdom"))
    visuals = []
    for geometry, origin, label, own, child in drafts:
        if own is None:
            visuals.append(Visual(geometry, origin, label, "", None, child))
        else:
            visuals.append(Visual(geometry, origin, label, own.name, materials.resolve(own, owner), child))
    return Link(name, inertial, tuple(visuals), tuple(collisions), element)


def _read_inertial(element: Element, owner: str, findings: Findings) -> Inertial | None:
    first = first_children(element)
    origin = read_origin(first.get("origin"), owner, findings)
    mass_element, inertia_element = first.get("mass"), first.get("inertia")
    mass: float | None = None
    inertia: tuple[float, float, float, float, float, float] | None = None
    if mass_element is None:
        explain_missing_child(element, schema.INERTIAL, "mass", owner, findings)
    else:
        try:
            mass = number(mass_element.attributes["value"])
        except (KeyError, ValueError):
            explain_attributes(mass_element, schema.MASS, owner, findings)
    if inertia_element is None:
        explain_missing_child(element, schema.INERTIAL, "inertia", owner, findings)
    else:
        given = inertia_element.attributes
        try:
            inertia = (
                number(given["ixx"]),
                number(given["ixy"]),
                number(given["ixz"]),
                number(given["iyy"]),
                number(given["iyz"]),
                number(given["izz"]),
            )
        except (KeyError, ValueError):
            explain_attributes(inertia_element, schema.INERTIA, owner, findings)
    if origin is None or mass is None or inertia is None:
        return None
    return Inertial(mass, *inertia, origin, element)


def _read_visual(element: Element, owner: str, findings: Findings) -> _Draft | None:
    first = first_children(element)
    origin = read_origin(first.get("origin"), owner, findings)
    geometry = _read_geometry(element, schema.VISUAL, first.get("geometry"), owner, findings)
    material_element = first.get("material")
    material = None
    if material_element is not None:
        material = read_material(material_element, owner, findings)
        if material is None:
            return None
    if origin is None or geometry is None:
        return None
    return geometry, origin, element.attributes.get("name", ""), material, element


def _read_collision(element: Element, owner: str, findings: Findings) -> Collision | None:
    first = first_children(element)
    origin = read_origin(first.get("origin"), owner, findings)
    geometry = _read_geometry(element, schema.COLLISION, first.get("geometry"), owner, findings)
    if origin is None or geometry is None:
        return None
    return Collision(geometry, origin, element.attributes.get("name", ""), element)


def _read_geometry(
    parent: Element, rule: schema.ElementRule, element: Element | None, owner: str, findings: Findings
) -> Geometry | None:
    if element is None:
        explain_missing_child(parent, rule, "geometry", owner, findings)
        return None
    shape = next(element.elements(), None)
    if shape is None:
        hint = "put a box, cylinder, sphere or mesh in it"
        findings.error("URDF131", f"<geometry> of {owner} is empty", element, hint=hint)
        return None
    tag, given = shape.tag, shape.attributes
    geometry: Geometry | None = None
    try:
        if tag == "mesh":
            geometry = Mesh(given["filename"], vector3(given.get("scale", "1 1 1")))
        elif tag == "box":
            geometry = Box(vector3(given["size"]))
        elif tag == "cylinder":
            geometry = Cylinder(number(given["radius"]), number(given["length"]))
        elif tag == "sphere":
            geometry = Sphere(number(given["radius"]))
        elif tag == "capsule" and findings.version >= (1, 1):
            geometry = Capsule(number(given["radius"]), number(given["length"]))
    except (KeyError, ValueError):
        shape_rule = schema.GEOMETRY.child(tag)
        assert shape_rule is not None
        explain_attributes(shape, shape_rule, owner, findings)
        return None
    if geometry is None:
        _explain_unknown_shape(shape, owner, findings)
        return None
    if findings.version >= (1, 2) and not _sizes_are_positive(shape, owner, findings):
        return None
    return geometry


def _explain_unknown_shape(shape: Element, owner: str, findings: Findings) -> None:
    if shape.tag == "capsule":
        hint = 'write <robot version="1.1" ...>, or build it from a cylinder and two spheres'
        findings.error("URDF132", f"<capsule> of {owner} needs URDF 1.1", shape, hint=hint)
        return
    hint = shape_hint(shape.tag, schema.SHAPES)
    findings.error("URDF132", f"<{shape.tag}> in <geometry> of {owner} is not a shape", shape, hint=hint)


def _sizes_are_positive(shape: Element, owner: str, findings: Findings) -> bool:
    """URDF 1.2 wants every size above zero; older files may say anything."""
    good = True
    for name in _SIZES.get(shape.tag, ()):
        value = shape.attributes[name]
        if min(numbers(value)) <= 0:
            good = False
            message = f"'{name}' in <{shape.tag}> of {owner} is not above zero: '{value}'"
            findings.error("URDF123", message, shape, name, hint="URDF 1.2 wants sizes above zero")
    return good
