"""Changes of descriptions in a review.

The tests cover arguments, moved parts, breaking changes, unreadable files.
"""

from __future__ import annotations

import pytest

from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/arm.urdf.xacro"
LAUNCH = """from launch import LaunchDescription
from launch.substitutions import Command, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    description = Command(["xacro ", model, " tool:=probe"])
    return LaunchDescription(
        [Node(package="robot_state_publisher", executable="robot_state_publisher",
              parameters=[{"robot_description": description}])]
    )
"""


def test_changed_macro_changes_robots_that_include_it(package, compare):
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace("length:=0.5", "length:=0.6")})
    result = compare(package)
    (review_subject,) = [item for item in result.subjects if item.kind.value == "description"]
    assert review_subject.path == PATH
    assert "joint 'upper_joint': origin xyz 0 0 0.5 -> 0 0 0.6 m (moved by 0.1 m)" in sentences(review_subject)
    change = next(change for change in review_subject.changes if "upper_joint" in change.sentence)
    assert (change.location.file, change.location.line) == ("arm_description/urdf/segment.xacro", 14)
    figures = {str(figure.name): (figure.old, figure.new, figure.unit) for figure in review_subject.figures}
    assert figures["size"] == ("0.1 x 0.1 x 1.5", "0.1 x 0.1 x 1.8", "m")
    assert float(figures["reach of 'lower'"][1]) == pytest.approx(1.8, abs=0.05)
    assert result.breaking_changes == []


def test_rotation_is_reported_in_degrees(package, compare):
    package.write(
        {
            "arm_description/urdf/segment.xacro": MACRO.replace(
                '${length}"/>\n      <axis', '${length}" rpy="0 0 1.5707963268"/>\n      <axis'
            )
        }
    )
    assert any("(rotated by 90°)" in sentence for sentence in sentences(subject(compare(package), PATH)))


@pytest.mark.parametrize(("angle", "is_reported"), [("3.14159", False), ("3.1415", True)])
def test_rounded_pi_is_no_change(package, compare, angle, is_reported):
    text = MACRO.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 1 0"/><!-- turned -->')
    origin = '<origin xyz="0 0 ${length}" rpy="0 0 %s"/>'
    turned = text.replace('<origin xyz="0 0 ${length}"/>', origin)
    package.commit({"arm_description/urdf/segment.xacro": turned % "${pi}"})
    package.write({"arm_description/urdf/segment.xacro": turned % angle})
    assert (
        any("rotated" in sentence for item in compare(package).subjects for sentence in sentences(item)) == is_reported
    )


def test_equal_robot_is_not_reported(package, compare):
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace("<mass value", "<!-- heavy --><mass value")})
    result = compare(package)
    assert (result.subjects, result.other_files) == ([], [])


def test_argument_sets_of_callers_are_compared(package, compare):
    package.commit({"arm_description/launch/arm.launch.py": LAUNCH})
    package.write({PATH: ARM.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package), PATH)
    assert review_subject.cases == ["tool:=probe"]
    assert sentences(review_subject) == ["joint 'probe_joint': origin xyz 0 0 0.2 -> 0 0 0.3 m (moved by 0.1 m)"]


