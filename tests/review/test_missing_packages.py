"""Robots that include packages and files that are not found."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/arm.urdf.xacro"
SENSOR = """  <xacro:include filename="$(find lidar_description)/urdf/lidar.xacro"/>
  <xacro:lidar parent="lower" rate="10"><origin xyz="0 0 1"/></xacro:lidar>
  <link name="bracket"/>
  <joint name="bracket_joint" type="fixed">
    <parent link="lidar_base"/>
    <child link="bracket"/>
    <origin xyz="0 0 0.1"/>
  </joint>
  <link name="cover">
    <visual><origin xyz="0 0 ${lidar_height}"/><geometry><sphere radius="0.1"/></geometry></visual>
  </link>
  <joint name="cover_joint" type="fixed"><parent link="lower"/><child link="cover"/></joint>
</robot>"""
WITH_SENSOR = ARM.replace("</robot>", SENSOR)


QUARTER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="quarter" value="0.25"/>
</robot>"""


@pytest.fixture
def sensor_package(package):
    package.commit({PATH: WITH_SENSOR})
    return package


def note_texts(result) -> list[str]:
    return [str(note) for note in result.notes]


def test_rest_of_robot_is_compared_with_one_note(sensor_package, compare):
    sensor_package.write({PATH: WITH_SENSOR.replace('xyz="0 0 0.1"', 'xyz="0 0 0.2"')})
    result = compare(sensor_package)
    review_subject = subject(result, PATH)
    assert sentences(review_subject) == ["joint 'bracket_joint': origin xyz 0 0 0.1 -> 0 0 0.2 m (moved by 0.1 m)"]
    assert [str(problem.text) for problem in review_subject.problems] == [
        "values that need definitions of missing files are not compared: 'cover'"
    ]
    assert review_subject.figures == []
    assert note_texts(result) == [
        f"'{PATH}' is compared without the packages and files that are not found: 'lidar_description'"
    ]


@pytest.mark.parametrize("is_added", [True, False])
def test_values_that_a_call_of_a_missing_macro_may_define_are_not_compared(package, compare, is_added):
    include = '<xacro:include filename="$(find lidar_description)/urdf/lidar.xacro"/>'
    joint = '<joint name="mast_joint" type="fixed"><parent link="lower"/><child link="mast"/></joint>'
    link = f'<link name="mast">{{}}</link>{joint}'
    inertial = '<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'
    texts = [
        ARM.replace("</robot>", include + link.format(content) + "</robot>")
        for content in (inertial, '<xacro:box_inertia mass="1"/>')
    ]
    old, new = texts if is_added else reversed(texts)
    package.commit({PATH: old})
    package.write({PATH: new, "arm_description/urdf/segment.xacro": MACRO.replace('effort="10"', 'effort="20"')})
    review_subject = subject(compare(package), PATH)
    assert ["limit effort" in sentence for sentence in sentences(review_subject)] == [True]
    assert [str(problem.text) for problem in review_subject.problems] == [
        "values that need definitions of missing files are not compared: 'mast'"
    ]


def test_note_does_not_call_a_file_missing_that_both_versions_have(package, compare):
    right = '<xacro:include filename="$(find arm_description)/urdf/colors.xacro"/>'
    text = ARM.replace("</robot>", right + "</robot>")
    colors = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><material name="red"/></robot>'
    package.commit({PATH: text.replace("/urdf/colors", "/colors"), "arm_description/urdf/colors.xacro": colors})
    package.write({PATH: text})
    result = compare(package)
    assert note_texts(result) == [
        f"'{PATH}' is compared without the packages and files that are not found: 'colors.xacro'"
    ]
    assert [str(finding.message) for finding in result.fixed_findings]


def test_values_of_a_call_of_a_missing_macro_are_compared(sensor_package, compare):
    sensor_package.write({PATH: WITH_SENSOR.replace('rate="10"', 'rate="20"')})
    assert sentences(subject(compare(sensor_package), PATH)) == ["call of macro 'lidar': @rate 10 -> 20"]


def test_equal_rest_is_not_reported(sensor_package, compare):
    sensor_package.write(
        {"arm_description/urdf/segment.xacro": MACRO.replace("<mass value", "<!-- heavy --><mass value")}
    )
    result = compare(sensor_package)
    assert sentences(subject(result, PATH)) == []
    assert breaking(result) == []


def test_value_that_only_one_version_can_evaluate_is_not_a_change(sensor_package, compare):
    text = WITH_SENSOR.replace("${lidar_height}", "0.3")
    sensor_package.write({PATH: text})
    assert sentences(subject(compare(sensor_package), PATH)) == []


def test_part_that_moves_into_missing_package_is_not_called_removed(package, compare):
    robot_with_lidar = ARM.replace(
        "</robot>",
        '<link name="lidar"/><joint name="lidar_joint" type="fixed"><parent link="lower"/>'
        '<child link="lidar"/></joint></robot>',
    )
    package.commit({PATH: robot_with_lidar})
    package.write({PATH: WITH_SENSOR})
    result = compare(package)
    assert breaking(result) == []
    found = sentences(subject(result, PATH))
    assert "link 'lidar' removed" not in found
    assert "link 'lidar' removed, unless a missing package defines it" in found
    assert "joint 'lidar_joint' removed, unless a missing package defines it" in found
    assert not any("lidar_base" in text or " to " in text for text in found if "unless" in text)


