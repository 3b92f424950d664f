"""Changes of unexpanded descriptions in a review.

The tests cover macros, arguments, and elements that no robot uses.
"""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from linkwright.review.changes import ExpandedElement
from linkwright.review.parts.expanded import find_expanded_elements
from linkwright.xacro.cache import read_document
from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

ROBOT = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"
TOOL = "arm_description/urdf/tool.xacro"
GRIPPER = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="width" value="0.05"/>
  <xacro:macro name="gripper" params="name parent side:=left *origin">
    <link name="${name}">
      <visual>
        <geometry><mesh filename="package://arm_description/meshes/${side}.stl"/></geometry>
      </visual>
      <collision><geometry><box size="${width} 0.1 0.1"/></geometry></collision>
    </link>
    <link name="${name}_tip"/>
    <joint name="${name}_joint" type="prismatic">
      <parent link="${parent}"/>
      <child link="${name}"/>
      <xacro:insert_block name="origin"/>
      <axis xyz="0 1 0"/>
      <limit lower="0" upper="0.04" effort="10" velocity="1"/>
    </joint>
    <gazebo reference="${name}">
      <sensor name="camera"><plugin name="driver" filename="driver.so"><topicName>image</topicName></plugin></sensor>
    </gazebo>
  </xacro:macro>
