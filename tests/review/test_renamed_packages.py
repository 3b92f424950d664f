"""Packages with new names and folders in a review: all consequences are one change."""

from __future__ import annotations

import pytest

from linkwright.review.reports.sentences import list_other_files
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """project(arm_tools)
find_package(ament_cmake REQUIRED)
add_library(arm_tools_core src/core.cpp)
install(TARGETS arm_tools_core LIBRARY DESTINATION lib)
install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
pluginlib_export_plugin_description_file(arm_base plugins.xml)
ament_package()
"""
MANIFEST = PACKAGE_XML.replace("arm_description", "arm_tools")
FILES = {
    "arm_tools/package.xml": MANIFEST,
    "arm_tools/CMakeLists.txt": CMAKE,
    "arm_tools/plugins.xml": """<library path="arm_tools_core">
  <class name="arm_tools/Grip" type="arm_tools::Grip" base_class_type="arm_base::Tool"><description/></class>
</library>
""",
    "arm_tools/config/arm.yaml": "driver:\n  ros__parameters:\n    rate: 10\n    plugin: arm_tools/Grip\n",
    "arm_tools/launch/arm.launch.xml": """<launch>
  <node pkg="arm_tools" exec="driver" name="driver">
    <param from="$(find-pkg-share arm_tools)/config/arm.yaml"/>
    <remap from="cmd" to="arm_tools/cmd"/>
  </node>
</launch>
""",
    **{f"arm_tools/src/{name}.cpp": f"int {name}() {{ return 1; }}\n" for name in ("core", "grip", "hold", "turn")},
    "robot/package.xml": PACKAGE_XML.replace("arm_description", "robot").replace(">xacro<", ">arm_tools<"),
}


RENAMED = (
    "package 'arm_tools' renamed to 'arm_gear'; also installed libraries 'arm_tools_core' -> 'arm_gear_core', "
    "plugin classes 'arm_tools/Grip' -> 'arm_gear/Grip'"
)


def rename_package_files(new_folder: str, new_name: str, **replacements: str) -> dict[str, str | None]:
    """Return the files of a commit that moves the package.

    All texts but that of the topic have the new name.
    """
    files: dict[str, str | None] = {}
    for path, text in FILES.items():
        new_text = text.replace("arm_tools", new_name).replace(f"{new_name}/cmd", "arm_tools/cmd")
        for old, new in replacements.items():
            new_text = new_text.replace(old, new)
        new_path = path.replace("arm_tools/", f"{new_folder}/", 1)
        if new_path != path:
            files[path] = None
        files[new_path] = new_text
    return files


def test_what_follows_from_the_new_name_of_a_package_is_one_change(repository, compare):
    repository.commit(FILES)
    repository.commit(rename_package_files("arm_gear", "arm_gear"))
    result = compare(repository, "HEAD~1..HEAD")
    assert [(found.path, sentences(found)) for found in result.subjects] == [("arm_gear/package.xml", [RENAMED])]
    assert [str(note) for note in result.notes if "follow" in str(note)]
    assert [(path, str(state)) for path, state in list_other_files(result)] == [
        ("arm_gear/src/", "4 files, moved with the package from arm_tools/"),
        ("robot/package.xml", "None"),
    ]


@pytest.mark.parametrize(
    ("old", "new", "path", "sentence"),
    [
        ("rate: 10", "rate: 20", "arm_gear/config/arm.yaml", "driver.ros__parameters.rate 10 -> 20"),
        ("arm_tools/cmd", "arm_gear/cmd", "arm_gear/launch/arm.launch.xml",
         "node 'arm_gear/driver': remapping cmd arm_tools/cmd -> arm_gear/cmd"),
        ("arm_gear_core", "gear_core", "arm_gear/CMakeLists.txt",
         "installed libraries: 'arm_tools_core' renamed to 'gear_core'"),
        ("arm_gear/Grip", "arm_gear/Grasp", "arm_gear/plugins.xml",
         "plugin class 'arm_tools/Grip' renamed to 'arm_gear/Grasp'"),
    ],
)  # fmt: skip
def test_other_changes_beside_a_new_name_are_reported(repository, compare, old, new, path, sentence):
    repository.commit(FILES)
    repository.commit(rename_package_files("arm_gear", "arm_gear", **{old: new}))
    assert sentence in sentences(subject(compare(repository, "HEAD~1..HEAD"), path))


