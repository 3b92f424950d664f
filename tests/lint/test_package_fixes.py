"""Fixes of package.xml, setup.py and CMakeLists.txt.

The finding disappears, and the format remains.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.lint.apply import fix_file
from linkwright.lint.checking import Checker
from linkwright.lint.engine import examine

MANIFEST = """<package format="3">
  <name>arm</name>
  <version>0.1.0</version>
  <description>An arm.</description>
  <maintainer email="a@my-lab.org">A</maintainer>
  <license>Apache-2.0</license>
  <export><build_type>{build_type}</build_type></export>
</package>
"""
LAUNCH = """from launch import LaunchDescription
from ament_index_python.packages import get_package_share_path

def generate_launch_description():
    get_package_share_path('arm') / 'launch/a.yaml', get_package_share_path('arm') / 'meshes/a.stl'
    return LaunchDescription([])
"""


def apply_safe_fixes(
    folder: Path, build_file: str, text: str, *, selected: tuple[str, ...] = ("LW822", "LW826")
) -> str:
    """Return a build file after all safe fixes of the package.

    No finding may remain.
    """
    build_type = "ament_python" if build_file == "setup.py" else "ament_cmake"
    files = {
        "package.xml": MANIFEST.format(build_type=build_type),
        build_file: text,
        "launch/arm.launch.py": LAUNCH,
        "meshes/arm.stl": "solid",
        "resource/arm": "",
    }
    for name, content in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content.encode())
    checker = Checker(folders=[folder])

    def findings(_: str | None = None):
        return [finding for finding in checker.check_package(folder, None, None)[0] if finding.code in selected]

    assert findings()
    fix_file(folder / "package.xml", findings)
    assert not findings()
    return (folder / build_file).read_bytes().decode()


def test_new_data_files_entries_have_format_of_existing_ones(tmp_path):
    text = """from glob import glob
from setuptools import setup

package_name = 'arm'

setup(
    name=package_name,
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),  # for tools
    ],
)
"""
    expected = text.replace(
        "  # for tools\n",
        "  # for tools\n"
        "        ('share/' + package_name + '/launch', glob('launch/*')),\n"
        "        ('share/' + package_name + '/meshes', glob('meshes/*')),\n",
    )
    assert sorted(apply_safe_fixes(tmp_path, "setup.py", text).splitlines()) == sorted(expected.splitlines())


def test_empty_data_files_and_missing_import_are_filled(tmp_path):
    text = 'from setuptools import setup\n\nsetup(name="arm", data_files=[])\n'
    changed = apply_safe_fixes(tmp_path, "setup.py", text)
    assert changed.startswith("from glob import glob\nfrom setuptools import setup\n\n")
    for part in ('("share/arm", ["package.xml"])', '("share/arm/meshes", glob("meshes/*"))', '["resource/arm"]'):
        assert part in changed


def test_folder_with_subfolders_is_installed_by_extension(tmp_path):
    (tmp_path / "meshes" / "more").mkdir(parents=True)
    (tmp_path / "meshes" / "more" / "b.dae").write_text("<COLLADA/>")
    text = "from glob import glob\nfrom setuptools import setup\nsetup(name='arm', data_files=[])\n"
    changed = apply_safe_fixes(tmp_path, "setup.py", text)
    assert "('share/arm/meshes', glob('meshes/*.stl'))" in changed
    assert "('share/arm/meshes/more', glob('meshes/more/*'))" in changed


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_folder_is_added_to_existing_install_command(tmp_path, newline):
    text = newline.join(
        (
            "project(arm)",
            "find_package(ament_cmake REQUIRED)",
            "install(",
            "  DIRECTORY",
            '    "launch"',
            "  DESTINATION share/${PROJECT_NAME}",
            ")",
            "ament_package()",
            "",
        )
    )
    expected = text.replace('    "launch"' + newline, f'    "launch"{newline}    meshes{newline}')
    assert apply_safe_fixes(tmp_path, "CMakeLists.txt", text) == expected


def test_install_command_is_added_before_ament_package(tmp_path):
    text = "project(arm)\nfind_package(ament_cmake REQUIRED)\ninstall(FILES launch/arm.launch.py DESTINATION share)\n"
    changed = apply_safe_fixes(tmp_path, "CMakeLists.txt", text + "\nament_package()\n")
    assert changed == text + "\ninstall(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\n\nament_package()\n"


def test_first_dependency_is_added_after_license(tmp_path):
    for name in ("arm", "wheels"):
        (tmp_path / name).mkdir()
        manifest = MANIFEST.format(build_type="ament_cmake").replace("<name>arm", f"<name>{name}")
        (tmp_path / name / "package.xml").write_text(manifest)
    (tmp_path / "wheels" / "w.xacro").write_text('<robot xmlns:xacro="http://www.ros.org/wiki/xacro"/>')
    main = tmp_path / "arm" / "arm.urdf.xacro"
    main.write_text(
        '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '  <xacro:include filename="$(find wheels)/w.xacro"/>\n  <link name="a"/>\n</robot>\n'
    )
    fix_file(main, lambda _: [finding for finding in examine(main).diagnostics if finding.code == "LW724"])
    changed = (tmp_path / "arm" / "package.xml").read_text()
    assert "  <license>Apache-2.0</license>\n  <exec_depend>wheels</exec_depend>\n" in changed
