"""The lines of a review about launch files that start another robot."""

from __future__ import annotations

import pytest

MANIFEST = "<package><name>arm</name><version>1.0.0</version></package>\n"
ROBOT = '<robot name="arm"><link name="base"/><link name="{}"/>{}</robot>\n'
JOINT = '<joint name="j" type="fixed"><parent link="base"/><child link="{}"/></joint>'
NODE = '<node pkg="state" exec="state"><param name="robot_description" value="{}"/></node>'
MARKUP = '<launch><arg name="model" default="{model}"/>' + NODE.format("$(command 'xacro {path}')") + "</launch>\n"
PATH = "$(find-pkg-share arm)/urdf/$(var model).urdf"
SHORT, LONG = ("$(find-pkg-share arm)/urdf/short.urdf", "$(find-pkg-share arm)/urdf/long.urdf")
PYTHON = """from launch import LaunchDescription
from launch_ros.actions import Node
def load_file(package, path):
    return open(package + path).read()
def generate_launch_description():
    robot = load_file("arm", "urdf/{model}.urdf")
    state = Node(package="robot_state_publisher", executable="robot_state_publisher",
                 parameters=[{{"robot_description": robot}}])
    return LaunchDescription([state])
"""
SENTENCE = "the robot 'arm/urdf/long.urdf' has no links tip of 'arm/urdf/short.urdf'"


def find_lines(repository, compare, path, old, new, others=None, **robots):
    repository.commit({"arm/package.xml": MANIFEST, path: old, **{f"arm/urdf/{k}.urdf": v for k, v in robots.items()}})
    repository.write({path: new, **(others or {})})
    result = compare(repository)
    return [str(change.sentence) for _, change in result.breaking_changes if "has no links" in str(change.sentence)]


@pytest.mark.parametrize(("link", "is_found"), [("hand", True), ("tip", False)])
def test_another_robot_by_default_lacks_links(repository, compare, link, is_found):
    robots = {name: ROBOT.format(each, JOINT.format(each)) for name, each in (("short", "tip"), ("long", link))}
    old, new = (MARKUP.format(model=model, path=PATH) for model in ("short", "long"))
    found = find_lines(repository, compare, "arm/launch/a.launch.xml", old, new, **robots)
    assert found == ([SENTENCE] if is_found else [])


def test_another_robot_of_a_function_lacks_links(repository, compare):
    robots = {name: ROBOT.format(each, JOINT.format(each)) for name, each in (("short", "tip"), ("long", "hand"))}
    old, new = (PYTHON.format(model=model) for model in ("short", "long"))
    assert find_lines(repository, compare, "arm/launch/a.launch.py", old, new, **robots) == [SENTENCE]


def test_a_second_robot_is_not_another_one(repository, compare):
    robots = {name: ROBOT.format(each, JOINT.format(each)) for name, each in (("short", "tip"), ("long", "hand"))}
    old, more = (MARKUP.format(model=model, path=PATH) for model in ("short", "long"))
    both = old.replace("</launch>", NODE.format("$(find-pkg-share arm)/urdf/long.urdf") + "</launch>")
    assert find_lines(repository, compare, "arm/launch/a.launch.xml", both, more, **robots) == []


INCLUDE = """<launch>
  <include file="$(find-pkg-share arm)/launch/{file}.launch.xml"><arg name="model" value="{model}"/></include>
</launch>
"""


@pytest.mark.parametrize(
    ("old", "new", "included", "expected"),
    [
        (("a", "short"), ("b", "short"), {}, [SENTENCE]),
        (("a", "short"), ("a", "long"), {}, []),
        (("c", "short"), ("c", "long"), {}, [SENTENCE]),
        (("a", "short"), ("a", "long"), {"arm/launch/a.launch.xml": MARKUP.format(model="short", path=LONG)},
         [SENTENCE]),
    ],
)  # fmt: skip
def test_another_robot_of_an_included_file_lacks_links(repository, compare, old, new, included, expected):
    robots = {name: ROBOT.format(each, JOINT.format(each)) for name, each in (("short", "tip"), ("long", "hand"))}
    paths = {"a": SHORT, "b": LONG, "c": PATH}
    files = {f"arm/launch/{k}.launch.xml": MARKUP.format(model="short", path=path) for k, path in paths.items()}
    repository.commit(files)
    old, new = (INCLUDE.format(file=file, model=model) for file, model in (old, new))
    found = find_lines(repository, compare, "arm/launch/s.launch.xml", old, new, included, **robots)
    assert found == expected
