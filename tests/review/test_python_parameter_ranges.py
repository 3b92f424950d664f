"""The lines of a review about the ranges of parameters that Python sources declare."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML

SOURCE = """class Arm(Node):
    def __init__(self):
        super().__init__('arm')
{}

    def stop(self):
        slider.floating_point_range = [FloatingPointRange(from_value=7.0)]
"""
DIRECT = (
    "        self.declare_parameter('gain', 1.0, ParameterDescriptor(floating_point_range="
    "[FloatingPointRange(from_value={}, to_value=2.0, step=0.1)]))"
)
STEPS = """        slider = ParameterDescriptor(description='gain')
        limits = FloatingPointRange()
        limits.from_value = {}
        limits.to_value = 2.0
        {}
        self.declare_parameter('gain', 1.0, slider)
        limits.from_value = 0.7"""
TABLE = (
    "        self.declare_parameters('', [('gain', 1, ParameterDescriptor(integer_range="
    "[IntegerRange(from_value={}, to_value=5, step=1)]))])"
)
GIVEN = "slider.floating_point_range = [limits]"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (DIRECT.format("0.1"), DIRECT.format("0.2"),
         {"parameter 'gain': minimum 0.1 -> 0.2": "values below 0.2 are rejected"}),
        (DIRECT.format("-0.1"), DIRECT.format("-0.2"), {"parameter 'gain': minimum -0.1 -> -0.2": None}),
        (STEPS.format("0.1", "pass"), STEPS.format("0.1", "slider.floating_point_range.append(limits)"),
         {"parameter 'gain': minimum none -> 0.1": "values below 0.1 are rejected",
          "parameter 'gain': maximum none -> 2.0": "values above 2.0 are rejected"}),
        (STEPS.format("0.1", GIVEN), STEPS.format("0.2", GIVEN),
         {"parameter 'gain': minimum 0.1 -> 0.2": "values below 0.2 are rejected"}),
        (STEPS.format("0.1", GIVEN), STEPS.format("LOW", GIVEN), {"parameter 'gain': minimum 0.1 -> LOW": None}),
        (TABLE.format("1"), TABLE.format("2"),
         {"parameter 'gain': minimum 1 -> 2": "values below 2 are rejected"}),
    ],
)  # fmt: skip
def test_the_range_of_a_parameter_in_python_rejects_values(repository, compare, old, new, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/scripts/arm.py": SOURCE.format(old)})
    repository.write({"arm/scripts/arm.py": SOURCE.format(new)})
    changes = [change for found in compare(repository).subjects for change in found.changes]
    lines = {str(item.sentence): item.reason and str(item.reason) for item in changes if "'gain'" in str(item.sentence)}
    assert lines == expected
