"""Solids from mesh files, for estimates of inertia."""

from __future__ import annotations

import gc
import os
import struct

import numpy as np
import pytest
import trimesh

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.meshes import read_mesh
from linkwright.inertia import MeshLibrary
from linkwright.packages import PackageFinder
from linkwright.urdf import Mesh
from linkwright.xmltree import parse
from tests.places import REPOSITORY

# numpy 2.5 warns about pycollada, which trimesh uses to write COLLADA files. The program only reads such files.
pytestmark = [
    pytest.mark.extra("mesh"),
    pytest.mark.filterwarnings("ignore:Setting the shape on a NumPy array:DeprecationWarning"),
]

CONE = trimesh.creation.cone(0.3, 1.0)


def write_cone(folder, kind):
    """Write a cone to a file of a format."""
    data = CONE.export(file_type=kind)
    path = folder / f"cone.{kind.partition('_')[0]}"
    if isinstance(data, dict):  # glTF with its buffer beside it
        for name, part in data.items():
            (folder / name).write_bytes(part)
        (folder / "model.gltf").rename(path)
    else:
        path.write_bytes(data.encode() if isinstance(data, str) else data)
    return path


@pytest.mark.parametrize("kind", ["stl", "obj", "glb"])
def test_reading_mesh_releases_memory_of_file(kind, tmp_path):
    """The garbage collector is off, because it rarely runs for a few large objects."""
    path = write_cone(tmp_path, kind)
    read_mesh(path)
    gc.collect()
    before = _count_mesh_objects()
    gc.disable()
    try:
        for _ in range(3):
            read_mesh(path)
        assert _count_mesh_objects() == before
    finally:
        gc.enable()


def _count_mesh_objects():
    """Return the number of objects with corners, triangles or the bytes of a file."""
    kinds = (trimesh.caching.TrackedArray, trimesh.caching.DataStore, trimesh.parent.LoadSource)
    return sum(isinstance(candidate, kinds) for candidate in gc.get_objects())


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "dae", "glb", "gltf"])
def test_all_mesh_formats_give_same_solid(kind, tmp_path):
    mesh = read_mesh(write_cone(tmp_path, kind))
    assert mesh.is_watertight
    assert mesh.solid.mass == pytest.approx(CONE.volume, rel=1e-5)
    assert np.allclose(mesh.solid.center, CONE.center_mass, atol=1e-5)
    assert np.allclose(mesh.solid.inertia, CONE.moment_inertia, rtol=1e-4, atol=1e-8)
    assert np.allclose(mesh.bounds, CONE.bounds, atol=1e-6)


def test_uppercase_file_extension_is_recognized(tmp_path):
    write_cone(tmp_path, "stl").rename(tmp_path / "CONE.STL")
    assert len(read_mesh(tmp_path / "CONE.STL").faces) == len(CONE.faces)


def test_collada_unit_is_applied_and_up_axis_is_ignored(tmp_path):
    path = write_cone(tmp_path, "dae")
    text = path.read_text(encoding="utf-8")
    assert "<up_axis>Y_UP</up_axis>" in text
    changed = text.replace("<asset>", '<asset><unit name="millimeter" meter="0.001"/>', 1)
    path.write_text(changed.replace("Y_UP", "Z_UP"), encoding="utf-8")
    assert np.allclose(read_mesh(path).bounds, CONE.bounds * 0.001, atol=1e-9)


def test_kinect_mesh_of_mbot_has_size_of_kinect():
    mesh = read_mesh(REPOSITORY / "robots" / "my_robot_description" / "meshes" / "kinect.dae")
    assert mesh.is_watertight
    assert np.allclose(mesh.bounds.size, (0.28, 0.07, 0.046), atol=1e-3)


def test_scene_nodes_transform_their_meshes(tmp_path):
    scene = trimesh.Scene()
    box = trimesh.creation.box((1, 1, 1))
    scene.add_geometry(box, transform=trimesh.transformations.translation_matrix((5, 0, 0)))
    mirrored = np.diag((1.0, -1.0, 1.0, 1.0))
    scene.add_geometry(box, transform=mirrored)
    (tmp_path / "scene.glb").write_bytes(scene.export(file_type="glb"))
    mesh = read_mesh(tmp_path / "scene.glb")
    assert mesh.is_watertight
    assert mesh.solid.mass == pytest.approx(2.0, rel=1e-5)
    assert np.allclose(mesh.solid.center, (2.5, 0, 0), atol=1e-5)


@pytest.mark.parametrize("scale", [(2, 2, 2), (0.001, 0.001, 0.001), (1, -1, 1), (-1, -2, -3)])
def test_mesh_scale_scales_solid(scale, tmp_path):
    mesh = read_mesh(write_cone(tmp_path, "stl")).scaled(scale)
    assert mesh.is_watertight
    assert mesh.solid.mass == pytest.approx(CONE.volume * abs(np.prod(scale)), rel=1e-5)
    assert np.allclose(mesh.solid.center, CONE.center_mass * scale, atol=1e-5)


