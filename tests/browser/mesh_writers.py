"""Mesh files of all formats, written by hand.

Each contains a box of 0.1 x 0.2 x 0.3 m with a corner at the origin.
"""

from __future__ import annotations

import json
import struct
import zlib

BOX_SIZE_M = (0.1, 0.2, 0.3)
TRIANGLES = (
    (0, 2, 1),
    (1, 2, 3),
    (4, 5, 6),
    (5, 7, 6),
    (0, 1, 4),
    (1, 5, 4),
    (2, 6, 3),
    (3, 6, 7),
    (0, 4, 2),
    (2, 4, 6),
    (1, 3, 5),
    (3, 7, 5),
)


def box_corners(scale: float = 1.0) -> list[tuple[float, float, float]]:
    """Return the corners; x changes fastest."""
    return [
        (BOX_SIZE_M[0] * scale * (i & 1), BOX_SIZE_M[1] * scale * (i >> 1 & 1), BOX_SIZE_M[2] * scale * (i >> 2 & 1))
        for i in range(8)
    ]


def write_stl_text() -> bytes:
    points = box_corners()
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {} {} {}\n".format(*points[corner]) for corner in triangle)
        + "endloop\nendfacet\n"
        for triangle in TRIANGLES
    )
    return f"solid box\n{facets}endsolid box\n".encode()


def write_stl_binary(*, color: bool = False) -> bytes:
    """Return a binary STL; `color` adds the colors of Materialise Magics, which RViz ignores."""
    header = b"COLOR=" + bytes((0, 255, 0, 255)) if color else b""
    points = box_corners()
    facets = b"".join(
        struct.pack(
            "<12fH", 0, 0, 0, *(value for corner in triangle for value in points[corner]), 0x801F if color else 0
        )
        for triangle in TRIANGLES
    )
    return header.ljust(80, b"\0") + struct.pack("<I", len(TRIANGLES)) + facets


def write_obj(materials: str = "", use: str = "") -> bytes:
    points = "".join("v {} {} {}\n".format(*point) for point in box_corners())
    faces = "".join("f {} {} {}\n".format(*(corner + 1 for corner in triangle)) for triangle in TRIANGLES)
    library = f"mtllib {materials}\n" if materials else ""
    return f"{library}o box\n{points}{f'usemtl {use}' if use else ''}\n{faces}".encode()


def write_dae(
    *,
    up: str = "Z_UP",
    unit: float = 1.0,
    node: str = "",
    diffuse: str = "",
    scale: float | None = None,
    extra: str = "",
) -> bytes:
    """Return a COLLADA file.

    Args:
        up: its up axis.
        unit: its unit in meters; the box keeps its size, unless `scale` is given.
        node: the nodes around ``GEOMETRY``.
        diffuse: the content of `<diffuse>`; without it, there is no material.
        scale: the factor of the corners.
        extra: more elements of the material.
    """
    points = " ".join(str(value) for point in box_corners(1 / unit if scale is None else scale) for value in point)
    indices = " ".join(str(corner) for triangle in TRIANGLES for corner in triangle)
    effect = f"<effect id='e'><profile_COMMON><technique sid='t'><lambert><diffuse>{diffuse}</diffuse>{extra}</lambert>"
    material = (
        f"<library_effects>{effect}</technique></profile_COMMON></effect></library_effects>"
        "<library_materials><material id='m' name='m'><instance_effect url='#e'/></material></library_materials>"
    )
    bind = "<instance_material symbol='s' target='#m'/>"
    bind = f"<bind_material><technique_common>{bind}</technique_common></bind_material>" if diffuse else ""
    nodes = (node or "<node>GEOMETRY</node>").replace(
        "GEOMETRY", f"<instance_geometry url='#g'>{bind}</instance_geometry>"
    )
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter="{unit}"/><up_axis>{up}</up_axis></asset>
{material if diffuse else ""}
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{points}</float_array><technique_common>
<accessor source="#a" count="8" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12" {"material='s'" if diffuse else ""}><input semantic="VERTEX" source="#v" offset="0"/>
<p>{indices}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>""".encode()


def write_glb(*, color: tuple[float, ...] | None = None, rotation: tuple[float, ...] | None = None) -> bytes:
    points = b"".join(struct.pack("<3f", *point) for point in box_corners())
    indices = b"".join(struct.pack("<3H", *triangle) for triangle in TRIANGLES)
    node: dict[str, object] = {"mesh": 0}
    if rotation:
        node["rotation"] = rotation
    primitive: dict[str, object] = {"attributes": {"POSITION": 0}, "indices": 1}
    document: dict[str, object] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [primitive]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 8,
                "type": "VEC3",
                "min": [0, 0, 0],
                "max": list(BOX_SIZE_M),
            },
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(points) + len(indices)}],
    }
    if color:
        document["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0}}]
        primitive["material"] = 0
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary = points + indices
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def make_png(*color: int) -> bytes:
    """Return an image of one pixel."""

    def chunk(chunk_type: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + chunk_type + data + struct.pack(">I", zlib.crc32(chunk_type + data))

    header = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(b"\0" + bytes(color)))
        + chunk(b"IEND", b"")
    )