</robot>
"""
GONE = "descriptions that call the macro cannot be expanded"


@pytest.fixture
def library(package):
    """Return the package with a macro that none of its robots calls."""
    package.commit({TOOL: GRIPPER})
    return package


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ("meshes/${side}", "meshes/finger_${side}",
         ("macro 'gripper': link ${name} visual geometry mesh filename: package://arm_description/meshes/${side}.stl"
         " -> package://arm_description/meshes/finger_${side}.stl"), None),
        ('upper="0.04"', 'upper="0.05"',
         "macro 'gripper': joint ${name}_joint limit upper: 0.04 -> 0.05", None),
        ('upper="0.04"', 'upper="0.03"', "macro 'gripper': joint ${name}_joint limit upper: 0.04 -> 0.03",
         "positions of '${name}_joint' above 0.03 are now outside of its limits"),
        ('lower="0"', 'lower="${low}"', "macro 'gripper': joint ${name}_joint limit lower: 0 -> ${low}", None),
        ('value="0.05"', 'value="0.06"', "property width value: 0.05 -> 0.06", None),
        ('    <link name="${name}_tip"/>\n', "", "macro 'gripper': link ${name}_tip removed",
         "programs that look up the frame '${name}_tip' do not find it"),
        ("<topicName>image<", "<topicName>picture<",
         "macro 'gripper': gazebo ${name} sensor camera plugin driver topicName: image -> picture",
         "programs that use the name 'image' do not find it"),
        ('name="gripper"', 'name="jaw"', "macro 'gripper' renamed to 'jaw'", GONE),
        ("name parent side", "name parent width side",
         "macro 'gripper': parameter width without a default added",
         "calls that do not pass it cannot be expanded"),
        ("name parent side", "name parent width mass side",
         "macro 'gripper': parameters width, mass without a default added",
         "calls that do not pass them cannot be expanded"),
        (" side:=left", "", "macro 'gripper': parameter side removed", "calls that pass it cannot be expanded"),
        ("side:=left", "side:=right", "macro 'gripper': default of parameter side left -> right", None),
        ("side:=left", "side:=left mass:=1", "macro 'gripper': parameter mass:=1 added", None),
        ("side:=left", "side", "macro 'gripper': parameter side no longer has a default",
         "calls that do not pass it cannot be expanded"),
    ],
)  # fmt: skip
def test_uncalled_macro_is_compared_as_it_is_written(library, compare, old, new, sentence, reason):
    library.write({TOOL: GRIPPER.replace(old, new, 1)})
    changes = {str(change.sentence): change for change in subject(compare(library), TOOL).changes}
    assert sentence in changes
    sentence_reason = changes[sentence].reason
    assert (None if sentence_reason is None else str(sentence_reason)) == reason


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("0.1 0.1", "0.10 .1"),
        ("${width}", "0.05"),
        ("<link name=", "<!-- other --><link  name="),
        ("width", "breadth"),
        ('upper="0.04"', 'upper="${0.08 / 2}"'),
        ('size="${width} ', 'size="${radians(degrees(width))} '),
    ],
)
def test_other_writing_of_an_uncalled_macro_is_no_change(library, compare, old, new):
    library.write({TOOL: GRIPPER.replace(old, new)})
    result = compare(library)
    assert result.subjects == []
    assert result.other_files == ([] if "other" in new else [TOOL])  # only a comment differs


def test_element_that_a_robot_shows_is_reported_once(package, compare):
    package.write({SEGMENT: MACRO.replace('mass value="2"', 'mass value="3"')})
    (review_subject,) = compare(package).subjects
    assert review_subject.path == ROBOT


def test_element_behind_a_false_condition_is_reported(package, compare):
    package.write({ROBOT: ARM.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    assert sentences(subject(compare(package), ROBOT)) == ["joint probe_joint origin xyz: 0 0 0.2 -> 0 0 0.3"]


def test_condition_around_an_element_of_all_robots_is_a_change(package, compare):
    text = MACRO.replace("<visual>", '<xacro:if value="${length > 0}"><visual>').replace(
        "</visual>", "</visual></xacro:if>"
    )
    package.write({SEGMENT: text})
    expected = "macro 'segment': link ${name} visual: condition always -> if ${length > 0}"
    assert sentences(subject(compare(package), SEGMENT)) == [expected]


def test_renamed_frame_of_an_uncalled_macro_is_breaking(library, compare):
    library.write({TOOL: GRIPPER.replace("${name}_tip", "${name}_end")})
    assert breaking(compare(library)) == ["macro 'gripper': link ${name}_end name: ${name}_tip -> ${name}_end"]


@pytest.mark.parametrize(
    ("new", "reason"),
    [
        ("<ros><remapping>~/out:=image</remapping></ros>", None),
        ("", "programs that use the name 'image' do not find it"),
    ],
)
def test_topic_that_another_tag_keeps_is_not_lost(library, compare, new, reason):
    library.write({TOOL: GRIPPER.replace("<topicName>image</topicName>", new)})
    changes = {str(change.sentence): change.reason for change in subject(compare(library), TOOL).changes}
    sensor_change = changes["macro 'gripper': gazebo ${name} sensor camera plugin driver topicName image removed"]
    assert (None if sensor_change is None else str(sensor_change)) == reason


def test_removed_plugin_of_an_uncalled_macro_is_breaking_if_it_names_topics(library, compare):
    start, end = GRIPPER.index("    <gazebo"), GRIPPER.index("  </xacro:macro>")
    library.write({TOOL: GRIPPER[:start] + GRIPPER[end:]})
    values = "sensor camera plugin driver filename=driver.so, sensor camera plugin driver topicName image"
    assert breaking(compare(library)) == [f"macro 'gripper': gazebo ${{name}} removed: {values}"]


def test_other_condition_is_a_change(library, compare):
    text = GRIPPER.replace(
        '<link name="${name}_tip"/>', '<xacro:if value="${tip}"><link name="${name}_tip"/></xacro:if>'
    )
    library.commit({TOOL: text})
    library.write({TOOL: text.replace('xacro:if value="${tip}"', 'xacro:if value="${not tip}"')})
    expected = "macro 'gripper': link ${name}_tip: condition if ${tip} -> if ${not tip}"
    assert sentences(subject(compare(library), TOOL)) == [expected]


@pytest.mark.parametrize(
    ("old", "new", "sentence", "is_breaking"),
    [
        ('  <xacro:arg name="tool" default="none"/>\n', "", "argument 'tool' removed", True),
        ('default="none"/>', 'default="none"/>\n  <xacro:arg name="paint" default="red"/>',
         "argument 'paint' added, with the default 'red'", False),
        ('default="none"', 'default="no"', "default of argument 'tool' none -> no", False),
        ('name="tool" default="none"', 'name="tool"', "argument 'tool' no longer has a default", True),
    ],
)  # fmt: skip
def test_arguments_of_a_robot_are_compared(package, compare, old, new, sentence, is_breaking):
    package.write({ROBOT: ARM.replace(old, new)})
    result = compare(package)
    assert sentence in sentences(subject(result, ROBOT))
    assert (sentence in breaking(result)) == is_breaking


def test_argument_that_moves_into_a_part_is_no_change(package, compare):
    argument = '  <xacro:arg name="tool" default="none"/>\n'
    package.write(
        {ROBOT: ARM.replace(argument, ""), SEGMENT: MACRO.replace("  <xacro:macro", f"{argument}  <xacro:macro")}
    )
    assert compare(package).subjects == []


def test_removed_and_renamed_parts_are_breaking(library, compare):
    library.commit({TOOL: None, "arm_description/urdf/jaw.xacro": GRIPPER})
    result = compare(library, "HEAD~1..HEAD")
    assert breaking(result) == [f"renamed from {TOOL}"]
    library.commit({"arm_description/urdf/jaw.xacro": None})
    result = compare(library, "HEAD~1..HEAD")
    assert breaking(result) == ["description file removed", "macro 'gripper' removed"]
    result = compare(library, "HEAD..HEAD~1")
    assert sentences(subject(result, "arm_description/urdf/jaw.xacro")) == [
        "description file added",
        (
            "macro 'gripper' added: parameters name, parent, side:=left, *origin; makes link ${name}, link ${name}_tip,"
            " joint ${name}_joint (prismatic, axis 0 1 0, limits 0 to 0.04), gazebo ${name} (sensor 'camera',"
            " plugin 'driver' (filename=driver.so, topicName image))"
        ),
    ]


def test_macro_in_another_file_breaks_only_those_who_do_not_get_it(library, compare):
    parts = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    library.write({TOOL: parts.format(""), "arm_description/urdf/jaw.xacro": GRIPPER})
    assert breaking(compare(library)) == ["macro 'gripper' moved to arm_description/urdf/jaw.xacro"]
    include = '<xacro:include filename="$(find arm_description)/urdf/jaw.xacro"/>'
    library.write({TOOL: parts.format(include)})
    assert breaking(compare(library)) == []


def test_robot_that_cannot_be_expanded_is_compared_as_it_is_written(package, compare):
    text = ARM.replace('name="tool" default="none"/>', 'name="tool" default="none"/>\n  <xacro:elsewhere/>')
    package.commit({ROBOT: text})
    package.write({ROBOT: text.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package), ROBOT)
    assert "joint probe_joint origin xyz: 0 0 0.2 -> 0 0 0.3" in sentences(review_subject)
    assert review_subject.problems


def test_part_that_is_no_longer_xml_is_breaking(package, compare):
    package.write({SEGMENT: MACRO.replace("</xacro:macro>", "")})
    (change,) = subject(compare(package), SEGMENT).changes
    assert str(change.sentence).startswith("the file can no longer be read: ")
    assert str(change.reason) == "descriptions that include the file cannot be expanded"


def test_variants_behind_conditions_are_not_taken_for_one_that_changed(library, compare):
    old = '<link name="${name}_tip"/>'
    plugin = '<ros2_control name="hand" type="system"><hardware>{}</hardware></ros2_control>'
    library.commit({TOOL: GRIPPER.replace(old, plugin.format("<plugin>mock/Hand</plugin>"))})
    variants = "".join(
        f"<xacro:if value=\"${{side == '{side}'}}\"><plugin>{side}/Hand</plugin></xacro:if>" for side in ("a", "b")
    )
    library.write({TOOL: GRIPPER.replace(old, plugin.format(variants))})
    assert sentences(subject(compare(library), TOOL)) == [
        "macro 'gripper': ros2_control hand hardware plugin mock/Hand removed",  # 'side' is neither by default
        "macro 'gripper': ros2_control hand hardware plugin a/Hand [if ${side == 'a'}] added",
    ]


def test_world_with_xacro_is_compared_as_it_is_written(library, compare):
    path = "arm_description/worlds/hall.world.xacro"
    text = '<sdf xmlns:xacro="http://www.ros.org/wiki/xacro"><world name="hall">{}</world></sdf>'
    library.commit({path: text.format("")})
    library.write({path: text.format("<wind><linear_velocity>1 0 0</linear_velocity></wind>")})
    assert sentences(subject(compare(library), path)) == ["world hall wind added: linear_velocity 1 0 0"]


def test_a_renamed_world_in_xacro_is_breaking(library, compare):
    path = "arm_description/worlds/hall.world.xacro"
    text = '<sdf xmlns:xacro="http://www.ros.org/wiki/xacro"><world name="{}"><wind/></world></sdf>'
    library.commit({path: text.format("hall")})
    library.write({path: text.format("yard")})
    assert breaking(compare(library)) == ["world yard name: hall -> yard"]


def test_handed_on_parameter_is_reported_once(library, compare):
    text = GRIPPER.replace('<link name="${name}_tip"/>', '<xacro:tip name="${name}"/>')
    library.commit({TOOL: text})
    new = text.replace("side:=left", "side:=left mass:=1").replace("<xacro:tip", '<xacro:tip mass="${mass}"')
    library.write({TOOL: new})
    assert sentences(subject(compare(library), TOOL)) == ["macro 'gripper': parameter mass:=1 added"]


def test_part_that_is_nested_too_deeply_is_a_problem(library, compare, monkeypatch):
    def read_outline(_file, _overlay):
        raise RecursionError

    monkeypatch.setattr("linkwright.review.parts.comparing.read_outline", read_outline)
    library.write({TOOL: GRIPPER.replace('upper="0.04"', 'upper="0.05"')})
    (problem,) = subject(compare(library), TOOL).problems
    assert str(problem.text) == "the versions cannot be compared: they are nested too deeply, or too large"


SENSOR_BLOCK = '<gazebo reference="${name}">\n      <sensor'


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (SENSOR_BLOCK, f'<gazebo reference="${{name}}"><mu1>1</mu1></gazebo>{SENSOR_BLOCK}',
         ["macro 'gripper': gazebo ${name} mu1 1 added"]),
        (SENSOR_BLOCK, ('<xacro:if value="${side}"><gazebo reference="${name}"><mu1>1</mu1></gazebo></xacro:if>'
                        f"{SENSOR_BLOCK}"), ["macro 'gripper': gazebo ${name} mu1 1 [if ${side}] added"]),
    ],
)  # fmt: skip
def test_added_block_of_gazebo_leaves_the_other_block_as_it_is(library, compare, old, new, expected):
    text = GRIPPER.replace("<topicName>image</topicName>", "<rate>1</rate>")
    library.commit({TOOL: text})
    library.write({TOOL: text.replace(old, new).replace("<rate>1<", "<rate>2<")})
    rate = "macro 'gripper': gazebo ${name} sensor camera plugin driver rate: 1 -> 2"
    assert sorted(sentences(subject(compare(library), TOOL))) == sorted([*expected, rate])


def test_elements_without_names_are_told_apart_by_their_attributes(library, compare):
    pairs = "".join(f'<enable_collisions link1="a" link2="b{number}"/>' for number in range(3))
    text = GRIPPER.replace('    <link name="${name}_tip"/>', f'    {pairs}<link name="${{name}}_tip"/>')
    library.commit({TOOL: text})
    library.write({TOOL: GRIPPER})
    (change,) = subject(compare(library), TOOL).changes
    assert str(change.sentence) == "macro 'gripper': enable_collisions link1=a link2=b0 removed"
    assert change.other_names == ("enable_collisions link1=a link2=b1", "enable_collisions link1=a link2=b2")


def test_link_that_the_including_robot_defines_is_not_lost(package, compare):
    """A file of macros was a copy of the robot that includes it, so that no robot could be read."""
    copy = ARM.replace("segment.xacro", "tool.xacro")
    package.commit({ROBOT: copy, TOOL: copy})
    package.write({TOOL: GRIPPER.replace('"gripper"', '"segment"')})
    assert "link 'base_link' removed" not in breaking(compare(package))
    assert "link base_link removed" not in breaking(compare(package))


def test_link_that_a_macro_makes_now_is_not_lost(library, compare):
    text = GRIPPER.replace('    <link name="${name}_tip"/>\n', '    <xacro:frame name="${name}_tip"/>\n')
    frame = '  <xacro:macro name="frame" params="name"><link name="${name}"/></xacro:macro>\n</robot>'
    library.write({TOOL: text.replace("</robot>", frame)})
    result = compare(library)
    assert "macro 'gripper': link ${name}_tip removed" in sentences(subject(result, TOOL))
    assert breaking(result) == []


HARDWARE = '<ros2_control name="${side}_${name}" type="system"><hardware><plugin>arm/Driver</plugin></hardware>'
CALLING = GRIPPER.replace(
    "</robot>",
    f"""  <xacro:macro name="driver" params="name side">{HARDWARE}</ros2_control></xacro:macro>
  <xacro:macro name="camera" params="name side"><link name="${{name}}"/></xacro:macro>
  <xacro:macro name="tool" params="side"><xacro:driver name="fast" side="left"/></xacro:macro>
