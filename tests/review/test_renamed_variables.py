"""The lines of a review about renamed variables with another value, and about constants that functions newly return."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """int main(int argc, char ** argv) {{
  std::string {0}("{1}");
  if (argc > 1) {{
    {0} = argv[1];
  }}
  load({0});
}}
"""
PYTHON = "def main():\n    {0} = {1}\n    if len(argv) > 1:\n        {0} = argv[1]\n    load({0})\n"
PLAN = "int Arm::plan(int goal) {{\n  if (goal < 0) {{\n    {}\n  }}\n  return Result::SUCCESS;\n}}\n"


@pytest.fixture
def review_source(repository, compare):
    """Review another text of a source, and return the lines."""

    def run(path, old, new):
        repository.commit({**MANIFEST, path: old})
        repository.write({path: new})
        result = compare(repository)
        assert not breaking(result)
        return [line for subject in result.subjects for line in sentences(subject)]

    return run


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        (
            "arm/src/load.cpp",
            CPP.format("bag", "poses.bag"),
            CPP.format("source", "poses.yaml"),
            ['values in main: bag "poses.bag" -> source "poses.yaml"'],
        ),
        ("arm/arm/load.py", PYTHON.format("rate", 3), PYTHON.format("speed", 5), ["values in main: rate 3 -> speed 5"]),
        ("arm/src/load.cpp", CPP.format("bag", "a.bag"), CPP.format("source", "a.bag"), []),
        (
            "arm/src/load.cpp",
            CPP.format("bag", "a.bag"),
            'int main() {\n  std::string name("arm");\n  log(name);\n}\n',
            [],
        ),
    ],
)
def test_a_renamed_variable_with_another_value(review_source, path, old, new, expected):
    lines = review_source(path, old, new)
    assert [line for line in lines if line.startswith("values in")] == expected


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("stop();", "return Result::TF_ERROR;", ["'Arm::plan()' returns Result::TF_ERROR now"]),
        ("return Result::INVALID;", "return Result::INVALID_GOAL;", []),  # may be another name
        ("code = Result::INVALID; return code;", "return Result::INVALID;", []),
        ("return ERROR;", "return Result::ERROR;", []),
        ("stop();", "return result;", []),
    ],
)
def test_a_constant_that_a_function_newly_returns(review_source, old, new, expected):
    lines = review_source("arm/src/arm.cpp", PLAN.format(old), PLAN.format(new))
    assert [line for line in lines if "returns" in line] == expected


@pytest.mark.parametrize(("text", "is_told"), [("eth_device", False), ("card", True)])
def test_a_variable_with_the_name_of_its_parameter_is_renamed_with_it(repository, compare, text, is_told):
    code = """int Arm::on_init() {{
  std::string {0} = info_.hardware_parameters["{1}"];
  return ec_init({0}.c_str());
}}
"""
    repository.commit({**MANIFEST, "arm/src/arm.cpp": code.format("interface_name", "interface_name")})
    repository.write({"arm/src/arm.cpp": code.format("eth_device", text)})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert lines[0] == f'values in Arm::on_init: info_.hardware_parameters["interface_name" -> "{text}"]'
    assert lines[1:] == (["code changed in 'Arm::on_init()'"] if is_told else [])