def test_parts_of_a_file_that_the_new_version_does_not_find_have_no_lines(package, compare):
    include = '<xacro:include filename="$(find arm_description)/urdf/lidar.xacro"/>'
    lidar = '<joint name="lidar_joint" type="fixed"><parent link="lower"/><child link="lidar"/></joint>'
    lidar = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="lidar"/>{lidar}</robot>'
    text = ARM.replace("</robot>", include + "</robot>")
    package.commit({PATH: text, "arm_description/urdf/lidar.xacro": lidar})
    package.write(
        {PATH: text.replace(include, include.replace("$(find arm_description)", "package://arm_description"))}
    )
    result = compare(package)
    path = "arm_description/urdf/package://arm_description/urdf/lidar.xacro"
    assert breaking(result) == [f"no such file: '{path}'"]
    assert [text for text in sentences(subject(result, PATH)) if "removed" in text] == []


def test_plugin_that_a_call_of_a_missing_macro_may_replace_is_told(sensor_package, compare):
    plugin = '<plugin name="imu" filename="libgazebo_ros_imu.so"><topicName>imu</topicName></plugin>'
    text = WITH_SENSOR.replace("</robot>", f"<gazebo>{plugin}</gazebo></robot>")
    sensor_package.commit({PATH: text})
    call = '<xacro:lidar parent="upper" rate="5"><origin xyz="0 0 2"/></xacro:lidar></robot>'
    sensor_package.write({PATH: WITH_SENSOR.replace("</robot>", call)})
    (found,) = [text for text in sentences(subject(compare(sensor_package), PATH)) if "unless" in text]
    assert found == (
        "extension 'gazebo' removed: plugin 'imu' (filename=libgazebo_ros_imu.so, topicName imu), "
        "unless a missing package defines it"
    )


def test_package_that_commit_removes_is_not_left_out(package, compare):
    package.commit(
        {
            "lidar_description/package.xml": "<package format='3'><name>lidar_description</name></package>",
            "lidar_description/urdf/lidar.xacro": "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'>"
            "<xacro:property name='lidar_height' value='1'/><xacro:macro name='lidar' params='parent rate *origin'>"
            "<link name='lidar_base'/><joint name='lidar_joint' type='fixed'><parent link='${parent}'/>"
            "<child link='lidar_base'/></joint></xacro:macro></robot>",
            PATH: WITH_SENSOR,
        }
    )
    package.commit({"lidar_description/package.xml": None, "lidar_description/urdf/lidar.xacro": None})
    result = compare(package, "HEAD~1..HEAD")
    assert any("can no longer be read" in sentence and "lidar_description" in sentence for sentence in breaking(result))


def test_package_that_only_the_working_tree_contains_is_missing_in_earlier_commits(sensor_package, compare):
    """A package that git ignores, such as a download of another repository, is found."""
    sensor_package.commit({PATH: WITH_SENSOR.replace('xyz="0 0 0.1"', 'xyz="0 0 0.2"'), ".gitignore": "/downloads"})
    sensor = {
        "package.xml": "<package format='3'><name>lidar_description</name></package>",
        "urdf/lidar.xacro": QUARTER.replace("quarter", "lidar_height"),
    }
    missing = f"'{PATH}' is compared without the packages and files that are not found: 'lidar_description'"
    sensor_package.commit({f"lidar/{name}": text for name, text in sensor.items()})
    assert missing in note_texts(compare(sensor_package, "HEAD~2..HEAD~1"))
    sensor_package.commit({f"lidar/{name}": None for name in sensor})
    sensor_package.write({f"downloads/lidar/{name}": text for name, text in sensor.items()})
    assert missing not in note_texts(compare(sensor_package, "HEAD~3..HEAD~2"))


def test_file_that_neither_version_has_is_left_out(package, compare):
    text = ARM.replace("</robot>", '<xacro:include filename="absent.xacro"/><xacro:absent/></robot>')
    package.commit({PATH: text})
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace('mass value="2"', 'mass value="3"')})
    result = compare(package)
    assert "link 'upper': inertial mass 2 -> 3 kg" in sentences(subject(result, PATH))
    assert "'absent.xacro'" in note_texts(result)[0]


def test_mistake_beside_missing_package_is_breaking(sensor_package, compare):
    sensor_package.write(
        {PATH: WITH_SENSOR.replace('<link name="bracket"/>', '<link name="bracket"/><link name="bracket"/>')}
    )
    ((_, change),) = compare(sensor_package).breaking_changes
    assert "link 'bracket' is defined twice" in change.sentence
    assert (change.location.file, change.location.line) == (PATH, 19)


