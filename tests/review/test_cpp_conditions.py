"""The lines of a review about conditions of the preprocessor in C++ sources."""

from __future__ import annotations

import pytest

from linkwright.review.sources.cpp.preprocessor import Conditions, blank_disabled
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/src/arm.cpp"
LOST = "publishers removed: 'state' (String)"
ADDED = "publishers added: 'state' (String)"


def make_source(before: str = "", after: str = "", start: str = "", line: str = "") -> str:
    line = line or 'p_ = create_publisher<std_msgs::msg::String>("state", 10);'
    return f"""#include <rclcpp/rclcpp.hpp>
{start}
Arm::Arm() : Node("arm") {{
{before}
  {line}
{after}
  declare_parameter("rate", 1);
  p_->publish(message);
}}
"""


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("#if 0", "#endif", [LOST]),
        ("#if 0 /* not \"yet */", "#endif // 0", [LOST]),
        ("#if 0\n#ifdef DEBUG\n#endif", "#else\n#endif", [LOST]),
        ("#if 1\n#else", "#endif", [LOST]),
        ("#if DEBUG && 0\n#elif 1\n#else", "#endif", [LOST]),
        ("#if 1", "#else\n  broken(\n#endif", []),
        ("#ifdef DEBUG", "#endif", ["publisher 'state': condition - -> defined(DEBUG)"]),
        ("#if not_known(3)", "#endif", ["publisher 'state': condition - -> not_known(3)"]),
        ("#ifdef DEBUG\n  f();\n#else", "#endif", ["publisher 'state': condition - -> !defined(DEBUG)"]),
        ("// #if 0", "// #endif", []),
        ("#if 0", "", []),
    ],
)  # fmt: skip
def test_code_that_gets_a_condition_of_the_preprocessor(repository, compare, before, after, expected):
    repository.commit({**MANIFEST, PATH: make_source()})
    repository.write({PATH: make_source(before, after)})
    result = compare(repository)
    found = [text for found in result.subjects for text in sentences(found) if not text.startswith("code changed")]
    assert found == expected
    assert breaking(result) == [text for text in expected if text == LOST]


def test_code_that_is_enabled_is_added(repository, compare):
    repository.commit({**MANIFEST, PATH: make_source("#if 0", "#endif")})
    repository.write({PATH: make_source()})
    (found,) = compare(repository).subjects
    assert sentences(found) == [ADDED]


def test_removed_disabled_code_is_no_change(repository, compare):
    repository.commit({**MANIFEST, PATH: make_source(start='#if 0\nvoid f() { n.advertise<Bool>("on", 1); }\n#endif')})
    repository.write({PATH: make_source()})
    result = compare(repository)
    assert not breaking(result)
    assert not result.subjects


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (make_source(line="f();"), make_source("#ifdef DEBUG", "#endif", line="f();"), "code changed in 'Arm::Arm()'"),
        (make_source(start="#define DEBUG"), make_source(), "outside of functions: `define DEBUG` removed"),
    ],
)
def test_conditions_of_other_code_are_compared(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, PATH: old})
    repository.write({PATH: new})
    (found,) = compare(repository).subjects
    assert sentences(found) == [expected]


def test_name_of_a_guard_is_no_change(repository, compare):
    text = "#ifndef {0}\n#define {0}\nclass Arm {{ public: void stop(); }};\n#endif  // {0}\n"
    path = "arm/include/arm/arm.hpp"
    repository.commit({**MANIFEST, path: text.format("ARM_H_")})
    repository.write({path: text.format("ARM__ARM_HPP_")})
    assert not compare(repository).subjects


def test_name_under_both_conditions_has_none_and_no_certain_type(repository, compare):
    line = 'p_ = create_publisher<std_msgs::msg::Bool>("state", 10);'
    repository.commit({**MANIFEST, PATH: make_source()})
    repository.write({PATH: make_source(f"#ifdef NEW\n{line}\n#else", "#endif")})
    result = compare(repository)
    assert not breaking(result)
    assert not [text for found in result.subjects for text in sentences(found) if "condition" in text]


def test_conditions_of_nested_branches():
    text = "a\n#if defined A || B\nb\n#if 1\nc\n#elif X\nd\n#endif\n#elif C > 3\ne\n#endif\nf\n"
    conditions = Conditions(text)
    assert [conditions.find(text.index(f"\n{name}\n") + 1) for name in "bcef"] == [
        "defined(A) || B", "defined(A) || B", "!(defined(A) || B) && C > 3", "",
    ]  # fmt: skip
    assert blank_disabled(text) == text.replace("\nd\n", "\n \n")


@pytest.mark.parametrize(
    "text", ["#if 0\nx\n", "#endif\nx", "#else\n#if 0\nx\n#endif", 'R"(\n#if 0\n)"; x R"(\n#endif\n)"']
)
def test_code_with_directives_that_do_not_match_is_not_disabled(text):
    assert blank_disabled(text) == text
