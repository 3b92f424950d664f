"""LW844 of scripts that launch files of packages built by CMake start."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine_package
from linkwright.lint.settings import Settings
from tests.lint.manifest import MANIFEST

CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(p)\ninstall(DIRECTORY launch DESTINATION share/p)\n"
XML = '<launch><group><node pkg="{package}" {key}="{program}" name="n"/></group></launch>\n'
PYTHON = "from launch_ros.actions import Node\n\n\ndef generate_launch_description():\n    Node({})\n"
DRIVER = PYTHON.format("package='p', executable='driver.py'")


@pytest.mark.parametrize(
    ("launch", "text", "more", "codes"),
    [
        ("p.launch", XML.format(package="p", key="type", program="driver.py"), {}, ["LW844"]),
        ("p.launch.xml", XML.format(package="p", key="exec", program="driver.py"), {}, ["LW844"]),
        ("p.launch.py", DRIVER, {}, ["LW844"]),
        ("p.launch.py", DRIVER, {"nodes/driver.py": ""}, []),
        ("p.launch.py", DRIVER, {"nodes/driver": ""}, []),
        ("p.launch.py", DRIVER, {"nodes/driver.py.in": ""}, []),
        ("p.launch.py", DRIVER, {"CMakeLists.txt": CMAKE + "install(PROGRAMS ../q/driver.py DESTINATION lib/p)\n"}, []),
        ("p.launch.py", DRIVER, {"CMakeLists.txt": CMAKE + "configure_file(a b)\n"}, []),
        ("p.launch.py", DRIVER, {"CMakeLists.txt": CMAKE + "# configure_file(a b)\n"}, ["LW844"]),
        ("p.launch.py", DRIVER, {".gitmodules": '[submodule "x"]\n\tpath = nodes\n'}, []),
        ("p.launch.py", DRIVER, {".gitmodules": '[submodule "x"]\n\tpath = ../other\n'}, ["LW844"]),
        ("p.launch", XML.format(package="q", key="type", program="driver.py"), {}, []),
        ("p.launch", XML.format(package="p", key="type", program="driver"), {}, []),
        ("p.launch", XML.format(package="p", key="type", program="$(arg name).py"), {}, []),
        ("p.launch", f"<!-- {XML.format(package='p', key='type', program='driver.py')} --><launch/>", {}, []),
        ("p.launch", "<launch><node>", {}, []),
    ],
)
def test_a_script_that_the_package_does_not_have(tmp_path, launch, text, more, codes):
    files = {"package.xml": MANIFEST.format(more=""), "CMakeLists.txt": CMAKE, f"launch/{launch}": text, **more}
    for name, content in files.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content)
    findings = examine_package(tmp_path, Settings(select=("LW844",))).diagnostics
    assert [finding.code for finding in findings] == codes


def test_a_package_with_a_linked_folder_may_have_the_script(tmp_path):
    package = tmp_path / "p"
    for folder in (package / "launch", tmp_path / "nodes"):
        folder.mkdir(parents=True)
    (package / "nodes").symlink_to(tmp_path / "nodes")
    (package / "package.xml").write_text(MANIFEST.format(more=""))
    (package / "CMakeLists.txt").write_text(CMAKE)
    (package / "launch/p.launch.py").write_text(DRIVER)
    assert examine_package(package, Settings(select=("LW844",))).diagnostics == ()


def test_the_hint_names_a_similar_script(tmp_path):
    for name, content in {
        "package.xml": MANIFEST.format(more=""),
        "CMakeLists.txt": CMAKE,
        "p.launch.py": DRIVER,
        "drivers.py": "",
    }.items():
        (tmp_path / name).write_text(content)
    (finding,) = examine_package(tmp_path, Settings(select=("LW844",))).diagnostics
    assert str(finding.message) == "the package 'p' has no executable 'driver.py'"
    assert str(finding.hint) == "did you mean 'drivers.py'?"
