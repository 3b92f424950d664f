"""The commands of the tutorial in the shell: create, build, source, launch, diagram."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import urllib.request
from pathlib import Path

import pytest

from tests.domains import own_domain

ROBOT = Path(__file__).resolve().parents[2] / "robots" / "my_robot_description"

PREPARE = """\
mkdir -p ros2_ws/src && cd ros2_ws/src
ros2 pkg create my_robot_description --build-type ament_python --dependencies urdf xacro --license MIT
cd my_robot_description && mkdir -p config doc launch rviz meshes urdf/sensor
"""

BUILD = """\
cd ros2_ws && colcon build --packages-select my_robot_description
source install/setup.bash && ros2 pkg prefix my_robot_description
"""

DIAGRAM = "cd ros2_ws/src/my_robot_description/urdf && urdf_to_graphviz mbot_base.urdf"

LAUNCH = "source ros2_ws/install/setup.bash && exec ros2 launch my_robot_description display.launch.py"

pytestmark = [pytest.mark.slow, pytest.mark.skipif(shutil.which("bash") is None, reason="the tutorial uses bash")]


@pytest.fixture
def home(tmp_path: Path) -> Path:
    return tmp_path


def shell_words(text: str) -> list[str]:
    return [sys.executable, "-m", "linkwright", "shell", "--", "bash", "-c", text]


def shell_environment_of(home: Path) -> dict[str, str]:
    variables = {"PATH": "/usr/bin:/bin", "HOME": str(home), "USER": "learner", "LC_ALL": "C.UTF-8"}
    return {**variables, "ROS_DOMAIN_ID": str(own_domain())}


def type_lines(text: str, home: Path) -> str:
    """Return the standard output of the lines that a learner types."""
    result = subprocess.run(
        shell_words(text),
        cwd=home,
        env=shell_environment_of(home),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_tutorial_commands_work_as_written(home: Path) -> None:
    assert "going to create a new package" in type_lines(PREPARE, home)
    package = home / "ros2_ws" / "src" / "my_robot_description"
    for name in ("urdf", "launch", "rviz", "meshes"):
        shutil.copytree(ROBOT / name, package / name, dirs_exist_ok=True)
    shutil.copy(ROBOT / "setup.py", package)

    built = type_lines(BUILD, home)
    assert "Summary: 1 package finished" in built
    assert built.splitlines()[-1] == str(home / "ros2_ws" / "install" / "my_robot_description")

    output = launch_and_read(home)
    assert re.search(r"\[robot_state_publisher-\d\] \[INFO\] .*Robot initialized", output)
    assert "has finished cleanly" in output

    assert type_lines(DIAGRAM, home).splitlines() == ["Created file mbot.gv", "Created file mbot.pdf"]
    assert (package / "urdf" / "mbot.pdf").read_bytes().startswith(b"%PDF")


def launch_and_read(home: Path) -> str:
    """Return the output of a launch until its page was loaded and Ctrl-C ended it."""
    process = subprocess.Popen(
        shell_words(LAUNCH),
        cwd=home,
        env=shell_environment_of(home),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    watchdog = threading.Timer(60, lambda: os.killpg(process.pid, signal.SIGKILL))
    watchdog.start()
    with process:
        assert process.stdout is not None
        assert process.stderr is not None
        address = process.stdout.readline().split()[-1]
        watchdog.cancel()
        with urllib.request.urlopen(address, timeout=60) as page:
            assert page.status == 200
        text = ""
        for line in process.stderr:
            text += line
            if "Robot initialized" in line:
                os.killpg(process.pid, signal.SIGINT)
    return text
