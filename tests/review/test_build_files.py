"""Changes of CMakeLists.txt and setup.py in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
set(CMAKE_CXX_STANDARD 14)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} msg/State.msg msg/Load.msg DEPENDENCIES std_msgs)
add_library(arm_core src/core.cpp)
add_executable(driver src/driver.cpp)
add_executable(tuner src/tuner.cpp)
ament_target_dependencies(driver rclcpp)
install(TARGETS arm_core EXPORT export_arm LIBRARY DESTINATION lib)
install(TARGETS driver tuner RUNTIME DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/home.py DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
pluginlib_export_plugin_description_file(arm_base plugins.xml)
ament_export_dependencies(rclcpp)
ament_package()
"""
FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/CMakeLists.txt": CMAKE,
    "a/launch/arm.launch.xml": "<launch/>\n",
    "a/config/arm.txt": "rate 10\n",
    "a/scripts/home.py": "print('home')\n",
    "a/plugins.xml": "<library path='arm'/>\n",
    "a/msg/State.msg": "int32 state\n",
    "a/msg/Load.msg": "float32 load\n",
}


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("driver tuner RUNTIME", "driver RUNTIME", ["installed executables removed: 'tuner'"], True),
        ("scripts/home.py DEST", "scripts/home.py scripts/up.py DEST", ["installed executables added: 'up.py'"], True),
        (" EXPORT export_arm", "", ["exported targets removed: 'arm_core'"], True),
        ("install(DIRECTORY launch config", "install(DIRECTORY launch",
         ["no longer installed: 'share/arm/config/'"], True),
        ("config DESTINATION share/${PROJECT_NAME}", "DESTINATION share/${PROJECT_NAME}/more",
         ["installed in share/arm/more/launch instead of share/arm/launch: 'arm.launch.xml'",
          "no longer installed: 'share/arm/config/'"], True),
        ("msg/Load.msg ", "", ["built interfaces removed: 'msg/Load.msg'"], True),
        ("(arm_base plugins", "(arm_tools plugins",
         ["exported plugin descriptions: 'plugins.xml': arm_base -> arm_tools"], True),
        ("find_package(rclcpp REQUIRED)", "find_package(rclcpp REQUIRED)\nfind_package(tf2_ros REQUIRED)",
         ["calls of find_package added: 'tf2_ros'"], False),
        ("STANDARD 14", "STANDARD 17", ["settings: 'CMAKE_CXX_STANDARD': 14 -> 17"], False),
        ("(driver rclcpp)", "(driver rclcpp tf2_ros)", ["'driver' linked to 'tf2_ros'"], False),
        ("(driver rclcpp)", "(driver PUBLIC rclcpp ${PCL_LIBRARIES} VTK ${MORE} driver)",
         ["'driver' linked to itself", "'driver' linked to 'PCL', 'VTK'"], False),
        ("find_package(rclcpp REQ", "find_package(Boost REQUIRED COMPONENTS thread)\nfind_package(rclcpp REQ",
         ["calls of find_package added: 'Boost', 'Boost thread'"], False),
        ("find_package(rclcpp REQ",
         "gz_find_package(gz-sim8 VERSION 8.1 REQUIRED COMPONENTS gui REQUIRED_BY arm)\nfind_package(rclcpp REQ",
         ["calls of find_package added: 'gz-sim8 8.1', 'gz-sim8 gui'"], False),
        ("find_package(rclcpp REQUIRED)", "gz_find_package(rclcpp REQUIRED PRETTY ros)", [], False),
        ("add_library(arm", "add_compile_options(-Wall)\nadd_library(arm", ["add_compile_options added: -Wall"], False),
        ("add_library(arm", "check_everything()\nadd_library(arm", ["check_everything added"], False),
        ("RUNTIME DESTINATION lib/${PROJECT_NAME}", "RUNTIME DESTINATION bin",
         ["installed executables: 'driver': lib/arm -> bin", "installed executables: 'tuner': lib/arm -> bin"], True),
        ("set(CMAKE_CXX_STANDARD 14)", "set(X 1) # a comment\nset(CMAKE_CXX_STANDARD 14)", [], False),
        ("install(DIRECTORY launch config", "install(DIRECTORY\n  config\n  launch", [], False),
        ("project(arm)", "project(arms)", [], False),
        ("launch config DEST", "launch config worlds DEST",
         ["installed folders that the repository does not have added: 'worlds'"], True),
        ("set(CMAKE_CXX_STANDARD 14)", "set(CMAKE_EXPORT_COMPILE_COMMANDS ON)\nset(CMAKE_CXX_STANDARD 14)", [], False),
        ("ament_package()", "catkin_add_nosetests(test/a.py)\nroslaunch_add_file_check(launch)\nament_package()",
         ["tests added: 'test/a.py', 'launch'"], False),
        ("ament_package()", "if($ENV{SIMULATOR} STREQUAL old)\nendif()\nament_package()",
         ["environment variable 'SIMULATOR' decides what is built"], False),
    ],
)  # fmt: skip
def test_changes_of_cmake_files_are_reported(repository, compare, old, new, expected, is_breaking):
    repository.commit(FILES)
    assert old in CMAKE
    repository.write({"a/CMakeLists.txt": CMAKE.replace(old, new)})
    result = compare(repository)
    found = [sentence for subject in result.subjects for sentence in sentences(subject)]
    assert found == expected
    assert bool(breaking(result)) is is_breaking


