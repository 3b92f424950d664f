"""The images of mesh files: a PNG is unchanged, and other formats are converted to PNG."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from linkwright.geometry.mesh_files import BadMeshError, create_file_resolver
from linkwright.geometry.mesh_parts import read_parts

pytestmark = pytest.mark.extra("image")

OBJ = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"


def encode_image(kind: str) -> bytes:
    file = BytesIO()
    Image.fromarray(np.full((8, 8, 3), (200, 30, 60), dtype=np.uint8)).save(file, kind)
    return file.getvalue()


def read_mesh_image(folder: Path, name: str, data: bytes) -> bytes | None:
    """Return the image of a mesh with one triangle."""
    (folder / "m.obj").write_text(OBJ)
    (folder / "m.mtl").write_text(f"newmtl m\nKd 1 1 1\nmap_Kd {name}\n")
    (folder / name).write_bytes(data)
    (part,) = read_parts(folder / "m.obj", resolver=create_file_resolver(str(folder / "m.obj")))
    assert part.file_material is not None
    return part.file_material.image


def test_png_is_not_reencoded(tmp_path: Path) -> None:
    data = encode_image("PNG")
    assert read_mesh_image(tmp_path, "i.png", data) == data


def test_jpeg_is_converted_to_png_of_same_color(tmp_path: Path) -> None:
    image = read_mesh_image(tmp_path, "i.jpg", encode_image("JPEG"))
    assert image is not None
    with Image.open(BytesIO(image)) as opened_image:
        assert opened_image.format == "PNG"
        assert np.abs(np.asarray(opened_image).astype(int) - (200, 30, 60)).max() < 4


def test_truncated_png_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(BadMeshError):
        read_mesh_image(tmp_path, "i.png", encode_image("PNG")[:-20])
