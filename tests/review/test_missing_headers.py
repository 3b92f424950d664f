"""The lines of a review about types of messages whose header no source includes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MESSAGES = PACKAGE_XML.replace("arm_description", "arm_msgs")
ROS1 = MESSAGES.replace("</package>", "<buildtool_depend>catkin</buildtool_depend></package>")
HEADER = "arm/include/arm/node.h"
USE = "bool load(arm_msgs::LoadTool::Request& request);\n"
USE_2 = "void load(const arm_msgs::srv::LoadTool::Request& request);\n"
LINE = "uses 'arm_msgs::LoadTool', but no source includes <arm_msgs/LoadTool.h>"


def review(repository, compare, manifest, added, other=None):
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm_msgs/package.xml": manifest}
    repository.commit({**files, HEADER: "#pragma once\n", "arm_msgs/srv/LoadTool.srv": "string name\n---\n"})
    repository.write({HEADER: f"#pragma once\n{added}", **(other or {})})
    return [line for line in breaking(compare(repository)) if "no source includes" in line]


def test_a_type_whose_header_no_source_includes_is_breaking(repository, compare):
    assert review(repository, compare, ROS1, USE, {"arm/src/node.cpp": f'#include "arm/node.h"\n{USE}'}) == [LINE]


def test_a_type_of_ros2_names_its_header(repository, compare):
    manifest = MESSAGES
    assert review(repository, compare, manifest, USE_2) == [
        "uses 'arm_msgs::srv::LoadTool', but no source includes <arm_msgs/srv/load_tool.hpp>"
    ]


@pytest.mark.parametrize(
    ("added", "other"),
    [
        (f"#include <arm_msgs/LoadTool.h>\n{USE}", {}),
        (f"#include <arm_msgs/srv/load_tool.hpp>\n{USE_2}", {}),
        (USE, {"arm/src/node.cpp": "#include <arm_msgs/LoadToolRequest.h>\n"}),
        (USE, {"arm/include/arm/types.h": "namespace arm_msgs { class LoadTool; }\n"}),
        (USE, {"arm_msgs/msg/Tools.msg": "LoadTool[] tools\n"}),
        (f"// {USE}", {}),
    ],
)
def test_a_type_that_something_may_bring_breaks_nothing(repository, compare, added, other):
    assert review(repository, compare, ROS1, added, other) == []
