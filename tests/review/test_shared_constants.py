"""Topics whose names are constants of headers and of other Python modules."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
HEADER = """#pragma once
namespace names {
constexpr char SCAN[] = "scan";
const std::string STATE{"state"};
#define POSE "pose"
}
"""
TALKER = """#include "arm/names.hpp"
Arm::Arm() : Node("arm") {
  scan_ = create_publisher<LaserScan>(names::SCAN, 10);
  state_ = create_publisher<State>(names::STATE, 10);
  pose_ = create_publisher<Pose>(POSE, 10);
}
"""
CPP = {**MANIFEST, "arm/include/arm/names.hpp": HEADER, "arm/src/arm.cpp": TALKER}
MODULE = "SCAN = 'scan'\nPRICE = '\\$'\n"
"""A module with an invalid escape sequence, about which Python warns."""
NODE = "import rclpy\n{}\nnode = rclpy.create_node('arm')\nnode.create_publisher(LaserScan, {}, 10)\n"


@pytest.mark.parametrize(("old", "new"), [('"scan"', '"laser"'), ('"state"', '"status"'), ('"pose"', '"place"')])
def test_a_changed_constant_of_a_header_renames_the_topics_of_its_users(repository, compare, old, new):
    repository.commit(CPP)
    repository.write({"arm/include/arm/names.hpp": HEADER.replace(old, new)})
    result = compare(repository)
    (sentence,) = sentences(subject(result, "arm/src/arm.cpp"))
    assert f"renamed to '{new.strip(chr(34))}'" in sentence
    assert sentence in breaking(result)


def test_a_variable_of_a_header_that_the_source_assigns_is_no_constant(repository, compare):
    text = TALKER.replace("  scan_ =", "  SCAN = read();\n  scan_ =")
    repository.commit({**CPP, "arm/src/arm.cpp": text})
    repository.write({"arm/include/arm/names.hpp": HEADER.replace('"scan"', '"laser"')})
    assert not [sentence for sentence in breaking(compare(repository)) if "publisher" in sentence]


@pytest.mark.parametrize(
    ("statement", "name"),
    [
        ("from arm.names import SCAN", "SCAN"),
        ("from .names import SCAN as TOPIC", "TOPIC"),
        ("from arm import names", "names.SCAN"),
        ("import names", "names.SCAN"),
    ],
)
def test_a_changed_constant_of_a_module_renames_the_topics_of_its_users(repository, compare, statement, name):
    node = NODE.format(statement, name)
    repository.commit({**MANIFEST, "arm/arm/names.py": MODULE, "arm/arm/node.py": node, "arm/arm/__init__.py": ""})
    repository.write({"arm/arm/names.py": MODULE.replace("scan", "laser")})
    expected = "publisher 'scan' (LaserScan) renamed to 'laser' (LaserScan)"
    assert expected in breaking(compare(repository))


def test_an_unused_constant_changes_no_topic(repository, compare):
    node = NODE.format("from arm.names import SCAN", "'scan'")
    repository.commit({**MANIFEST, "arm/arm/names.py": MODULE, "arm/arm/node.py": node, "arm/arm/__init__.py": ""})
    repository.write({"arm/arm/names.py": MODULE.replace("scan", "laser")})
    assert breaking(compare(repository)) == []


def test_a_module_outside_of_the_package_is_not_read(repository, compare):
    node = NODE.format("from ...other.names import SCAN", "SCAN")
    repository.commit({**MANIFEST, "other/names.py": MODULE, "arm/arm/node.py": node, "arm/arm/__init__.py": ""})
    repository.write({"arm/arm/node.py": node.replace("'arm'", "'leg'")})
    assert "scan" not in " ".join(sentences(subject(compare(repository), "arm/arm/node.py")))


PACKAGE_CONSTANTS = "NAMESPACE = '/arm/'\nSCAN = NAMESPACE + 'scan'\n\n\nclass Topics:\n    SCAN = f'{NAMESPACE}scan'\n"


@pytest.mark.parametrize(
    ("statement", "name"),
    [
        ("import arm as names", "names.SCAN"),
        ("from arm import SCAN", "SCAN"),
        ("from . import Topics", "Topics.SCAN"),
        ("from arm import Topics as T", "T.SCAN"),
    ],
)
def test_a_constant_of_constants_in_the_package_is_the_name_of_a_topic(repository, compare, statement, name):
    node = NODE.format(statement, name)
    package = {**MANIFEST, "arm/arm/node.py": node, "arm/arm/__init__.py": PACKAGE_CONSTANTS}
    repository.commit({**package, "arm/setup.py": ""})
    repository.write({"arm/arm/__init__.py": PACKAGE_CONSTANTS.replace("/arm/", "/leg/")})
    expected = "publisher '/arm/scan' (LaserScan) renamed to '/leg/scan' (LaserScan)"
    assert expected in breaking(compare(repository))


RESULT = """class Arm(Node):
    {decorator}def topic(self):
        \"\"\"Return the topic.\"\"\"
        return {result}

    def start(self):
        self.create_publisher(LaserScan, {name}, 10)
"""


@pytest.mark.parametrize(
    ("values", "is_known"),
    [
        ({"decorator": "", "result": "'{}'", "name": "self.topic()"}, True),
        ({"decorator": "@property\n    ", "result": "'{}'", "name": "self.topic"}, True),
        ({"decorator": "@property\n    ", "result": "'{}'", "name": "'/arm/' + self.topic"}, True),
        ({"decorator": "@other\n    ", "result": "'{}'", "name": "self.topic()"}, False),
        ({"decorator": "@property\n    ", "result": "self.topic + '{}'", "name": "self.topic"}, False),
    ],
)
def test_result_of_a_function_is_the_name_of_a_topic(repository, compare, values, is_known):
    for name, write in (("scan", repository.commit), ("laser", repository.write)):
        write({**MANIFEST, "arm/arm/node.py": RESULT.format(**{**values, "result": values["result"].format(name)})})
    found = [sentence for sentence in breaking(compare(repository)) if "renamed to" in sentence]
    assert len(found) == is_known
