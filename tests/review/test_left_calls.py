"""Calls of macros that a change of the parameters breaks, in files that are no robots."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

TOOL, EXTRA, ROBOT = "arm/urdf/tool.xacro", "arm/urdf/extra.urdf", "arm/urdf/arm.urdf.xacro"
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="tool" params="name{}"><link name="${{name}}"/></xacro:macro>
</robot>
"""
CALLS = """<robot{declaration}>
  <{prefix}tool name="left" side="left"/>
  <{prefix}tool name="right" length="1"/>
</robot>
"""
CATKIN = "<buildtool_depend>catkin</buildtool_depend>"
DECLARED = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
PLAIN = f'<robot{DECLARED} name="arm"><property name="a" value="1"/><link name="base"/></robot>'


@pytest.mark.parametrize(
    ("new", "lines"),
    [(" side:=left length", [2]), ("", [2]), (" side:=left width", [2, 3]), (" side:=left", []), (" side", [3])],
)
@pytest.mark.parametrize(("declaration", "prefix"), [(DECLARED, "xacro:"), (DECLARED, "xacro:arms."), ("", "")])
def test_reason_names_the_calls_that_fail(repository, compare, new, lines, declaration, prefix):
    """The file with the calls is a part that a robot of ROS 1 can include."""
    manifest = PACKAGE_XML.replace("arm_description", "arm").replace("</package>", f"{CATKIN}</package>")
    calls = CALLS.format(declaration=declaration, prefix=prefix)
    files = {"arm/package.xml": manifest, EXTRA: calls, ROBOT: PLAIN, TOOL: MACRO.format(" side:=left")}
    repository.commit(files)
    repository.write({TOOL: MACRO.format(f"{new} height:=1")})
    reasons = [str(change.reason) for change in subject(compare(repository), TOOL).changes if change.reason]
    places = ", ".join(f"{EXTRA}:{line}" for line in lines)
    assert [reason.endswith(f"cannot be expanded, such as {places}") for reason in reasons] == [True] * bool(lines)


def test_calls_without_a_prefix_are_none_in_ros_2(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    calls = CALLS.format(declaration="", prefix="")
    repository.commit({"arm/package.xml": manifest, EXTRA: calls, ROBOT: PLAIN, TOOL: MACRO.format("")})
    repository.write({TOOL: MACRO.format(" width")})
    reasons = [str(change.reason) for change in subject(compare(repository), TOOL).changes if change.reason]
    assert reasons == ["calls that do not pass it cannot be expanded"]
