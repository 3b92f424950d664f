"""``linkwright convert``."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from linkwright.cli import main
from linkwright.descriptions import examine_world

INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
ROBOT = f"""\
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="size" default="1"/>
  <link name="base">{INERTIAL}<visual><geometry><box size="$(arg size) 1 1"/></geometry></visual></link>
  <link name="tip">{INERTIAL}</link>
  <joint name="fix" type="fixed"><parent link="base"/><child link="tip"/><origin xyz="0 0 1"/></joint>
</robot>
"""
BALL = """\
<sdf version="1.6"><model name="ball"><link name="l"><visual name="v"><geometry>
  <mesh><uri>meshes/ball.stl</uri></mesh></geometry></visual></link></model></sdf>
"""
WORLD = """\
<sdf version="1.5"><world name="w"><physics type="ode"><gravity>0 0 -1</gravity></physics>
  <include><uri>model://ball</uri><pose>1 2 3 0 0 0</pose></include>
  <state world_name="w"><model name="ball"><pose>4 5 6 0 0 0</pose></model></state>
</world></sdf>
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "arm.xacro").write_text(ROBOT)
    (tmp_path / "w.world").write_text(WORLD)
    (tmp_path / "models/ball/meshes").mkdir(parents=True)
    (tmp_path / "models/ball/model.sdf").write_text(BALL)
    (tmp_path / "models/ball/meshes/ball.stl").write_bytes(bytes(84))
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
    return tmp_path


def test_xacro_is_converted_to_sdf_with_arguments(folder, capsys):
    assert main(["convert", "arm.xacro", "size:=4"]) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith('<?xml version="1.0" ?>\n<sdf version="1.11">\n  <model name="arm">\n')
    assert "<size>4 1 1</size>" in printed.out
    assert '<frame attached_to="fix" name="tip"/>' in printed.out
    assert printed.err == ""


def test_keep_fixed_joints_preserves_links(folder, capsys):
    assert main(["convert", "arm.xacro", "--keep-fixed-joints", "-o", "out/arm.sdf"]) == 0
    assert "Created file out/arm.sdf" in capsys.readouterr().out
    sdf = examine_world(folder / "out/arm.sdf").sdf
    assert sdf is not None
    assert [link.name for link in sdf.models[0].links] == ["base", "tip"]
    assert [joint.name for joint in sdf.models[0].joints] == ["fix"]


def test_converted_world_contains_includes_at_saved_poses(folder):
    assert main(["convert", "w.world", "-o", "flat.world"]) == 0
    model_world = examine_world(folder / "flat.world", environment={"HOME": "/nowhere"})
    assert model_world.diagnostics == ()
    assert model_world.sdf is not None
    world = model_world.sdf.worlds[0]
    assert (world.gravity, world.includes, world.states) == ((0.0, 0.0, -1.0), (), ())
    assert world.models[0].pose.pose.xyz == (4.0, 5.0, 6.0)


def test_mesh_uris_are_relative_only_below_output_folder(folder):
    assert main(["convert", "w.world", "-o", "flat.world"]) == 0
    assert "<uri>models/ball/meshes/ball.stl</uri>" in (folder / "flat.world").read_text()
    assert main(["convert", "w.world", "-o", "elsewhere/flat.world"]) == 0
    address = (folder / "models/ball/meshes/ball.stl").as_uri()
    assert f"<uri>{address}</uri>" in (folder / "elsewhere/flat.world").read_text()


def test_missing_model_stays_an_include_and_is_reported(folder, capsys):
    (folder / "w.world").write_text(WORLD.replace("model://ball", "model://cube"))
    assert main(["convert", "w.world"]) == 0
    printed = capsys.readouterr()
    assert "<uri>model://cube</uri>" in printed.out
    assert "SDF160" in printed.err


def test_file_without_robot_is_an_error(folder, capsys):
    (folder / "no.urdf").write_text("<launch/>")
    assert main(["convert", "no.urdf"]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "URDF101" in printed.err


def test_robot_is_converted_to_mjcf(folder):
    mujoco = pytest.importorskip("mujoco")
    assert main(["convert", "arm.xacro", "--to", "mjcf", "-o", "arm.xml"]) == 0
    model = mujoco.MjModel.from_xml_path(str(folder / "arm.xml"))
    assert (model.nbody, model.njnt) == (2, 1)
    assert sum(model.body_mass) == pytest.approx(2.0)


def test_invalid_model_is_not_converted_to_mjcf(folder, capsys):
    pytest.importorskip("mujoco")
    (folder / "m.sdf").write_text(
        '<sdf version="1.9"><model name="m"><link name="a"><pose relative_to="b"/></link></model></sdf>'
    )
    assert main(["convert", "m.sdf", "--to", "mjcf"]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "SDF141" in printed.err


def test_mujoco_error_is_reported(folder, capsys, monkeypatch):
    pytest.importorskip("mujoco")

    class Refused:
        def __init__(self, *_):
            self.spec = self

        def compile(self):
            raise ValueError("mesh volume is too small:\n  mesh0")

    monkeypatch.setattr("linkwright.simulation.mjcf.Scene", Refused)
    assert main(["convert", "arm.xacro", "--to", "mjcf"]) == 1
    assert "MuJoCo rejects the model: mesh volume is too small: mesh0" in capsys.readouterr().err


def test_sdf_model_is_converted_to_urdf(folder, capsys):
    assert main(["convert", "models/ball/model.sdf", "--to", "urdf", "-o", "ball.urdf"]) == 0
    text_of_ball = (folder / "ball.urdf").read_text()
    assert '<robot name="ball"' in text_of_ball
    assert 'filename="models/ball/meshes/ball.stl"' in text_of_ball
    assert capsys.readouterr().err == ""


def test_worlds_and_urdf_are_not_converted_to_urdf(folder, capsys):
    assert main(["convert", "w.world", "--to", "urdf"]) == 1
    assert "error[SDF180]" in capsys.readouterr().err
    assert main(["convert", "arm.xacro", "--to", "urdf"]) == 1
    assert "error[CLI322]" in capsys.readouterr().err


def test_mjcf_materials_have_mean_texture_colors(tmp_path: Path) -> None:
    corners = "v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0.1 -1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    (tmp_path / "quad.obj").write_text(corners + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n")
    mujoco = pytest.importorskip("mujoco")
    image = Image.new("RGB", (4, 4), (255, 0, 0))
    image.paste((0, 0, 255), (2, 0, 4, 4))
    image.save(tmp_path / "halves.png")
    material = "<diffuse>0.5 1 1 1</diffuse><pbr><metal><albedo_map>halves.png</albedo_map></metal></pbr>"
    world = tmp_path / "panel.sdf"
    world.write_text(
        '<sdf version="1.9"><model name="m"><static>true</static><link name="l"><visual name="v"><geometry><mesh>'
        f"<uri>quad.obj</uri></mesh></geometry><material>{material}</material></visual></link></model></sdf>"
    )
    assert main(["convert", str(world), "--to", "mjcf", "-o", str(tmp_path / "out" / "m.xml")]) == 0
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / "m.xml"))
    assert model.ntex == 0
    assert model.geom_rgba[0].tolist() == pytest.approx([0.25, 0.0, 0.5, 1.0], abs=1e-3)
