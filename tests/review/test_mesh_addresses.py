"""Meshes of xacro files whose addresses are of another kind."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/urdf/arm.urdf.xacro"
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base">
  <visual><geometry><mesh filename="{0}/meshes/a.stl"/></geometry></visual>
  <collision><geometry><mesh filename="{0}/meshes/b.stl"/></geometry></collision>
</link></robot>
"""
PACKAGE, FILE, FIND = "package://arm", "file://$(find arm)", "$(find arm)"


@pytest.mark.parametrize(
    ("old", "new", "change"),
    [
        (PACKAGE, FIND, "package:// -> $(find ...), without file://"),
        (FIND, PACKAGE, "$(find ...) -> package://"),
        (FIND, "$(find  arm)", None),
        (FILE, "file://$(find  arm)", None),
    ],
)
def test_other_kind_of_address_is_told_once(repository, compare, old, new, change):
    corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0"
    stl = f"solid a\nfacet normal 0 0 1\nouter loop\n{corners}\nendloop\nendfacet\nendsolid\n"
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    meshes = dict.fromkeys(("arm/meshes/a.stl", "arm/meshes/b.stl"), stl)
    repository.commit({"arm/package.xml": manifest, PATH: ROBOT.format(old), **meshes})
    repository.write({PATH: ROBOT.format(new)})
    result = compare(repository)
    assert breaking(result) == []
    found = [line for item in result.subjects for line in sentences(item)]
    assert found == ([] if change is None else [f"addresses of 2 meshes: {change}"])
    assert change is None or sentences(subject(result, PATH)) == found


def test_addresses_with_file_are_shown_as_they_are_written(package, compare):
    path = "arm_description/urdf/plain.urdf"
    text = """<robot name="plain"><link name="base">
  <visual><geometry><mesh filename="file://$(find {})/meshes/a.dae"/></geometry></visual>
</link></robot>
"""
    package.commit({path: text.format("absent")})
    package.write({path: text.format("arm_description")})
    lines = [line for found in compare(package).subjects for line in sentences(found) if "geometry mesh" in line]
    addresses = [f"file://$(find {name})/meshes/a.dae" for name in ("absent", "arm_description")]
    assert lines == [f"link 'base': visual geometry mesh {addresses[0]} -> mesh {addresses[1]}"]
