"""Changes of what launch files start through the files that they include, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import subject

PART = """<launch>
  <arg name="camera" default="true"/>
  <node pkg="arm" type="camera.py" name="camera" if="$(arg camera)"/>
</launch>
"""
MODEL = '<launch><param name="robot_description" textfile="arm.urdf"/></launch>'
FILE = """<launch>
  <arg name="camera" default="true"/>
  <include file="$(find elsewhere)/launch/safety.launch"/>
  <include file="$(dirname)/part.launch"><arg name="camera" value="$(arg camera)"/></include>
  <include file="$(dirname)/model.launch"/>
  <include file="$(find elsewhere)/launch/laser_pipeline.launch"><arg name="scan" value="front"/></include>
  <include file="$(find elsewhere)/launch/rviz.launch"/>
</launch>
"""
SAFETY, PART_INCLUDE, MODEL_INCLUDE, LASER, RVIZ = (line + "\n" for line in FILE.splitlines()[2:7])
STOPS = "its nodes do not start any more"
CAMERA_STOPS = "by default, 'arm/camera.py' does not start any more"


@pytest.fixture
def reasons(repository, compare):
    """Review a replacement in a launch file that includes others; return the changes with their reasons."""

    def run(old: str, new: str):
        assert old in FILE
        files = {"arm/launch/part.launch": PART, "arm/launch/model.launch": MODEL}
        repository.commit({"arm/launch/arm.launch": FILE, **files})
        repository.write({"arm/launch/arm.launch": FILE.replace(old, new)})
        changes = subject(compare(repository), "arm/launch/arm.launch").changes
        return {str(each.sentence): None if each.reason is None else str(each.reason) for each in changes}

    return run


@pytest.mark.parametrize(
    ("line", "reason"),
    [(SAFETY, STOPS), (PART_INCLUDE, STOPS), (MODEL_INCLUDE, None), (LASER, STOPS), (RVIZ, None)],
)
def test_removed_include_is_breaking_if_its_nodes_start_by_default(reasons, line, reason):
    assert list(reasons(line, "").values()) == [reason]


def test_removed_include_is_not_breaking_if_its_nodes_were_switched_off(repository, compare):
    text = FILE.replace('default="true"', 'default="false"')
    repository.commit({"arm/launch/arm.launch": text, "arm/launch/part.launch": PART})
    repository.write({"arm/launch/arm.launch": text.replace(PART_INCLUDE, "")})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert change.reason is None


def test_removed_include_is_not_breaking_if_the_file_starts_its_nodes(reasons):
    node = '  <node pkg="arm" type="camera.py" name="camera"/>\n'
    assert set(reasons(PART_INCLUDE, node).values()) == {None}


def test_include_of_a_file_with_the_same_role_replaces_another(reasons):
    found = reasons(LASER, '  <include file="$(find elsewhere)/launch/pipeline.launch"/>\n')
    assert set(found.values()) == {None}
    assert (
        "include of '$(find elsewhere)/launch/laser_pipeline.launch' replaced by "
        "include of '$(find elsewhere)/launch/pipeline.launch'"
    ) in found


def test_include_of_a_file_with_another_role_does_not_replace_it(reasons):
    found = reasons(SAFETY, '  <include file="$(find elsewhere)/launch/mux.launch"/>\n')
    assert list(found.values()) == [None, STOPS]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'value="$(arg camera)"',
            'value="false"',
            "include of '$(dirname)/part.launch': camera $(arg camera) -> false",
        ),
        ('default="true"', 'default="false"', "argument 'camera': default true -> false"),
    ],
)
def test_value_that_switches_off_a_node_of_an_included_file_is_breaking(reasons, old, new, expected):
    assert reasons(old, new) == {expected: CAMERA_STOPS}


@pytest.mark.parametrize(
    ("line", "reason"), [(SAFETY, "by default, it does not start any more"), (MODEL_INCLUDE, None)]
)
def test_condition_that_does_not_hold_is_breaking_for_a_file_with_nodes(reasons, line, reason):
    assert list(reasons(line, line.replace("/>", ' if="false"/>')).values()) == [reason]
