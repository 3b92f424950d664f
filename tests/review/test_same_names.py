"""Names and types in sources that stay the same although they are written in another way."""

from __future__ import annotations

import re

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

NODE = """class Lamp(Node):
    def __init__(self):
        super().__init__("lamp")
        self.client = self.create_client(Empty, "{}")
"""


@pytest.mark.parametrize(("name", "reasons"), [("off", []), ("stop", ["servers that offer '/off' get no requests"])])
def test_a_client_with_a_relative_name_instead_of_the_absolute_one_breaks_nobody(repository, compare, name, reasons):
    repository.commit({"lamp/package.xml": PACKAGE_XML, "lamp/lamp.py": NODE.format("/off")})
    repository.write({"lamp/lamp.py": NODE.format(name)})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


PUBLISHER = """import rospy
from {}.msg import Level
pub = rospy.Publisher("level", Level, queue_size=1)
"""


@pytest.mark.parametrize("imported", ["lamp", "lantern"])
def test_type_of_a_renamed_package_that_a_source_still_imports_is_not_another_one(repository, compare, imported):
    files = {
        "lamp/msg/Level.msg": "float64 value\n",
        "lamp/package.xml": PACKAGE_XML.replace("arm_description", "lamp"),
    }
    files |= {"lamp/CMakeLists.txt": "project(lamp)\nfind_package(catkin)\ncatkin_package()\n"}
    repository.commit({**files, "lamp/scripts/level.py": PUBLISHER.format("lamp")})
    new = {path: re.sub(r"\blamp\b", "lantern", text) for path, text in files.items()}
    repository.write({**new, "lamp/scripts/level.py": PUBLISHER.format(imported) + "rospy.spin()\n"})
    lines = breaking(compare(repository))
    assert any(line.startswith("package 'lamp' renamed to 'lantern'") for line in lines)
    assert not any("type" in line for line in lines)
