"""Names that a Python source gives in loops over constants."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
NODE = """from names import make_names
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Bool, String

CAMERAS = {{'front': '/front/image', 'wrist': '/wrist/image'}}
OUTPUTS = [('state', String), ('ready', Bool)]
SIDES = ['left']


class Arm(Node):
    def __init__(self):
        super().__init__('arm')
{}
"""


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        (["for key, topic in CAMERAS.items():", "    self.create_subscription(Image, topic, self.show, 10)"],
         "subscriptions added: '/front/image' (Image), '/wrist/image' (Image)"),
        (["for key in CAMERAS:", "    self.create_subscription(Image, f'/{key}/depth', self.show, 10)"],
         "subscriptions added: '/front/depth' (Image), '/wrist/depth' (Image)"),
        (["for name, kind in OUTPUTS:", "    self.create_publisher(kind, 'out/' + name, 10)"],
         "publishers added: 'out/state' (String), 'out/ready' (Bool)"),
        (["p = [self.create_publisher(Bool, f'{side}/{end}', 10) for side in ('a', 'b') for end in ('c', 'd')]"],
         "publishers added: 'a/c' (Bool), 'a/d' (Bool), 'b/c' (Bool), 'b/d' (Bool)"),
        (["for name in make_names():", "    self.create_publisher(Bool, name, 10)"],
         "publishers with computed names added: 'name' (Bool)"),
        (["for side in SIDES:", "    self.create_publisher(Bool, side, 10)", "SIDES.append('right')"],
         "publishers with computed names added: 'side' (Bool)"),
        (["for side in ('a', 'b'):", "    side = side.upper()", "    self.create_publisher(Bool, side, 10)"],
         "publishers with computed names added: 'side' (Bool)"),
    ],
)  # fmt: skip
def test_a_loop_over_constants_gives_each_name(repository, compare, lines, expected):
    repository.commit(MANIFEST)
    repository.write({"arm/arm.py": NODE.format("\n".join(f"        {line}" for line in lines))})
    (found,) = compare(repository).subjects
    assert expected in sentences(found)
