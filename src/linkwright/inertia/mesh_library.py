"""The mesh files of a description; each is located and read once."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.mesh_content import ContentKey, shape_key
from linkwright.geometry.outlines import Outline, SmallMesh, read_small_mesh
from linkwright.geometry.shapes import MAX_COORDINATE
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder
from linkwright.urdf import Mesh
from linkwright.xacro.cache import BoundedCache
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.geometry.meshes import TriangleMesh

_FileKey = tuple[str, int, int]
_CACHE_BYTES = 256 << 20
"""The maximum size in bytes of the meshes that are cached across descriptions."""
_MAX_SMALL_FILE, _MAX_SMALL_FILES = 100_000, 500_000
"""The maximum bytes of a file, and of all files in a process, to read without numpy. Beyond, numpy is faster."""


class MeshLibrary:
    """A reader of the meshes of a description.

    Meshes are cached across descriptions, and read again only if their file has changed.

    Args:
        finder: the finder of packages.
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
            LinkwrightError: PKG101 if the package is not found, or PKG102 if the URI is invalid.
        """
        key = uri, self._get_base_folder(element)
        path_or_error = self._paths.get(key)
        if path_or_error is None:
            try:
                path_or_error = self._finder.resolve(*key)
            except LinkwrightError as error:
                path_or_error = error
            self._paths[key] = path_or_error
        if isinstance(path_or_error, LinkwrightError):
            raise path_or_error
        return path_or_error

    def read(self, path: Path) -> TriangleMesh:
        """Return the triangles of a mesh file, reading the file at most once.

        Raises:
            LinkwrightError: the same errors as `read_mesh`.
        """
        key = os.path.realpath(path)
        mesh_or_error = self._meshes.get(key)
        if mesh_or_error is None:
            try:
                mesh_or_error = _read_cached(path, key)
            except LinkwrightError as error:
                mesh_or_error = error
            self._meshes[key] = mesh_or_error
        if isinstance(mesh_or_error, LinkwrightError):
            raise mesh_or_error
        return mesh_or_error

    def find_content_key(self, uri: str, element: Element | None = None) -> ContentKey | None:
        """Return a key that is equal for files with the same triangles, without reading the triangles.

        The result is None if the file is not found, or if its triangles may be in other files.
        """
        try:
            path = self.locate(uri, element)
            key = _find_key(path, os.path.realpath(path))
        except (LinkwrightError, OSError):
            return None
        return key if len(key) == 2 else None

    def load(self, mesh: Mesh, element: Element | None = None) -> TriangleMesh:
        """Return the triangles of a URDF mesh, scaled, in the frame of its visual or collision.

        Raises:
            LinkwrightError: the same errors as `locate` and `read`.
        """
        return self.read(self._find_file(mesh, element)).scaled(mesh.scale)

    def load_outline(self, mesh: Mesh, element: Element | None = None) -> Outline:
        """Return the properties of a scaled URDF mesh that checks use.

        The result is in the frame of the visual or collision.

        Raises:
            LinkwrightError: the same errors as `locate` and `read`.
        """
        path = self._find_file(mesh, element)
        key = os.path.realpath(path)
        if key not in self._outlines:
            self._outlines[key] = None if key in self._meshes else _read_small_cached(key, path.suffix.lower())
        return (self._outlines[key] or self.read(path)).scaled(mesh.scale)

    def _find_file(self, mesh: Mesh, element: Element | None) -> Path:
        """Return the path of a mesh's file.

        Raises:
            LinkwrightError: the same errors as `locate`, or INR103 if the scale is out of range.
        """
        path = self.locate(mesh.filename, element)
        if max(map(abs, mesh.scale)) > MAX_COORDINATE:
            from linkwright.geometry.meshes import unreadable_mesh_error

            raise unreadable_mesh_error(path, phrase("its scale is out of range"))
        return path

    def _get_base_folder(self, element: Element | None) -> Path:
        if element is None or element.source is None or element.source.name.startswith("<"):
            return self._folder
        return Path(element.source.name).parent


def _count_mesh_bytes(_: object, mesh: TriangleMesh) -> int:
    """Return the size of a mesh in bytes, doubled to account for data computed from the mesh."""
    return 2 * (mesh.vertices.nbytes + mesh.faces.nbytes)


_MESH_CACHE: BoundedCache[_FileKey | ContentKey, TriangleMesh] = BoundedCache(_CACHE_BYTES, _count_mesh_bytes)
"""The meshes of files by their content, which both versions of a repository have under other paths.

Files without a key of their content, such as very large ones, have the key of the file.
"""
_CONTENT_KEYS: dict[_FileKey, _FileKey | ContentKey] = {}
"""The keys in `_MESH_CACHE` of files, by the path, the time of the last change in ns, and the size in bytes."""


def _read_cached(path: Path, real_path: str) -> TriangleMesh:
    """Return the triangles of a file from the cache, or read the file if it has changed.

    A glTF file is read each time, because it may refer to other files.
    """
    from linkwright.geometry.meshes import read_mesh  # Checks of small meshes need no numpy.

    if path.suffix.lower() in (".glb", ".gltf"):
        return read_mesh(path)
    try:
        key = _find_key(path, real_path)
    except OSError:
        return read_mesh(path)  # This raises an error with the reason.
    mesh = _MESH_CACHE.values.get(key)
    if mesh is None:
        mesh = read_mesh(path)
        _MESH_CACHE.store(key, mesh)
    return mesh


def _find_key(path: Path, real_path: str) -> _FileKey | ContentKey:
    """Return the key of a file in `_MESH_CACHE`.

    Raises:
        OSError: the status of the file cannot be read.
    """
    file_status = os.stat(real_path)  # noqa: PTH116 - a path that is already text
    file_key = real_path, file_status.st_mtime_ns, file_status.st_size
    key = _CONTENT_KEYS.get(file_key)
    if key is None:
        key = _CONTENT_KEYS[file_key] = shape_key(path) or file_key
    return key


_SMALL_MESHES: dict[tuple[str, int, int], SmallMesh] = {}
"""The meshes of files that were read without arrays, with the keys of `_MESH_CACHE`."""


def _read_small_cached(real_path: str, kind: str) -> SmallMesh | None:
    """Return the triangles of a small file without unusual content, read without arrays.

    The result is None for other files. They must be read with arrays, which also reports their errors.
    """
    try:
        file_status = os.stat(real_path)  # noqa: PTH116 - as above
        key = real_path, file_status.st_mtime_ns, file_status.st_size
        mesh = _SMALL_MESHES.get(key)
        if mesh is not None or "numpy" in sys.modules or not stat.S_ISREG(file_status.st_mode):
            return mesh
        if (
            file_status.st_size > _MAX_SMALL_FILE
            or file_status.st_size + sum(size for _, _, size in _SMALL_MESHES) > _MAX_SMALL_FILES
        ):
            return None
        mesh = read_small_mesh(Path(real_path).read_bytes(), kind[1:])
    except OSError:
        return None
    if mesh is not None:
        _SMALL_MESHES[key] = mesh
    return mesh