def test_change_with_some_arguments_names_them(package, compare):
    package.commit(
        {
            "arm_description/launch/arm.launch.py": LAUNCH,
            "arm_description/launch/plain.launch.py": LAUNCH.replace("tool:=probe", "tool:=none"),
        }
    )
    package.write({PATH: ARM.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')})
    review_subject = subject(compare(package), PATH)
    assert review_subject.cases == ["tool:=probe", "tool:=none"]
    assert [change.cases for change in review_subject.changes] == [("tool:=probe",)]


FOOTPRINT = """<link name="base_footprint"/>
  <joint name="foot" type="fixed"><parent link="base_footprint"/><child link="base_link"/></joint>
  <link name="base_link"/>"""
CAMERA = """<link name="camera"/>
  <joint name="camera_joint" type="fixed"><parent link="lower"/><child link="camera"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('name="lower"', 'name="forearm"', "link 'lower' renamed to 'forearm'"),
        ('  <xacro:segment name="lower" parent="middle"/>\n', "", "joint 'lower_joint' removed"),
        ('<link name="base_link"/>', FOOTPRINT,
         "root link 'base_link' -> 'base_footprint' (both robots are compared in the frame of 'base_link')"),
    ],
)  # fmt: skip
def test_renamed_and_removed_elements_are_breaking(package, compare, old, new, sentence):
    package.write({PATH: ARM.replace(old, new)})
    result = compare(package)
    assert sentence in breaking(result)
    assert all(change.reason for _, change in result.breaking_changes)


def test_renamed_link_that_moved_has_the_distance(package, compare):
    camera = """<link name="camera"><visual><geometry><mesh filename="package://arm_description/c.stl"/></geometry></visual></link>
  <joint name="camera_joint" type="fixed"><parent link="lower"/><child link="camera"/></joint></robot>"""
    package.commit({PATH: ARM.replace("</robot>", camera)})
    moved = camera.replace('"camera', '"head').replace("<parent", '<origin xyz="0 0 0.3"/><parent')
    package.write({PATH: ARM.replace("</robot>", moved)})
    result = compare(package)
    assert sentences(subject(result, PATH)) == [
        "link 'camera' renamed to 'head' (moved by 0.3 m)",
        "joint 'camera_joint' renamed to 'head_joint'",
        "joint 'head_joint': origin xyz 0 0 0 -> 0 0 0.3 m (moved by 0.3 m)",
    ]
    assert breaking(result) == ["link 'camera' renamed to 'head' (moved by 0.3 m)"]


def test_renamed_link_that_rotated_has_the_angle(package, compare):
    camera = """<link name="camera"><visual><geometry><mesh filename="package://arm_description/c.stl"/></geometry></visual></link>
  <joint name="camera_joint" type="fixed"><parent link="lower"/><child link="camera"/></joint></robot>"""
    package.commit({PATH: ARM.replace("</robot>", camera)})
    turned = camera.replace('"camera', '"head').replace("<parent", '<origin rpy="0 0 1.5707963"/><parent')
    package.write({PATH: ARM.replace("</robot>", turned)})
    assert breaking(compare(package)) == ["link 'camera' renamed to 'head' (rotated by 90°)"]


HEAD = """<link name="mast"/>
  <joint name="mast_joint" type="fixed"><origin xyz="0 0 1"/><parent link="base_link"/><child link="mast"/></joint>
  <link name="head"/>
  <joint name="{joint}" type="{type}"><origin xyz="{xyz}"/><parent link="{at}"/><child link="head"/></joint>
</robot>"""


@pytest.mark.parametrize(
    ("joint", "xyz", "expected"),
    [
        ("head_joint", "0 0 0.25",
         ["joint 'head_joint': parent base_link -> mast (the same pose)",
          "joint 'head_joint': origin xyz 0 0 1.25 -> 0 0 0.25 m"]),
        ("head_mount", "0 0 0.5",
         ["joint 'head_joint' renamed to 'head_mount'",
          "joint 'head_mount': parent base_link -> mast (moved by 0.25 m)",
          "joint 'head_mount': origin xyz 0 0 1.25 -> 0 0 0.5 m"]),
        ("head_mount", "0 0 1.25",
         ["joint 'head_joint' renamed to 'head_mount'",
          "joint 'head_mount': parent base_link -> mast (moved by 1 m)"]),
    ],
)  # fmt: skip
def test_link_below_another_parent_has_the_distance_by_which_it_moved(package, compare, joint, xyz, expected):
    old = HEAD.format(joint="head_joint", type="fixed", at="base_link", xyz="0 0 1.25")
    package.commit({PATH: ARM.replace("</robot>", old)})
    new = HEAD.format(joint=joint, type="fixed", at="mast", xyz=xyz)
    package.write({PATH: ARM.replace("</robot>", new)})
    assert sentences(subject(compare(package), PATH)) == expected


def test_joints_that_exchange_their_names_have_no_distances(package, compare):
    joint = """<joint name="{}" type="fixed"><origin xyz="0 0 {}"/><parent link="{}"/><child link="{}"/></joint>"""
    links = '<link name="pan"/><link name="tilt"/>'
    old = joint.format("a", 1, "base_link", "pan") + joint.format("b", 2, "pan", "tilt")
    new = joint.format("b", 1, "base_link", "pan") + joint.format("a", 2, "pan", "tilt")
    package.commit({PATH: ARM.replace("</robot>", f"{links}{old}</robot>")})
    package.write({PATH: ARM.replace("</robot>", f"{links}{new}</robot>")})
    result = sentences(subject(compare(package), PATH))
    assert "joint 'a': origin xyz 0 0 1 -> 0 0 2 m" in result
    assert not any("moved by" in sentence or "pose" in sentence for sentence in result)


def test_added_joint_that_replaces_another_one_is_told_with_its_place(package, compare):
    old = HEAD.format(joint="head_joint", type="fixed", at="base_link", xyz="0 0 1.25")
    package.commit({PATH: ARM.replace("</robot>", old)})
    new = HEAD.format(joint="head_tilt", type="floating", at="mast", xyz="0 0 0.5")
    package.write({PATH: ARM.replace("</robot>", new)})
    assert sentences(subject(compare(package), PATH)) == [
        "joint 'head_tilt' added: floating, link 'head' at 'mast', xyz 0 0 0.5 m",
        "joint 'head_joint' removed",
    ]


def test_renamed_moving_joint_that_moved_is_breaking(package, compare):
    text = MACRO.replace('"${name}_joint"', "\"${name + '_axis' if name == 'lower' else name + '_joint'}\"")
    package.write({"arm_description/urdf/segment.xacro": text.replace("length:=0.5", "length:=0.6")})
    assert breaking(compare(package)) == ["joint 'lower_joint' renamed to 'lower_axis'"]


LIFTED = """<link name="foot"/><joint name="foot_joint" type="fixed"><parent link="foot"/><child link="base_link"/>
    <origin xyz="0 0.1 0.3" rpy="0 0 1"/></joint><link name="base_link"/>"""


def test_added_root_link_changes_no_figure_of_the_rest(package, compare):
    package.write({PATH: ARM.replace('<link name="base_link"/>', LIFTED)})
    review_subject = subject(compare(package), PATH)
    assert {str(figure.name) for figure in review_subject.figures} == {"links", "joints"}


def test_removed_root_link_changes_no_figure_of_the_rest(package, compare):
    package.commit({PATH: ARM.replace('<link name="base_link"/>', LIFTED)})
    package.write({PATH: ARM})
    review_subject = subject(compare(package), PATH)
    assert {str(figure.name) for figure in review_subject.figures} == {"links", "joints"}
    assert sentences(review_subject)[0] == (
        "root link 'foot' -> 'base_link' (both robots are compared in the frame of 'base_link')"
    )


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('tool" default="none"', 'tool" default="probe"'),
        ("</robot>", CAMERA),
    ],
)  # fmt: skip
def test_additions_are_not_breaking(package, compare, old, new):
    package.write({PATH: ARM.replace(old, new)})
    result = compare(package)
    assert sentences(subject(result, PATH))
    assert result.breaking_changes == []


CONTROL = """  <ros2_control name="hardware" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="upper_joint">
      <command_interface name="position"/>
      <command_interface name="velocity"/>
      <state_interface name="position"/>
    </joint>
  </ros2_control>
  <gazebo>
    <plugin name="drive" filename="libgazebo_ros_diff_drive.so">
      <command_topic>cmd_vel</command_topic>
      <max_wheel_torque>20</max_wheel_torque>
    </plugin>
  </gazebo>
</robot>"""


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('      <command_interface name="velocity"/>\n', "",
         "controllers that claim 'upper_joint/velocity' do not start"),
        ("cmd_vel", "base/cmd_vel", "programs that use the name 'cmd_vel' do not find it"),
        (">20<", ">30<", None),
        (CONTROL[CONTROL.index('    <joint name="upper_joint"') : CONTROL.index("  </ros2_control>")], "",
         "controllers that claim interfaces of 'upper_joint' do not start"),
        ('<ros2_control name="hardware"', '<ros2_control name="motors"', None),
        (CONTROL[CONTROL.index("  <ros2_control") : CONTROL.index("  <gazebo>")], "",
         "controllers of this hardware do not find its interfaces"),
    ],
)  # fmt: skip
def test_plugin_interfaces_and_topics_are_compared(package, compare, old, new, reason):
    text = ARM.replace("</robot>", CONTROL)
    package.commit({PATH: text})
    package.write({PATH: text.replace(old, new)})
    (change,) = subject(compare(package), PATH).changes
    assert (None if change.reason is None else str(change.reason)) == reason


def test_the_reason_of_an_unreadable_version_is_no_warning_about_an_argument(package, compare):
    call = "$(command 'xacro $(find-pkg-share arm_description)/urdf/arm.urdf.xacro speed:=1')"
    launch = f'<launch><let name="d" value="{call}"/></launch>'
    joint = '<joint name="j" type="fixed"><parent link="lower"/><child link="{}"/></joint><link name="hand"/></robot>'
    old, new = (ARM.replace("</robot>", joint.format(name)) for name in ("palm", "hand"))
    package.commit({PATH: old, "arm_description/launch/arm.launch.xml": launch})
    package.write({PATH: new})
    texts = [text for text in sentences(subject(compare(package), PATH)) if text.startswith("can be read now")]
    assert ["'palm'" in text for text in texts] == [True]


def test_unreadable_version_is_a_change_of_its_file_only(package, compare):
    package.commit(
        {
            PATH: ARM.replace("</robot>", "${missing}</robot>"),
            "other/b.urdf": "<robot name='b'><link name='b'/></robot>",
        }
    )
    package.write({PATH: ARM, "other/b.urdf": "<robot name='b'><link name='c'/></robot>"})
    result = compare(package)
    sentence, contents = sentences(subject(result, PATH))
    assert contents == (
        "robot 'arm': 4 links (base_link, upper, middle, lower), "
        "3 moving joints (upper_joint, middle_joint, lower_joint)"
    )
    assert sentence.startswith("can be read now; in the old version: arm_description/urdf/arm.urdf.xacro:")
    assert "missing" in sentence
    assert breaking(result)


def test_added_removed_and_renamed_files_are_reported(package, compare):
    package.commit({"arm_description/urdf/old.urdf": "<robot name='old'><link name='a'/></robot>"})
    text = (package.root / PATH).read_text()
    package.commit({PATH: None, "arm_description/urdf/new_arm.urdf.xacro": text})
    package.git("rm", "--quiet", "arm_description/urdf/old.urdf")
    package.commit({"arm_description/urdf/fresh.urdf": "<robot name='fresh'><link name='z'/><!-- other --></robot>"})
    result = compare(package, "HEAD~2..HEAD")
    assert sentences(subject(result, "arm_description/urdf/new_arm.urdf.xacro")) == [f"renamed from {PATH}"]
    assert sentences(subject(result, "arm_description/urdf/old.urdf")) == [
        "description removed",
        "robot 'old': 1 link (a)",
    ]
    assert sentences(subject(result, "arm_description/urdf/fresh.urdf")) == [
        "description added",
        "robot 'fresh': 1 link (z)",
    ]
    assert len(breaking(result)) == 2


def test_computed_include_is_followed(package, compare):
    text = ARM.replace("urdf/segment.xacro", "urdf/$(arg kind)_segment.xacro").replace(
        "<xacro:include", '<xacro:arg name="kind" default="plain"/><xacro:include'
    )
    package.commit({PATH: text, "arm_description/urdf/plain_segment.xacro": MACRO})
    package.write({"arm_description/urdf/plain_segment.xacro": MACRO.replace('mass value="2"', 'mass value="3"')})
    assert "link 'upper': inertial mass 2 -> 3 kg" in sentences(subject(compare(package), PATH))


def test_too_deeply_nested_description_is_a_problem_of_its_file_only(package, compare):
    deeply_nested = "<robot name='d'><link name='a'/><gazebo>" + "<a>" * 3000 + "</a>" * 3000 + "</gazebo></robot>"
    package.commit({"arm_description/urdf/deep.urdf": deeply_nested})
    package.write(
        {
            "arm_description/urdf/deep.urdf": deeply_nested.replace("name='d'", "name='e'"),
            PATH: ARM.replace('name="arm"', 'name="other"'),
        }
    )
    result = compare(package)
    assert "robot 'other': name arm -> other" in sentences(subject(result, PATH))
    assert len(subject(result, "arm_description/urdf/deep.urdf").problems) in (1, 2)


def test_equal_changes_of_several_joints_are_one_line(package, compare):
    second = MACRO.replace('name="segment"', 'name="tip"')
    text = ARM.replace('<xacro:segment name="lower"', '<xacro:tip name="lower"')
    package.commit(
        {
            "arm_description/urdf/segment.xacro": MACRO.replace("</robot>", second[second.index("  <xacro:") :]),
            PATH: text,
        }
    )
    package.write(
        {
            "arm_description/urdf/segment.xacro": (package.root / "arm_description/urdf/segment.xacro")
            .read_text()
            .replace('effort="10"', 'effort="20"')
        }
    )
    (change,) = subject(compare(package), PATH).changes
    assert str(change.sentence) == "joint 'upper_joint': limit effort 10 -> 20 N m"
    assert change.other_names == ("middle_joint", "lower_joint")
    assert len(change.other_locations) == 1


def test_renamed_hardware_keeps_its_other_changes(package, compare):
    text = ARM.replace("</robot>", CONTROL)
    package.commit({PATH: text})
    package.write({PATH: text.replace('"hardware"', '"motors"').replace("mock_components/Generic", "motors/Arm")})
    result = compare(package)
    assert sentences(subject(result, PATH)) == [
        "extension 'ros2_control hardware' renamed to 'ros2_control motors'",
        "extension 'ros2_control motors': hardware plugin mock_components/GenericSystem -> motors/ArmSystem",
    ]
    assert breaking(result) == []


def test_interface_that_other_hardware_offers_is_not_lost(package, compare):
    text = ARM.replace("</robot>", CONTROL)
    package.commit({PATH: text})
    interface = '      <command_interface name="velocity"/>\n'
    other = f"""  <ros2_control name="other" type="system">
    <joint name="upper_joint">{interface}</joint>
  </ros2_control>
</robot>"""
    package.write({PATH: text.replace(interface, "").replace("</robot>", other)})
    assert breaking(compare(package)) == []


@pytest.mark.parametrize(
    ("new", "is_breaking"), [("prismatic", True), ("continuous", True), ("fixed", True), ("revolute", False)]
)
def test_other_type_of_a_joint_is_breaking(package, compare, new, is_breaking):
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace('type="revolute"', f'type="{new}"')})
    assert bool(breaking(compare(package))) == is_breaking


def test_renamed_link_with_a_renamed_mesh_is_renamed(package, compare):
    robot = """<robot name="box"><link name="base"/>
  <link name="box_1"><visual><geometry><mesh filename="package://arm_description/{}"/></geometry></visual></link>
  <joint name="box_joint" type="fixed"><parent link="base"/><child link="box_1"/></joint>
</robot>"""
    corners = b"vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    mesh = b"solid lid\nfacet normal 0 0 1\nouter loop\n" + corners + b"endloop\nendfacet\nendsolid\n"
    package.commit({"arm_description/box.urdf": robot.format("old.stl"), "arm_description/old.stl": mesh})
    package.commit(
        {
            "arm_description/box.urdf": robot.format("new.stl").replace("box_1", "lid"),
            "arm_description/old.stl": None,
            "arm_description/new.stl": mesh,
        }
    )
    result = compare(package, "HEAD~1..HEAD")
    assert sentences(subject(result, "arm_description/box.urdf")) == ["link 'box_1' renamed to 'lid'"]
    assert sentences(subject(result, "arm_description/new.stl")) == ["renamed from arm_description/old.stl"]


def test_equal_changes_of_several_parts_of_hardware_are_one_line(package, compare):
    part = '    <gpio name="{}"><param name="gain">1</param></gpio>\n'
    gpios = "".join(map(part.format, ("a", "b", "c")))
    text = ARM.replace("</robot>", CONTROL.replace("  </ros2_control>", f"{gpios}  </ros2_control>"))
    package.commit({PATH: text})
    package.write({PATH: text.replace('"gain">1<', '"gain">2<')})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.sentence) == "extension 'ros2_control hardware': gpio a param gain 1 -> 2"
    assert change.other_names == ("gpio b", "gpio c")


EXTENSIONS = """
  <gazebo reference="{prefix}probe"><sensor name="scan" type="ray"><update_rate>{rate}</update_rate>
    <plugin name="scan" filename="scan.so"><frame_name>{prefix}probe</frame_name></plugin></sensor></gazebo>
  <transmission name="{prefix}drive"><joint name="{prefix}probe_joint"/><ratio>50</ratio></transmission>
</robot>"""


def test_extensions_of_renamed_links_and_joints_are_compared_with_the_old_ones(package, compare):
    """What only follows the new names has no line."""
    robot = ARM.replace('default="none"', 'default="probe"')
    renamed = robot.replace('"probe"/>\n    <', '"arm_probe"/>\n    <').replace('link="probe"', 'link="arm_probe"')
    renamed = renamed.replace('"probe_joint"', '"arm_probe_joint"')
    package.commit({PATH: robot.replace("</robot>", EXTENSIONS.format(prefix="", rate=10))})
    package.write({PATH: renamed.replace("</robot>", EXTENSIONS.format(prefix="arm_", rate=30))})
    assert sentences(subject(compare(package), PATH)) == [
        "link 'probe' renamed to 'arm_probe'",
        "joint 'probe_joint' renamed to 'arm_probe_joint'",
        "extension 'transmission arm_drive': @name drive -> arm_drive",
        "extension 'gazebo arm_probe': sensor scan update_rate 10 -> 30",
    ]


def test_a_macro_that_robots_read_is_compared_and_not_listed_with_the_other_files(package, compare):
    joint = MACRO[MACRO.index('    <joint name="${name}_joint"') : MACRO.index("  </xacro:macro>")]
    moved = MACRO.replace(joint, "").replace('    <link name="${name}">', joint + '    <link name="${name}">')
    assert moved != MACRO
    package.write({"arm_description/urdf/segment.xacro": moved})
    result = compare(package)
    assert (list(result.subjects), result.other_files) == ([], [])
