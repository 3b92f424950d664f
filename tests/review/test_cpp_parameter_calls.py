"""The lines of a review about parameters that a C++ source requires, and about those whose names are in a table."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SOURCE = "bool Arm::init(ros::NodeHandle & nh) {{\n  start();\n{}  return true;\n}}\n"
FAILS = "the program fails where '{}' is not set"
CHECK = '  if (!nh.getParam("mass", mass_)) {\n    ROS_ERROR("no mass");\n    return false;\n  }\n'
TABLE = """  const std::pair<const char *, double *> table[] = {
    {"mass", &mass_}, {"load", &load_},
  };
  for (const auto & entry : table)
    if (!nh.getParam(entry.first, *entry.second))
      return false;
"""
LIST = """  std::vector<std::string> names = {"mass", "load"};
  for (const std::string & name : names) {
    node->declare_parameter<double>(name, 1.0);
  }
"""


@pytest.mark.parametrize(
    ("code", "expected", "reason"),
    [
        (CHECK, "parameters added: 'mass'", FAILS.format("mass")),
        (
            CHECK.replace("return false", 'throw std::runtime_error("no mass")'),
            "parameters added: 'mass'",
            FAILS.format("mass"),
        ),
        (CHECK.replace("return false", "mass_ = 1.0"), "parameters added: 'mass' (1.0)", ""),
        (CHECK.replace("if (", "if (is_heavy && "), "parameters added: 'mass'", ""),
        (CHECK.replace("if (!", "if ("), "parameters added: 'mass'", ""),
        ("  if (is_heavy_) {\n" + CHECK + "  }\n", "parameters added: 'mass'", ""),
        (TABLE, "parameters added: 'mass', 'load'", FAILS.format("mass', 'load")),
        (LIST, "parameters added: 'mass' (1.0), 'load' (1.0)", ""),
        ('  node->declare_parameter<double>("mass");\n', "parameters added: 'mass'", FAILS.format("mass")),
        ('  node->declare_parameter<double>("mass", 1.0);\n', "parameters added: 'mass' (1.0)", ""),
        ('  node->declare_parameter("mass", rclcpp::PARAMETER_DOUBLE);\n', "parameters added: 'mass'", ""),
    ],
)
def test_a_new_parameter_may_be_required(repository, compare, code, expected, reason):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": SOURCE.format("")})
    repository.write({"arm/src/arm.cpp": SOURCE.format(code)})
    result = compare(repository)
    lines = [line for subject in result.subjects for line in sentences(subject)]
    assert expected in lines
    assert [str(change.reason) for _, change in result.breaking_changes] == ([reason] if reason else [])


def test_a_parameter_may_become_required(repository, compare):
    old = '  nh.getParam("mass", mass_);\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": SOURCE.format(old)})
    repository.write({"arm/src/arm.cpp": SOURCE.format(CHECK)})
    assert breaking(compare(repository)) == ["parameter 'mass': required no -> yes"]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", ', ""', "parameter 'tool': default - -> \"\""),
        (", 4", "", "parameter 'tool': default 4 -> -"),
    ],
)
def test_a_declaration_may_get_or_lose_its_default(repository, compare, old, new, expected):
    texts = [SOURCE.format(f'  node->declare_parameter("tool"{default});\n') for default in (old, new)]
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": texts[0]})
    repository.write({"arm/src/arm.cpp": texts[1]})
    (found,) = compare(repository).subjects
    assert expected in sentences(found)


def test_the_value_that_a_variable_gets_without_its_parameter_is_the_default(repository, compare):
    code = '  if (!nh.getParam("mass", mass_)) {\n    mass_ = 1.5;\n    log();\n  }\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": SOURCE.format(code)})
    repository.write({"arm/src/arm.cpp": SOURCE.format(code.replace("1.5", "2.5"))})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == "parameter 'mass': default 1.5 -> 2.5"


def test_a_variable_that_a_call_does_not_set_keeps_its_value(repository, compare):
    code = '  bool is_heavy = false;\n  nh.getParam("is_heavy", is_heavy);\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": SOURCE.format("")})
    repository.write({"arm/src/arm.cpp": SOURCE.format(code)})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == "parameters added: 'is_heavy' (false)"


@pytest.mark.parametrize(
    ("code", "shown"),
    [
        ('  std::string unit = "M";\n  getParam("unit", unit, unit, "The unit", true);\n', "'unit' (\"M\")"),
        ('  getParam("rate", 20, rate_, "The rate");\n', "'rate' (20)"),
        ('  getParam("rate", rate_, other_);\n', "'rate'"),
    ],
)
def test_a_function_of_the_repository_takes_the_default_before_the_variable(repository, compare, code, shown):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": SOURCE.format("")})
    repository.write({"arm/src/arm.cpp": SOURCE.format(code)})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert f"parameters added: {shown}" in lines


GROUP = """Arm::Arm() : Node("arm") {
  declare_parameters<int>("limits", {{"count", 3}, {"depth", {4, describe("depth")}}});
  node->declare_parameters("", std::map<std::string, double>{{"gain", 1.5}});
}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"count", 3', '"count", 5', "parameter 'limits.count': default 3 -> 5"),
        ("{4, d", "{5, d", "parameter 'limits.depth': default 4 -> 5"),
        ('{"count", 3}, ', "", "parameters removed: 'limits.count' (3)"),
        ('"gain"', '"kp"', "parameter 'gain' (1.5) renamed to 'kp' (1.5)"),
        ("<int>", "<double>", "parameter 'limits.count': type int -> double"),
    ],
)
def test_parameters_that_are_declared_together_have_their_namespace(repository, compare, old, new, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": GROUP})
    repository.write({"arm/src/arm.cpp": GROUP.replace(old, new)})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == expected


UNDEFINED = """class Arm {{
  double mass_{0};
  bool read() {{
    {1};
    return ok();
  }}
}};
"""


@pytest.mark.parametrize(
    ("value", "code", "is_breaking"),
    [
        ("", 'nh_.getParam("mass", mass_)', True),
        ("", 'double load; nh_.getParam("load", load)', True),
        (" = 1.0", 'nh_.getParam("mass", mass_)', False),
        ("", 'mass_ = 1.0; nh_.getParam("mass", mass_)', False),
        ("", 'if (!nh_.getParam("mass", mass_)) warn()', False),
        ("", 'nh_.param("mass", mass_, 1.0)', False),
        ("", 'read(mass_); nh_.getParam("mass", mass_)', False),
        ("", 'std::string mass; nh_.getParam("mass", mass)', False),  # empty
    ],
)
def test_a_number_without_a_value_makes_a_new_parameter_breaking(repository, compare, value, code, is_breaking):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": UNDEFINED.format(value, "start()")})
    repository.write({"arm/src/arm.cpp": UNDEFINED.format(value, code)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    name = "load" if "load" in code else "mass"
    assert reasons == ([f"where '{name}' is not set, its variable has no value"] if is_breaking else [])


RANGE = """Arm::Arm() : Node("arm") {{
  rcl_interfaces::msg::ParameterDescriptor slider;
  rcl_interfaces::msg::FloatingPointRange range;
  {}
  declare_parameter<double>("gain", 1.0, slider);
}}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "range.set__from_value(-0.5).set__to_value(2.0).set__step(0.1); slider.floating_point_range = {range};",
         {"parameter 'gain': minimum none -> -0.5": "values below -0.5 are rejected",
          "parameter 'gain': maximum none -> 2.0": "values above 2.0 are rejected"}),
        ("range.to_value = 2.0; slider.floating_point_range.push_back(range);",
         "range.to_value = 3.0; slider.floating_point_range.push_back(range);",
         {"parameter 'gain': maximum 2.0 -> 3.0": None}),
        ("slider.integer_range[0].from_value = 2;", "slider.integer_range[0].from_value = 3;",
         {"parameter 'gain': minimum 2 -> 3": "values below 3 are rejected"}),
        ("slider.integer_range[0].from_value = 2;", "slider.integer_range[0].from_value = kLow;",
         {"parameter 'gain': minimum 2 -> kLow": None}),
        ("", "range.to_value = 2.0; other.floating_point_range.push_back(range);", {}),
    ],
)  # fmt: skip
def test_the_range_of_a_parameter_rejects_values(repository, compare, old, new, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": RANGE.format(old)})
    repository.write({"arm/src/arm.cpp": RANGE.format(new)})
    changes = [change for found in compare(repository).subjects for change in found.changes]
    lines = {str(item.sentence): item.reason and str(item.reason) for item in changes if "gain" in str(item.sentence)}
    assert lines == expected


FLAG = """int main(int argc, char** argv) {
  ros::NodeHandle nh;
  double mass = 0.0;
  double load = 0.0;
  bool ok = true;
  BODY
  ros::spin();
  return 0;
}
"""
LOAD = 'ok &= nh.getParam("load", load);'
FAIL = 'if (!ok) { ROS_ERROR("no value"); return 1; }'


@pytest.mark.parametrize(
    ("code", "is_breaking"),
    [
        ('ok &= nh.getParam("mass", mass); LOAD FAIL', True),
        ('ok = ok && nh.getParam("mass", mass); ok = ok && nh.getParam("load", load); FAIL', True),
        ('ok = nh.getParam("mass", mass); FAIL', True),
        # another call replaces the result, any of them is enough, or the program continues
        ('ok = nh.getParam("mass", mass); ok = nh.getParam("load", load); FAIL', False),
        ('ok |= nh.getParam("mass", mass); ok |= nh.getParam("load", load); FAIL', False),
        ('ok &= nh.getParam("mass", mass); if (!ok) ROS_WARN("no mass");', False),
        ('ok &= nh.getParam("mass", mass); if (argc > 1) { FAIL }', False),
    ],
)
def test_a_parameter_whose_result_is_tested_later_is_required(repository, compare, code, is_breaking):
    code = code.replace("LOAD", LOAD).replace("FAIL", FAIL)
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/arm.cpp": FLAG.replace("BODY", "")})
    repository.write({"arm/src/arm.cpp": FLAG.replace("BODY", code)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    assert any("'mass'" in reason for reason in reasons) is is_breaking, reasons
