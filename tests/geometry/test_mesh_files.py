"""What is known of a mesh file before it is parsed."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.geometry.mesh_files import told_triangles

FACET = b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"


@pytest.mark.parametrize(
    ("name", "data", "count"),
    [
        ("a.stl", bytes(80) + (2).to_bytes(4, "little") + bytes(100), 2),
        ("a.STL", b"solid a\n" + 3 * FACET + b"endsolid a\n", 3),
        ("cut.stl", bytes(80) + (2).to_bytes(4, "little") + bytes(50), 0),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n", 2),
        ("a.dae", b"<COLLADA/>", None),
    ],
)
def test_triangles_are_counted_without_parsing(tmp_path: Path, name: str, data: bytes, count: int | None) -> None:
    file = tmp_path / name
    file.write_bytes(data)
    assert told_triangles(file) == count


def test_a_file_that_is_not_there_says_nothing(tmp_path: Path) -> None:
    assert told_triangles(tmp_path / "a.stl") is None
