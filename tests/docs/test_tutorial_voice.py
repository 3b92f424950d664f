"""The chapter about voice: its utterances are understood, and custom commands move mbot."""

from __future__ import annotations

import math
import re
import wave
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.diagnostics import SourceText
from linkwright.messages import get_message
from linkwright.nodes import NodeOptions
from linkwright.speech.commands.command_file import parse_commands, read_command_file
from linkwright.speech.nodes.voice_commander import VoiceCommander
from linkwright.testing import AsyncSteppedSimulation
from tests.docs.pages import DOCS, read_blocks, read_commands
from tests.docs.reader import Outcome
from tests.places import GAZEBO_PACKAGE, VOICE_PACKAGE

LANGUAGES = {"en": DOCS / "tutorial-voice.md", "zh": DOCS / "zh" / "tutorial-voice.md"}
WORLD = GAZEBO_PACKAGE / "worlds" / "playground.world"
ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"
STRING = get_message("std_msgs/msg/String")


@pytest.mark.parametrize("language", LANGUAGES)
def test_shown_utterances_are_understood(language: str) -> None:
    page = LANGUAGES[language].read_text(encoding="utf-8")
    robot_commands = read_command_file(VOICE_PACKAGE / "config" / "commands.yaml")
    table = [cell for row in re.findall(r"^\| (`.+?) \| (.+?) \|$", page, re.MULTILINE) for cell in row]
    utterances = [text for cell in table[:8] for text in re.findall(r"`([^`]+)`", cell) or cell.split("、")]
    utterances += [
        "forward half a meter",
        "前进半米",
        "后退半米",
        "go to the kitchen",
        "去厨房",
        "go home",
        "回家",
        "stop",
        "停",
    ]
    utterances += [
        "turn right forty five degrees",
        "右转四十五度",
        "turn left",
        "左转",
        "turn right",
        "右转",
        "forward",
        "前进",
    ]
    assert len(utterances) > 22
    assert [text for text in utterances if robot_commands.match_command(text) is None] == []


def test_launch_file_has_arguments_of_page(capsys: pytest.CaptureFixture[str]) -> None:
    documented = {
        word.partition(":=")[0] for line in read_commands(LANGUAGES["en"]) for word in line.split() if ":=" in word
    }
    assert documented >= {"commands_file", "engine", "language", "navigation", "open_listening", "wav"}
    assert main(["launch", "my_robot_voice", "voice.launch.py", "--show-args"]) == 0
    output = capsys.readouterr().out
    for argument in documented:
        assert f"'{argument}':\n" in output


async def test_custom_command_file_moves_mbot(tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    (block,) = [block for block in read_blocks(LANGUAGES["en"]) if block.title == "my_commands.yaml"]
    file = tmp_path / block.title
    file.write_text(block.text, encoding="utf-8")
    async with AsyncSteppedSimulation(WORLD, ROBOT, period=0.02) as playground:
        parameters = {"engine": "", "commands_file": str(file), "use_sim_time": True}
        commander = VoiceCommander(playground.graph, NodeOptions(parameters=parameters))
        text = playground.node.create_publisher(STRING, "/voice/text_input", 10)
        responses = playground.record("/voice/response")
        turned = playground.record("/odom")

        async def tell(message: str, seconds: float) -> str:
            text.publish(STRING(data=message))
            await playground.advance(seconds)
            return str(responses.last.data)

        await playground.advance(1.0)
        assert await tell("please dance", 12.0) == "look at me"
        assert sum(abs(odometry.twist.twist.angular.z) for odometry in turned) > 0
        x, y, _, _, _, z, w = playground.robot_pose()
        assert math.hypot(x, y) < 0.1
        assert abs(2.0 * math.atan2(z, w)) < 0.1, "the robot has turned by two full turns"
        assert await tell("race one meter", 1.0) == "really?"
        assert math.hypot(*playground.robot_pose()[:2]) < 0.1
        assert await tell("yes", 8.0) == "race one meter"
        assert math.hypot(*playground.robot_pose()[:2]) == pytest.approx(1.0, abs=0.12)
        commander.close()


def test_command_file_of_voice_page_is_valid() -> None:
    (block,) = [block for block in read_blocks(DOCS / "voice.md") if block.title == "my_commands.yaml"]
    found = parse_commands(SourceText(block.title, block.text))
    assert found.match_command("please go forward seven meters") is None
    for text in (
        "go forward seven meters",
        "转圈",
        "go and recharge",
        "张开夹爪",
        "count to twelve",
        "follow the wall",
    ):
        assert found.match_command(text) is not None, text
    assert "前进七米" in found.phrases("zh")


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path], tmp_path: Path) -> None:
    with wave.open(str(tmp_path / "my_recording.wav"), "wb") as recording:  # two seconds of silence
        recording.setparams((1, 2, 16000, 0, "NONE", ""))
        recording.writeframes(bytes(2 * 2 * 16000))
    follow(
        LANGUAGES["en"],
        {
            "linkwright topic echo /voice/command": Outcome(topic="/voice/command", output_text="backward_by"),
            "linkwright topic echo /cmd_vel": Outcome(topic="/cmd_vel", output_text="linear"),
            "linkwright models get vosk-en": Outcome(runs_on=False, may_fail=True),
            "linkwright models get vosk-zh": Outcome(runs_on=False, may_fail=True),
        },
    )
