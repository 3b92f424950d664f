"""Names of a source that are edited alike are one line of a review."""

from __future__ import annotations

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/src/arm.cpp"
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
SOURCE = """void Arm::setUp(ros::NodeHandle & nh) {{
  nh.param("{0}/speed", speed_, 1.5);
  nh.param("{0}/force", force_, 20.0);
  nh.param("{0}/{1}", name_, std::string("left"));
}}
"""


def review_source(repository, compare, old, new):
    repository.commit({**MANIFEST, PATH: old})
    repository.write({PATH: new})
    result = compare(repository)
    return subject(result, PATH), breaking(result)


def test_parameters_with_another_prefix_are_one_line(repository, compare):
    old, new = SOURCE.format("cfg_limit", "arm_name"), SOURCE.format("limit", "arm_name")
    source, lost = review_source(repository, compare, old, new)
    assert len(source.changes) == len(lost) == 1
    (change,) = source.changes
    assert str(change.sentence) == "parameter 'cfg_limit/speed' (1.5) renamed to 'limit/speed' (1.5)"
    assert change.other_names == (
        "cfg_limit/force (20.0) -> limit/force (20.0)",
        'cfg_limit/arm_name ("left") -> limit/arm_name ("left")',
    )
    assert [location.line for location in change.other_locations] == [3, 4]


def test_parameter_that_is_edited_otherwise_has_its_own_line(repository, compare):
    old, new = SOURCE.format("limit", "arm_name"), SOURCE.format("limit", "robot_arm")
    new = new.replace('"limit/speed"', '"limit/max_speed"')
    source, lost = review_source(repository, compare, old, new)
    assert len(sentences(source)) == len(lost) == 2
    assert not any(change.other_names for change in source.changes)


def test_functions_with_another_notation_are_one_line(repository, compare):
    header = "class Arm {{\npublic:\n  void {}(double a);\n  int {}(int b);\n  bool {}(char c);\n}};\n"
    build = "project(arm)\nfind_package(ament_cmake REQUIRED)\nadd_library(arm src/arm.cpp)\n"
    build += "install(TARGETS arm)\ninstall(DIRECTORY include/ DESTINATION include)\nament_package()\n"
    path = "arm/include/arm/arm.hpp"
    old = header.format("setSpeed", "getHTTPCode", "stop")
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": build, path: old})
    repository.write({path: header.format("set_speed", "get_http_code", "stop_now")})
    changes = [change for change in subject(compare(repository), path).changes if change.reason is not None]
    assert ["setSpeed" in str(change.sentence) for change in changes] == [True, False]
    assert changes[0].other_names == ("Arm::getHTTPCode (int) -> Arm::get_http_code (int)",)
    assert "stop" not in str(changes[0].sentence)
