from __future__ import annotations

import os
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.page.files import IMAGE_TYPES, MESH_TYPES, FileRefusedError, MeshFolders, MeshIndex


def write(path: Path, content: str = "solid") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content, encoding="utf-8")
    return path


def package(folder: Path, name: str) -> Path:
    write(folder / "package.xml", f"<package format='3'><name>{name}</name></package>")
    return folder


@pytest.fixture
def robot(tmp_path):
    share = package(tmp_path / "robot", "robot")
    write(share / "meshes" / "arm.dae")
    write(share / "meshes" / "arm.png")
    write(share / "materials" / "wood.png")
    write(share / "launch" / "secret.py")
    return share


@pytest.fixture
def index(tmp_path, robot):
    return MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": robot}))


def ask(index: MeshIndex, url: str) -> Path:
    """Return what the server reads for an address."""
    folders = MeshFolders()
    folders.replace("display-1", index.folders)
    _, _, key, relative = url.partition("?")[0].split("/", 3)
    return folders.file(key, relative)


def test_a_mesh_of_a_package_has_an_address_below_the_package(index, robot):
    located = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert located.problem is None
    assert located.url.startswith("/mesh/robot-")
    assert "/meshes/arm.dae?v=" in located.url
    assert str(robot) not in located.url
    assert ask(index, located.url) == robot / "meshes" / "arm.dae"


def test_what_lies_beside_it_is_reachable(index, robot):
    url = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    base = url[: url.index("meshes/")]
    assert ask(index, f"{base}meshes/arm.png")
    assert ask(index, f"{base}materials/wood.png") == robot / "materials" / "wood.png"


def test_an_edited_mesh_has_another_address(index, robot):
    before = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    os.utime(robot / "meshes" / "arm.dae", ns=(1, 1))
    assert index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url != before


def test_file_addresses_and_paths_in_a_package_are_of_the_package(index, robot):
    expected = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert index.locate(f"file://{robot}/meshes/arm.dae", None, MESH_TYPES) == expected
    assert index.locate(str(robot / "meshes" / "arm.dae"), None, MESH_TYPES) == expected
    assert index.locate("../meshes/arm.dae", robot / "urdf", MESH_TYPES) == expected


def test_a_loose_mesh_opens_its_folder_and_the_folders_in_it(index, tmp_path):
    mesh = write(tmp_path / "loose" / "a b" / "part.STL")
    write(mesh.parent / "textures" / "t.png")
    write(mesh.parent / "textures" / "deep" / "t.png")
    url = index.locate(f"file://{mesh.parent.parent}/a%20b/part.STL", None, MESH_TYPES).url
    assert "/part.STL?" in url
    base = url[: url.index("part")]
    assert ask(index, f"{base}part.STL") == mesh
    assert ask(index, f"{base}textures/t.png")
    with pytest.raises(FileRefusedError) as caught:
        ask(index, f"{base}textures/deep/t.png")
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
def test_why_there_is_no_mesh(index, uri, problem):
    located = index.locate(uri, None, MESH_TYPES)
    assert located.url is None
    assert problem in located.problem
    assert index.folders == {}


def test_a_package_that_is_not_there_is_looked_for_once(index, monkeypatch):
    searched = []
    monkeypatch.setattr(index.finder, "packages", lambda: searched.append("packages") or {})
    problems = {index.locate(f"package://nobody/{number}.dae", None, MESH_TYPES).problem for number in range(5)}
    assert (len(problems), searched) == (1, ["packages"])


def test_the_missing_file_is_named_with_its_whole_path(index, robot):
    located = index.locate("package://robot/meshes/gone.dae", None, MESH_TYPES)
    assert str(robot / "meshes" / "gone.dae") in located.problem


def test_textures_are_images(index):
    assert index.locate("package://robot/materials/wood.png", None, IMAGE_TYPES).url
    assert index.locate("package://robot/meshes/arm.dae", None, IMAGE_TYPES).url is None


def refused(index: MeshIndex, relative: str) -> int:
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
def test_paths_that_lead_elsewhere_are_refused(index, robot, relative, status):
    write(robot.parent / "outside.dae")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert refused(index, relative) == status


@pytest.mark.parametrize("target", ["outside.dae", "secret.txt"])
def test_a_link_out_of_the_package_is_refused(index, robot, target):
    outside = write(robot.parent / target)
    (robot / "meshes" / "link.dae").symlink_to(outside)
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert refused(index, "meshes/link.dae") == 403
    assert "link" in index.locate("package://robot/meshes/link.dae", None, MESH_TYPES).problem


def test_a_linked_folder_that_leads_out_is_refused(index, robot):
    write(robot.parent / "other" / "a.dae")
    (robot / "more").symlink_to(robot.parent / "other")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert refused(index, "more/a.dae") == 403


def test_links_in_circles_are_no_files(index, robot):
    (robot / "meshes" / "loop.dae").symlink_to("loop.dae")
    index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert refused(index, "meshes/loop.dae") == 404


def test_links_of_symlink_install_lead_into_the_sources(tmp_path):
    source = package(tmp_path / "src" / "robot", "robot")
    mesh = write(source / "meshes" / "arm.dae")
    share = package(tmp_path / "install" / "robot" / "share" / "robot", "robot")
    (share / "meshes").mkdir()
    (share / "meshes" / "arm.dae").symlink_to(mesh)
    index = MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": share}))
    url = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url
    assert ask(index, url) == mesh


def test_links_into_a_package_of_another_name_are_refused(tmp_path):
    other = package(tmp_path / "src" / "other", "other")
    write(other / "meshes" / "arm.dae")
    share = package(tmp_path / "share" / "robot", "robot")
    (share / "meshes").symlink_to(other / "meshes")
    index = MeshIndex(PackageFinder(start=tmp_path / "nowhere", environment={}, extra={"robot": share}))
    assert index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES).url is None


def test_folders_go_with_their_description(index):
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


def test_a_pointer_of_git_lfs_is_named_as_such(index, robot):
    (robot / "meshes" / "arm.dae").write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 9\n")
    located = index.locate("package://robot/meshes/arm.dae", None, MESH_TYPES)
    assert located.url is None
    assert "Git LFS pointer" in (located.problem or "")
    assert "git lfs pull" in (located.problem or "")
