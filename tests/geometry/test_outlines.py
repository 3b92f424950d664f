"""Outlines of meshes without arrays, compared with those from the arrays of `read_mesh`."""

from __future__ import annotations

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.geometry.meshes import read_mesh
from linkwright.geometry.outlines import FACET_TOKENS, read_small_mesh

CUBE = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
TRIANGLES = [triangle for a, b, c, d in SQUARES for triangle in ((a, b, c), (a, c, d))]
SCALES = [(1.0, 1.0, 1.0), (0.001, 0.001, 0.001), (-1.0, 2.0, 0.5), (1.0, 1.0, 0.0)]
numbers = st.floats(-100, 100, width=32)
points = st.tuples(numbers, numbers, numbers)


def write_binary_stl(triangles):
    rows = [struct.pack("<12fH", 0, 0, 0, *(part for point in triangle for part in point), 0) for triangle in triangles]
    return bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def write_text_stl(triangles):
    lines = ["solid part"]
    for triangle in triangles:
        corners = iter([repr(part) for point in triangle for part in point])
        shown = iter(["0", "0", "1"])
        words = [word.decode() for word in FACET_TOKENS]
        lines.append(" ".join(next(shown, None) or next(corners) if word == "?" else word for word in words))
    return "\n".join([*lines, "endsolid part"]).encode()


def write_obj(points, polygons):
    lines = [f"v {' '.join(map(repr, point))}" for point in points]
    return "\n".join(lines + [f"f {' '.join(f'{place + 1}//1' for place in polygon)}" for polygon in polygons]).encode()


def assert_same_outline(data, kind, folder):
    path = folder / f"mesh.{kind}"
    path.write_bytes(data)
    outline, mesh = read_small_mesh(data, kind), read_mesh(path)
    assert outline is not None
    for scale in SCALES:
        actual, expected = outline.scaled(scale), mesh.scaled(scale)
        assert actual.count == expected.count
        assert actual.bounds == expected.bounds
        assert actual.is_watertight == expected.is_watertight


@given(st.lists(st.tuples(points, points, points), min_size=1, max_size=6))
def test_outlines_of_random_stl_match_read_mesh(tmp_path_factory, triangles):
    assert_same_outline(write_binary_stl(triangles), "stl", tmp_path_factory.getbasetemp())
    assert_same_outline(write_text_stl(triangles), "stl", tmp_path_factory.getbasetemp())


@given(st.lists(st.sampled_from(TRIANGLES), min_size=1), st.lists(st.sampled_from(SQUARES)))
def test_outlines_of_partial_cube_match_read_mesh(tmp_path_factory, triangles, squares):
    assert_same_outline(write_obj(CUBE, [*triangles, *squares]), "obj", tmp_path_factory.getbasetemp())
    flat = [tuple(CUBE[place] for place in triangle) for triangle in triangles]
    assert_same_outline(write_binary_stl(flat), "stl", tmp_path_factory.getbasetemp())


def test_cube_is_watertight_only_with_all_faces(tmp_path):
    assert read_small_mesh(write_obj(CUBE, SQUARES), "obj").is_watertight
    assert not read_small_mesh(write_obj(CUBE, SQUARES[1:]), "obj").is_watertight
    assert_same_outline(write_obj([*CUBE, (9.0, 9.0, 9.0)], SQUARES), "obj", tmp_path)


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        (b"", "stl"),
        (write_binary_stl([CUBE[:3]])[:-1], "stl"),
        (write_binary_stl([[(float("nan"), 0, 0), *CUBE[:2]]]), "stl"),
        (write_binary_stl([[(1e30, 0, 0), *CUBE[:2]]]), "stl"),
        (write_text_stl([CUBE[:3]]).replace(b"1.0", b"one"), "stl"),
        (write_text_stl([CUBE[:3]]).replace(b"1.0", b"1_0"), "stl"),
        (write_text_stl([CUBE[:3]]).replace(b"vertex", b"vortex"), "stl"),
        (write_text_stl([CUBE[:3]]) + b"\n" + write_text_stl([CUBE[:3]]), "stl"),
        (write_text_stl([CUBE[:3]]).replace(b"solid part", b"solid \xff", 1), "stl"),
        (write_obj(CUBE, SQUARES) + b"\nf 1 2 99", "obj"),
        (write_obj(CUBE, SQUARES) + b"\nf -1 -2 -3", "obj"),
        (write_obj(CUBE, SQUARES) + b"\nf 1 2", "obj"),
        (write_obj(CUBE, SQUARES) + b"\nf 1 2 x", "obj"),
        (write_obj(CUBE, SQUARES) + b"\nv 1 2", "obj"),
        (write_obj(CUBE, SQUARES) + b"\nv 1 2 \\\n3", "obj"),
        (write_obj(CUBE, []), "obj"),
        (b"<COLLADA/>", "dae"),
    ],
)
def test_unusual_files_are_not_read_as_small_mesh(data, kind):
    assert read_small_mesh(data, kind) is None
