"""Names that a macro newly uses although nothing defines them."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/rail.xacro"
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">%s
  <xacro:macro name="rail" params="%s"><link name="rail">%s</link></xacro:macro>
</robot>
"""
PART = (
    '<xacro:unless value="${mode == \'sim\'}"><visual><geometry><sphere radius="1"/></geometry></visual></xacro:unless>'
)
PROPERTY = '<xacro:property name="mode" value="real"/>'
LIST = '<xacro:if value="${[mode for mode in range(3)]}"><visual/></xacro:if>'


@pytest.mark.parametrize(
    ("new", "is_breaking"),
    [
        (("", "", PART), True),
        (("", "mode:=sim", PART), False),
        ((PROPERTY, "", PART), False),
        (("", "", LIST), False),
    ],
)
def test_name_that_nothing_defines_is_breaking(package, compare, new, is_breaking):
    package.commit({PATH: MACRO % ("", "", "")})
    package.write({PATH: MACRO % new})
    result = compare(package)
    text = "macro 'rail': uses 'mode', which nothing defines"
    assert (text in breaking(result)) is is_breaking
    assert any("rail" in sentence for sentence in sentences(subject(result, PATH)))


def test_name_that_a_caller_may_define_is_not_reported(package, compare):
    caller = """<xacro:macro name="station" params="mode"><xacro:rail/></xacro:macro></robot>"""
    package.commit({PATH: (MACRO % ("", "", "")).replace("</robot>", caller)})
    package.write({PATH: (MACRO % ("", "", PART)).replace("</robot>", caller)})
    assert breaking(compare(package)) == []


INCLUDE = '<xacro:include filename="modes.xacro"/>'
ROBOT = """<robot name="cell" xmlns:xacro="http://www.ros.org/wiki/xacro">{}
  <xacro:include filename="rail.xacro"/><xacro:rail/>
</robot>
"""


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        (INCLUDE, "", True),
        (PROPERTY, "", True),
        (INCLUDE, PROPERTY, False),
        (INCLUDE, '<xacro:include filename="$(find other_modes)/modes_of_rail.xacro"/>', False),
        ("", "", False),
    ],
)
def test_name_whose_definition_moved_to_the_robot_is_breaking_for_other_robots(package, compare, old, new, is_breaking):
    robot, modes = "arm_description/urdf/cell.urdf.xacro", "arm_description/urdf/modes.xacro"
    package.commit(
        {
            PATH: MACRO % (old, "", PART),
            robot: ROBOT.format("" if old else INCLUDE),
            modes: f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{PROPERTY}</robot>\n',
        }
    )
    package.write({PATH: MACRO % (f"<!-- new -->{new}", "", PART), robot: ROBOT.format("" if new else INCLUDE)})
    text = "no longer defines 'mode', which its macros use"
    assert (text in breaking(compare(package))) is is_breaking
