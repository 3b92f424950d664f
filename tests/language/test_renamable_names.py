"""Renaming from any file.

The tests cover computed names, mentions, launch arguments, SDF, and descriptions that lack a package.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.language.file_renaming import rename_file
from linkwright.language.includes import real_path
from linkwright.language.renamable_names import renamable_name_at, rename_name
from linkwright.language.renaming import Renaming
from linkwright.language.workspace import Workspace
from linkwright.xacro import expand

ROBOT = """<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <xacro:include filename="wheel.xacro"/>
  <link name="$(arg prefix)base"/>
  <xacro:wheel side="left" prefix="$(arg prefix)"/>
  <xacro:wheel side="right" prefix="$(arg prefix)"/>
  <xacro:sensor name="camera" parent="$(arg prefix)base"/>
</robot>
"""
WHEEL = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side prefix mount:='base'">
    <link name="${prefix}${side}_wheel"/>
    <joint name="${prefix}${side}_wheel_joint" type="continuous">
      <parent link="${prefix}base"/>
      <child link="${prefix}${side}_wheel"/>
    </joint>
    <transmission name="${prefix}${side}_wheel_joint_trans">
      <joint name="${prefix}${side}_wheel_joint"/>
    </transmission>
  </xacro:macro>
  <xacro:macro name="sensor" params="name parent">
    <link name="${name}_link"/>
    <joint name="${name}_joint" type="fixed"><parent link="${parent}"/><child link="${name}_link"/></joint>
  </xacro:macro>
  <xacro:macro name="spare" params="name">
    <link name="${name}_spare"/>
    <joint name="${name}_fix" type="fixed"><parent link="base"/><child link="${name}_spare"/></joint>
  </xacro:macro>
</robot>
"""
YAML = """diff_drive:
  ros__parameters:
    left_wheel_names: ["left_wheel_joint"]
    right_wheel_names:
      - right_wheel_joint
    base_frame_id: base
camera:
  ros__parameters:
    frame_id: camera_link
"""
RVIZ = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/TF
      Frames:
        camera_link:
          Value: true
      Tree:
        base:
          camera_link:
            {}
  Global Options:
    Fixed Frame: base
"""
SRDF = """<robot name="rover" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <group name="g"><joint name="$(arg prefix)left_wheel_joint"/><link name="camera_link"/></group>
</robot>
"""
STATIC = """<launch>
  <node pkg="tf2_ros" exec="static_transform_publisher" args="0 0 0 0 0 0 base map"/>