def test_interface_that_is_added_is_not_repeated_for_its_build_file(repository, compare):
    repository.commit(FILES)
    text = CMAKE.replace("msg/Load.msg", "msg/Load.msg msg/Heat.msg")
    repository.write({"a/CMakeLists.txt": text, "a/msg/Heat.msg": "float32 heat\n"})
    assert [subject.path for subject in compare(repository).subjects] == ["a/msg/Heat.msg"]


def test_build_file_of_a_subdirectory_is_compared_with_its_package(repository, compare):
    text = CMAKE.replace("ament_package()", "add_subdirectory(tools)\nament_package()")
    tools = "add_executable(show show.cpp)\ninstall(TARGETS show RUNTIME DESTINATION lib/${PROJECT_NAME})\n"
    repository.commit({**FILES, "a/CMakeLists.txt": text, "a/tools/CMakeLists.txt": tools})
    repository.write(
        {"a/tools/CMakeLists.txt": tools.replace("show show.cpp", "view show.cpp").replace("S show", "S view")}
    )
    result = compare(repository)
    found = subject(result, "a/CMakeLists.txt")
    assert sentences(found) == [
        "installed executables: 'show' renamed to 'view'",
    ]
    assert found.changes[0].location.file == "a/tools/CMakeLists.txt"
    assert result.other_files == []


