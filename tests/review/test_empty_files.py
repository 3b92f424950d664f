"""Files that were empty, and files outside of packages, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject


def test_parameters_of_nodes_count_outside_of_packages(repository, compare):
    text = "driver:\n  ros__parameters:\n    rate: {}\n"
    repository.commit({"config/driver.yaml": text.format(5), "config/tool.yaml": "rate: 5\n"})
    repository.write({"config/driver.yaml": text.format(6), "config/tool.yaml": "rate: 6\n"})
    result = compare(repository)
    assert [found.path for found in result.subjects] == ["config/driver.yaml"]
    assert result.other_files == ["config/tool.yaml"]


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        ("a/config/a.yaml", "rate: 5\n", ["parameter file added: rate 5"]),
        ("a/urdf/a.xacro", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="m"/></robot>',
         ["description file added", "macro 'm' added"]),
        ("a/launch/a.launch", '<launch><node pkg="a" type="b" name="c"/></launch>',
         ["launch file added: node 'a/b' (name c)"]),
    ],
)  # fmt: skip
@pytest.mark.parametrize("empty", ["", " \n"])
def test_file_that_was_empty_is_an_added_file(repository, compare, path, text, expected, empty):
    repository.commit({"a/package.xml": PACKAGE_XML.replace("arm_description", "a"), path: empty})
    repository.write({path: text})
    assert sentences(subject(compare(repository), path)) == expected


def test_file_that_stays_empty_is_no_change(repository, compare):
    blank = dict.fromkeys(("a/setup.py", "a/a/node.py", "a/a/__init__.py", "a/README.md"), "\n")
    repository.commit({"a/package.xml": PACKAGE_XML.replace("arm_description", "a"), **blank})
    repository.write(dict.fromkeys(blank, ""))
    result = compare(repository)
    assert (result.subjects, result.other_files) == ([], [])
    repository.write({"a/a/__init__.py": "from a.node import *"})
    result = compare(repository)
    assert [*(found.path for found in result.subjects), *result.other_files] == ["a/a/__init__.py"]
