"""Reviews of descriptions that could not be expanded before, because an included file was missing or malformed."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

BASE = "arm_description/urdf/base.xacro"
LIBRARY = "arm_description/urdf/library.xacro"
PARTS = "arm_description/urdf/parts.xacro"
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="side"><link name="${side}_wheel"/></xacro:macro>
</robot>
"""
INCLUDE = '<xacro:include filename="{file}"/>'
TEXT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  {include}
  <xacro:property name="orange" value="1 0.5 0 1"/>
  <xacro:macro name="base" params="parent"><link name="base"/></xacro:macro>
</robot>
"""


@pytest.mark.parametrize(
    ("include", "is_malformed", "is_breaking"),
    [
        (INCLUDE.format(file="$(find arm_description)/urdf/parts.xacro"), True, False),
        (INCLUDE.format(file="library.xacro"), True, False),
        (INCLUDE.format(file="library.xacro"), False, True),
        (f"<xacro:if value='$(arg wheels)'>{INCLUDE.format(file='parts.xacro')}</xacro:if>", True, True),
        ("", True, True),
    ],
)
def test_change_of_a_description_that_nobody_could_expand_breaks_nothing(
    package, compare, include, is_malformed, is_breaking
):
    parts = MACRO.replace("</xacro:macro>", "<xacro:macro>") if is_malformed else MACRO
    library = TEXT.replace("base", "library").format(include=INCLUDE.format(file="parts.xacro"))
    package.commit({BASE: TEXT.format(include=include), LIBRARY: library, PARTS: parts})
    new = TEXT.format(include=include).replace('name="orange"', 'name="red"').replace("1 0.5 0", "1 0 0")
    package.write({BASE: new.replace('params="parent"', 'params="parent side"'), PARTS: MACRO})
    result = compare(package)
    assert bool(breaking(result)) == is_breaking
    assert "macro 'base': parameter side without a default added" in sentences(subject(result, BASE))


@pytest.mark.parametrize(
    ("include", "is_breaking"),
    [
        (INCLUDE.format(file="$(find arm_description)/urdf/lost.xacro"), False),
        (INCLUDE.format(file="lost.xacro").replace("/>", ' optional="true"/>'), True),
        (INCLUDE.format(file="../submodule/lost.xacro"), True),
        (INCLUDE.format(file="$(find other)/urdf/lost.xacro"), True),
        (INCLUDE.format(file="library.xacro"), True),
    ],
)
def test_links_of_a_description_that_includes_a_missing_file_are_not_lost(package, compare, include, is_breaking):
    text = TEXT.format(include=include).replace("</robot>", '<link name="base_link"/><link name="plate"/></robot>')
    package.commit({BASE: text, LIBRARY: MACRO})
    package.write(
        {BASE: text.replace(include, INCLUDE.format(file="library.xacro")).replace('<link name="plate"/>', "")}
    )
    lines = breaking(compare(package))
    assert any("plate" in line for line in lines) == is_breaking
