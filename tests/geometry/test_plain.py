"""COLLADA and OBJ without trimesh: the same triangles as with trimesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.geometry.collada import read_collada
from linkwright.geometry.mesh_files import read_placed_meshes
from linkwright.geometry.meshes import read_mesh
from linkwright.geometry.outlines import read_small_mesh
from linkwright.geometry.plain import PlainMesh
from linkwright.geometry.wavefront import read_obj
from tests.geometry.test_mesh_faults import COLLADA

TRIANGLES = '<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>'
LINE = TRIANGLES.replace("triangles", "lines").replace("0 1 2", "0 1")
NODE = '<node id="n"><instance_geometry url="#g"/></node>'
SQUARE = COLLADA.replace('count="9"', 'count="15"').replace("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 1.5 1 0 1 2 0.1 0 1 0")
SQUARE = SQUARE.replace('count="3" stride', 'count="5" stride')
NORMALS = SQUARE.replace(
    "<vertices",
    '<source id="n"><float_array id="na" count="6">0 0 1 0 1 0</float_array><technique_common><accessor source="#na"'
    ' count="2" stride="3"><param name="X"/><param name="Y"/><param name="Z"/></accessor></technique_common></source>'
    "<vertices",
)
PAIRS = '<input semantic="NORMAL" source="#n" offset="1"/><input semantic="VERTEX" source="#v" offset="0"/>'


NODE_INSTANCE = '<instance_node url="#kept"/>'


def collada_with_library(parts: str) -> str:
    """Return a file that uses a node of its library twice."""
    library = f'<library_nodes><node id="kept">{parts}</node></library_nodes><library_visual_scenes>'
    return COLLADA.replace(NODE, f"<node>{NODE_INSTANCE}{NODE_INSTANCE}</node>").replace(
        "<library_visual_scenes>", library
    )


def triangle_corners(data: bytes, kind: str, *, is_plain: bool) -> np.ndarray:
    """Return the sorted corners of all triangles in meters; shape (n, 9).

    Each triangle begins with its lowest corner.
    """
    vertices_by_mesh = []
    for mesh, matrix, unit, _ in (placed := read_placed_meshes(data, kind, is_plain=is_plain)):
        assert isinstance(mesh, PlainMesh) is is_plain
        vertices = (np.asarray(mesh.vertices) @ matrix[:3, :3].T + matrix[:3, 3]) * unit
        vertices_by_mesh.append(vertices.round(5))
    rows = [
        list(map(tuple, vertices[face]))
        for vertices, mesh in zip(vertices_by_mesh, placed, strict=True)
        for face in mesh.faces
    ]
    turned = [face[first:] + face[:first] for face in rows for first in [face.index(min(face))]]
    return np.array(sorted(turned)).reshape(-1, 9)


@pytest.mark.extra("mesh")
@pytest.mark.parametrize(
    "text",
    [
        COLLADA,
        COLLADA.replace('meter="1"', 'meter="0.0254"'),
        COLLADA.replace('<unit meter="1" name="meter"/>', ""),
        COLLADA.replace(
            NODE,
            "<node><translate>1 2 3</translate><rotate>0 0 1 30</rotate><scale>2 3 -4</scale><node>"
            "<matrix>0 1 0 .5 -1 0 0 .25 0 0 1 0 0 0 0 1</matrix>" + NODE + "<extra/></node></node>" + NODE,
        ),
        collada_with_library("<rotate>0.6 0.8 0 90</rotate>" + NODE),
        COLLADA.replace(TRIANGLES, LINE + TRIANGLES + TRIANGLES.replace("0 1 2", "2 1 0")),
        SQUARE.replace("triangles", "polylist").replace("<p>0 1 2", "<vcount>5 3 4</vcount><p>0 1 2 3 4 0 2 4 4 3 2 0"),
        SQUARE.replace("triangles", "polygons").replace("0 1 2</p>", "0 1 2 4</p><p>0 3 4</p>"),
        NORMALS.replace(TRIANGLES, f"<triangles>{PAIRS}<p>0 0 1 1 2 0 2 1 3 1 4 1</p></triangles>"),
        COLLADA.replace("0 0 0 1", "0.1 0.2 0.3 1"),
    ],
    ids=[
        "one triangle",
        "inches",
        "without a unit",
        "transforms, one that mirrors",
        "a node at two places",
        "two sets of triangles, and lines",
        "a polylist",
        "polygons",
        "normals with numbers of their own",
        "numbers that 32 bits round",
    ],
)
def test_collada_triangles_match_trimesh(text: str, tmp_path: Path) -> None:
    data = text.encode()
    assert np.allclose(
        triangle_corners(data, "dae", is_plain=True), triangle_corners(data, "dae", is_plain=False), atol=2e-5
    )
    (tmp_path / "mesh.dae").write_bytes(data)
    plain_mesh, mesh = read_small_mesh(data, "dae"), read_mesh(tmp_path / "mesh.dae")
    assert plain_mesh is not None
    assert plain_mesh.count == mesh.count
    assert plain_mesh.is_watertight == mesh.is_watertight
    assert np.allclose(plain_mesh.bounds, mesh.bounds, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        COLLADA.replace("<COLLADA", "<!DOCTYPE COLLADA><COLLADA"),
        COLLADA.replace("<p>0 1 2</p>", "<p>0 1 3</p>"),
        COLLADA.replace("<p>0 1 2</p>", "<p>0 1 two</p>"),
        COLLADA.replace("<p>0 1 2</p>", "<p>0 1</p>"),
        COLLADA.replace("<p>0 1 2</p>", "<p>0 1 2</p><p>2 1 0</p>"),
        COLLADA.replace("<p>0 1 2</p>", ""),
        COLLADA.replace("0 0 0 1 0 0", "0 0 nan 1 0 0"),
        COLLADA.replace("0 0 0 1 0 0", "0 0 1 0 0"),
        COLLADA.replace('stride="3"', 'stride="4"'),
        COLLADA.replace("triangles", "tristrips"),
        COLLADA.replace('url="#g"', 'url="#none"'),
        COLLADA.replace('url="#g"', 'url="other.dae#g"'),
        COLLADA.replace(NODE, NODE.replace('"n">', '"n"><lookat>0 0 1 0 0 0 0 1 0</lookat>')),
        COLLADA.replace(NODE, ""),
        COLLADA.replace(' xmlns="http://www.collada.org/2005/11/COLLADASchema"', ""),
        COLLADA.replace("</COLLADA>", ""),
        collada_with_library(NODE_INSTANCE),
        "",
    ],
    ids=[
        "a document type",
        "a corner that is not there",
        "a word for a number",
        "a triangle of two corners",
        "two lists of corners",
        "no list of corners",
        "no finite number",
        "fewer numbers than it says",
        "rows with a gap",
        "strips",
        "a mesh that is not there",
        "a mesh of another file",
        "a transform of another kind",
        "nothing placed",
        "without a namespace",
        "cut off",
        "a node in itself",
        "nothing",
    ],
)
def test_unusual_collada_is_left_to_trimesh(text: str) -> None:
    assert read_collada(text.encode()) is None
    assert read_small_mesh(text.encode(), "dae") is None


def test_mirrored_solid_is_watertight_without_arrays() -> None:
    solid = COLLADA.replace('count="9"', 'count="12"').replace("0 0 0 1 0 0 0 1 0", "0 0 0 1 0 0 0 1 0 0 0 1")
    solid = solid.replace('count="3" stride', 'count="4" stride').replace("<p>0 1 2", "<p>0 2 1 0 1 3 0 3 2 1 2 3")
    for text in (solid, solid.replace(NODE, f"<node><scale>1 -1 1</scale>{NODE}</node>")):
        plain_mesh = read_small_mesh(text.encode(), "dae")
        assert plain_mesh is not None
        assert plain_mesh.is_watertight
    cut = read_small_mesh(solid.replace("0 2 1 0 1 3", "0 1 3").encode(), "dae")
    assert cut is not None
    assert not cut.is_watertight


def test_collada_with_many_instances_is_not_read_as_small_mesh() -> None:
    assert read_small_mesh(COLLADA.replace(NODE, NODE * 19_000).encode(), "dae") is not None
    often = collada_with_library(NODE * 200).replace(NODE_INSTANCE, NODE_INSTANCE * 70)
    assert read_small_mesh(often.encode(), "dae") is None


OBJ = "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nvn 0 0 1\nvt 0 0\n"


@pytest.mark.extra("mesh")
@pytest.mark.parametrize(
    "text",
    [
        OBJ + "f 1 2 3\nf 1 3 4\n",
        OBJ + "usemtl b\ns off\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng c\nf 1//1 2//1 4//1\n",
        (OBJ + "f 1/1 2/1 3/1 \nf  1/1  3/1 4/1\n").replace("\n", "\r\n"),
        OBJ.replace(" 0\nv ", " 0 0.5 0.5 0.5\nv ").replace("0.1\n", "0.1 1 1 1\n").replace("1 0\nvn", "1 0 1 1 1\nvn")
        + "l 1 2\nf 1 2 4\n",
    ],
    ids=["triangles", "polygons in groups", "lines as Windows ends them", "corners with colors"],
)
def test_obj_triangles_match_trimesh(text: str) -> None:
    data = text.encode()
    assert np.allclose(triangle_corners(data, "obj", is_plain=True), triangle_corners(data, "obj", is_plain=False))


@pytest.mark.parametrize(
    "text",
    [
        OBJ + "f -4 -3 -2\n",
        OBJ + "f 1 2 5\n",
        OBJ + "f 1 2\n",
        OBJ + "f 1 2 three\n",
        OBJ + "f 1 2 \\\n3\n",
        OBJ.replace("v 1 0 0\n", "v 1 0\n") + "f 1 2 3\n",
        OBJ.replace("v 1 0 0\n", "v 1 0 zero\n") + "f 1 2 3\n",
        OBJ,
        "f 1 2 3\n",
    ],
    ids=[
        "counted from the last vertex",
        "a corner that is not there",
        "a polygon of two corners",
        "a word for a corner",
        "a line that goes on",
        "two coordinates",
        "a word for a coordinate",
        "no triangles",
        "no vertices",
    ],
)
def test_unusual_obj_is_left_to_trimesh(text: str) -> None:
    assert read_obj(text.encode()) is None


@pytest.mark.extra("mesh")
@pytest.mark.parametrize("header", [b"", b"COLOR=\x7f\x7f\x7f\xff"])
def test_stl_colors_do_not_change_triangles(header: bytes) -> None:
    facet = np.array([0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0], dtype="<f4").tobytes() + b"\xff\x83"
    data = header.ljust(80) + (1).to_bytes(4, "little") + facet
    assert np.array_equal(triangle_corners(data, "stl", is_plain=True), triangle_corners(data, "stl", is_plain=False))