def test_misspelled_name_in_robot_without_missing_files_is_reported(package, compare):
    package.write({PATH: ARM.replace('parent="upper"', 'parent="${uper}"')})
    (sentence,) = breaking(compare(package))
    assert "the property 'uper' is not defined" in sentence


def test_unreadable_robots_that_did_not_change_are_counted_in_a_note(package, compare):
    broken = ARM.replace("</robot>", "${missing}</robot>")
    package.commit({PATH: broken, "arm_description/urdf/second.urdf.xacro": broken})
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace('mass value="2"', 'mass value="3"')})
    result = compare(package)
    (review_subject,) = result.subjects
    assert review_subject.path == "arm_description/urdf/segment.xacro"
    (note,) = note_texts(result)
    assert note.startswith("2 files that the changes may affect are not compared, such as ")
    assert "the property 'missing' is not defined" in note


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("", ["call of macro 'lidar front' removed: parent=lower"]),
        ('<xacro:lidar name="back" parent="lower"/>', ["call of macro 'lidar front' removed: parent=lower"]),
        ('<xacro:laser name="front" parent="lower"/>', []),
        ('<xacro:lidar name="front" parent="upper"/>', []),
    ],
)
def test_removed_call_of_a_macro_of_a_missing_package_is_breaking(package, compare, new, expected):
    assert review_calls(package, compare, '<xacro:lidar name="front" parent="lower"/>', new) == expected


def review_calls(package, compare, old: str, new: str) -> list[str]:
    """Return the breaking lines of a robot whose call of a macro of a missing package changes."""
    include = '<xacro:include filename="$(find lidar_description)/urdf/lidar.xacro"/>'
    package.commit({PATH: ARM.replace("</robot>", f"{include}{old}</robot>")})
    package.write({PATH: ARM.replace("</robot>", f"{include}{new}</robot>")})
    return breaking(compare(package))


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ('<xacro:zed prefix="left_zed" parent="lower"/>', "", True),
        ('<xacro:zed prefix="left_zed" parent="lower"/>', '<xacro:zed2 prefix="left_zed" parent="lower"/>', False),
        ('<xacro:zed prefix="low" parent="lower"/>', "", False),
        ('<xacro:zed prefix="left_zed"/>', "", False),
        ('<xacro:zed prefix="" parent="lower"/>', "", False),
    ],
)
def test_removed_call_of_a_macro_that_names_a_part_by_a_prefix_is_breaking(package, compare, old, new, is_breaking):
    assert bool(review_calls(package, compare, old, new)) is is_breaking


def test_topic_that_a_call_of_a_missing_macro_newly_passes_may_be_breaking(sensor_package, compare):
    for attribute, is_breaking in (('topic="scan"', True), ('rate_limit="5"', False)):
        sensor_package.write({PATH: WITH_SENSOR.replace('rate="10"', f'rate="10" {attribute}')})
        assert bool(breaking(compare(sensor_package))) is is_breaking


def test_value_that_needs_a_file_which_only_the_new_version_misses_is_not_compared(package, compare):
    include = '<xacro:include filename="$(find lidar_description)/urdf/lidar.xacro"/>'
    call = '<xacro:lidar name="front" parent="lower" angle="${2 * quarter}"/>'
    angle = '<xacro:include filename="$(find arm_description)/urdf/angle.xacro"/>'
    package.commit(
        {
            PATH: ARM.replace("</robot>", angle + include + call + "</robot>"),
            "arm_description/urdf/angle.xacro": QUARTER,
        }
    )
    package.write({PATH: ARM.replace("</robot>", angle.replace("arm_d", "angles_d") + include + call + "</robot>")})
    review_subject = subject(compare(package), PATH)
    assert [line for line in sentences(review_subject) if "lidar front" in line] == []
    assert [str(problem.text) for problem in review_subject.problems] == [
        "values that need definitions of missing files are not compared: 'lidar front'"
    ]


def test_color_of_a_material_that_a_missing_file_may_define_is_not_lost(package, compare):
    visual = '<visual><geometry><sphere radius="1"/></geometry><material name="white">COLOR</material></visual>'
    joint = '<joint name="lid_joint" type="fixed"><parent link="lower"/><child link="lid"/></joint>'
    text = ARM.replace("</robot>", f'<link name="lid">{visual}</link>{joint}</robot>')
    package.commit({PATH: text.replace("COLOR", '<color rgba="1 1 1 1"/>')})
    include = '<xacro:include filename="$(find paint_description)/urdf/materials.xacro"/>'
    package.write({PATH: text.replace("COLOR", "").replace("</robot>", include + "</robot>")})
    assert [line for item in compare(package).subjects for line in sentences(item) if "color" in line] == []


def test_other_file_of_a_missing_package_is_reported_as_it_is_written(sensor_package, compare):
    sensor_package.write({PATH: WITH_SENSOR.replace("urdf/lidar.xacro", "urdf/lidar_v2.xacro")})
    folder = "$(find lidar_description)/urdf"
    assert sentences(subject(compare(sensor_package), PATH)) == [
        f"include filename: {folder}/lidar.xacro -> {folder}/lidar_v2.xacro"
    ]
