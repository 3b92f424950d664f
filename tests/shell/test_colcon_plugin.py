"""``colcon build`` of ``ament_cmake`` packages without ament."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform == "win32", reason="the test uses bash")]

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>0.0.1</version><description>Test.</description>
  <maintainer email="ada@example.org">Ada</maintainer><license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


def write_package(workspace: Path, name: str, cmake: str) -> Path:
    folder = workspace / "src" / name
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(MANIFEST.format(name=name))
    (folder / "CMakeLists.txt").write_text(f"project({name})\nfind_package(ament_cmake REQUIRED)\n{cmake}\n")
    return folder


def run_in_shell(workspace: Path, text: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "linkwright", "shell", "--", "bash", "-c", text],
        cwd=workspace,
        env={"PATH": "/usr/bin:/bin", "HOME": str(workspace), "LC_ALL": "C.UTF-8", **variables},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_descriptions_scripts_and_interfaces_are_built(tmp_path: Path) -> None:
    arm = write_package(
        tmp_path,
        "arm",
        "install(DIRECTORY urdf DESTINATION share/arm)\ninstall(PROGRAMS hello.py DESTINATION lib/arm)\n"
        "ament_python_install_package(arm)",
    )
    (arm / "urdf").mkdir()
    (arm / "urdf" / "arm.urdf").write_text('<robot name="arm"><link name="base"/></robot>')
    (arm / "hello.py").write_text("#!/usr/bin/env python3\nimport arm\nprint('hello', arm.VALUE)\n")
    (arm / "hello.py").chmod(0o755)
    (arm / "arm").mkdir()
    (arm / "arm" / "__init__.py").write_text("VALUE = 7\n")
    speeds = write_package(tmp_path, "speeds", 'rosidl_generate_interfaces(${PROJECT_NAME} "msg/Speed.msg")')
    (speeds / "msg").mkdir()
    (speeds / "msg" / "Speed.msg").write_text("float64 value\n")

    built = run_in_shell(tmp_path, "colcon build")
    assert built.returncode == 0, built.stdout + built.stderr
    assert "2 packages finished" in built.stdout
    output = run_in_shell(
        tmp_path,
        "source install/setup.bash && cd / && ros2 pkg prefix arm && ros2 interface show speeds/msg/Speed "
        "&& python3 -c 'import arm; print(arm.VALUE)' && ros2 run arm hello.py",
    )
    assert output.stdout.splitlines() == [str(tmp_path / "install" / "arm"), "float64 value", "7", "hello 7"], (
        output.stderr
    )
    assert (tmp_path / "install/arm/share/arm/urdf/arm.urdf").is_file()


def test_symlink_install_creates_links(tmp_path: Path) -> None:
    arm = write_package(tmp_path, "arm", "install(DIRECTORY urdf DESTINATION share/arm)")
    (arm / "urdf").mkdir()
    (arm / "urdf" / "arm.urdf").write_text("<robot/>")
    assert run_in_shell(tmp_path, "colcon build --symlink-install").returncode == 0
    assert (tmp_path / "install/arm/share/arm/urdf/arm.urdf").is_symlink()


def test_compiled_targets_are_reported_and_other_files_installed(tmp_path: Path) -> None:
    arm = write_package(
        tmp_path,
        "arm",
        "add_executable(move src/move.cpp)\ninstall(TARGETS move DESTINATION lib/arm)\n"
        "add_subdirectory(description)\n"
        "configure_file(limits.yaml.in limits.yaml @ONLY)\n"
        "install(FILES ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml DESTINATION share/${PROJECT_NAME}/config)",
    )
    (arm / "limits.yaml.in").write_text("arm: '@PROJECT_NAME@'\n")
    (arm / "description" / "urdf").mkdir(parents=True)
    (arm / "description" / "urdf" / "arm.urdf").write_text("<robot/>")
    (arm / "description" / "CMakeLists.txt").write_text("install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})\n")
    result = run_in_shell(tmp_path, "colcon build")
    assert result.returncode == 0, result.stderr
    assert "'arm' is not built in full without ROS 2: 'move' would have to be compiled" in result.stderr
    share = tmp_path / "install/arm/share/arm"
    assert (share / "urdf" / "arm.urdf").read_text() == "<robot/>"
    assert (share / "config" / "limits.yaml").read_text() == "arm: 'arm'\n"


def test_environment_hooks_and_python_package_files_are_installed(tmp_path: Path) -> None:
    arm = write_package(
        tmp_path,
        "arm",
        'ament_environment_hooks("hooks/${PROJECT_NAME}.dsv.in")\nament_python_install_package(arm)\n'
        "ament_python_install_module(tools/extra.py)",
    )
    for name, text in {
        "hooks/arm.dsv.in": "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/models\n",
        "arm/__init__.py": "",
        "arm/data/table.csv": "1,2\n",
        "tools/extra.py": "VALUE = 3\n",
    }.items():
        (arm / name).parent.mkdir(parents=True, exist_ok=True)
        (arm / name).write_text(text)
    built = run_in_shell(tmp_path, "colcon build")
    assert built.returncode == 0, built.stderr
    output = run_in_shell(
        tmp_path,
        "source install/setup.bash && cd / && echo $GZ_SIM_RESOURCE_PATH && python3 -c 'import arm, extra, pathlib; "
        'print(extra.VALUE, pathlib.Path(arm.__file__).with_name("data").joinpath("table.csv").read_text().strip())\'',
    )
    assert output.stdout.splitlines() == [str(tmp_path / "install/arm/share/arm/models"), "3 1,2"], output.stderr


def test_missing_install_folder_fails_build(tmp_path: Path) -> None:
    write_package(tmp_path, "arm", "install(DIRECTORY meshes DESTINATION share/arm)")
    result = run_in_shell(tmp_path, "colcon build")
    assert result.returncode == 1
    assert "'arm' installs 'meshes', which does not exist" in result.stderr
    assert "Traceback" not in result.stderr


def test_installed_ament_cmake_is_used_by_colcon(tmp_path: Path) -> None:
    write_package(tmp_path, "arm", "")
    real = tmp_path / "opt"
    (real / "share" / "ament_cmake").mkdir(parents=True)
    listed = run_in_shell(tmp_path, "colcon list", AMENT_PREFIX_PATH=str(real))
    assert "(ros.ament_cmake)" in listed.stdout
    assert "(ros.ament_cmake_copied)" in run_in_shell(tmp_path, "colcon list").stdout