def test_added_words_of_a_long_setting_are_reported(repository, compare):
    text = CMAKE.replace("ament_package()", "add_compile_options(one two three four five)\nament_package()")
    repository.commit({**FILES, "a/CMakeLists.txt": text})
    repository.write({"a/CMakeLists.txt": text.replace("four five", "five six")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["add_compile_options: six added, four removed"]


def test_folder_that_is_new_and_installed_now_is_reported(repository, compare):
    repository.commit(FILES)
    text = CMAKE.replace("launch config DEST", "launch config notes DEST")
    repository.write({"a/CMakeLists.txt": text, "a/notes/all.txt": "grease\n"})
    assert sentences(subject(compare(repository), "a/CMakeLists.txt")) == ["installed now: 'share/arm/notes/'"]


CONTENTS = (
    "installed executables 'driver', 'tuner', 'home.py'; installed libraries 'arm_core'; "
    "exported plugin descriptions 'plugins.xml'; built interfaces 'msg/State.msg', 'msg/Load.msg'; "
    "files in 'share/arm/launch/', 'share/arm/config/', 'share/arm/'"
)


def test_contents_of_added_and_removed_build_files_are_listed(repository, compare):
    first = repository.commit({"README.md": "arm\n"})
    second = repository.commit(FILES)
    added = subject(compare(repository, f"{first}..{second}"), "a/CMakeLists.txt")
    assert sorted(str(added.changes[0].sentence).removeprefix("build file added: ").split("; ")) == sorted(
        CONTENTS.split("; ")
    )
    repository.commit({"a/CMakeLists.txt": None})
    removed = subject(compare(repository, f"{second}..HEAD"), "a/CMakeLists.txt")
    assert "installed libraries 'arm_core'" in str(removed.changes[0].sentence)


def test_build_file_without_a_compared_difference_is_listed(repository, compare):
    repository.commit(FILES)
    repository.write(
        {"a/CMakeLists.txt": CMAKE.replace("find_package(rclcpp", "message(STATUS a)\nfind_package(rclcpp")}
    )
    result = compare(repository)
    assert (result.subjects, result.other_files) == ([], ["a/CMakeLists.txt"])


SETTINGS = {
    "setup.cfg": """[metadata]
name = arm
[options.entry_points]
console_scripts =
    driver = arm.driver:main
    tuner = arm.tuner:main
[options.data_files]
share/arm/launch = launch/*.launch.py
[develop]
script_dir=$base/lib/arm
[install]
install_scripts=$base/lib/arm
""",
    "pyproject.toml": """[project]
name = "arm"
version = "1.0.0"
[project.scripts]
driver = "arm.driver:main"
tuner = "arm.tuner:main"
[project.entry-points.arm_tools]
home = "arm.tools:Home"
[tool.setuptools.data-files]
"share/arm/launch" = ["launch/*.launch.py"]
""",
}


@pytest.mark.parametrize(
    ("name", "old", "new", "expected"),
    [
        ("setup.cfg", "    tuner = arm.tuner:main\n", "", ["installed executables removed: 'tuner'"]),
        ("setup.cfg", "install_scripts=$base/lib/arm", "install_scripts=$base/bin",
         ["settings: 'install.install_scripts': $base/lib/arm -> $base/bin"]),
        ("setup.cfg", "launch/*.launch.py", "launch/arm.launch.py",
         ["no longer installed: 'share/arm/launch/all.launch.py'"]),
        ("pyproject.toml", 'tuner = "arm.tuner:main"\n', "", ["installed executables removed: 'tuner'"]),
        ("pyproject.toml", 'home = "', 'rest = "', ["entry points added: 'arm_tools: rest'",
                                                   "entry points removed: 'arm_tools: home'"]),
        ("pyproject.toml", '["launch/*.launch.py"]', '["launch/arm.launch.py"]',
         ["no longer installed: 'share/arm/launch/all.launch.py'"]),
        ("pyproject.toml", '"1.0.0"', '"1.1.0"', ["settings: 'version': 1.0.0 -> 1.1.0"]),
        ("pyproject.toml", "[project]", "[tool.ruff]\nline-length = 120\n[project]", []),
        ("pyproject.toml", "[project]", "[project", ["can no longer be read"]),
    ],
)  # fmt: skip
def test_changes_of_settings_of_python_packages_are_reported(repository, compare, name, old, new, expected):
    files = {path: text for path, text in PYTHON_FILES.items() if not path.endswith("setup.py")}
    repository.commit({**files, f"a/{name}": SETTINGS[name]})
    assert old in SETTINGS[name]
    repository.write({f"a/{name}": SETTINGS[name].replace(old, new)})
    found = [sentence for subject in compare(repository).subjects for sentence in sentences(subject)]
    assert [sentence.partition(": Expected")[0] for sentence in found] == expected


SETUP = """from glob import glob
from setuptools import setup

package_name = 'arm'
setup(
    name=package_name,
    version='1.0.0',
    packages=[package_name],
    data_files=[
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
        ('share/' + package_name + '/config', glob('config/*.yaml')),
    ],
    install_requires=['setuptools'],
    entry_points={
        'console_scripts': ['driver = arm.driver:main', 'tuner = arm.tuner:main'],
        'arm.tools': ['home = arm.tools:Home'],
    },
)
"""
PYTHON_FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/setup.py": SETUP,
    "a/launch/arm.launch.py": "",
    "a/launch/all.launch.py": "",
    "a/config/arm.yaml": "rate: 10\n",
}


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        (", 'tuner = arm.tuner:main'", "", ["installed executables removed: 'tuner'"], True),
        ("arm.driver:main", "arm.nodes.driver:main",
         ["installed executables: 'driver': arm.driver:main -> arm.nodes.driver:main"], False),
        ("launch/*.launch.py", "launch/a*.launch.py", [], False),
        ("glob('launch/*.launch.py')", "['launch/arm.launch.py']",
         ["no longer installed: 'share/arm/launch/all.launch.py'"], True),
        ("        ('share/' + package_name + '/config', glob('config/*.yaml')),\n", "",
         ["no longer installed: 'share/arm/config/'"], True),
        ("'home = arm", "'rest = arm", ["entry points added: 'arm.tools: rest'",
                                        "entry points removed: 'arm.tools: home'"], True),
        ("'1.0.0'", "'1.1.0'", ["settings: 'version': 1.0.0 -> 1.1.0"], False),
        ("['setuptools']", "['setuptools', 'numpy']",
         ["install_requires ['setuptools'] -> ['setuptools', 'numpy']"], False),
    ],
)  # fmt: skip
def test_changes_of_setup_files_are_reported(repository, compare, old, new, expected, is_breaking):
    repository.commit(PYTHON_FILES)
    assert old in SETUP
    repository.write({"a/setup.py": SETUP.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking


def test_new_files_of_another_folder_are_installed_now(repository, compare):
    repository.commit(PYTHON_FILES)
    text = SETUP.replace("['package.xml']", "['package.xml'] + glob('rviz/*')")
    repository.write({"a/setup.py": text, "a/rviz/arm.rviz": "Panels: []\n", "a/config/tool.yaml": "a: 1\n"})
    found = subject(compare(repository), "a/setup.py")
    assert sentences(found) == ["installed now: 'share/arm/arm.rviz'"]


def test_setup_file_that_is_no_longer_python_is_breaking(repository, compare):
    repository.commit(PYTHON_FILES)
    repository.write({"a/setup.py": SETUP + "setup("})
    (sentence,) = breaking(compare(repository))
    assert sentence.startswith("can no longer be read")


EXPORTS = PACKAGE_XML.replace(
    "</package>",
    """  <export>
    <build_type>ament_cmake</build_type>
    <arm_base plugin="${prefix}/plugins.xml"/>
    <gazebo_ros gazebo_model_path="${prefix}/models"/>
  </export>
</package>""",
)


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("arm_base plugin", "arm_core plugin", ["export added: arm_core plugin=${prefix}/plugins.xml",
                                                "export removed: arm_base plugin=${prefix}/plugins.xml"], True),
        ("prefix}/plugins", "prefix}/all",
         ["export arm_base: plugin ${prefix}/plugins.xml -> ${prefix}/all.xml"], False),
        ('_path="${prefix}/models"', '_path="${prefix}/models" plugin_path="${prefix}/lib"',
         ["export gazebo_ros: plugin_path ${prefix}/lib added"], False),
        (' gazebo_model_path="${prefix}/models"', "",
         ["export gazebo_ros: gazebo_model_path ${prefix}/models removed"], True),
        ("ament_cmake", "ament_python", ["build type: ament_cmake -> ament_python"], False),
        ('    <gazebo_ros gazebo_model_path="${prefix}/models"/>\n', "",
         ["export removed: gazebo_ros gazebo_model_path=${prefix}/models"], True),
        ("<exec_depend>", '<exec_depend condition="$ROS_VERSION == 2">',
         ["exec_depend xacro: always -> if $ROS_VERSION == 2"], False),
        ("ann@example.org", "ann@example.com", ["email of maintainer: ann@example.org -> ann@example.com"], False),
        ("An arm.", "Two arms.", ["description: An arm. -> Two arms."], False),
        ("1.0.0", "1.0.1", ["version: 1.0.0 -> 1.0.1"], False),
    ],
)  # fmt: skip
def test_changes_of_manifests_are_reported(repository, compare, old, new, expected, is_breaking):
    repository.commit({"a/package.xml": EXPORTS})
    assert old in EXPORTS
    repository.write({"a/package.xml": EXPORTS.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "a/package.xml")) == expected
    assert bool(breaking(result)) is is_breaking


