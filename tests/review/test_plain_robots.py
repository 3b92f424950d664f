"""Changes of plain URDF in a review.

The tests cover expressions for xacro, added links, and meshes under other paths.
"""

from __future__ import annotations

import pytest

from linkwright.review import open_versions, review
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject
from tests.review.test_scene_images import make_stl

PATH = "w/urdf/arm.urdf"
PACKAGE = {"w/package.xml": "<package format='3'><name>w</name><version>1.0.0</version></package>"}
ARM = """<robot name="arm">
<link name="base">
<visual><geometry><mesh filename="package://w/meshes/base.stl"/></geometry></visual>
</link>
<transmission name="a_trans"><type>t</type>
<joint name="a"><hardwareInterface>Effort</hardwareInterface></joint>
</transmission>
<transmission name="b_trans"><type>t</type>
<joint name="b"><hardwareInterface>Effort</hardwareInterface></joint>
</transmission>
</robot>
"""
WRAPPER = """<robot name="cell" xmlns:xacro="http://ros.org/wiki/xacro">
<xacro:include filename="$(find w)/urdf/arm.urdf"/><link name="floor"/>
<joint name="f" type="fixed"><parent link="floor"/><child link="base"/></joint></robot>
"""
FILES = {**PACKAGE, PATH: ARM, "w/meshes/base.stl": make_stl(1.0)}
REASON = "programs that read the file without xacro do not find the file that it names"


def review_replacement(repository, replacement, *, files=FILES, with_images=False):
    old, new = replacement
    assert old in ARM
    repository.commit(files)
    repository.write({PATH: ARM.replace(old, new)})
    versions = open_versions(repository.root, "HEAD")
    try:
        return review(versions, with_images=with_images)
    finally:
        versions.close()


@pytest.mark.parametrize("files", [FILES, {**FILES, "w/urdf/cell.urdf.xacro": WRAPPER}])
def test_expression_in_plain_urdf_is_breaking(repository, files):
    result = review_replacement(repository, ("package://w", "$(find w)"), files=files)
    assert [str(change.reason) for change in subject(result, PATH).changes] == [REASON]
    assert len(result.breaking_changes) == 1


def test_expression_in_xacro_is_not_breaking(repository, compare):
    text = WRAPPER.replace('name="floor"/>', 'name="floor">').replace(
        "<joint", ('<visual><geometry><mesh filename="package://w/meshes/base.stl"/></geometry></visual></link><joint')
    )
    path = "w/urdf/cell.urdf.xacro"
    repository.commit({**FILES, path: text})
    repository.write({path: text.replace("package://w", "file://$(find w)")})
    result = compare(repository)
    assert breaking(result) == []
    assert sentences(subject(result, path)) == [
        "link 'floor': visual geometry mesh package://w/meshes/base.stl -> mesh file://$(find w)/meshes/base.stl"
    ]


SENSOR = '<gazebo reference="{}"><sensor name="s" type="imu"><topic>imu</topic></sensor></gazebo></robot>'


@pytest.mark.parametrize(("reference", "is_breaking"), [("base", True), ("imu_link", False)])
def test_removed_extension_for_unknown_link_is_not_breaking(repository, compare, reference, is_breaking):
    repository.commit({**FILES, PATH: ARM.replace("</robot>", SENSOR.format(reference))})
    repository.write({PATH: ARM})
    (change,) = subject(compare(repository), PATH).changes
    assert (change.reason is not None) == is_breaking
    note = ", which had no effect, because 'imu_link' was neither a link nor a joint: sensor 's' ("
    assert (note in str(change.sentence)) != is_breaking


def test_robot_that_xacro_includes_is_compared_on_its_own(repository):
    link = '<link name="tip"/><joint name="t" type="fixed"><parent link="base"/><child link="tip"/></joint>'
    files = {**FILES, "w/urdf/cell.urdf.xacro": WRAPPER}
    result = review_replacement(repository, ("</robot>", f"{link}</robot>"), files=files)
    assert [each.path for each in result.subjects] == [PATH, "w/urdf/cell.urdf.xacro"]


LINK = (
    '<link name="{0}"><visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual>'
    '<collision><geometry><cylinder radius="0.1" length="1"/></geometry></collision>'
    '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="{0}_joint" type="fixed"><parent link="base"/><child link="{0}"/><origin xyz="0 0 0.5"/></joint>'
)


def test_added_link_is_one_line_with_its_place(repository):
    result = review_replacement(repository, ("</robot>", f"{LINK.format('tip')}</robot>"))
    (text,) = sentences(subject(result, PATH))
    assert text == (
        "link 'tip' added: fixed joint 'tip_joint' at 'base', xyz 0 0 0.5 m, "
        "visual box 0.1 0.2 0.3, collision cylinder 0.1 1, mass 2 kg"
    )


def test_added_link_with_a_mass_and_without_inertia_tells_it(repository):
    link = LINK.format("tip").replace('ixx="1" iyy="1" izz="1"', 'ixx="0" iyy="0" izz="0"')
    (text,) = sentences(subject(review_replacement(repository, ("</robot>", f"{link}</robot>")), PATH))
    assert text.endswith("mass 2 kg, inertia zero")


