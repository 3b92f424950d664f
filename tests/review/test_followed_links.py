"""Joints of a macro that follow the new names of its links."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/hand.xacro"
HAND = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="hand" params="prefix">
    <link name="${{prefix}}{base}"><visual><geometry><box size="1 2 3"/></geometry></visual></link>
    <link name="${{prefix}}finger"/>
    <link name="${{prefix}}tip"/>
    <joint name="${{prefix}}finger_joint" type="fixed">
      <parent link="${{prefix}}{parent}"/><child link="${{prefix}}finger"/>
    </joint>
    <joint name="${{prefix}}tip_joint" type="fixed">
      <parent link="${{prefix}}finger"/><child link="${{prefix}}tip"/>
    </joint>
  </xacro:macro>
</robot>
"""


@pytest.mark.parametrize(("parent", "count"), [("palm", 1), ("tip", 2)])
def test_only_another_parent_is_a_change_of_the_joint(repository, compare, parent, count):
    repository.commit({"arm_description/package.xml": PACKAGE_XML, PATH: HAND.format(base="hand", parent="hand")})
    repository.write({PATH: HAND.format(base="palm", parent=parent)})
    result = compare(repository)
    assert len(breaking(result)) == 1
    assert len(sentences(subject(result, PATH))) == count
