"""The lines of a review about parameter files of MoveIt that follow a robot with other joints."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML

ROBOT = """<robot name="arm"><link name="base_link"/><link name="upper"/>
  <joint name="{}" type="revolute">
    <parent link="base_link"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
LIMITS = """joint_limits:
  elbow: {{has_velocity_limits: true, max_velocity: 1.5}}
  {}: {{has_velocity_limits: true, max_velocity: 2.5, has_acceleration_limits: false}}
"""
CONTROLLERS = "controller_list:\n  - name: arm\n    type: FollowJointTrajectory\n    joints: [{}]\n"


@pytest.mark.parametrize(("name", "text"), [("joint_limits.yaml", LIMITS), ("controllers.yaml", CONTROLLERS)])
@pytest.mark.parametrize("joint", ["swivel", "shoulder"])
def test_a_file_of_moveit_that_follows_a_renamed_joint_breaks_nothing(repository, compare, name, text, joint):
    path = f"arm/config/{name}"
    old = {"arm/arm.urdf": ROBOT.format("shoulder"), path: text.format("shoulder")}
    repository.commit({"arm/package.xml": PACKAGE_XML, **old})
    repository.write({"arm/arm.urdf": ROBOT.format(joint), path: text.format("swivel")})
    result = compare(repository)
    changed = "arm/arm.urdf" if joint == "swivel" else path
    assert {subject.path for subject, _ in result.breaking_changes} == {changed}
    assert any(subject.path == path and subject.changes for subject in result.subjects)
