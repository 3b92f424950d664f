"""The lines of a review about manifests of rosbuild.

The tests also cover dependencies that others have through a package.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = """<package>
  <description brief="arm">An arm.</description>
  <author>Ann</author>
  <license>BSD</license>
  <depend package="roscpp"/>
  <depend package="tf"/>
  <rosdep name="eigen"/>
  <export>
    <nodelet plugin="${prefix}/nodelets.xml"/>
    <cpp cflags="-I${prefix}/include"/>
  </export>
</package>
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ('  <depend package="tf"/>\n', "", ["depend removed: tf"], False),
        ("<author>", '<depend package="tf2"/>\n<author>', ["depend added: tf2"], False),
        ("eigen", "eigen3", ["rosdep added: eigen3", "rosdep removed: eigen"], False),
        ('    <nodelet plugin="${prefix}/nodelets.xml"/>\n', "",
         ["export removed: nodelet plugin=${prefix}/nodelets.xml"], True),
        ("BSD", "MIT", ["license: BSD -> MIT"], False),
        ("An arm.", "Two arms.", ["description changed"], False),
    ],
)  # fmt: skip
def test_changes_of_a_manifest_of_rosbuild_are_reported(repository, compare, old, new, expected, is_breaking):
    assert MANIFEST.count(old) == 1
    repository.commit({"arm/manifest.xml": MANIFEST})
    repository.write({"arm/manifest.xml": MANIFEST.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/manifest.xml")) == expected
    assert bool(breaking(result)) is is_breaking


def test_added_removed_and_replaced_manifests_of_rosbuild_are_reported(repository, compare):
    repository.commit({"README": "arm"})
    repository.commit({"arm/manifest.xml": MANIFEST, "stack.xml": "<stack><version>1.0</version></stack>"})
    added = compare(repository, "HEAD~1..HEAD")
    assert sentences(subject(added, "arm/manifest.xml")) == ["package of rosbuild added: depends on roscpp, tf, eigen"]
    assert sentences(subject(added, "stack.xml")) == ["stack added"]
    package = PACKAGE_XML.replace("arm_description", "arm").replace("xacro", "roscpp")
    repository.commit({"arm/manifest.xml": None, "stack.xml": None, "arm/package.xml": package})
    replaced = compare(repository, "HEAD~1..HEAD")
    assert sentences(subject(replaced, "arm/manifest.xml")) == ["replaced by package.xml", "depend removed: tf"]
    assert breaking(replaced) == []
    removed = compare(repository, "HEAD~1..HEAD~2")
    assert "package of rosbuild added" not in str(removed)


def test_removed_package_of_rosbuild_is_breaking(repository, compare):
    repository.commit({"arm/manifest.xml": MANIFEST})
    repository.commit({"arm/manifest.xml": None})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["package removed"]


def test_renamed_package_of_rosbuild_is_breaking(repository, compare):
    repository.commit({"arm/manifest.xml": MANIFEST})
    repository.commit({"arm/manifest.xml": None, "arms/manifest.xml": MANIFEST})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["package 'arm' renamed to 'arms'"]


@pytest.mark.parametrize(
    ("tag", "export", "is_breaking"),
    [
        ("depend", "", True),
        ("build_export_depend", "", True),
        ("exec_depend", "", False),
        ("exec_depend", "<export><metapackage/></export>", True),
        ("depend", "<export><build_type>ament_python</build_type></export>", False),
    ],
)
def test_removed_dependency_that_others_have_through_the_package_is_breaking(
    repository, compare, tag, export, is_breaking
):
    line = f"  <{tag}>gears</{tag}>\n"
    text = PACKAGE_XML.replace("</package>", f"{line}{export}</package>")
    repository.commit({"a/package.xml": text})
    repository.write({"a/package.xml": text.replace(line, "")})
    assert breaking(compare(repository)) == ([f"{tag} removed: gears"] if is_breaking else [])


def test_message_of_a_package_of_rosbuild_is_read_as_ros_1_does(repository, compare):
    repository.commit({"arm/manifest.xml": MANIFEST})
    repository.commit({"arm/msg/State.msg": "Header header\nduration delay\n"})
    found = subject(compare(repository, "HEAD~1..HEAD"), "arm/msg/State.msg")
    assert sentences(found) == ["interface added: std_msgs/Header header, duration delay"]


def test_parameter_files_of_a_rosbuild_package_are_compared(repository, compare):
    repository.commit({"arm/manifest.xml": MANIFEST, "arm/config/arm.yaml": "arm:\n  speed: 1.0\n"})
    repository.write({"arm/config/arm.yaml": "arm:\n  speed: 2.0\n"})
    assert sentences(subject(compare(repository), "arm/config/arm.yaml")) == ["arm.speed 1.0 -> 2.0"]
