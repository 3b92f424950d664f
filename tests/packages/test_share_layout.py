"""Packages that are not built, and that install files to other folders."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError, SourceText
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.ros.substitutions import FindPackageShare
from linkwright.packages import PackageFinder, use_finder
from linkwright.packages.ament_functions import get_package_share_directory
from linkwright.packages.readers.cmake import read_cmake
from linkwright.packages.share_layout import find_share_of_sources, find_source
from linkwright.xacro import expand

MANIFEST = '<package format="3"><name>arm</name></package>'
ROBOT = '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/></robot>'
CMAKE = """
project(arm)
add_subdirectory(extra)
install(DIRECTORY description/urdf description/meshes DESTINATION share/${PROJECT_NAME})
foreach(folder launch config)
  install(DIRECTORY bringup/${folder} DESTINATION share/${PROJECT_NAME})
endforeach()
configure_file(limits.yaml.in limits.yaml)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml DESTINATION share/${PROJECT_NAME}/config)
ament_package()
"""
SETUP = """
import os
from glob import glob
from setuptools import setup
package_name = 'arm'
setup(name=package_name, data_files=[
    ('share/' + package_name, ['package.xml']),
    (os.path.join('share', package_name, 'config'), glob('cfg/*')),
    (os.path.join('share', package_name, 'urdf'), glob('description/**/*.xacro', recursive=True)),
])
"""


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "linkwright" / "shares"


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    def write_package(files: dict[str, str]) -> Path:
        folder = tmp_path / "src" / "arm"
        for name, text in {"package.xml": MANIFEST, **files}.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return folder

    return write_package


@pytest.fixture
def moved_package(write: Callable[..., Path]) -> Path:
    return write(
        {
            "CMakeLists.txt": CMAKE,
            "extra/CMakeLists.txt": "install(DIRECTORY rviz DESTINATION share/${PROJECT_NAME})\n",
            "extra/rviz/arm.rviz": "",
            "description/urdf/arm.xacro": ROBOT,
            "description/meshes/base.stl": "",
            "bringup/launch/show.launch.py": "",
            "bringup/config/arm.rviz": "",
            "limits.yaml.in": "robot: @PROJECT_NAME@\n",
            "README.md": "",
        }
    )


def make_finder(package: Path) -> PackageFinder:
    return PackageFinder(start=package.parents[1], environment={})


def list_files(folder: Path) -> set[str]:
    return {
        Path(subfolder, name).relative_to(folder).as_posix()
        for subfolder, _, names in os.walk(folder, followlinks=True)
        for name in names
    }


def test_layout_places_files_moved_by_cmake(moved_package: Path) -> None:
    share = make_finder(moved_package).share("arm")
    assert os.path.realpath(share / "urdf" / "arm.xacro") == str(moved_package / "description" / "urdf" / "arm.xacro")
    cmake = read_cmake(SourceText("CMakeLists.txt", CMAKE), moved_package)
    installed = {file.destination.removeprefix("share/arm/") for file in cmake.installed_files(moved_package)}
    assert installed == {
        *("urdf/arm.xacro", "meshes/base.stl", "launch/show.launch.py", "config/arm.rviz", "config/limits.yaml"),
        "rviz/arm.rviz",
    }
    assert installed <= list_files(share)
    assert (share / "config" / "limits.yaml").read_text() == "robot: arm\n"
    assert {"package.xml", "README.md", "description/urdf/arm.xacro"} <= list_files(share)


STAYING = """
project(arm)
install(DIRECTORY launch ./urdf meshes/ DESTINATION share/${PROJECT_NAME})
install(DIRECTORY config/ DESTINATION share/${PROJECT_NAME}/config)
install(FILES rviz/arm.rviz missing.txt DESTINATION share/${PROJECT_NAME}/rviz)
install(FILES rviz/arm.rviz DESTINATION share/${PROJECT_NAME}/rviz RENAME other.rviz)
install(DIRECTORY include/ DESTINATION include)
"""


def test_only_moved_folders_are_searched(write: Callable[..., Path], monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("launch/a.py", "urdf/a.xacro", "meshes/base.stl", "config/a.yaml", "rviz/arm.rviz", "include/arm.hpp")
    package = write({"CMakeLists.txt": STAYING, **dict.fromkeys(names, "")})
    read: list[str] = []
    below = Path.rglob

    def rglob(path: Path, pattern: str) -> Iterator[Path]:
        read.append(path.name)
        return below(path, pattern)

    monkeypatch.setattr(Path, "rglob", rglob)
    cmake = read_cmake(SourceText("CMakeLists.txt", STAYING), package)
    sources = {file.destination: file.source for file in cmake.moved_files(package, "share/arm")}
    assert sources == {"share/arm/base.stl": "meshes/base.stl", "share/arm/rviz/other.rviz": "rviz/arm.rviz"}
    assert read == ["meshes"]


def test_layout_places_files_moved_by_setup_py(write: Callable[..., Path]) -> None:
    package = write(
        {"setup.py": SETUP, "cfg/a.yaml": "a", "description/parts/hand.xacro": ROBOT, "config/kept.txt": ""}
    )
    share = make_finder(package).share("arm")
    assert (share / "config" / "a.yaml").read_text() == "a"
    assert (share / "urdf" / "hand.xacro").read_text() == ROBOT
    assert (share / "config" / "kept.txt").is_file(), "files that are not installed stay"


def find_by_address(finder: PackageFinder) -> str:
    return str(finder.resolve("package://arm/urdf/arm.xacro"))


def find_by_launch(finder: PackageFinder) -> str:
    with use_finder(finder):
        return FindPackageShare("arm").perform(LaunchContext()) + "/urdf/arm.xacro"


def find_by_ament(finder: PackageFinder) -> str:
    with use_finder(finder):
        return get_package_share_directory("arm") + "/urdf/arm.xacro"


@pytest.mark.parametrize("find", [find_by_address, find_by_launch, find_by_ament])
def test_lookups_return_same_file(moved_package: Path, find: Callable[[PackageFinder], str]) -> None:
    assert os.path.realpath(find(make_finder(moved_package))) == str(
        moved_package / "description" / "urdf" / "arm.xacro"
    )


def test_xacro_finds_moved_file_and_errors_name_source(moved_package: Path, tmp_path: Path) -> None:
    main = tmp_path / "main.xacro"
    main.write_text(ROBOT.replace('<link name="base"/>', '<xacro:include filename="$(find arm)/urdf/arm.xacro"/>'))
    assert "base" in str(expand(main, packages=make_finder(moved_package)))
    source = moved_package / "description" / "urdf" / "arm.xacro"
    source.write_text(ROBOT.replace("base", "${none}"))
    with pytest.raises(LinkwrightError) as caught:
        expand(main, packages=make_finder(moved_package))
    span = caught.value.diagnostics[0].span
    assert span is not None
    assert span.file == str(source)


def test_package_without_moved_files_is_its_own_share_folder(write: Callable[..., Path], cache: Path) -> None:
    cmake = "project(arm)\ninstall(DIRECTORY urdf launch/ DESTINATION share/arm)\n".replace("launch/", "launch")
    package = write({"CMakeLists.txt": cmake, "urdf/arm.xacro": ROBOT, "launch/a.launch.py": ""})
    assert make_finder(package).share("arm") == package
    assert not cache.exists()


def test_layout_is_updated_for_new_file_and_old_layout_removed(moved_package: Path, cache: Path) -> None:
    finder = make_finder(moved_package)
    before = finder.share("arm")
    assert make_finder(moved_package).share("arm") == before, "an existing layout is reused"
    (moved_package / "bringup" / "config" / "more.yaml").write_text("")
    month_ago = time.time() - 30 * 86400
    os.utime(before.parent, (month_ago, month_ago))
    finder.clear_cache()
    after = finder.share("arm")
    assert (after / "config" / "more.yaml").is_file()
    assert not before.exists()
    assert len(list(next(cache.iterdir()).iterdir())) == 1


def test_package_is_found_from_inside_layout(moved_package: Path) -> None:
    share = make_finder(moved_package).share("arm")
    assert PackageFinder(start=share / "launch", environment={}).share("arm") == share


def test_sources_are_used_if_symlinks_fail(moved_package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError("no links here")

    monkeypatch.setattr(Path, "symlink_to", refuse)
    assert make_finder(moved_package).share("arm") == moved_package


def test_source_of_other_path_is_that_path(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(tmp_path)
    assert find_source(str(link)) == str(link)


OUTSIDE = {
    "CMakeLists.txt": """
