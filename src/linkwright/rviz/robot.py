"""A robot for the page: the source of its description, its shapes and its size.

A description is received on a topic or read from a file. It is converted to links with shapes, colors, files and
poses, which pages draw.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from math import dist, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.descriptions import examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.geometry.arrays import Array, quaternion_from_matrix
from linkwright.geometry.shapes import Bounds, Placement, placement, shape_bounds, union
from linkwright.geometry.single import pose_quaternion
from linkwright.graph import DurabilityPolicy, MessageInfo
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.introspection.graph_queries import UNKNOWN_NODE
from linkwright.kinematics import KinematicTree
from linkwright.messages import String
from linkwright.packages import PackageFinder
from linkwright.page.files import IMAGE_TYPES, MESH_TYPES, MeshIndex
from linkwright.page.protocol.configuration import Place
from linkwright.page.protocol.description import LinkInertia
from linkwright.page.protocol.robot import JointScene, LinkScene, Shape
from linkwright.rviz.config.property_store import PropertyStore, qos_from_properties
from linkwright.rviz.config.schema import PropertySpec, topic_spec
from linkwright.rviz.config.views import ModelSize
from linkwright.rviz.context import ViewerContext
from linkwright.urdf import Box, Capsule, Collision, Cylinder, Inertial, Link, Material, Mesh, Robot, Sphere, Visual
from linkwright.xacro.faults import origin_of
from linkwright.xmltree import Element

_MIN_DISTANCE = 1e-6
"""Frames that are closer than this have the same position, in m."""


def estimate_size(robot: Robot) -> ModelSize | None:
    """Return the size of a robot whose joints are at zero, or None if it has no extent.

    The size is computed from the frames of the links, and from visuals and collisions with simple shapes. A page
    computes the exact size once it has read the meshes, but draws axes earlier.
    """
    tree = KinematicTree(robot)
    frames = dict(zip(tree.link_names, map(_placement_from_matrix, tree.forward({})), strict=True))
    boxes = [Bounds(frame.position, frame.position) for frame in frames.values()]
    boxes += [box.moved(frames[name]) for name in frames for box in _find_simple_shape_bounds(robot, name)]
    bounds = union(boxes)
    if bounds is None or not isfinite(bounds.diagonal) or bounds.diagonal < _MIN_DISTANCE:
        return None
    distances = [
        dist(frames[joint.child].position, frames[joint.parent].position)
        for joint in robot.joints.values()
        if joint.child in frames and joint.parent in frames
    ]
    nonzero_distances = [distance for distance in distances if distance > _MIN_DISTANCE]
    return ModelSize(bounds.diagonal, float(np.median(nonzero_distances)) if nonzero_distances else bounds.diagonal)


def _find_simple_shape_bounds(robot: Robot, link: str) -> Iterator[Bounds]:
    """Yield the bounding boxes of a link's shapes other than meshes, in the link's frame."""
    shapes: tuple[Visual | Collision, ...] = (*robot.links[link].visuals, *robot.links[link].collisions)
    for shape in shapes:
        if not isinstance(shape.geometry, Mesh):
            yield shape_bounds(shape.geometry).moved(placement(shape.origin))


def _placement_from_matrix(matrix: Array) -> Placement:
    (a, b, c, x), (d, e, f, y), (g, h, i, z), _ = matrix.tolist()
    return Placement(((a, b, c), (d, e, f), (g, h, i)), (x, y, z))


SOURCE = "Description Source"
FILE = "Description File"
TOPIC = "Description Topic"

DESCRIPTION_SPECS = (
    PropertySpec(SOURCE, "enum", "Topic", "The source of the description.", options=("Topic", "File")),
    PropertySpec(
        FILE,
        "string",
        "",
        "A URDF or xacro file: a path or a package:// address.",
        when=((SOURCE,), "File"),
    ),
    topic_spec(
        TOPIC,
        "/robot_description",
        "The topic of the description, std_msgs/msg/String.",
        depth=1,
        durability="Transient Local",
        durability_help="Whether to receive a description that was published before. This display always "
        "does: most files set Volatile, with which the robot would appear only by chance.",
        when=((SOURCE,), "Topic"),
    ),
)


class DescriptionSource:
    """The source of a robot description that a display's properties select: a topic or a file.

    Args:
        context: the viewer's context. Its library stores descriptions that were read from files, with their source
            positions.
        properties: the display's properties, with `DESCRIPTION_SPECS`.
        on_text: called with the text of each description.
        on_refusal: called with the findings if a file cannot be read.
    """

    def __init__(
        self,
        context: ViewerContext,
        properties: PropertyStore,
        on_text: Callable[[str], None],
        on_refusal: Callable[[Sequence[Diagnostic]], None],
    ) -> None:
        self._context = context
        self._properties = properties
        self._on_text = on_text
        self._on_refusal = on_refusal
        self._subscriptions: list[Any] = []
        self._reading_task: asyncio.Task[None] | None = None
        self._publishers: dict[bytes, EndpointInfo | None] = {}
        self.publisher: bytes | None = None
        """The GID of the publisher of the last description, or None before the first one and for a file."""

    def follow(self) -> Phrase | None:
        """Subscribe to the topic or start reading the file that the properties select.

        Return RViz's error text if that fails, or None.
        """
        self.close()
        if self._properties.text(SOURCE) == "File":
            return self._read_file(self._properties.text(FILE).strip())
        return self._subscribe(self._properties.text(TOPIC).strip())

    def close(self) -> None:
        """Unsubscribe, and cancel reading a file."""
        for subscription in self._subscriptions:
            with suppress(ValueError):  # the node may already have been destroyed
                self._context.node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self._publishers.clear()
        self.publisher = None
        if self._reading_task is not None:
            self._reading_task.cancel()
            self._reading_task = None

    def _subscribe(self, topic: str) -> Phrase | None:
        if not topic:
            return phrase("Error subscribing: Empty topic name")
        requested_qos = qos_from_properties(self._properties, TOPIC)
        # A second subscription uses the durability of the file, for publishers that do not offer transient local.
        profiles = [qos_from_properties(self._properties, TOPIC, transient_local=True)]
        if requested_qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
            profiles.append(requested_qos)
        try:
            for profile in profiles:
                self._subscriptions.append(
                    self._context.node.create_subscription(String, topic, self._on_received, profile)
                )
        except LinkwrightError as error:
            return phrase("Error subscribing: {message}", message=error.diagnostics[0].message)
        return None

    def publishers(self) -> dict[bytes, str]:
        """Return the publishers of the descriptions received so far that still exist.

        The keys are GIDs; a value consists of the node's name and, if known, its host.
        """
        if not self._publishers:
            return {}
        gids = set(map(self.find_current_gid, self._publishers))
        return {
            endpoint.gid: _describe_node(endpoint)
            for endpoint in self._context.node.graph.endpoints()
            if endpoint.gid in gids
        }

    def find_current_gid(self, gid: bytes) -> bytes:
        """Return the current GID of a publisher, given a GID that it has or had.

        The GIDs of this process's publishers change when the process joins a network.
        """
        previous = self._publishers.get(gid)
        if previous is None or not previous.local:
            return gid
        candidates = (
            endpoint
            for endpoint in self._context.node.graph.endpoints()
            if endpoint.local and endpoint.kind is previous.kind
        )
        return next(
            (
                endpoint.gid
                for endpoint in candidates
                if (endpoint.node, endpoint.name) == (previous.node, previous.name)
            ),
            gid,
        )

    def _on_received(self, message: String, info: MessageInfo) -> None:
        self.publisher = info.publisher_gid
        if self.publisher not in self._publishers:
            endpoints = self._context.node.graph.endpoints()
            self._publishers[self.publisher] = next(
                (endpoint for endpoint in endpoints if endpoint.gid == self.publisher), None
            )
        self._on_text(message.data)

    def _read_file(self, address: str) -> Phrase | None:
        if not address:
            return phrase("No Description File is set")
        self._reading_task = asyncio.get_running_loop().create_task(self._read(address))
        return None

    async def _read(self, address: str) -> None:
        try:
            path: Path = self._context.finder.resolve(address)
            description = await asyncio.to_thread(examine, path, packages=self._context.finder, xacro=True)
        except LinkwrightError as error:
            self._on_refusal(error.diagnostics)
            return
        self._on_text(self._context.library.store(description))


def _describe_node(publisher: EndpointInfo) -> str:
    name = (publisher.node or UNKNOWN_NODE).full_name
    return f"{name} on {publisher.host}" if publisher.host else name


def make_link_inertia(inertial: Inertial | None) -> LinkInertia | None:
    """Return a link's mass, center of mass and equivalent box, or None if not computable."""
    if inertial is None or not inertial.is_computable:
        return None
    properties = inertial.properties
    box = properties.equivalent_box()
    edges = [] if box is None or not np.isfinite(box).all() else [float(edge) for edge in box]
    axes = properties.principal().axes if edges else np.eye(3)
    return LinkInertia(
        mass=float(properties.mass),
        center=[float(coordinate) for coordinate in properties.center],
        box=edges,
        quaternion=[float(component) for component in quaternion_from_matrix(axes)],
    )