ROS1_MANIFEST = """<package format="2"><name>arm_msgs</name><version>1.0.0</version><description>Arms.</description>
  <maintainer email="a@example.org">A</maintainer><license>MIT</license>
  <buildtool_depend>catkin</buildtool_depend>
  <depend>std_msgs</depend>
  <build_export_depend>geometry_msgs</build_export_depend>
</package>
"""
ROS1_FILES = {
    "a/package.xml": ROS1_MANIFEST,
    "a/CMakeLists.txt": """project(arm_msgs)
find_package(catkin REQUIRED COMPONENTS std_msgs)
catkin_package(CATKIN_DEPENDS std_msgs)
""",
}
ROS2_MANIFEST = (
    ROS1_MANIFEST.replace("catkin", "ament_cmake")
    .replace("  <depend>std_msgs</depend>\n  <build_export_depend>geometry_msgs</build_export_depend>\n", "")
    .replace("</package>", "<export><build_type>ament_cmake</build_type></export></package>")
)


def test_package_that_moves_from_ros_1_to_ros_2_is_one_breaking_change(repository, compare):
    """Nobody uses the dependencies of a package of another version of ROS."""
    repository.commit(ROS1_FILES)
    repository.write(
        {
            "a/package.xml": ROS2_MANIFEST,
            "a/CMakeLists.txt": "project(arm_msgs)\nfind_package(ament_cmake REQUIRED)\nament_package()\n",
        }
    )
    result = compare(repository)
    assert breaking(result) == ["build type: catkin -> ament_cmake"]
    (change,) = [change for change in subject(result, "a/package.xml").changes if change.reason is not None]
    assert str(change.reason) == "packages of ROS 1 no longer find the package"
    assert "exported dependencies removed: 'std_msgs'" in sentences(subject(result, "a/CMakeLists.txt"))


