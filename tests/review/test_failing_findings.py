"""Findings about missing files that break a build or a description are breaking changes of a review."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, PACKAGE_XML
from tests.review.conftest import subject
from tests.review.test_findings import finding_codes

ROBOT = "arm_description/urdf/arm.urdf.xacro"
INCLUDE = '<xacro:include filename="camera.xacro"/>'
CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm_description)
find_package(ament_cmake REQUIRED)
install(DIRECTORY {folders} DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
BUILD = "arm_description/CMakeLists.txt"


def list_reasons(result, path: str) -> dict[str, str]:
    return {str(each.sentence): str(each.reason) for each in subject(result, path).changes if each.reason}


@pytest.mark.parametrize("was_missing", [False, True])
def test_newly_included_file_that_does_not_exist_is_breaking(package, compare, was_missing):
    old = INCLUDE.replace("camera", "lamp") if was_missing else ""
    package.commit({ROBOT: ARM.replace("</robot>", f"{old}</robot>")})
    package.write({ROBOT: ARM.replace("</robot>", f"{INCLUDE}</robot>")})
    result = compare(package)
    codes = finding_codes(result.new_findings)
    if was_missing:
        assert codes == ["XML101"]
        return
    (reason,) = list_reasons(result, ROBOT).items()
    assert "camera.xacro" in reason[0]
    assert reason[1] == "the description can no longer be read"
    assert "XML101" not in codes


@pytest.mark.parametrize("is_added", [False, True])
def test_installed_folder_that_does_not_exist_is_breaking(package, compare, is_added):
    package.commit({"arm_description/package.xml": PACKAGE_XML})
    if not is_added:
        package.commit({BUILD: CMAKE.format(folders="urdf")})
    package.write({BUILD: CMAKE.format(folders="urdf meshs")})
    result = compare(package)
    if is_added:
        assert "LW824" in finding_codes(result.new_findings)
        return
    text = "installed folders that the repository does not have added: 'meshs'"
    assert list_reasons(result, BUILD) == {text: "the build fails, because 'meshs' does not exist"}
    assert "LW824" not in finding_codes(result.new_findings)


def test_installed_folder_outside_of_the_repository_may_exist(package, compare):
    package.commit({BUILD: CMAKE.format(folders="urdf")})
    package.write({BUILD: CMAKE.format(folders="urdf ../../tools/include ../tools/include")})
    result = compare(package)
    reasons = list(list_reasons(result, BUILD).values())
    assert reasons == ["the build fails, because '../tools/include' does not exist"]
    assert "LW824" not in finding_codes(result.new_findings)


@pytest.mark.parametrize("was_refused", [False, True])
def test_description_that_urdfdom_refuses_is_one_breaking_change(package, compare, was_refused):
    inertia = '<inertia ixx="{}" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    part = f'<link name="lamp"><inertial><mass value="{{}}"/>{inertia}</inertial></link></robot>'
    joint = '<joint name="lamp_joint" type="fixed"><parent link="base_link"/><child link="lamp"/></joint>'
    old, new = part.format("1", "1 m" if was_refused else "1"), part.format("1 kg", "1.0-6")
    package.commit({ROBOT: ARM.replace("</robot>", joint + old)})
    package.write({ROBOT: ARM.replace("</robot>", joint + new)})
    result = compare(package)
    if was_refused:
        assert not result.subjects
        return
    assert list_reasons(result, ROBOT) == {
        "'value' in <mass> of link 'lamp' is not a number: '1 kg'": (
            "robot_state_publisher does not start with the description"
        )
    }
    assert finding_codes(result.new_findings) == ["URDF121"]
