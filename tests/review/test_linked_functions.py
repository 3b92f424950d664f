"""Lines of a review about C++ that depend on what the package builds and on the branches of the preprocessor."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

HEADER = """#pragma once
class Base {
 public:
  bool reset();
  bool scale(int factor) { return factor > 1; }
  bool stop();
 protected:
#if NEW >= 1
  asio::io::strand strand_;
#else
  asio::strand strand_;
#endif
};
inline bool Base::stop() { return true; }
"""
CATKIN = (
    "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package(INCLUDE_DIRS include)\nadd_executable(n src/n.cpp)\n"
)
COMPONENT = """project(arm)
find_package(ament_cmake REQUIRED)
add_library(core SHARED src/core.cpp)
rclcpp_components_register_node(core PLUGIN "arm::Server" EXECUTABLE {})
install(TARGETS core DESTINATION lib)
ament_package()
"""
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}


@pytest.mark.parametrize("library", ["", "add_library(core src/core.cpp)\n"])
@pytest.mark.parametrize(
    ("old", "new", "is_inline"),
    [("bool reset();", "bool reset(int count);", False), ("scale(int factor)", "scale(int factor, int more)", True)],
)
def test_functions_without_code_break_callers_only_if_a_library_has_it(
    repository, compare, library, old, new, is_inline
):
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": CATKIN + library, "arm/include/arm/base.hpp": HEADER})
    repository.write({"arm/include/arm/base.hpp": HEADER.replace(old, new)})
    result = compare(repository)
    (line,) = [line for subject in result.subjects for line in sentences(subject)]
    assert line.startswith("function 'Base::")
    assert bool(breaking(result)) is (is_inline or bool(library))


def test_a_function_that_is_defined_below_its_class_has_code(repository, compare):
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": CATKIN, "arm/include/arm/base.hpp": HEADER})
    new = HEADER.replace("bool stop();", "bool stop(int a);").replace("::stop()", "::stop(int a)")
    repository.write({"arm/include/arm/base.hpp": new})
    assert breaking(compare(repository)) == ["function 'Base::stop': () -> (int)"]


def test_a_member_of_two_branches_has_both_types(repository, compare):
    branches = HEADER[HEADER.index("#if") : HEADER.index("#endif")]
    first, second = "asio::io::strand strand_;", "asio::strand strand_;"
    swapped = HEADER.replace(branches, f"#if NEW < 1\n  {second}\n#else\n  {first}\n")
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": CATKIN, "arm/include/arm/base.hpp": HEADER})
    repository.write({"arm/include/arm/base.hpp": swapped})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert not any("strand_" in line for line in lines if "type" in line)
    repository.write({"arm/include/arm/base.hpp": HEADER.replace(f"  {second}", "  asio::other strand_;")})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert (
        "protected member 'Base::strand_': type asio::io::strand or asio::strand -> asio::io::strand or asio::other"
        in lines
    )


def test_the_program_of_a_component_is_renamed(repository, compare):
    source = 'Server::Server() : rclcpp::Node("{}") {{}}\n'
    files = {"arm/src/log.hpp": 'auto logger = rclcpp::get_logger("server");\n', **MANIFEST}
    repository.commit(
        {**files, "arm/CMakeLists.txt": COMPONENT.format("server"), "arm/src/core.cpp": source.format("server")}
    )
    repository.write(
        {"arm/CMakeLists.txt": COMPONENT.format("arm_server"), "arm/src/core.cpp": source.format("arm_server")}
    )
    assert sorted(breaking(compare(repository))) == [
        "installed executables: 'server' renamed to 'arm_server'",
        "node 'server' renamed to 'arm_server'",
    ]


@pytest.mark.parametrize(
    ("type_name", "reason"),
    [
        ("Bool", "if the node has a namespace, programs that use the name '/done' do not find it"),
        ("Int8", "programs that use '/done' with the old type get nothing"),
    ],
)
def test_a_topic_that_moves_into_the_namespace_of_its_node(repository, compare, type_name, reason):
    text = 'void f() { p_ = node->create_publisher<Bool>("/done", 1); }\n'
    repository.commit({**MANIFEST, "arm/src/n.cpp": text})
    repository.write({"arm/src/n.cpp": text.replace("/done", "done").replace("Bool", type_name)})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == reason


def test_a_member_whose_type_has_another_meaning_shows_both_types(repository, compare):
    alias = HEADER.replace("bool stop();\n", "bool stop();\n  using Strand = asio::first;\n")
    text = alias.replace("#if NEW >= 1\n", "  Strand next_;\n#if NEW >= 1\n")
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": CATKIN, "arm/include/arm/base.hpp": text})
    repository.write({"arm/include/arm/base.hpp": text.replace("asio::first", "asio::second")})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert "protected member 'Base::next_': type asio::first -> asio::second" in lines


@pytest.mark.parametrize(
    ("declaration", "is_told"), [("class Phase;\n", True), ("namespace arm { class Phase; }\n", False), ("", False)]
)
def test_a_class_outside_of_namespaces_is_another_type_than_a_message(repository, compare, declaration, is_told):
    text = HEADER.replace("bool reset();", "bool reset(const Phase & phase);").replace(
        "class Base", f"{declaration}class Base"
    )
    new = text.replace(declaration, "").replace("const Phase &", "const walk::msg::Phase &") if declaration else None
    new = new or text.replace("const Phase &", "const walk::msg::Phase &")
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": CATKIN, "arm/include/arm/base.hpp": text})
    repository.write({"arm/include/arm/base.hpp": new})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert ("function 'Base::reset': (const Phase&) -> (const walk::msg::Phase&)" in lines) is is_told
