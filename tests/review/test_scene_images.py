"""Images of worlds and meshes in the page: only of those that look different."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.review import open_versions, review

BOX = """<model name="{name}"><pose>{x} 0 0.5 0 0 0</pose><link name="link"><visual name="v"><geometry>
  <box><size>1 1 1</size></box></geometry></visual></link></model>"""


def world_text(*boxes: str, step: float = 0.001) -> str:
    physics = f'<physics name="p" type="ode"><max_step_size>{step}</max_step_size></physics>'
    return f'<sdf version="1.9"><world name="w">{physics}{"".join(boxes)}</world></sdf>'


def make_stl(height: float) -> bytes:
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles = np.zeros(2, record)
    triangles["corners"] = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0], [0, 0, height]]]
    return bytes(80) + len(triangles).to_bytes(4, "little") + triangles.tobytes()


FIXED = BOX.format(name="fixed", x=0)


@pytest.fixture
def render_images(repository):
    def run(path: str, old: str | bytes, new: str | bytes):
        repository.commit({path: old})
        repository.write({path: new})
        versions = open_versions(repository.root, "HEAD")
        try:
            (subject,) = review(versions, with_images=True).subjects
        finally:
            versions.close()
        return subject.images

    return run


@pytest.mark.parametrize("new_pose", [3, 100])
def test_moved_model_of_a_world_is_shown(render_images, new_pose):
    old, new = (world_text(FIXED, BOX.format(name="moved", x=x)) for x in (new_pose, new_pose + 1))
    images = render_images("w/worlds/w.sdf", old, new)
    assert [view.name for view in images] == ["iso", "front", "left", "top"]
    assert images[0].old != images[0].new


def test_world_with_same_appearance_has_no_images(render_images):
    assert render_images("w/worlds/w.sdf", world_text(FIXED), world_text(FIXED, step=0.002)) == []


def test_model_that_only_has_another_name_is_not_shown(render_images):
    old, new = (world_text(FIXED, BOX.format(name=name, x=3)) for name in ("old_name", "new_name"))
    assert render_images("w/worlds/w.sdf", old, new) == []


def test_changed_mesh_is_shown(render_images):
    images = render_images("w/meshes/m.stl", make_stl(1.0), make_stl(2.0))
    assert len(images) == 4
    assert images[0].old != images[0].new


def test_world_of_one_version_is_shown(repository):
    repository.commit({"README.md": "w"})
    repository.commit({"w/worlds/w.sdf": world_text(FIXED)})
    repository.commit({"w/worlds/w.sdf": None})
    for revisions, names in (("HEAD~2..HEAD~1", ("new", "old")), ("HEAD~1..HEAD", ("old", "new"))):
        versions = open_versions(repository.root, revisions)
        try:
            (subject,) = review(versions, with_images=True).subjects
        finally:
            versions.close()
        shown, missing = names
        assert len(subject.images) == 4
        assert all(getattr(view, shown) and not getattr(view, missing) for view in subject.images)
