"""`linkwright check` of folders with packages: problems reported once, skipped, or as infos."""

from __future__ import annotations

import pytest

from linkwright.cli import main
from tests.sdf.worlds import write_files

VALID_ROBOT = '<robot name="r">\n  <link name="base_link"/>\n</robot>\n'
XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LONG_AXIS = """<robot name="r">
  <link name="base_link"/>
  <link name="arm_link"/>
  <joint name="arm_joint" type="continuous">
    <parent link="base_link"/>
    <child link="arm_link"/>
    <axis xyz="0 0 2"/>
  </joint>
</robot>
"""
SELECTION = ["--select", "LW2"]


@pytest.fixture(autouse=True)
def working_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("parent", "is_reported"), [("lb", False), ("lost", True)])
def test_unused_part_of_robot_is_not_reported_as_broken(working_directory, capsys, parent, is_reported):
    joint = '<joint name="{0}" type="fixed"><parent link="base_link"/><child link="l{0}"/></joint>'
    chain = LONG_AXIS.replace("</robot>", "") + "".join(f'<link name="l{name}"/>{joint.format(name)}' for name in "bc")
    camera = f'<joint name="camera" type="fixed"><parent link="{parent}"/><child link="camera"/></joint>'
    red = '<visual><geometry><box size="1 1 1"/></geometry><material name="red"/></visual>'
    write_files(
        working_directory,
        {
            "package.xml": "<package><name>p</name></package>",
            "r.urdf.xacro": chain.replace("<robot", f"<robot {XACRO}") + "</robot>",
            "camera.xacro": f'<robot name="r" {XACRO}><link name="camera">{red}</link>{camera}</robot>',
        },
    )
    main(["check", ".", "--format", "concise"])
    output = capsys.readouterr().out
    assert ("URDF150" in output, "URDF160" in output) == (is_reported, is_reported)


@pytest.mark.parametrize(("folder", "is_reported"), [("launch", True), ("launch/past", False), ("launch/old", False)])
def test_backup_launch_files_report_no_warnings_in_folder_check(working_directory, capsys, folder, is_reported):
    text = """from launch_ros.actions import Node
from ament_index_python.packages import get_package_share_directory
import os
def generate_launch_description():
    return LaunchDescription([Node(package="p", parameters=[
        os.path.join(get_package_share_directory("p"), "config", "lost.yaml")])])
"""
    write_files(
        working_directory, {"p/package.xml": "<package><name>p</name></package>", f"p/{folder}/a.launch.py": text}
    )
    main(["check", ".", "--format", "concise"])
    assert ("LW842" in capsys.readouterr().out) is is_reported


@pytest.mark.parametrize(("folder", "count"), [("urdf", 1), ("vendor", 0)])
def test_missing_package_of_vendor_copy_is_not_reported_in_folder(working_directory, capsys, folder, count):
    include = '<xacro:include filename="$(find far_description)/arm.xacro"/>'
    write_files(
        working_directory, {f"{folder}/r.urdf.xacro": f'<robot name="r" {XACRO}>{include}<link name="a"/></robot>'}
    )
    main(["check", ".", "--format", "concise"])
    assert capsys.readouterr().out.count("PKG101") == count


def test_missing_package_of_include_is_not_repeated_for_meshes(working_directory, capsys):
    mesh = '<visual><geometry><mesh filename="package://{}/a.stl"/></geometry></visual>'
    links = "".join(f'<link name="{name}">{mesh.format(name)}</link>' for name in ("far_description", "other"))
    include = '<xacro:include filename="$(find far_description)/arm.xacro"/>'
    write_files(working_directory, {"r.urdf.xacro": f'<robot name="r" {XACRO}>{include}{links}</robot>'})
    main(["check", ".", "--format", "concise"])
    output = [line for line in capsys.readouterr().out.splitlines() if "PKG101" in line or "LW423" in line]
    assert [("far_description" in line, "PKG101" in line) for line in output] == [(True, True), (False, False)]


