"""The lines of a review about methods of class templates that are defined outside of the class."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
SOURCE = """template<class T, int N>
typename Node<T, N>::Result Node<T, N>::setup(int count)
{
  create_publisher<std_msgs::msg::String>("state", 10);
  limit(0.5, count);
  while (count) { step(count); }
}
template<>
bool Node<std::vector<int>, 4>::operator==(const Node & other) const
{
  return same(other, 1);
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"state"', '"status"', ["publisher 'state' (String) renamed to 'status' (String)"]),
        ("0.5", "0.7", ["values in Node::setup: limit(0.5 -> 0.7, ...)"]),
        ("step(count)", "step(count - 1, N)", ["in 'Node::setup()': `step(count)` -> `step(count - 1, N)`"]),
        ("same(other, 1)", "same(other, 2)", ["values in Node::operator==: same(other, 1 -> 2)"]),
    ],
)
def test_methods_of_a_class_template_have_the_name_of_the_class(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": SOURCE})
    repository.write({"arm/src/arm.cpp": SOURCE.replace(old, new)})
    (found,) = compare(repository).subjects
    assert sentences(found) == expected