</launch>
"""
ROBOT_FILES = {
    "description/package.xml": "<package format='3'><name>rover_description</name></package>",
    "description/urdf/rover.urdf.xacro": ROBOT,
    "description/urdf/wheel.xacro": WHEEL,
    "bringup/package.xml": "<package format='3'><name>bringup</name><depend>rover_description</depend></package>",
    "bringup/config/rover.yaml": YAML,
    "bringup/config/rover.rviz": RVIZ,
    "bringup/config/rover.srdf.xacro": SRDF,
    "bringup/launch/static.launch.xml": STATIC,
}


class Files:
    """A workspace with some files.

    Args:
        folder: the root of the workspace.
        files: path -> text.
    """

    def __init__(self, folder: Path, files: Mapping[str, str]) -> None:
        self.folder = real_path(folder)
        for name, text in files.items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        self.workspace = Workspace([self.folder])
        self.workspace.index.refresh()

    def rename(self, file: str, before: str, new: str) -> tuple[Renaming, dict[str, str]]:
        """Rename the symbol after a text in a file.

        Return the renaming with the new texts of all changed files.
        """
        path = self.folder / file
        text = path.read_text(encoding="utf-8")
        place = renamable_name_at(self.workspace, {}, path, text.index(before) + len(before))
        assert place is not None
        renaming = rename_name(self.workspace, {}, place, new)
        texts: dict[str, str] = {}
        for edit in sorted(renaming.edits, reverse=True):
            name = edit.file.relative_to(self.folder).as_posix()
            present = texts.get(name) or edit.file.read_text(encoding="utf-8")
            texts[name] = present[: edit.start] + edit.text + present[edit.end :]
        return renaming, texts


Make = Callable[[Mapping[str, str]], Files]


@pytest.fixture
def make_files(tmp_path: Path) -> Make:
    return lambda files: Files(tmp_path, files)


def test_computed_joint_is_renamed_from_yaml_by_its_literal_part(make_files: Make):
    files = make_files(ROBOT_FILES)
    renaming, texts = files.rename("bringup/config/rover.yaml", '["left', "left_tire_joint")
    assert renaming.names == {"left_wheel_joint": "left_tire_joint", "right_wheel_joint": "right_tire_joint"}
    assert '<joint name="${prefix}${side}_tire_joint" type' in texts["description/urdf/wheel.xacro"]
    assert '<joint name="${prefix}${side}_tire_joint"/>' in texts["description/urdf/wheel.xacro"]
    assert texts["bringup/config/rover.yaml"] == YAML.replace("_wheel_joint", "_tire_joint")
    assert texts["bringup/config/rover.srdf.xacro"] == SRDF.replace("left_wheel_joint", "left_tire_joint")
    assert "'right_wheel_joint'" in str(renaming.notes[0])


def test_computed_link_is_renamed_in_the_call_that_passes_its_name(make_files: Make):
    renaming, texts = make_files(ROBOT_FILES).rename("bringup/config/rover.rviz", "        camera", "lidar_link")
    assert renaming.names == {"camera_link": "lidar_link", "camera_joint": "lidar_joint"}
    assert texts["description/urdf/rover.urdf.xacro"] == ROBOT.replace('name="camera"', 'name="lidar"')
    assert texts["bringup/config/rover.rviz"] == RVIZ.replace("camera_link", "lidar_link")
    assert texts["bringup/config/rover.yaml"] == YAML.replace("camera_link", "lidar_link")
    assert texts["bringup/config/rover.srdf.xacro"] == SRDF.replace("camera_link", "lidar_link")
    assert "description/urdf/wheel.xacro" not in texts


def test_link_rename_updates_dependent_packages(make_files: Make):
    renaming, texts = make_files(ROBOT_FILES).rename("bringup/config/rover.yaml", "base_frame_id: ", "trunk")
    assert renaming.names == {"base": "trunk"}
    assert texts["description/urdf/rover.urdf.xacro"] == ROBOT.replace("prefix)base", "prefix)trunk")
    assert '<parent link="${prefix}trunk"/>' in texts["description/urdf/wheel.xacro"]
    assert texts["bringup/config/rover.rviz"] == RVIZ.replace("base", "trunk")
    assert "0 0 0 0 0 0 trunk map" in texts["bringup/launch/static.launch.xml"]
    assert [mention.file.name for mention in renaming.unchanged] == ["wheel.xacro"]  # a default that no call uses


def test_rename_at_use_in_macro_changes_definition(make_files: Make):
    _, texts = make_files(ROBOT_FILES).rename(
        "description/urdf/wheel.xacro", '<child link="${prefix}${side}_wh', "${prefix}${side}_tire"
    )
    assert texts["description/urdf/wheel.xacro"] == WHEEL.replace('_wheel"', '_tire"')


def test_uncalled_macro_is_checked_with_generated_call(make_files: Make):
    renaming, texts = make_files(ROBOT_FILES).rename(
        "description/urdf/wheel.xacro", '<link name="${name}_sp', "${name}_extra"
    )
    assert texts == {"description/urdf/wheel.xacro": WHEEL.replace('{name}_spare"', '{name}_extra"')}
    assert any("generated calls" in str(note) for note in renaming.notes)


def test_rename_is_rejected_if_another_robot_would_lose_the_name(make_files: Make):
    other = ROBOT.replace('name="prefix" default=""', 'name="prefix" default="other_"')
    files = make_files({**ROBOT_FILES, "description/urdf/other.urdf.xacro": other})
    with pytest.raises(LinkwrightError, match=r"'other_left_wheel_joint' of 'other\.urdf\.xacro'"):
        files.rename("bringup/config/rover.yaml", '["left', "left_tire_joint")


def test_file_belongs_to_robot_named_in_same_launch_file(make_files: Make):
    launch = "ROBOT = 'rover.urdf.xacro'\nPARAMETERS = 'rover.yaml'\n"
    files = make_files(
        {
            **ROBOT_FILES,
            "description/urdf/other.urdf": '<robot name="other"><link name="camera_link"/></robot>',
            "bringup/launch/rover.launch.py": launch,
        }
    )
    renaming, texts = files.rename("bringup/config/rover.yaml", "frame_id: camera", "lidar_link")
    assert "frame_id: lidar_link" in texts["bringup/config/rover.yaml"]
    assert "description/urdf/other.urdf" not in texts
    assert "bringup/config/rover.rviz" not in texts  # the file may belong to the other robot
    assert "rover.rviz" in {mention.file.name for mention in renaming.unchanged}


def test_robot_with_missing_package_is_compared_without_its_elements(make_files: Make):
    robot = ROBOT.replace(
        "  <link", '  <xacro:include filename="$(find missing)/x.xacro"/>\n  <xacro:missing_part/>\n  <link', 1
    )
    files = make_files({**ROBOT_FILES, "description/urdf/rover.urdf.xacro": robot})
    renaming, texts = files.rename("description/urdf/wheel.xacro", 'macro name="whe', "roller")
    assert "<xacro:roller side" in texts["description/urdf/rover.urdf.xacro"]
    assert any("package 'missing' not found" in str(note) for note in renaming.notes)


def test_forwarded_macro_parameter_is_renamed_in_inner_macros(make_files: Make):
    text = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="inner" params="size:=^"><link name="l_${size}"/></xacro:macro>
  <xacro:macro name="outer" params="size"><xacro:inner/></xacro:macro>
  <xacro:outer size="3"/>
</robot>
"""
    files = make_files({"p/package.xml": "<package format='3'><name>p</name></package>", "p/r.urdf.xacro": text})
    before = str(expand(files.folder / "p/r.urdf.xacro"))
    _, texts = files.rename("p/r.urdf.xacro", 'name="outer" params="si', "width")
    assert texts["p/r.urdf.xacro"] == text.replace("size", "width")
    (files.folder / "p/r.urdf.xacro").write_text(texts["p/r.urdf.xacro"])
    assert str(expand(files.folder / "p/r.urdf.xacro")) == before


