"""Unions of dictionaries, and keyword arguments in any order, in Python launch files, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences

FILE = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription, SetEnvironmentVariable
from launch_ros.actions import Node, SetParameter, SetRemap

inverts = False
{names}

def generate_launch_description():
    return LaunchDescription([
        {remap},
        IncludeLaunchDescription("wheels.launch.py", launch_arguments={arguments}.items()),
    ])
"""
ARGUMENTS = '{"port": "1", "prefix": ""}'
REMAP = 'SetRemap(src="cmd_vel", dst="wheels/cmd_vel")'


@pytest.fixture
def review_include(repository, compare):
    """Review other arguments of an include and another action, and return the changes."""

    def run(arguments: str = ARGUMENTS, remap: str = REMAP, names: str = ""):
        path = "arm/launch/arm.launch.py"
        repository.commit({path: FILE.format(arguments=ARGUMENTS, remap=REMAP, names="")})
        repository.write({path: FILE.format(arguments=arguments, remap=remap, names=names)})
        return [text for each in compare(repository).subjects for text in sentences(each)]

    return run


@pytest.mark.parametrize(
    ("arguments", "changes"),
    [
        ('({"port": "1"} | {"prefix": ""})', []),
        ('{**{"port": "2", "prefix": ""}, "port": "1"}', []),
        ('({"port": "1", "prefix": ""} | ({"overlay": "x"} if inverts else {}))', []),
        (
            '({"port": "1", "prefix": ""} | ({"overlay": "x"} if not_known else {}))',
            ["overlay x (if `not_known`) added"],
        ),
        ('({"port": "1", "prefix": ""} | {"port": "2"})', ["port 1 -> 2"]),
    ],
)
def test_union_of_dictionaries_passes_the_arguments_of_both(review_include, arguments, changes):
    found = [change for change in review_include(arguments) if "include" in change]
    assert len(found) == len(changes)
    assert all(text in change for change, text in zip(found, changes, strict=True)), found


def test_named_dictionary_in_another_one_passes_its_arguments(review_include):
    assert review_include('{**COMMON, "prefix": ""}', names='COMMON = {"port": "1"}') == []


@pytest.mark.parametrize(
    ("remap", "changes"),
    [
        ('SetRemap(dst="wheels/cmd_vel", src="cmd_vel")', []),
        ('SetRemap("cmd_vel", dst="wheels/cmd_vel")', []),
        (
            'SetRemap(dst="cmd_vel", src="wheels/cmd_vel")',
            [
                "remapping of 'wheels/cmd_vel' for the nodes that follow added: cmd_vel",
                "remapping of 'cmd_vel' for the nodes that follow removed: wheels/cmd_vel",
            ],
        ),
    ],
)
def test_keyword_arguments_of_a_remapping_have_any_order(review_include, remap, changes):
    assert review_include(remap=remap) == changes


@pytest.mark.parametrize(
    ("action", "change"),
    [
        ('SetParameter(value="1", name="limit")', "parameter limit of the nodes that follow added: 1"),
        ('SetEnvironmentVariable(value="1", name="LIMIT")', "environment variable LIMIT added: 1"),
    ],
)
def test_keyword_arguments_of_a_value_have_any_order(review_include, action, change):
    (found, *_) = review_include(remap=f"{REMAP}, {action}")
    assert found.replace("'", "") == change
