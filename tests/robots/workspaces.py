"""Colcon workspaces made for a test, and colcon run in them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

COLCON = Path(sys.executable).with_name("colcon")


def colcon_build(workspace: Path, package: str, *options: str) -> None:
    """Build a package of a workspace; if the build fails, the test fails with colcon's output."""
    environment = dict(os.environ)
    for name in ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH", "PYTHONPATH"):
        environment.pop(name, None)
    # Logs stay in the workspace, and colcon sends no desktop notifications.
    environment |= {
        "COLCON_HOME": str(workspace / ".colcon"),
        "COLCON_EXTENSION_BLOCKLIST": "colcon_core.event_handler",
    }
    environment["COLCON_EXTENSION_BLOCKLIST"] += ".desktop_notification"
    result = subprocess.run(
        [COLCON, "build", "--packages-select", package, *options],
        cwd=workspace,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr


def read_sourced_variable(workspace: Path, variable: str) -> str:
    """Return the value of an environment variable after ``source install/setup.bash``."""
    script = f'source install/setup.bash && printf %s "${variable}"'
    environment = {"PATH": os.environ["PATH"], "HOME": str(workspace)}
    result = subprocess.run(
        ["bash", "-c", script], cwd=workspace, env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout
