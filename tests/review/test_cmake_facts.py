"""The lines of a review about changes of a CMakeLists.txt.

The tests cover targets, conditions, versions and interfaces.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"a/package.xml": PACKAGE_XML.replace("arm_description", "arm")}

AMENT = """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
find_package(Eigen3 3.3 REQUIRED)
find_package(rclcpp REQUIRED)
if(NOT rclcpp_FOUND)
  message(WARNING "no rclcpp")
endif()
rosidl_generate_interfaces(${PROJECT_NAME} msg/State.msg DEPENDENCIES std_msgs)
add_library(core SHARED src/core.cpp)
add_executable(driver src/driver.cpp)
add_executable(helper src/helper.cpp)
target_link_libraries(driver PUBLIC core rclcpp::rclcpp)
install(TARGETS core driver DESTINATION lib/${PROJECT_NAME})
install(FILES config/a.yaml RENAME b.yaml DESTINATION share/${PROJECT_NAME})
install(FILES ${GENERATED} RENAME ${NAME} DESTINATION share/${PROJECT_NAME})
install(FILES config/c.yaml config/d.yaml DESTINATION share/${PROJECT_NAME})
ament_export_include_directories(include)
ament_export_libraries(core)
ament_export_dependencies(rclcpp std_msgs)
if(BUILD_TESTING)
  ament_add_gtest(test_core test/core.cpp TIMEOUT 60)
