"""Changed files with the same contents as before, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, PACKAGE_XML
from tests.review.conftest import sentences, subject

BUILD = "project(arm_description)\nif(V VERSION_GREATER 1)\n  add_definitions(-DNEW)\nendif()\nament_package()\n"


@pytest.mark.parametrize(
    ("path", "old", "new"),
    [
        ("package.xml", PACKAGE_XML, PACKAGE_XML.replace("</package>", "<!-- <depend>a</depend> --></package>")),
        ("urdf/arm.urdf.xacro", ARM, ARM.replace("</robot>", "\n\n<!-- end --></robot>")),
        ("config/a.yaml", "names: [left]\nrate: 5\n", "names: ['left']  # all\nrate:   5 \n"),
        ("CMakeLists.txt", BUILD, f"# build\n{BUILD}"),
        ("setup.py", "from setuptools import setup\nsetup()\n", "from setuptools import setup\n\nsetup( ) # all\n"),
    ],
)
def test_comments_and_notations_are_not_listed(package, compare, path, old, new):
    package.commit({f"arm_description/{path}": old})
    package.write({f"arm_description/{path}": new})
    result = compare(package)
    assert (result.subjects, result.other_files) == ([], [])


def test_changed_condition_of_a_definition_is_shown(package, compare):
    path = "arm_description/CMakeLists.txt"
    package.commit({path: BUILD})
    package.write({path: BUILD.replace("GREATER", "GREATER_EQUAL")})
    result = compare(package)
    assert result.other_files == [path]
    assert str(result.file_states[path]) == "if(V VERSION_GREATER 1) -> if(V VERSION_GREATER_EQUAL 1)"


def test_texture_of_a_material_script_is_shown(package, compare):
    path = "arm_description/media/tag.material"
    text = "material Tag\n{\n  // white\n  texture {}tag.png\n}\n"
    package.commit({path: text.replace("{}", "")})
    package.write({path: text.replace("{}", "../textures/").replace("white", "black")})
    assert str(compare(package).file_states[path]) == "texture tag.png -> texture ../textures/tag.png"


def test_yaml_file_with_any_name_can_be_a_list_of_repositories(package, compare):
    path = "arm_description/third_party.yaml"
    entry = "  {0}:\n    type: git\n    url: https://example.org/{0}.git\n    version: main\n"
    package.commit({path: "repositories:\n" + entry.format("left") + entry.format("right")})
    package.write({path: "repositories:\n" + entry.format("left")})
    assert sentences(subject(compare(package), path)) == [
        "repository 'right' removed: type git, url https://example.org/right.git, version main"
    ]


def test_empty_files_are_paired_by_their_names(package, compare):
    old, new = "arm_description/old", "arm_description/new"
    package.commit({f"{old}/arm/__init__.py": "", f"{old}/arm/tool/__init__.py": ""})
    package.git("mv", old, new)
    package.commit({"arm_description/docs/a.txt": ""})
    result = compare(package, "HEAD~1..HEAD")
    states = {path: str(result.file_states.get(path)) for path in result.other_files}
    assert states == {
        f"{new}/arm/__init__.py": f"renamed from {old}/arm/__init__.py",
        f"{new}/arm/tool/__init__.py": f"renamed from {old}/arm/tool/__init__.py",
        "arm_description/docs/a.txt": "added",
    }


def test_files_that_need_an_absent_package_are_one_note(package, compare):
    text = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:include filename="$(find absent_package)/urdf/base.xacro"/>
      <xacro:base_of_robot name="base"/>
      <xacro:if value="${base_height > 1}"><link name="tip"><inertial><mass value="%s"/></inertial></link></xacro:if>
      </robot>"""
    paths = [f"arm_description/urdf/{side}.urdf.xacro" for side in ("left", "middle", "right")]
    package.commit(dict.fromkeys(paths, text % 1))
    package.write(dict.fromkeys(paths, text % 2))
    result = compare(package)
    assert [subject(result, path).problems for path in paths] == [[], [], []]
    (note,) = (str(note) for note in result.notes if "as they are written" in str(note))
    assert note == (
        f"3 changed files are only compared as they are written, such as '{paths[0]}': "
        "package 'absent_package' not found"
    )


def test_finding_at_an_old_line_that_another_file_of_the_robot_had_is_not_new(package, compare):
    part = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="blade">
      <link name="blade"><visual>{}<geometry><box size="1 1 1"/></geometry></visual></link>
      <joint name="blade_joint" type="revolute"><parent link="lower"/><child link="blade"/><axis xyz="0 0 1"/>
      <limit lower="1" upper="0" effort="1" velocity="1"/></joint></xacro:macro></robot>"""
    robot = ARM.replace("</robot>", '<xacro:include filename="FILE.xacro"/><xacro:blade/></robot>')
    folder = "arm_description/urdf"
    package.commit(
        {f"{folder}/{name}.xacro": part.format("") for name in ("old", "new")}
        | {
            f"{folder}/arm.urdf.xacro": robot.replace("FILE", "old"),
            f"{folder}/other.urdf.xacro": robot.replace("FILE", "old"),
        }
    )
    package.write(
        {
            f"{folder}/arm.urdf.xacro": robot.replace("FILE", "new").replace("</robot>", "<xacro:absent/></robot>"),
            f"{folder}/new.xacro": part.format('<origin xyz="0 0 1"/>'),
        }
    )
    assert [finding.code for finding in compare(package).new_findings] == ["XAC401"]
