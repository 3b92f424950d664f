"""Configurations of fake controllers that start in a state that does not exist."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

PATH = "arm_description/config/arm.srdf"
SRDF = """<robot name="arm"><group name="arm"><joint name="upper_joint"/></group>%s</robot>
"""
STATE = '<group_state name="%s" group="arm"><joint name="upper_joint" value="%s"/></group_state>'
CONTROLLERS = """controller_list:
  - name: fake_arm_controller
initial:  # the first pose
  - group: arm
    pose: home
"""


def test_initial_state_that_never_existed_is_not_reported(package, compare):
    package.commit({PATH: SRDF % "", "arm_description/config/fake_controllers.yaml": CONTROLLERS})
    package.write({PATH: SRDF % (STATE % ("rest", 1))})
    assert breaking(compare(package)) == []


@pytest.mark.parametrize(("new", "is_lost"), [(STATE % ("rest", 1), True), (STATE % ("home", 1), False)])
def test_initial_state_that_no_longer_exists_is_breaking(package, compare, new, is_lost):
    package.commit({PATH: SRDF % (STATE % ("home", 0)), "arm_description/config/fake_controllers.yaml": CONTROLLERS})
    package.write({PATH: SRDF % new})
    text = "names the state 'arm/home', which does not exist"
    assert (text in breaking(compare(package))) is is_lost


@pytest.mark.parametrize(
    ("old", "new", "reasons"),
    [
        ("upper_joint", "base_x", ["MoveIt finds no controller for the joint 'base_x'"]),
        ("upper_joint", "lower_joint", []),
        ('<joint name="upper_joint"/>', '<chain base_link="base" tip_link="tip"/>', []),
        ('<joint name="upper_joint"/>', "", []),
    ],
)
def test_fake_controllers_keep_a_joint_that_another_one_replaces(package, compare, old, new, reasons):
    joints = "controller_list:\n  - name: fake_arm_controller\n    joints:\n      - upper_joint\n      - lower_joint\n"
    package.commit({PATH: SRDF % "", "arm_description/config/fake_controllers.yaml": joints})
    package.write({PATH: (SRDF % "").replace(old, new)})
    text = "names the joint 'upper_joint', which no group has any more"
    changes = [change for _, change in compare(package).breaking_changes]
    assert [str(change.reason) for change in changes if str(change.sentence) == text] == reasons


def test_initial_state_that_never_existed_is_not_reported_in_a_moved_package(package, compare):
    settings = "arm_description/config/fake_controllers.yaml"
    package.commit({PATH: SRDF % (STATE % ("rest", 1)), settings: CONTROLLERS})
    files = [path for path in package.root.rglob("*") if path.is_file() and ".git" not in path.parts]
    moved = {path.relative_to(package.root).as_posix(): path.read_text() for path in files}
    package.write(dict.fromkeys(moved) | {f"arms/{path}": text for path, text in moved.items()})
    package.commit({})
    assert not any("names the state" in sentence for sentence in breaking(compare(package, "HEAD~..HEAD")))
