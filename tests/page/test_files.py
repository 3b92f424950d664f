"""The files that the page may load: URLs, folders and limits."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.page.files import IMAGE_TYPES, MESH_TYPES, FileRefusedError, MeshFolders, MeshIndex


def write_file(path: Path, content: str = "solid") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content, encoding="utf-8")
    return path


def write_package(folder: Path, name: str) -> Path:
    write_file(folder / "package.xml", f"<package format='3'><name>{name}</name></package>")
    return folder


@pytest.fixture
def robot(tmp_path):
    share = write_package(tmp_path / "robot", "robot")
    write_file(share / "meshes" / "arm.dae")
    write_file(share / "meshes" / "arm.png")
    write_file(share / "materials" / "wood.png")
    write_file(share / "launch" / "secret.py")
    return share


@pytest.fixture
def index(tmp_path, robot):
    return MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": robot}))


def served_path(index: MeshIndex, url: str) -> Path:
    """Return the path that the server reads for a URL."""
    folders = MeshFolders()
    folders.replace("display-1", index.folders)
    _, _, key, relative = url.partition("?")[0].split("/", 3)
    return folders.file(key, relative)


def test_package_mesh_has_url_below_package(index, robot):
    located = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert located.problem is None
    assert located.url.startswith("/mesh/robot-")
    assert "/meshes/arm.dae?v=" in located.url
    assert str(robot) not in located.url
    assert served_path(index, located.url) == robot / "meshes" / "arm.dae"


def test_files_beside_mesh_are_served(index, robot):
    url = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    base = url[: url.index("meshes/")]
    assert served_path(index, f"{base}meshes/arm.png")
    assert served_path(index, f"{base}materials/wood.png") == robot / "materials" / "wood.png"


def test_edited_mesh_has_new_url(index, robot):
    before = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    os.utime(robot / "meshes" / "arm.dae", ns=(1, 1))
    assert index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url != before


def test_file_uris_and_paths_in_package_use_package_url(index, robot):
    expected = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert index.locate(f"file://{robot}/meshes/arm.dae", None, MESH_TYPES) == expected
    assert index.locate(str(robot / "meshes" / "arm.dae"), None, MESH_TYPES) == expected
    assert index.locate("../meshes/arm.dae", robot / "urdf", MESH_TYPES) == expected


def test_mesh_outside_package_exposes_its_folder_and_subfolders(index, tmp_path):
    mesh = write_file(tmp_path / "loose" / "a b" / "part.STL")
    write_file(mesh.parent / "textures" / "t.png")
    write_file(mesh.parent / "textures" / "deep" / "t.png")
    url = index.locate(f"file://{mesh.parent.parent}/a%20b/part.STL", None, MESH_TYPES).url
    assert "/part.STL?" in url
    base = url[: url.index("part")]
    assert served_path(index, f"{base}part.STL") == mesh
    assert served_path(index, f"{base}textures/t.png")
    with pytest.raises(FileRefusedError) as caught:
        served_path(index, f"{base}textures/deep/t.png")
    assert caught.value.status == 403


@pytest.mark.parametrize(
    ("uri", "problem"),
    [
        ("package://robot/meshes/gone.dae", "no file '"),
        ("package://nobody/meshes/a.dae", "package 'nobody' not found"),
        ("http://example.org/a.dae", "scheme 'http'"),
        ("", "is empty"),
        ("package://robot/launch/secret.py", "is not supported"),
        ("package://robot/meshes", "no file '"),
        ("package://robot/meshes/a\0.dae", "no file '"),
    ],
)
def test_missing_mesh_is_reported_with_reason(index, uri, problem):
    located = index.locate(uri, None, MESH_TYPES)
    assert located.url is None
    assert problem in located.problem
    assert index.folders == {}


def test_missing_package_is_searched_once(index, monkeypatch):
    searched = []
    monkeypatch.setattr(index.finder, "packages", lambda: searched.append("packages") or {})
    problems = {index.locate(f"package://nobody/{number}.dae", None, MESH_TYPES).problem for number in range(5)}
    assert (len(problems), searched) == (1, ["packages"])


def test_missing_file_is_reported_with_full_path(index, robot):
    located = index.locate("package://robot/meshes/gone.dae", None, MESH_TYPES)
    assert str(robot / "meshes" / "gone.dae") in located.problem


def test_textures_must_be_images(index):
    assert index.locate("package://robot/materials/wood.png", None, IMAGE_TYPES).url
    assert index.locate("package://robot/meshes/arm.dae", None, IMAGE_TYPES).url is None


def rejection_status(index: MeshIndex, relative: str) -> int:
    (key,) = index.folders
    folders = MeshFolders()
    folders.replace("display-1", index.folders)
    with pytest.raises(FileRefusedError) as caught:
        folders.file(key, relative)
    return caught.value.status


@pytest.mark.parametrize(
    ("relative", "status"),
    [
        ("../outside.dae", 403),
        ("meshes/../../outside.dae", 403),
        ("meshes//arm.dae", 403),
        ("./meshes/arm.dae", 403),
        ("/etc/passwd", 403),
        ("", 403),
        ("meshes\\..\\arm.dae", 403),
        ("meshes/arm.dae\0.png", 403),
        ("launch/secret.py", 403),
        ("package.xml", 403),
        ("meshes", 403),
        ("meshes/gone.dae", 404),
        ("meshes/" + "x" * 300 + ".dae", 404),
    ],
)
def test_paths_outside_package_are_rejected(index, robot, relative, status):
    write_file(robot.parent / "outside.dae")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert rejection_status(index, relative) == status


@pytest.mark.parametrize("target", ["outside.dae", "secret.txt"])
def test_symlink_out_of_package_is_rejected(index, robot, target):
    outside = write_file(robot.parent / target)
    (robot / "meshes" / "link.dae").symlink_to(outside)
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert rejection_status(index, "meshes/link.dae") == 403
    assert "link" in index.locate("package://robot/meshes/link.dae", None, MESH_TYPES).problem


def test_symlinked_folder_out_of_package_is_rejected(index, robot):
    write_file(robot.parent / "other" / "a.dae")
    (robot / "more").symlink_to(robot.parent / "other")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert rejection_status(index, "more/a.dae") == 403


def test_circular_symlink_is_not_found(index, robot):
    (robot / "meshes" / "loop.dae").symlink_to("loop.dae")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert rejection_status(index, "meshes/loop.dae") == 404


def test_symlink_install_links_into_sources_are_served(tmp_path):
    source = write_package(tmp_path / "src" / "robot", "robot")
    mesh = write_file(source / "meshes" / "arm.dae")
    share = write_package(tmp_path / "install" / "robot" / "share" / "robot", "robot")
    (share / "meshes").mkdir()
    (share / "meshes" / "arm.dae").symlink_to(mesh)
    index = MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": share}))
    url = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    assert served_path(index, url) == mesh


def test_symlinks_into_other_package_are_rejected(tmp_path):
    other = write_package(tmp_path / "src" / "other", "other")
    write_file(other / "meshes" / "arm.dae")
    share = write_package(tmp_path / "share" / "robot", "robot")
    (share / "meshes").symlink_to(other / "meshes")
    index = MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": share}))
    assert index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url is None


def test_folders_are_removed_with_their_description(index):
    url = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    _, _, key, relative = url.partition("?")[0].split("/", 3)
    folders = MeshFolders()
    with pytest.raises(FileRefusedError):
        folders.file(key, relative)
    folders.replace("display-1", index.folders)
    assert folders.file(key, relative)
    folders.replace("display-1", {})
    with pytest.raises(FileRefusedError) as caught:
        folders.file(key, relative)
    assert caught.value.status == 404


def test_git_lfs_pointer_is_reported(index, robot):
    (robot / "meshes" / "arm.dae").write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 9\n")
    located = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert located.url is None
    assert "Git LFS pointer" in (located.problem or "")
    assert "git lfs pull" in (located.problem or "")
