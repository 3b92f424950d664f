"""``linkwright arm``."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from tests.planning.arms import urdf

pytestmark = pytest.mark.extra("arm")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    source = tmp_path / "elbow_description"
    (source / "urdf").mkdir(parents=True)
    (source / "package.xml").write_text(
        "<package format='3'><name>elbow_description</name><version>1.0.0</version></package>"
    )
    (source / "urdf" / "arm.urdf").write_text(urdf())
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_init_writes_package_and_says_what_it_found(folder, capsys):
    assert main(["arm", "init", "elbow_description/urdf/arm.urdf"]) == 0
    captured = capsys.readouterr()
    assert "group arm: 6 joints from base to tool\n" in captured.out
    assert "end effector gripper: joints left, right, attached to tool\n" in captured.out
    assert "8 Adjacent" in captured.out
    assert "`linkwright launch elbow_arm_moveit_config demo.launch.py`" in captured.err
    package = folder / "elbow_arm_moveit_config"
    assert "$(find elbow_description)/urdf/arm.urdf" in (package / "config/elbow_arm.urdf.xacro").read_text()
    assert {path.name for path in (package / "launch").iterdir()} >= {"demo.launch.py", "move_group.launch.py"}
    assert main(["check", str(package / "config/elbow_arm.urdf.xacro")]) == 0


def test_init_keeps_an_existing_package(folder, capsys):
    package = folder / "out" / "my_config"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("mine")
    words = ["arm", "init", "elbow_description/urdf/arm.urdf", "--package", "my_config", "--output", "out"]
    assert main(words) == 1
    assert "CLI206" in capsys.readouterr().err
    assert [path.name for path in package.iterdir()] == ["package.xml"]
    (package / "notes.txt").write_text("kept")
    assert main([*words, "--force"]) == 0
    assert "<name>my_config</name>" in (package / "package.xml").read_text()
    assert (package / "notes.txt").read_text() == "kept"


def test_init_tells_what_gazebo_needs(folder, capsys):
    source = folder / "elbow_description" / "urdf" / "arm.urdf.xacro"
    hardware = "<ros2_control name='own' type='system'><hardware><plugin>$(arg plugin)</plugin></hardware>"
    text = urdf().replace("<robot ", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro' ")
    arguments = "<xacro:arg name='plugin' default='maker/Robot'/>"
    joint = "<joint name='pan'><command_interface name='position'/></joint></ros2_control></robot>"
    source.write_text(text.replace("</robot>", arguments + hardware + joint))
    assert main(["arm", "init", str(source)]) == 0
    out = capsys.readouterr().out
    assert "hardware maker/Robot of the description is not simulated; --gazebo NAME:=VALUE gives" in out
    assert "links without a mass are left out: shoulder, upper_arm," in out
    words = ["--gazebo", "plugin:=gz_ros2_control/GazeboSimSystem"]
    assert main(["arm", "init", str(source), "--force", *words]) == 0
    assert "maker/Robot" not in capsys.readouterr().out
    written = str(folder / "elbow_arm_moveit_config" / "config" / "elbow_arm.urdf.xacro")
    for value, plugin in (("mock_components", "maker/Robot"), ("gazebo", "gz_ros2_control/GazeboSimSystem")):
        assert main(["xacro", written, f"ros2_control_hardware_type:={value}"]) == 0
        assert f"<plugin>{plugin}</plugin>" in capsys.readouterr().out


def test_init_refuses_arguments_for_the_copy_of_a_description(folder, capsys):
    (folder / "arm.urdf").write_text(urdf())
    assert main(["arm", "init", "arm.urdf", "--gazebo", "a:=b"]) == 1
    assert "ARM108" in capsys.readouterr().err


def test_init_refuses_the_name_of_another_package_of_the_workspace(folder, capsys):
    other = folder / "src" / "taken"
    other.mkdir(parents=True)
    (other / "package.xml").write_text("<package format='3'><name>taken</name><version>1.0.0</version></package>")
    words = ["arm", "init", "elbow_description/urdf/arm.urdf", "--package", "taken"]
    assert main(words) == 1
    assert str(other) in capsys.readouterr().err
    assert main([*words, "--force"]) == 0


def test_init_takes_groups_of_the_user(folder, capsys):
    words = ["--group", "short=base:forearm", "--group", "rest=bend,twist", "--end-effector", "gripper=flange"]
    assert main(["arm", "init", "elbow_description/urdf/arm.urdf", *words, "--distro", "humble"]) == 0
    out = capsys.readouterr().out
    assert "group short: 3 joints from base to forearm\n" in out
    assert "group rest: joints bend, twist\n" in out
    assert "joints without a group: roll\n" in out
    assert "attached to flange\n" in out


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--group", "arm"], "CLI313"),
        (["--tip", "arm="], "CLI313"),
        (["--tip", "arm=nowhere"], "ARM106"),
        (["--package", "Bad Name"], "PKG201"),
    ],
)
def test_init_refuses_wrong_words(folder, capsys, words, code):
    assert main(["arm", "init", "elbow_description/urdf/arm.urdf", *words]) == 1
    assert code in capsys.readouterr().err
    assert sorted(path.name for path in folder.iterdir()) == ["elbow_description"]


def test_init_refuses_description_with_errors(folder, capsys):
    (folder / "bad.urdf").write_text("<robot name='r'><link name='a'/><link name='b'/></robot>")
    assert main(["arm", "init", "bad.urdf"]) == 1
    assert "URDF" in capsys.readouterr().err


def test_arm_is_listed_with_its_options():
    from linkwright.cli.completion.candidates import TABLE_PATH

    assert "arm" in json.loads(TABLE_PATH.read_text())["verbs"]
