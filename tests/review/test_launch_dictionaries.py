"""Dictionaries and flags that Python launch files pass to functions, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences

FUNCTION = """from launch.actions import IncludeLaunchDescription
from launch_ros.actions import Node


def make(config, mode="none"):
    actions = []
    if mode in read_modes():
        actions.append(Node(package="arm", executable="viewer"))
    for name, args in config.items():
{rest}
    return actions
"""
EVALUATED = (
    """        actions.append(IncludeLaunchDescription(name + ".launch.py", launch_arguments=list(args.items())))"""
)
UNKNOWN = """        values = list(args.items())
        values += [("mode", mode)]
        actions.append(IncludeLaunchDescription(name + ".launch.py", launch_arguments=values))"""
FILE = """from arm.make import make
from launch import LaunchDescription

IDS = "left right"


def generate_launch_description():
    return LaunchDescription(make({
        "slam": {"datum": "1.0", "ids": IDS},
        "nav": {"ids": IDS},
    }, mode="none"))
"""
TAGS = """        "tags": {"size": "0.2"},
"""


@pytest.fixture
def review_changes(repository, compare):
    """Review a replacement in a launch file, and return its changes."""

    def run(body: str, old: str, new: str):
        assert old in FILE
        function = FUNCTION.format(rest=body)
        repository.commit({"arm/launch/arm.launch.py": FILE, "arm/arm/make.py": function, "arm/arm/__init__.py": ""})
        repository.write({"arm/launch/arm.launch.py": FILE.replace(old, new)})
        return [text for each in compare(repository).subjects for text in sentences(each)]

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"1.0"', '"2.0"', ["include of 'slam.launch.py': datum 1.0 -> 2.0"]),
        ('        "nav"', f'{TAGS}        "nav"', ["include of 'tags.launch.py' added: size 0.2"]),
        ('"nav": {', '"nav": {"deep": "true", ', ["include of 'nav.launch.py': deep true added"]),
    ],
)
def test_loop_over_a_dictionary_is_read_for_each_item(review_changes, old, new, expected):
    assert review_changes(EVALUATED, old, new) == expected


@pytest.mark.parametrize("body", [EVALUATED, UNKNOWN])
def test_flag_that_no_action_shows_is_other_code(review_changes, body):
    (change,) = review_changes(body, 'mode="none"', 'mode="debug"')
    assert change.startswith("other code: ")
    assert "debug" in change


@pytest.mark.parametrize(
    ("old", "new", "value"),
    [('"1.0"', '"2.0"', "'2.0'"), ('{"ids": IDS},', '{"ids": IDS, "size": "3"},', "'size': '3'")],
)
def test_item_that_no_action_shows_is_other_code(review_changes, old, new, value):
    (change,) = review_changes(UNKNOWN, old, new)
    assert change.startswith("other code: ")
    assert value in change


CAMERAS = """from launch import LaunchDescription
from launch_ros.actions import Node

CAMERAS = {"left": {"serial": "11"}, "right": {"serial": "22"}}
SHARED = {"rate": 10}
TOOL = {"size": 1}


def make_parameters():
    values = {"cameras": list(CAMERAS)}
    for camera, settings in CAMERAS.items():
        values.update({camera + "." + key: value for key, value in SHARED.items()})
        values[camera + ".serial"] = settings["serial"]
    values["kind"] = "stereo"
    values["mode"] = "fast"
    return values


def generate_launch_description():
    tool = Node(package="arm", executable="tool", parameters=[TOOL])
    return LaunchDescription([tool, Node(package="arm", executable="cameras", parameters=[make_parameters()])])
"""


def test_values_that_other_statements_read_are_told_beside_changed_statements(repository, compare):
    new = CAMERAS.replace('"11"', '"12"').replace('"rate": 10', '"rate": 15').replace('"size": 1', '"size": 2')
    new = new.replace('    values["kind"] = "stereo"\n    values["mode"] = "fast"\n', "")
    repository.commit({"arm/launch/arm.launch.py": CAMERAS})
    repository.write({"arm/launch/arm.launch.py": new})
    found = [text for each in compare(repository).subjects for text in sentences(each)]
    right = "'right': {'serial': '22'}}"
    assert found == [
        "node 'arm/tool': parameter size 1 -> 2",
        f"values of 'CAMERAS': {{'left': {{'serial': '11'}}, {right} -> {{'left': {{'serial': '12'}}, {right}",
        "values of 'SHARED': {'rate': 10} -> {'rate': 15}",
        "other code changed, such as `values['kind'] = 'stereo'` removed, `values['mode'] = 'fast'` removed",
    ]
