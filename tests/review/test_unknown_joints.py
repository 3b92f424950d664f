"""Parameters that newly name a joint which no robot has, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import ARM
from tests.review.conftest import breaking

PATH, ROBOT = "arm_description/config/servos.yaml", "arm_description/urdf/arm.urdf.xacro"
SETTINGS = "front:\n  servo: {}\n  rate: 5\n"


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ("upper_joint", "uper_joint", True),
        ("upper_joint", "lower_joint", False),
        ("upper_joint", "left_upper_joint", False),
        ("uper_joint", "uppper_joint", False),
        ("upper_joint", "supper", False),
    ],
    ids=["unknown", "other", "prefix", "unknown-before", "no-joint"],
)
def test_parameter_that_newly_names_an_unknown_joint(package, compare, old, new, is_breaking):
    package.commit({PATH: SETTINGS.format(old)})
    package.write({PATH: SETTINGS.format(new)})
    text = f"names the joint '{new}' instead of '{old}', but no robot has it"
    assert (text in breaking(compare(package))) is is_breaking


@pytest.mark.parametrize(
    "content",
    ['<xacro:tool_of_another_package name="uper_"/>', '<!-- --><gazebo reference="uper_joint"/>'],
)
def test_joint_that_another_file_may_make_is_not_unknown(package, compare, content):
    package.commit({PATH: SETTINGS.format("upper_joint"), ROBOT: ARM.replace("</robot>", f"{content}</robot>")})
    package.write({PATH: SETTINGS.format("uper_joint")})
    assert not any("no robot has it" in text for text in breaking(compare(package)))
