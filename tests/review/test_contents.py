"""The lines of a review about the contents of changed elements.

The tests cover plugins, folders, templates and descriptions of packages.
"""

from __future__ import annotations

import pytest

from linkwright.review import open_versions, review
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

URDF = "arm/urdf/arm.urdf"
OLD_DRIVE = """<plugin name="drive" filename="libgazebo_ros_diff_drive.so">
  <ros><remapping>cmd_vel:=base/cmd</remapping></ros><rate>{rate}</rate>
</plugin>"""
NEW_DRIVE = """<plugin name="gz::sim::systems::DiffDrive" filename="gz-sim-diff-drive-system">
  <topic>base/cmd</topic><odom_topic>odom</odom_topic>
</plugin>"""


def robot_with_plugin(plugin: str) -> str:
    return f'<robot name="r"><link name="base"/><gazebo>{plugin}</gazebo></robot>'


def test_plugin_of_the_same_role_replaces_another_one(repository, compare):
    repository.commit({URDF: robot_with_plugin(OLD_DRIVE.format(rate=9))})
    repository.write({URDF: robot_with_plugin(NEW_DRIVE)})
    result = compare(repository)
    assert sentences(subject(result, URDF)) == [
        (
            "extension 'gazebo': plugin 'drive' (filename=libgazebo_ros_diff_drive.so, "
            "ros remapping cmd_vel:=base/cmd, rate 9, topics 'odom') "
            "replaced by plugin 'gz::sim::systems::DiffDrive' (filename=gz-sim-diff-drive-system, "
            "topic base/cmd, odom_topic odom)"
        )
    ]
    assert breaking(result) == []


def test_replaced_plugin_without_a_topic_is_breaking(repository, compare):
    world = '<sdf version="1.9"><world name="w">{}</world></sdf>'
    repository.commit({"arm/worlds/w.sdf": world.format(OLD_DRIVE.format(rate=9))})
    repository.write({"arm/worlds/w.sdf": world.format(NEW_DRIVE.replace("<odom_topic>odom</odom_topic>", ""))})
    result = compare(repository)
    assert [change.reason.arguments["topics"] for _, change in result.breaking_changes] == ["'odom'"]


def test_topic_in_another_parameter_of_a_plugin_is_not_lost(repository, compare):
    plugin = '<plugin name="imu" filename="libimu.so">{}</plugin>'
    repository.commit({URDF: robot_with_plugin(plugin.format("<topicName>imu</topicName>"))})
    repository.write({URDF: robot_with_plugin(plugin.format("<ros><remapping>~/out:=imu</remapping></ros>"))})
    result = compare(repository)
    assert sentences(subject(result, URDF)) == [
        "extension 'gazebo': plugin imu ros added: remapping ~/out:=imu",
        "extension 'gazebo': plugin imu topicName removed: imu",
    ]
    assert breaking(result) == []


def test_files_of_a_renamed_folder_are_one_change(repository, compare):
    files = {
        f"robots/{name}.yaml": f"{name}:\n  a: 1\n  b: {name}\n  c: 2\n  d: 3\n  e: 4\n"
        for name in ("left", "right", "rear")
    }
    repository.commit({"arm/package.xml": PACKAGE_XML, **{f"arm/config/{name}": text for name, text in files.items()}})
    moved = {f"arm/settings/{name}": text for name, text in files.items()}
    moved["arm/settings/robots/left.yaml"] = files["robots/left.yaml"].replace("a: 1", "a: 2")
    repository.write({**{f"arm/config/{name}": None for name in files}, **moved})
    repository.git("add", "-A")
    result = compare(repository)
    assert sentences(subject(result, "arm/settings/")) == breaking(result)
    assert breaking(result) == [
        "folder renamed from arm/config/ with 3 compared files: robots/left.yaml, robots/rear.yaml, robots/right.yaml"
    ]
    assert sentences(subject(result, "arm/settings/robots/left.yaml")) == ["left.a 1 -> 2"]


