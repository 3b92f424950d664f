"""The lines of a review about added nodes of launch files whose packages are missing, or that replace an include."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

MANIFEST = "<package format='3'><name>lamp</name><version>1.0.0</version>{}</package>\n"
FILE = """<launch>
  <arg name="camera" default="true"/>
  <arg name="debug" default="false"/>
  <node pkg="lamp" exec="lamp" if="$(var camera)" unless="$(var debug)"/>
</launch>
"""
NODE = '<node pkg="eye" exec="eye_node"{}/>'
INCLUDE = '<include file="$(find-pkg-share eye)/launch/eye.launch.xml"/>'
NO_START = "package.xml does not name '{}', without which the node does not start"


@pytest.mark.parametrize(
    ("added", "depend", "reason"),
    [
        (NODE.format(""), "", NO_START.format("eye")),
        (NODE.format(' if="$(var camera)"'), "", NO_START.format("eye")),
        (NODE.format(' if="$(var debug)"'), "", None),
        (NODE.format(""), "eye", None),
        (INCLUDE, "", "package.xml does not name 'eye', without which the launch file fails"),
        ('<executable cmd="ros2 run eye relay /image"/>', "", NO_START.format("eye")),
        ('<executable cmd="ros2 run eye relay /image"/>', "eye", None),
        ('<executable cmd="ros2 topic echo /image"/>', "", None),
        ('<node pkg="rviz2" exec="rviz2"/>', "", None),
        ('<node pkg="robot_state_publisher" exec="robot_state_publisher"/>', "", None),
    ],
)
def test_an_added_node_of_an_undeclared_package_is_breaking(repository, compare, added, depend, reason):
    dependency = f"<exec_depend>{depend}</exec_depend>" if depend else ""
    path = "lamp/launch/lamp.launch.xml"
    repository.commit({"lamp/package.xml": MANIFEST.format(dependency), path: FILE})
    repository.write({path: FILE.replace("</launch>", f"{added}</launch>")})
    (change,) = subject(compare(repository), path).changes
    assert (None if change.reason is None else str(change.reason)) == reason


REMAPPED = """<node pkg="eye" exec="eye_node"{}>
  <remap from="/eye/image" to="/lamp/image"/>
  <remap from="/eye/info" to="/eye/info"/>
  <remap from="depth" to="/lamp/depth"/>
</node>
"""
REASON = "if the included file published or served '/eye/image', programs that use the names do not find them"


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (INCLUDE, REMAPPED.format(""), REASON),
        (INCLUDE, REMAPPED.format(' if="$(var camera)"'), None),
        (INCLUDE, NODE.format(""), None),
        (INCLUDE.replace(" eye)", " ear)"), REMAPPED.format(""), None),
    ],
)
def test_remappings_of_a_node_that_replaces_an_include(repository, compare, old, new, reason):
    path = "lamp/launch/lamp.launch.xml"
    text = FILE.replace("</launch>", f"{old}</launch>")
    repository.commit({"lamp/package.xml": MANIFEST.format("<depend>eye</depend>"), path: text})
    repository.write({path: text.replace(old, new)})
    changes = subject(compare(repository), path).changes
    (added,) = [change for change in changes if str(change.sentence).startswith("node 'eye/eye_node' added")]
    assert (None if added.reason is None else str(added.reason)) == reason


@pytest.mark.parametrize(
    ("started", "depend", "is_breaking"),
    [
        ("nav2_planner", "", False),
        ("nav2_planner", "nav2_planner", True),
        ("eye", "", True),
    ],
)
def test_node_of_packages_that_are_installed_together_starts_as_the_others(
    repository, compare, started, depend, is_breaking
):
    dependency = f"<exec_depend>{depend}</exec_depend>" if depend else ""
    path = "lamp/launch/lamp.launch.xml"
    text = FILE.replace("</launch>", f'<node pkg="{started}" exec="server"/>\n</launch>')
    repository.commit({"lamp/package.xml": MANIFEST.format(dependency), path: text})
    repository.write({path: text.replace("</launch>", '<node pkg="nav2_smoother" exec="server"/>\n</launch>')})
    (change,) = subject(compare(repository), path).changes
    assert (change.reason is not None) == is_breaking


def test_missing_package_is_told_once(repository, compare):
    path, values = "lamp/launch/lamp.launch.xml", "lamp/config/lamp.yaml"
    parameters = "lamp:\n  ros__parameters:\n    rate: 5\n"
    repository.commit({"lamp/package.xml": MANIFEST.format(""), path: FILE, values: parameters})
    loaded = f"{parameters}    seeing:\n      plugin: eye_plugins::Seeing\n"
    repository.write({path: FILE.replace("</launch>", '<node pkg="eye_plugins" exec="e"/></launch>'), values: loaded})
    result = compare(repository)
    assert [item.path for item, _ in result.breaking_changes] == [path]
    assert any(str(change.sentence).startswith("lamp.ros__") for change in subject(result, values).changes)
    assert result.new_findings == []


def test_a_repeated_node_does_not_move_to_a_file_that_newly_starts_one(repository, compare):
    node = '<node pkg="eye" exec="eye_node" output="screen"/>'
    files = "lamp/launch/lamp.launch.xml", "lamp/launch/eye.launch.xml"
    both, one, none = (f"<launch>{node * count}</launch>\n" for count in (2, 1, 0))
    repository.commit({"lamp/package.xml": MANIFEST.format("<depend>eye</depend>"), files[0]: both, files[1]: none})
    repository.write({files[0]: one, files[1]: one})
    result = compare(repository)
    removed = "node 'eye/eye_node' removed: output screen; the file still has an equal one"
    assert [sentences(subject(result, file)) for file in files] == [
        [removed],
        ["node 'eye/eye_node' added: output screen"],
    ]
    assert not breaking(result)