def test_package_that_moves_to_another_folder_is_one_change_and_breaks_nothing(repository, compare):
    repository.commit(FILES)
    repository.commit(rename_package_files("gear/arm_tools", "arm_tools"))
    result = compare(repository, "HEAD~1..HEAD")
    assert [sentences(found) for found in result.subjects] == [["package 'arm_tools' moved from arm_tools/"]]
    assert breaking(result) == []
    assert result.other_files == []


def test_package_that_moves_to_the_root_has_its_changed_files(repository, compare):
    files = {f"gear/arm_tools/{path.removeprefix('arm_tools/')}": text for path, text in FILES.items()}
    notes = "Notes about the gear.\n" * 9
    repository.commit({**files, "gear/arm_tools/notes.txt": notes})
    moved = {path.removeprefix("gear/arm_tools/"): text for path, text in files.items()}
    repository.commit({**moved, **dict.fromkeys([*files, "gear/arm_tools/notes.txt"]), "notes.txt": f"{notes}More.\n"})
    result = compare(repository, "HEAD~1..HEAD")
    expected = "package 'arm_tools' moved from gear/arm_tools/ to the root of the repository"
    assert sentences(subject(result, "package.xml")) == [expected]
    assert result.other_files == ["notes.txt"]


def test_package_with_another_manifest_in_another_folder_is_moved(repository, compare):
    """Git does not pair manifests with few equal lines."""
    repository.commit(FILES)
    manifest = "<package format='3'><name>arm_tools</name><build_type>ament_cmake</build_type></package>\n"
    files = {**rename_package_files("tools/arm_tools", "arm_tools"), "tools/arm_tools/package.xml": manifest}
    repository.commit(files)
    result = compare(repository, "HEAD~1..HEAD")
    assert "package 'arm_tools' moved from arm_tools/" in sentences(subject(result, "tools/arm_tools/package.xml"))
    assert [subject.path for subject in result.subjects] == ["tools/arm_tools/package.xml"]


def sibling_files(*names: str) -> dict[str, str]:
    """Return the files of packages that differ only in their names."""
    files = {}
    for name in names:
        included = f"$(find {name})/launch/view.launch"
        files |= {
            f"{name}/package.xml": f"<package><name>{name}</name><version>1.0.0</version></package>\n",
            f"{name}/launch/demo.launch": f"<launch>\n<include file='{included}'>\n<arg name='unknown' value='1'/>\n"
            "</include>\n</launch>\n",
            f"{name}/launch/view.launch": f"<launch>\n<node pkg='{name}' type='view' name='view'/>\n</launch>\n",
        }
    return files


def test_files_of_similar_packages_are_paired_within_their_package(repository, compare):
    """Git pairs similar files of different packages."""
    repository.commit(sibling_files("arm_a", "arm_b", "arm_c"))
    new = sibling_files("z_arm_a", "y_arm_b", "x_arm_c")
    repository.commit({**dict.fromkeys(sibling_files("arm_a", "arm_b", "arm_c")), **new})
    found = {found.path: sentences(found) for found in compare(repository, "HEAD~1..HEAD").subjects if found.changes}
    assert found == {
        f"{new}/package.xml": [f"package '{old}' renamed to '{new}'"]
        for old, new in (("arm_a", "z_arm_a"), ("arm_b", "y_arm_b"), ("arm_c", "x_arm_c"))
    }


