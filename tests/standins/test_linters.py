"""The linter tests that `linkwright pkg create` writes.

Plain pytest runs them, and can import Linkwright's rclpy, too.
"""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from linkwright.cli import main

VALID_FILE = '''\
# Copyright 2026 Ada
# SPDX-License-Identifier: MIT

"""A node."""

import rclpy


def start():
    """Start it."""
    rclpy.init()
'''


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return the package that ``pkg create`` writes."""
    words = ["pkg", "create", "my_nodes", "--build-type", "ament_python", "--license", "MIT", "--node-name", "first"]
    assert main([*words, "--destination-directory", str(tmp_path)]) == 0
    return tmp_path / "my_nodes"


def run_pytest(package: Path, *words: str, **variables: str) -> tuple[int, str]:
    """Return the status and output of ``python -m pytest``.

    The settings of Linkwright's shell are removed.
    """
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "LINKWRIGHT_SITE")}
    result = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", "-p", "no:asyncio", *words],
        cwd=package,
        env={**environment, "COLUMNS": "200", **variables},
        capture_output=True,
        encoding="utf-8",
        timeout=240,
        check=False,
    )
    return result.returncode, result.stdout + result.stderr


def hide_modules(folder: Path, *names: str) -> str:
    """Return a folder for PYTHONPATH that hides modules of these names."""
    folder.mkdir()
    code = f"import sys\nsys.modules.update(dict.fromkeys({names!r}))\n"
    (folder / "sitecustomize.py").write_text(code)
    return str(folder)


def test_new_package_passes_its_linter_tests(package: Path) -> None:
    status, output = run_pytest(package)
    assert status == 0, output
    assert "2 passed, 1 skipped" in output
    assert "no copyright header yet" in output


def test_rclpy_and_messages_are_importable_in_plain_pytest(package: Path) -> None:
    (package / "test" / "test_node.py").write_text(
        textwrap.dedent("""\
        import rclpy
        from geometry_msgs.msg import Twist
        from launch import LaunchDescription


        def test_node():
            rclpy.init()
            node = rclpy.create_node('here')
            assert node.get_name() == 'here'
            assert Twist().linear.x == 0.0
            assert LaunchDescription().entities == []
        """)
    )
    status, output = run_pytest(package, "test/test_node.py")
    assert status == 0, output


def test_style_errors_fail_flake8_test(package: Path) -> None:
    (package / "my_nodes" / "first.py").write_text(f"{VALID_FILE}    x = {'1 + ' * 40}1\n")
    status, output = run_pytest(package, "test/test_flake8.py")
    assert status == 1
    assert "2 findings about code style" in output
    assert "first.py:12:100: E501 line too long" in output
    assert "first.py:12:5: F841" in output


def test_docstring_without_period_fails_pep257_test(package: Path) -> None:
    (package / "my_nodes" / "first.py").write_text(VALID_FILE.replace("Start it.", "Start it"))
    status, output = run_pytest(package, "test/test_pep257.py")
    assert status == 1
    assert "D400" in output


def test_missing_copyright_headers_fail_without_skip(package: Path) -> None:
    (package / "my_nodes" / "first.py").write_text(VALID_FILE)
    test = package / "test" / "test_copyright.py"
    test.write_text("\n".join(line for line in test.read_text().splitlines() if "skip" not in line) + "\n")
    for path in package.rglob("test_*.py"):
        path.write_text("# Copyright 2026 Ada. Licensed under the MIT License.\n" + path.read_text())
    assert run_pytest(package, "test/test_copyright.py")[0] == 0
    (package / "my_nodes" / "second.py").write_text("x = 1\n")
    (package / "my_nodes" / "third.py").write_text("# Copyright 2026 Ada\nx = 1\n")
    status, output = run_pytest(package, "test/test_copyright.py")
    assert status == 1
    assert "second.py: could not find copyright notice" in output
    assert "third.py: could not find a license that is known" in output


@pytest.mark.parametrize("name", ["generated/AMENT_IGNORE", "_generated/x", ".generated/x"])
def test_folders_ignored_by_ament_are_ignored(package: Path, name: str) -> None:
    (package / name).parent.mkdir()
    (package / name).touch()
    (package / name).with_name("bad.py").write_text("import os\n")
    status, output = run_pytest(package, "test/test_flake8.py")
    assert status == 0, output


def test_missing_linter_skips_its_test_with_install_hint(package: Path, tmp_path: Path) -> None:
    hidden = hide_modules(tmp_path / "hidden", "flake8", "pydocstyle")
    status, output = run_pytest(package, PYTHONPATH=hidden)
    assert status == 0, output
    assert "3 skipped" in output
    assert "flake8 is not installed beside pytest" in output
    assert "pydocstyle is not installed beside pytest" in output
