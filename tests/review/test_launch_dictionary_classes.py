"""Objects of a repository's own classes of dictionaries, lists that are sums, and nested helpers in launch files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

HELPER = '''from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration


class Arguments(dict):
    """Arguments that are passed on."""

    def add(self, name):
        if isinstance(name, str):
            super().__setitem__(name, LaunchConfiguration(name))
        else:
            for item in name:
                self[item] = LaunchConfiguration(item)

    def add_time(self):
        self.add('use_sim_time')


def declare(launch_description, default=None):
    declare_name(launch_description, default)


def declare_name(launch_description, default=None):
    launch_description.add_action(DeclareLaunchArgument('vehicle', default_value=default))
'''
LAUNCH = """from launch import LaunchDescription
from launch.actions import GroupAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace
from arm.helper import Arguments, declare


def generate_launch_description():
    ld = LaunchDescription()
    declare(ld)
    args = Arguments()
    args.add_time()
    actions = [Node(package='arm', executable='drive', parameters=[args])]
    ld.add_action(GroupAction([PushRosNamespace(LaunchConfiguration('vehicle'))] + actions))
    return ld
"""
PATH = "arm/launch/arm.launch.py"
FILES = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/helper.py": HELPER}


def test_items_and_namespace_of_an_added_node_are_shown(repository, compare):
    repository.commit(FILES)
    repository.write({PATH: LAUNCH})
    (line,) = sentences(subject(compare(repository), PATH))
    assert line == (
        "launch file added: node 'arm/drive' (namespace $(var vehicle), parameter use_sim_time $(var use_sim_time)), "
        "argument 'vehicle' (required)"
    )


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("args.add_time(); args.add('name')", ["parameter name $(var name) added"]),
        ("args.add_time(); args.add(['a', 'b'])", ["parameter a $(var a) added", "parameter b $(var b) added"]),
        ("args.add_time()\n    args.update({'rate': 5})", ["parameter rate 5 added"]),
        ("args.add_time()\n    args.update(rate=5)", ["parameter rate 5 added"]),
        ("pass", ["parameter use_sim_time $(var use_sim_time) removed"]),
    ],
)
def test_items_that_statements_add_are_compared(repository, compare, statement, expected):
    repository.commit({**FILES, PATH: LAUNCH})
    repository.write({PATH: LAUNCH.replace("args.add_time()", statement)})
    found = sentences(subject(compare(repository), PATH))
    prefix = "node 'arm/drive': "
    assert [line.removeprefix(prefix) for line in found if line.startswith(prefix)] == expected


@pytest.mark.parametrize("statement", ["args.add(load())", "args.pop('a')", "args['a'] = 1", "args = make(args)"])
def test_unknown_effect_on_items_leaves_the_object(repository, compare, statement):
    repository.commit(FILES)
    repository.write({PATH: LAUNCH.replace("args.add_time()", statement)})
    assert "parameters [" in sentences(subject(compare(repository), PATH))[0]


def test_renamed_class_of_dictionaries_changes_no_parameters(repository, compare):
    repository.commit({**FILES, PATH: LAUNCH})
    renamed = {path: text.replace("Arguments", "Passed") for path, text in {**FILES, PATH: LAUNCH}.items()}
    repository.write(renamed)
    assert PATH not in [found.path for found in compare(repository).subjects]


def test_default_none_is_no_default(repository, compare):
    repository.commit({**FILES, PATH: LAUNCH, "arm/arm/helper.py": HELPER.replace(", default_value=default", "")})
    repository.write({"arm/arm/helper.py": HELPER})
    found = [line for item in compare(repository).subjects for line in sentences(item)]
    assert not [line for line in found if "default" in line and line.startswith("argument")]


SETUP = "from setuptools import setup\nsetup(name='arm', packages=['arm'])\n"


@pytest.mark.parametrize(
    ("old", "new", "setup", "expected"),
    [
        ("Arguments", "Passed", SETUP, ["'Arguments' renamed to 'Passed'"]),
        ("def declare(", "def _declare(", SETUP, ["'declare' removed"]),
        ("Arguments", "Passed", "", []),
    ],
)
def test_names_that_other_packages_import_are_compared(repository, compare, old, new, setup, expected):
    files = {**FILES, "arm/arm/__init__.py": "", **({"arm/setup.py": setup} if setup else {})}
    repository.commit(files)
    repository.write({"arm/arm/helper.py": HELPER.replace(old, new)})
    assert breaking(compare(repository)) == expected


def test_ported_launch_file_of_another_name_is_told_once(repository, compare):
    xml = """<launch>
  <arg name="rate" default="5"/>
  <node pkg="arm" type="drive" name="drive" output="screen"><param name="rate" value="$(arg rate)"/></node>
  <node pkg="arm" type="watch" name="watch" output="screen"><param name="rate" value="$(arg rate)"/></node>
</launch>
"""
    comment = "".join(f"<!-- This comment is in both versions of the launch file, line {n}. -->\n" for n in range(9))
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/arm.launch": comment + xml})
    ported = xml.replace("type=", "exec=").replace("$(arg", "$(var")
    lines = [line for line in ported.splitlines(keepends=True) if "watch" not in line]
    repository.write({"arm/launch/arm.launch": None, "arm/launch/robot_launch.xml": comment + "".join(lines)})
    repository.commit({})
    assert breaking(compare(repository, "HEAD~..HEAD")) == ["renamed from arm/launch/arm.launch"]
