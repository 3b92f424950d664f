"""The mesh files of a description, each of which is located and read once."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.outlines import Outline, SmallMesh, read_small
from linkwright.geometry.shapes import FARTHEST
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.urdf import Mesh
from linkwright.xacro.cache import BoundedCache
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.geometry.meshes import TriangleMesh

_CACHE_SIZE = 256 << 20
"""Bytes of meshes that are kept from one description to the next."""
_SMALL, _MOST_SMALL = 100_000, 500_000
"""Bytes of a file, and of all files of a process, that are read for outlines without arrays. To read more, numpy is
quicker, together with its import."""


class MeshLibrary:
    """A reader of the meshes of a description.

    Meshes are cached across descriptions, and read again only if their file has changed.

    Args:
        finder: finds packages.
        folder: the folder for relative paths if the file that contains them is unknown.
    """

    def __init__(self, finder: PackageFinder, folder: Path) -> None:
        self._finder = finder
        self._folder = folder
        self._paths: dict[tuple[str, Path], Path | LinkwrightError] = {}
        self._meshes: dict[str, TriangleMesh | LinkwrightError] = {}
        self._outlines: dict[str, SmallMesh | None] = {}

    def locate(self, uri: str, element: Element | None = None) -> Path:
        """Return the path of the file that a URI refers to, whether or not it exists.

        Args:
            uri: ``package://``, ``file://`` or a path; a relative path starts at the folder of the file that contains
                the URI.
            element: the element in which the URI is written.

        Raises:
            LinkwrightError: PKG101, the package is unknown; PKG102, the URI is invalid.
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
        """Return the triangles of a mesh file, which is read at most once.

        Raises:
            LinkwrightError: the same errors as `read_mesh`.
        """
        key = os.path.realpath(path)
        found = self._meshes.get(key)
        if found is None:
            try:
                found = _read_cached(path, key)
            except LinkwrightError as error:
                found = error
            self._meshes[key] = found
        if isinstance(found, LinkwrightError):
            raise found
        return found

    def load(self, mesh: Mesh, element: Element | None = None) -> TriangleMesh:
        """Return the triangles of a URDF mesh, scaled, in the frame of its visual or collision.

        Raises:
            LinkwrightError: the same errors as `locate` and `read`.
        """
        return self.read(self._checked(mesh, element)).scaled(mesh.scale)

    def outline(self, mesh: Mesh, element: Element | None = None) -> Outline:
        """Return the scaled properties of a URDF mesh that checks use.

        The result is in the frame of the visual or collision.

        Raises:
            LinkwrightError: the same errors as `locate` and `read`.
        """
        path = self._checked(mesh, element)
        key = os.path.realpath(path)
        if key not in self._outlines:
            self._outlines[key] = None if key in self._meshes else _small(key, path.suffix.lower())
        return (self._outlines[key] or self.read(path)).scaled(mesh.scale)

    def _checked(self, mesh: Mesh, element: Element | None) -> Path:
        """Return the path of a mesh's file.

        Raises:
            LinkwrightError: the same errors as `locate`; INR103, the scale is out of range.
        """
        path = self.locate(mesh.filename, element)
        if max(map(abs, mesh.scale)) > FARTHEST:
            from linkwright.geometry.meshes import unreadable

            raise unreadable(path, phrase("its scale is out of range"))
        return path

    def _base(self, element: Element | None) -> Path:
        if element is None or element.source is None or element.source.name.startswith("<"):
            return self._folder
        return Path(element.source.name).parent


def _size_of(_: object, mesh: TriangleMesh) -> int:
    """Return the size of a mesh in bytes, doubled to account for data computed from the mesh."""
    return 2 * (mesh.vertices.nbytes + mesh.faces.nbytes)


_CACHE: BoundedCache[tuple[str, int, int], TriangleMesh] = BoundedCache(_CACHE_SIZE, _size_of)
"""The meshes of files, by the path, the time of the last change in ns, and the size in bytes."""


def _read_cached(path: Path, real: str) -> TriangleMesh:
    """Return the triangles of a file from the cache, or read the file if it has changed.

    A glTF file is read each time, because it may refer to other files.
    """
    from linkwright.geometry.meshes import read_mesh  # Checks of small meshes need no numpy.

    if path.suffix.lower() in (".glb", ".gltf"):
        return read_mesh(path)
    try:
        facts = os.stat(real)  # noqa: PTH116 - a path that is already text
    except OSError:
        return read_mesh(path)  # This raises an error with the reason.
    key = real, facts.st_mtime_ns, facts.st_size
    found = _CACHE.values.get(key)
    if found is None:
        found = read_mesh(path)
        _CACHE.store(key, found)
    return found


_SMALL_MESHES: dict[tuple[str, int, int], SmallMesh] = {}
"""The meshes of files that were read without arrays, with the keys of `_CACHE`."""


def _small(real: str, kind: str) -> SmallMesh | None:
    """Return the triangles of a small file without unusual content, read without arrays.

    Returns None for other files, which must be read with arrays; that also reports what is wrong with them.
    """
    try:
        facts = os.stat(real)  # noqa: PTH116 - as above
        key = real, facts.st_mtime_ns, facts.st_size
        found = _SMALL_MESHES.get(key)
        if found is not None or "numpy" in sys.modules or not stat.S_ISREG(facts.st_mode):
            return found
        if facts.st_size > _SMALL or facts.st_size + sum(size for _, _, size in _SMALL_MESHES) > _MOST_SMALL:
            return None
        found = read_small(Path(real).read_bytes(), kind[1:])
    except OSError:
        return None
    if found is not None:
        _SMALL_MESHES[key] = found
    return found
