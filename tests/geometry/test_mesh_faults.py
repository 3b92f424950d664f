"""The errors of unreadable mesh files, with the line, the element and the number."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.mesh_files import BadMeshError, create_file_resolver
from linkwright.geometry.mesh_parts import read_parts
from linkwright.geometry.meshes import read_mesh

pytestmark = pytest.mark.extra("mesh")

CORNERS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
TEXT_STL = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid a
"""
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""


def make_stl(triangles: list[list[list[float]]]) -> bytes:
    rows = np.zeros(len(triangles), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["corners"] = triangles
    return bytes(80) + struct.pack("<I", len(triangles)) + rows.tobytes()


def gltf_document() -> dict[str, Any]:
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 42}],
    }


def make_glb(
    modify: Callable[[dict[str, Any]], object] = lambda contents: None,
    corners: list[list[float]] = CORNERS,
    indices: tuple[int, int, int] = (0, 1, 2),
    text: bytes | None = None,
) -> bytes:
    contents = gltf_document()
    modify(contents)
    text = json.dumps(contents).encode() if text is None else text
    text += b" " * (-len(text) % 4)
    binary = np.array(corners, dtype="<f4").tobytes() + struct.pack("<3H", *indices) + bytes(2)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def attributes_of(value: dict[str, Any]) -> dict[str, Any]:
    attributes: dict[str, Any] = value["meshes"][0]["primitives"][0]["attributes"]
    return attributes


