"""Functions of Python scripts that nothing calls."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

PATH = "arm/scripts/arm.py"
SCRIPT = """import rospy
from std_msgs.msg import String


def talk():
    talker = rospy.Publisher("talk", String, queue_size=1)
    rate = rospy.Rate(30)


START
pub = rospy.Publisher("state", String, queue_size=1)
rospy.spin()
"""


@pytest.mark.parametrize(
    ("start", "is_used"),
    [
        ("rospy.init_node('arm')", False),
        ("rospy.init_node('arm')\ntalk()", True),
        ("rospy.init_node('arm')\nrospy.Timer(rospy.Duration(1), talk)", True),
        ("rospy.init_node('arm')\nglobals()['talk']()", True),
        ("if __name__ == '__main__':\n    rospy.init_node('arm')", True),
    ],
)
def test_names_of_a_function_that_nothing_calls_are_not_told(repository, compare, start, is_used):
    text = SCRIPT.replace("START", start)
    if start.startswith("if"):
        text = text.replace("rospy.spin()\n", "")  # another source may import the function
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({PATH: text})
    (found,) = compare(repository).subjects
    lines = sentences(found)
    topics = "'talk' (String), 'state' (String)" if is_used else "'state' (String)"
    assert f"publishers added: {topics}" in lines
    assert any("Rate(30)" in line for line in lines) == is_used
