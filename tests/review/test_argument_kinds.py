"""Arguments of launch files that were true or false and now choose between texts, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"lamp/package.xml": PACKAGE_XML.replace("arm_description", "lamp")}
FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node

def generate_launch_description():
    eye = LaunchConfiguration("eye"{default})
    return LaunchDescription([
        {argument}
        Node(package="lamp", executable="lamp", condition={condition}),
    ])
"""
DECLARED = 'DeclareLaunchArgument("eye", default_value="{}"),'
SWITCH = "IfCondition(eye)"
COMPARED = """IfCondition(PythonExpression(['"', eye, '" == "{}"']))"""
CHANGED = "argument 'eye' chooses between 'front' now, not between true and false"


def make_file(condition: str, default: str = "", argument: str = "") -> str:
    return FILE.format(condition=condition, default=default and f', default="{default}"', argument=argument)


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        (make_file(COMPARED.format("front"), "none"), [CHANGED]),
        (make_file(COMPARED.format("true"), "false"), []),
        (make_file(SWITCH, "true"), []),
    ],
)
def test_an_argument_without_declaration_that_chooses_between_texts_now(repository, compare, new, expected):
    path = "lamp/launch/lamp.launch.py"
    repository.commit({**MANIFEST, path: make_file(SWITCH, "false")})
    repository.write({path: new})
    assert breaking(compare(repository)) == expected


def test_a_declared_default_that_is_no_boolean_any_more_is_told_once(repository, compare):
    path = "lamp/launch/lamp.launch.py"
    repository.commit({**MANIFEST, path: make_file(SWITCH, argument=DECLARED.format("false"))})
    repository.write({path: make_file(COMPARED.format("front"), argument=DECLARED.format("none"))})
    assert breaking(compare(repository)) == ["argument 'eye': default false -> none"]


@pytest.mark.parametrize("use", ["arg('eye') == 'front'", "eye == 'front' and eye"])
def test_an_argument_of_ros1_that_chooses_between_texts_now(repository, compare, use):
    path = "lamp/launch/lamp.launch"
    text = '<launch><arg name="eye"/><node pkg="lamp" type="lamp" name="lamp" if="{}"/></launch>\n'
    repository.commit({**MANIFEST, path: text.format("$(arg eye)")})
    repository.write({path: text.format(f"$(eval {use})")})
    assert (CHANGED in breaking(compare(repository))) is ("arg(" in use)
