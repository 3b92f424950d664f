"""Nodes of launch files whose programs only have another name, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

LAUNCH = '<launch><node pkg="lamp" exec="{}" name="lamp"/></launch>\n'
SCRIPT = "#!/usr/bin/env python3\nimport rclpy\nfrom rclpy.node import Node\n\n\nrclpy.init()\nnode = Node('lamp')\n"
CMAKE = """project(lamp)
rclcpp_components_register_node(lamp_component
  PLUGIN "lamp::Lamp"
  EXECUTABLE {})
"""
PATH = "lamp/launch/lamp.launch.xml"


def test_a_node_follows_the_new_name_of_its_script(repository, compare):
    manifest = {"lamp/package.xml": PACKAGE_XML.replace("arm_description", "lamp")}
    launch = LAUNCH.replace(' name="lamp"', "")
    repository.commit({**manifest, "lamp/scripts/bulb.py": SCRIPT, PATH: launch.format("bulb.py")})
    repository.write({"lamp/scripts/bulb.py": None, "lamp/scripts/sun.py": SCRIPT, PATH: launch.format("sun.py")})
    repository.commit({})
    assert sentences(subject(compare(repository, "HEAD~..HEAD"), PATH)) == [
        "node 'lamp/bulb.py' replaced by node 'lamp/sun.py'"
    ]


def test_a_node_follows_the_new_executable_of_its_component(repository, compare):
    launch = LAUNCH.replace(' name="lamp"', "")
    files = {"lamp/package.xml": PACKAGE_XML.replace("arm_description", "lamp")}
    repository.commit({**files, "lamp/CMakeLists.txt": CMAKE.format("bulb"), PATH: launch.format("bulb")})
    repository.write({"lamp/CMakeLists.txt": CMAKE.format("sun"), PATH: launch.format("sun")})
    assert sentences(subject(compare(repository), PATH)) == ["node 'lamp/bulb' replaced by node 'lamp/sun'"]


@pytest.mark.parametrize("default", ["bulb", "sun"])
def test_an_argument_with_the_old_program_as_default_starts_the_same_node(repository, compare, default):
    launch = '<launch>{}<node pkg="lamp" exec="{}"/></launch>\n'
    argument = f'<arg name="program" default="{default}"/>'
    repository.commit({PATH: launch.format("", "bulb")})
    repository.write({PATH: launch.format(argument, "$(var program)")})
    result = compare(repository)
    same = "node 'lamp/bulb' replaced by node 'lamp/$(var program)', by default the same"
    assert (same in sentences(subject(result, PATH))) is (default == "bulb")
    assert bool(breaking(result)) is (default == "sun")