def test_findings_that_name_the_renamed_package_are_neither_new_nor_fixed(package, compare):
    mesh = '<visual><geometry><mesh filename="package://arm_description/meshes/none.stl"/></geometry></visual>'
    robot = f'<robot name="tool"><link name="tool">{mesh}</link></robot>'
    package.commit({"arm_description/urdf/tool.urdf": robot})
    package.git("mv", "arm_description", "robot_arm")
    manifest = (package.root / "robot_arm/package.xml").read_text(encoding="utf-8")
    package.commit(
        {
            "robot_arm/package.xml": manifest.replace("arm_description", "robot_arm"),
            **{
                path: (package.root / path).read_text(encoding="utf-8").replace("arm_description", "robot_arm")
                for path in (f"robot_arm/urdf/{name}" for name in ("tool.urdf", "arm.urdf.xacro", "segment.xacro"))
            },
        }
    )
    review = compare(package, "HEAD~1..HEAD")
    assert review.new_findings == []
    assert review.fixed_findings == []


def test_robot_that_neither_version_can_read_has_one_problem_after_a_move(package, compare):
    package.commit({"arm_description/urdf/two.urdf": '<robot name="two"><link name="a"/><link name="b"/></robot>'})
    package.git("mv", "arm_description/urdf/two.urdf", "arm_description/urdf/pair.urdf")
    package.commit({})
    problems = [
        str(problem.text) for subject in compare(package, "HEAD~1..HEAD").subjects for problem in subject.problems
    ]
    assert len(problems) == 1
    assert problems[0].startswith("neither version can be read: ")


@pytest.mark.parametrize(
    ("old_header", "new_header", "keeps_text", "expected"),
    [
        ("gripper/grip.hpp", "kuka_gripper/grip.hpp", False, []),
        ("gripper/gripper.hpp", "kuka_gripper/kuka_gripper.hpp", True, []),
        ("gripper/gripper.hpp", "kuka_gripper/kuka_gripper.hpp", False, []),
        (
            "gripper/grip.hpp",
            "kuka_gripper/kuka_grip.hpp",
            True,
            ["headers renamed: 'gripper/grip.hpp -> kuka_gripper/kuka_grip.hpp'"],
        ),
    ],
)
def test_headers_that_are_renamed_with_their_package_are_no_new_ones(
    repository, compare, old_header, new_header, keeps_text, expected
):
    text = "#pragma once\n" + "class Grip;\n" * 20
    build = "project({0})\nfind_package(ament_cmake REQUIRED)\ninstall(DIRECTORY include/ DESTINATION include)\n"
    folders = [("c/gripper", "gripper", old_header), ("c/kuka_gripper", "kuka_gripper", new_header)]
    old, new = (
        {
            f"{folder}/package.xml": PACKAGE_XML.replace("arm_description", name),
            f"{folder}/CMakeLists.txt": build.format(name),
            f"{folder}/include/{header}": text if name == "gripper" or keeps_text else text.replace("class", "struct"),
        }
        for folder, name, header in folders
    )
    repository.commit(old)
    repository.commit({**dict.fromkeys(old), **new})
    lines = [line for subject in compare(repository, "HEAD~1..HEAD").subjects for line in sentences(subject)]
    assert [line for line in lines if "header" in line or "installed now" in line] == expected


def test_package_with_a_short_manifest_is_paired_by_its_moved_files(repository, compare):
    """Git does not pair two manifests of one line."""
    manifest = "<package><name>{0}</name><version>1.0.0</version></package>"
    config = "driver:\n  ros__parameters:\n    rate: 10\n    gain: 2\n"
    repository.commit({"old/package.xml": manifest.format("old"), "old/config/a.yaml": config})
    files = {"arm/package.xml": manifest.format("arm").replace("1.0.0", "2.1.0"), "arm/config/a.yaml": config}
    repository.commit({**files, "old/package.xml": None, "old/config/a.yaml": None})
    result = compare(repository, "HEAD~1..HEAD")
    assert "package 'old' renamed to 'arm'" in " ".join(sentences(subject(result, "arm/package.xml")))
    assert not any("removed" in sentence for sentence in breaking(result))


