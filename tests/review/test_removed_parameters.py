"""Reviews of macros that lose parameters, and of the calls that no longer pass them."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/hardware.xacro"
JOINT = '<joint name="{joint}"><command_interface name="position"/></joint>'
MACRO = f"""<xacro:macro name="hardware" {{parameters}}>
    <ros2_control name="{{name}}" type="system">{JOINT}</ros2_control>
  </xacro:macro>"""
TEXT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  {macro}
  <xacro:macro name="arm" params="simulated">
    <xacro:if value="${{simulated}}"><xacro:hardware {call}/></xacro:if>{other}
  </xacro:macro>
</robot>
"""
OLD_MACRO = MACRO.format(parameters='params="name shoulder"', name="${name}", joint="${shoulder}")
NEW_MACRO = MACRO.format(parameters="", name="arm", joint="${SHOULDER}")
CALL = 'name="arm" shoulder="${SHOULDER}"'


def test_value_that_all_calls_passed_takes_the_place_of_the_parameter(package, compare):
    package.commit({PATH: TEXT.format(macro=OLD_MACRO, call=CALL, other="")})
    package.write({PATH: TEXT.format(macro=NEW_MACRO, call="", other="")})
    assert sentences(subject(compare(package), PATH)) == ["macro 'hardware': parameters name, shoulder removed"]


@pytest.mark.parametrize("other", ["${ELBOW}", ""])
def test_parameter_for_which_calls_pass_different_values_keeps_its_name(package, compare, other):
    package.commit(
        {PATH: TEXT.format(macro=OLD_MACRO, call=CALL, other=f'<xacro:hardware name="arm" shoulder="{other}"/>')}
    )
    package.write({PATH: TEXT.format(macro=NEW_MACRO, call="", other="")})
    lines = sentences(subject(compare(package), PATH))
    assert "macro 'hardware': ros2_control arm joint ${SHOULDER} name: ${shoulder} -> ${SHOULDER}" in lines


def test_call_that_loses_its_name_is_not_removed_hardware(package, compare):
    macro = OLD_MACRO.replace("${shoulder}", "shoulder").replace(" shoulder", "")
    package.commit({PATH: TEXT.format(macro=macro, call='name="arm"', other="")})
    package.write({PATH: TEXT.format(macro=macro.replace('params="name"', 'params="name:=arm"'), call="", other="")})
    result = compare(package)
    assert breaking(result) == []
    assert "macro 'arm': hardware name arm removed" in sentences(subject(result, PATH))


LINKS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="caster" params="{parameters}">
    <link name="{name}"/><link name="{name}_wheel"/><link name="{other}"/>
  </xacro:macro>
  <xacro:macro name="base" params="parent">{calls}</xacro:macro>
</robot>
"""


@pytest.mark.parametrize("calls", [["swivel"], ["swivel", "tail"]])
def test_value_that_all_calls_pass_takes_the_place_of_the_new_parameter(package, compare, calls):
    old = LINKS.format(parameters="parent", name="swivel", other="hub", calls='<xacro:caster parent="p"/>')
    texts = "".join(f'<xacro:caster parent="p" name="{name}"/>' for name in calls)
    new = LINKS.format(parameters="name parent", name="${name}", other="${name}_hub", calls=texts)
    package.commit({PATH: old})
    package.write({PATH: new})
    lines = sentences(subject(compare(package), PATH))
    is_same = len(calls) == 1
    assert ("macro 'caster': link ${name}_hub name: hub -> ${name}_hub" in lines) is is_same
    assert ("macro 'caster': link swivel removed" not in lines) is is_same
    assert ("macro 'caster': link swivel_wheel removed" not in lines) is is_same
