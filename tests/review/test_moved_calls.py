"""The lines of a review about calls that move into a condition or out of one."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """void Arm::on_timer() {{
  state_ = read();
  {}
}}
"""
PYTHON = """class Arm:
    def on_timer(self):
        state = self.read()
        {}
"""
INSIDE = "if (key_ != 0) { state_ = 1; publisher_->publish(state_); }"
OUTSIDE = "if (key_ != 0) { state_ = 1; } else { state_ = 2; }\n  publisher_->publish(state_);"
GUARDED = "if (key_ == 0) { return; }\n  if (key_ != 0) { state_ = 1; }\n  publisher_->publish(state_);"
PYTHON_INSIDE = "if self.key:\n            state = 1\n            self.pub.publish(state)"
PYTHON_OUTSIDE = "if self.key:\n            state = 1\n        self.pub.publish(state)"


def review_calls(repository, compare, path, old, new):
    repository.commit({**MANIFEST, path: old})
    repository.write({path: new})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    return [line for line in lines if "publish()`" in line]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (INSIDE, OUTSIDE, ["in 'Arm::on_timer()': `publisher_->publish()` no longer only if key_ != 0"]),
        (OUTSIDE, INSIDE, ["in 'Arm::on_timer()': `publisher_->publish()` now only if key_ != 0"]),
        (INSIDE, GUARDED, []),  # the other condition leaves the function
        (INSIDE, "state_ = 3; publisher_->publish(state_);", []),  # the line about the condition tells it
        (INSIDE, INSIDE.replace("= 1", "= 4"), []),
        (OUTSIDE, INSIDE + " publisher_->publish(other_);", []),
    ],
)
def test_call_that_moves_out_of_a_condition_is_told(repository, compare, old, new, expected):
    assert review_calls(repository, compare, "arm/a.cpp", CPP.format(old), CPP.format(new)) == expected


def test_call_in_python_that_moves_out_of_a_condition_is_told(repository, compare):
    old, new = PYTHON.format(PYTHON_INSIDE), PYTHON.format(PYTHON_OUTSIDE)
    expected = ["in 'Arm.on_timer()': `self.pub.publish()` no longer only if self.key"]
    assert review_calls(repository, compare, "arm/arm/a.py", old, new) == expected