def test_files_that_leave_a_folder_with_other_files_are_moved(repository, compare):
    sides = ("left", "right", "rear")
    files = {f"{name}.yaml": f"{name}:\n  a: 1\n  b: {name}\n  c: 2\n  d: 3\n  e: 4\n" for name in sides}
    old = {f"arm/config/{name}": text for name, text in files.items()}
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/config/other.yaml": "a: 1\n", **old})
    moved = {f"arm/config/sides/{name}": text for name, text in files.items()}
    repository.write({**dict.fromkeys(old), **moved})
    repository.git("add", "-A")
    assert breaking(compare(repository)) == [
        "3 compared files moved from arm/config/: left.yaml, rear.yaml, right.yaml"
    ]


TEMPLATE = """<?xml version="1.0"?>
{# a model #}
<sdf version="1.6">
  <model name="{{ name }}">
    <link name="base">
      {%- if heavy < 2 %}
      <pose>0 0 1 0 0 0</pose>
      {%- endif %}
      <inertial><mass>{{ mass if mass > 1 else 1 }}</mass></inertial>
    </link>
  </model>
</sdf>
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("0 0 1 0", "0 0 2 0", "model {{ name }} link base pose: 0 0 1 0 0 0 -> 0 0 2 0 0 0 (moved by 1 m)"),
        ("else 1", "else 2",
         "model {{ name }} link base inertial mass: {{ mass if mass > 1 else 1 }} -> {{ mass if mass > 1 else 2 }}"),
    ],
)  # fmt: skip
def test_template_of_a_model_is_compared_without_its_statements(repository, compare, old, new, expected):
    path = "arm/models/arm.sdf.jinja"
    repository.commit({path: TEMPLATE})
    repository.write({path: TEMPLATE.replace(old, new)})
    (change,) = subject(compare(repository), path).changes
    assert str(change.sentence) == expected


MACROS = """<?xml version="1.0"? encoding="utf-8">
{%- macro gear(mass, name="a") -%}
  {% set k = 27.2 %}{# grams #}
  <link name="wheel">
    <inertial><mass>2.0</mass></inertial>
  </link>
  <!-- {% set unused = 1 %} -->
  <plugin name="drive {%- set x = 1 -%}" filename="libdrive.so"/>
{%- endmacro -%}
{% macro cap() %}<link name="cap"><pose>0 0 1 0 0 0</pose></link>{% endmacro %}
<sdf version="1.6"><model name="m"><static>{{ gear(3) }}</static></model></sdf>
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "line"),
    [
        ("27.2", "29 / 2", "macro gear set k: 27.2 -> 29 / 2", 3),
        ("k = 27.2", "k =\n '<a>'", "macro gear set k: 27.2 -> '<a>'", 3),
        ("(mass, name", "(mass, b, name", "macro gear @parameters: mass, name='a' -> mass, b, name='a'", 2),
        ("2.0", "3.0", "macro gear link wheel inertial: mass 2 -> 3 kg", 5),
        ('name="cap"', 'name="hood"', "macro cap link cap renamed to 'hood'", 10),
        ("libdrive.so", "libgo.so", "macro gear plugin drive @filename: libdrive.so -> libgo.so", 8),
        ("gear(3)", "gear(4)", "model m static: {{ gear(3) }} -> {{ gear(4) }}", 11),
    ],
)
def test_macros_and_variables_of_a_template_are_compared(repository, compare, old, new, expected, line):
    assert MACROS.count(old) == 1
    path = "arm/models/arm.sdf.jinja"
    repository.commit({path: MACROS})
    repository.write({path: MACROS.replace(old, new)})
    (change,) = subject(compare(repository), path).changes
    assert str(change.sentence) == expected
    assert change.location is not None
    assert change.location.line == line


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("<link name='wheel'><pose>1</pose></link>", "<link name='{{ part }}'><pose>1</pose></link>"),
        ("{% macro n() %}<plugin name='q' filename='libq.so'><topic>a</topic></plugin>{% endmacro %}", ""),
        (
            "{% macro m() %}{% set frame_sensor = 'a' %}{% endmacro %}",
            "{% macro m() %}{% set frame_sensor = 'b' %}{% endmacro %}",
        ),
    ],
)
def test_name_that_a_template_may_keep_is_not_breaking(repository, compare, old, new):
    path = "arm/models/arm.sdf.jinja"
    text = f"<sdf>{old}</sdf>"
    repository.commit({path: text})
    repository.write({path: text.replace(old, new)})
    result = compare(repository)
    assert (len(subject(result, path).changes), breaking(result)) == (1, [])


