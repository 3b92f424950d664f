"""The output of the `cyclonedds` command about Linkwright's participants.

It is an outside view without any knowledge of ROS.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.messages import JointState, type_hash

CONFIGURATIONS = pytest.importorskip("tests.wire.ros_peer", reason="cyclonedds is not installed").CONFIGURATIONS
TOOL = Path(sys.executable).with_name("cyclonedds")

pytestmark = pytest.mark.skipif(not TOOL.exists(), reason="the tool is not installed")


@pytest.fixture
def run_tool(domain, monkeypatch):
    def run(*arguments: str) -> str:
        result = subprocess.run(
            [str(TOOL), *arguments, "--suppress-progress-bar", "-r", "1s"],
            capture_output=True,
            text=True,
            timeout=60,
            check=True,
            env={"CYCLONEDDS_URI": CONFIGURATIONS["localhost"], "COLUMNS": "200", "PATH": "/usr/bin", "HOME": "/tmp"},
        )
        return re.sub(r"\x1b\[[0-9;]*m", "", result.stdout)

    return run


def test_cyclonedds_ps_shows_participant(processes, run_tool, domain):
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 10)
    output = run_tool("ps", "-i", str(domain))
    assert "linkwright/" in output
    assert str(os.getpid()) in output
    for topic in ("ros_discovery_info", "rt/joint_states", "rt/rosout", "rq/ours/get_parametersRequest"):
        assert topic in output


def test_cyclonedds_ls_shows_endpoints_and_qos(processes, run_tool, domain):
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 7)
    output = run_tool("ls", "-i", str(domain), "-q", "-t", "rt/joint_states")
    assert "sensor_msgs::msg::dds_::JointState_" in output
    assert "History.KeepLast(depth=7)" in output
    assert "Reliability.Reliable(max_blocking_time='100 milliseconds')" in output
    assert f"typehash={type_hash(JointState)};" in output
    assert "enclave=/;" in output


def test_cyclonedds_typeof_shows_no_type_description(processes, run_tool, domain):
    """Type descriptions are not sent.

    rmw_fastrtps_cpp and Humble's Cyclone DDS cannot process Linkwright's.
    """
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 10)
    assert "struct" not in run_tool("typeof", "rt/joint_states", "-i", str(domain))
