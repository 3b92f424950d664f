"""Topics and services of changed sources that unchanged sources use, too.

The sources are in the same package.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

TALKER = """#include <ros/ros.h>
void talk(ros::NodeHandle& nh) {
  auto p = nh.advertise<std_msgs::Float64>("chatter", 1);
  auto c = nh.serviceClient<std_srvs::Trigger>("home");
}
"""
LISTENER = """#include <ros/ros.h>
void listen(ros::NodeHandle& nh) {
  auto s = nh.subscribe("chatter", 1, f);
  auto h = nh.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>("home", g);
}
"""
CMAKE = """project(arm)
add_executable(talker src/talker.cpp)
add_executable(listener src/listener.cpp)
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": CMAKE,
    "arm/src/talker.cpp": TALKER,
    "arm/src/listener.cpp": LISTENER,
}
RENAMED = "publisher 'chatter' (Float64) renamed to 'talk' (Float64)"


def breaking_reasons(result):
    return [str(change.reason) for _, change in result.breaking_changes]


@pytest.mark.parametrize(
    ("path", "old", "new", "sentence", "reason"),
    [
        ("talker.cpp", '"chatter"', '"speech"', RENAMED.replace("talk", "speech"),
         "'listener.cpp' still subscribes to 'chatter'; nothing in the repository subscribes to 'speech'"),
        ("listener.cpp", '"chatter"', '"speech"', "subscription 'chatter' renamed to 'speech'",
         "'talker.cpp' still publishes 'chatter'; nothing in the repository publishes 'speech'"),
        ("listener.cpp", '"home"', '"go_home"', "service 'home' (Trigger) renamed to 'go_home' (Trigger)",
         "'talker.cpp' still calls 'home'; nothing in the repository calls 'go_home'"),
        ("talker.cpp", '"home"', '"go_home"',
         "service client 'home' (Trigger) renamed to 'go_home' (Trigger)",
         "'listener.cpp' still serves 'home'; nothing in the repository serves 'go_home'"),
    ],
)  # fmt: skip
def test_a_renamed_name_is_breaking_if_the_other_end_keeps_it(repository, compare, path, old, new, sentence, reason):
    repository.commit(FILES)
    repository.write({f"arm/src/{path}": FILES[f"arm/src/{path}"].replace(old, new)})
    result = compare(repository)
    assert breaking(result) == [sentence]
    assert breaking_reasons(result) == [reason]


def test_a_topic_that_another_source_newly_reads_has_another_publisher(repository, compare):
    """The listener read another topic before, so a program of another package publishes the topic now."""
    other = LISTENER.replace("chatter", "unfiltered")
    repository.commit({**FILES, "arm/src/listener.cpp": other})
    silent = TALKER.replace('  auto p = nh.advertise<std_msgs::Float64>("chatter", 1);\n', "")
    repository.write({"arm/src/talker.cpp": silent, "arm/src/listener.cpp": LISTENER})
    result = compare(repository)
    (line,) = sentences(subject(result, "arm/src/talker.cpp"))
    assert line == "publishers removed: 'chatter' (Float64); 'listener.cpp' newly subscribes to it"
    assert line not in breaking(result)


def test_a_removed_topic_that_a_source_still_reads_is_breaking(repository, compare):
    repository.commit(FILES)
    silent = TALKER.replace('  auto p = nh.advertise<std_msgs::Float64>("chatter", 1);\n', "")
    repository.write({"arm/src/talker.cpp": silent})
    assert breaking_reasons(compare(repository)) == ["'listener.cpp' still subscribes to 'chatter'"]


def test_a_topic_that_another_node_publishes_is_not_lost(repository, compare):
    files = {**FILES, "arm/src/other.cpp": TALKER, "arm/CMakeLists.txt": f"{CMAKE}add_executable(o src/other.cpp)\n"}
    repository.commit(files)
    repository.write({"arm/src/talker.cpp": TALKER.replace("chatter", "talk")})
    result = compare(repository)
    assert sentences(subject(result, "arm/src/talker.cpp")) == [RENAMED]
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("build_file", "text", "source", "copy"),
    [
        ("CMakeLists.txt", CMAKE.replace("listener", "talker2"), "src/talker.cpp", "src/backups/talker.cpp"),
        ("setup.py", "from setuptools import setup\nsetup(name='arm', packages=['arm'])\n", "arm/n.py", "old/n.py"),
    ],
)
def test_a_copy_that_is_not_built_keeps_no_name(repository, compare, build_file, text, source, copy):
    code = TALKER if source.endswith("cpp") else "self.create_publisher(Float64, 'chatter', 1)\n"
    manifest = {"arm/package.xml": FILES["arm/package.xml"], f"arm/{build_file}": text}
    repository.commit({**manifest, f"arm/{source}": code, f"arm/{copy}": code})
    repository.write({f"arm/{source}": code.replace("chatter", "talk")})
    assert breaking(compare(repository)) == [RENAMED]


def test_a_publisher_that_moves_to_a_changed_source_is_no_change(repository, compare):
    line = '  auto p = nh.advertise<std_msgs::Float64>("chatter", 1);\n'
    repository.commit(FILES)
    repository.write(
        {
            "arm/src/talker.cpp": TALKER.replace(line, ""),
            "arm/src/listener.cpp": LISTENER.replace("  auto s", f"{line}  auto s"),
        }
    )
    assert breaking(compare(repository)) == []


NODE = """#include <rclcpp_lifecycle/lifecycle_node.hpp>
Driver::Driver(const std::string& name) : rclcpp_lifecycle::LifecycleNode(name) {
  scan_ = create_publisher<LaserScan>("scan", 1);
  declare_parameter<int>("port", 0);
}
"""


def test_an_added_node_with_a_computed_name_has_its_topics_and_parameters_told(repository, compare):
    repository.commit({"arm/package.xml": FILES["arm/package.xml"], "arm/src/driver.cpp": NODE})
    repository.write({"arm/src/life_cycle_driver.cpp": NODE})
    found = sentences(subject(compare(repository), "arm/src/life_cycle_driver.cpp"))
    assert found == ["publishers added: 'scan' (LaserScan)", "parameters added: 'port' (0)"]