def test_findings_of_xacro_are_not_repeated_for_generated_urdf(working_directory, capsys):
    joint = LONG_AXIS.partition("<joint")[2]
    chain = LONG_AXIS.replace('"arm_joint"', '"a"') + "".join(
        f'<link name="l{name}"/><joint{joint}'.replace("arm_joint", name).replace("arm_link", f"l{name}")
        for name in ("b", "c")
    )
    chain = chain.replace("</robot>", "") + "</robot>"
    drifted = chain.replace("0 0 2", "0 0 3", 1)
    write_files(
        working_directory,
        {
            "package.xml": "<package><name>p</name></package>",
            "xacro/r.urdf.xacro": chain.replace("<robot", f"<robot {XACRO}"),
            "urdf/r.urdf": drifted,
            "urdf/other.urdf": chain.replace('"c"', '"d"'),
        },
    )
    main(["check", ".", "--format", "concise", *SELECTION])
    places = [line.partition(":")[0] for line in capsys.readouterr().out.splitlines() if "LW221" in line]
    assert sorted(places) == ["urdf/other.urdf"] * 3 + ["urdf/r.urdf"] + ["xacro/r.urdf.xacro"] * 3


@pytest.mark.parametrize(("source", "is_reported"), [("r.urdf.xacro", False), ("other.urdf.xacro", True)])
def test_warnings_in_urdf_generated_from_checked_xacro_are_skipped(working_directory, capsys, source, is_reported):
    header = "<!-- |    This document was autogenerated by xacro from /home/me/ws/r.urdf.xacro      | -->\n"
    write_files(working_directory, {"p/r.urdf": header + LONG_AXIS, f"p/{source}": VALID_ROBOT})
    main(["check", *SELECTION, "p"])
    assert ("LW221" in capsys.readouterr().err) is is_reported
    main(["check", *SELECTION, "p/r.urdf"])
    assert "LW221" in capsys.readouterr().err


INCLUDE = '<xacro:include filename="$(find arm)/urdf/part.xacro"/>'


@pytest.mark.parametrize("user", ["arm", "robot"])
def test_package_sources_take_precedence_over_installed_copies(working_directory, capsys, user):
    manifest = '<package format="3"><name>{}</name><version>1.0.0</version></package>'
    share = "ws/install/arm/share/arm"
    write_files(
        working_directory,
        {
            "ws/install/arm/share/ament_index/resource_index/packages/arm": "",
            "ws/install/.colcon_install_layout": "isolated\n",
            f"{share}/package.xml": manifest.format("arm"),
            f"{share}/urdf/part.xacro": LONG_AXIS,
            "ws/src/arm/package.xml": manifest.format("arm"),
            "ws/src/arm/urdf/part.xacro": LONG_AXIS.replace("0 0 2", "0 0 1"),
            f"ws/src/{user}/package.xml": manifest.format(user),
            f"ws/src/{user}/urdf/r.urdf.xacro": f'<robot {XACRO} name="r">{INCLUDE}</robot>',
        },
    )
    assert main(["check", *SELECTION, "--strict", f"ws/src/{user}/urdf/r.urdf.xacro"]) == 0, capsys.readouterr().out


def test_unset_environment_variable_is_info_in_folder_check(working_directory, capsys):
    write_files(
        working_directory,
        {"p/r.urdf.xacro": f'<robot {XACRO} name="$(env KIND_OF_ROBOT)"><link name="base_link"/></robot>'},
    )
    assert main(["check", "p"]) == 0
    assert "info[XAC214]" in capsys.readouterr().err
    assert main(["check", "p/r.urdf.xacro"]) == 1


@pytest.mark.parametrize(
    ("inside", "is_reported"),
    [
        ('<material name="red"/>', False),
        ("<gazebo/><transmission/>", False),
        ('<xacro:macro name="m" params="n"><link name="${n}"/></xacro:macro>', False),
        ('<limit lower="0"/>', True),
    ],
)
def test_urdf_without_links_is_a_part_in_folder_check(working_directory, capsys, inside, is_reported):
    (working_directory / "p").mkdir()
    (working_directory / "p" / "part.urdf").write_text(
        f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}</robot>'
    )
    (working_directory / "p" / "whole.urdf").write_text('<robot name="r"><link name="base_link"/></robot>')
    main(["check", "--format", "concise", "p"])
    assert ("URDF106" in capsys.readouterr().out) is is_reported
    main(["check", "--format", "concise", "p/part.urdf"])
    output = capsys.readouterr().out
    assert "URDF106" in output or "LINT302" in output