def test_open_mesh_is_replaced_by_convex_hull(tmp_path):
    ball = trimesh.creation.icosphere(2)
    ball.update_faces(np.arange(len(ball.faces)) > 3)
    (tmp_path / "open.stl").write_bytes(ball.export(file_type="stl"))
    mesh = read_mesh(tmp_path / "open.stl")
    assert not mesh.is_watertight
    assert mesh.solid.mass == pytest.approx(trimesh.creation.icosphere(2).volume, rel=1e-2)


def test_flat_mesh_has_no_mass(tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert read_mesh(tmp_path / "flat.obj").solid.mass == 0


@pytest.mark.parametrize(
    ("name", "data", "code"),
    [
        ("none.stl", None, "INR101"),
        ("part.step", b"ISO-10303-21;", "INR102"),
        ("empty.stl", b"", "INR103"),
        ("lfs.stl", b"version https://git-lfs.github.com/spec/v1\n", "INR103"),
        ("torn.stl", b"\0" * 80 + struct.pack("<I", 1000) + b"\0" * 50, "INR103"),
        ("torn.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff", "INR103"),
        ("torn.gltf", b'{"asset": {"version": "2.0"}', "INR103"),
        ("torn.dae", b"<COLLADA>", "INR103"),
        ("words.dae", b"not XML at all", "INR103"),
        ("bad.obj", b"v 0 0\nf 1 2 99\n", "INR103"),
        ("infinite.obj", b"v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n", "INR103"),
        ("folder.stl", b"/", "INR103"),
    ],
)
def test_unreadable_mesh_error_names_cause(name, data, code, tmp_path):
    path = tmp_path / name
    if data == b"/":
        path.mkdir()
    elif data is not None:
        path.write_bytes(data)
    with pytest.raises(LinkwrightError) as caught:
        read_mesh(path)
    assert caught.value.diagnostics[0].code == code
    assert caught.value.diagnostics[0].hint


def test_gltf_reads_no_file_outside_its_folder(tmp_path):
    inner_folder = tmp_path / "inner"
    inner_folder.mkdir()
    path = write_cone(inner_folder, "gltf")
    buffer = next(inner_folder.glob("*.bin"))
    buffer.rename(tmp_path / "secret.bin")
    path.write_text(path.read_text().replace(buffer.name, "../secret.bin"))
    with pytest.raises(LinkwrightError):
        read_mesh(path)


def test_mesh_library_reads_file_once_and_resolves_relative_path(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "urdf").mkdir()
    write_cone(tmp_path / "meshes", "stl")
    document = parse('<mesh filename="../meshes/cone.stl"/>', str(tmp_path / "urdf" / "part.xacro"))
    library = MeshLibrary(PackageFinder(start=tmp_path), tmp_path)
    first = library.load(Mesh("../meshes/cone.stl"), document.root)
    assert library.load(Mesh("../meshes/cone.stl"), document.root) is first
    assert library.load(Mesh("meshes/cone.stl")) is first
    for _ in range(2):
        with pytest.raises(LinkwrightError) as caught:
            library.load(Mesh("package://nowhere/cone.stl"))
        assert caught.value.diagnostics[0].code == "PKG101"
        with pytest.raises(LinkwrightError) as caught:
            library.load(Mesh("meshes/cube.stl"))
        assert caught.value.diagnostics[0].code == "INR101"


def test_mesh_library_rereads_changed_mesh_only(tmp_path):
    path = write_cone(tmp_path, "stl")
    finder = PackageFinder(start=tmp_path)
    first = MeshLibrary(finder, tmp_path).read(path)
    assert MeshLibrary(finder, tmp_path).read(path) is first
    CONE.copy().apply_scale(2).export(path)
    os.utime(path, ns=(1, 1))  # the times differ also with a coarse clock of the file system
    assert np.allclose(MeshLibrary(finder, tmp_path).read(path).bounds, np.multiply(first.bounds, 2))


def test_equal_gltf_files_with_other_buffers_are_different_meshes(tmp_path):
    paths = []
    for name in ("old", "new"):
        (tmp_path / name).mkdir()
        paths.append(write_cone(tmp_path / name, "gltf"))
    corners = tmp_path / "new" / "gltf_buffer_1.bin"
    corners.write_bytes((2 * np.frombuffer(corners.read_bytes(), np.float32)).tobytes())
    library = MeshLibrary(PackageFinder(start=tmp_path), tmp_path)
    old, new = map(library.read, paths)
    assert np.allclose(new.bounds, np.multiply(old.bounds, 2))