def test_package_that_builds_for_both_versions_of_ros_is_not_breaking(repository, compare):
    repository.commit(ROS1_FILES)
    both = ROS1_MANIFEST.replace(
        "</package>",
        '<buildtool_depend condition="$ROS_VERSION == 2">ament_cmake</buildtool_depend><export>'
        '<build_type condition="$ROS_VERSION == 1">catkin</build_type>'
        '<build_type condition="$ROS_VERSION == 2">ament_cmake</build_type></export></package>',
    )
    repository.write({"a/package.xml": both})
    assert breaking(compare(repository)) == []


DEPENDENCIES = EXPORTS.replace(
    "  <exec_depend>xacro</exec_depend>\n",
    """  <build_depend>gears</build_depend>
  <exec_depend>gears</exec_depend>
  <build_depend>levers</build_depend>
  <exec_depend>levers</exec_depend>
  <exec_depend condition="$SIMULATOR == 'old'">bridge</exec_depend>
  <exec_depend condition="$SIMULATOR == 'new'">bridge</exec_depend>
  <exec_depend>xacro</exec_depend>
""",
)


CATKIN_EXPORT = "catkin_package(CATKIN_DEPENDS gears)"


def find_dependency_changes(repository, compare, *replacements):
    repository.commit({"a/package.xml": DEPENDENCIES})
    text = DEPENDENCIES
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    repository.write({"a/package.xml": text})
    result = compare(repository)
    return sentences(subject(result, "a/package.xml")), breaking(result)