@pytest.mark.parametrize(
    ("project", "build_type", "is_breaking"),
    [("arm", "ament_cmake", False), ("old", "ament_cmake", True), ("arm", "cmake", True)],
)
def test_package_with_the_name_of_its_project_is_repaired(repository, compare, project, build_type, is_breaking):
    export = f"<export><build_type>{build_type}</build_type></export></package>"
    manifest = PACKAGE_XML.replace("</package>", export)
    build = f"cmake_minimum_required(VERSION 3.8)\nproject({project})\nament_package()\n"
    repository.commit({"package.xml": manifest.replace("arm_description", "old"), "CMakeLists.txt": build})
    repository.write({"package.xml": manifest.replace("arm_description", "arm")})
    result = compare(repository)
    renamed = "package 'old' renamed to 'arm'"
    assert renamed in sentences(subject(result, "package.xml"))
    assert (renamed in breaking(result)) == is_breaking


def test_packages_without_common_files_are_removed_and_added(repository, compare):
    manifest = "<package><name>{0}</name><version>1.0.0</version></package>"
    repository.commit({"old/package.xml": manifest.format("old"), "old/config/a.yaml": "a: {ros__parameters: {x: 1}}"})
    files = {"arm/package.xml": manifest.format("arm"), "arm/config/b.yaml": "other:\n  ros__parameters:\n    y: [1]\n"}
    repository.commit({**files, "old/package.xml": None, "old/config/a.yaml": None})
    removed = "package removed with 2 files: parameter files 'config/a.yaml'"
    assert breaking(compare(repository, "HEAD~1..HEAD")) == [removed]


def test_packages_that_still_depend_on_the_old_name_of_a_package_are_named(repository, compare):
    cmake = "find_package(catkin REQUIRED COMPONENTS rospy arm_tools)\nfind_package(Boost COMPONENTS arm_tools)\n"
    repository.commit({**FILES, "robot/CMakeLists.txt": cmake})
    files = rename_package_files("arm_gear", "arm_gear")
    repository.commit({**files, "robot/package.xml": FILES["robot/package.xml"]})
    result = compare(repository, "HEAD~1..HEAD")
    assert breaking(result) == [
        RENAMED,
        "requires the package 'arm_tools', whose name is 'arm_gear' now",
        "depends on the package 'arm_tools', whose name is 'arm_gear' now",
    ]
    locations = [change.location for change in (*result.subjects[-2].changes, *result.subjects[-1].changes)]
    assert [(location.file, location.line) for location in locations if location] == [
        ("robot/CMakeLists.txt", 1),
        ("robot/package.xml", 8),
    ]


def test_dependency_on_the_old_name_of_a_package_that_another_folder_still_has_breaks_nothing(repository, compare):
    repository.commit(FILES)
    files = rename_package_files("arm_gear", "arm_gear")
    other = {"other/package.xml": MANIFEST, "robot/package.xml": FILES["robot/package.xml"]}
    repository.commit({**files, **other})
    assert not [sentence for sentence in breaking(compare(repository, "HEAD~1..HEAD")) if "depends on" in sentence]


