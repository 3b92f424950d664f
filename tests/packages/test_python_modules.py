"""The Python modules of the packages in a workspace."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.packages.programs.python_modules import find_module

NAMES = ("a_robot", "b_robot", "c_robot")


@pytest.mark.parametrize("asking", NAMES)
def test_launch_file_gets_module_of_its_own_package(tmp_path: Path, asking: str) -> None:
    for name in NAMES:
        (tmp_path / name / "scripts").mkdir(parents=True)
        (tmp_path / name / "scripts" / "__init__.py").touch()
        (tmp_path / name / "CMakeLists.txt").write_text("ament_python_install_package(scripts)")
        (tmp_path / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (tmp_path / asking / "launch").mkdir()
    module = find_module(PackageFinder(start=tmp_path, environment={}), "scripts", tmp_path / asking / "launch")
    assert module is not None
    assert module.origin == str(tmp_path / asking / "scripts" / "__init__.py")


def test_python_package_may_have_a_folder_with_another_name(tmp_path: Path) -> None:
    (tmp_path / "arm" / "launch" / "utils").mkdir(parents=True)
    (tmp_path / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    build_file = "project(arm)\nament_python_install_package(${PROJECT_NAME} PACKAGE_DIR launch)\n"
    (tmp_path / "arm" / "CMakeLists.txt").write_text(build_file)
    (tmp_path / "arm" / "launch" / "__init__.py").touch()
    spec = find_module(PackageFinder(start=tmp_path, environment={}), "arm", tmp_path)
    assert spec is not None
    assert spec.origin == str(tmp_path / "arm" / "launch" / "__init__.py")
    assert spec.submodule_search_locations == [str(tmp_path / "arm" / "launch")]