@pytest.mark.parametrize(
    ("more", "tag", "is_breaking"),
    [
        ("", "depend", False),
        ("install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})", "depend", False),
        ("", "build_export_depend", True),
        ("install(DIRECTORY include/ DESTINATION include)", "depend", True),
        ("ament_export_dependencies(gears)", "depend", True),
        ("ament_export_dependencies(ament_cmake rosidl_default_generators)\nament_package()", "depend", False),
        ("ament_export_dependencies(ament_cmake gears)\nament_package()", "depend", True),
        ("pluginlib_export_plugin_description_file(nav2_core plugins.xml)", "depend", False),
        ("add_library(core src/core.cpp)", "depend", True),
        ("add_library(core src/core.cpp)\ninstall(TARGETS core DESTINATION lib)\nament_package()", "depend", False),
        ("add_library(core src/core.cpp)\ninstall(TARGETS core EXPORT core)\nament_package()", "depend", True),
        ("add_subdirectory(core)\nament_package()", "depend", False),
        ("add_subdirectory(exported)\nament_package()", "depend", True),
        ("ament_python_install_package(arm)\nament_package()", "depend", True),
        ("ament_auto_package()", "depend", True),
        ("ament_package(CONFIG_EXTRAS cmake/core.cmake)", "depend", True),
    ],
)
def test_dependency_of_a_package_that_exports_nothing_breaks_nobody(repository, compare, more, tag, is_breaking):
    depend = f"  <{tag}>gears</{tag}>\n"
    cmake = "project(arm)\nadd_executable(driver src/driver.cpp)\n"
    install = "install(TARGETS driver RUNTIME DESTINATION lib/${PROJECT_NAME})\n"
    manifest = EXPORTS.replace("  <exec_depend>xacro", f"{depend}  <exec_depend>xacro")
    files = {"a/src/driver.cpp": "int main() {}\n", "a/launch/a.launch": "<launch/>\n", "a/arm/__init__.py": ""}
    files |= {"a/core/CMakeLists.txt": "add_library(core c.cpp)\n"} if "(core)" in more else {}
    files |= {"a/exported/CMakeLists.txt": "ament_export_libraries(c)\n"} if "exported" in more else {}
    repository.commit({"a/package.xml": manifest, "a/CMakeLists.txt": f"{cmake}{install}{more}\n", **files})
    repository.write({"a/package.xml": manifest.replace(depend, "")})
    result = compare(repository)
    assert breaking(result) == [f"{tag} removed: gears"] * is_breaking


@pytest.mark.parametrize(("package", "is_breaking"), [("catkin_package()", False), (CATKIN_EXPORT, True)])
def test_dependency_of_a_package_that_builds_nothing_breaks_nobody(repository, compare, package, is_breaking):
    depend = "  <depend>gears</depend>\n"
    manifest = EXPORTS.replace("  <exec_depend>xacro", f"{depend}  <exec_depend>xacro")
    cmake = f"project(arm)\nfind_package(catkin REQUIRED COMPONENTS gears)\n{package}\n"
    repository.commit({"a/package.xml": manifest, "a/CMakeLists.txt": cmake, "a/launch/a.launch": "<launch/>\n"})
    repository.write({"a/package.xml": manifest.replace(depend, "")})
    assert breaking(compare(repository)) == ["depend removed: gears"] * is_breaking


def test_dependencies_with_the_same_tags_are_one_line(repository, compare):
    found, _ = find_dependency_changes(repository, compare, (">gears<", ">wheels<"), (">levers<", ">cranks<"))
    assert found == [
        "build_depend + exec_depend added: wheels, cranks",
        "build_depend + exec_depend removed: gears, levers",
    ]


