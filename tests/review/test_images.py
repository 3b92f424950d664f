"""Images of robots in the page.

Only robots that look different have images, with the changed links outlined.
"""

from __future__ import annotations

import io

import numpy as np
import pytest

from linkwright.picture import OUTLINE_COLOR
from linkwright.review import open_versions, review
from linkwright.review.reports import as_html
from tests.repositories import ARM, MACRO

PATH = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"
TURNED = (
    MACRO.replace('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>')
    .replace(
        '<origin xyz="0 0 ${length}"/>', '<origin xyz="0 0 ${length}" rpy="0 0 ${pi if name == \'lower\' else 0}"/>'
    )
    .replace("<visual>", "<visual><origin rpy=\"0 0 ${pi if name == 'lower' else 0}\"/>")
)


@pytest.fixture
def render_images(package):
    def run(files: dict[str, str]):
        package.write(files)
        versions = open_versions(package.root, "HEAD")
        try:
            result = review(versions, with_images=True)
        finally:
            versions.close()
        (subject,) = (subject for subject in result.subjects if subject.path == PATH)
        return result, subject.images

    return run


def count_outline_pixels(image: bytes) -> int:
    """Return the number of pixels with the color of outlines."""
    pil = pytest.importorskip("PIL.Image")
    pixels = np.asarray(pil.open(io.BytesIO(image)).convert("RGB")).astype(int)
    differences = np.abs(pixels - np.rint(np.array(OUTLINE_COLOR) * 255.0)).max(axis=-1)
    return int(np.count_nonzero(differences < 20))


def share_of_differing_pixels(first: bytes, second: bytes) -> float:
    pil = pytest.importorskip("PIL.Image")
    pixels, other_pixels = (np.asarray(pil.open(io.BytesIO(image)).convert("RGB")) for image in (first, second))
    return float((pixels != other_pixels).any(axis=-1).mean())


def test_moved_link_is_outlined_in_both_versions(render_images):
    result, images = render_images({SEGMENT: MACRO.replace("length:=0.5", "length:=0.6")})
    assert [view.name for view in images] == ["iso", "front", "left", "top"]
    assert all(count_outline_pixels(image) > 50 for view in images[:3] for image in (view.old, view.new))
    assert images[1].old != images[1].new
    page = as_html(result)
    assert page.count("data:image/png;base64,") == 8
    assert page.count("type='range'") == 4


def test_robot_with_same_appearance_has_no_images(render_images):
    assert render_images({SEGMENT: MACRO.replace('mass value="2"', 'mass value="3"')})[1] == []


def test_frame_rotated_together_with_visual_has_no_images(render_images):
    assert render_images({SEGMENT: TURNED})[1] == []


def test_added_link_is_outlined_only_in_new_version(render_images):
    sensor = """<link name="sensor"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <joint name="sensor_joint" type="fixed"><parent link="lower"/><child link="sensor"/></joint></robot>"""
    _, images = render_images({PATH: ARM.replace("</robot>", sensor)})
    assert (count_outline_pixels(images[1].old), count_outline_pixels(images[1].new) > 50) == (0, True)


def share_of_axis_pixels(image: bytes) -> float:
    """Return the share of green and blue pixels, such as those of the axes y and z. The robot is red."""
    pil = pytest.importorskip("PIL.Image")
    pixels = np.asarray(pil.open(io.BytesIO(image)).convert("RGB")).astype(int)
    return float((pixels[..., 1:].max(axis=-1) - pixels[..., 0] > 80).mean())


FRAME = """<link name="{name}"/>
  <joint name="{name}_joint" type="fixed"><origin xyz="0.1 0 {height}"/><parent link="base_link"/><child link="{name}"/>
  </joint></robot>"""


def with_frame(**values: object) -> str:
    return ARM.replace("</robot>", FRAME.format(**values))


def test_added_frame_without_visuals_is_shown_as_axes(render_images):
    _, images = render_images({PATH: with_frame(name="sensor", height=0.5)})
    assert [view.name for view in images] == ["iso", "front", "left", "top"]  # the axes alone would show no place
    assert [share_of_axis_pixels(view.old) for view in images] == [0.0] * 4
    assert all(share_of_axis_pixels(view.new) > 0 for view in images)


def test_moved_frame_without_visuals_is_shown_in_both_places(package, render_images):
    package.commit({PATH: with_frame(name="sensor", height=0.5)})
    _, images = render_images({PATH: with_frame(name="sensor", height=0.7)})
    assert all(share_of_axis_pixels(image) > 0 for view in images for image in (view.old, view.new))
    assert images[1].old != images[1].new