# --- launch arguments -------------------------------------------------------------------------------------------------

MAIN_PY = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument('speed', default_value='1'),
        DeclareLaunchArgument('mode', default_value='a'),
        IncludeLaunchDescription(
            PathJoinSubstitution([FindPackageShare('p'), 'launch', 'part.launch.xml']),
            launch_arguments={'speed': LaunchConfiguration('speed')}.items(),
        ),
    ])
"""
PART_XML = """<launch>
  <arg name="speed" default="2"/>
  <arg name="mode" default="b"/>
  <node pkg="p" exec="n" name="$(var mode)" args="$(var speed) speed"/>
  <include file="$(find-pkg-share p)/launch/deep.launch.yaml"><arg name="speed" value="$(var speed)"/></include>
</launch>
"""
DEEP_YAML = """launch:
- arg:
    name: "speed"
    default: "3"
- executable:
    cmd: echo $(var speed) $(var mode)
"""
LAUNCH_FILES = {
    "p/package.xml": "<package format='3'><name>p</name></package>",
    "p/launch/main.launch.py": MAIN_PY,
    "p/launch/part.launch.xml": PART_XML,
    "p/launch/deep.launch.yaml": DEEP_YAML,
}


def test_launch_argument_rename_updates_callers(make_files: Make):
    _, texts = make_files(LAUNCH_FILES).rename("p/launch/part.launch.xml", '<arg name="sp', "pace")
    assert texts == {
        "p/launch/main.launch.py": MAIN_PY.replace("{'speed'", "{'pace'"),
        "p/launch/part.launch.xml": PART_XML.replace('<arg name="speed" default', '<arg name="pace" default').replace(
            "$(var speed)", "$(var pace)"
        ),
    }


def test_inherited_launch_argument_is_renamed_in_included_files(make_files: Make):
    renaming, texts = make_files(LAUNCH_FILES).rename("p/launch/main.launch.py", "DeclareLaunchArgument('mo", "style")
    assert texts == {
        "p/launch/main.launch.py": MAIN_PY.replace("'mode'", "'style'"),
        "p/launch/part.launch.xml": PART_XML.replace("mode", "style"),
        "p/launch/deep.launch.yaml": DEEP_YAML.replace("mode", "style"),
    }
    assert renaming.unchanged == ()


def test_launch_configuration_passed_as_value_is_renamed_only_in_its_file(make_files: Make):
    _, texts = make_files(LAUNCH_FILES).rename("p/launch/main.launch.py", "LaunchConfiguration('sp", "pace")
    edited_text = MAIN_PY.replace("'speed'", "'pace'").replace("{'pace'", "{'speed'")
    assert texts == {"p/launch/main.launch.py": edited_text}


def test_launch_argument_rename_to_existing_name_is_rejected(make_files: Make):
    with pytest.raises(LinkwrightError, match="already uses 'mode'"):
        make_files(LAUNCH_FILES).rename("p/launch/part.launch.xml", '<arg name="sp', "mode")


# --- SDF --------------------------------------------------------------------------------------------------------------

MODEL = """<sdf version="1.9"><model name="cart" canonical_link="body">
  <frame name="mount" attached_to="body"/>
  <link name="body"><sensor name="s" type="imu"><gz_frame_id>body</gz_frame_id></sensor></link>
  <link name="wheel"><pose relative_to="body">0 0 0 0 0 0</pose></link>
  <joint name="axle" type="revolute"><parent>body</parent><child>wheel</child></joint>
  <model name="arm"><link name="body"/><joint name="j" type="fixed"><parent>body</parent><child>hand</child></joint>
    <link name="hand"/></model>
  <joint name="hold" type="fixed"><parent>body</parent><child>arm::body</child></joint>
  <plugin name="p" filename="p"><left_joint>axle</left_joint><topic>body</topic></plugin>
