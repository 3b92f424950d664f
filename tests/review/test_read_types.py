"""The types of the variables into which C++ sources of ROS 1 read parameters."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SOURCE = """#include "lamp/lamp.h"
bool Lamp::init(ros::NodeHandle & nh) {{
  {code}
}}
"""
HEADER = """class Lamp {
  int level_, last_;
  bool is_on_ = false;
  std::vector<int> colors_;
  lamp_msgs::Light light_;
};
"""
MESSAGE = "uint8 ON=1\nuint8 state  # on or off\nstring[] names\nbool is_on\n"
FILES = {
    "lamp/package.xml": PACKAGE_XML.replace("arm_description", "lamp"),
    "lamp/include/lamp/lamp.h": HEADER,
    "lamp_msgs/msg/Light.msg": MESSAGE,
}
REJECTED = "values of the old type are not read"


@pytest.mark.parametrize(
    ("old", "new", "change", "is_breaking"),
    [
        ('nh.getParam("x", level_);', 'bool on; nh.getParam("x", on);', "int -> bool", True),
        ('nh.getParam("x", last_);', 'nh.getParam("x", is_on_);', "int -> bool", True),
        ('nh.param("x", level_, 1);', 'nh.param("x", colors_, colors);', "int -> list", True),
        ('nh.getParam("x", light_.state);', 'nh.getParam("x", is_on_);', "int -> bool", True),
        ('nh.getParam("x", light_.names);', 'nh.getParam("x", level_);', "list -> int", True),
        ('readParam("x", light_.state);', 'readParam("x", is_on_);', "int -> bool", True),
        ('nh.param<bool>("x", on, true);', 'nh.param<int>("x", on, 1);', "bool -> int", True),
        ('nh.getParam("x", level_);', 'double level; nh.getParam("x", level);', "int -> double", False),
        ('nh.getParam("x", level_);', 'uint16_t level; nh.getParam("x", level);', None, False),
        ('nh.getParam("x", level_);', 'nh.getParam("x", unknown_);', None, False),
        ('nh.getParam("x", level_);', 'nh.getParam("x", light_.color);', None, False),
        ('nh.getParam("x", level_);', 'nh.getParam("x", level_); nh.getParam("x", is_on_);', None, False),
        ('nh.getParam("x", level_);', 'nh.param<int>("x", level_, 2);', None, False),
    ],
)
def test_type_of_variable(repository, compare, old, new, change, is_breaking):
    path = "lamp/src/lamp.cpp"
    repository.commit({**FILES, path: SOURCE.format(code=old)})
    repository.write({path: SOURCE.format(code=new)})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject) if "read as" in line]
    assert [line.partition(": read as ")[2] for line in lines] == ([change] if change else [])
    assert [line for line in breaking(result) if "read as" in line] == (lines if is_breaking else [])
    if is_breaking:
        assert REJECTED in [str(item.reason) for _, item in result.breaking_changes]
