"""Scenes in 3D in the page of a review.

They show both versions of a robot with their meshes, are bounded, and contain no file from elsewhere.
"""

from __future__ import annotations

import base64
import gzip
import json
import re

import pytest

from linkwright.cli import main
from linkwright.panels.export import html
from linkwright.review import open_versions, review
from linkwright.review.drawings import images, scenes
from linkwright.review.reports import as_html, scene_page
from tests.places import needs_page
from tests.repositories import PACKAGE, Repository

PATH = "arm_description/urdf/box.urdf"
URDF = """<robot name="box">
  <link name="base"><visual><geometry><mesh filename="{uri}"/></geometry></visual></link>
</robot>"""
URI = "package://arm_description/meshes/a.stl"


def make_stl(height: float) -> bytes:
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, height)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    lines = [
        f"facet normal 0 0 0 outer loop {' '.join('vertex {} {} {}'.format(*corners[index]) for index in face)} "
        "endloop endfacet"
        for face in faces
    ]
    return "\n".join(["solid a", *lines, "endsolid a", ""]).encode()


@pytest.fixture(autouse=True)
def _small_images(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw the images beside the scenes small, because they take longer than everything else."""
    monkeypatch.setattr(images, "_SIZE", (80, 60))


@pytest.fixture
def boxed(repository: Repository) -> Repository:
    """Return a repository with a robot whose mesh changed in the last commit but one."""
    repository.commit({**PACKAGE, PATH: URDF.format(uri=URI), "arm_description/meshes/a.stl": make_stl(1.0)})
    repository.commit({"arm_description/meshes/a.stl": make_stl(2.0)})
    repository.commit({"README.md": "Later."})
    return repository


def review_range(repository: Repository, range_text: str = "HEAD~2..HEAD~1"):
    versions = open_versions(repository.root, range_text)
    try:
        return review(versions, with_scenes=True)
    finally:
        versions.close()


def find_scene(result, path=PATH):
    (subject,) = (subject for subject in result.subjects if subject.path == path)
    return subject.scene


@needs_page
def test_scene_has_the_meshes_of_both_versions(boxed):
    data = json.loads(gzip.decompress(find_scene(review_range(boxed)).data))
    files = {base64.b64decode(content) for content in data["files"].values()}
    assert files == {make_stl(1.0), make_stl(2.0)}
    assert str(boxed.root) not in json.dumps(data["messages"])


@needs_page
def test_page_has_the_program_once_and_the_same_bytes_twice(boxed):
    boxed.commit({"arm_description/urdf/other.urdf": URDF.format(uri=URI).replace("box", "other")})
    boxed.commit({"arm_description/meshes/a.stl": make_stl(3.0)})
    first, second = (as_html(review_range(boxed, "HEAD~1..HEAD")) for _ in range(2))
    assert first == second
    assert first.count("<details class='scene'>") == 2
    assert first.count("id='viewer'") == 1
    assert not re.search(r"""(src|href)=['"](?!data:)""", first)


def test_page_without_scenes_has_no_program(boxed):
    versions = open_versions(boxed.root, "HEAD~2..HEAD~1")
    try:
        page = as_html(review(versions, with_images=True))
    finally:
        versions.close()
    assert "id='viewer'" not in page
    assert "<details class='scene'>" not in page


@needs_page
def test_files_from_elsewhere_are_in_no_scene(boxed, tmp_path):
    outside_file = tmp_path / "secret.stl"
    outside_file.write_bytes(make_stl(7.0))
    boxed.commit({PATH: URDF.format(uri=outside_file.as_uri())})
    scene = find_scene(review_range(boxed, "HEAD~1..HEAD"))
    assert scene.data == b""
    assert "it would contain files outside the repository" in str(scene.reason)


@needs_page
def test_meshes_of_a_repository_without_packages_are_in_the_scene(repository):
    repository.commit({"urdf/box.urdf": URDF.format(uri="../meshes/a.stl"), "meshes/a.stl": make_stl(1.0)})
    repository.commit({"meshes/a.stl": make_stl(2.0)})
    scene = find_scene(review_range(repository, "HEAD~1..HEAD"), "urdf/box.urdf")
    assert scene.reason is None
    assert len(json.loads(gzip.decompress(scene.data))["files"]) == 2


def test_installation_without_the_page_says_so(boxed, tmp_path, monkeypatch):
    monkeypatch.setattr(html, "PAGE_FOLDER", tmp_path)
    result = review_range(boxed)
    assert "the page for exports was not built" in str(find_scene(result).reason)
    assert "the page for exports was not built" in as_html(result)


@needs_page
def test_large_scene_is_left_out(boxed, monkeypatch):
    monkeypatch.setattr(scenes, "_MAX_BYTES", 100)
    scene = find_scene(review_range(boxed))
    assert (scene.data, str(scene.reason)) == (b"", "the scene in 3D is left out: it has 0 MB")


@needs_page
def test_later_scenes_of_a_large_page_are_left_out(boxed, monkeypatch):
    boxed.commit({"arm_description/urdf/other.urdf": URDF.format(uri=URI).replace("box", "other")})
    boxed.commit({"arm_description/meshes/a.stl": make_stl(3.0)})
    result = review_range(boxed, "HEAD~1..HEAD")
    monkeypatch.setattr(scene_page, "_MAX_BYTES", int(len(find_scene(result).data) * 1.5))
    page = as_html(result)
    assert page.count("<details class='scene'>") == 1
    assert page.count("the scene in 3D is left out") == 1


def test_scenes_without_a_page_are_wrong_usage(boxed, capsys):
    assert main(["review", "--repository", str(boxed.root), "HEAD", "--scenes"]) == 2
    assert "--html FILE" in capsys.readouterr().err
