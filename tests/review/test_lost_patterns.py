"""Removed topics, services and actions whose names a source computes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
NODE = """import actionlib
import rospy
from arm_msgs.msg import HomeAction
from std_srvs.srv import Empty


def start(name, home):
{}"""
HOME = "rospy.Service('{}/home'.format(name), Empty, home)"
STOP = "rospy.Service('{}/stop'.format(name), Empty, home)"
REMOVED = "services with computed names removed: '\"{}/home\".format(name)' (Empty)"


def find_breaking(repository, compare, old: list[str], new: list[str], client: str = ""):
    sources = (NODE.format("".join(f"    {line}\n" for line in lines)) for lines in (old, new))
    files = {"arm/examples/demo.py": f"import rospy\n{client}\n"} if client else {}
    repository.commit({**MANIFEST, **files, "arm/src/arm.py": next(sources)})
    repository.write({"arm/src/arm.py": next(sources)})
    return compare(repository)


@pytest.mark.parametrize(
    ("client", "reason"),
    [
        ("", "programs that use the service do not find it"),
        ("rospy.ServiceProxy('/left/home', Empty)", "'demo.py' still calls '/left/home'"),
        ("rospy.ServiceProxy('/left/stop', Empty)", "programs that use the service do not find it"),
        ("rospy.ServiceProxy('/left/home', Trigger)", "programs that use the service do not find it"),
    ],
)
def test_removed_service_with_a_computed_name_is_breaking(repository, compare, client, reason):
    action = "actionlib.SimpleActionServer('{}/home'.format(name), HomeAction, home)"
    result = find_breaking(repository, compare, [HOME, STOP], [action, STOP], client)
    assert breaking(result) == [REMOVED]
    assert [str(change.reason) for _, change in result.breaking_changes] == [reason]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ([HOME, STOP], ["for item in ('home', 'stop'):", "    rospy.Service(f'{name}/{item}', Empty, home)"]),
        ([HOME, HOME], [HOME]),
        ([HOME.replace("Service(", "ServiceProxy(")], ["pass"]),
        ([HOME, STOP], ["rospy.Service('/arm/home', Empty, home)", STOP]),
    ],
)
def test_computed_name_that_another_name_may_replace_is_not_lost(repository, compare, old, new):
    assert [text for text in breaking(find_breaking(repository, compare, old, new)) if "removed" in text] == []