def test_imports_of_a_package_that_only_has_another_name_are_no_change(repository, compare):
    files = {
        "arm_tools/package.xml": FILES["arm_tools/package.xml"],
        "arm_tools/setup.py": "from setuptools import setup\nsetup(name='arm_tools', packages=['arm_tools'])\n",
        "arm_tools/arm_tools/__init__.py": "",
        "arm_tools/arm_tools/hand.py": "from arm_tools.grip import close\n\n\ndef hold():\n    return close()\n",
        "robot/package.xml": FILES["robot/package.xml"],
        "robot/scripts/hold.py": "#!/usr/bin/env python3\nfrom arm_tools import hand\n\nhand.hold()\n",
        "robot/scripts/other.py": "from arm_tools import hand\n\nhand.hold()\n",
    }
    repository.commit(files)
    moved = {
        path.replace("arm_tools", "arm_gear"): text.replace("arm_tools", "arm_gear") for path, text in files.items()
    }
    other = {"robot/scripts/other.py": "import numpy\nfrom arm_gear import hand\n\nhand.hold()\n"}
    repository.commit({**dict.fromkeys(files), **moved, **other})
    result = compare(repository, "HEAD~1..HEAD")
    assert [(found.path, sentences(found)) for found in result.subjects] == [
        (
            "arm_gear/package.xml",
            ["package 'arm_tools' renamed to 'arm_gear'; also installed Python modules 'arm_tools' -> 'arm_gear'"],
        ),
        ("robot/scripts/other.py", ["packages imported for the first time: 'numpy'"]),
    ]


def test_a_module_that_keeps_the_old_name_of_its_package_is_imported_as_before(repository, compare):
    files = {
        "arm_tools/package.xml": FILES["arm_tools/package.xml"],
        "arm_tools/arm_tools/__init__.py": "",
        "arm_tools/scripts/hold.py": "#!/usr/bin/env python3\nfrom arm_tools import hand\n\nhand.hold()\n",
        "robot/package.xml": FILES["robot/package.xml"],
        "robot/scripts/hold.py": "#!/usr/bin/env python3\nfrom arm_tools import hand\n\nhand.hold()\n",
    }
    repository.commit(files)
    moved = {
        "arm_gear/package.xml": files["arm_tools/package.xml"].replace("arm_tools", "arm_gear"),
        "arm_gear/arm_tools/__init__.py": "",
        "arm_gear/scripts/hold.py": files["arm_tools/scripts/hold.py"].replace("hand.hold()", "hand.hold()  # tight"),
        "robot/scripts/hold.py": files["robot/scripts/hold.py"].replace("hand.hold()", "hand.hold()  # tight"),
    }
    own = {path: None for path in files if path.startswith("arm_tools/")}
    repository.commit({**own, **moved})
    result = compare(repository, "HEAD~1..HEAD")
    assert not any("import" in line for found in result.subjects for line in sentences(found))


LAUNCH_CODE = """import os
from launch import LaunchDescription
from ament_index_python.packages import get_package_share_directory

def generate_launch_description():
    arm_tools = get_package_share_directory("arm_tools")
    robot = Robot()
    robot.set_file(os.path.join(arm_tools, "arm.xmacro"))
    robot.make({0})
    return LaunchDescription([])
"""
CPP_CODE = """#include <arm_tools/grip.hpp>
int hold() {{
  int force = arm_tools::kForce + {0};
  return force;
}}
"""


@pytest.mark.parametrize(
    ("path", "code", "value", "other"),
    [
        ("robot/launch/arm.launch.py", LAUNCH_CODE, "'red'", "other code: robot.make('red') -> robot.make('blue')"),
        ("robot/src/hold.cpp", CPP_CODE, "1", "value in 'hold()': arm_gear::kForce + 1 -> arm_gear::kForce + 2"),
    ],
)
def test_code_that_names_a_renamed_package_is_no_other_code(repository, compare, path, code, value, other):
    repository.commit({**FILES, path: code.format(value)})
    new = code.format(value).replace("arm_tools", "arm_gear")
    repository.commit({**rename_package_files("arm_gear", "arm_gear"), path: new})
    result = compare(repository, "HEAD~1..HEAD")
    assert [found.path for found in result.subjects if found.path == path] == []
    repository.commit({path: code.format({"1": "2"}.get(value, "'blue'")).replace("arm_tools", "arm_gear")})
    changed = compare(repository, "HEAD~2..HEAD")
    assert len(sentences(subject(changed, path))) == 1
    assert other.rpartition("-> ")[2].rpartition("+ ")[2] in sentences(subject(changed, path))[0]