def test_frame_below_another_parent_in_the_same_place_has_no_images(package, render_images):
    mast = FRAME.format(name="mast", height=0.5).replace("</robot>", "")
    package.commit({PATH: ARM.replace("</robot>", mast + FRAME.format(name="sensor", height=0.75))})
    below = FRAME.format(name="sensor", height=0.25).replace("base_link", "mast").replace("0.1 0 ", "0 0 ")
    assert render_images({PATH: ARM.replace("</robot>", mast + below)})[1] == []


def test_many_added_frames_are_not_shown(render_images):
    frames = "".join(FRAME.format(name=f"frame_{number}", height=0.1 * number) for number in range(20))
    assert render_images({PATH: ARM.replace("</robot>", frames.replace("</robot>", "") + "</robot>")})[1] == []


def test_small_part_has_an_image_of_its_own_from_a_side_where_it_is_visible(render_images):
    knob = """<link name="knob"><visual><geometry><sphere radius="0.02"/></geometry></visual></link>
  <joint name="knob_joint" type="fixed"><origin xyz="-0.06 0 0.3"/><parent link="upper"/><child link="knob"/></joint>
</robot>"""
    _, images = render_images({PATH: ARM.replace("</robot>", knob)})
    assert images[-1].name == "changed parts"
    assert count_outline_pixels(images[-1].new) > 5 * count_outline_pixels(images[0].new)


def test_visual_that_moves_to_another_link_in_the_same_place_is_not_outlined(render_images):
    moved = MACRO.replace("<visual>", "<!--").replace("</visual>", "-->")
    shell = """<link name="${name}_shell"><visual>{}</visual></link>
    <joint name="${name}_shell_joint" type="fixed"><parent link="${name}"/><child link="${name}_shell"/></joint>
    """
    visual = MACRO.partition("<visual>")[2].partition("</visual>")[0]
    text = moved.replace("<link ", shell.replace("{}", visual) + "<link ", 1)
    _, images = render_images({SEGMENT: text})
    assert sum(count_outline_pixels(image) for view in images for image in (view.old, view.new)) == 0


def test_mesh_that_is_not_drawn_is_named_below_the_images(render_images):
    bracket = """<link name="bracket"><visual><geometry><mesh filename="package://arm_description/no.stl"/></geometry></visual>
  <visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <joint name="bracket_joint" type="fixed"><parent link="lower"/><child link="bracket"/></joint></robot>"""
    result, images = render_images({PATH: ARM.replace("</robot>", bracket)})
    (note,) = images[0].notes
    assert "link 'bracket' is drawn without the mesh 'package://arm_description/no.stl'" in note
    assert as_html(result).count("is drawn without the mesh") == 1


SWITCH = """<xacro:arg name="size" default="1"/>
  <link name="knob"><visual><geometry><sphere radius="$(arg size)"/></geometry></visual>
  <inertial><mass value="{}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="knob_joint" type="fixed"><parent link="lower"/><child link="knob"/></joint></robot>"""


def test_images_and_quantities_name_the_arguments_of_several_callers(package, render_images):
    launch = """<launch>{}</launch>"""
    path = "$(find-pkg-share arm_description)/urdf/arm.urdf.xacro"
    call = f'<let name="d{{0}}" value="$(command \'xacro {path} size:={{0}}\')"/>'
    package.commit(
        {
            PATH: ARM.replace("</robot>", SWITCH.format(1)),
            "arm_description/launch/arm.launch.xml": launch.format(call.format(2) + call.format(3)),
        }
    )
    result, images = render_images({PATH: ARM.replace("</robot>", SWITCH.format(2).replace("sphere", "sphere "))})
    assert images == []
    page = as_html(result)
    assert "mass (with size:=2)" in page


COLLISION = "<collision><geometry>{}</geometry></collision>"


def test_collision_that_moves_to_another_link_in_the_same_place_is_not_outlined(package, render_images):
    shell = """<link name="shell">{}</link><link name="knob">{}</link>
  <joint name="shell_joint" type="fixed"><parent link="knob"/><child link="shell"/></joint>
  <joint name="knob_joint" type="fixed"><parent link="lower"/><child link="knob"/></joint></robot>"""
    sphere, box = COLLISION.format('<sphere radius="0.2"/>'), COLLISION.format('<box size="0.2 0.2 0.2"/>')
    package.commit({PATH: ARM.replace("</robot>", shell.format("", sphere))})
    assert render_images({PATH: ARM.replace("</robot>", shell.format(sphere, ""))})[1] == []
    _, images = render_images({PATH: ARM.replace("</robot>", shell.format(box, ""))})
    assert [view.name for view in images] == ["iso, collision", "front, collision"]
    assert all(count_outline_pixels(image) > 50 for view in images for image in (view.old, view.new))


