"""Arguments that choose the files of the actions of a launch file, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import subject

FILE = """<launch>
  <arg name="description" default="arm_description"/>
  <arg name="viewer" default="{viewer}"/>
  <arg name="robot" default="arm"/>
  <node pkg="rviz2" exec="rviz2" args="-d $(find-pkg-share $(var description))/config/view.rviz"/>
  <node pkg="arm" exec="driver" args="$(var viewer) $(var description)">
    <param name="model" value="$(command 'xacro $(find-pkg-share arm)/urdf/arm.xacro a:=$(var robot)')"/>
  </node>
</launch>
"""
CALLER = """<launch>
  <include file="$(find-pkg-share arm)/launch/arm.launch.xml"><arg name="description" value="x"/></include>
</launch>
"""
SENTENCE = "'description' no longer chooses the file '$(find-pkg-share $(var viewer))/config/view.rviz'"


@pytest.fixture
def review_reasons(repository, compare):
    """Review a replacement in a launch file, and return its changes with their reasons."""

    def run(text: str, old: str, new: str, other: str = "<launch/>"):
        assert old in text
        repository.commit({"arm/launch/arm.launch.xml": text, "arm/launch/other.launch.xml": other})
        repository.write({"arm/launch/arm.launch.xml": text.replace(old, new)})
        changes = subject(compare(repository), "arm/launch/arm.launch.xml").changes
        return {str(each.sentence): None if each.reason is None else str(each.reason) for each in changes}

    return run


@pytest.mark.parametrize(
    ("viewer", "caller", "is_breaking"),
    [("arm_description", "<launch/>", False), ("viewer", "<launch/>", True), ("arm_description", CALLER, True)],
)
def test_path_that_another_argument_begins(review_reasons, viewer, caller, is_breaking):
    text = FILE.format(viewer=viewer)
    found = review_reasons(text, "$(var description))", "$(var viewer))", caller)
    reason = "the value that a caller passes for 'description' chooses another file"
    (sentence,) = [sentence for sentence in found if sentence.startswith(SENTENCE)]
    assert found[sentence] == (reason if is_breaking else None)


@pytest.mark.parametrize(
    ("path", "end"),
    [
        ("$(var robot)", "the same as before"),
        ("$(var viewer)", "'$(find-pkg-share arm)/urdf/v.xacro'"),
    ],
)
def test_fixed_path_that_depends_on_an_argument_now(review_reasons, path, end):
    name = path.removeprefix("$(var ").removesuffix(")")
    found = review_reasons(FILE.format(viewer="v"), "/arm.xacro", f"/{path}.xacro")
    text = f"the file '$(find-pkg-share arm)/urdf/{path}.xacro' depends on '{name}' now; by default, it is {end}"
    assert found[text] is None


def test_path_with_other_arguments_has_the_files_that_it_chooses_by_default(review_reasons):
    text = """<launch>
  <arg name="team" default="1"/>
  <include file="$(find-pkg-share gazebo)/empty.launch.xml">
    <arg name="world" value="worlds/team$(var team).world"/>
  </include>
</launch>
"""
    found = review_reasons(text, "worlds/team$(var team)", "worlds/$(var team)")
    assert found["by default, the file is 'worlds/1.world' instead of 'worlds/team1.world'"] is None


def test_lost_argument_of_a_path_has_the_files_that_are_chosen_by_default(review_reasons):
    text = FILE.format(viewer="viewer")
    found = review_reasons(text, "$(var description))", "$(var viewer))")
    folders = [f"'$(find-pkg-share {name})/config/view.rviz'" for name in ("viewer", "arm_description")]
    assert f"{SENTENCE}; by default, it is {folders[0]} instead of {folders[1]}" in found


def test_value_that_takes_the_place_of_a_parameter_file_is_no_other_file(review_reasons):
    text = """<launch>
  <arg name="params" default="$(find-pkg-share arm)/config/arm.yaml"/>
  <node pkg="nav2_map_server" exec="map_server"><param from="$(var params)"/></node>
</launch>
"""
    inline = '<param name="yaml_filename" value="$(find-pkg-share arm)/maps/arm.yaml"/>'
    found = review_reasons(text, '<param from="$(var params)"/>', inline)
    assert not [sentence for sentence in found if "no longer chooses" in sentence]


def test_a_fixed_file_that_an_added_argument_chooses_is_told_with_the_setting(review_reasons):
    text = FILE.format(viewer="arm_description")
    path = "-d $(find-pkg-share $(var description))/config/view.rviz"
    fixed = text.replace(path, "-d /config/view.rviz")
    old, new = fixed[: fixed.index("</launch>")], fixed.replace("-d /config/view.rviz", "-d $(var view)")
    argument = '  <arg name="view" default="/config/view.rviz"/>\n'
    assert list(review_reasons(fixed, old, f"{new[: new.index('</launch>')]}{argument}")) == [
        "node 'rviz2/rviz2': arguments -d /config/view.rviz -> -d $(var view) (the same by default)",
        "argument 'view' added: default /config/view.rviz",
    ]


RENAMED = """<launch>
  <arg name="robot" default="custom"/>
  <param name="robot_description"
    command="$(find xacro)/xacro.py --inorder '$(find arm_description)/robots/arm_$(arg robot).urdf.xacro'"/>
</launch>
"""


def test_renamed_argument_that_no_longer_chooses_a_file_is_only_renamed(review_changes):
    new = RENAMED.replace("_$(arg robot)", "").replace("xacro'\"", "xacro' laser:=$(arg laser)\"")
    new = new.replace('"robot" default="custom"', '"laser" default="front"')
    changes, breaking = review_changes("arm.launch", RENAMED, RENAMED, new)
    assert breaking == ["argument 'robot' renamed to 'laser'"]
    assert not [change for change in changes if "chooses" in change]
