"""Parameters in launch files whose values are names that other programs use, in a review."""

from __future__ import annotations

import pytest

FILE = """<launch>
  <arg name="robot" default="arm"/>
  <node pkg="arm" type="driver" name="driver">
    <param name="{name}" value="state"/>
    <rosparam>
      gains:
      limit: ''
    </rosparam>
  </node>
</launch>
"""


@pytest.mark.parametrize(
    ("name", "new", "is_breaking"),
    [
        ("output_topic", "status", True),
        ("topic_pub", "status", True),
        ("pub_scan_topic", "status", True),
        ("output_topic", "/state", False),
        ("input_topic", "status", False),
        ("map_topic", "status", False),
        ("output_topic", "$(arg robot)/state", True),
    ],
)
def test_topic_that_a_node_publishes_is_a_name_that_others_use(changes_of, name, new, is_breaking):
    changes, found = changes_of("arm.launch", FILE.format(name=name), 'value="state"', f'value="{new}"')
    assert changes == [f"node 'arm/driver': parameter {name} state -> {new}"]
    assert found == (changes if is_breaking else [])


def test_null_is_not_an_empty_text(changes_of):
    text = FILE.format(name="rate")
    assert changes_of("arm.launch", text, "gains:", "gains: 1")[0] == ["node 'arm/driver': parameter gains null -> 1"]


def test_empty_text_is_shown_as_one(changes_of):
    text = FILE.format(name="rate")
    assert changes_of("arm.launch", text, "limit: ''", "limit: 1")[0] == ["node 'arm/driver': parameter limit '' -> 1"]