project(arm)
install(FILES {outside} ../other/secret.stl DESTINATION share/arm/meshes)
install(FILES cfg/a.yaml DESTINATION share/arm/config)
ament_package()
""",
    "setup.py": """
from glob import glob
from setuptools import setup
setup(name='arm', data_files=[
    ('share/arm/config', ['cfg/a.yaml']),
    ('share/arm/meshes', ['{outside}', '../other/secret.stl'] + glob('../other/*')),
])
""",
}


@pytest.mark.parametrize("build_file", OUTSIDE)
def test_files_outside_package_are_not_included(write: Callable[..., Path], build_file: str, tmp_path: Path) -> None:
    (tmp_path / "src" / "other").mkdir(parents=True)
    secret = tmp_path / "src" / "other" / "secret.stl"
    secret.write_text("")
    folder = write({build_file: OUTSIDE[build_file].replace("{outside}", secret.as_posix()), "cfg/a.yaml": ""})
    share = find_share_of_sources("arm", folder)
    assert (share / "config" / "a.yaml").is_file()
    assert not (share / "meshes").exists()


def test_files_moved_by_setup_py_loop_are_found(write: Callable[..., Path]) -> None:
    text = (
        "import os\nfrom setuptools import setup\ndata = []\nfor root, _, files in os.walk('description'):\n"
        "    to = 'share/arm/' + root[len('description/'):]\n"
        "    data.append((to, [os.path.join(root, f) for f in files]))\nsetup(name='arm', data_files=data)\n"
    )
    folder = write({"setup.py": text, "description/urdf/arm.xacro": ROBOT})
    assert (find_share_of_sources("arm", folder) / "urdf" / "arm.xacro").read_text() == ROBOT


def test_environment_hooks_create_no_layout(write: Callable[..., Path]) -> None:
    folder = write({"CMakeLists.txt": "project(arm)\nament_environment_hooks(a.dsv.in)\n", "a.dsv.in": ""})
    assert find_share_of_sources("arm", folder) == folder
