"""Launch files that no longer start a program which offers no topics and services, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SCRIPT = """#!/usr/bin/env python
import sys
import rospy
from roscpp.srv import SetLoggerLevel

rospy.init_node("level")
rospy.ServiceProxy("/gazebo/set_logger_level", SetLoggerLevel)("ros", sys.argv[1])
"""
NODE = '<node pkg="arm" type="level.py" name="{}"/>'
PATH = "arm/launch/arm.launch"


@pytest.mark.parametrize(
    ("more", "is_breaking"),
    [
        ("", False),
        ('rospy.Publisher("state", SetLoggerLevel)\n', True),
        ("rospy.Subscriber(sys.argv[1], SetLoggerLevel)\n", True),
        ("import driver_library\n", True),
    ],
)
@pytest.mark.parametrize("new", ["", NODE.format("other")])
def test_a_program_without_names_leaves_none_behind(repository, compare, more, is_breaking, new):
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/scripts/level.py": SCRIPT + more}
    repository.commit({**files, PATH: f"<launch>{NODE.format('level')}</launch>"})
    repository.write({PATH: f"<launch>{new}</launch>"})
    assert bool(breaking(compare(repository))) == is_breaking
