"""Links that collide in the new version and not in the old one."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, MACRO, PACKAGE
from tests.review.conftest import sentences, subject

pytest.importorskip("mujoco")

PATH = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"
SOLID_MACRO = MACRO.replace(
    "</link>",
    """<collision>
        <origin xyz="0 0 ${length / 2}"/>
        <geometry><box size="0.1 0.1 ${length - 0.02}"/></geometry>
      </collision>
    </link>""",
)


@pytest.fixture
def solid(repository):
    repository.commit({**PACKAGE, SEGMENT: SOLID_MACRO})
    return repository


def find_collisions(compare, repository, text: str) -> list[str]:
    repository.write({SEGMENT: text})
    return [sentence for sentence in sentences(subject(compare(repository), PATH)) if "collide" in sentence]


def test_wider_joint_limits_report_new_self_collision(solid, compare):
    (collision,) = find_collisions(
        compare, solid, SOLID_MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-3" upper="3"')
    )
    assert collision.startswith("links 'upper' and 'lower' can collide: in ")
    assert collision.endswith(" % of 300 configurations, in none before")


def test_collision_at_home_is_reported(solid, compare):
    text = SOLID_MACRO.replace(
        '<origin xyz="0 0 ${length}"/>', "<origin xyz=\"0 0 ${0.12 if name == 'lower' else length}\"/>"
    )
    text = text.replace('<origin xyz="0 0 ${0.12', "<origin xyz=\"0 0 ${-length if name == 'lower' else 0.12")
    assert "links 'upper' and 'lower' collide at home" in find_collisions(compare, solid, text)


@pytest.mark.parametrize("name", ["upper", "${prefix}upper"])
def test_collision_that_a_semantic_description_disables_is_not_reported(solid, compare, name):
    text = f'<robot name="arm"><disable_collisions link1="{name}" link2="lower" reason="Never"/></robot>'
    solid.commit({"arm_description/srdf/arm.srdf.xacro": text})
    assert (
        find_collisions(compare, solid, SOLID_MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-3" upper="3"')) == []
    )


def test_existing_collision_is_not_reported(solid, compare):
    free = SOLID_MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-3" upper="3"')
    solid.commit({SEGMENT: free})
    assert find_collisions(compare, solid, free.replace('mass value="2"', 'mass value="3"')) == []
    assert find_collisions(compare, solid, SOLID_MACRO) == []


def test_connected_links_may_touch(solid, compare):
    assert find_collisions(compare, solid, SOLID_MACRO.replace("${length - 0.02}", "${length + 0.1}")) == []


def test_renamed_links_and_joints_collide_as_before(solid, compare):
    free = SOLID_MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-3" upper="3"')
    solid.commit({SEGMENT: free})
    text = free.replace('link name="${name}"', 'link name="${name}_link"').replace("${name}_joint", "${name}_axis")
    text = text.replace('child link="${name}"', 'child link="${name}_link"').replace(
        'parent link="${parent}"', "parent link=\"${parent}${'' if parent == 'base_link' else '_link'}\""
    )
    solid.write({PATH: ARM.replace('parent link="lower"', 'parent link="lower_link"')})
    assert find_collisions(compare, solid, text) == []


def test_collisions_of_a_mesh_that_the_old_version_lacks_are_unknown(solid, compare):
    """That a link with an unreadable mesh did not collide says nothing."""
    wide = SOLID_MACRO.replace('lower="-1.5" upper="1.5"', 'lower="-3" upper="3"')
    mesh = '<mesh filename="package://arm_description/meshes/missing.stl"/>'
    solid.commit({SEGMENT: SOLID_MACRO.replace('<box size="0.1 0.1 ${length - 0.02}"/>', mesh)})
    assert find_collisions(compare, solid, wide) == []


FINGER = """<link name="f{0}"><collision><geometry><box size="{1} 0.1 0.1"/></geometry></collision></link>
<joint name="j{0}" type="revolute"><parent link="palm"/><child link="f{0}"/><origin xyz="{0} 0 0"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
"""


@pytest.mark.parametrize(("count", "lines"), [(5, 4), (6, 1)])
def test_many_collisions_are_one_line(solid, compare, count, lines):
    path = "arm_description/urdf/hand.urdf"
    robots = [
        f'<robot name="hand"><link name="palm"/>{"".join(FINGER.format(n, size) for n in range(count))}</robot>'
        for size in (0.5, 1.5)
    ]
    solid.commit({path: robots[0]})
    solid.write({path: robots[1]})
    found = [text for text in sentences(subject(compare(solid), path)) if "collide" in text]
    assert len(found) == lines
    if lines == 1:
        assert found[0].startswith("5 pairs of links newly collide in 300 configurations: 'f")
        assert found[0].count("(at home)") == 5
