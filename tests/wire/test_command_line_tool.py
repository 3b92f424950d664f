"""What the `cyclonedds` command shows of us: a view from outside that knows nothing of ROS."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.messages import JointState, type_hash

CONFIGURATIONS = pytest.importorskip("tests.wire.ros_peer", reason="there is no DDS here").CONFIGURATIONS
TOOL = Path(sys.executable).with_name("cyclonedds")

pytestmark = pytest.mark.skipif(not TOOL.exists(), reason="the tool is not installed")


@pytest.fixture
def tool(domain, monkeypatch):
    def run(*words: str) -> str:
        result = subprocess.run(
            [str(TOOL), *words, "--suppress-progress-bar", "-r", "1s"],
            capture_output=True,
            text=True,
            timeout=60,
            check=True,
            env={"CYCLONEDDS_URI": CONFIGURATIONS["localhost"], "COLUMNS": "200", "PATH": "/usr/bin", "HOME": "/tmp"},
        )
        return re.sub(r"\x1b\[[0-9;]*m", "", result.stdout)

    return run


def test_cyclonedds_ps_shows_participant(processes, tool, domain):
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 10)
    shown = tool("ps", "-i", str(domain))
    assert "linkwright/" in shown
    assert str(os.getpid()) in shown
    for topic in ("ros_discovery_info", "rt/joint_states", "rt/rosout", "rq/ours/get_parametersRequest"):
        assert topic in shown


def test_cyclonedds_ls_shows_endpoints_and_qos(processes, tool, domain):
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 7)
    shown = tool("ls", "-i", str(domain), "-q", "-t", "rt/joint_states")
    assert "sensor_msgs::msg::dds_::JointState_" in shown
    assert "History.KeepLast(depth=7)" in shown
    assert "Reliability.Reliable(max_blocking_time='100 milliseconds')" in shown
    assert f"typehash={type_hash(JointState)};" in shown
    assert "enclave=/;" in shown


def test_cyclonedds_typeof_shows_no_type_description(processes, tool, domain):
    """Descriptions of types are not sent: rmw_fastrtps_cpp and Humble's Cyclone DDS do not get on with ours."""
    process = processes("ours")
    process.node.create_publisher(JointState, "joint_states", 10)
    assert "struct" not in tool("typeof", "rt/joint_states", "-i", str(domain))
