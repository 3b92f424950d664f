"""The command lines of Gazebo's programs, in the forms that launch files have."""

from __future__ import annotations

import shlex

import pytest

from linkwright.simulation.nodes.command_line import simulator_command

FACTORY = "-s libgazebo_ros_init.so -s libgazebo_ros_factory.so"


@pytest.mark.parametrize(
    ("line", "parameters"),
    [
        ("gzserver", {}),
        (f"gazebo --verbose {FACTORY} /w/a.world", {"world": "/w/a.world", "gui": True}),
        (f"gzserver /w/a.world {FACTORY}", {"world": "/w/a.world"}),
        (f"gzserver {FACTORY} -u --seed 7 a.world", {"world": "a.world", "pause": True, "seed": 7}),
        ("gzserver '' extra-gazebo-args --ros-args", {}),
        ("/usr/bin/gazebo -e bullet --seed=7 a.world", {"world": "a.world", "seed": 7, "gui": True}),
    ],
)
def test_classic_command_line_is_parsed(line, parameters):
    command = simulator_command(shlex.split(line))
    assert command is not None
    assert (command.package, command.executable) == ("gazebo_ros", "gzserver")
    assert command.parameters == parameters


@pytest.mark.parametrize(
    ("line", "parameters"),
    [
        ("gz sim", {"pause": True, "gui": True}),
        ("gz sim -r empty.sdf", {"pause": False, "gui": True, "world": "empty.sdf"}),
        ("gz sim -r -s -v 4 /w/a.sdf", {"pause": False, "gui": False, "world": "/w/a.sdf"}),
        ("gz sim -v4 a.sdf -r", {"pause": False, "gui": True, "world": "a.sdf"}),
        ("gz sim -v a.sdf", {"pause": True, "gui": True, "world": "a.sdf"}),
        ("gz sim -r '' a.sdf", {"pause": False, "gui": True, "world": "a.sdf"}),
        ("ign gazebo --headless-rendering -z 100 -r a.sdf", {"pause": False, "gui": True, "world": "a.sdf"}),
        ("gz sim --gui-config g.config --physics-engine p a.sdf", {"pause": True, "gui": True, "world": "a.sdf"}),
    ],
)
def test_gz_command_line_is_parsed(line, parameters):
    command = simulator_command(shlex.split(line))
    assert command is not None
    assert (command.package, command.executable) == ("ros_gz_sim", "gzserver")
    assert command.parameters == parameters


@pytest.mark.parametrize(
    ("panel", "flags", "pause"),
    [
        ('<plugin filename="WorldControl" name="c"><start_paused>false</start_paused></plugin>', "", False),
        ('<plugin filename="WorldControl" name="c"><start_paused>false</start_paused></plugin>', "-s", True),
        ('<plugin filename="WorldControl" name="c"><start_paused>true</start_paused></plugin>', "", True),
        ('<plugin filename="Other"><start_paused>false</start_paused></plugin>', "", True),
        ('<!-- <plugin filename="WorldControl"><start_paused>false</start_paused></plugin> -->', "", True),
    ],
)
def test_window_configuration_can_start_simulation(tmp_path, panel, flags, pause):
    config = tmp_path / "gui.config"
    config.write_text(f'<?xml version="1.0"?>\n<window/>\n{panel}\n<plugin filename="WorldStats"></plugin>\n')
    command = simulator_command(["gz", "sim", "--gui-config", str(config), "a.sdf", *flags.split()])
    assert command is not None
    assert command.parameters["pause"] is pause


def test_gui_only_commands_start_gzclient():
    for line in ("gzclient --verbose", "gz sim -g", "ign gazebo -g -v 4"):
        command = simulator_command(line.split())
        assert command is not None
        assert command.executable == "gzclient"


def test_ros_arguments_are_kept():
    command = simulator_command(["gzserver", "a.world", "--ros-args", "--params-file", "f.yaml"])
    assert command is not None
    assert list(command.ros_arguments) == ["--ros-args", "--params-file", "f.yaml"]
    assert command.parameters == {"world": "a.world"}


@pytest.mark.parametrize("line", ["gz topic -l", "ign service", "ros2 run a b", "gz", "python3 gzserver"])
def test_other_commands_are_not_recognized(line):
    assert simulator_command(line.split()) is None
