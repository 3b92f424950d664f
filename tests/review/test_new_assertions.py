"""The lines of a review about conditions that functions newly assert."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """void Arm::configure() {{
  {}
  start();
}}
"""
PYTHON = """class Arm:
    def configure(self):
        {}
        self.start()
"""


def review_assertions(repository, compare, path, old, new):
    """Return the lines about a source in which a statement changes."""
    template = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, path: template.format(old)})
    repository.write({path: template.format(new)})
    return [line for subject in compare(repository).subjects for line in sentences(subject)]


@pytest.mark.parametrize(
    ("old", "new", "condition"),
    [
        ("", "ROS_ASSERT(rate_ >= 0 && std::isfinite(arm->rate(1)));",
         "`rate_ >= 0 && std::isfinite(arm->rate(1))`"),
        ("", 'ROS_ASSERT_MSG(rate_ != -1, "rate");', "`rate_ != -1`"),
        ("", "rcpputils::require_true(!ids_.empty());", "`!ids_.empty()`"),
        ("assert(rate_);", "assert(rate_); assert(ids_[0] < 9); assert(ids_[1] < 9);",
         "`ids_[0] < 9`, `ids_[1] < 9`"),
    ],
)  # fmt: skip
def test_a_new_assertion_in_cpp(repository, compare, old, new, condition):
    lines = review_assertions(repository, compare, "arm/src/arm.cpp", old, new)
    assert lines == [f"'Arm::configure()' fails now unless {condition}"]


def test_a_new_assertion_in_python(repository, compare):
    lines = review_assertions(repository, compare, "arm/arm/arm.py", "pass", "assert self.rate > 0, 'rate'")
    assert lines == ["'Arm.configure()' fails now unless `self.rate > 0`"]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", "assert(false);"),
        ("ROS_ASSERT(rate_ > 0);", "ROS_ASSERT(rate_ > 1);"),
        ('ROS_ASSERT_MSG(rate_, "low");', 'ROS_ASSERT_MSG(rate_, "high");'),
        ("", "start(); ASSERT_EQ(rate_, 1);"),
    ],
)
def test_an_assertion_that_may_replace_another_one_or_has_no_condition(repository, compare, old, new):
    lines = review_assertions(repository, compare, "arm/src/arm.cpp", old, new)
    assert not any("fails now" in line for line in lines)
