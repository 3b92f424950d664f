"""The robot package in real colcon: it is built, and its installed files are complete."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from tests.places import GAZEBO_PACKAGE, PACKAGE
from tests.robots.workspaces import colcon_build, read_sourced_variable

pytestmark = pytest.mark.slow

INSTALLED_FOLDERS = ("launch", "meshes", "rviz", "urdf")


@pytest.fixture(scope="module", params=["copied", "symlinked"])
def workspace(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a workspace with a copy of the package, built with or without symbolic links."""
    workspace = tmp_path_factory.mktemp("ros2_ws")
    source = workspace / "src" / PACKAGE.name
    shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    # A file and a folder that setup.py does not name.
    (source / "urdf" / "sensor" / "imu").mkdir()
    (source / "urdf" / "sensor" / "imu" / "imu_gazebo.xacro").write_text("<robot/>\n", encoding="utf-8")
    colcon_build(workspace, PACKAGE.name, *(["--symlink-install"] if request.param == "symlinked" else []))
    return workspace


def share_folder(workspace: Path) -> Path:
    return workspace / "install" / PACKAGE.name / "share" / PACKAGE.name


@pytest.mark.parametrize("folder", INSTALLED_FOLDERS)
def test_package_files_are_installed(workspace: Path, folder: str) -> None:
    source = workspace / "src" / PACKAGE.name / folder
    written = sorted(path.relative_to(source) for path in source.rglob("*") if path.is_file())
    installed = share_folder(workspace) / folder
    assert written
    assert sorted(path.relative_to(installed) for path in installed.rglob("*") if path.is_file()) == written
    assert all((installed / path).read_bytes() == (source / path).read_bytes() for path in written)


def test_all_package_folders_are_tested() -> None:
    folders = {path.name for path in PACKAGE.iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert folders == {*INSTALLED_FOLDERS, "resource", PACKAGE.name}


def test_manifest_and_index_marker_are_installed(workspace: Path) -> None:
    assert (share_folder(workspace) / "package.xml").read_bytes() == (PACKAGE / "package.xml").read_bytes()
    index = share_folder(workspace).parent / "ament_index" / "resource_index" / "packages"
    assert (index / PACKAGE.name).is_file()


def test_sourced_workspace_provides_package(workspace: Path) -> None:
    prefix = read_sourced_variable(workspace, "AMENT_PREFIX_PATH")
    assert prefix == str(workspace / "install" / PACKAGE.name)
    finder = PackageFinder(start=Path("/no/such/folder"), environment={"AMENT_PREFIX_PATH": prefix})
    assert finder.share(PACKAGE.name).resolve() == share_folder(workspace).resolve()


def test_gazebo_package_is_installed_completely(tmp_path: Path) -> None:
    source = tmp_path / "src" / GAZEBO_PACKAGE.name
    shutil.copytree(GAZEBO_PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    colcon_build(tmp_path, GAZEBO_PACKAGE.name)
    installed = tmp_path / "install" / GAZEBO_PACKAGE.name / "share" / GAZEBO_PACKAGE.name
    for folder in ("config", "launch", "models", "rviz", "worlds"):
        written = {path.relative_to(source) for path in (source / folder).rglob("*") if path.is_file()}
        assert written == {path.relative_to(installed) for path in (installed / folder).rglob("*") if path.is_file()}
        assert all((installed / path).read_bytes() == (source / path).read_bytes() for path in written)
    assert (installed / "package.xml").is_file()
