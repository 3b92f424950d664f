"""The generated Kinect mesh: current, well formed, closed, outward, and of the right size."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import trimesh

from tests.places import PACKAGE
from tests.repository_tools import load_tool

MESH = PACKAGE / "meshes" / "kinect.dae"
COLLADA = {"c": "http://www.collada.org/2005/11/COLLADASchema"}
PARTS = ["body", "foot", "emitter", "color_lens", "depth_lens", "led"]


@pytest.fixture(scope="module")
def collada() -> ET.Element:
    return ET.parse(MESH).getroot()


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    return load_tool("make_kinect_mesh")


class Geometry:
    """The triangles of one <geometry>, as positions and normals.

    Each is an array of shape (triangles, 3 corners, 3).
    """

    def __init__(self, element: ET.Element) -> None:
        self.name = element.attrib["name"]
        sources = {source.attrib["id"]: _triples(source) for source in element.iterfind("c:mesh/c:source", COLLADA)}
        triangles = element.find("c:mesh/c:triangles", COLLADA)
        assert triangles is not None
        text = triangles.findtext("c:p", namespaces=COLLADA)
        assert text is not None
        indices = np.array(text.split(), dtype=int).reshape(-1, 3, 2)
        assert len(indices) == int(triangles.attrib["count"])
        positions = sources[f"{self.name}-positions"]
        assert indices[..., 0].max() == len(positions) - 1
        self.mesh = trimesh.Trimesh(positions, indices[..., 0], process=False)
        self.normals = sources[f"{self.name}-normals"][indices[..., 1]]


def _triples(source: ET.Element) -> np.ndarray:
    array = source.find("c:float_array", COLLADA)
    assert array is not None
    assert array.text is not None
    numbers = np.array(array.text.split(), dtype=float)
    assert len(numbers) == int(array.attrib["count"])
    return numbers.reshape(-1, 3)


@pytest.fixture(scope="module")
def geometries(collada: ET.Element) -> dict[str, Geometry]:
    geometries = [Geometry(element) for element in collada.iterfind("c:library_geometries/c:geometry", COLLADA)]
    return {geometry.name: geometry for geometry in geometries}


def test_file_matches_generator_output(tool: ModuleType) -> None:
    assert MESH.read_bytes() == tool.generate().encode("utf-8")


def test_generator_check_reports_stale_file(
    tool: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(tool, "TARGET", tmp_path / "meshes" / "kinect.dae")
    assert tool.main(["--check"]) == 1
    assert "is stale" in capsys.readouterr().err
    assert tool.main([]) == 0
    assert tool.main(["--check"]) == 0
    assert (tmp_path / "meshes" / "kinect.dae").read_bytes() == MESH.read_bytes()


def test_mesh_uses_meters_and_z_up(collada: ET.Element) -> None:
    assert collada.attrib["version"] == "1.4.1"
    unit = collada.find("c:asset/c:unit", COLLADA)
    assert unit is not None
    assert float(unit.attrib["meter"]) == 1.0
    assert collada.findtext("c:asset/c:up_axis", namespaces=COLLADA) == "Z_UP"


def test_parts_are_in_scene_with_existing_materials(
    collada: ET.Element, geometries: dict[str, Geometry]
) -> None:
    assert list(geometries) == PARTS
    identifiers = {element.attrib["id"] for element in collada.iter() if "id" in element.attrib}
    references = [
        element.attrib[name].removeprefix("#")
        for element in collada.iter()
        for name in ("url", "source", "target")
        if name in element.attrib
    ]
    assert set(references) <= identifiers
    shown = [element.attrib["url"] for element in collada.iter(f"{{{COLLADA['c']}}}instance_geometry")]
    assert shown == [f"#{part}-mesh" for part in PARTS]
    materials = {element.attrib["name"] for element in collada.iterfind("c:library_materials/c:material", COLLADA)}
    assert materials == {"shell", "foot", "lens", "emitter", "led"}


@pytest.mark.parametrize("part", PARTS)
def test_surfaces_are_closed_and_face_outward(geometries: dict[str, Geometry], part: str) -> None:
    mesh = geometries[part].mesh
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0


@pytest.mark.parametrize("part", PARTS)
def test_normals_have_unit_length_and_match_faces(geometries: dict[str, Geometry], part: str) -> None:
    geometry = geometries[part]
    assert np.allclose(np.linalg.norm(geometry.normals, axis=-1), 1.0, atol=1e-5)
    facing = np.einsum("tci,ti->tc", geometry.normals, geometry.mesh.face_normals)
    assert facing.min() > 0.9


def test_mesh_has_expected_size_and_position(geometries: dict[str, Geometry]) -> None:
    lower = np.min([geometry.mesh.bounds[0] for geometry in geometries.values()], axis=0)
    upper = np.max([geometry.mesh.bounds[1] for geometry in geometries.values()], axis=0)
    assert upper - lower == pytest.approx([0.28, 0.07, 0.046], abs=1e-6)
    assert lower[2] == pytest.approx(-0.034)
    # The mesh is symmetric: left and right, front and back.
    assert (upper + lower)[:2] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert geometries["foot"].mesh.bounds[0][2] == pytest.approx(lower[2])


def test_lenses_face_negative_y(geometries: dict[str, Geometry]) -> None:
    body = geometries["body"].mesh.bounds
    for name in ("emitter", "color_lens", "depth_lens", "led"):
        bounds = geometries[name].mesh.bounds
        assert bounds[0][1] < body[0][1] < bounds[1][1], "the part protrudes from the front of the body"
