"""Types of C++ as callers see them."""

from __future__ import annotations

import pytest

from linkwright.review.sources.cpp.types import accepts_type, can_use_result, is_same_type, normalize_type
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n",
}
HEADER = """#pragma once
class Arm {
public:
  Arm(std::string const& name, unsigned count, double values[]);
  double length(const Pose& pose, struct Limits limits) const;
  virtual bool move(Goal goal) = 0;
};
"""


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("std::string const &", "const std::string&"),
        ("unsigned", "unsigned int"),
        ("long int", "long"),
        ("unsigned long long int", "unsigned long long"),
        ("double []", "double*"),
        ("const double", "double"),
        ("double const", "double"),
        ("struct Q", "Q"),
        ("int * const", "int *"),
        ("std::shared_ptr<Pose const>", "std::shared_ptr<const Pose>"),
        ("std::map<std::string, unsigned> const &", "const std::map<std::string,unsigned int>&"),
        ("std::function<void (int , double)>", "std::function<void(int, double)>"),
        ("std::function<void ( Pose const & )>", "std::function<void(const Pose&)>"),
    ],
)
def test_notations_of_a_type_are_equal(first, second):
    assert normalize_type(first) == normalize_type(second)


@pytest.mark.parametrize(
    ("first", "second"), [("const char*", "char*"), ("int", "unsigned int"), ("long", "long long"), ("Q&", "Q")]
)
def test_different_types_are_not_equal(first, second):
    assert not is_same_type(normalize_type(first), normalize_type(second))


def test_namespace_may_be_left_out():
    assert is_same_type("const Pose&", "const arm::Pose&")
    assert not is_same_type("const a::Pose&", "const b::Pose&")


@pytest.mark.parametrize(
    ("old", "new", "accepts"),
    [
        ("std::string", "const std::string&", True),
        ("char*", "const char*", True),
        ("Pose&", "const Pose&", True),
        ("float", "double", True),
        ("std::shared_ptr<Pose>", "const std::shared_ptr<const Pose>&", True),
        ("const char*", "char*", False),
        ("const Pose&", "Pose&", False),
        ("double", "int", False),
        ("Pose", "Twist", False),
        ("std::shared_ptr<const Pose>", "std::shared_ptr<Pose>", False),
    ],
)
def test_parameter_accepts_the_arguments_for_the_old_type(old, new, accepts):
    assert accepts_type(old, new) is accepts


@pytest.mark.parametrize(
    ("old", "new", "builds"),
    [("int", "double", True), ("void", "bool", True), ("const Pose*", "Pose*", True), ("bool", "Result", False)],
)
def test_code_that_uses_the_old_result_may_build(old, new, builds):
    assert can_use_result(old, new) is builds


@pytest.mark.parametrize(
    ("old", "new", "lines", "is_breaking"),
    [
        ("std::string const& name, unsigned count", "const std::string &name, unsigned int count", [], False),
        ("struct Limits limits", "const arm::Limits limits", [], False),
        (
            "double values[]",
            "const double values[]",
            [
                (
                    "function 'Arm::Arm': (const std::string&, unsigned int, double*) -> "
                    "(const std::string&, unsigned int, const double*)"
                )
            ],
            False,
        ),
        ("double length", "float length", ["function 'Arm::length': result double -> float"], False),
        ("double length", "Length length", ["function 'Arm::length': result double -> Length"], True),
        ("Goal goal", "const Goal& goal", ["function 'Arm::move': (Goal) -> (const Goal&)"], True),  # others define it
    ],
)
def test_function_of_a_header_is_compared_by_what_its_callers_see(repository, compare, old, new, lines, is_breaking):
    repository.commit({**FILES, "a/include/arm/arm.hpp": HEADER})
    repository.write({"a/include/arm/arm.hpp": HEADER.replace(old, new)})
    result = compare(repository)
    found = [line for item in result.subjects for line in sentences(item) if line.startswith("function")]
    assert found == lines
    assert breaking(result) == (lines if is_breaking else [])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("int32_t", "size_t"),
        ("const std::uint8_t&", "int"),
        ("long", "int"),
        ("uint16_t", "float"),
        ("unsigned", "const double&"),
    ],
)
def test_a_parameter_of_another_integer_type_takes_the_old_arguments(old, new):
    assert accepts_type(normalize_type(old), normalize_type(new))
    assert not accepts_type(normalize_type(old), "std::string")
    assert not accepts_type("int&", "long&")


@pytest.mark.parametrize(("declaration", "is_breaking"), [("class Pose;\n", True), ("", False)])
def test_a_class_that_the_header_declared_is_another_one_than_that_of_a_namespace(
    repository, compare, declaration, is_breaking
):
    path, old = "a/include/a/arm.hpp", HEADER.replace("class Arm", declaration + "class Arm")
    repository.commit({**FILES, path: old})
    repository.write({path: HEADER.replace("const Pose&", "const robot_msgs::msg::Pose&")})
    lost = ["function 'Arm::length': (const Pose&, Limits) -> (const robot_msgs::msg::Pose&, Limits)"]
    assert breaking(compare(repository)) == (lost if is_breaking else [])