endif()
ament_package()
"""
GENERATED = "generate_parameter_library(gains src/gains.yaml)\n"
CATKIN = """cmake_minimum_required(VERSION 2.8.3)
project(arm)
find_package(catkin REQUIRED roscpp tf)
add_message_files(FILES State.msg Load.msg)
add_service_files(DIRECTORY services FILES Home.srv)
generate_messages(DEPENDENCIES std_msgs)
generate_dynamic_reconfigure_options(cfg/Arm.cfg)
catkin_package(INCLUDE_DIRS include LIBRARIES core CATKIN_DEPENDS roscpp tf)
add_library(core src/core.cpp)
add_executable(driver src/driver.cpp)
target_link_libraries(driver core ${catkin_LIBRARIES})
"""
ROSBUILD = """cmake_minimum_required(VERSION 2.4.6)
include($ENV{ROS_ROOT}/core/rosbuild/rosbuild.cmake)
rosbuild_init()
rosbuild_genmsg()
rosbuild_add_library(core src/core.cpp)
rosbuild_add_executable(driver src/driver.cpp)
target_link_libraries(driver core)
"""
OTHER_FILES = {
    **dict.fromkeys(("a/config/a.yaml", "a/config/c.yaml", "a/config/d.yaml"), "rate: 10\n"),
    **{f"a/msg/{name}.msg": "int32 value\n" for name in ("State", "Load")},
    "a/services/Home.srv": "---\n",
}


@pytest.mark.parametrize(
    ("text", "old", "new", "expected", "is_breaking"),
    [
        (AMENT, "core rclcpp::rclcpp", "core rclcpp::rclcpp tf2::tf2", ["'driver' linked to 'tf2'"], False),
        (AMENT, "core rclcpp::rclcpp", "core ${rclcpp_TARGETS}", [], False),
        (AMENT, "core rclcpp::rclcpp", "core rclcpp::rclcpp rclcpp::more",
         ["'driver' linked to 'rclcpp::more'"], False),
        (AMENT, "core rclcpp::rclcpp", "core rclcpp::more", [], False),
        (AMENT.replace("core rclcpp::", "core rclcpp::more rclcpp::"), "core rclcpp::more rclcpp::rclcpp",
         "core rclcpp", ["'driver' no longer linked to 'rclcpp::more'"], False),
        (AMENT.replace("core rclcpp::rclcpp", "core rclcpp::more"), "core rclcpp::more", "core ${rclcpp_TARGETS}",
         [], False),
        (AMENT, "src/core.cpp", "src/core.cpp src/more.cpp", ["sources of 'core' added: 'src/more.cpp'"], False),
        (AMENT, "test/core.cpp", "test/core.cpp test/more.cpp",
         ["sources of 'test_core' added: 'test/more.cpp'"], False),
        (AMENT, "TIMEOUT 60", "TIMEOUT 90", [], False),
        (AMENT, "SHARED", "STATIC", ["built targets: 'core': SHARED -> STATIC"], False),
        (AMENT, "add_executable(helper src/helper.cpp)", "", ["built targets removed: 'helper'"], False),
        (AMENT, "add_executable(helper src/helper.cpp)",
         "if(BUILD_HELPER)\nadd_executable(helper src/helper.cpp)\nendif()",
         ["built targets 'helper': always -> if BUILD_HELPER"], False),
        (AMENT, "Eigen3 3.3", "Eigen3 3.4", ["calls of find_package: 'Eigen3': 3.3 -> 3.4"], False),
        (AMENT, "rclcpp REQUIRED", "rclcpp",
         ["calls of find_package: 'rclcpp': any version -> any version, optional"], False),
        (AMENT, 'message(WARNING "no rclcpp")', 'message(FATAL_ERROR "no rclcpp")',
         ["errors that stop the build added: 'no rclcpp (if NOT rclcpp_FOUND)'"], True),
        (AMENT.replace("WARNING", "FATAL_ERROR"), '"no rclcpp"', '"rclcpp is missing"',
         ["the error 'no rclcpp' has another text: 'rclcpp is missing'"], False),
        (AMENT, "DEPENDENCIES std_msgs", "DEPENDENCIES std_msgs geometry_msgs",
         ["dependencies of interfaces added: 'geometry_msgs'"], False),
        (AMENT, "a.yaml RENAME b.yaml", "a.yaml RENAME e.yaml",
         ["installed under another name in share/arm: 'b.yaml -> e.yaml'"], True),
        (AMENT, "config/c.yaml config/d.yaml", "config/c.yaml",
         ["no longer installed: 'share/arm/d.yaml'"], True),
        (AMENT, "RENAME ${NAME}", "RENAME ${OTHER}", [], False),
        (AMENT, "directories(include)", "directories(include/${PROJECT_NAME})", [], False),
        (AMENT, "ament_export_libraries(core)", "", ["exported targets removed: 'core'"], True),
        (AMENT, "dependencies(rclcpp std_msgs)", "dependencies(rclcpp)",
         ["exported dependencies removed: 'std_msgs'"], True),
        (AMENT, "dependencies(rclcpp std_msgs)", "dependencies(rclcpp std_msgs ${MORE})", [], False),
        (AMENT.replace("S core", "S gains core").replace("add_ex", f"{GENERATED}add_ex", 1), "gains core", "core",
         ["installed libraries removed: 'gains'"], True),
        (CATKIN, "State.msg Load.msg", "State.msg", ["built interfaces removed: 'msg/Load.msg'"], True),
        (CATKIN, "FILES Home.srv", "FILES", ["built interfaces removed: 'services/Home.srv'"], True),
        (CATKIN, "options(cfg/Arm.cfg)", "options()",
         ["descriptions for dynamic_reconfigure removed: 'cfg/Arm.cfg'"], True),
        (CATKIN, "roscpp tf)\nadd_mes", "roscpp)\nadd_mes", ["calls of find_package removed: 'tf'"], False),
        (CATKIN, "LIBRARIES core ", "", ["exported targets removed: 'core'"], True),
        (CATKIN, "DEPENDS roscpp tf", "DEPENDS roscpp", ["exported dependencies removed: 'tf'"], True),
        (CATKIN, "DEPENDS roscpp tf", "DEPENDS roscpp tf rospy", ["exported dependencies added: 'rospy'"], False),
        (CATKIN.replace(" tf", " rospy"), "DEPENDS roscpp rospy", "DEPENDS roscpp",
         ["exported dependencies removed: 'rospy'"], False),
        (CATKIN, "INCLUDE_DIRS include", "", ["exported include folders removed: 'include'"], False),
        (CATKIN, "add_executable(driver src/driver.cpp)\n", "", ["built executables removed: 'driver'"], True),
        (CATKIN, "core ${catkin_LIBRARIES}", "${catkin_LIBRARIES}", ["'driver' no longer linked to 'core'"], False),
        (ROSBUILD, "executable(driver", "executable(drive",
         ["built executables: 'driver' renamed to 'drive'"], True),
        (ROSBUILD, "rosbuild_init()", "rosbuild_init()\ncheck()\ncheck()", ["check added"], False),
        (ROSBUILD, "rosbuild_genmsg()", "", ["built interfaces removed: 'msg/Load.msg', 'msg/State.msg'"], True),
    ],
)  # fmt: skip
def test_facts_of_cmake_files_are_compared(repository, compare, text, old, new, expected, is_breaking):
    assert text.count(old) == 1
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": text})
    repository.write({"a/CMakeLists.txt": text.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking


def test_moved_source_of_a_test_is_named(repository, compare):
    source = "TEST(Core, IsThere) {\n  EXPECT_TRUE(true);\n}\n"
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": AMENT, "a/test/core.cpp": source})
    text = AMENT.replace("test/core.cpp", "test/src/core.cpp")
    repository.commit({"a/CMakeLists.txt": text, "a/test/core.cpp": None, "a/test/src/core.cpp": source})
    found = subject(compare(repository, "HEAD~1..HEAD"), "a/CMakeLists.txt")
    assert sentences(found) == ["source of 'test_core' moved: 'test/core.cpp' -> 'test/src/core.cpp'"]


def test_new_executable_under_a_condition_is_shown_with_it(repository, compare):
    repository.commit({**MANIFEST, "a/CMakeLists.txt": AMENT})
    install = "install(TARGETS tuner DESTINATION lib/arm)"
    target = "add_executable(tuner src/tuner.cpp)"
    with_condition = f"{target}\nif(WITH_TUNER AND UNIX)\n  {install}\nelse()\n  message(FATAL_ERROR no)\nendif()\n"
    repository.write({"a/CMakeLists.txt": AMENT.replace("ament_package", with_condition + "ament_package")})
    (found,) = compare(repository).subjects
    assert sentences(found) == [
        "installed executables added: 'tuner (if WITH_TUNER AND UNIX)'",
        "errors that stop the build added: 'no (if NOT (WITH_TUNER AND UNIX))'",
    ]


@pytest.mark.parametrize(
    ("text", "command", "expected"),
    [
        (
            AMENT,
            "add_library(${PROJECT_NAME}_b src/b.cpp)",
            ["built targets added: 'arm_b (if ROS_DISTRO STREQUAL x)'"],
        ),
        (ROSBUILD, "rosbuild_add_library(b src/b.cpp)", ["built libraries added: 'b (if ROS_DISTRO STREQUAL x)'"]),
        (
            ROSBUILD,
            "rosbuild_add_library(${PROJECT_NAME}_b src/b.cpp)",
            ["built libraries added: 'a_b (if ROS_DISTRO STREQUAL x)'"],
        ),
        (ROSBUILD, "rosbuild_add_library(${OTHER} src/b.cpp)", []),
        (ROSBUILD, "rosbuild_add_library(core src/b.cpp)", []),
    ],
)
def test_new_target_under_a_condition_that_does_not_hold_is_shown(repository, compare, text, command, expected):
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": text})
    repository.write({"a/CMakeLists.txt": f"{text}if(ROS_DISTRO STREQUAL x)\n  {command}\nendif()\n"})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert breaking(result) == []


def test_package_that_moves_from_rosbuild_to_catkin_keeps_its_programs(repository, compare):
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": ROSBUILD})
    repository.write({"a/CMakeLists.txt": CATKIN})
    found = breaking(compare(repository))
    assert [sentence for sentence in found if "executables" in sentence or "interfaces" in sentence] == []


def test_target_of_renamed_sources_is_renamed(repository, compare):
    repository.commit({**MANIFEST, "a/CMakeLists.txt": AMENT, "a/src/driver.cpp": "int main() { return 0; }\n"})
    text = AMENT.replace("driver", "arm_driver")
    repository.commit(
        {"a/CMakeLists.txt": text, "a/src/driver.cpp": None, "a/src/arm_driver.cpp": "int main() { return 0; }\n"}
    )
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["installed executables: 'driver' renamed to 'arm_driver'"]


def test_subdirectory_of_a_package_of_rosbuild_is_compared_with_it(repository, compare):
    text = ROSBUILD.replace("rosbuild_add_library(core src/core.cpp)", "rosbuild_add_subdirectory(src)")
    lib = "rosbuild_add_library(core core.cpp)\n"
    manifest = "<package><license>BSD</license></package>"
    repository.commit({"a/manifest.xml": manifest, "a/CMakeLists.txt": text, "a/src/CMakeLists.txt": lib})
    repository.write({"a/src/CMakeLists.txt": lib.replace("(core", "(arm_core").replace("core.cpp", "arm.cpp")})
    assert breaking(compare(repository)) == ["built libraries removed: 'core'"]


def test_contents_of_a_removed_build_file_have_what_was_built(repository, compare):
    repository.commit({"a/manifest.xml": "<package/>", "a/CMakeLists.txt": ROSBUILD})
    repository.commit({"a/CMakeLists.txt": None})
    (found,) = compare(repository, "HEAD~1..HEAD").subjects
    assert sentences(found) == ["build file removed: built executables 'driver'; built libraries 'core'"]


def test_installed_target_that_nothing_built_is_not_removed(repository, compare):
    text = CATKIN_NODES.format("servre")
    repository.commit({**MANIFEST, "a/CMakeLists.txt": text})
    repository.write({"a/CMakeLists.txt": CATKIN_NODES.format("server")})
    result = compare(repository)
    assert breaking(result) == []
    assert sentences(subject(result, "a/CMakeLists.txt")) == ["installed executables added: 'server'"]


CATKIN_NODES = """cmake_minimum_required(VERSION 3.0)
project(arm)
find_package(catkin REQUIRED COMPONENTS roscpp)
catkin_package()
add_executable(server src/server.cpp)
target_link_libraries(server ${{catkin_LIBRARIES}})
install(TARGETS {} RUNTIME DESTINATION ${{CATKIN_PACKAGE_BIN_DESTINATION}})
"""


def test_version_of_a_downloaded_project_is_compared_by_its_keyword(repository, compare):
    project = "ExternalProject_Add(core GIT_REPOSITORY https://example.org/core.git GIT_TAG {} PREFIX core)\n"
    repository.commit({**MANIFEST, "a/CMakeLists.txt": AMENT + project.format("1.0.0")})
    repository.write({"a/CMakeLists.txt": AMENT + project.format("devel")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["externalproject_add GIT_TAG 1.0.0 -> devel"]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("GIT_SHALLOW TRUE", "GIT_SHALLOW FALSE", ["fetchcontent_declare GIT_SHALLOW TRUE -> FALSE"]),
        ("GIT_TAG MAIN", "GIT_TAG STABLE", ["fetchcontent_declare GIT_TAG MAIN -> STABLE"]),
        ("", "EXCLUDE_FROM_ALL", ["fetchcontent_declare EXCLUDE_FROM_ALL added"]),
        ("EXCLUDE_FROM_ALL", "", ["fetchcontent_declare EXCLUDE_FROM_ALL removed"]),
    ],
)
def test_values_in_capital_letters_and_switches_of_a_downloaded_project_are_told(
    repository, compare, old, new, expected
):
    project = "FetchContent_Declare(core URL https://example.org/core.zip {})\n"
    repository.commit({**MANIFEST, "a/CMakeLists.txt": AMENT + project.format(old)})
    repository.write({"a/CMakeLists.txt": AMENT + project.format(new)})
    (found,) = compare(repository).subjects
    assert sentences(found) == expected


INTERFACES = CATKIN.replace("FILES State.msg Load.msg", "DIRECTORY msg/FOLDER FILES State.msg")


@pytest.mark.parametrize(("folder", "is_breaking"), [("all", False), ("other", True)])
def test_interface_of_ros1_that_moves_to_another_folder_keeps_its_type(repository, compare, folder, is_breaking):
    manifest = MANIFEST["a/package.xml"].replace("</license>", "</license><buildtool_depend>catkin</buildtool_depend>")
    value = "int32 value\n"
    repository.commit({"a/package.xml": manifest, "a/CMakeLists.txt": INTERFACES.replace("FOLDER", "arm"),
                       "a/msg/arm/State.msg": value, "a/services/Home.srv": "---\n"})  # fmt: skip
    repository.commit({"a/CMakeLists.txt": INTERFACES.replace("FOLDER", folder),
                       "a/msg/arm/State.msg": None, "a/msg/all/State.msg": value})  # fmt: skip
    result = compare(repository, "HEAD~1..HEAD")
    assert ("renamed from a/msg/arm/State.msg" in breaking(result)) is is_breaking
    if not is_breaking:
        assert str(result.file_states["a/msg/all/State.msg"]) == "moved from a/msg/arm/, the type keeps its name"


def test_built_interface_without_a_file_is_named(repository, compare):
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": CATKIN})
    repository.write({"a/CMakeLists.txt": CATKIN.replace("Load.msg", "Load.msg Lost.msg")})
    found = subject(compare(repository), "a/CMakeLists.txt")
    assert sentences(found) == ["built interfaces added: 'msg/Lost.msg'"]


@pytest.mark.parametrize(
    ("command", "folders"),
    [
        ("include_directories(include /opt/cuda/include)", ["/opt/cuda/include"]),
        ("target_include_directories(arm PUBLIC ~/ws/include)", ["~/ws/include"]),
        ("include_directories(include ${CMAKE_CURRENT_SOURCE_DIR}/src ${EIGEN_DIR})", []),
        ("set(own ${PROJECT_SOURCE_DIR}/src)\ninclude_directories(${own})", []),
        ("include_directories($<BUILD_INTERFACE:/opt/include>)", []),
    ],
)
def test_a_new_absolute_include_folder_is_told(repository, compare, command, folders):
    text = "project(arm)\nadd_library(arm src/arm.cpp)\n"
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/CMakeLists.txt": text})
    repository.write({"arm/CMakeLists.txt": f"{text}{command}\n"})
    found = [
        line for subject in compare(repository).subjects for line in sentences(subject) if "include folders" in line
    ]
    assert found == [f"absolute include folders added: '{folder}'" for folder in folders]


GTEST = """if(CATKIN_ENABLE_TESTING)
  {}
  target_link_libraries(homing ${{GTEST_LIBRARIES}})