</model></sdf>
"""
WORLD = """<sdf version="1.9"><world name="w">
  <include><uri>model://cart</uri><name>one</name></include>
  <joint name="fix" type="fixed"><parent>world</parent><child>one::body</child></joint>
  <model name="box"><link name="body"/></model>
  <state world_name="w"><model name="box"><link name="body"><pose>0 0 0 0 0 0</pose></link></model></state>
</world></sdf>
"""
SDF_FILES = {
    "p/package.xml": "<package format='3'><name>p</name></package>",
    "p/models/cart/model.sdf": MODEL,
    "p/worlds/w.world": WORLD,
}


def test_sdf_link_is_renamed_in_its_scope_and_in_including_worlds(make_files: Make):
    _, texts = make_files(SDF_FILES).rename("p/models/cart/model.sdf", '  <link name="bo', "base")
    nested = MODEL.index('  <model name="arm">'), MODEL.index('  <joint name="hold"')
    inner = MODEL[slice(*nested)]
    edited_text = MODEL.replace("body", "base").replace("<topic>base", "<topic>body").replace("arm::base", "arm::body")
    edited_text = edited_text.replace(inner.replace("body", "base"), inner)
    assert texts == {
        "p/models/cart/model.sdf": edited_text,
        "p/worlds/w.world": WORLD.replace("one::body", "one::base"),
    }


def test_nested_sdf_model_and_world_state_are_renamed(make_files: Make):
    files = make_files(SDF_FILES)
    _, texts = files.rename("p/models/cart/model.sdf", '<model name="ar', "limb")
    assert texts == {"p/models/cart/model.sdf": MODEL.replace('"arm"', '"limb"').replace("arm::", "limb::")}
    _, texts = files.rename("p/worlds/w.world", '<model name="bo', "crate")
    assert texts == {"p/worlds/w.world": WORLD.replace('"box"', '"crate"')}


def test_sdf_rename_to_existing_name_is_rejected(make_files: Make):
    with pytest.raises(LinkwrightError, match="already exists"):
        make_files(SDF_FILES).rename("p/models/cart/model.sdf", '  <link name="bo', "wheel")


# --- files ------------------------------------------------------------------------------------------------------------


def test_renamed_file_is_updated_in_launch_yaml_and_build_files(make_files: Make):
    launch = (
        "import os\n"
        "from ament_index_python.packages import get_package_share_directory\n"
        "FILE = os.path.join(get_package_share_directory('rover_description'), 'urdf', 'wheel.xacro')\n"
        "NAME = 'wheel.xacro'\n"
    )
    files = make_files(
        {
            **ROBOT_FILES,
            "description/CMakeLists.txt": "install(FILES urdf/wheel.xacro DESTINATION share/x)\n",
            "bringup/launch/main.launch.py": launch,
            "bringup/config/part.yaml": "file: package://rover_description/urdf/wheel.xacro\n",
        }
    )
    folder = files.folder / "description" / "urdf"
    edits, unchanged = rename_file(files.workspace, {}, folder / "wheel.xacro", folder / "parts.xacro")
    old_texts = {edit.file.name: edit.file.read_text()[edit.start : edit.end] for edit in edits}
    assert old_texts.keys() == {"rover.urdf.xacro", "CMakeLists.txt", "main.launch.py", "part.yaml"}
    assert {edit.text.rpartition("/")[2] for edit in edits} == {"parts.xacro"}
    assert [(mention.file.name, mention.start) for mention in unchanged] == [
        ("main.launch.py", launch.index("NAME = '") + len("NAME = '"))
    ]


def test_unnamed_included_model_is_renamed_and_launch_use_is_listed(make_files: Make):
    world = WORLD.replace("<name>one</name>", "").replace("one::", "cart::")
    launch = "arguments = ['-name', 'cart']\n"
    files = make_files({**SDF_FILES, "p/worlds/w.world": world, "p/launch/a.launch.py": launch})
    renaming, texts = files.rename("p/models/cart/model.sdf", '<model name="ca', "wagon")
    assert texts == {
        "p/models/cart/model.sdf": MODEL.replace('"cart"', '"wagon"'),
        "p/worlds/w.world": world.replace("cart::", "wagon::"),
    }
    assert [mention.file.name for mention in renaming.unchanged] == ["a.launch.py"]


def test_computed_sdf_reference_is_rejected_and_its_argument_is_renamed(make_files: Make):
    text = """<sdf version="1.9" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="part" default="whe"/>
<model name="m"><link name="body"/><link name="wheel"/>
<joint name="j" type="fixed"><parent>body</parent><child>$(arg part)el</child></joint></model></sdf>
"""
    files = make_files({"p/package.xml": "<package format='3'><name>p</name></package>", "p/m.sdf.xacro": text})
    with pytest.raises(LinkwrightError, match="some references keep the old name"):
        files.rename("p/m.sdf.xacro", '<link name="whe', "tire")
    assert files.rename("p/m.sdf.xacro", '<link name="bo', "base")[1] == {"p/m.sdf.xacro": text.replace("body", "base")}
    assert files.rename("p/m.sdf.xacro", "$(arg pa", "side")[1] == {"p/m.sdf.xacro": text.replace("part", "side")}


def test_joint_interface_is_renamed_and_other_path_is_listed(make_files: Make):
    lists = "    inputs: [left_wheel_joint/velocity, pid/left_wheel_joint]\n    dof_names: [left_wheel_joint]\n"
    yaml = f"filter:\n  ros__parameters:\n{lists}"
    files = make_files({**ROBOT_FILES, "bringup/config/filter.yaml": yaml})
    renaming, texts = files.rename("bringup/config/filter.yaml", "dof_names: [left", "left_tire_joint")
    assert texts["bringup/config/filter.yaml"] == yaml.replace("left_wheel", "left_tire").replace(
        "pid/left_tire", "pid/left_wheel"
    )
    assert "filter.yaml" in {mention.file.name for mention in renaming.unchanged}
