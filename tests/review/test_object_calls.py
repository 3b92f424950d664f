"""The lines of a review about calls in C++ of methods that the class of an object does not have."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

HEADER = """#pragma once
namespace lift {
class Motor {
public:
  void start();
  void stop();
};
}
"""
SOURCE = """#include "motor.hpp"
#include <memory>
class Lift {
private:
  std::unique_ptr<lift::Motor> motor_;
  void run() {
    motor_->start();
  }
};
"""
FILES = {"lift/package.xml": PACKAGE_XML.replace("arm_description", "lift"), "lift/src/motor.hpp": HEADER}
SENTENCE = "calls the method '{}', which 'Motor' in 'lift/src/motor.hpp' does not have"
PATH = "lift/src/lift.cpp"


def review(repository, compare, header, source):
    repository.commit({**FILES, PATH: SOURCE})
    repository.write({"lift/src/motor.hpp": header, PATH: source})
    return [line for line in breaking(compare(repository)) if "does not have" in line]


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        ("motor_->start();", "motor_->turn();", True),
        ("motor_->start();", "lift::Motor other; other.turn();", True),
        ("motor_->start();", "motor_->stop();", False),
        ("motor_->start();", "motor_.turn();", False),
        ("motor_->start();", "this->motor_->start(); drive.motor_->turn();", False),
        ("motor_->start();", "for (auto motor_ : motors) motor_->turn();", False),
        ("motor_->start();", "auto [motor_, b] = find(); motor_->turn();", False),
        ("void run() {\n    motor_->start();", "void run(Drive* motor_) {\n    motor_->turn();", False),
        ("unique_ptr<lift::Motor> motor_;", "unique_ptr<other::Motor> motor_; void go() { motor_->turn(); }", False),
    ],
)
def test_a_method_that_the_class_does_not_have(repository, compare, old, new, is_told):
    lines = review(repository, compare, HEADER, SOURCE.replace(old, new))
    assert lines == ([SENTENCE.format("turn")] if is_told else [])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("class Motor {", "class Motor : public Base {"),
        ("class Motor {", "template <typename T>\nclass Motor {"),
        ("  void stop();", "  void stop();\n  METHODS(turn_)"),
        ("  void stop();", "  void stop();\n  Motor* operator->();"),
        ("}\n", "}\nclass Motor { };\n"),
    ],
)
def test_a_class_that_may_have_more_methods(repository, compare, old, new):
    assert review(repository, compare, HEADER.replace(old, new), SOURCE.replace("->start", "->turn")) == []


def test_a_source_that_does_not_include_the_class(repository, compare):
    source = SOURCE.replace('#include "motor.hpp"\n', "").replace("->start", "->turn")
    assert review(repository, compare, HEADER, source) == []


def test_a_removed_method_that_objects_still_call(repository, compare):
    assert review(repository, compare, HEADER.replace("start", "turn"), SOURCE) == [SENTENCE.format("start")]
