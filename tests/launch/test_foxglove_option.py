"""The option ``--foxglove PORT`` of the commands that launch."""

from __future__ import annotations

import pytest

from linkwright.launch import LaunchOptions
from linkwright.launch import run as launch_run
from linkwright.launch.model.description import LaunchDescription
from linkwright.launch.ros import Node
from linkwright.packages import PackageFinder


def load_launch_entities(monkeypatch, options: LaunchOptions) -> list[Node]:
    descriptions: list[LaunchDescription] = []

    async def run(description, *_, noninteractive):
        descriptions.append(description)
        return True

    monkeypatch.setattr(launch_run, "_run", run)
    load = lambda _: (LaunchDescription([]), {})  # noqa: E731 - as launch files are loaded
    assert launch_run.run_description(load, {}, PackageFinder(), options, "nothing") == 0
    return [entity for entity in descriptions[0].entities if isinstance(entity, Node)]


def test_foxglove_option_adds_bridge(monkeypatch):
    (node,) = load_launch_entities(monkeypatch, LaunchOptions(foxglove=8765))
    assert (node.node_package, node.node_executable) == ("foxglove_bridge", "foxglove_bridge")


def test_bridge_is_not_added_without_option(monkeypatch):
    assert load_launch_entities(monkeypatch, LaunchOptions()) == []


@pytest.mark.parametrize("words", [["view", "robot.urdf"], ["launch", "a.launch.py"], ["run", "package", "talker"]])
def test_launching_commands_accept_foxglove_option(words):
    from linkwright.cli.command import create_parser

    arguments = create_parser(words[0]).parse_args(["--foxglove", "9000", *words[1:]])
    assert arguments.foxglove == 9000
    with pytest.raises(SystemExit):
        create_parser(words[0]).parse_args(["--foxglove", "0", *words[1:]])
