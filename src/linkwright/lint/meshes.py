"""The mesh files that a description references, located and read once for all rules."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property
from pathlib import Path

from linkwright.diagnostics import LinkwrightError
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import Collision, Link, Mesh, Visual
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.geometry.outlines import Outline
    from linkwright.inertia import MeshLibrary
    from linkwright.packages import PackageFinder


@dataclass(frozen=True, slots=True)
class MeshUse:
    """The use of a mesh by a link.

    Attributes:
        link: the link that has the shape.
        shape: the visual or collision with the mesh.
        mesh: the URI and scale.
        element: the ``<mesh>`` element.
    """

    link: Link
    shape: Visual | Collision
    mesh: Mesh
    element: Element

    @property
    def kind(self) -> str:
        """The kind of the shape, ``visual`` or ``collision``."""
        return "visual" if isinstance(self.shape, Visual) else "collision"


class MeshFacts:
    """The facts about the meshes of one description.

    Files are read only when a rule needs them. A URI without a file has no path, and an unreadable file has no
    triangles. The rules about files report such meshes, and all other rules skip them.

    Args:
        links: the links whose visuals and collisions are checked.
        finder: the finder of the packages in ``package://`` URIs.
        folder: the base of relative paths.
    """

    def __init__(self, links: Iterable[Link], finder: PackageFinder, folder: Path) -> None:
        self._links = tuple(links)
        self._finder = finder
        self._folder = folder
        self.unread: LinkwrightError | None = None
        """The error about the missing mesh library if a rule needed a mesh, or None."""

    @cached_property
    def uses(self) -> tuple[MeshUse, ...]:
        """Every use of a mesh, in the order of the links, visuals before collisions."""
        return tuple(self._all_uses())

    @cached_property
    def files(self) -> tuple[tuple[MeshUse, Path], ...]:
        """The uses with a valid URI, each with the path of the mesh file, which need not exist."""
        paths = ((use, self.path(use)) for use in self.uses)
        return tuple((use, path) for use, path in paths if path is not None)

    def path(self, use: MeshUse) -> Path | None:
        """Return the path of the file that a mesh's URI names, or None if the URI is not valid."""
        try:
            return self._mesh_library.locate(use.mesh.filename, use.element).absolute()
        except LinkwrightError:
            return None

    def problem(self, use: MeshUse) -> LinkwrightError | None:
        """Return the error of a mesh file that exists but cannot be read, or None."""
        try:
            self._load(use.mesh, use.element)
        except LinkwrightError as error:
            return error
        return None

    def load_outline(self, shape: Visual | Collision) -> Outline | None:
        """Return the scaled outline of a shape's mesh in the shape frame, or None if unreadable."""
        if not isinstance(shape.geometry, Mesh):
            return None
        try:
            return self._load(shape.geometry, shape.element)
        except LinkwrightError:
            return None

    def _load(self, mesh: Mesh, element: Element | None) -> Outline:
        try:
            return self._mesh_library.load_outline(mesh, element)
        except LinkwrightError as error:
            if error.diagnostics[0].code == "INR104":
                self.unread = error
            raise

    @cached_property
    def _mesh_library(self) -> MeshLibrary:
        from linkwright.inertia import MeshLibrary  # Imported here because a robot without meshes does not need it.

        return MeshLibrary(self._finder, self._folder)

    def _all_uses(self) -> Iterator[MeshUse]:
        for link in self._links:
            shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
            for shape in shapes:
                element = shape_element(shape)
                if isinstance(shape.geometry, Mesh) and element is not None:
                    yield MeshUse(link, shape, shape.geometry, element)


def shape_element(shape: Visual | Collision) -> Element | None:
    """Return the shape element of a visual or collision, such as ``<box>``, or None."""
    geometry = shape.element.first("geometry") if shape.element is not None else None
    return next(geometry.elements(), None) if geometry is not None else None


def material_element(shape: Visual) -> Element | None:
    """Return the ``<material>`` element of a visual, or None."""
    return shape.element.first("material") if shape.element is not None else None
