"""The lines of a review about values of a macro that take its parameter instead of the argument with the same name."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="hand" params="prefix">
    <link name="{}tip"/>
  </xacro:macro>
</robot>
"""
ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="robot">
  <xacro:arg name="prefix" default=""/>
  <xacro:include filename="hand.xacro"/>
  <xacro:hand prefix="$(arg prefix)"/>
</robot>
"""
ARGUMENT, PARAMETER = "$(arg prefix)", "${prefix}"


@pytest.mark.parametrize(("old", "new"), [(ARGUMENT, PARAMETER), (PARAMETER, ARGUMENT)])
def test_a_name_of_a_macro_that_no_robot_of_the_repository_changes_is_told(repository, compare, old, new):
    files = {"arm/package.xml": PACKAGE_XML, "arm/urdf/robot.urdf.xacro": ROBOT}
    repository.commit({**files, "arm/urdf/hand.xacro": MACRO.format(old)})
    repository.write({"arm/urdf/hand.xacro": MACRO.format(new)})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject)]
    assert lines == [f"macro 'hand': link {new}tip name: {old}tip -> {new}tip"]
    assert bool(breaking(result)) == (new == ARGUMENT)