@pytest.mark.parametrize(
    ("attributes", "shown"),
    [("condition=\"$SIMULATOR == 'new'\"", "if $SIMULATOR == 'new'"), ('version_gte="1.2"', ">= 1.2")],
)
def test_added_and_removed_dependencies_have_their_conditions(repository, compare, attributes, shown):
    old = "  <exec_depend>gears</exec_depend>\n"
    new = f"  <exec_depend {attributes}>wheels</exec_depend>\n"
    found, _ = find_dependency_changes(repository, compare, (f"  <build_depend>gears</build_depend>\n{old}", new))
    assert found[0] == f"exec_depend added: wheels ({shown})"
    text = DEPENDENCIES.replace(old, "").replace("  <build_depend>gears</build_depend>\n", "")
    repository.commit({"a/package.xml": text.replace("  <exec_depend>xacro", f"{new}  <exec_depend>xacro")})
    repository.write({"a/package.xml": text})
    assert sentences(subject(compare(repository), "a/package.xml")) == [f"exec_depend removed: wheels ({shown})"]


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        ("depend", "exec_depend", False),
        ("depend", "build_depend", True),
        ("build_export_depend", "test_depend", True),
        ("build_depend", "test_depend", False),
        ("exec_depend", "depend", False),
    ],
)
def test_dependency_that_is_no_longer_exported_by_the_package_is_breaking(repository, compare, old, new, is_breaking):
    text = EXPORTS.replace("exec_depend>", f"{old}>").replace("xacro", "urdf")
    repository.commit({"a/package.xml": text})
    repository.write({"a/package.xml": text.replace(f"{old}>", f"{new}>")})
    result = compare(repository)
    assert sentences(subject(result, "a/package.xml")) == [f"{old} -> {new}: urdf"]
    assert bool(breaking(result)) is is_breaking


def test_all_conditions_of_a_dependency_are_compared(repository, compare):
    lines = [line for line in DEPENDENCIES.splitlines(keepends=True) if "bridge" in line]
    new = "  <exec_depend>bridge</exec_depend>\n"
    found, breaking_ones = find_dependency_changes(repository, compare, (lines[0], new), (lines[1], ""))
    assert found == [
        "exec_depend bridge: if $SIMULATOR == 'old'; if $SIMULATOR == 'new' -> always",
        "environment variable 'SIMULATOR' no longer decides what is built",
    ]
    assert breaking_ones == found[1:]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("find_packages(exclude=['test'])", "['arm', 'arm.tools']", []),
        ("find_packages()", "find_packages(exclude=['arm.tools'])", ["installed Python modules removed: 'arm.tools'"]),
        ("find_packages('src')", "['arm']",
         ["installed Python modules removed: 'arm.tools'", "packages removed: find_packages('src')"]),
    ],
)  # fmt: skip
def test_found_packages_are_compared_by_their_names(repository, compare, old, new, expected):
    files = {"arm/package.xml": PACKAGE_XML, "arm/arm/__init__.py": "", "arm/arm/tools/__init__.py": ""}
    setup = "from setuptools import find_packages, setup\nsetup(name='arm', packages=%s)\n"
    repository.commit({**files, "arm/setup.py": setup % old})
    repository.write({"arm/setup.py": setup % new})
    result = compare(repository)
    found = [sentence for each in result.subjects if each.path == "arm/setup.py" for sentence in sentences(each)]
    assert found == expected


def test_an_executable_that_leaves_path_is_found_by_launch_files(repository, compare):
    text = "project(arm)\nadd_executable(driver driver.cpp)\ninstall(TARGETS driver DESTINATION %s)\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/CMakeLists.txt": text % "bin"})
    repository.write({"arm/CMakeLists.txt": text % "lib/arm"})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "commands that find it through PATH fail; launch files find it only now"


@pytest.mark.parametrize(
    ("build_type", "expected"),
    [("ament_python", []), ("ament_cmake", ["no longer installed: 'share/arm/launch/'"])],
)
def test_cmake_files_of_packages_that_are_built_without_cmake_are_other_files(
    repository, compare, build_type, expected
):
    manifest = PACKAGE_XML.replace("</package>", f"<export><build_type>{build_type}</build_type></export></package>")
    cmake = "project(arm)\n%sament_package()\n"
    install = "install(DIRECTORY launch DESTINATION share/arm)\n"
    repository.commit({"arm/package.xml": manifest, "arm/CMakeLists.txt": cmake % install, "arm/launch/a.txt": ""})
    repository.write({"arm/CMakeLists.txt": cmake % ""})
    assert breaking(compare(repository)) == expected


