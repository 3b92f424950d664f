"""Plugins that still name a link or joint that is gone, in a review of models and robots."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

SDF = """<sdf version="1.9"><model name="cart">
<link name="base"/>
<link name="wheel"/>
<joint name="axle" type="revolute"><parent>base</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>
<plugin name="drive" filename="drive.so">
<bodyName>cart::base</bodyName>
<frameName>world</frameName>
<left_joint>axle</left_joint>
</plugin>
</model></sdf>
"""
URDF = """<robot name="cart">
<link name="base"/>
<link name="wheel"/>
<joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
<gazebo><plugin name="drive" filename="drive.so">
<robot_base_frame>wheel</robot_base_frame>
<jointName>axle</jointName>
</plugin></gazebo>
</robot>
"""


@pytest.mark.parametrize(
    ("path", "text", "replacements", "expected"),
    [
        ("a/model.sdf", SDF, [('link name="base"', 'link name="body"'), (">base<", ">body<")],
         ("plugin 'drive' still names 'cart::base' in <bodyName>", "the link 'base' no longer exists", 6)),
        ("a/model.sdf", SDF, [('joint name="axle"', 'joint name="hub"')],
         ("plugin 'drive' still names 'axle' in <left_joint>", "the joint 'axle' no longer exists", 8)),
        ("a/cart.urdf", URDF, [('joint name="axle"', 'joint name="hub"')],
         ("plugin 'drive' still names 'axle' in <jointName>", "the joint 'axle' no longer exists", 7)),
        ("a/cart.urdf", URDF, [('link name="wheel"', 'link name="disk"'), ('link="wheel"', 'link="disk"')],
         ("plugin 'drive' still names 'wheel' in <robot_base_frame>", "the link 'wheel' no longer exists", 6)),
        ("a/model.sdf", SDF, [("base", "body")], None),
        ("a/model.sdf", SDF,
         [('link name="base"', 'link name="body"'), (">base<", ">body<"),
          ("</model>", "<include><uri>model://arm</uri></include></model>")], None),
    ],
)  # fmt: skip
def test_plugin_that_names_a_lost_link_or_joint_is_breaking(repository, compare, path, text, replacements, expected):
    repository.commit({"a/package.xml": PACKAGE_XML, path: text})
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    repository.write({path: text})
    changes = subject(compare(repository), path).changes
    found = [change for change in changes if "still names" in str(change.sentence)]
    if expected is None:
        assert found == []
    else:
        ((change),) = found
        assert (str(change.sentence), str(change.reason), change.location.line) == expected
