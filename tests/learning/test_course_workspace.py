"""The workspace of a learner at the end of the course.

It is an ordinary workspace, which colcon builds and tests.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.learning.course import find_course, load_course
from tests.domains import own_domain
from tests.learning.finished import finish_lessons

pytestmark = [pytest.mark.slow, pytest.mark.extra("colcon")]

INSTALLED = (
    "my_control/lib/my_control/wander",
    "my_mission/lib/my_mission/go_to_ball",
    "my_mission/share/my_mission/config/mission.yaml",
    "my_robot_bringup/share/my_robot_bringup/launch/robot.launch.py",
    "my_robot_bringup/share/my_robot_bringup/urdf/mbot_hardware.xacro",
    "my_robot_description/share/my_robot_description/urdf/mbot_sim.xacro",
    "my_senses/lib/my_senses/color_finder",
    "my_worlds/share/my_worlds/worlds/yard.world",
)


def run_colcon(workspace: Path, *words: str) -> str:
    """Run colcon in the environment of ``linkwright shell``, and return its output."""
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", "shell", "--", "colcon", *words],
        cwd=workspace,
        env={**os.environ, "COLCON_HOME": str(workspace / ".colcon"), "ROS_DOMAIN_ID": str(own_domain())},
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_colcon_builds_and_tests_all_packages_of_course(tmp_path: Path) -> None:
    finish_lessons(load_course(find_course("robot")).lessons, tmp_path)
    run_colcon(tmp_path, "build")
    missing = [name for name in INSTALLED if not (tmp_path / "install" / name).is_file()]
    assert not missing
    run_colcon(tmp_path, "test", "--packages-select", "my_mission")
    summary = run_colcon(tmp_path, "test-result")
    assert "9 tests, 0 errors, 0 failures" in summary
