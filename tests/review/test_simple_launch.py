"""The lines of a review about arguments that launch files declare by simple_launch."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

PATH = "arm/launch/arm.launch.py"
TEXT = """from simple_launch import SimpleLauncher


def generate_launch_description():
    sl = SimpleLauncher(use_sim_time=False)
    sl.declare_arg("name", default_value="arm")
    {}
    sl.node("arm", "driver", parameters={{"name": sl.arg("name"){}}})
    return sl.launch_description()
"""
CAMERA, USE = 'sl.declare_arg("camera", False)', ', "camera": sl.arg("camera")'
REMOVED, UNUSED = "argument 'camera' removed", "argument 'camera' is no longer used"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ((CAMERA, USE), ("", ""), REMOVED, True),
        ((CAMERA, ""), ("", ""), f"{REMOVED}; the file did not use it", False),
        ((CAMERA, USE), (CAMERA, ""), UNUSED, True),
        (("", ""), (CAMERA, USE), "argument 'camera' added: default False", False),
        (("", ""), ('sl.declare_arg("camera")', USE), "argument 'camera' added (required)", True),
        ((CAMERA, USE), (CAMERA, ', "camera": sl.arg_map()'), None, False),
    ],
)
def test_arguments_of_simple_launch_are_told(repository, compare, old, new, expected, is_breaking):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: TEXT.format(*old)})
    repository.write({PATH: TEXT.format(*new)})
    result = compare(repository)
    lines = [line for found in result.subjects for line in sentences(found) if line.startswith("argument")]
    assert lines == [expected] * (expected is not None)
    assert breaking(result) == lines * is_breaking
