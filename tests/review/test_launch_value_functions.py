"""Values that functions of the repository return in Python launch files, and items of unknown values, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

HELPER = """import os
from pathlib import Path
from ament_index_python.packages import get_package_share_directory, get_package_share_path
from launch.launch_description_sources import PythonLaunchDescriptionSource
import yaml

FOLDER = 'config'


def config_file(package, name='arm.yaml'):
    \"\"\"Return the path of a file.\"\"\"
    share = get_package_share_path(package)
    return str(share / FOLDER / name)


def joined_file(package, name):
    return os.path.join(get_package_share_directory(package), FOLDER, name)


def share_file(package, *parts):
    folder = Path(get_package_share_directory(package))
    return str(folder.joinpath('share', *parts))


def source(package, name):
    path = get_package_share_path(package) / 'launch' / name
    return PythonLaunchDescriptionSource(path)


def common():
    return {'rate': 5, 'file': joined_file('arm', 'a.yaml')}


def load(path, overrides):
    with open(path) as stream:
        return {**yaml.safe_load(stream), **overrides}
"""
LAUNCH = """import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node
from arm.helper import common, config_file, joined_file, load, share_file, source


def generate_launch_description():
    values = load(config_file('arm'), {'a': 1})
    motor = values['motor']
    return LaunchDescription([
        ACTION
    ])
"""
PATH = "arm/launch/arm.launch.py"
FILES = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/helper.py": HELPER}
FOUND = "$(find-pkg-share arm)/"


@pytest.mark.parametrize(
    ("action", "expected"),
    [
        ("DeclareLaunchArgument('f', default_value=config_file('arm'))", f"default {FOUND}config/arm.yaml"),
        ("DeclareLaunchArgument('f', default_value=config_file('arm', name='b'))", f"default {FOUND}config/b"),
        ("DeclareLaunchArgument('f', default_value=joined_file('arm', 'b.yaml'))", f"default {FOUND}config/b.yaml"),
        ("Node(package='arm', executable='n', name=share_file('arm', 'a', 'b'))", f"name {FOUND}share/a/b"),
        ("Node(package='arm', executable='n', name=share_file('arm'))", f"name {FOUND}share"),
        ("Node(package='arm', executable='n', name=share_file(*motor))", "name share_file(*motor)"),
        ("IncludeLaunchDescription(source('arm', 'a.launch.py'))", f"include of '{FOUND}launch/a.launch.py'"),
        ("Node(package='arm', executable='n', parameters=[common()])", "parameter rate 5"),
        ("Node(package='arm', executable='n', parameters=[common()])", f"parameter file {FOUND}config/a.yaml"),
        ("Node(package='arm', executable='n', name=load('a', {}))", "name load(a, {})"),
        ("Node(package='arm', executable='n', name=config_file())", "name config_file()"),
        ("Node(package='arm', executable='n', name=motor['name'])", "name load(...)[motor][name]"),
    ],
)
def test_values_of_functions_are_shown(repository, compare, action, expected):
    repository.commit(FILES)
    repository.write({PATH: LAUNCH.replace("ACTION", action)})
    (line,) = sentences(subject(compare(repository), PATH))
    assert expected in line


def test_include_that_a_function_chooses_is_compared(repository, compare):
    action = "IncludeLaunchDescription(source('arm', 'a.launch.py'))"
    included = {"arm/launch/a.launch.py": LAUNCH.replace("ACTION", "Node(package='arm', executable='n')")}
    repository.commit({**FILES, **included, PATH: LAUNCH.replace("ACTION", action)})
    call = "os.path.join(get_package_share_directory('arm'), 'launch', 'a.launch.py')"
    path = f"IncludeLaunchDescription(PythonLaunchDescriptionSource({call}))"
    repository.write({PATH: LAUNCH.replace("ACTION", path)})
    assert not breaking(compare(repository))


def test_changed_argument_of_an_unknown_function_is_one_line(repository, compare):
    nodes = [f"Node(package='arm', executable='n{number}', parameters=[{{'a': motor['a']}}])," for number in range(5)]
    text = LAUNCH.replace("ACTION", "\n        ".join(nodes))
    repository.commit({**FILES, PATH: text})
    repository.write({PATH: text.replace("{'a': 1}", "{'a': 1, 'b': 2}")})
    (line,) = sentences(subject(compare(repository), PATH))
    assert line.startswith("other code: values = load(config_file('arm'), {'a': 1})")


INSTALLING = """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""


def test_include_of_a_missing_file_that_a_function_chooses_is_breaking(repository, compare):
    action = "IncludeLaunchDescription(source('arm', 'a.launch.py'))"
    included = {"arm/launch/a.launch.py": LAUNCH.replace("ACTION", "Node(package='hand', executable='n')")}
    files = {**FILES, **included, "arm/CMakeLists.txt": INSTALLING, PATH: LAUNCH.replace("ACTION", action)}
    repository.commit(files)
    text = files[PATH].replace("helper import", "helper import other_source,").replace("(source", "(other_source")
    start = HELPER.index("def source(")
    other = HELPER[start:].replace("def source(", "def other_source(").replace("'launch'", "'config'")
    repository.write({PATH: text, "arm/arm/helper.py": HELPER + "\n\n" + other.partition("\n\n\n")[0] + "\n"})
    found = f"include of '{FOUND}launch/a.launch.py' replaced by include of '{FOUND}config/a.launch.py'"
    assert breaking(compare(repository)) == [found]


def test_a_name_from_an_unpacked_result_is_shown_and_may_be_the_old_one(repository, compare):
    text = LAUNCH.replace("ACTION", "Node(package='hand', executable='n', namespace=NAMESPACE)")
    text = text.replace("    motor =", "    name, prefix = load(config_file('arm'), {})\n    motor =")
    repository.commit({**FILES, PATH: text.replace("NAMESPACE", "'left'")})
    repository.write({PATH: text.replace("NAMESPACE", "name")})
    result = compare(repository)
    assert breaking(result) == []
    assert sentences(subject(result, PATH)) == [
        f"node 'hand/n': namespace left -> load({FOUND}config/arm.yaml, {{}})[0]"
    ]
