"""Optional libraries, and the offers to install them."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from linkwright.bag import BagReader, BagWriter
from linkwright.cli.tools.programs import main
from linkwright.diagnostics import LinkwrightError, Severity
from linkwright.diagnostics.extras import EXTRAS, install_hint, missing_extra
from linkwright.geometry.mesh_parts import read_parts
from linkwright.geometry.meshes import read_mesh
from linkwright.images import BadImageError
from linkwright.images.image_files import decode_file
from linkwright.lint.engine import examine
from linkwright.planning.library import load_ompl
from linkwright.urdf.diagram import render
from tests import toml_files


@pytest.fixture
def hide_library(monkeypatch):
    """Let a library appear not to be installed."""

    def hide(module: str) -> None:
        for name in [name for name in sys.modules if name.partition(".")[0] == module]:
            monkeypatch.delitem(sys.modules, name)
        monkeypatch.setitem(sys.modules, module, None)

    return hide


def test_extras_table_matches_pyproject():
    assert EXTRAS.keys() == toml_files.EXTRAS.keys()
    assert EXTRAS.keys() > toml_files.TOGETHER


@pytest.mark.parametrize(
    ("extra", "use"),
    [
        ("arm", lambda _folder: load_ompl.__wrapped__()),
        ("bag", BagReader),
        ("bag", lambda folder: BagWriter(folder / "new")),
        ("diagram", lambda folder: render("digraph G {}", folder / "robot.pdf")),
        ("mesh", lambda folder: read_mesh(small_mesh(folder))),
        ("mesh", lambda folder: read_parts(small_mesh(folder), resolver=None)),
    ],
)
def test_missing_library_is_named_with_install_hint(extra, use, hide_library, tmp_path):
    hide_library(EXTRAS[extra])
    with pytest.raises(LinkwrightError, match=f"'{EXTRAS[extra]}' is not installed") as caught:
        use(tmp_path)
    assert caught.value.diagnostics[0].hint == install_hint(extra)


def small_mesh(folder):
    """Write a tetrahedron as an OBJ file with a continued line.

    Usual OBJ and STL files need no extra.
    """
    corners = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    faces = ((1, 3, 2), (1, 2, 4), (2, 3, 4), (1, 4, 3))
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a} {b} {c}" for a, b, c in faces]
    path = folder / "tetrahedron.obj"
    path.write_text("\n".join(lines).replace("f 1 3 2", "f 1 3 \\\n2") + "\n")
    return path


ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/>
  <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <visual><geometry><mesh filename="tetrahedron.obj"/></geometry></visual>
  <collision><geometry><mesh filename="tetrahedron.obj"/></geometry></collision></link></robot>"""


@pytest.mark.extra("mesh")
def test_unread_meshes_are_reported_once_per_check(hide_library, tmp_path):
    def unread_in(folder):
        folder.mkdir()
        mesh = small_mesh(folder)
        mesh.write_text(f"{mesh.read_text()}# {folder.name}\n")
        (folder / "robot.urdf").write_text(ROBOT)
        return [diagnostic for diagnostic in examine(folder / "robot.urdf").diagnostics if diagnostic.code == "INR104"]

    assert unread_in(tmp_path / "with") == []
    hide_library("trimesh")
    unread = unread_in(tmp_path / "without")  # with other content, because meshes that were read are cached
    assert [(diagnostic.severity, diagnostic.hint) for diagnostic in unread] == [(Severity.INFO, install_hint("mesh"))]


def test_image_decoder_names_missing_image_extra(hide_library):
    hide_library("PIL")
    with pytest.raises(BadImageError, match=r"\[image\]"):
        decode_file(np.frombuffer(b"\x89PNG\r\n\x1a\n", np.uint8))


@pytest.mark.parametrize(
    ("version", "module", "hint"),
    [
        ((3, 14), "rosbags", "[bag]'"),
        ((3, 15), "rosbags", "there is no wheel of rosbags for Python 3.15: use an older Python, or"),
        ((3, 15), "cv2", "[vision]'"),
        ((3, 15), "trimesh", "[mesh]'"),
    ],
)
def test_missing_wheel_for_new_python_is_reported(monkeypatch, version, module, hint):
    monkeypatch.setattr("linkwright.diagnostics.extras._PYTHON_VERSION", version)
    error = missing_extra("BAG107", ModuleNotFoundError(module, name=module))
    assert str(error.diagnostics[0].hint).count(hint) == 1


def test_missing_module_of_no_extra_is_raised_unchanged():
    with pytest.raises(ModuleNotFoundError, match="another"):
        missing_extra("BAG107", ModuleNotFoundError("another", name="another.module"))


def test_missing_colcon_is_reported_with_install_hint(hide_library, capsys):
    hide_library("colcon_core")
    assert main("colcon", ["build"]) == 1
    assert str(install_hint("colcon")) in capsys.readouterr().err
