"""Remappings that keep a name which the other files of a repository have replaced, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

LAUNCH = (
    '<launch>\n  <node pkg="arm" type="base" name="base">\n    <remap from="odom" to="{}"/>\n  </node>\n</launch>\n'
)
FILES = {
    "arm/config/filter.yaml": "odom0: {}\nrate: 10\n",
    "arm/config/planner.yaml": "planner:\n  odom_topic: {}\n",
    "arm/nodes/finder.py": "import rospy\nrospy.Subscriber('{}', Odometry, print)\n",
}
PATH = "arm/launch/world.launch"
OLD, NEW = "wheel_odom", "odom"
LEFT = f"still remaps to '{OLD}', which 3 other files call '{NEW}' now"


def list_left(repository, compare, files: dict[str, str], left: str = OLD, changed: int = 3) -> list[str]:
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    texts = {path: text.format(OLD) for path, text in FILES.items()}
    repository.commit({**manifest, **texts, **files, PATH: LAUNCH.format(left)})
    repository.write({path: FILES[path].format(NEW) for path in list(FILES)[:changed]})
    return [sentence for sentence in breaking(compare(repository)) if "remaps" in sentence]


def test_the_last_remapping_to_a_name_that_all_other_files_replace_is_breaking(repository, compare):
    comment = {"arm/config/other.yaml": f"# {OLD} is the old name\nrate: 1\n"}
    assert list_left(repository, compare, comment) == [LEFT]


@pytest.mark.parametrize(
    ("files", "left", "changed"),
    [
        ({}, OLD, 2),  # few files replace the name
        ({"arm/a.py": f"a = '{OLD}'\n", "arm/b.py": f"b = '{OLD}'\n"}, OLD, 3),  # other files keep it
        ({}, "other_odom", 3),
    ],
)
def test_a_name_that_is_in_use_elsewhere_is_no_leftover(repository, compare, files, left, changed):
    assert list_left(repository, compare, files, left, changed) == []
