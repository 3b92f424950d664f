"""The lines of a review about files that a Python launch file finds in its own folder."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

INCLUDED = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("real", default_value="true"),
        Node(package="arm", executable="driver", condition=IfCondition(LaunchConfiguration("real"))),
    ])
"""
LAUNCH = """import os
from pathlib import Path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node

FOLDER = os.path.dirname(os.path.realpath(__file__))


def generate_launch_description():
    return LaunchDescription([
        IncludeLaunchDescription(PythonLaunchDescriptionSource(FILE), launch_arguments={"real": "true"}.items()),
    ])
"""
PATHS = (
    'os.path.join(FOLDER, "driver.launch.py")',
    'os.path.join(os.path.dirname(os.path.abspath(__file__)), "driver.launch.py")',
    'os.path.dirname(__file__) + "/driver.launch.py"',
    'str(Path(__file__).parent / "driver.launch.py")',
    'Path(__file__).resolve().parent.joinpath("driver.launch.py").as_posix()',
)
PATH = "arm/launch/arm.launch.py"
FILES = {"arm/launch/driver.launch.py": INCLUDED}


@pytest.mark.parametrize("path", PATHS)
def test_files_in_the_folder_of_the_launch_file_are_read(repository, compare, path):
    text = LAUNCH.replace("FILE", path)
    repository.commit({**FILES, PATH: text})
    repository.write({PATH: text.replace('"real": "true"', '"real": "false"')})
    assert breaking(compare(repository)) == ["include of '$(dirname)/driver.launch.py': real true -> false"]


def test_another_form_of_the_same_path_is_no_change_of_an_action(repository, compare):
    repository.commit({**FILES, PATH: LAUNCH.replace("FILE", PATHS[1])})
    repository.write({PATH: LAUNCH.replace("FILE", PATHS[3])})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert not any("include" in line for line in lines)


def test_the_folder_of_a_module_is_not_the_folder_of_the_launch_file(repository, compare):
    module = "import os\n\n\ndef find(name):\n    return os.path.join(os.path.dirname(__file__), name)\n"
    text = LAUNCH.replace("from pathlib", "from arm.files import find\nfrom pathlib")
    repository.commit({**FILES, "arm/arm/files.py": module})
    repository.write({PATH: text.replace("FILE", 'find("driver.launch.py")')})
    (line,) = sentences(subject(compare(repository), PATH))
    assert "dirname(__file__)" in line