def test_added_link_has_its_rotation_and_the_number_of_its_equal_shapes(repository):
    visual = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'
    link = LINK.format("tip").replace("<visual>", f"{visual}{visual}<visual>", 1)
    link = link.replace('xyz="0 0 0.5"', 'xyz="0 0 0.5" rpy="-1.5708 0 0.5"')
    (text,) = sentences(subject(review_replacement(repository, ("</robot>", f"{link}</robot>")), PATH))
    assert "xyz 0 0 0.5 m, rpy -90 0 28.65°, visual sphere 0.1 (2 times), visual box 0.1 0.2 0.3," in text


def test_many_added_links_are_named_only(repository):
    links = "".join(map(LINK.format, ("one", "two", "three", "four", "five")))
    (links_change, joints_change) = subject(
        review_replacement(repository, ("</robot>", f"{links}</robot>")), PATH
    ).changes
    assert (str(links_change.sentence), str(joints_change.sentence)) == (
        "link 'one' added",
        "joint 'one_joint' added",
    )
    assert len(links_change.other_names) == 4


def test_added_inertial_is_shown_without_products(repository):
    inertial = '<inertial><mass value="2"/><inertia ixx="1" iyy="2" izz="3" ixy="0.1" ixz="0" iyz="0"/></inertial>'
    result = review_replacement(repository, ("</link>", f"{inertial}</link>"))
    (text,) = sentences(subject(result, PATH))
    assert text.startswith("link 'base': inertial added: mass 2 kg, ")
    assert text.endswith("inertia ixx 1 kg m2, inertia iyy 2 kg m2, inertia izz 3 kg m2")
    assert "ixy" not in text


def test_same_value_of_all_transmissions_is_one_line(repository):
    (change,) = subject(review_replacement(repository, (">Effort<", ">hardware/Effort<")), PATH).changes
    assert str(change.sentence) == (
        "extension 'transmission a_trans': joint a hardwareInterface Effort -> hardware/Effort"
    )
    assert change.other_names == ("transmission b_trans",)


@pytest.mark.parametrize(("height", "count"), [(1.0, 0), (2.0, 4)])
def test_equal_mesh_under_another_path_has_no_images(repository, height, count):
    files = {**FILES, "w/meshes/other.stl": make_stl(height)}
    result = review_replacement(repository, ("base.stl", "other.stl"), files=files, with_images=True)
    assert len(subject(result, PATH).images) == count


def test_added_elements_of_an_unreadable_robot_have_their_values(repository, compare):
    text = '<robot name="arm"><link name="a"/><link name="b"/>{}</robot>'
    joints = "".join(
        f'<joint name="j{number}" type="fixed"><parent link="a"/><child link="{child}"/></joint>'
        for number, child in enumerate("cd")
    )
    repository.commit({**PACKAGE, PATH: text.format("")})
    repository.write({PATH: text.format(joints)})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.sentence) == "joint j0 type=fixed added: parent link=a, child link=c"
    assert change.other_names == ("joint j1: parent link=a, child link=d",)


def test_installed_files_have_uris_instead_of_paths_of_the_computer(repository, compare):
    mesh = "<visual><geometry><mesh filename='%s/meshes/a.stl'/></geometry></visual>"
    robot = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><link name='base'>%s</link></robot>"
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
            "arm/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY model/meshes DESTINATION share/arm)\n",
            "arm/model/meshes/a.stl": b"solid a\nendsolid a\n",
            "arm/urdf/arm.urdf.xacro": robot % (mesh % "model://vendor"),
        }
    )
    repository.write({"arm/urdf/arm.urdf.xacro": robot % (mesh % "file://$(find arm)")})
    found = sentences(subject(compare(repository), "arm/urdf/arm.urdf.xacro"))
    expected = "link 'base': visual geometry mesh model://vendor/meshes/a.stl -> mesh file://$(find arm)/meshes/a.stl"
    assert found == [expected]


def test_mesh_named_by_its_file_differs_from_its_path(repository, compare):
    link = '<link name="base"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'
    text = f'<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro">{link}</robot>'
    path = "w/urdf/cell.urdf.xacro"
    repository.commit({**FILES, path: text.format("$(find w)/meshes/base.stl")})
    repository.write({path: text.format("file://$(find w)/meshes/base.stl")})
    assert sentences(subject(compare(repository), path)) == [
        "link 'base': visual geometry mesh w/meshes/base.stl -> mesh file://$(find w)/meshes/base.stl"
    ]


CONTROLLER = """<gazebo reference="{0}"><controller name="c"><frameName>base</frameName></controller>
<sensor name="s" type="ray"><plugin name="p" filename="laser.so"><bodyName>base</bodyName></plugin></sensor></gazebo>
</robot>"""


def test_elements_that_still_name_a_renamed_link_are_breaking(repository, compare):
    repository.commit({**FILES, PATH: ARM.replace("</robot>", CONTROLLER.format("base"))})
    repository.write({PATH: ARM.replace("</robot>", CONTROLLER.format("foot")).replace('"base"', '"foot"')})
    changes = {str(each.sentence): str(each.reason) for each in subject(compare(repository), PATH).changes}
    lost = "the link 'base' no longer exists"
    names = [sentence for sentence, reason in changes.items() if reason == lost]
    assert names[0] == "extension 'gazebo foot': controller c frameName still names 'base'"
    assert all("still names 'base' in <bodyName>" in name for name in names[1:])
    assert len(names) > 1
    assert not any("base -> base" in sentence for sentence in changes)
