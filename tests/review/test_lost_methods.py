"""C++ sources that call a method of their class which the header lost."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

HEADER = """#pragma once
class Arm {
public:
  void start();
private:
  void move_to(double x);
};
"""
SOURCE = """#include "arm.hpp"
void Arm::move_to(double x) { set(x); }
void Arm::start() {
  this->move_to(1.0);
}
"""
FILES = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/src/arm.cpp": SOURCE}
SENTENCE = "calls the method 'move_to', which 'Arm' in 'arm/src/arm.hpp' does not have"


@pytest.mark.parametrize(
    ("header", "source", "is_breaking"),
    [
        (HEADER.replace("move_to", "drive_to"), SOURCE.replace("::move_to", "::drive_to"), True),
        (HEADER.replace("move_to", "drive_to"), SOURCE.replace("move_to", "drive_to"), False),
        (HEADER.replace("move_to", "drive_to").replace("Arm {", "Arm : public Base {"), SOURCE, False),
        (HEADER.replace("private:\n", "").replace("void start();", "void start();\nprivate:"), SOURCE, False),
        (HEADER.replace("move_to", "drive_to"), SOURCE.replace("Arm::start", "Leg::start"), False),
    ],
)
def test_a_call_of_a_lost_method_is_breaking(repository, compare, header, source, is_breaking):
    repository.commit({**FILES, "arm/src/arm.hpp": HEADER})
    repository.write({"arm/src/arm.hpp": header, "arm/src/arm.cpp": source})
    assert (SENTENCE in breaking(compare(repository))) == is_breaking
