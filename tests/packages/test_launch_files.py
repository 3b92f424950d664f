"""Which files of a package are launch files; what `linkwright launch` finds is what TAB completes."""

from __future__ import annotations

from pathlib import Path

from linkwright.packages.launch_files import is_launch_file_name, launch_files_below


def test_names_are_those_that_ros2launch_takes_for_launch_files():
    assert all(map(is_launch_file_name, ("a.launch.py", "a_launch.xml", "launch.yaml", "bringuplaunch.yml")))
    assert not any(map(is_launch_file_name, ("a.py", "launch.txt", "launch.py.orig", "a.launch")))


def test_they_are_looked_for_below_the_share_folder(tmp_path: Path):
    for path in ("launch/b.launch.py", "launch/sub/a.launch.xml", "c.launch.yaml", "launch/d.py"):
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).touch()
    found = [path.relative_to(tmp_path).as_posix() for path in launch_files_below(tmp_path)]
    assert found == ["c.launch.yaml", "launch/b.launch.py", "launch/sub/a.launch.xml"]


def test_folders_that_are_built_hidden_or_too_deep_are_left_out(tmp_path: Path):
    for folder in ("install/launch", ".git", "build", "log", "1/2/3/4/5"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "a.launch.py").touch()
    assert list(launch_files_below(tmp_path)) == []
    assert list(launch_files_below(tmp_path / "nowhere")) == []
