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


CHOSEN = """
    <xacro:if value="${space == ''}"><xacro:property name="ns" value=""/></xacro:if>
    <xacro:unless value="${space == ''}"><xacro:property name="ns" value="${space}/"/></xacro:unless>"""


@pytest.mark.parametrize(
    ("value", "extra", "default", "is_same"),
    [
        ("${ns}scan", CHOSEN, "''", True),
        ("${ns}scan", CHOSEN, "arm", False),
        ("${ns}scan", CHOSEN.replace("''", "none"), "''", False),
        ("${space + '/' if space else ''}scan", "", "''", True),
        ("${'' if not space else space + '/'}scan", "", "''", True),
        ("${space + '/' if other else ''}scan", "", "''", False),
    ],
)
def test_conditions_on_a_new_parameter_hold_with_its_default(repository, compare, value, extra, default, is_same):
    macro = MACRO.replace("<gazebo", f"{extra}\n    <gazebo")
    repository.commit({PART: MACRO.format(parameters="name", value="scan")})
    text = macro.replace("{parameters}", f"name space:={default}").replace("{value}", value)
    repository.write({PART: text})
    result = compare(repository)
    (line,) = [line for line in sentences(subject(result, PART)) if "topicName" in line]
    assert line.endswith("(the same by default)") is is_same
    assert (breaking(result) == []) is is_same


REMAPPED = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="drive" params="file{parameters}">
    <gazebo><plugin name="control" filename="control-system"><ros>
      {lines}
    </ros></plugin></gazebo>
  </xacro:macro>
</robot>
"""
DRIVE, IMU = "<remapping>drive/cmd:={}cmd</remapping>", "<remapping>{}imu/imu:=imu/data</remapping>"


@pytest.mark.parametrize(
    ("new", "parameters", "expected"),
    [
        (IMU.format("") + DRIVE.format("/"), "", []),
        (IMU.format("") + DRIVE.format(""), "", []),
        ("<namespace>${space}</namespace>" + DRIVE.format(""), " space:=''", ["imu/imu:=imu/data"]),
        ("<namespace>${space}</namespace>" + IMU.format("") + DRIVE.format(""), " space:='arm'", ["drive/cmd:=/cmd"]),
        (IMU.format("") + DRIVE.format("drive/"), "", ["drive/cmd:=/cmd"]),
    ],
)
def test_remappings_of_a_plugin_belong_together_by_their_left_side(repository, compare, new, parameters, expected):
    lines = DRIVE.format("/") + IMU.format("/")
    repository.commit({PART: REMAPPED.format(parameters="", lines=lines)})
    repository.write({PART: REMAPPED.format(parameters=parameters, lines=new)})
    assert [next(text for text in expected if text in line) for line in breaking(compare(repository))] == expected


def test_remappings_of_a_robot_belong_together_by_their_left_side(repository, compare):
    robot = (
        '<robot name="arm"><link name="base"/><gazebo><plugin name="control" filename="control-system"><ros>'
        "{}</ros></plugin></gazebo></robot>"
    )
    old, new = DRIVE.format("/") + IMU.format("/"), IMU.format("") + DRIVE.format("")
    repository.commit({"arm/urdf/arm.urdf": robot.format(old)})
    repository.write({"arm/urdf/arm.urdf": robot.format(new)})
    result = compare(repository)
    assert breaking(result) == []
    repository.write({"arm/urdf/arm.urdf": robot.format(new.replace("imu/data", "imu/raw"))})
    assert ["imu/imu:=imu/data -> imu/imu:=imu/raw" in line for line in breaking(compare(repository))] == [True]


def test_lost_parameter_of_a_macro_in_a_namespace_is_told_once(repository, compare):
    sensors = MACRO.format(parameters="{}", value="scan")
    robot = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="laser.xacro" ns="sensors"/>
  <xacro:macro name="arm" params="prefix"><xacro:sensors.laser size="1"{}/></xacro:macro>
</robot>
"""
    path = "arm/urdf/arm_macro.xacro"
    repository.commit({PART: sensors.format("size name"), path: robot.format(' name="front"')})
    repository.write({PART: sensors.format("size"), path: robot.format("")})
    assert breaking(compare(repository)) == ["macro 'laser': parameter name removed"]