def test_quotes_around_texts_in_a_template_make_no_difference(repository, compare):
    path = "arm/models/arm.sdf.jinja"
    text = """<sdf>{% set a = "b" + '"c"' %}{% macro m(a="b") %}<static>{{ a + "c" }}</static>{% endmacro %}</sdf>"""
    repository.commit({path: text})
    repository.write({path: text.replace('"b"', "'b'").replace(' "c"', " 'c'")})
    assert list(compare(repository).subjects) == []


@pytest.mark.parametrize("suffix", [".sdf.jinja", ".world.em", ".world.template"])
def test_template_in_which_no_difference_is_found_is_listed(repository, compare, suffix):
    path = f"arm/models/arm{suffix}"
    text = "<sdf>\n@# one\n{% if a %}\n<model name='a'/>\n{% endif %}\n</sdf>\n"
    repository.commit({path: text})
    repository.write({path: text.replace("one", "two").replace("if a", "if b")})
    result = compare(repository)
    assert (list(result.subjects), result.other_files) == ([], [path])


def test_template_that_is_not_xml_is_a_problem(repository, compare):
    path = "arm/models/arm.sdf.jinja"
    repository.commit({path: "<sdf>{% if a %}<model name='a'>{% else %}<model name='b'>{% endif %}</model></sdf>"})
    repository.write({path: "<sdf>{% if a %}<model name='a'>{% else %}<model name='c'>{% endif %}</model></sdf>"})
    assert len(subject(compare(repository), path).problems) == 1


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("<b>arm</b>", "<b>crane</b>", ["description: An arm. See x. -> An crane. See x."]),
        ("<b>arm</b>", "<i>arm</i>", ["markup of the description changed"]),
        ("http://x", "http://y", ["markup of the description changed"]),
        ("<b>arm</b>.", "<b>arm</b>.\n   ", []),
    ],
)
def test_description_of_a_package_is_compared_as_text(repository, compare, old, new, expected):
    text = PACKAGE_XML.replace("An arm.", '<p>An <b>arm</b>.</p><p>See <a href="http://x">x</a>.</p>')
    repository.commit({"arm/package.xml": text})
    repository.write({"arm/package.xml": text.replace(old, new)})
    assert [sentence for each in compare(repository).subjects for sentence in sentences(each)] == expected


LIBRARY = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="tool" params=""><link name="{name}"/></xacro:macro>
</robot>
"""
ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">
  <xacro:include filename="$(find library)/tool.xacro"/>
  <xacro:tool/>
</robot>
"""


def test_nearest_copy_of_a_package_is_used(repository, compare):
    files = {}
    for folder in ("one", "two"):
        files[f"{folder}/library/package.xml"] = PACKAGE_XML.replace("arm_description", "library")
        files[f"{folder}/library/tool.xacro"] = LIBRARY.format(name=folder)
        files[f"{folder}/robot/package.xml"] = PACKAGE_XML.replace("arm_description", f"robot_{folder}")
        files[f"{folder}/robot/arm.urdf.xacro"] = ROBOT
    repository.commit(files)
    repository.write({"two/library/tool.xacro": LIBRARY.format(name="three")})
    (found,) = compare(repository).subjects
    assert found.path == "two/robot/arm.urdf.xacro"
    assert sentences(found)[0] == "root link 'two' -> 'three'"


def test_changed_collisions_have_images(repository):
    shape = '<collision><geometry><box size="{} 1 1"/></geometry></collision>'
    text = f'<robot name="r"><link name="base">{shape}</link></robot>'
    repository.commit({URDF: text.format(1)})
    repository.write({URDF: text.format(2)})
    versions = open_versions(repository.root, "HEAD")
    try:
        result = review(versions, with_images=True)
    finally:
        versions.close()
    views = subject(result, URDF).images
    assert [view.name for view in views] == ["iso, collision", "front, collision"]
    assert views[0].old != views[0].new