</robot>""",
)


@pytest.mark.parametrize(
    ("macro", "name", "lost"),
    [
        ("driver", "slow", None),
        ("camera", "slow", "programs that use the frames and topics of 'fast' do not find them"),
        ("absent", "slow", "programs that use the frames and topics of 'fast' do not find them"),
    ],
)
def test_call_with_another_name_is_one_change(package, compare, macro, name, lost):
    text = CALLING.replace("<xacro:driver name", f"<xacro:{macro} name")
    package.commit({TOOL: text})
    package.write({TOOL: text.replace('name="fast"', f'name="{name}"')})
    found = subject(compare(package), TOOL)
    assert sentences(found) == [f"macro 'tool': {macro} slow name: fast -> slow"]
    assert [None if change.reason is None else str(change.reason) for change in found.changes] == [lost]


@pytest.mark.parametrize(
    ("macro", "reason"),
    [
        ("driver", "controllers of this hardware do not find its interfaces"),
        ("camera", "programs that use the frames and topics of 'fast' do not find them"),
    ],
)
def test_removed_call_is_breaking_by_what_the_macro_makes(package, compare, macro, reason):
    text = CALLING.replace("<xacro:driver name", f"<xacro:{macro} name")
    package.commit({TOOL: text})
    package.write({TOOL: text.replace(f'<xacro:{macro} name="fast" side="left"/>', "")})
    (change,) = subject(compare(package), TOOL).changes
    assert str(change.reason) == reason


INSIDE = """<collision>
        <xacro:if value="${side == 'left'}"><geometry><box size="1 1 1"/></geometry></xacro:if>
        <xacro:unless value="${side == 'left'}"><geometry><box size="2 2 2"/></geometry></xacro:unless>
      </collision>"""
AROUND = """<xacro:if value="${side == 'left'}">
        <collision><geometry><box size="1 1 1"/></geometry></collision>
      </xacro:if>
      <xacro:unless value="${side == 'left'}"><collision><geometry><box size="2 2 2"/></geometry></collision>
      </xacro:unless>"""


@pytest.mark.parametrize(
    ("size", "expected"),
    [("2 2 2", []), ("3 3 3", ["macro 'gripper': link ${name} collision geometry box size: 2 2 2 -> 3 3 3"])],
)
def test_conditions_that_move_around_a_collision_are_no_change(package, compare, size, expected):
    collision = '<collision><geometry><box size="${width} 0.1 0.1"/></geometry></collision>'
    package.commit({TOOL: GRIPPER.replace(collision, INSIDE)})
    package.write({TOOL: GRIPPER.replace(collision, AROUND.replace("2 2 2", size))})
    assert [line for part in compare(package).subjects for line in sentences(part)] == expected


def test_robot_that_reads_links_to_sources_uses_their_elements(tmp_path):
    """The share folder consists of links to the sources if a build file installs files at other paths."""
    (tmp_path / "source.xacro").write_text('<robot name="arm"><link name="base_link"/></robot>', encoding="utf-8")
    (tmp_path / "link.xacro").symlink_to(tmp_path / "source.xacro")
    document = read_document(str(tmp_path / "source.xacro"))
    description = SimpleNamespace(files=[tmp_path / "link.xacro"], document=document)
    version = SimpleNamespace(is_old=False, relative=lambda file: Path(file).resolve().name)
    changed = [SimpleNamespace(old_path="source.xacro", new_path="source.xacro")]
    versions = SimpleNamespace(old=version, new=version, changed_files=changed)
    (link,) = document.root.elements()
    assert ExpandedElement("source.xacro", link.offset, False) in set(
        find_expanded_elements(cast(Any, versions), cast(Any, description), cast(Any, description))
    )


def test_renamed_macros_that_call_each_other(library, compare):
    path = "arm_description/urdf/wheels.xacro"
    text = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="wheel" params="name x">
    <link name="${name}_wheel"/>
    <joint name="${name}_joint" type="fixed"><parent link="base"/><child link="${name}_wheel"/></joint>
  </xacro:macro>
  <xacro:macro name="base" params="size">
    <link name="base"/>
    <xacro:wheel name="left" x="${size}"/>
    <xacro:wheel name="right" x="-${size}"/>
  </xacro:macro>
</robot>
"""
    library.commit({path: text})
    library.write({path: text.replace('name="wheel"', 'name="my_wheel"').replace("xacro:wheel", "xacro:my_wheel")
                   .replace('name="base" params', 'name="my_base" params')})  # fmt: skip
    (change,) = subject(compare(library), path).changes
    assert str(change.sentence) == "macro 'wheel' renamed to 'my_wheel'"
    assert change.other_names == ("base -> my_base",)


