"""The lines of a review about frames that a function of a source writes into messages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/arm/arm.py"
START = """def make(parent, child):
    transform = TransformStamped()
    transform.header.frame_id = parent
    transform.child_frame_id = child
    return transform


"""
METHOD = """class Arm:
    def make(self, parent, child):
        self.transform.child_frame_id = child

    def send(self):
"""


@pytest.mark.parametrize(
    ("source", "is_told"),
    [
        (START + "send(make('base', '{}'))\n", True),
        (START + "send(make('base', child='{}'))\n", True),
        (START + "send(other.make('base', '{}'))\n", False),
        (START.replace("    return", "    child = 'fixed'\n    return") + "send(make('base', '{}'))\n", False),
        (START + START + "send(make('base', '{}'))\n", False),
        (METHOD + "        self.make('base', '{}')\n", True),
    ],
)
def test_frame_that_a_function_gets_as_an_argument(repository, compare, source, is_told):
    repository.commit({**MANIFEST, PATH: source.format("tool")})
    repository.write({PATH: source.format("hand")})
    (found,) = compare(repository).subjects
    assert ("frame 'tool' renamed to 'hand'" in sentences(found)) == is_told