INTERFACES = """<robot name="r"><link name="base"/><ros2_control name="{name}" type="system">
  <joint name="a">{interface}</joint><joint name="b">{interface}</joint>
</ros2_control></robot>
"""


def test_interface_that_all_joints_gain_is_one_change(repository, compare):
    repository.commit({URDF: INTERFACES.format(name="arm", interface='<state_interface name="position"/>')})
    interfaces = '<state_interface name="position"/><state_interface name="effort"/>'
    repository.write({URDF: INTERFACES.format(name="arm", interface=interfaces)})
    (change,) = subject(compare(repository), URDF).changes
    assert str(change.sentence) == "extension 'ros2_control arm': joint a state_interface effort added"
    assert change.other_names == ("joint b",)


def test_numbered_interfaces_that_take_the_place_of_an_array_are_not_lost(repository, compare):
    repository.commit({URDF: INTERFACES.format(name="arm", interface='<command_interface name="out" size="4"/>')})
    interfaces = "".join(f'<command_interface name="out_{index}" data_type="bool"/>' for index in range(4))
    repository.write({URDF: INTERFACES.format(name="arm", interface=interfaces)})
    result = compare(repository)
    assert sentences(subject(result, URDF)) == [
        "extension 'ros2_control arm': joint a command_interface out size=4 -> out_0 to out_3 data_type=bool"
    ]
    assert not result.breaking_changes


def test_array_of_interfaces_whose_last_item_has_no_name_is_lost(repository, compare):
    repository.commit({URDF: INTERFACES.format(name="arm", interface='<command_interface name="out" size="4"/>')})
    interfaces = "".join(f'<command_interface name="out_{index}"/>' for index in range(3))
    repository.write({URDF: INTERFACES.format(name="arm", interface=interfaces)})
    (change,) = [change for _, change in compare(repository).breaking_changes]
    assert str(change.sentence) == "extension 'ros2_control arm': joint a command_interface out removed: size=4"


CALLS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="pair" params="">
  <xacro:wheel prefix="left" {more}/><xacro:wheel prefix="right" {more}/><xacro:tower side="front" {more}/>
</xacro:macro></robot>
"""


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ('size="1"', [("wheel size 1", ("tower size",))]),
        ('size="1" mass="2"', [("wheel prefix=left: size 1, mass 2", ("wheel prefix=right",)),
                             ("tower side=front: size 1, mass 2", ())]),
    ],
)  # fmt: skip
def test_values_that_a_call_gains_or_loses_are_one_line(repository, compare, more, expected):
    path = "arm/urdf/pair.xacro"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: CALLS.replace("{more}", "")})
    repository.write({path: CALLS.replace("{more}", more)})
    added = subject(compare(repository), path).changes
    lines = [(f"macro 'pair': {text} added", names) for text, names in expected]
    assert [(str(change.sentence), change.other_names) for change in added] == lines
    repository.commit({path: CALLS.replace("{more}", more)})
    repository.write({path: CALLS.replace("{more}", "")})
    removed = subject(compare(repository), path).changes
    assert [str(change.sentence) for change in removed] == [line.replace("added", "removed") for line, _ in lines]


@pytest.mark.parametrize(("old_file", "is_kept"), [("", True), ("  speed: 2\n", False)])
def test_an_added_file_that_is_a_copy_names_the_other_one(repository, compare, old_file, is_kept):
    text = "arm:\n  ros__parameters:\n" + "".join(f"    gain_{number}: {number}.5\n" for number in range(9))
    repository.commit({"a/config/left.yaml": text})
    repository.write({"a/config/left.yaml": f"{text}{old_file}", "a/config/right.yaml": text})
    copied = "a copy of a/config/left.yaml" if is_kept else "a copy of the old a/config/left.yaml"
    assert sentences(subject(compare(repository), "a/config/right.yaml")) == [f"parameter file added: {copied}"]
