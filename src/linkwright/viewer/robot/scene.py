"""A robot as the page draws it: links with their shapes, colours, files and places."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from linkwright.geometry.single import quaternion_of
from linkwright.urdf import Box, Capsule, Collision, Cylinder, Link, Material, Mesh, Robot, Sphere, Visual
from linkwright.viewer.protocol.parts import Place
from linkwright.viewer.protocol.robot import JointScene, LinkScene, Shape
from linkwright.viewer.robot.inertia import link_inertia
from linkwright.viewer.web.files import IMAGE_TYPES, MESH_TYPES, MeshIndex
from linkwright.xacro.origin import origin_of
from linkwright.xmltree import Element


def place_of(element: Element | None) -> Place | None:
    """Where an element was written, and through which macro calls and includes it came; None if a program made it."""
    if element is None:
        return None
    origin = origin_of(element)
    if origin.span is None:
        return None
    return Place(
        file=origin.span.file,
        line=origin.span.line,
        column=origin.span.column,
        trail=[f"{note.message}: {note.span}" if note.span else note.message for note in origin.trail],
    )


def folder_of(element: Element | None) -> Path | None:
    """The folder of the file an element was written in, from which relative paths in it start; None if it has none."""
    if element is None or element.source is None or element.source.name.startswith("<"):
        return None
    return Path(element.source.name).parent


def frame_of(link: str, prefix: str) -> str:
    """The tf frame of a link for a display's TF Prefix; RViz joins them with a slash."""
    return f"{prefix}/{link}" if prefix else link


class SceneBuilder:
    """Turns a robot into what the page draws.

    A visual has the colour of its material; each of several visuals its own, which RViz gets wrong. A collision has
    that of the link's first visual, as in RViz.

    Attributes:
        index: the files found on the way, for `MeshFolders`.
        problems: link -> what is wrong with files that it names, in RViz's manner of speaking.
    """

    def __init__(self, index: MeshIndex) -> None:
        self.index = index
        self.problems: dict[str, list[str]] = {}

    def links(self, robot: Robot, prefix: str) -> list[LinkScene]:
        """The links in file order, with frames named by the display's TF Prefix."""
        parents = {joint.child: joint.name for joint in robot.joints.values()}
        return [self._link(link, prefix, parents.get(link.name)) for link in robot.links.values()]

    def joints(self, robot: Robot) -> list[JointScene]:
        """The joints in file order."""
        return [
            JointScene(
                name=joint.name,
                kind=joint.type,
                parent=joint.parent,
                child=joint.child,
                position=list(joint.origin.xyz),
                quaternion=list(quaternion_of(joint.origin)),
                axis=list(joint.axis),
                lower=_finite(joint.limit.lower) if joint.limit else None,
                upper=_finite(joint.limit.upper) if joint.limit else None,
            )
            for joint in robot.joints.values()
        ]

    def _link(self, link: Link, prefix: str, parent_joint: str | None) -> LinkScene:
        first = link.visuals[0].material if link.visuals else None
        return LinkScene(
            name=link.name,
            frame=frame_of(link.name, prefix),
            parent_joint=parent_joint,
            visuals=self._shapes(link, link.visuals),
            collisions=self._shapes(link, link.collisions, first),
            place=place_of(link.element),
            inertia=link_inertia(link.inertial),
        )

    def _shapes(self, link: Link, parts: Sequence[Visual | Collision], material: Material | None = None) -> list[Shape]:
        shapes = (self._shape(link, part, part.material if isinstance(part, Visual) else material) for part in parts)
        return [shape for shape in shapes if shape is not None]

    def _shape(self, link: Link, part: Visual | Collision, material: Material | None) -> Shape | None:
        geometry = part.geometry
        shape = Shape(
            kind="mesh",
            size=[],
            position=list(part.origin.xyz),
            quaternion=list(quaternion_of(part.origin)),
            color=list(material.rgba) if material and material.rgba else None,
            texture=self._texture(link, material),
            name=part.name,
        )
        if isinstance(geometry, Box):
            shape.kind, shape.size = "box", list(geometry.size)
        elif isinstance(geometry, Cylinder):
            shape.kind, shape.size = "cylinder", [geometry.radius, geometry.length]
        elif isinstance(geometry, Capsule):
            shape.kind, shape.size = "capsule", [geometry.radius, geometry.length]
        elif isinstance(geometry, Sphere):
            shape.kind, shape.size = "sphere", [geometry.radius]
        else:
            return self._mesh(link, part, geometry, shape)
        return shape

    def _mesh(self, link: Link, part: Visual | Collision, mesh: Mesh, shape: Shape) -> Shape | None:
        located = self.index.locate(mesh.filename, folder_of(part.element), MESH_TYPES)
        if located.url is None:
            self._problem(link, f"Could not load mesh resource '{mesh.filename}': {located.problem}")
            return None
        shape.size = list(mesh.scale)
        shape.url = located.url
        shape.format = mesh.filename.rpartition(".")[2].lower()
        return shape

    def _texture(self, link: Link, material: Material | None) -> str | None:
        if material is None or not material.texture:
            return None
        located = self.index.locate(material.texture, folder_of(material.element), IMAGE_TYPES)
        if located.url is None:
            self._problem(link, f"Could not load texture '{material.texture}': {located.problem}")
        return located.url

    def _problem(self, link: Link, text: str) -> None:
        problems = self.problems.setdefault(link.name, [])
        if text not in problems:
            problems.append(text)


def _finite(number: float) -> float | None:
    return number if math.isfinite(number) else None
