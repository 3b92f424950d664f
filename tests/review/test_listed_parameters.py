"""Patterns of the names of parameters that a source lists, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

OLD = """from rclpy.node import Node


class Reader(Node):
    def __init__(self):
        super().__init__("reader")
        for marker in ["one", "two"]:
            self.values = self.get_parameter_or("markers.{0}.{1}".format(marker, "size"))
"""
LOOP = 'for marker in ["one", "two"]:'


@pytest.mark.parametrize(
    ("loop", "name", "is_breaking"),
    [
        ('for marker in self.get_parameters_by_prefix("markers"):', '"markers.{}".format(marker)', False),
        ('for marker in self.get_parameters_by_prefix("tags"):', '"tags.{}".format(marker)', True),
        (LOOP, '"markers.{}".format(marker)', True),
    ],
)
def test_pattern_of_listed_parameters_that_covers_the_old_names_is_not_breaking(
    repository, compare, loop, name, is_breaking
):
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/arm/reader.py": OLD}
    repository.commit(files)
    text = OLD.replace(LOOP, loop).replace('"markers.{0}.{1}".format(marker, "size")', name)
    repository.write({"arm/arm/reader.py": text})
    found = [line for line in breaking(compare(repository)) if "renamed" in line]
    assert bool(found) == is_breaking
