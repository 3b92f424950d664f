"""The reach of a robot in a review.

It is the largest distance, found by a search instead of chance.
"""

from __future__ import annotations

import pytest

from linkwright.diagnostics import phrase
from linkwright.review.quantities import compare_quantity
from tests.repositories import MACRO
from tests.review.conftest import subject

PATH = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"


def _find_reach_figure(result):
    figures = {str(figure.name): figure for figure in subject(result, PATH).figures}
    return figures.get("reach of 'lower'")


def test_tighter_limits_never_enlarge_the_reach(package, compare):
    for limit in (1.4, 1.0, 0.6, 0.3):
        package.write({SEGMENT: MACRO.replace('"-1.5" upper="1.5"', f'"-{limit}" upper="{limit}"')})
        assert _find_reach_figure(compare(package)) is None  # the stretched arm is within all of these limits


def test_reach_is_that_of_the_stretched_arm(package, compare):
    package.write({SEGMENT: MACRO.replace("length:=0.5", "length:=0.6")})
    figure = _find_reach_figure(compare(package))
    assert (figure.old, figure.new) == ("1.5", "1.8")


def test_limits_that_bend_the_arm_reduce_the_reach(package, compare):
    package.write({SEGMENT: MACRO.replace('lower="-1.5"', 'lower="0.5"')})
    figure = _find_reach_figure(compare(package))
    assert float(figure.new) < float(figure.old)


@pytest.mark.parametrize("upper", [0.5, 1.5])
def test_slide_reaches_farthest_at_a_limit(package, compare, upper):
    sliding = MACRO.replace('type="revolute"', 'type="prismatic"').replace('xyz="0 1 0"', 'xyz="0 0 1"')
    sliding = sliding.replace('"-1.5" upper="1.5"', '"0" upper="0"')
    package.commit({SEGMENT: sliding})
    package.write({SEGMENT: sliding.replace('upper="0"', f'upper="{upper}"')})
    figure = _find_reach_figure(compare(package))
    assert float(figure.new) == pytest.approx(1.5 + 3 * upper, abs=1e-3)


@pytest.mark.parametrize(
    ("old", "new", "texts"),
    [
        (2.0, 3.0, ("2", "3")),
        (102.8, 102.8453, ("102.8", "102.85")),
        (102.84, 102.823, ("102.84", "102.82")),
    ],
)
def test_quantity_has_the_digits_that_tell_both_versions_apart(old, new, texts):
    (figure,) = compare_quantity(phrase("mass"), "kg", old, new)
    assert (figure.old, figure.new) == texts


def test_robot_without_mass_has_no_center_of_mass(package, compare):
    package.commit({SEGMENT: MACRO.replace('mass value="2"', 'mass value="0"')})
    package.write({SEGMENT: MACRO})
    figures = {str(figure.name): (figure.old, figure.new) for figure in subject(compare(package), PATH).figures}
    assert figures["mass"] == ("0", "6")
    assert "center of mass" not in figures
