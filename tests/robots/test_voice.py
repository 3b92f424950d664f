"""Voice commands for mbot in the playground.

They use the commands and the launch file of my_robot_voice.
"""

from __future__ import annotations

import math
import os
import subprocess
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.speech.commands.command_file import DEFAULT_FILE, read_command_file
from linkwright.speech.nodes.voice_commander import VoiceCommander
from linkwright.testing import AsyncSteppedSimulation
from tests.places import GAZEBO_PACKAGE, VOICE_PACKAGE
from tests.robots.workspaces import colcon_build, read_sourced_variable
from tests.waiting import TIMEOUT_S

COMMANDS = VOICE_PACKAGE / "config" / "commands.yaml"
WORLD = GAZEBO_PACKAGE / "worlds" / "playground.world"
ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"
STRING = get_message("std_msgs/msg/String")


def test_commands_are_built_in_commands_with_rooms():
    built_in, robot_commands = read_command_file(DEFAULT_FILE), read_command_file(COMMANDS)
    assert robot_commands.commands == built_in.commands
    assert set(robot_commands.places) - set(built_in.places) == {"kitchen", "bedroom", "study"}
    match = robot_commands.match_command("go to the kitchen")
    assert match is not None
    assert match.values == {"place": "kitchen"}
    assert "去厨房" in robot_commands.phrases("zh")


@pytest.mark.parametrize("name", ["audio_capture", "voice_commander"])
def test_entry_points_run_nodes_of_same_name(name):
    assert f"'{name} = my_robot_voice.{name}:main'" in (VOICE_PACKAGE / "setup.py").read_text()
    program = (VOICE_PACKAGE / "my_robot_voice" / f"{name}.py").read_text()
    assert f"run('my_robot_voice', '{name}', sys.argv[1:])" in program


def test_launch_file_declares_arguments(capsys):
    assert main(["launch", "my_robot_voice", "voice.launch.py", "--show-args"]) == 0
    output = capsys.readouterr().out
    for argument in ("engine", "language", "words_file", "commands_file", "open_listening", "wav", "navigation"):
        assert f"'{argument}':\n" in output


async def test_spoken_commands_drive_robot_through_playground():
    pytest.importorskip("mujoco")
    async with AsyncSteppedSimulation(WORLD, ROBOT, period=0.02) as playground:
        parameters = {"engine": "", "commands_file": str(COMMANDS), "use_sim_time": True}
        running = VoiceCommander(playground.graph, NodeOptions(parameters=parameters))
        text = playground.node.create_publisher(STRING, "/voice/text_input", 10)

        async def tell(command, seconds):
            text.publish(STRING(data=command))
            await playground.advance(seconds)
            x, y, _, _, _, z, w = playground.robot_pose()
            return x, y, 2.0 * math.atan2(z, w)

        await playground.advance(1.0)
        assert (await tell("前进一米", 8.0))[:2] == pytest.approx((1.0, 0.0), abs=0.02)
        assert (await tell("turn left ninety degrees", 5.0))[2] == pytest.approx(math.pi / 2, abs=0.03)
        assert (await tell("forward", 2.0))[1] > 0.2
        x, y, _ = await tell("停", 1.0)
        assert (await tell("加速", 2.0))[:2] == pytest.approx((x, y), abs=0.01)
        assert (await tell("后退半米", 5.0))[1] == pytest.approx(y - 0.5, abs=0.03)
        running.close()


def test_package_has_no_findings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--strict", str(VOICE_PACKAGE)]) == 0, capsys.readouterr().out


@pytest.mark.slow
def test_colcon_installs_package_and_program_runs(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / VOICE_PACKAGE.name).symlink_to(VOICE_PACKAGE)
    colcon_build(tmp_path, VOICE_PACKAGE.name)
    installed = tmp_path / "install" / VOICE_PACKAGE.name
    for file in ("launch/voice.launch.py", "config/commands.yaml"):
        assert (installed / "share" / VOICE_PACKAGE.name / file).is_file()
    programs = installed / "lib" / VOICE_PACKAGE.name
    assert (programs / "audio_capture").is_file()
    ran = subprocess.run(
        [programs / "voice_commander", "--ros-args", "-p", "commands_file:=gone.yaml"],
        env={**os.environ, "PYTHONPATH": read_sourced_variable(tmp_path, "PYTHONPATH"), "LINKWRIGHT_DDS": "0"},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert ran.returncode == 1
    assert "gone.yaml" in ran.stderr
    assert "Traceback" not in ran.stderr
