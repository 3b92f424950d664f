"""The recipe of `docs/howto-real-robot.md`, with a robot whose node is real.

See `test_real_ros`.
"""

from __future__ import annotations

import os
import re
import shlex

import pytest

from tests.docs.pages import DOCS, read_blocks
from tests.domains import own_domain
from tests.wire.programs import linkwright

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
PAGE = DOCS / "howto-real-robot.md"
FIND_COMMAND = next(block.text for block in read_blocks(PAGE) if "linkwright topic list" in block.text)

pytestmark = pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")


@pytest.fixture
def start_robot(programs):
    """Start a robot with some variables of its environment.

    It listens and publishes when this returns.
    """
    return lambda **variables: programs("real_peer", "robot", python=PYTHON, **variables)


def run_recipe_command(name):
    """Run the command of step 3 that has this verb."""
    line = next(line for line in FIND_COMMAND.splitlines() if line.startswith(f"linkwright {name}"))
    return linkwright(*shlex.split(line)[1:])


def test_robot_is_found_with_documented_variables(start_robot, monkeypatch) -> None:
    for name, value in re.findall(r"^export (\w+)=(\w+)", FIND_COMMAND, re.MULTILINE):
        monkeypatch.setenv(name, str(own_domain()) if name == "ROS_DOMAIN_ID" else value)
    start_robot()
    assert "/from_ros" in run_recipe_command("topic list")[0].splitlines()
    output, errors, status = run_recipe_command("doctor")
    (shown,) = (line for block in read_blocks(PAGE) for line in block.text.splitlines() if ": 1 node, " in line)
    assert (status, output.partition("1 node, ")[0]) == (0, shown.partition("1 node, ")[0]), errors


@pytest.mark.parametrize(("transports", "found"), [("SHM", False), ("LARGE_DATA", False), ("DEFAULT", True)])
def test_fast_dds_transports_that_hide_robot(start_robot, transports, found) -> None:
    start_robot(FASTDDS_BUILTIN_TRANSPORTS=transports)
    assert ("/from_ros" in run_recipe_command("topic list")[0].splitlines()) is found


def test_doctor_reports_possibly_different_domain(start_robot) -> None:
    start_robot(ROS_DOMAIN_ID=str(own_domain(2)))
    assert "DOC801" in run_recipe_command("doctor")[1]
