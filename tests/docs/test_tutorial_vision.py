"""The chapter about vision; its nodes are tested in tests/vision/nodes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from linkwright import standins
from linkwright.cli import main
from linkwright.nodes import EXECUTABLES
from tests.docs.pages import DOCS, read_blocks
from tests.docs.reader import Outcome
from tests.vision.nodes.seeking_robot import SeekingRobot

LANGUAGES = {"en": DOCS / "tutorial-vision.md", "zh": DOCS / "zh" / "tutorial-vision.md"}


def test_launch_files_have_arguments_of_page(capsys: pytest.CaptureFixture[str]):
    assert main(["launch", "my_robot_vision", "detect.launch.py", "--show-args"]) == 0
    output = capsys.readouterr().out
    for argument in ("depth", "voice", "language", "model", "threshold"):
        assert f"'{argument}'" in output
    assert main(["launch", "my_robot_vision", "follow_object.launch.py", "--show-args"]) == 0
    assert "'thing'" in capsys.readouterr().out


@pytest.mark.parametrize("page", LANGUAGES.values(), ids=LANGUAGES)
def test_nodes_of_page_exist(page: Path):
    text = page.read_text(encoding="utf-8")
    for name in ("detector", "tracking_node", "detect_3d_node", "object_seeker"):
        assert f"| `{name}` |" in text
        assert ("my_robot_vision", name) in EXECUTABLES


def test_program_of_page_drives_to_red_object(tmp_path: Path):
    pytest.importorskip("mujoco")
    standins.activate()
    (program,) = [block for block in read_blocks(LANGUAGES["en"]) if block.title == "follow_color.py"]
    names: dict[str, Any] = {"__name__": "follow_color"}
    exec(compile(program.text, "follow_color.py", "exec"), names)
    with SeekingRobot(tmp_path, (2.0, 0.6), object_name="red") as test:
        test.init_rclpy()
        names["FollowColor"]()
        test.advance(20.0)
        assert test.distance() < 1.2
        assert abs(test.commands.last.angular.z) < 0.2, "the object is in the center of the image"


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path]) -> None:
    follow(
        LANGUAGES["en"],
        {
            "linkwright topic hz /yolo/detections": Outcome(output_text="average rate"),
            "linkwright shell -- python follow_color.py": Outcome(node="/follow_color"),
            "linkwright launch my_robot_vision follow_object.launch.py model:=colors thing:=red": Outcome(
                node="/follow_object"
            ),
        },
    )