endif()
"""
PROGRAM_OF_A_TEST = "add_executable(homing test/homing.cpp)\n  add_rostest(test/homing.launch DEPENDENCIES homing)"


@pytest.mark.parametrize("command", ["add_rostest_gtest", "add_rostest_gmock", "add_rostest_with_parameters_gmock"])
def test_program_of_a_test_that_another_command_builds_is_not_removed(repository, compare, command):
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": CATKIN + GTEST.format(PROGRAM_OF_A_TEST)})
    test = f"{command}(homing test/homing.launch test/homing.cpp)"
    repository.write({"a/CMakeLists.txt": CATKIN + GTEST.format(test)})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["tests: 'test/homing.launch' renamed to 'homing'"]
    assert breaking(compare(repository)) == []
    repository.commit({"a/CMakeLists.txt": CATKIN + GTEST.format(test)})
    repository.write({"a/CMakeLists.txt": CATKIN + GTEST.format(test.replace("homing.launch", "home.test"))})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["tests: 'homing': test/homing.launch -> test/home.test"]


@pytest.mark.parametrize(
    "command", ["catkin_add_gtest", "ament_add_gtest", "ament_add_gmock_executable", "ament_add_google_benchmark"]
)
def test_executable_that_becomes_a_test_of_the_same_name_is_not_removed(repository, compare, command):
    text = CATKIN.replace("add_executable(driver", f"{command}(driver")
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": CATKIN})
    repository.write({"a/CMakeLists.txt": text})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["tests added: 'driver'"]


def test_executable_that_a_test_of_python_replaces_is_removed(repository, compare):
    text = CATKIN.replace("add_executable(driver src/driver.cpp)", "ament_add_pytest_test(driver test/driver.py)")
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": CATKIN})
    repository.write({"a/CMakeLists.txt": text})
    assert breaking(compare(repository)) == ["built executables removed: 'driver'"]


CONDITIONAL = "if({})\n  find_package(catkin REQUIRED COMPONENTS {})\nendif()\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (CONDITIONAL.format("A", "roslint"), "if(A)\n  find_package(roslint)\nendif()\n",
         ["calls of find_package: 'roslint': any version -> any version, optional",
          "calls of find_package removed: 'catkin (if A)'"]),
        ("", CONDITIONAL.format("A", "tf2"), ["calls of find_package added: 'catkin (if A)', 'tf2 (if A)'"]),
        (CONDITIONAL.format("A", "roscpp"), CONDITIONAL.format("B", "roscpp"),
         ["calls of find_package 'catkin', 'roscpp': if A -> if B"]),
        ("if(A)\nfind_package(x)\nendif()\nif(B AND C)\nfind_package(x)\nendif()\n", "find_package(x)\n",
         ["calls of find_package 'x': if A OR (B AND C) -> always"]),
        ("", "if(A)\nfind_package(x 1.2 REQUIRED)\nendif()\n", ["calls of find_package added: 'x 1.2 (if A)'"]),
    ],
)  # fmt: skip
def test_calls_of_find_package_under_different_conditions_are_different_calls(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, **OTHER_FILES, "a/CMakeLists.txt": CATKIN + old})
    repository.write({"a/CMakeLists.txt": CATKIN + new})
    found = subject(compare(repository), "a/CMakeLists.txt")
    assert [text for text in sentences(found) if "find_package" in text] == expected


EXPORT = "pluginlib_export_plugin_description_file(base tools.xml)\n"


@pytest.mark.parametrize(
    ("old", "new", "is_repeated"),
    [
        (EXPORT, EXPORT * 2, True),
        (EXPORT * 2, EXPORT * 2 + "# end\n", False),
        (EXPORT, EXPORT + EXPORT.replace("base", "other"), False),
        (EXPORT * 2, EXPORT, False),
    ],
)
def test_plugin_description_that_is_exported_twice_is_told(repository, compare, old, new, is_repeated):
    files = {**MANIFEST, **OTHER_FILES, "a/tools.xml": "<library path='core'/>\n"}
    repository.commit({**files, "a/CMakeLists.txt": AMENT + old})
    repository.write({"a/CMakeLists.txt": AMENT + new})
    lines = [text for found in compare(repository).subjects for text in sentences(found) if "times" in text]
    assert lines == (["plugin description 'tools.xml' is exported 2 times"] if is_repeated else [])


def test_a_program_that_only_tests_install_is_not_breaking_when_it_is_gone(repository, compare):
    text = (
        "project(arm)\nadd_executable({name} src/a.cpp)\nif(BUILD_TESTING)\n  add_executable(check test/{name}.cpp)\n"
    )
    text += "  install(TARGETS check DESTINATION lib/arm)\nendif()\ninstall(TARGETS {name} DESTINATION lib/arm)\n"
    repository.commit({**MANIFEST, "a/CMakeLists.txt": text.replace("{name}", "arm")})
    repository.write({"a/CMakeLists.txt": text.replace("{name}", "arm").replace("check", "probe")})
    result = compare(repository)
    assert any("'check" in line for line in sentences(subject(result, "a/CMakeLists.txt")))
    assert breaking(result) == []


@pytest.mark.parametrize("is_exported", [True, False])
def test_a_folder_of_headers_that_exported_targets_bring_is_not_lost(repository, compare, is_exported):
    export = "ament_export_targets(export_arm)\n" if is_exported else "\n"
    new = AMENT.replace("ament_export_include_directories(include)\n", export)
    repository.commit({**MANIFEST, "a/CMakeLists.txt": AMENT})
    repository.write({"a/CMakeLists.txt": new})
    lost = [line for line in breaking(compare(repository)) if "include folders" in line]
    assert lost == ([] if is_exported else ["exported include folders removed: 'include'"])


GUARDED = """project(a)
find_package({0} QUIET)
if(NOT {0}_FOUND)
  message(WARNING "no {0}")
  {1}
