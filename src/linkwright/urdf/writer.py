"""Writing a robot as URDF, in the order of the robot, so that reading it back gives an equal robot."""

from __future__ import annotations

from collections.abc import Iterable
from math import isinf

from linkwright.urdf.model import (
    Box,
    Collision,
    Geometry,
    Inertial,
    Joint,
    Limit,
    Link,
    Material,
    Mesh,
    Pose,
    Robot,
    Sphere,
    Visual,
)
from linkwright.urdf.values import plain
from linkwright.xmltree import Document, Element, Text, write

_IDENTITY = Pose()


def save(robot: Robot) -> str:
    """The robot as URDF text; defaults are left out, numbers are as short as they can be without loss.

    Materials stand at robot level. Elements of other rooms (``gazebo``, ``ros2_control``, ...) follow at the end
    as they were read.
    """
    attributes = {"name": robot.name}
    if robot.version != (1, 0):
        attributes["version"] = f"{robot.version[0]}.{robot.version[1]}"
    root = _element("robot", attributes)
    root.children += [_material(material) for material in robot.materials.values()]
    root.children += [_link(link) for link in robot.links.values()]
    root.children += [_joint(joint) for joint in robot.joints.values()]
    root.children += map(_tidied, robot.extensions)
    if robot.element is not None:
        # The extensions may use prefixes that the file declared on its root.
        prefixes = {name: value for name, value in robot.element.attributes.items() if name.startswith("xmlns")}
        root.attributes = {**attributes, **prefixes}
    return write(Document(root))


def _tidied(root: Element) -> Element:
    """A copy whose texts beside elements have no blanks around them, or writing would add some each time."""
    top = Element(root.tag, dict(root.attributes))
    todo = [(root, top)]  # not by recursion: what is nested too deep is for the writer to say
    while todo:
        element, copy = todo.pop()
        mixed = any(not isinstance(child, Text) for child in element.children)
        for child in element.children:
            if isinstance(child, Element):
                inner = Element(child.tag, dict(child.attributes))
                copy.children.append(inner)
                todo.append((child, inner))
            elif mixed and isinstance(child, Text) and not child.cdata:
                if text := child.data.strip():
                    copy.children.append(Text(text))
            else:
                copy.children.append(child)
    return top


def _element(tag: str, attributes: dict[str, str] | None = None, *children: Element | None) -> Element:
    element = Element(tag, attributes or {})
    element.children += [child for child in children if child is not None]
    return element


def _origin(pose: Pose) -> Element | None:
    if pose == _IDENTITY:
        return None
    attributes = {}
    if pose.xyz != _IDENTITY.xyz:
        attributes["xyz"] = _list(pose.xyz)
    if pose.quaternion is not None:
        attributes["quat_xyzw"] = _list(pose.quaternion)
    elif pose.rpy != _IDENTITY.rpy:
        attributes["rpy"] = _list(pose.rpy)
    return _element("origin", attributes)


def _material(material: Material) -> Element:
    color = None if material.rgba is None else _element("color", {"rgba": _list(material.rgba)})
    texture = None if material.texture is None else _element("texture", {"filename": material.texture})
    return _element("material", {"name": material.name}, color, texture)


def _link(link: Link) -> Element:
    inertial = None if link.inertial is None else _inertial(link.inertial)
    shapes = [_visual(visual) for visual in link.visuals] + [_collision(each) for each in link.collisions]
    return _element("link", {"name": link.name}, inertial, *shapes)


def _inertial(inertial: Inertial) -> Element:
    tensor = {name: plain(getattr(inertial, name)) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
    mass = _element("mass", {"value": plain(inertial.mass)})
    return _element("inertial", None, _origin(inertial.origin), mass, _element("inertia", tensor))


def _visual(visual: Visual) -> Element:
    material = None
    if visual.material_name:
        material = _element("material", {"name": visual.material_name})
    elif visual.material is not None:
        material = _material(visual.material)  # one without a name is its visual's alone
    return _element("visual", _label(visual.name), _origin(visual.origin), _geometry(visual.geometry), material)


def _collision(collision: Collision) -> Element:
    return _element("collision", _label(collision.name), _origin(collision.origin), _geometry(collision.geometry))


def _label(name: str) -> dict[str, str]:
    return {"name": name} if name else {}


def _geometry(geometry: Geometry) -> Element:
    if isinstance(geometry, Box):
        shape = _element("box", {"size": _list(geometry.size)})
    elif isinstance(geometry, Sphere):
        shape = _element("sphere", {"radius": plain(geometry.radius)})
    elif isinstance(geometry, Mesh):
        shape = _element("mesh", {"filename": geometry.filename})
        if geometry.scale != (1.0, 1.0, 1.0):
            shape.attributes["scale"] = _list(geometry.scale)
    else:
        sizes = {"radius": plain(geometry.radius), "length": plain(geometry.length)}
        shape = _element(type(geometry).__name__.lower(), sizes)
    return _element("geometry", None, shape)


def _joint(joint: Joint) -> Element:
    element = _element("joint", {"name": joint.name, "type": joint.type}, _origin(joint.origin))
    parts = element.children
    parts.append(_element("parent", {"link": joint.parent}))
    parts.append(_element("child", {"link": joint.child}))
    if joint.type not in ("fixed", "floating"):
        parts.append(_element("axis", {"xyz": _list(joint.axis)}))
    if joint.limit is not None:
        parts.append(_element("limit", _limit(joint.limit)))
    if joint.mimic is not None:
        parts.append(
            _element(
                "mimic",
                {
                    "joint": joint.mimic.joint,
                    "multiplier": plain(joint.mimic.multiplier),
                    "offset": plain(joint.mimic.offset),
                },
            )
        )
    for tag, part in (
        ("safety_controller", joint.safety),
        ("dynamics", joint.dynamics),
        ("calibration", joint.calibration),
    ):
        if part is not None:
            given = ((name, getattr(part, name)) for name in type(part).__dataclass_fields__)
            parts.append(_element(tag, {name: plain(value) for name, value in given if value is not None}))
    return element


def _limit(limit: Limit) -> dict[str, str]:
    """The attributes of a limit; an infinite bound is one that is not given."""
    given = ((name, getattr(limit, name)) for name in type(limit).__dataclass_fields__)
    return {name: plain(value) for name, value in given if value is not None and not isinf(value)}


def _list(values: Iterable[float]) -> str:
    return " ".join(map(plain, values))