def find_place(element: Element | None) -> Place | None:
    """Return the source position of an element, or None if a program generated the element.

    The position includes the macro calls and includes that led to the element.
    """
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


def find_folder(element: Element | None) -> Path | None:
    """Return the folder of the file that contains an element, or None if there is no file.

    Relative paths in the element are relative to this folder.
    """
    if element is None or element.source is None or element.source.name.startswith("<"):
        return None
    return Path(element.source.name).parent


def get_frame_name(link: str, prefix: str) -> str:
    """Return the tf frame of a link: its name, preceded by the TF Prefix and a slash if set."""
    return f"{prefix}/{link}" if prefix else link


def has_visuals(robot: Robot, finder: PackageFinder) -> bool:
    """Return whether a robot has a visual that can be drawn.

    Args:
        robot: the robot's description.
        finder: finds the files of the robot's meshes.
    """
    return any(link.visuals for link in SceneBuilder(MeshIndex(finder)).links(robot, ""))


class SceneBuilder:
    """A converter of robots to the page's form.

    Each visual has the color of its own material, whereas RViz colors links with several visuals incorrectly. A
    collision has the color of the link's first visual, as in RViz.

    Attributes:
        index: finds mesh and texture files, and collects them for `MeshFolders`.
        problems: the problems with mesh and texture files by link name, with the texts of RViz.
    """

    def __init__(self, index: MeshIndex) -> None:
        self.index = index
        self.problems: dict[str, list[Phrase]] = {}

    def links(self, robot: Robot, prefix: str) -> list[LinkScene]:
        """Return the links in file order, with frame names that include the display's TF Prefix."""
        parents = {joint.child: joint.name for joint in robot.joints.values()}
        return [self._make_link(link, prefix, parents.get(link.name)) for link in robot.links.values()]

    def joints(self, robot: Robot) -> list[JointScene]:
        """Return the joints in file order."""
        return [
            JointScene(
                name=joint.name,
                kind=joint.type,
                parent=joint.parent,
                child=joint.child,
                position=list(joint.origin.xyz),
                quaternion=list(pose_quaternion(joint.origin)),
                axis=list(joint.axis),
                lower=_finite_or_none(joint.limit.lower) if joint.limit else None,
                upper=_finite_or_none(joint.limit.upper) if joint.limit else None,
            )
            for joint in robot.joints.values()
        ]

    def _make_link(self, link: Link, prefix: str, parent_joint: str | None) -> LinkScene:
        first_material = link.visuals[0].material if link.visuals else None
        return LinkScene(
            name=link.name,
            frame=get_frame_name(link.name, prefix),
            parent_joint=parent_joint,
            visuals=self._make_shapes(link, link.visuals),
            collisions=self._make_shapes(link, link.collisions, first_material),
            place=find_place(link.element),
            inertia=make_link_inertia(link.inertial),
        )

    def _make_shapes(
        self, link: Link, elements: Sequence[Visual | Collision], material: Material | None = None
    ) -> list[Shape]:
        shapes = (
            self._make_shape(link, element, element.material if isinstance(element, Visual) else material)
            for element in elements
        )
        return [shape for shape in shapes if shape is not None]

    def _make_shape(self, link: Link, element: Visual | Collision, material: Material | None) -> Shape | None:
        geometry = element.geometry
        shape = Shape(
            kind="mesh",
            size=[],
            position=list(element.origin.xyz),
            quaternion=list(pose_quaternion(element.origin)),
            color=list(material.rgba) if material and material.rgba else None,
            texture=self._find_texture(link, material),
            name=element.name,
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
            return self._set_mesh(link, element, geometry, shape)
        return shape

    def _set_mesh(self, link: Link, element: Visual | Collision, mesh: Mesh, shape: Shape) -> Shape | None:
        located = self.index.locate(mesh.filename, find_folder(element.element), MESH_TYPES)
        if located.url is None:
            self._add_problem(
                link,
                phrase("Could not load mesh resource '{name}': {reason}", name=mesh.filename, reason=located.problem),
            )
            return None
        shape.size = list(mesh.scale)
        shape.url = located.url
        shape.format = mesh.filename.rpartition(".")[2].lower()
        return shape

    def _find_texture(self, link: Link, material: Material | None) -> str | None:
        if material is None or not material.texture:
            return None
        located = self.index.locate(material.texture, find_folder(material.element), IMAGE_TYPES)
        if located.url is None:
            self._add_problem(
                link, phrase("Could not load texture '{name}': {reason}", name=material.texture, reason=located.problem)
            )
        return located.url

    def _add_problem(self, link: Link, text: Phrase) -> None:
        problems = self.problems.setdefault(link.name, [])
        if text not in problems:
            problems.append(text)


def _finite_or_none(number: float) -> float | None:
    return number if math.isfinite(number) else None
