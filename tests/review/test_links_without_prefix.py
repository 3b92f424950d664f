"""Links of a macro without the prefix with which its joints name them, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm/urdf/arm.xacro"
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm" params="prefix:=''">
    <link name="${prefix}flange"/>
  </xacro:macro>
</robot>
"""
ADDED = """<link name="LINK"/>
    <joint name="${prefix}grip_joint" type="fixed"><parent link="${prefix}flange"/><child link="CHILD"/></joint>
"""
SENTENCE = "macro 'arm': link 'grip' lacks the prefix of its joint"


@pytest.mark.parametrize(
    ("link", "child", "expected"),
    [
        ("grip", "${prefix}grip", [SENTENCE]),
        ("${prefix}grip", "${prefix}grip", []),
        ("grip", "grip", []),
        ("grip", "${other}grip", []),
    ],
)
def test_a_link_without_the_prefix_of_its_joint_is_breaking(repository, compare, link, child, expected):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    added = ADDED.replace("LINK", link).replace("CHILD", child)
    repository.commit({"arm/package.xml": manifest, PATH: MACRO})
    repository.write({PATH: MACRO.replace("  </xacro:macro>", f"    {added}  </xacro:macro>")})
    assert [sentence for sentence in breaking(compare(repository)) if "prefix of" in sentence] == expected


def test_an_old_link_without_the_prefix_is_no_change(repository, compare):
    added = ADDED.replace("LINK", "grip").replace("CHILD", "${prefix}grip")
    text = MACRO.replace("  </xacro:macro>", f"    {added}  </xacro:macro>")
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: text})
    repository.write({PATH: text.replace("grip_joint", "grasp_joint")})
    assert not [sentence for sentence in breaking(compare(repository)) if "prefix of" in sentence]