@pytest.mark.parametrize(("file", "is_breaking"), [("segment.xacro", True), ("wheels.xacro", False)])
def test_removed_call_of_a_macro_from_a_file_that_does_not_exist_breaks_nobody(library, compare, file, is_breaking):
    include = f'<xacro:include filename="$(find arm_description)/urdf/{file}"/>\n  <xacro:property'
    text = GRIPPER.replace("<xacro:property", include, 1)
    call = '<xacro:wheel name="left_wheel"/>'
    library.commit({TOOL: text.replace("  </xacro:macro>", f"{call}</xacro:macro>")})
    library.write({TOOL: text})
    result = compare(library)
    assert "macro 'gripper': wheel left_wheel removed" in sentences(subject(result, TOOL))
    assert bool(breaking(result)) == is_breaking


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ('name="lidar"', 'name="lidar" rate="5"', True),
        ('name="lidar"', 'name="lidar" prefix="rear_"', False),
        ('name="lidar"', 'name="lidar_2"', False),
        ('name="imu"', 'name="imu"', False),
    ],
)
def test_second_call_of_a_macro_with_the_same_names_is_breaking(package, compare, old, new, is_breaking):
    include = '<xacro:include filename="$(find lidar_description)/lidar.xacro"/>'
    block = "<xacro:if value=\"${'$(arg tool)' == 'laser'}\"><xacro:%s %s parent=\"lower\"/></xacro:if>"
    first = include + block % ("lidar" if "lidar" in old else "imu", old)
    package.commit({ROBOT: ARM.replace("</robot>", first + "</robot>")})
    package.write({ROBOT: ARM.replace("</robot>", first + block % ("lidar", new) + "</robot>")})
    assert bool(breaking(compare(package))) == is_breaking


