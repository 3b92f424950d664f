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


def test_initial_state_that_never_existed_is_not_reported_in_a_moved_package(package, compare):
    settings = "arm_description/config/fake_controllers.yaml"
    package.commit({PATH: SRDF % (STATE % ("rest", 1)), settings: CONTROLLERS})
    files = [path for path in package.root.rglob("*") if path.is_file() and ".git" not in path.parts]
    moved = {path.relative_to(package.root).as_posix(): path.read_text() for path in files}
    package.write(dict.fromkeys(moved) | {f"arms/{path}": text for path, text in moved.items()})
    package.commit({})
    assert not any("names the state" in sentence for sentence in breaking(compare(package, "HEAD~..HEAD")))
