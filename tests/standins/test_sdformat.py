"""The Python bindings of libsdformat, as launch files use them."""

from __future__ import annotations

import importlib

import pytest
import sdformat14 as sdf

BOAT = """
<sdf version="1.9">
  <model name="boat" canonical_link="hull">
    <static>true</static>
    <link name="hull">
      <sensor name="eye" type="camera"><update_rate>20</update_rate><topic>see</topic><camera/></sensor>
      <sensor name="sweep" type="gpu_ray"/>
      <sensor name="odd" type="nose"/>
      <collision name="shell"><geometry><box><size>1 1 1</size></box></geometry></collision>
      <visual name="paint"><geometry><sphere><radius>1</radius></sphere></geometry></visual>
    </link>
    <link name="screw"><gravity>false</gravity></link>
    <joint name="shaft" type="revolute"><parent>hull</parent><child>screw</child><axis><xyz>1 0 0</xyz></axis></joint>
    <plugin filename="thruster" name="own::Thruster"><name>left</name></plugin>
  </model>
</sdf>
"""


@pytest.fixture
def boat():
    root = sdf.Root()
    root.load_sdf_string(BOAT)
    return root.model()


@pytest.mark.parametrize("module", ["sdformat", "sdformat13", "sdformat14", "sdformat15"])
def test_each_version_has_its_module(module):
    assert importlib.import_module(module).Root is sdf.Root


def test_links_and_joints_are_found_by_index_and_name(boat):
    assert (boat.name(), boat.static(), boat.canonical_link_name()) == ("boat", True, "hull")
    assert [boat.link_by_index(index).name() for index in range(boat.link_count())] == ["hull", "screw"]
    assert boat.link_by_index(2) is None
    assert boat.link_by_name("keel") is None
    assert boat.link_name_exists("screw")
    assert not boat.link_name_exists("keel")
    assert not boat.link_by_name("screw").enable_gravity()
    shaft = boat.joint_by_name("shaft")
    assert (shaft.type(), shaft.parent_name(), shaft.child_name()) == (sdf.JointType.REVOLUTE, "hull", "screw")
    hull = boat.link_by_index(0)
    assert (hull.collision_by_index(0).name(), hull.visual_count()) == ("shell", 1)


def test_sensors_have_types(boat):
    hull = boat.link_by_name("hull")
    types = [hull.sensor_by_index(index).type() for index in range(hull.sensor_count())]
    assert types == [sdf.Sensortype.CAMERA, sdf.Sensortype.GPU_LIDAR, sdf.Sensortype.NONE]
    assert sdf.Sensortype.CAMERA != "camera"
    eye = hull.sensor_by_name("eye")
    assert (eye.type_str(), eye.topic(), eye.update_rate()) == ("camera", "see", 20.0)


def test_plugins_are_written_with_their_parameters(boat):
    (plugin,) = boat.plugins()
    assert (plugin.name(), plugin.filename()) == ("own::Thruster", "thruster")
    assert "<name>left</name>" in str(plugin)
    assert str(plugin).startswith("<plugin ")


def test_worlds_contain_included_models(tmp_path):
    (tmp_path / "buoy").mkdir()
    (tmp_path / "buoy" / "model.config").write_text(
        '<model><name>buoy</name><sdf version="1.6">model.sdf</sdf></model>'
    )
    (tmp_path / "buoy" / "model.sdf").write_text(
        '<sdf version="1.6"><model name="buoy"><link name="body"/></model></sdf>'
    )
    world_file = tmp_path / "sea.sdf"
    world_file.write_text(
        '<sdf version="1.6"><world name="sea"><include><uri>model://buoy</uri><name>red</name></include></world></sdf>'
    )
    root = sdf.Root()
    root.load(str(world_file))
    assert (root.world_count(), root.world_by_index(1), root.model()) == (1, None, None)
    world = root.world_by_index(0)
    assert (world.name(), world.model_by_name("red").link_count()) == ("sea", 1)


def test_urdf_is_converted():
    root = sdf.Root()
    root.load_sdf_string('<robot name="cart"><link name="base"/></robot>')
    assert root.model().name() == "cart"


def test_errors_say_where_they_are(tmp_path):
    with pytest.raises(sdf.SDFErrorsException, match=r"data-string:1:20: <model> has no 'name'") as raised:
        sdf.Root().load_sdf_string("<sdf version='1.9'><model/></sdf>")
    assert [error.message() for error in raised.value.errors] == ["<model> has no 'name'"]
    with pytest.raises(sdf.SDFErrorsException, match="no such file"):
        sdf.Root().load(str(tmp_path / "missing.sdf"))
    with pytest.raises(sdf.SDFErrorsException):
        sdf.Root().load_sdf_string("not XML")


def test_functions_that_are_not_offered_are_named_in_the_error(boat):
    with pytest.raises(
        AttributeError, match=r"Model\.raw_pose is not available in Linkwright, which offers: .*link_count"
    ):
        boat.raw_pose()
    with pytest.raises(AttributeError, match="Box"):
        sdf.Box()


def test_an_unread_root_is_empty():
    root = sdf.Root()
    assert (root.version(), root.model(), root.light(), root.world_count()) == ("", None, None, 0)
