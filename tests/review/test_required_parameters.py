"""Parameters without which a node of rospy fails, and programs whose names begin with ``test_``."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/arm.py"
HEAD = "import rospy\nrospy.init_node('arm')\n"
WITH_DEFAULT = "gain = rospy.get_param('~gain', 1.0)\n"
WITHOUT = "gain = rospy.get_param('~gain')\n"
GUARDED = "try:\n    gain = rospy.get_param('~gain')\nexcept KeyError:\n    gain = 2.0\n"
REPORTED = "try:\n    gain = rospy.get_param('~gain')\nexcept KeyError:\n    raise KeyError('no gain')\n"
CHECKED = "if rospy.has_param('~gain'):\n    gain = rospy.get_param('~gain')\n"
FAILS = "the program fails where '~gain' is not set"


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ("", WITHOUT, "parameters added: '~gain'", FAILS),
        (WITH_DEFAULT, WITHOUT, "parameter '~gain': required no -> yes", FAILS),
        (WITH_DEFAULT, REPORTED, "parameter '~gain': required no -> yes", FAILS),
        ("", GUARDED, "parameters added: '~gain'", None),
        ("", CHECKED, "parameters added: '~gain'", None),
        ("", WITH_DEFAULT, "parameters added: '~gain' (1.0)", None),
        (WITHOUT, WITH_DEFAULT, "parameter '~gain': required yes -> no", None),
    ],
)
def test_parameter_that_must_be_set(repository, compare, old, new, sentence, reason):
    repository.commit({**MANIFEST, PATH: HEAD + old})
    repository.write({PATH: HEAD + new})
    change = next(each for each in subject(compare(repository), PATH).changes if "'~gain'" in str(each.sentence))
    assert (str(change.sentence), change.reason and str(change.reason)) == (sentence, reason)


def test_parameters_of_a_new_node_break_nothing(repository, compare):
    repository.commit(MANIFEST)
    repository.write({PATH: HEAD + WITHOUT})
    assert breaking(compare(repository)) == []


@pytest.mark.parametrize(("include", "count"), [("rclcpp/rclcpp.hpp", 2), ("gtest/gtest.h", 0)])
def test_program_whose_name_begins_with_test_is_compared(repository, compare, include, count):
    repository.commit(MANIFEST)
    text = f'#include <{include}>\nArm::Arm() : Node("arm") {{ p = create_publisher<Bool>("on", 1); }}\n'
    repository.write({"arm/src/test_arm.cpp": text})
    found = [sentence for item in compare(repository).subjects for sentence in sentences(item)]
    assert len(found) == count
