"""The lines of a review about parameters that hardware of ros2_control requires, or reads with its own functions."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/src/arm.cpp"
HARDWARE = """#include <hardware_interface/system_interface.hpp>
{}
class Arm : public hardware_interface::SystemInterface {{
  std::string port_;
  int limit_ = 5;
  CallbackReturn on_init(const HardwareInfo & info) {{
    auto & all = info_.hardware_parameters;
    {}
    return CallbackReturn::SUCCESS;
  }}
}};
"""
ERROR = "{ return hardware_interface::CallbackReturn::ERROR; }"
END = "info_.hardware_parameters.end()"
FIND = 'info_.hardware_parameters.find("port")'
COUNT = 'info_.hardware_parameters.count("port")'
READ = '{ port_ = info_.hardware_parameters.at("port"); }'
FUNCTION = """std::string value_or(
  const std::unordered_map<std::string, std::string> & texts, const std::string & key, const std::string & other) {
  auto it = texts.find(key);
  return it != texts.end() ? it->second : other;
}"""
LAMBDA = (
    "auto read = [&](const std::string & key, int other) { return all_of(info_.hardware_parameters.at(key), other); };"
)


@pytest.mark.parametrize(
    ("code", "is_required"),
    [
        (f"if ({FIND} != {END}) {READ} else {ERROR}", True),
        (f"if ({FIND} == {END}) {ERROR}\n    {READ}", True),
        (f"if (!{COUNT} || other_) {ERROR}\n    {READ}", True),
        (f"if ({COUNT} == 0) {ERROR}\n    {READ}", True),
        (f"auto it = {FIND};\n    if (it == {END}) {ERROR}\n    port_ = it->second;", True),
        (f"if (auto it = {FIND}; it != {END}) {{ port_ = it->second; }} else {ERROR}", True),
        (f"try {{ g(); }} catch (const E & e) {ERROR}\n    if ({COUNT} > 0) {READ} else {ERROR}", True),
        (f"if ({FIND} != {END}) {READ}", False),
        (f"if ({FIND} != {END} || other_) {READ} else {ERROR}", False),
        (f"if (!{COUNT} && other_) {ERROR}\n    if ({COUNT}) {READ}", False),
        (f"if ({COUNT}) {READ} else if (other_) {ERROR}", False),
        (f"if (other_) {{ if ({COUNT}) {READ} else {ERROR} }}", False),
        (f"if (other_) {{ g(); }} else if (!{COUNT}) {ERROR}", False),
        (f"if ({COUNT}) {ERROR}", False),
        (f"auto it = {FIND};\n    if (other_) {ERROR}", False),
    ],
)
def test_hardware_requires_a_parameter_without_which_it_fails(repository, compare, code, is_required):
    repository.commit({**MANIFEST, PATH: HARDWARE.format("", "g();")})
    repository.write({PATH: HARDWARE.format("", code)})
    result = compare(repository)
    assert breaking(result) == (["parameters of the hardware added: 'port'"] if is_required else [])
    assert any("parameters of the hardware added: 'port'" in line for line in sentences(subject(result, PATH)))


@pytest.mark.parametrize(
    ("function", "code", "expected"),
    [
        (FUNCTION, 'limit_ = std::stoi(value_or(all, "limit", std::to_string(limit_)));', "'limit' (5)"),
        (FUNCTION, 'port_ = value_or(all, "port", "tty0");', "'port' (\"tty0\")"),
        ("", f'{LAMBDA}\n    g(read("rate", 20));', "'rate' (20)"),
        (FUNCTION, "port_ = value_or(all, key_, port_);", None),
        (FUNCTION.replace("texts.find(key)", "texts.begin()"), 'port_ = value_or(all, "port", "tty0");', None),
    ],
)
def test_functions_of_hardware_read_parameters_with_a_default(repository, compare, function, code, expected):
    repository.commit({**MANIFEST, PATH: HARDWARE.format(function, "g();")})
    repository.write({PATH: HARDWARE.format(function, code)})
    found = [line for line in sentences(subject(compare(repository), PATH)) if "of the hardware" in line]
    assert found == ([] if expected is None else [f"parameters of the hardware added: {expected}"])
