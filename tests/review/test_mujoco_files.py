"""The lines of a review about robots and worlds of MuJoCo."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/mjcf/arm.xml"
ARM = """<mujoco model="arm">
  <compiler angle="radian" meshdir="assets"/>
  <default>
    <default class="motors"><general forcerange="-50 50"/></default>
  </default>
  <asset><mesh file="hand.stl"/></asset>
  <worldbody>
    <body name="base" pos="0 0 0.5">
      <freejoint/>
      <geom type="box" size="0.1 0.1 0.1"/>
      <geom type="sphere" size="0.2"/>
      <body name="hand" pos="0 0 1">
        <joint name="wrist" axis="0 0 1" range="-1 1"/>
        <site name="tip" pos="0 0 0.1"/>
      </body>
    </body>
  </worldbody>
  <actuator><general name="wrist_drive" joint="wrist" gainprm="20"/></actuator>
  <sensor><force name="push" site="tip"/></sensor>
</mujoco>
"""
SITE = '        <site name="tip" pos="0 0 0.1"/>\n'
LOST = "programs that use the name '{}' do not find it"


@pytest.fixture
def review_file(repository, compare):
    def run(old, new):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
        repository.write({PATH: new})
        return compare(repository)

    return run


@pytest.mark.parametrize(
    ("old", "new", "expected", "line"),
    [
        ('"0 0 0.5"', '"0 0 0.45"', "body 'base': pos 0 0 0.5 -> 0 0 0.45", 8),
        (' meshdir="assets"', "", "compiler: meshdir assets removed", 2),
        ("-50 50", "-9 9", "general in default 'motors': forcerange -50 50 -> -9 9", 4),
        ('"0.1 0.1 0.1"', '"0.1 0.1 0.3"', "geom in body 'base': size 0.1 0.1 0.1 -> 0.1 0.1 0.3", 10),
        ("      <freejoint/>\n", "", "joint in body 'base' removed", 9),
        (
            '<general name="wrist_drive"',
            '<motor name="wrist_drive"',
            "actuator 'wrist_drive': type general -> motor",
            18,
        ),
        ('range="-1 1"', 'range="-1 1" damping="2"', "joint 'wrist': damping 2 added", 13),
        ('"hand.stl"', '"hand.stl" scale="2 2 2"', "mesh 'hand': scale 2 2 2 added", 6),
        ("  <sensor>", "  <sensor><torque site='tip' name='turn'/>", "sensor 'turn' added: type torque, site tip", 19),
    ],
)
def test_changed_elements_are_told(review_file, old, new, expected, line):
    assert ARM.count(old) == 1
    (change,) = subject(review_file(ARM, ARM.replace(old, new)), PATH).changes
    assert (str(change.sentence), change.reason) == (expected, None)
    assert change.location is not None
    assert change.location.line == line


@pytest.mark.parametrize(
    ("old", "new"),
    [('"0 0 0.5"', '"0 0  .50"'), ("<mujoco model", "<!-- mine --><mujoco model"), ("</asset>", "</asset >")],
)
def test_another_spelling_is_no_change(review_file, old, new):
    assert ARM.count(old) == 1
    assert review_file(ARM, ARM.replace(old, new)).subjects == []


def test_lost_names_are_breaking(review_file):
    result = review_file(
        ARM, ARM.replace('name="push"', 'name="press"').replace('        <site name="tip" pos="0 0 0.1"/>\n', "")
    )
    assert [(str(change.sentence), str(change.reason)) for change in subject(result, PATH).changes] == [
        ("sensor 'push' renamed to 'press'", LOST.format("push")),
        ("site 'tip' removed", LOST.format("tip")),
    ]


def test_a_name_that_moves_into_an_included_file_is_not_lost(repository, compare):
    body = ARM[ARM.index('      <body name="hand"') : ARM.index("    </body>\n  </worldbody>")]
    part = f"<mujoco><worldbody>{body}</worldbody></mujoco>"
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: ARM})
    new = ARM.replace(body, "").replace("<worldbody>", '<include file="parts/hand.xml"/><worldbody>')
    repository.write({PATH: new, "arm/mjcf/parts/hand.xml": part})
    result = compare(repository)
    assert breaking(result) == []
    assert "body 'hand' removed" in sentences(subject(result, PATH))


@pytest.mark.parametrize("address", ["arm.xml", "../../../outside.xml", "{outside}", "."])
def test_includes_of_itself_or_outside_are_not_read(review_file, tmp_path, address):
    """The names that a file outside the repository has are lost nevertheless."""
    outside = tmp_path / "outside.xml"
    outside.write_text(ARM, encoding="utf-8")
    include = f'<include file="{address.format(outside=outside)}"/>'
    result = review_file(ARM, ARM.replace("<worldbody>", f"{include}<worldbody>").replace(SITE, ""))
    assert breaking(result) == ["site 'tip' removed"]


def test_a_renamed_body_keeps_its_elements(review_file):
    result = review_file(ARM, ARM.replace('name="hand"', 'name="gripper"'))
    assert sentences(subject(result, PATH)) == ["body 'hand' renamed to 'gripper'"]


def test_an_element_that_moves_to_another_body_is_one_line(review_file):
    new = ARM.replace(SITE, "").replace("    </body>\n  </worldbody>", f"{SITE}    </body>\n  </worldbody>")
    assert sentences(subject(review_file(ARM, new), PATH)) == ["site 'tip': parent body 'hand' -> body 'base'"]


def test_elements_without_a_name_follow_from_an_added_body(review_file):
    body = '<body name="thumb"><geom size="1"/><joint name="bend"/></body>'
    new = ARM.replace("    </body>\n  </worldbody>", f"{body}    </body>\n  </worldbody>")
    assert sentences(subject(review_file(ARM, new), PATH)) == ["body 'thumb' added", "joint 'bend' added"]


def test_an_added_file_has_its_bodies_and_actuators(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.commit({PATH: ARM})
    assert sentences(subject(compare(repository, "HEAD~1..HEAD"), PATH)) == [
        "robot or world of MuJoCo added: body 'base', 'hand'; joint 'wrist'; actuator 'wrist_drive'; sensor 'push'"
    ]


def test_a_removed_file_is_breaking_if_a_source_names_it(repository, compare):
    source = 'import mujoco\n\nMODEL = mujoco.MjModel.from_xml_path("mjcf/arm.xml")\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: ARM, "arm/arm/run.py": source})
    repository.commit({PATH: None})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["robot or world of MuJoCo removed"]


def test_a_file_that_became_unreadable_is_told(review_file):
    result = review_file(ARM, ARM.replace("</worldbody>", ""))
    assert len(breaking(result)) == 1