NAN = float("nan")
CASES = {
    "none.stl": (b"", "it is empty"),
    "pointer.stl": (b"version https://git-lfs.github.com/spec/v1\n", "it is a Git LFS pointer"),
    "page.stl": (b"<!DOCTYPE html><html>404: Not Found</html>", "it is a web page, not a mesh"),
    "tiny.stl": (b"abc", "it ends after 3 bytes, but the header of an STL has 84"),
    "cut.stl": (make_stl([CORNERS, CORNERS])[:-20], "its header declares 2 triangles, but the file has 1"),
    "nan.stl": (make_stl([[[0, 0, NAN], *CORNERS[1:]]]), "a coordinate is not a finite number"),
    "infinite.stl": (make_stl([[[0, 0, 1e999], *CORNERS[1:]]]), "a coordinate is not a finite number"),
    "word.stl": (TEXT_STL.replace("vertex 1 0 0", "vertex 1 0 O"), "line 5: 'O' is not a finite number"),
    "nan_in_text.stl": (TEXT_STL.replace("vertex 1 0 0", "vertex 1 0 nan"), "line 5: 'nan' is not a finite number"),
    "few.stl": (TEXT_STL.replace("vertex 1 0 0\n", ""), "line 6: a facet has 2 corners, not 3"),
    "word.obj": (OBJ.replace("v 1 0 0", "v 1 0 O"), "line 2: 'O' is not a finite number"),
    "nan.obj": (OBJ.replace("v 1 0 0", "v 1 0 nan"), "line 2: 'nan' is not a finite number"),
    "few.obj": (
        OBJ.replace("v 0 0 0", "v 0 0").replace("1 0 0", "1 0").replace("0 1 0", "0 1"),
        "line 1: 3 numbers are needed, but there are 2",
    ),
    "index.obj": (OBJ.replace("f 1 2 3", "f 1 2 9"), "line 4: there is no vertex 9: the mesh has 3 vertices"),
    "face.obj": (OBJ.replace("f 1 2 3", "f 1 2 c"), "line 4: 'c' is not a vertex number"),
    "unclosed.dae": (COLLADA.replace("</mesh>", ""), "line 10: '</geometry>' does not close '<mesh>'"),
    "cut.dae": (COLLADA[:500], "line 8: this tag has no closing '>'"),
    "robot.dae": ("<robot/>", "line 1: the file begins with <robot>, not with <COLLADA>"),
    "word.dae": (COLLADA.replace("0 0 0 1 0 0", "0 0 O 1 0 0"), "line 5: 'O' in <float_array> is not a finite number"),
    "infinite.dae": (COLLADA.replace("0 0 0 1 0 0", "0 0 INF 1 0 0"), "line 5: 'INF' in <float_array>"),
    "few.dae": (COLLADA.replace("1 0 0 0 1 0", "1 0 0"), "line 5: <float_array> has 6 numbers, but 9 are needed"),
    "index.dae": (COLLADA.replace("<p>0 1 2", "<p>0 1 7"), "line 9: there is no vertex 7: the mesh has 3 vertices"),
    "index_word.dae": (COLLADA.replace("<p>0 1 2", "<p>0 1 b"), "line 9: 'b' in <p> is not an index"),
    "source.dae": (
        COLLADA.replace('source="#p"', 'source="#q"'),
        "line 8: <input> refers to '#q', which is not in the file",
    ),
    "url.dae": (COLLADA.replace('url="#g"', 'url="#h"'), "line 11: <instance_geometry> refers to '#h'"),
    "scene.dae": (COLLADA.replace('url="#s"', 'url="#t"'), "line 13: <instance_visual_scene> refers to '#t'"),
    "offset.dae": (COLLADA.replace(' offset="0"', ""), "line 9: <input> has no attribute 'offset'"),
    "cut.glb": (make_glb()[:-20], "its header declares "),
    "tiny.glb": (b"glTF", "it ends after 4 bytes, but the header of a .glb has 20"),
    "letters.glb": (make_glb().replace(b"glTF", b"glTX", 1), "it does not begin with the letters glTF"),
    "old.glb": (b"glTF\x01" + make_glb()[5:], "it is glTF 1, but only glTF 2 is supported"),
    "json.glb": (make_glb(text=b'{"asset": '), "its JSON cannot be read: "),
    "list.gltf": ("[]", "its JSON is not an object"),
    "form.gltf": ('{"asset": {"version": "2.0"}, "meshes": [{}]}', "its JSON does not have the structure of glTF"),
    "nan.glb": (make_glb(corners=[[0, 0, NAN], *CORNERS[1:]]), "a coordinate is not a finite number"),
    "corner.glb": (make_glb(indices=(0, 1, 70)), "a triangle refers to vertex 70, but there are 3"),
    "accessor.glb": (
        make_glb(lambda contents: attributes_of(contents).update(POSITION=9)),
        "attributes.POSITION is 9, but the number of",
    ),
    "position.glb": (
        make_glb(lambda contents: attributes_of(contents).clear()),
        "primitives[0] has no attribute 'POSITION'",
    ),
    "type.glb": (
        make_glb(lambda contents: contents["accessors"][0].update(componentType=1)),
        "accessors[0].componentType is 1, which glTF does not define",
    ),
    "long.glb": (
        make_glb(lambda contents: contents["bufferViews"][0].update(byteLength=999)),
        "bufferViews[0] reaches beyond the 44 bytes of its buffer",
    ),
    "beside.gltf": (
        json.dumps(gltf_document() | {"buffers": [{"byteLength": 42, "uri": "none.bin"}]}),
        "it refers to the file 'none.bin', which does not exist",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_malformed_mesh_is_rejected_with_specific_error(name: str, tmp_path: Path) -> None:
    data, expected = CASES[name]
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    with pytest.raises(LinkwrightError) as raised:
        read_mesh(path)
    with pytest.raises(BadMeshError) as exported:
        read_parts(path, resolver=create_file_resolver(str(path)))
    assert expected in raised.value.diagnostics[0].message
    assert str(exported.value.reason) in raised.value.diagnostics[0].message


@pytest.mark.parametrize(
    ("name", "data"),
    [("a.stl", make_stl([CORNERS])), ("b.stl", TEXT_STL), ("a.obj", OBJ), ("a.dae", COLLADA), ("a.glb", make_glb())],
)
def test_unmodified_base_files_are_readable(name: str, data: bytes | str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    assert len(read_mesh(path).faces) == 1
    assert len(read_parts(path, resolver=create_file_resolver(str(path)))) == 1
