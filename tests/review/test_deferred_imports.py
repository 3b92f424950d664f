"""Modules that functions of Python sources import, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

FIRST = "import rosbag\nimport os\n\ndef record():\n    {}return rosbag.Bag(os.getcwd())\n"
NAMES = "imported only in 'record()' now: 'rosbag'"


@pytest.mark.parametrize("statement", ["import rosbag\n    ", "rosbag = importlib.import_module('rosbag')\n    "])
def test_module_that_only_functions_import_is_named(package, compare, statement):
    path = "arm_description/scripts/record.py"
    first, later = FIRST.format(""), FIRST.format(statement).replace("import rosbag\n", "", 1)
    package.commit({path: first})
    package.commit({path: later})
    assert NAMES in sentences(subject(compare(package, "HEAD~1..HEAD"), path))
    assert "imported with the module now: 'rosbag'" in sentences(subject(compare(package, "HEAD..HEAD~1"), path))


def test_module_that_is_still_imported_first_is_not_named(package, compare):
    path = "arm_description/scripts/record.py"
    package.commit({path: FIRST.format("")})
    package.write({path: FIRST.format("import rosbag\n    ")})
    assert not any("imported" in line for found in compare(package).subjects for line in sentences(found))
