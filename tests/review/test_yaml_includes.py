"""YAML files in a review whose items move into files that they include."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "a/config/world.yaml"
CAMERA = "name: camera\ntype: Camera\nparameters:\n  rate: 10\n"
ITEM = "- name: camera\n  type: Camera\n  parameters:\n    rate: 10\n"
WORLD = f"plugins:\n{ITEM}- name: map\n  type: Map\n"
ADDED = "included files added: 'camera.yaml'"


@pytest.mark.parametrize(
    ("old", "new", "content", "expected"),
    [
        (WORLD, WORLD.replace(ITEM, "- include: camera.yaml\n"), CAMERA, [ADDED]),
        (WORLD, WORLD.replace(ITEM, "- $include: camera.yaml\n"), CAMERA, [ADDED]),
        (WORLD, WORLD.replace(ITEM, "- !include camera.yaml\n"), CAMERA, [ADDED]),
        (WORLD, WORLD.replace(ITEM, "- include: camera.yaml\n"), ITEM, [ADDED]),
        (WORLD, "include: camera.yaml\n", WORLD, [ADDED]),
        (WORLD, WORLD.replace(ITEM, "- include: camera.yaml\n"), CAMERA.replace("10", "20"),
         [ADDED, "plugins[camera].parameters.rate 10 -> 20"]),
        (WORLD.replace(ITEM, "- include: camera.yaml\n"), WORLD, CAMERA,
         ["included files removed: 'camera.yaml'"]),
        (WORLD, WORLD.replace(ITEM, "- include: ../../../other.yaml\n"), CAMERA,
         ["plugins[camera] removed: type Camera, parameters.rate 10",
          "plugins[0].include ../../../other.yaml added"]),
    ],
)  # fmt: skip
def test_items_of_included_files_are_those_of_the_file(repository, compare, old, new, content, expected):
    (repository.root.parent / "other.yaml").write_text(CAMERA)
    files = {"a/package.xml": PACKAGE_XML, "a/config/camera.yaml": content}
    repository.commit({**files, PATH: old})
    repository.write({PATH: new})
    assert sorted(sentences(subject(compare(repository), PATH))) == sorted(expected)


def test_files_that_include_each_other_are_read_once(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: "plugins: []\n", "a/config/b.yaml": "- include: b.yaml\n"})
    repository.write({PATH: "plugins:\n- include: b.yaml\n"})
    assert "included files added: 'b.yaml'" in sentences(subject(compare(repository), PATH))


def test_files_that_include_each_other_many_times_are_read_up_to_a_limit(repository, compare):
    items = "- include: b.yaml\n" * 500
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: "plugins: []\n", "a/config/b.yaml": items})
    repository.write({PATH: f"plugins:\n{items}"})
    assert "included files added: 'b.yaml'" in sentences(subject(compare(repository), PATH))
