"""Position limits of joints that are narrower, or gone, are breaking; so are reversed axes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, subject

PATH = "arm_description/urdf/stage.urdf"
URDF = """<robot name="stage">
  <link name="base"/>
  <link name="table"/>
  <joint name="turn" type="revolute">
    <parent link="base"/>
    <child link="table"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/>
  </joint>
</robot>
"""
MIMIC = '<joint name="turn" type="revolute"><mimic joint="lead"/>'
LEAD = """<link name="arm"/>
  <joint name="lead" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>"""
SDF_PATH = "arm_description/models/stage/model.sdf"
SDF = """<sdf version="1.9"><model name="stage">
  <link name="base"/><link name="table"/>
  <joint name="turn" type="revolute"><parent>base</parent><child>table</child>
    <axis><xyz>0 0 1</xyz><limit><lower>-2</lower><upper>2</upper></limit></axis></joint>
</model></sdf>
"""


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ('upper="2"', 'upper="1"', "joint 'turn': limit upper 2 -> 1 rad",
         "positions of 'turn' above 1 rad are now outside of its limits"),
        ('lower="-2"', 'lower="0"', "joint 'turn': limit lower -2 -> 0 rad",
         "positions of 'turn' below 0 rad are now outside of its limits"),
        ('lower="-2" upper="2"', 'lower="-1" upper="1"', "joint 'turn': limit: lower -2 -> -1 rad, upper 2 -> 1 rad",
         "positions of 'turn' below -1 rad and above 1 rad are now outside of its limits"),
        ('lower="-2" upper="2"', 'lower="-3" upper="1"', "joint 'turn': limit: lower -2 -> -3 rad, upper 2 -> 1 rad",
         "positions of 'turn' above 1 rad are now outside of its limits"),
        ('"revolute"', '"continuous"', "joint 'turn': type revolute -> continuous",
         "controllers and planners no longer keep 'turn' within position limits"),
    ],
)  # fmt: skip
def test_narrower_or_lost_limits_are_breaking(package, compare, old, new, sentence, reason):
    package.commit({PATH: URDF})
    package.write({PATH: URDF.replace(old, new)})
    ((_, change),) = compare(package).breaking_changes
    assert (str(change.sentence), str(change.reason)) == (sentence, reason)


def test_limits_of_a_joint_that_was_continuous_are_breaking(package, compare):
    package.commit({PATH: URDF.replace('"revolute"', '"continuous"').replace('lower="-2" upper="2" ', "")})
    package.write({PATH: URDF})
    ((_, change),) = compare(package).breaking_changes
    assert str(change.reason) == "positions of 'turn' below -2 rad and above 2 rad are now outside of its limits"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('upper="2"', 'upper="3"'),
        ('upper="2"', 'upper="1.999"'),
        ('effort="1"', 'effort="0.5"'),
        ('velocity="1"', 'velocity="0.5"'),
    ],
)
def test_other_limits_are_not_breaking(package, compare, old, new):
    package.commit({PATH: URDF})
    package.write({PATH: URDF.replace(old, new)})
    result = compare(package)
    assert subject(result, PATH).changes
    assert breaking(result) == []


def test_limits_of_a_joint_that_follows_another_are_not_breaking(package, compare):
    text = URDF.replace("</robot>", LEAD).replace('<joint name="turn" type="revolute">', MIMIC)
    package.commit({PATH: text})
    package.write({PATH: text.replace('upper="2"', 'upper="1.5"')})
    assert breaking(compare(package)) == []


@pytest.mark.parametrize(
    ("limit", "reasons"),
    [("1", ["positions of 'turn' above 1 are now outside of its limits"]), ("3", [])],
)
def test_limits_of_joints_in_sdf(package, compare, limit, reasons):
    package.commit({SDF_PATH: SDF})
    package.write({SDF_PATH: SDF.replace("<upper>2<", f"<upper>{limit}<")})
    assert [str(change.reason) for _, change in compare(package).breaking_changes] == reasons


AXIS = '<joint name="turn" type="revolute"><axis xyz="{}"/>'
REVERSED = "the same position of 'turn' moves it in the opposite direction"


@pytest.mark.parametrize(
    ("old", "new", "reasons"),
    [
        ("0 0 1", "0 0 -1", [REVERSED]),
        ("0 0 2", "0 0 -1", [REVERSED]),
        ("0 0 1", "0 1 0", []),
        ("0 0 1", '0 0 -1"/><origin rpy="3.141592653589793 0 0', []),
        ('0 0 1"/><mimic joint="lead', '0 0 -1"/><mimic joint="lead" multiplier="-1', []),
    ],
)
def test_reversed_axis_is_breaking(repository, compare, old, new, reasons):
    urdf = URDF.replace("</robot>", LEAD)
    texts = [urdf.replace('<joint name="turn" type="revolute">', AXIS.format(axis)) for axis in (old, new)]
    repository.commit({PATH: texts[0]})
    repository.write({PATH: texts[1]})
    changes = subject(compare(repository), PATH).changes
    assert any("axis" in str(change.sentence) for change in changes)
    assert [str(change.reason) for change in changes if change.reason] == reasons
