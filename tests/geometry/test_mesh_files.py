"""Properties of mesh files before parsing, and the readable parts of damaged files."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.geometry.mesh_files import count_declared_triangles, read_placed_meshes
from tests.geometry.test_mesh_faults import COLLADA

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
    assert count_declared_triangles(file) == count


def test_missing_file_declares_no_triangles(tmp_path: Path) -> None:
    assert count_declared_triangles(tmp_path / "a.stl") is None


@pytest.mark.extra("mesh")
@pytest.mark.parametrize(
    "materials",
    ["", '<library_materials><material id="red"><instance_effect url="#none"/></material></library_materials>'],
    ids=["no material", "a material without its effect"],
)
def test_collada_keeps_mesh_with_unreadable_material(materials: str) -> None:
    bound = (
        '<bind_material><technique_common><instance_material symbol="m" target="#red"/></technique_common>'
        "</bind_material></instance_geometry>"
    )
    node_text = '<node id="n"><instance_geometry url="#g"/></node>'
    worn = node_text.replace('"n"', '"worn"').replace('"#g"/>', '"#g">' + bound)
    text = COLLADA.replace(node_text, node_text + worn).replace("<library_visual", materials + "<library_visual", 1)
    assert len(read_placed_meshes(text.encode(), "dae")) == 2


@pytest.mark.extra("mesh")
def test_collada_keeps_mesh_beside_an_element_at_an_unknown_place() -> None:
    geometry = '<instance_geometry url="#g"/>'
    misplaced = "<bind_material><technique_common/></bind_material>"
    assert geometry in COLLADA
    assert len(read_placed_meshes(COLLADA.replace(geometry, geometry + misplaced).encode(), "dae")) == 1


@pytest.mark.extra("mesh")
@pytest.mark.parametrize(
    ("proper", "malformed"),
    [
        ('<node id="n"', '<node id="<STL_BINARY>" name="n"'),
        ("<asset>", "<asset><!-- made -- by hand -->"),
        ("<asset>", '<asset><contributor><author a="1"b="2">R&D</author></contributor>'),
    ],
    ids=["< in a value", "hyphens in a comment", "no blank between attributes, and &"],
)
@pytest.mark.parametrize("is_plain", [True, False])
def test_collada_tolerates_same_xml_errors_as_gazebo(proper: str, malformed: str, is_plain: bool) -> None:
    assert proper in COLLADA
    (expected,) = read_placed_meshes(COLLADA.encode(), "dae", is_plain=is_plain)
    (placed_mesh,) = read_placed_meshes(COLLADA.replace(proper, malformed).encode(), "dae", is_plain=is_plain)
    assert placed_mesh.faces.tolist() == expected.faces.tolist()
    assert placed_mesh.mesh.vertices.tolist() == expected.mesh.vertices.tolist()