def test_new_root_link_has_no_images(render_images):
    new_root = """<link name="foot"/><joint name="foot_joint" type="fixed">
    <parent link="foot"/><child link="base_link"/><origin xyz="0 0 0.3"/></joint><link name="base_link"/>"""
    assert render_images({PATH: ARM.replace('<link name="base_link"/>', new_root)})[1] == []


@pytest.mark.parametrize("is_added", [True, False])
def test_robots_with_other_root_links_are_in_the_same_place(render_images, package, is_added):
    foot = """<link name="foot"/><joint name="foot_joint" type="fixed"><parent link="foot"/>
    <child link="base_link"/><origin xyz="0.2 0 0.3" rpy="0 0 0.5"/></joint><link name="base_link"/>"""
    with_foot = ARM.replace('<link name="base_link"/>', foot)
    package.commit({PATH: ARM if is_added else with_foot})
    ball = """<link name="ball"><visual><geometry><sphere radius="0.01"/></geometry></visual></link>
  <joint name="ball_joint" type="fixed"><parent link="base_link"/><child link="ball"/><origin xyz="0 0.1 1"/>
  </joint></robot>"""
    _, images = render_images({PATH: (with_foot if is_added else ARM).replace("</robot>", ball)})
    assert [count_outline_pixels(view.old) for view in images] == [0, 0, 0, 0, 0]
    for view in images[:4]:
        assert 0.0 < share_of_differing_pixels(view.old, view.new) < 0.05


def test_joint_limits_that_exclude_zero_move_link(render_images):
    _, images = render_images({SEGMENT: MACRO.replace('lower="-1.5"', 'lower="0.5"')})
    assert count_outline_pixels(images[2].old) > 50
    assert images[2].old != images[2].new


@pytest.mark.parametrize("is_added", [True, False])
def test_added_and_removed_robots_have_one_image_of_each_view(package, is_added):
    package.commit({PATH: None})
    package.commit({PATH: ARM})
    versions = open_versions(package.root, "HEAD~1..HEAD" if is_added else "HEAD~2..HEAD~1")
    try:
        result = review(versions, with_images=True)
    finally:
        versions.close()
    (subject,) = (subject for subject in result.subjects if subject.path == PATH)
    assert [(bool(view.old), bool(view.new)) for view in subject.images] == [(not is_added, is_added)] * 4
    page = as_html(result)
    assert page.count("data:image/png;base64,") == 4
    assert "type='range'" not in page


WHEEL = """<link name="wheel">
  <{tag}><origin rpy="{rpy}"/><geometry>{shape}</geometry></{tag}></link>
  <joint name="wheel_joint" type="fixed"><parent link="base_link"/><child link="wheel"/></joint>
</robot>"""


@pytest.mark.parametrize("tag", ["visual", "collision"])
@pytest.mark.parametrize(
    ("shape", "old", "new", "is_shown"),
    [
        ('<cylinder radius="0.1" length="0.05"/>', "-1.57079632679 0 0", "1.57079632679 0 0.5", True),
        ('<cylinder radius="0.1" length="0.05"/>', "-1.57079632679 0 0", "1.57079632679 0 0", False),
        ('<cylinder radius="0.1" length="0.05"/>', "0 0 0", "0 0 0.5", False),
        ('<box size="0.1 0.2 0.05"/>', "0 0 0", "3.14159265359 0 0", False),
        ('<box size="0.1 0.2 0.05"/>', "0 0 0", "1.57079632679 0 0", True),
        ('<sphere radius="0.1"/>', "0 0 0", "1 2 3", False),
    ],
)
def test_rotation_of_a_symmetric_shape_is_not_outlined(package, render_images, tag, shape, old, new, is_shown):
    package.commit({PATH: ARM.replace("</robot>", WHEEL.format(tag=tag, shape=shape, rpy=old))})
    _, images = render_images({PATH: ARM.replace("</robot>", WHEEL.format(tag=tag, shape=shape, rpy=new))})
    assert bool(images) == is_shown


def test_equal_images_of_two_robots_are_in_the_page_once(package):
    other = "arm_description/urdf/other.urdf.xacro"
    package.commit({other: ARM})
    package.write({SEGMENT: MACRO.replace("length:=0.5", "length:=0.6")})
    versions = open_versions(package.root, "HEAD")
    try:
        page = as_html(review(versions, with_images=True))
    finally:
        versions.close()
    assert page.count("class='images'") == 1
    assert f"the same images as in {PATH}" in page
