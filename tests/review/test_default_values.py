"""Values of descriptions that arguments or parameters of macros newly give, with the old value as the default."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PART = "arm/urdf/laser.xacro"
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="laser" default="false"/>
  <link name="base"/>{argument}
  <xacro:include filename="laser.xacro"/>
</robot>
"""
LASER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{extra}
  <xacro:if value="$(arg laser)">
    <gazebo reference="base"><sensor name="laser" type="ray"><plugin name="driver" filename="liblaser.so">
      <robotNamespace>{value}</robotNamespace>
    </plugin></sensor></gazebo>
  </xacro:if>
</robot>
"""
PATH = "gazebo base sensor laser plugin driver robotNamespace"
ALIAS = '<xacro:property name="space" value="$(arg space)"/>'


@pytest.mark.parametrize(
    ("value", "extra", "default", "is_same"),
    [
        ("$(arg space)", "", "/old", True),
        ("${space}", ALIAS, "/old", True),
        ("$(arg space)", "", "/new", False),
        ("$(arg space)/a", "", "/old", False),
    ],
)
def test_argument_whose_default_is_the_old_value_breaks_nothing(repository, compare, value, extra, default, is_same):
    """The robot that the review shows has another change, and no laser."""
    argument = f'<gazebo><static>true</static></gazebo><xacro:arg name="space" default="{default}"/>'
    repository.commit(
        {"arm/urdf/arm.urdf.xacro": ROBOT.format(argument=""), PART: LASER.format(value="/old", extra="")}
    )
    new = {"arm/urdf/arm.urdf.xacro": ROBOT.format(argument=argument), PART: LASER.format(value=value, extra=extra)}
    repository.write(new)
    result = compare(repository)
    line = f"{PATH}: /old -> {value}" + " (the same by default)" * is_same
    assert line in sentences(subject(result, PART))
    assert breaking(result) == [] if is_same else [line]


MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="laser" params="{parameters}">
    <gazebo reference="base"><plugin name="driver" filename="liblaser.so">
      <topicName>{value}</topicName>
    </plugin></gazebo>
  </xacro:macro>
</robot>
"""


@pytest.mark.parametrize(("default", "is_same"), [(":=scan", True), (":='scan'", True), (":=laser", False)])
def test_parameter_of_a_macro_whose_default_is_the_old_value_breaks_nothing(repository, compare, default, is_same):
    repository.commit({PART: MACRO.format(parameters="name", value="scan")})
    repository.write({PART: MACRO.format(parameters=f"name topic{default}", value="${topic}")})
    result = compare(repository)
    (line,) = [line for line in sentences(subject(result, PART)) if "topicName" in line]
    assert line.endswith("(the same by default)") is is_same
    assert (breaking(result) == []) is is_same
