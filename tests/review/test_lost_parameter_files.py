"""Nodes of launch files that no longer get a parameter file with their parameters, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

LAUNCH = """<launch>
  <arg name="params" default=""/>
  <node pkg="{package}" exec="sensors" name="sensors">{content}</node>
</launch>
"""
LOADED = '<param from="$(find-pkg-share arm)/config/{}.yaml"/>'
SECTION = "{}:\n  ros__parameters:\n    rate: 10\n    noise: 0.1\n"
PATH = "arm/launch/arm.launch.xml"
REASON = "the node starts without the parameters in 'sim.yaml'"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/config/sim.yaml": SECTION.format("/sensors"),
    "arm/config/other.yaml": SECTION.format("other"),
    "arm/config/all.yaml": SECTION.format("/**"),
    "arm/src/sensors.cpp": 'int main() { node->declare_parameter("rate", 1); }\n',
}


@pytest.mark.parametrize(
    ("content", "files", "reason"),
    [
        ("", {}, REASON),
        (LOADED.format("other"), {}, REASON),
        ('<param from="$(var params)"/>', {}, REASON),
        (LOADED.format("all"), {}, None),
        ('<param name="rate" value="10"/>', {}, None),
        ('<param from="$(var params)"/>', {"arm/config/more.yaml": SECTION.format("sensors")}, None),
        ("", {"arm/config/sim.yaml": SECTION.format("other")}, None),
        ("", {"arm/src/sensors.cpp": "int main() {}\n"}, None),
    ],
)
def test_a_node_that_loses_its_parameter_file(repository, compare, content, files, reason):
    text = LAUNCH.format(package="arm", content=LOADED.format("sim"))
    repository.commit({**FILES, **files, PATH: text})
    repository.write({PATH: LAUNCH.format(package="arm", content=content)})
    changes = subject(compare(repository), PATH).changes
    reasons = [str(change.reason) for change in changes if ": parameters" in str(change.sentence) and change.reason]
    assert reasons == ([] if reason is None else [reason])


ROS1 = """<launch>
  {outer}
  <node pkg="sensors" type="sensors" name="sensors">{content}</node>
</launch>
"""
ROSPARAM = '<rosparam command="load" file="$(find arm)/config/{}.yaml"/>'


@pytest.mark.parametrize(
    ("outer", "content", "reason"),
    [
        ("", "", REASON),
        ("", ROSPARAM.format("fast"), None),
        (ROSPARAM.format("sim").replace("/>", ' ns="sensors"/>'), "", None),
    ],
)
def test_a_node_of_ros_1_that_loses_its_parameter_file(repository, compare, outer, content, reason):
    files = {"arm/config/sim.yaml": "rate: 10\n", "arm/config/fast.yaml": "rate: 20\n"}
    path = "arm/launch/arm.launch"
    text = ROS1.format(outer="", content=ROSPARAM.format("sim"))
    repository.commit({"arm/package.xml": FILES["arm/package.xml"], **files, path: text})
    repository.write({path: ROS1.format(outer=outer, content=content)})
    changes = subject(compare(repository), path).changes
    reasons = [str(change.reason) for change in changes if ": parameters" in str(change.sentence) and change.reason]
    assert reasons == ([] if reason is None else [reason])


@pytest.mark.parametrize("section", ["planner2:\n", "TrajectoryPlanner:\n  a: 1\n  b: 2\n  c: 3\n  d: 4\n  e: 5\n"])
@pytest.mark.parametrize("is_loaded", [True, False])
def test_a_renamed_file_with_other_names_is_not_lost(repository, compare, is_loaded, section):
    path, old, new = "arm/launch/arm.launch", "arm/config/planner.yaml", "arm/config/planners.yaml"
    values = "".join(f"  gain_{letter}: {number}\n" for number, letter in enumerate("abcdefgh"))
    files = {"arm/package.xml": FILES["arm/package.xml"], old: f"Planner:\n{values}"}
    repository.commit({**files, path: ROS1.format(outer="", content=ROSPARAM.format("planner"))})
    repository.git("mv", old, new)
    content = ROSPARAM.format("planners") if is_loaded else ""
    repository.write({new: f"{section}{values}", path: ROS1.format(outer="", content=content)})
    reasons = [str(change.reason) for change in subject(compare(repository), path).changes if change.reason]
    assert reasons == ([] if is_loaded else ["the node starts without the parameters in 'planner.yaml'"])
