"""The chapter about navigation; its program is tested in tests/standins/test_simple_commander.py."""

from __future__ import annotations

from linkwright.cli import main
from tests.docs.pages import DOCS, blocks, commands

LANGUAGES = {"en": DOCS / "tutorial-navigation.md", "zh": DOCS / "zh" / "tutorial-navigation.md"}


def test_both_languages_have_the_same_commands_and_programs():
    english, chinese = LANGUAGES.values()
    assert commands(english) == commands(chinese)
    assert [block.text for block in blocks(english)] == [block.text for block in blocks(chinese)]


def test_the_launch_file_has_the_arguments_that_the_page_uses(capsys):
    assert main(["launch", "my_robot_navigation", "navigation.launch.py", "--show-args"]) == 0
    said = capsys.readouterr().out
    for argument in ("slam", "map", "nav2_params_file"):
        assert f"'{argument}'" in said