@pytest.mark.parametrize(
    ("name", "text", "is_reported"),
    [
        ("r.urdf", '<link name="a"/>', False),
        ("r.urdf", "<geometry><box/></geometry>", False),
        ("r.urdf", '<ros2_control name="r"/>', False),
        ("r.urdf", '<model name="a"/>', True),
        ("r.urdf", '<!-- | This document was autogenerated by xacro from r.xacro | --><robot name="r"/>', False),
        ("r.sdf", "\n", False),
        ("r.world", "", False),
        ("r.urdf", "<?xml version='1.0'?>\n<!-- <robot/> -->\n<!-- later -->\n", False),
        ("r.urdf", "<!-- <robot/> --> robot", True),
    ],
)
def test_fragments_and_unfinished_files_are_skipped_in_folder(working_directory, capsys, name, text, is_reported):
    write_files(working_directory, {f"p/{name}": text, "p/whole.urdf": VALID_ROBOT})
    assert main(["check", "p"]) == int(is_reported)
    assert (name in capsys.readouterr().err) is is_reported
    assert main(["check", f"p/{name}"]) == 1


def test_packages_are_searched_in_checked_folder(working_directory, capsys, monkeypatch):
    manifest = '<package format="3"><name>{}</name></package>'
    robot_text = f'<robot name="r" {XACRO}><xacro:include filename="$(find yonder)/part.xacro"/></robot>'
    files = {"a/b/here_by/package.xml": manifest.format("here_by"), "a/b/here_by/urdf/r.urdf.xacro": robot_text}
    files |= {"c/yonder/package.xml": manifest.format("yonder"), "c/yonder/part.xacro": VALID_ROBOT}
    write_files(working_directory / "ws", files)
    (working_directory / "elsewhere").mkdir()
    monkeypatch.chdir(working_directory / "elsewhere")
    main(["check", "../ws", "--select", "PKG,XAC,XML,URDF"])
    assert "PKG101" not in capsys.readouterr().err


def test_webots_plugin_file_is_not_a_robot(working_directory, capsys):
    (working_directory / "p").mkdir()
    (working_directory / "p" / "driver.urdf").write_text(
        '<robot name="r"><webots><plugin type="p.Driver"/></webots></robot>'
    )
    (working_directory / "p" / "robot.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    assert main(["check", "p"]) == 0
    assert "driver.urdf" not in capsys.readouterr().out


def test_same_problem_in_several_files_is_reported_once(working_directory, capsys, monkeypatch):
    """A problem of several files is reported once.

    The problems are a package that two files need, and a mistake of a model that its world repeats.
    """
    (working_directory / "p" / "models" / "box").mkdir(parents=True)
    box = '<model name="box"><link name="l"><pose>0 0 0 0 0</pose></link></model>'
    (working_directory / "p" / "models" / "box" / "model.sdf").write_text(f'<sdf version="1.6">{box}</sdf>')
    world = '<world name="w"><include><uri>model://box</uri></include></world>'
    (working_directory / "p" / "w.world").write_text(f'<sdf version="1.6">{world}</sdf>')
    (working_directory / "p" / "package.xml").write_text(
        "<package format='3'><name>p</name><depend>q</depend></package>"
    )
    xacro = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    for name in ("one", "two"):
        inside = '<xacro:include filename="$(find q)/q.xacro"/><link name="base"/>'
        (working_directory / "p" / f"{name}.urdf.xacro").write_text(f'<robot name="r" {xacro}>{inside}</robot>')
    monkeypatch.chdir(working_directory / "p")
    main(["check", "--format", "concise", "."])
    lines = capsys.readouterr().out.splitlines()
    assert sum("SDF121" in line for line in lines) == 1
    assert sum("PKG101" in line for line in lines) == 1


def test_fuel_models_are_reported_only_for_explicit_world(working_directory, capsys):
    (working_directory / "p").mkdir()
    place = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Table"
    include = f"<include><uri>{place}</uri></include>"
    (working_directory / "p" / "w.world").write_text(f'<sdf version="1.6"><world name="w">{include}</world></sdf>')
    main(["check", "--format", "concise", "p"])
    assert "SDF160" not in capsys.readouterr().out
    main(["check", "--format", "concise", "p/w.world"])
    assert "info[SDF160]" in capsys.readouterr().out