CELL = """<robot name="cell" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="stand.xacro"/>
  {}<xacro:stand/>
</robot>
"""
STAND = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="stand" params="">
  {}<link name="post"/><joint name="mount" type="fixed"><parent link="world"/><child link="post"/></joint>
</xacro:macro></robot>
"""
WORLD = '<link name="world"/>'


@pytest.mark.parametrize("is_moved_back", [False, True])
def test_link_that_callers_make_instead_of_a_macro_is_breaking_for_other_callers(package, compare, is_moved_back):
    folder = "arm_description/urdf"
    cells = [
        {f"{folder}/cell.urdf.xacro": CELL.format(inner), f"{folder}/stand.xacro": STAND.format(outer)}
        for inner, outer in (("", WORLD), (WORLD, ""))
    ]
    old, new = reversed(cells) if is_moved_back else cells
    package.commit(old)
    package.write(new)
    changes = [change for item in compare(package).subjects for change in item.changes if change.reason]
    if is_moved_back:
        assert changes == []
        return
    (change,) = changes
    assert str(change.sentence) == f"macro 'stand': no longer makes 'world', but {folder}/cell.urdf.xacro does"
    assert str(change.reason) == "other callers of the macro lack 'world' unless they make it"


def test_sensors_and_plugins_of_an_added_macro_are_shown(package, compare):
    sensor = """<sensor type="ray" name="laser"><update_rate>5</update_rate><visualize>${visual}</visualize>
      <plugin name="scanner" filename="libgazebo_ros_ray_sensor.so"><topicName>scan</topicName></plugin></sensor>"""
    macro = f"""<xacro:macro name="laser" params="visual:=false"><gazebo reference="laser">{sensor}</gazebo>
      <gazebo reference="base"><mu1>0.2</mu1></gazebo></xacro:macro>"""
    path = "arm_description/urdf/laser.gazebo.xacro"
    package.write({path: f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{macro}</robot>'})
    assert sentences(subject(compare(package), path))[1] == (
        "macro 'laser' added: parameters visual:=false; makes "
        "gazebo laser (sensor 'laser' (type=ray, update_rate 5, visualize ${visual}), "
        "plugin 'scanner' (filename=libgazebo_ros_ray_sensor.so, topicName scan)), gazebo base"
    )


def test_added_and_removed_materials_of_an_included_file_are_told(package, compare):
    path = "arm_description/urdf/segment.xacro"
    material = '<material name="card"><color rgba="0.5 0.25 0 1"/></material>'
    link = (
        '<link name="tray"><visual><geometry><sphere radius="0.1"/></geometry><material name="card"/></visual></link>'
    )
    joint = '<joint name="tray_joint" type="fixed"><parent link="base_link"/><child link="tray"/></joint>'
    included = MACRO.replace("</robot>", f"  {material}\n</robot>")
    package.write({path: included, ROBOT: ARM.replace("</robot>", f"{link}{joint}</robot>")})
    result = compare(package)
    assert sentences(subject(result, path)) == ["material card added: color rgba=0.5 0.25 0 1"]
    assert sentences(subject(result, ROBOT)) == [
        (
            "link 'tray' added: fixed joint 'tray_joint' at 'base_link', xyz 0 0 0 m, "
            "visual sphere 0.1 material card 0.5 0.25 0 1"
        )
    ]
    package.commit({path: included, ROBOT: ARM})
    package.write({path: MACRO})
    assert sentences(subject(compare(package), path)) == ["material card removed: color rgba=0.5 0.25 0 1"]


def test_names_that_get_the_same_prefix_are_one_line(package, compare):
    path = "arm_description/urdf/tool.xacro"
    joints = "".join(
        f'<joint name="j{number}" type="fixed"><parent link="{{0}}a{number}"/><child link="{{0}}b{number}"/></joint>'
        for number in range(2)
    )
    start = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="tool" params="prefix">'
    file = f"{start}{{}}</xacro:macro></robot>"
    package.commit({path: file.format(joints.format(""))})
    package.write({path: file.format(joints.format("${prefix}"))})
    (change,) = subject(compare(package), path).changes
    assert str(change.sentence) == "macro 'tool': joint j0 parent link: '${prefix}' added before the value"
    assert change.other_names == ("joint j0 child link", "joint j1 parent link", "joint j1 child link")


LASER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"{}>
  <xacro:arg name="side" default=""/>
  <xacro:include filename="$(find absent_package)/urdf/base.xacro"/>
  <link name="$(arg side)laser"/>
  <joint name="laser_joint" type="fixed"><parent link="base"/><child link="laser"/></joint>
  <gazebo reference="laser"><sensor type="ray" name="scanner"><update_rate>40</update_rate></sensor></gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("name", "attributes", "expected"),
    [
        ("laser.urdf.xacro", ' name="laser"', ["description added: {}"]),
        ("laser.xacro", "", ["description file added", "contains {}"]),
    ],
)
def test_added_description_that_cannot_be_expanded_shows_what_is_written_in_it(
    package, compare, name, attributes, expected
):
    path = f"arm_description/urdf/{name}"
    package.write({path: LASER.format(attributes)})
    contents = (
        "argument 'side' (default ''), includes $(find absent_package)/urdf/base.xacro, link $(arg side)laser, "
        "joint laser_joint, gazebo laser (sensor 'scanner' (type=ray, update_rate 40))"
    )
    assert sentences(subject(compare(package), path)) == [line.format(contents) for line in expected]


def test_added_file_that_a_compared_robot_reads_is_shown_by_the_robot(package, compare):
    path = "arm_description/urdf/cap.xacro"
    include = '<xacro:include filename="cap.xacro"/></robot>'
    cap = """<robot><link name="cap"/><joint name="cap_joint" type="continuous">
      <parent link="lower"/><child link="cap"/><axis xyz="0 0 -1"/></joint></robot>"""
    package.write({path: cap, ROBOT: ARM.replace("</robot>", include)})
    result = compare(package)
    assert sentences(subject(result, path)) == ["included description file added"]
    assert sentences(subject(result, ROBOT)) == [
        "link 'cap' added: continuous joint 'cap_joint' at 'lower', xyz 0 0 0 m, axis 0 0 -1"
    ]


def test_empty_argument_in_the_names_of_an_added_robot_is_shown(package, compare):
    path = "arm_description/urdf/turtle.urdf.xacro"
    text = """<robot name="turtle" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="space" default=""/>
      <link name="$(arg space)_link"/></robot>"""
    package.write({path: text})
    assert sentences(subject(compare(package), path)) == [
        "description added: argument 'space' (default '')",
        "robot 'turtle': 1 link (<space>_link)",
    ]
