"""Parameters of sources are renamed only if they keep their use."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = """from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        super().__init__('arm')
        self.declare_parameter('{name}', 'base')
        self.{variable} = self.get_parameter('{name}').value

    def step(self):
        self.pub.publish(make_path(self.points{old_use}))
        self.buffer.lookup('map'{new_use})
"""
CPP = """void Arm::start() {{
  declare_parameter("{name}", "base");
  get_parameter("{name}", {variable}_);
  publish(points{old_use});
  lookup("map"{new_use});
}}
"""
RENAMED = ["parameter 'target_frame' ('base') renamed to 'base_frame' ('base')"]
REMOVED = ["parameters removed: 'target_frame' ('base')"]
USE = ", self.{}"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (("target_frame", USE, ""), ("base_frame", "", USE), REMOVED),
        (("target_frame", USE, ""), ("base_frame", USE, ""), RENAMED),
        (("frame", USE, ""), ("frame", "", USE), RENAMED),
        (("target_frame", USE, ""), ("base_frame", USE, USE), RENAMED),
        (("target_frame", "", ""), ("base_frame", "", ""), RENAMED),
    ],
)
def test_a_parameter_of_a_python_node_is_renamed_only_with_the_same_use(repository, compare, old, new, expected):
    texts = [
        PYTHON.format(name=name, variable=variable, old_use=first.format(variable), new_use=second.format(variable))
        for name, (variable, first, second) in (("target_frame", old), ("base_frame", new))
    ]
    repository.commit({**MANIFEST, "arm/a.py": texts[0]})
    repository.write({"arm/a.py": texts[1]})
    assert breaking(compare(repository)) == expected


@pytest.mark.parametrize(("is_same", "expected"), [(True, RENAMED), (False, REMOVED)])
def test_a_parameter_of_a_cpp_node_is_renamed_only_with_the_same_use(repository, compare, is_same, expected):
    old = CPP.format(name="target_frame", variable="target", old_use=", target_", new_use="")
    uses = (", base_", "") if is_same else ("", ", base_")
    new = CPP.format(name="base_frame", variable="base", old_use=uses[0], new_use=uses[1])
    repository.commit({**MANIFEST, "arm/a.cpp": old})
    repository.write({"arm/a.cpp": new})
    assert breaking(compare(repository)) == [text.replace("'base'", '"base"') for text in expected]


@pytest.mark.parametrize(
    ("helper", "expected"),
    [
        ("from launch_ros.actions import Node\nvalue = {'speed': 2}\n", ["parameters removed: 'speed' (1)"]),
        ("import rclpy\nfrom launch.actions import LogInfo\nrate = read('speed')\n", []),
        ("rate = read('speed')\n", []),
    ],
)
def test_a_helper_module_of_launch_files_does_not_read_a_parameter(repository, compare, helper, expected):
    node = (
        'void Arm::start() {\n  declare_parameter("speed", 1);\n  get_parameter("speed", speed_);\n  run(speed_);\n}\n'
    )
    repository.commit({**MANIFEST, "arm/src/arm.cpp": node, "arm/arm/actions.py": helper})
    repository.write({"arm/src/arm.cpp": "void Arm::start() {\n  run(speed_);\n}\n"})
    assert breaking(compare(repository)) == expected


HARDWARE = """#include <hardware_interface/system_interface.hpp>
int Arm::on_init(const HardwareInfo & info) {{
  try {{
    {variable}_ = std::stod(
      info_.hardware_parameters.count("{name}") ?
      info_.hardware_parameters.at("{name}") : "0");
  }} catch (const std::exception &) {{ return 1; }}
  if ({variable}_ {check}) return 1;
  return 0;
}}
"""


@pytest.mark.parametrize(("check", "is_renamed"), [("< 0", True), ("> max_speed_", False)])
def test_a_parameter_of_hardware_is_renamed_only_with_the_same_use(repository, compare, check, is_renamed):
    old = HARDWARE.format(name="speed_zone", variable="zone", check="< 0")
    new = HARDWARE.format(name="speed_gain", variable="gain", check=check)
    repository.commit({**MANIFEST, "arm/a.cpp": old})
    repository.write({"arm/a.cpp": new})
    title = "parameter of the hardware" if is_renamed else "parameters of the hardware removed:"
    renamed = " renamed to 'speed_gain'" if is_renamed else ""
    assert breaking(compare(repository)) == [f"{title} 'speed_zone'{renamed}"]


def test_parameters_that_are_edited_alike_are_renamed_although_other_words_of_their_lines_change(repository, compare):
    source = """#include <rclcpp/rclcpp.hpp>
Camera::Camera() : Node("camera")
{{
  declare_parameter("{0}_image_topic", "");
  declare_parameter("{0}_info_topic", "");
  auto {0}_image_topic = get_parameter("{0}_image_topic").as_string();
  auto {0}_info_topic = get_parameter("{0}_info_topic").as_string();
  use({0}_node_, {0}_image_topic, 1);
  if ({0}_info_topic != "") {{ listen({0}_node_, {0}_info_topic); }}
}}
"""
    repository.commit({**MANIFEST, "arm/src/camera.cpp": source.format("old")})
    repository.write({"arm/src/camera.cpp": source.format("new")})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.sentence) == "parameter 'old_image_topic' (\"\") renamed to 'new_image_topic' (\"\")"
    assert change.other_names == ('old_info_topic ("") -> new_info_topic ("")',)