endif()
find_package(ament_cmake REQUIRED)
ament_package()
"""


@pytest.mark.parametrize(
    ("end", "depend", "reason"),
    [
        ("return()", "", "without 'gz-sim8', which package.xml does not name, nothing is built"),
        ("return()", "<depend>gz-sim8</depend>", None),
        ("set(WITH_SIM OFF)", "", None),
    ],
)
def test_another_version_of_a_package_without_which_nothing_is_built(repository, compare, end, depend, reason):
    manifest = PACKAGE_XML.replace("</package>", f"{depend}</package>")
    repository.commit({"a/package.xml": manifest, "a/CMakeLists.txt": GUARDED.format("gz-sim7", end)})
    repository.write({"a/CMakeLists.txt": GUARDED.format("gz-sim8", end)})
    (change,) = subject(compare(repository), "a/CMakeLists.txt").changes
    assert str(change.sentence) == "calls of find_package: 'gz-sim7' replaced by 'gz-sim8'"
    assert (change.reason and str(change.reason)) == reason


def test_a_new_package_without_which_nothing_is_built(repository, compare):
    build = "project(a)\nfind_package(ament_cmake REQUIRED)\nament_package()\n"
    repository.commit({"a/package.xml": PACKAGE_XML, "a/CMakeLists.txt": build})
    repository.write({"a/CMakeLists.txt": GUARDED.format("gz-sim8", "return()")})
    (change,) = subject(compare(repository), "a/CMakeLists.txt").changes
    assert str(change.sentence) == "calls of find_package added: 'gz-sim8 any version, without which nothing is built'"
    assert change.reason is not None


def test_a_call_whose_macro_is_defined_now_is_not_removed(repository, compare):
    head = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\ninclude(macros.cmake)\n"
    build = f"{head}arm_component(driver src/driver.cpp)\n"
    macro = "macro(arm_component name source)\n  add_library(${name} SHARED ${source})\nendmacro()\n"
    repository.commit({**MANIFEST, "a/CMakeLists.txt": build, "a/macros.cmake": "", "a/src/driver.cpp": ""})
    repository.commit({"a/macros.cmake": macro})
    assert sentences(subject(compare(repository, "HEAD~"), "a/CMakeLists.txt")) == [
        "built targets added: 'driver'",
        "'arm_component', which the file already called, is defined now",
    ]
    repository.write({"a/macros.cmake": ""})
    assert sentences(subject(compare(repository), "a/CMakeLists.txt")) == [
        "built targets removed: 'driver'",
        "'arm_component', which the file still calls, is no longer defined",
    ]


def test_library_with_the_new_name_of_its_package_is_still_linked(repository, compare):
    build = """project(THIS)
add_library(${PROJECT_NAME} SHARED core.cpp)
add_executable(driver driver.cpp)
target_link_libraries(driver ${PROJECT_NAME})
ament_package()
"""
    manifest = PACKAGE_XML.replace("arm_description", "THIS")
    files = {"a/CMakeLists.txt": build, "a/package.xml": manifest, "a/core.cpp": "", "a/driver.cpp": ""}
    for name in ("arm-core", "arm_core"):
        repository.commit({path: text.replace("THIS", name) for path, text in files.items()})
    result = compare(repository, "HEAD~1..HEAD")
    assert not any("linked" in sentence for found in result.subjects for sentence in sentences(found))


def test_a_computed_number_is_no_setting(repository, compare):
    text = 'project(arm)\nset(NAMES one two)\nmath(EXPR LAST "{} + 1")\n'
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/CMakeLists.txt": text.format(1)})
    repository.write({"arm/CMakeLists.txt": text.format(2)})
    assert [str(change.sentence) for found in compare(repository).subjects for change in found.changes] == []
