"""Programs that still name a removed data file, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

FILES = {
    "a/package.xml": PACKAGE_XML,
    "a/grammar/words.bnf": "x ::= y\n",
    "a/scripts/talk.py": 'path = folder + "/grammar/words.bnf"\n',
    "a/config/talk.yaml": "talk:\n  grammar: grammar/words.bnf\n",
}
REMOVED = "names the file 'words.bnf', which was removed"
RENAMED = "names the file 'words.bnf', which has another name now"


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"a/grammar/words.bnf": None}, [REMOVED, REMOVED]),
        ({"a/grammar/words.bnf": None, "a/config/talk.yaml": None}, ["parameter file removed", REMOVED]),
        ({"a/grammar/words.bnf": None, "a/data/words.bnf": "x ::= y\n"}, []),
        ({"a/grammar/words.bnf": None, "a/grammar/text.bnf": "x ::= y\n"}, [RENAMED, RENAMED]),
        ({"a/grammar/words.bnf": None, "a/scripts/talk.py": "# words.bnf\n", "a/config/talk.yaml": "talk: {}\n"}, []),
    ],
)  # fmt: skip
def test_program_that_names_a_removed_data_file_is_breaking(repository, compare, changes, expected):
    repository.commit(FILES)
    repository.commit(changes)
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert [item.partition(":")[0] for item in found] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            '<mesh filename="package://arm_description/meshes/base.stl"/>',
            ["names the file 'base.stl', which was removed"],
        ),
        ('<!-- <mesh filename="package://arm_description/meshes/base.stl"/> -->', []),
    ],
)
def test_macro_that_names_a_removed_mesh_is_breaking(repository, compare, text, expected):
    macro = f'<xacro:macro name="base" params=""><link name="b"><visual><geometry>{text}</geometry></visual></link>'
    xacro = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{macro}</xacro:macro></robot>'
    repository.commit(
        {"a/package.xml": PACKAGE_XML, "a/urdf/base.xacro": xacro, "a/meshes/base.stl": "solid a\nendsolid a\n"}
    )
    repository.commit({"a/meshes/base.stl": None})
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert [item for item in found if item != "mesh removed"] == expected


@pytest.mark.parametrize(
    ("path", "is_told"), [("b/ui/runner.py", True), ("a/setup.py", False), ("b/launch/all.launch.py", False)]
)
def test_program_of_any_package_that_names_a_removed_launch_file_is_breaking(repository, compare, path, is_told):
    files = {"b/package.xml": PACKAGE_XML.replace("arm_description", "b"), path: "run(['core.launch.py'])\n"}
    repository.commit({**FILES, **files, "a/launch/core.launch.py": "x = 1\n"})
    repository.commit({"a/launch/core.launch.py": None})
    found = breaking(compare(repository, "HEAD~1..HEAD"))
    assert ("names the file 'core.launch.py', which was removed" in found) is is_told
