"""Launch files that import classes under other names, in a review."""

from __future__ import annotations

import ast

from linkwright.packages.readers.python_values import replace_import_aliases
from tests.review.conftest import breaking, sentences, subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument as Arg
from launch.conditions import IfCondition as If
from launch.substitutions import LaunchConfiguration as LC
from launch_ros.actions import Node as N

def generate_launch_description():
    return LaunchDescription([
        Arg("lidar", default_value="{lidar}"),
        Arg("side", default_value="left"),
        N(package="arm", executable="scanner", name=[LC("side"), "{name}"], condition=If(LC("lidar"))),
    ])
"""
PATH = "arm/launch/arm.launch.py"


def test_classes_with_other_names_are_compared_as_under_their_own(repository, compare):
    old, new = LAUNCH.format(lidar="true", name="_scan"), LAUNCH.format(lidar="false", name="_laser")
    for short, name in (("Arg", "DeclareLaunchArgument"), ("If", "IfCondition"), ("LC", "LaunchConfiguration")):
        plain = new.replace(f" as {short}\n", "\n").replace(f"{short}(", f"{name}(")
        repository.commit({PATH: old})
        repository.write({PATH: new})
        report = sentences(subject(compare(repository), PATH))
        assert "argument 'lidar': default true -> false" in report
        assert any("_laser" in line for line in report)
        assert breaking(compare(repository))
        repository.commit({PATH: old})
        repository.write({PATH: plain})
        assert sentences(subject(compare(repository), PATH)) == report


def test_an_alias_whose_own_name_the_file_uses_for_something_else_stays():
    text = "from launch_ros.actions import Node as N\nfrom launch.actions import LogInfo as L\n{}\nN(); L()\n"
    for definition in ("class Node: pass", "Node = 1", "from arm import Node", "def run(Node): pass", "N = 1"):
        tree = ast.parse(text.format(definition))
        replace_import_aliases(tree)
        assert ast.unparse(tree).splitlines()[-2:] == ["N()", "LogInfo()"]
