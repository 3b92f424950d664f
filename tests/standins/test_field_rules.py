"""Values that users' programs may assign to fields, as in their ROS 2 distribution."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from linkwright.messages.distribution import ASSUMED_DISTRIBUTION_VARIABLE
from linkwright.standins import process

PYTHON = os.environ.get("LINKWRIGHT_ROS_PYTHON", "")
PROGRAM = Path(__file__).with_name("field_values_program.py")
BASE = {"PATH": os.environ["PATH"], "LINKWRIGHT_DDS": "0"}


def run_assignments(python=sys.executable, command=(PROGRAM,), **variables):
    """Return the result of each assignment.

    It is an AssertionError's text, another error's name, or type and values.
    """
    environment = {**BASE, **variables} if python == PYTHON else process.create_environment({**BASE, **variables})
    result = subprocess.run(
        [python, *command], env=environment, check=False, capture_output=True, text=True, timeout=120
    )
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def is_refused(outcome):
    return isinstance(outcome, str)


class TestHumble:
    def test_numpy_arrays_are_rejected_for_sequences(self):
        humble = run_assignments(ROS_DISTRO="humble")
        assert humble["Image.data set of numpy"] == (
            "The 'data' field must be a set or sequence and each value of type 'int' "
            "and each unsigned integer in [0, 255]"
        )
        assert is_refused(humble["JointState.position set of numpy"])
        assert is_refused(humble["UnboundedSequences.bool_values set of numpy"])

    def test_supported_sequence_types_are_accepted(self):
        humble = run_assignments(ROS_DISTRO="humble")
        assert humble["Image.data set of bytes"] == humble["Image.data set of list"] == ["array", list(range(12))]
        assert humble["JointState.position set of list of numpy's"] == ["array", [0.5, 1.5]]
        assert humble["CameraInfo.k set of numpy"] == ["ndarray", list(range(9))]

    def test_constructors_convert_values(self):
        humble = run_assignments(ROS_DISTRO="humble")
        assert humble["Image.data made of numpy"] == ["array", list(range(12))]
        assert humble["Image.data made of numpy of rows"] == "TypeError"
        assert humble["JointState.position made of array of another type"] == ["array", [0.5]]
        assert humble["CameraInfo.k made of list of integers"] == ["ndarray", [1] * 9]
        assert humble["CameraInfo.k made of numpy of rows"] == "The 'k' numpy.ndarray() must have the shape (9,)"


@pytest.mark.parametrize(
    "variables", [{}, {"ROS_DISTRO": "humble", ASSUMED_DISTRIBUTION_VARIABLE: "1"}, {"ROS_DISTRO": "jazzy"}]
)
def test_numpy_arrays_are_accepted_unless_ros_distro_is_set_to_humble(variables):
    outcome = run_assignments(**variables)
    assert outcome["Image.data set of numpy of rows"] == ["array", list(range(12))]
    assert outcome["JointState.position made of array of another type"] == ["array", [0.5]]
    assert outcome["UnboundedSequences.bool_values set of numpy"] == ["list", [True, False]]


def test_own_commands_accept_numpy_arrays(tmp_path):
    """In the shell, the processes of commands import the stand-ins, as users' programs do."""
    program = tmp_path / "ours.py"
    imports = "import json, linkwright.cli, numpy, rclpy\nfrom sensor_msgs.msg import Image"
    program.write_text(
        f"{imports}\nimage = Image()\nimage.data = numpy.zeros(2, 'B')\nprint(json.dumps(len(image.data)))\n"
    )
    assert run_assignments(command=(program,), ROS_DISTRO="humble") == 2


@pytest.mark.skipif(not PYTHON, reason="LINKWRIGHT_ROS_PYTHON names no interpreter with rclpy")
def test_field_rules_match_real_message_classes():
    """Jazzy's classes check fields if an environment variable enables this.

    The setters are compared with Humble's.
    """
    real = run_assignments(python=PYTHON, ROS_PYTHON_CHECK_FIELDS="1")
    assert run_assignments(ROS_DISTRO="jazzy", ROS_PYTHON_CHECK_FIELDS="1") == real
    humble = run_assignments(ROS_DISTRO="humble")
    assert {case: outcome for case, outcome in humble.items() if " set of " in case} == {
        case: outcome for case, outcome in real.items() if " set of " in case
    }
