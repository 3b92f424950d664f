"""STL files, compared with trimesh."""

import numpy as np
import pytest
import trimesh

from linkwright.geometry.mesh_files import read_placed_meshes
from linkwright.geometry.plain import PlainMesh
from linkwright.geometry.stl import read_stl

pytestmark = pytest.mark.extra("mesh")


def _stl_bytes(kind: str = "stl") -> bytes:
    data = trimesh.creation.icosphere(subdivisions=2, radius=0.3).export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


TEXT = _stl_bytes("stl_ascii")


@pytest.mark.parametrize(
    "data",
    [_stl_bytes(), TEXT, TEXT.replace(b"\n", b"\r\n"), b"solid a ball\n" + TEXT.partition(b"\n")[2]],
    ids=["binary", "text", "text of Windows", "text with a name"],
)
def test_stl_triangles_match_trimesh(data):
    (actual,) = read_placed_meshes(data, "stl")
    assert isinstance(actual.mesh, PlainMesh)
    scene = trimesh.load_scene(trimesh.util.wrap_as_stream(data), file_type="stl", process=False)
    ((name, expected),) = scene.geometry.items()
    assert np.array_equal(actual.mesh.vertices[actual.faces], expected.vertices[expected.faces])
    assert not actual.mesh.name or actual.names == {name}


@pytest.mark.parametrize(
    "data",
    [
        _stl_bytes()[:-1],
        _stl_bytes() + b"x",
        b"COLOR=" + _stl_bytes()[6:],
        _stl_bytes()[:-2] + b"\1\0",
        bytes(84),
        TEXT + TEXT,
        TEXT.replace(b"endloop", b"endlop", 1),
        TEXT.replace(b"vertex 0", b"vertex O", 1).replace(b"vertex -0", b"vertex -O", 1),
        b"solid\xff" + TEXT[5:],
        b"solid nothing\nendsolid nothing\n",
        b"",
    ],
    ids=[
        "short",
        "long",
        "colored",
        "colored triangles",
        "empty",
        "two solids",
        "a wrong word",
        "no number",
        "no UTF-8",
        "nothing in it",
        "nothing",
    ],
)
def test_unusual_stl_is_left_to_trimesh(data):
    assert read_stl(data) is None
