"""Launch arguments and parameters that name a frame which a program only looks up, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

LAUNCH = """<launch>
  <arg name="base_frame" default="base_link"/>
  <node pkg="arm" exec="n.py">
    <param name="base_frame" value="$(var base_frame)"/>
    <param name="frame_id" value="base_link"/>
  </node>
</launch>
"""
SOURCE = """class Arm(Node):
    def __init__(self):
        super().__init__("arm")
        self.base = self.declare_parameter("base_frame", "base_link").value
        self.frame = self.declare_parameter("frame_id", "base_link").value
        self.buffer.lookup_transform(self.base, "hand", Time())
        self.buffer.lookup_transform(self.frame, "hand", Time())
"""
SENDS = """        message.header.frame_id = self.base
        message.header.frame_id = self.frame
"""
REASON = "programs that use the name 'base_link' do not find it"


@pytest.mark.parametrize(("source", "reason"), [(SOURCE, None), (SOURCE + SENDS, REASON), ("", REASON)])
@pytest.mark.parametrize(
    ("old", "new"),
    [('default="base_link"', 'default="footprint"'), ('"frame_id" value="base_link"', '"frame_id" value="footprint"')],
)
def test_a_frame_that_the_program_only_looks_up_breaks_nobody(repository, compare, source, reason, old, new):
    manifest, path = PACKAGE_XML.replace("arm_description", "arm"), "arm/launch/arm.launch.xml"
    repository.commit({"arm/package.xml": manifest, "arm/scripts/n.py": source, path: LAUNCH})
    repository.write({path: LAUNCH.replace(old, new)})
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == reason


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ('pkg="rtabmap_slam" exec="rtabmap"', None),
        ('pkg="rtabmap_viz" exec="rtabmap_viz"', None),
        ('pkg="rtabmap_odom" exec="icp_odometry"', REASON),  # it publishes the transform of the frame
    ],
)
def test_a_frame_that_a_well_known_program_only_looks_up_breaks_nobody(repository, compare, program, reason):
    manifest, path = PACKAGE_XML.replace("arm_description", "arm"), "arm/launch/arm.launch.xml"
    launch = f'<launch><node {program}><param name="frame_id" value="base_link"/></node></launch>\n'
    repository.commit({"arm/package.xml": manifest, path: launch})
    repository.write({path: launch.replace("base_link", "footprint")})
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == reason
