"""Compare mesh files: bytes, triangles and size."""

from __future__ import annotations

from pathlib import Path

from linkwright.descriptions.comparison import has_same_contents
from linkwright.diagnostics import Phrase, counted, phrase
from linkwright.files.git_repository import read_lfs_pointer
from linkwright.geometry.meshes import TriangleMesh, read_mesh
from linkwright.review.changes import Figure
from linkwright.review.drawings.scene_images import render_meshes
from linkwright.review.file_pair import FilePair, LimitError
from linkwright.review.versions import Version

_MAX_BYTES = 100 << 20
"""The maximum size in bytes of compared meshes. For larger meshes, only the file sizes are compared."""
_MAX_CONTENT_BYTES = 10 << 20
"""The maximum size in bytes of added meshes whose contents are shown. A commit can add hundreds of meshes."""
_METRIC_SUFFIXES = frozenset({".dae", ".glb", ".gltf"})
"""The endings of formats that state their unit, so that the sizes are in meters."""
_TOLERANCE = 1e-6


def compare_meshes(pair: FilePair) -> None:
    """Compare two versions of a mesh file."""
    files = pair.old_file, pair.new_file
    if has_same_contents(*files):
        return
    sizes = [None if read_lfs_pointer(file) else file.stat().st_size for file in files]
    if None not in sizes and sizes[0] != sizes[1]:
        pair.figures.append(Figure(phrase("size of the file"), str(sizes[0]), str(sizes[1]), "bytes"))
    meshes = pair.read(_read)
    if meshes is None:
        return
    old, new = meshes
    if pair.drawings.images and pair.old_file.read_bytes() != pair.new_file.read_bytes():
        pair.images += render_meshes(pair)
    if old.count != new.count:
        pair.figures.append(Figure(phrase("triangles"), str(old.count), str(new.count)))
    names = phrase("lowest corner, in the units of the file"), phrase("highest corner, in the units of the file")
    unit = ""
    if pair.new_file.suffix.lower() in _METRIC_SUFFIXES:
        names, unit = (phrase("lowest corner"), phrase("highest corner")), "m"
    for name, before, after in zip(names, old.bounds, new.bounds, strict=True):
        if any(abs(a - b) > _TOLERANCE * max(1.0, abs(a)) for a, b in zip(before, after, strict=True)):
            old_text, new_text = (" ".join(f"{number:.6g}" for number in corner) for corner in (before, after))
            pair.figures.append(Figure(name, old_text, new_text, unit))
    if not pair.figures:
        pair.add(phrase("contents changed, with the same triangles and size"), None)


def mesh_contents(version: Version, path: str) -> Phrase | None:
    """Return the number of triangles and the size of a mesh; None for a large file.

    The size is in meters if the format states its unit, and else in the units of the file.
    """
    file = version.file(path)
    if file.stat().st_size > _MAX_CONTENT_BYTES:
        return None
    mesh = _read(file)
    low, high = mesh.bounds
    size = " x ".join(f"{b - a:.3g}" for a, b in zip(low, high, strict=True))
    if file.suffix.lower() in _METRIC_SUFFIXES:
        return counted("{count} triangle, {size} m", "{count} triangles, {size} m", mesh.count, size=size)
    return counted(
        "{count} triangle, {size} in the units of the file",
        "{count} triangles, {size} in the units of the file",
        mesh.count,
        size=size,
    )


def _read(file: Path) -> TriangleMesh:
    if read_lfs_pointer(file):
        raise LimitError(phrase("the file is in Git LFS and is not downloaded"))
    if file.stat().st_size > _MAX_BYTES:
        raise LimitError(phrase("it is larger than {megabytes} MB", megabytes=_MAX_BYTES >> 20))
    return read_mesh(file)
