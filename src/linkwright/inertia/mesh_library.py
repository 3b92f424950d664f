"""The mesh files of a description, each found and read once."""

from __future__ import annotations

import os.path
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.bounds import FARTHEST
from linkwright.geometry.meshes import TriangleMesh, read_mesh, unreadable
from linkwright.packages import PackageFinder
from linkwright.urdf import Mesh
from linkwright.xmltree import Element


class MeshLibrary:
    """Finds and reads the meshes that a description names.

    Args:
        finder: where packages are.
        folder: where relative paths start when it is not known in which file they are written.
    """

    def __init__(self, finder: PackageFinder, folder: Path) -> None:
        self._finder = finder
        self._folder = folder
        self._paths: dict[tuple[str, Path], Path | LinkwrightError] = {}
        self._meshes: dict[str, TriangleMesh | LinkwrightError] = {}

    def locate(self, uri: str, element: Element | None = None) -> Path:
        """The file that a URI means; whether it exists is not asked.

        Args:
            uri: ``package://``, ``file://`` or a path; a relative one starts at the folder of the file it stands in.
            element: the element that it is written in.

        Raises:
            LinkwrightError: PKG101 for an unknown package, PKG102 for a URI that is none.
        """
        key = uri, self._base(element)
        found = self._paths.get(key)
        if found is None:
            try:
                found = self._finder.resolve(*key)
            except LinkwrightError as error:
                found = error
            self._paths[key] = found
        if isinstance(found, LinkwrightError):
            raise found
        return found

    def read(self, path: Path) -> TriangleMesh:
        """The triangles of a file.

        Raises:
            LinkwrightError: as `read_mesh` does.
        """
        key = os.path.realpath(path)
        found = self._meshes.get(key)
        if found is None:
            try:
                found = read_mesh(path)
            except LinkwrightError as error:
                found = error
            self._meshes[key] = found
        if isinstance(found, LinkwrightError):
            raise found
        return found

    def load(self, mesh: Mesh, element: Element | None = None) -> TriangleMesh:
        """The triangles of a URDF mesh, scaled, in the frame of its visual or collision.

        Raises:
            LinkwrightError: as `locate` and `read` do.
        """
        path = self.locate(mesh.filename, element)
        if max(map(abs, mesh.scale)) > FARTHEST:
            raise unreadable(path, phrase("its scale is beyond all bounds"))
        return self.read(path).scaled(mesh.scale)

    def _base(self, element: Element | None) -> Path:
        if element is None or element.source is None or element.source.name.startswith("<"):
            return self._folder
        return Path(element.source.name).parent
