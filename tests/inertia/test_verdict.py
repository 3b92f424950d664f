"""The verdict about an `<inertial>` in comparison with the shapes of its link."""

from __future__ import annotations

import pytest

from linkwright.inertia import MeshLibrary, estimate
from linkwright.inertia.verdict import Grade, assess
from linkwright.packages import PackageFinder
from linkwright.urdf import read
from linkwright.urdf.bodies import Bodies
from linkwright.xmltree import parse

BALL = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'


def verdict_on(tmp_path, inertial, shapes=BALL, content=""):
    """Return the verdict on a link 'a' with a revolute joint."""
    text = (
        f'<robot name="r"><link name="world"/><link name="a">{inertial}{shapes}</link>'
        '<joint name="j" type="continuous"><parent link="world"/><child link="a"/></joint>' + content + "</robot>"
    )
    robot = read(parse(text, "r.urdf")).robot
    inertia_estimate = estimate(robot.links["a"], MeshLibrary(PackageFinder(start=[tmp_path]), tmp_path))
    return assess(robot.links["a"], inertia_estimate, Bodies(robot))


def inertial_text(mass=4.0, moment=0.016, origin="0 0 0"):
    return (
        f'<inertial><origin xyz="{origin}"/><mass value="{mass}"/>'
        f'<inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial>'
    )


@pytest.mark.parametrize(
    ("block", "grade", "words"),
    [
        (inertial_text(), Grade.FITS, "it matches its shapes"),
        (inertial_text(mass=-1), Grade.IMPOSSIBLE, "the mass is not positive"),
        (inertial_text(moment=-1), Grade.IMPOSSIBLE, "the inertia tensor is not positive definite"),
        (inertial_text(mass=1e40), Grade.IMPOSSIBLE, "its numbers are out of range"),
        (
            inertial_text(mass=400, moment=1.6),
            Grade.IMPOSSIBLE,
            "it is denser than any solid: osmium has 22 600 kg/m3",
        ),
        (inertial_text(mass=0.004, moment=0.000016), Grade.DOUBTFUL, "it is lighter than air"),
        (
            inertial_text(moment=16),
            Grade.DOUBTFUL,
            "its moments are 1 000 times the moments of a solid with its shapes",
        ),
        (
            inertial_text(moment=0.00016),
            Grade.DOUBTFUL,
            "its moments are 1/100 of the moments of a solid with its shapes",
        ),
        (
            inertial_text(moment=0.064),
            Grade.ROUGH,
            "its moments are 4 times the moments of a solid with its shapes",
        ),
        (inertial_text(origin="0 0.5 0"), Grade.DOUBTFUL, "its center of mass is 500 mm from the center of its shapes"),
        (inertial_text(origin="0 0.05 0"), Grade.ROUGH, "its center of mass is 50 mm from the center of its shapes"),
        ("", Grade.MISSING, "it has no <inertial>"),
    ],
)
def test_inertial_of_ball_is_graded(tmp_path, block, grade, words):
    verdict = verdict_on(tmp_path, block)
    assert (verdict.grade, verdict.reason) == (grade, words)


def test_worst_grade_is_reported_and_sorts_first(tmp_path):
    verdict = verdict_on(tmp_path, inertial_text(mass=-1, moment=16))
    assert verdict.grade is Grade.IMPOSSIBLE
    worse = verdict_on(tmp_path, inertial_text(moment=16))
    bad_verdict = verdict_on(tmp_path, inertial_text(moment=1.6))
    good_verdict = verdict_on(tmp_path, inertial_text())
    assert sorted([good_verdict, bad_verdict, worse, verdict], key=lambda verdict: verdict.sort_key) == [
        verdict,
        worse,
        bad_verdict,
        good_verdict,
    ]


def test_tiny_mass_in_large_shape_has_zero_density(tmp_path):
    large = BALL.replace("0.1", "1e5")
    verdict = verdict_on(tmp_path, inertial_text(mass=1e-320, moment=1.0), large)
    assert (verdict.grade, verdict.density) == (Grade.DOUBTFUL, 0.0)
    assert verdict.reason.startswith("it is lighter than air")


def test_mass_is_unjudged_if_mesh_is_missing(tmp_path):
    shapes = BALL + '<visual><geometry><mesh filename="package://nowhere/a.stl"/></geometry></visual>'
    verdict = verdict_on(tmp_path, inertial_text(mass=400), shapes)
    assert (verdict.grade, verdict.density) == (Grade.UNJUDGED, None)


def test_mass_is_unjudged_if_fixed_neighbor_has_no_mass(tmp_path):
    joint = '<joint name="f" type="fixed"><parent link="{}"/><child link="{}"/></joint><link name="{}">{}</link>'
    through_a_frame = joint.format("a", "frame", "frame", "") + joint.format("frame", "cover", "cover", BALL).replace(
        '"f"', '"g"'
    )
    assert verdict_on(tmp_path, inertial_text(mass=400), content=through_a_frame).grade is Grade.UNJUDGED
    robot_text = joint.format("a", "cover", "cover", BALL + inertial_text())
    assert verdict_on(tmp_path, inertial_text(mass=400), content=robot_text).grade is Grade.IMPOSSIBLE


def test_link_fixed_to_link_with_mass_needs_no_inertial(tmp_path):
    joint = '<joint name="f" type="fixed"><parent link="a"/><child link="b"/></joint><link name="b">{}</link>'
    verdict = verdict_on(tmp_path, "", content=joint.format(inertial_text()))
    assert verdict.reason == "it is fixed to 'b', which has a mass"
