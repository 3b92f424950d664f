"""`linkwright check`: the tree of check_urdf, findings with their locations, exit status."""

from __future__ import annotations

import struct
import subprocess
import sys

from linkwright.cli import main
from linkwright.cli.check import parse_without_options
from linkwright.cli.command import create_parser
from tests.geometry.test_mesh_faults import COLLADA
from tests.imports import loaded_by
from tests.places import PACKAGE


def test_check_prints_tree_of_valid_model(capsys):
    assert main(["check", str(PACKAGE / "urdf" / "mbot_base.urdf")]) == 0
    captured = capsys.readouterr()
    assert captured.out.splitlines()[:4] == [
        "robot name is: mbot",
        "---------- Successfully Parsed XML ---------------",
        "root Link: base_link has 4 child(ren)",
        "    child(1):  back_caster_link",
    ]
    assert captured.err == "0 errors, 0 warnings\n"


def test_checking_robot_imports_no_world_modules():
    """The check of a robot imports no modules of worlds.

    Building their tables of elements and attributes takes longer than the check.

    The import of `importlib.metadata` takes as long, so `linkwright.loading.extensions` does not use it.
    """
    words = ["check", str(PACKAGE / "urdf" / "mbot_base.xacro")]
    loaded = loaded_by(f"from linkwright.cli import main; main({words})")
    assert "linkwright.lint.engine" in loaded
    assert not {"asyncio", "importlib.metadata", "linkwright.sdf", "linkwright.graph", "tomllib"} & loaded
    assert "linkwright.lint.rules.names_text" in loaded
    assert not {"linkwright.lint.rules.launch_nodes", "linkwright.lint.rules.package_manifest"} & loaded


def test_checking_masses_and_small_meshes_imports_no_numpy(tmp_path):
    """The import of numpy takes longer than the rest of the check.

    Xacro has nothing to expand here.
    """
    box = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    triangle = struct.pack("<12fH", 0, 0, 1, *(part for corner in box for part in corner), 0)
    (tmp_path / "part.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + triangle)
    (tmp_path / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    (tmp_path / "part.dae").write_text(COLLADA)
    robot = tmp_path / "robot.urdf"
    inertia = '<inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>'
    links = "".join(
        f'<link name="{kind}"><inertial><mass value="1"/>{inertia}</inertial>'
        f'<collision><geometry><mesh filename="part.{kind}"/></geometry></collision></link>'
        for kind in ("stl", "obj", "dae")
    )
    joint = "".join(
        f'<joint name="{kind}" type="fixed"><parent link="stl"/><child link="{kind}"/></joint>'
        for kind in ("obj", "dae")
    )
    robot.write_text(f'<robot name="r">{links}{joint}</robot>')
    code = "import sys; from linkwright.cli import main; main(sys.argv[1:]); print(*sorted(sys.modules))"
    command = [sys.executable, "-c", code, "check", "--select", "ALL", str(robot)]
    result = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "the collision mesh 'part.stl' of link 'stl' is not watertight" in result.stderr
    loaded = set(result.stdout.split())
    assert not {"dataclasses", "inspect", "numpy", "pkgutil", "typing", "linkwright.xacro.expansion"} & loaded


def test_checking_plain_urdf_imports_neither_xacro_nor_argparse():
    words = ["check", str(PACKAGE / "urdf" / "mbot_base.urdf")]
    loaded = loaded_by(f"from linkwright.cli import main; main({words})")
    assert "linkwright.lint.rules.xacro_tags" in loaded
    assert (
        not {"argparse", "ast", "gettext", "typing", "linkwright.lint.xacro_facts", "linkwright.xacro.macros"} & loaded
    )


def test_arguments_without_options_match_full_parser():
    words = ["robot.urdf", "a:=1"]
    assert vars(parse_without_options(words)) == vars(create_parser("check").parse_args(words))
    assert parse_without_options([]) is None


def test_xacro_is_expanded_before_check(capsys):
    assert main(["check", str(PACKAGE / "urdf" / "mbot_base.xacro")]) == 0
    assert "base_link has 11 child(ren)" in capsys.readouterr().out


def test_independent_errors_are_reported_together(tmp_path, capsys):
    model = tmp_path / "bad.urdf"
    model.write_text(
        '<robot name="r">\n'
        '  <link name="a"/>\n'
        '  <link name="b"/>\n'
        '  <joint name="j" type="revolut"><parent link="a"/><child link="b"/></joint>\n'
        '  <link name="b"/>\n'
        "</robot>\n"
    )
    assert main(["check", str(model)]) == 1
    err = capsys.readouterr().err
    assert f"{model}:4:25" in err
    assert "did you mean 'revolute'" in err
    assert f"{model}:5:" in err


def test_finding_in_macro_names_macro_call(tmp_path, capsys):
    model = tmp_path / "bad.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:macro name="wheel" params="side">\n'
        '    <link name="${side}_wheel"><visual><geometry><sphere radius="big"/></geometry></visual></link>\n'
        "  </xacro:macro>\n"
        '  <xacro:wheel side="left"/>\n'
        "</robot>\n"
    )
    assert main(["check", str(model)]) == 1
    err = capsys.readouterr().err
    assert f"{model}:3:" in err
    assert f"{model}:5:3" in err
    assert "wheel" in err
