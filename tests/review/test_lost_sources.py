"""Build files and sources that still name a source or header which was removed or renamed."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

CMAKE = """project(arm)
add_library(arm SHARED
  ${CMAKE_CURRENT_SOURCE_DIR}/src/joint.cpp  # src/other.cpp
  src/arm.cpp)
generate_parameter_library(arm_parameters src/arm.yaml)
ament_export_dependencies(${DEPENDENCIES})
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": CMAKE,
    "arm/src/joint.cpp": "int joint() { return 1; }\n",
    "arm/src/other.cpp": "int other() { return 1; }\n",
    "arm/src/arm.cpp": '#include "arm/limits.hpp"\nint arm() { return LIMIT; }\n',
    "arm/src/arm.yaml": "arm:\n  rate:\n    type: double\n",
    "arm/include/arm/limits.hpp": "#pragma once\nconst int LIMIT = 1;\n",
}


@pytest.fixture
def review_removal(repository, compare):
    """Remove a file, write others and return the breaking changes about files that no longer exist."""

    def run(path, files=(), before=()):
        repository.commit({**FILES, **dict(before)})
        repository.git("rm", "-q", path)
        repository.write(dict(files))
        repository.git("add", "-A")
        return [line for line in breaking(compare(repository)) if "no longer exists" in line]

    return run


@pytest.mark.parametrize("name", ["src/joint.cpp", "src/arm.yaml"])
def test_removed_source_that_the_build_file_names_is_breaking(review_removal, name):
    assert review_removal(f"arm/{name}") == [f"names '{name}', which no longer exists"]


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("protobuf_generate_python(PROTO_PY {})", "proto/state.proto"),
        ("protobuf_generate_cpp(SOURCES HEADERS ${{CMAKE_CURRENT_SOURCE_DIR}}/{})", "proto/state.proto"),
        ("generate_dynamic_reconfigure_options({})", "cfg/Arm.cfg"),
        ("pluginlib_export_plugin_description_file(nav2_core {})", "plugins.xml"),
        ("add_rostest({})", "test/arm.test"),
    ],
)
def test_removed_file_from_which_a_command_generates_code_is_breaking(review_removal, command, name):
    build = {"arm/CMakeLists.txt": f"project(arm)\n{command.format(name)}\n"}
    files = {f"arm/{name}": "syntax = 'proto3';\n", **build}
    assert f"names '{name}', which no longer exists" in review_removal(f"arm/{name}", before=files)


def test_removed_message_that_catkin_names_without_its_folder_is_breaking(review_removal):
    files = {
        "arm/CMakeLists.txt": "project(arm)\nadd_message_files(FILES State.msg)\n",
        "arm/msg/State.msg": "int8 x\n",
    }
    assert "names 'State.msg', which no longer exists" in review_removal("arm/msg/State.msg", before=files)


def test_removed_source_that_only_a_comment_names_is_not_lost(review_removal):
    assert not review_removal("arm/src/other.cpp")


def test_removed_source_that_the_build_file_no_longer_names_is_not_lost(review_removal):
    text = CMAKE.replace("${CMAKE_CURRENT_SOURCE_DIR}/src/joint.cpp", "")
    assert not review_removal("arm/src/joint.cpp", {"arm/CMakeLists.txt": text})


def test_removed_header_that_a_source_includes_is_breaking(review_removal):
    assert review_removal("arm/include/arm/limits.hpp") == ["names 'arm/limits.hpp', which no longer exists"]


@pytest.mark.parametrize("path", ["arm/include/arm/limits.hpp.in", "arm/src/limits.hpp"])
def test_header_that_another_file_may_replace_is_not_lost(review_removal, path):
    assert not review_removal("arm/include/arm/limits.hpp", {path: FILES["arm/include/arm/limits.hpp"]})


def test_variable_without_value_is_no_exported_dependency(repository, compare):
    text = CMAKE.replace("ament_export", "set(DEPENDENCIES rclcpp)\nament_export")
    repository.commit({**FILES, "arm/CMakeLists.txt": text})
    repository.write({"arm/CMakeLists.txt": CMAKE})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert lines == ["exported dependencies removed: 'rclcpp'"]


def test_element_of_sdf_is_no_parameter_of_ros(repository, compare):
    text = 'void P::Load(sdf::ElementPtr _sdf) {\n  getSdfParam(_sdf, "noise", noise_, 0.0);\n}\n'
    repository.commit({**FILES, "arm/src/p.cpp": text})
    repository.write({"arm/src/p.cpp": text.replace("}\n", '  getSdfParam(_sdf, "delay", delay_, 0.5);\n}\n')})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert lines == ["parameters of the plugin added: 'delay'"]


def test_removed_message_of_a_list_that_a_command_reads_is_breaking(review_removal):
    build = 'project(arm)\nset(msg_files\n  "msg/State.msg"\n  "msg/Load.msg"\n)\n{}'
    command = "rosidl_generate_interfaces(${PROJECT_NAME} ${msg_files})\n"
    files = {"arm/msg/State.msg": "int8 x\n", "arm/msg/Load.msg": "int8 x\n"}
    before = {"arm/CMakeLists.txt": build.format(command), **files}
    lost = "names 'msg/State.msg', which no longer exists"
    assert review_removal("arm/msg/State.msg", before=before) == [lost]


def test_removed_message_of_a_list_that_no_command_reads_is_not_lost(review_removal):
    build = "project(arm)\nset(msg_files msg/State.msg)\nrosidl_generate_interfaces(${PROJECT_NAME} ${files})\n"
    before = {"arm/CMakeLists.txt": build, "arm/msg/State.msg": "int8 x\n"}
    assert not review_removal("arm/msg/State.msg", before=before)
