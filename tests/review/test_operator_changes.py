"""The lines of a review about statements in which only an operator differs."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """void Arm::f() {
  azimuth_ = -std::atan2(east, north);
  if (a < b && !ready_) { g(x); }
  while (count <= limit_) { step(); }
  y = x * 2 + z;
  total += value;
  std::vector<int> * p = h(q);
  return a - b;
}
"""
PYTHON = "def f(self):\n    if self.a < 3 and self.b:\n        g(1)\n    return not self.c\n"


@pytest.mark.parametrize(
    ("path", "text", "old", "new", "expected"),
    [
        ("a.cpp", CPP, "-std::atan2", "std::atan2",
         "values in Arm::f: azimuth_ -std::atan2(east, north) -> std::atan2(east, north)"),
        ("a.cpp", CPP, "a < b", "a <= b", "values in Arm::f: a < b -> a <= b"),
        ("a.cpp", CPP, "&&", "||", "values in Arm::f: a < b && !ready_ -> a < b || !ready_"),
        ("a.cpp", CPP, "!ready_", "ready_", "values in Arm::f: !ready_ -> ready_"),
        ("a.cpp", CPP, "<= limit_", "< limit_", "values in Arm::f: count <= limit_ -> count < limit_"),
        ("a.cpp", CPP, "x * 2", "x / 2", "values in Arm::f: y x * 2 + z -> x / 2 + z"),
        ("a.cpp", CPP, "total +=", "total -=", "values in Arm::f: total += value -> total -= value"),
        ("a.cpp", CPP, "a - b", "b - a", "in 'Arm::f()': `return a - b` -> `return b - a`"),
        ("a.cpp", CPP, "<int> *", "<int> &",
         "in 'Arm::f()': `std::vector<int> * p = h(q)` -> `std::vector<int> & p = h(q)`"),
        ("a.py", PYTHON, "< 3", "<= 3", "values in f: self.a < 3 -> self.a <= 3"),
        ("a.py", PYTHON, "not ", "", "values in f: return not self.c -> self.c"),
    ],
)  # fmt: skip
def test_an_operator_that_is_the_only_difference_is_a_value(repository, compare, path, text, old, new, expected):
    repository.commit({**MANIFEST, f"arm/{path}": text})
    assert text.count(old) == 1
    repository.write({f"arm/{path}": text.replace(old, new)})
    (found,) = compare(repository).subjects
    assert sentences(found) == [expected]
