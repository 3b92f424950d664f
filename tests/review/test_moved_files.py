"""Files that move inside their package in a review.

The tests also cover plugin descriptions without an export.
"""

from __future__ import annotations

import pytest

from linkwright.files.git_repository import GitRepository
from linkwright.review.reports.sentences import list_other_files
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = PACKAGE_XML.replace("arm_description", "arm")
LAUNCH = "<launch>\n  <node pkg='arm' exec='{name}'/>\n</launch>\n"
NAMES = ("arm", "gripper", "tool", "all")


def cmake_text(folder: str) -> str:
    return f"project(arm)\ninstall(DIRECTORY {folder} DESTINATION share/arm)\nament_package()\n"


def find_moved_files(repository, compare, old_rule: str, new_rule: str):
    texts = {name: LAUNCH.format(name=name) for name in NAMES}
    old = {f"arm/examples/launch/{name}.launch.xml": text for name, text in texts.items()}
    new = {f"arm/launch/{name}.launch.xml": text for name, text in texts.items()}
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake_text(old_rule), **old})
    repository.commit({"arm/CMakeLists.txt": cmake_text(new_rule), **dict.fromkeys(old), **new})
    return compare(repository, "HEAD~1..HEAD")


def test_files_that_are_installed_at_the_same_place_are_one_line(repository, compare):
    result = find_moved_files(repository, compare, "examples/launch", "launch")
    assert result.subjects == []
    line = " -> ".join(f"install(DIRECTORY {folder} DESTINATION share/arm)" for folder in ("examples/launch", "launch"))
    assert [(path, str(state)) for path, state in list_other_files(result)] == [
        ("arm/CMakeLists.txt", line),
        ("arm/launch/", "4 files, moved from arm/examples/launch/, installed at the same place"),
    ]


def test_files_that_are_installed_at_another_place_are_breaking(repository, compare):
    assert breaking(find_moved_files(repository, compare, "examples", "launch")) == [
        (
            "folder renamed from arm/examples/ with 4 compared files: "
            "launch/all.launch.xml, launch/arm.launch.xml, launch/gripper.launch.xml, launch/tool.launch.xml"
        )
    ]


PLUGINS = """<library path="arm">
  <class name="arm/Grip" type="arm::Grip" base_class_type="base::Tool"/>
</library>
"""


@pytest.mark.parametrize(
    ("command", "is_breaking"),
    [
        ("", False),
        ("pluginlib_export_plugin_description_file(base plugins.xml)\n", True),
        ("pluginlib_export_plugin_description_file(base ${PLUGINS})\n", True),
    ],
)
def test_class_of_a_description_that_no_package_exports_breaks_nothing(repository, compare, command, is_breaking):
    build = cmake_text("launch").replace("ament_package", f"{command}ament_package")
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": build, "arm/plugins.xml": PLUGINS})
    repository.commit({"arm/plugins.xml": None})
    result = compare(repository, "HEAD~1..HEAD")
    assert sentences(subject(result, "arm/plugins.xml")) == ["plugin class 'arm/Grip' removed"]
    assert bool(breaking(result)) is is_breaking


def test_executable_without_its_module_is_breaking(repository, compare):
    setup = "from setuptools import setup\nsetup(name='arm', entry_points={'console_scripts': ['go = arm.go:main']})\n"
    repository.commit({"arm/package.xml": MANIFEST, "arm/setup.py": setup, "arm/arm/go.py": "def main(): ...\n"})
    repository.commit({"arm/setup.py": setup.replace("'arm',", "'arm', zip_safe=True,"), "arm/arm/go.py": None})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["executable 'go': its module 'arm.go' was removed"]


def test_added_package_is_described(repository, compare):
    repository.commit({"arm/package.xml": MANIFEST})
    repository.commit({"copy/package.xml": MANIFEST})
    (found,) = compare(repository, "HEAD~1..HEAD").subjects
    assert sentences(found) == [
        "package added: 'arm' 1.0.0, catkin; depends on xacro; arm/ has a package with the same name"
    ]


def test_renamed_files_with_equal_contents_are_paired_by_their_names(repository):
    text = LAUNCH.format(name="speech") + "<!-- the launch file of a node -->\n" * 8
    old = {f"arm/launch/n_{name}.launch": text for name in ("leds", "speech", "voice")}
    new = {"arm/launch/leds.launch": text.replace("speech", "leds"), "arm/launch/speech.launch": text}
    commits = [repository.commit(old), repository.commit({**dict.fromkeys(old), **new})]
    files = GitRepository(repository.root, "arm", "", downloads_lfs=False).changed_files(*commits)
    assert [(file.old_path, file.new_path) for file in files] == [
        ("arm/launch/n_leds.launch", "arm/launch/leds.launch"),
        ("arm/launch/n_voice.launch", None),
        ("arm/launch/n_speech.launch", "arm/launch/speech.launch"),
    ]


TEST = """project(arm)
if(BUILD_TESTING)
  ament_add_gtest(grip test/grip.cpp ${{CMAKE_CURRENT_SOURCE_DIR}}/test/{}.yaml)
endif()
{}ament_package()
"""
INSTALLED = "install(DIRECTORY test DESTINATION share/arm)\n"


@pytest.mark.parametrize(
    ("name", "install", "other_files", "is_breaking"),
    [
        ("new_grip", "", {}, False),
        ("grip", "", {}, True),
        ("new_grip", INSTALLED, {}, True),
        ("new_grip", "", {"arm/launch/grip.launch.py": "NAME = 'test/grip.yaml'\n"}, True),
    ],
)
def test_renamed_file_that_only_tests_use_is_breaking_if_its_old_name_is_used(
    repository, compare, name, install, other_files, is_breaking
):
    values = "grip:\n  ros__parameters:\n    force: 2.0\n    speed: 1.0\n"
    old = {"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": TEST.format("grip", install), **other_files}
    repository.commit({**old, "arm/test/grip.yaml": values})
    new = {"arm/CMakeLists.txt": TEST.format(name, install) + "# new\n"}
    repository.commit({**new, "arm/test/grip.yaml": None, "arm/test/new_grip.yaml": values})
    result = compare(repository, "HEAD~1..HEAD")
    assert sentences(subject(result, "arm/test/new_grip.yaml")) == ["renamed from arm/test/grip.yaml"]
    assert ("renamed from arm/test/grip.yaml" in breaking(result)) is is_breaking


def test_module_with_another_import_path_is_not_at_the_same_place(repository, compare):
    cmake = """project({name})
ament_python_install_package(${{PROJECT_NAME}})
ament_python_install_module(${{PROJECT_NAME}}/launch_common.py)
"""
    text = "from launch_ros.actions import Node\n\n\ndef make_arm():\n    return Node(package='arm', executable='a')\n"
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake.format(name="arm"),
                       "arm/arm/__init__.py": "", "arm/arm/launch_common.py": text})  # fmt: skip
    repository.commit({"arm/CMakeLists.txt": cmake.format(name="hand"), "arm/arm/__init__.py": None,
                      "arm/hand/__init__.py": "", "arm/arm/launch_common.py": None,
                      "arm/hand/launch_common.py": text})  # fmt: skip
    result = compare(repository, "HEAD~1..HEAD")
    assert "renamed from arm/arm/launch_common.py" in sentences(subject(result, "arm/hand/launch_common.py"))
