"""The chapter about navigation.

Its program is tested in tests/standins/test_simple_commander.py.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.cli import main
from tests.docs.pages import DOCS, read_commands
from tests.docs.reader import Outcome

LANGUAGES = {"en": DOCS / "tutorial-navigation.md", "zh": DOCS / "zh" / "tutorial-navigation.md"}


def test_launch_file_has_arguments_of_page(capsys):
    assert main(["launch", "my_robot_navigation", "navigation.launch.py", "--show-args"]) == 0
    output = capsys.readouterr().out
    for argument in ("slam", "map", "nav2_params_file"):
        assert f"'{argument}'" in output


@pytest.mark.slow
def test_tutorial_commands_run_with_installed_wheel(follow: Callable[..., Path]) -> None:
    bedroom_goal, wall_goal = (line for line in read_commands(LANGUAGES["en"]) if "send_goal" in line)
    home = follow(
        LANGUAGES["en"],
        {
            "linkwright launch my_robot_navigation navigation.launch.py": Outcome(error="the goal (-0.90, 2.40)"),
            bedroom_goal: Outcome(output_text="distance_remaining"),
            wall_goal: Outcome(output_text="ABORTED", runs_on=False),
            # As in ROS, Ctrl-C ends it with a traceback if it does not wait for the action at that time.
            "linkwright shell -- python patrol.py": Outcome(output_text="m to the bedroom", may_fail=True),
            "linkwright run teleop_twist_keyboard teleop_twist_keyboard": Outcome(output_text="stop"),
        },
    )
    assert (home / "my_house.pgm").stat().st_size > 1000