def test_a_changed_file_that_the_build_file_includes_is_compared_as_a_part_of_it(repository, compare):
    cmake = "project(arm)\nif(TRUE)\n  include(${CMAKE_CURRENT_SOURCE_DIR}/cmake/ros2.cmake)\nendif()\n"
    part = "find_package(rclcpp REQUIRED)\ninstall(PROGRAMS scripts/home.py DESTINATION lib/arm)\n"
    repository.commit({**FILES, "a/CMakeLists.txt": cmake, "a/cmake/ros2.cmake": part, "a/cmake/old.cmake": part})
    repository.write({"a/cmake/ros2.cmake": "find_package(rclpy REQUIRED)\n", "a/cmake/old.cmake": "# nothing\n"})
    result = compare(repository)
    assert sentences(subject(result, "a/CMakeLists.txt")) == [
        "installed executables removed: 'home.py'",
        "calls of find_package added: 'rclpy'",
        "calls of find_package removed: 'rclcpp'",
    ]
    assert list(result.other_files) == ["a/cmake/old.cmake"]


@pytest.mark.parametrize(
    ("command", "path", "name"),
    [
        ("rosidl_generate_interfaces(${{PROJECT_NAME}} srv/Stop.srv {})", "srv/Move.srv", "built interfaces"),
        ("install(PROGRAMS scripts/stop.py {} DESTINATION lib/${{PROJECT_NAME}})", "scripts/move.py",
         "installed executables"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("exists", [True, False])
def test_removed_entry_of_a_file_that_the_old_version_lacks_breaks_nobody(
    repository, compare, command, path, name, exists
):
    files = {"a/srv/Stop.srv": "---\n", "a/scripts/stop.py": "#!/usr/bin/env python3\n", "a/package.xml": EXPORTS}
    text = f"project(arm)\nfind_package(ament_cmake REQUIRED)\n{command}\n"
    repository.commit({**files, "a/CMakeLists.txt": text.format(path), **({f"a/{path}": "---\n"} if exists else {})})
    repository.write({"a/CMakeLists.txt": text.format("")})
    shown = path if "srv" in path else "move.py"
    expected = f"{name} removed: '{shown}'" + "; the old version does not have the files" * (not exists)
    result = compare(repository)
    assert expected in sentences(subject(result, "a/CMakeLists.txt"))
    assert any(name in line for line in breaking(result)) is exists


@pytest.mark.parametrize(
    ("condition", "expected"), [("BUILD_TESTING", []), ("BUILD_TOOLS", ["no longer installed: 'share/arm/test/'"])]
)
def test_files_that_are_installed_only_for_tests_are_missing_to_nobody(repository, compare, condition, expected):
    cmake = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\n%sament_package()\n"
    install = f"if({condition})\n  install(DIRECTORY test/config DESTINATION share/${{PROJECT_NAME}}/test)\nendif()\n"
    repository.commit({**FILES, "a/CMakeLists.txt": cmake % install, "a/test/config/arm.txt": "rate 10\n"})
    repository.write({"a/CMakeLists.txt": cmake % ""})
    result = compare(repository)
    assert breaking(result) == expected
    (found,) = [each for each in sentences(subject(result, "a/CMakeLists.txt")) if "installed" in each]
    assert found == (expected[0] if expected else "no longer installed for tests: 'share/arm/test/'")


def test_marker_of_a_package_that_is_built_with_cmake_now_is_not_lost(repository, compare):
    folder = "share/ament_index/resource_index/packages"
    setup = f"from setuptools import setup\nsetup(name='arm', data_files=[('{folder}', ['resource/arm'])])\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/setup.py": setup, "arm/resource/arm": ""})
    cmake = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nament_package()\n"
    repository.write({"arm/setup.py": None, "arm/resource/arm": None, "arm/CMakeLists.txt": cmake})
    assert not [line for line in breaking(compare(repository)) if "installed" in line]
