"""The launch files of a package, for `linkwright launch` and for completion."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from linkwright.packages.launch_files import find_launch_files_below, is_launch_file_name
from linkwright.packages.share_layout import find_share_of_sources


def test_launch_file_names_match_ros2launch():
    assert all(map(is_launch_file_name, ("a.launch.py", "a_launch.xml", "launch.yaml", "bringuplaunch.yml")))
    assert not any(map(is_launch_file_name, ("a.py", "launch.txt", "launch.py.orig", "a.launch")))


def test_launch_files_are_found_below_share_folder(tmp_path: Path):
    for path in ("launch/b.launch.py", "launch/sub/a.launch.xml", "c.launch.yaml", "launch/d.py"):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).touch()
    paths = [path.relative_to(tmp_path).as_posix() for path in find_launch_files_below(tmp_path)]
    assert paths == ["c.launch.yaml", "launch/b.launch.py", "launch/sub/a.launch.xml"]


def test_build_hidden_and_deep_folders_are_skipped(tmp_path: Path):
    for folder in ("install/launch", ".git", "build", "log", "1/2/3/4/5"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "a.launch.py").touch()
    assert find_launch_files_below(tmp_path) == []
    assert find_launch_files_below(tmp_path / "nowhere") == []


@pytest.mark.skipif(sys.platform == "win32", reason="symbolic links need a privilege on Windows")
def test_launch_file_in_source_and_install_folder_is_listed_once(tmp_path: Path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    package = tmp_path / "arm"
    (package / "start").mkdir(parents=True)
    (package / "start" / "a.launch.py").touch()
    (package / "CMakeLists.txt").write_text("project(arm)\ninstall(DIRECTORY start/ DESTINATION share/arm/launch)\n")
    share = find_share_of_sources("arm", package)
    assert find_launch_files_below(share) == [share / "launch" / "a.launch.py"]
    assert (share / "start" / "a.launch.py").exists()
