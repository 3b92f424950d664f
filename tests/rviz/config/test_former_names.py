"""Classes and keys of RViz 1, read and written."""

from __future__ import annotations

import pytest
import yaml

from linkwright.rviz.config import yaml_tree
from linkwright.rviz.config.former_names import get_former_keys, to_modern_class
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.schema import PropertySpec, topic_spec


@pytest.mark.parametrize(
    ("written", "modern"),
    [
        ("rviz/Grid", "rviz_default_plugins/Grid"),
        ("rviz/Group", "rviz_common/Group"),
        ("rviz/WrenchStamped", "rviz_default_plugins/Wrench"),
        ("rviz/SetInitialPose", "rviz_default_plugins/SetInitialPose"),
        ("rviz_default_plugins/Grid", "rviz_default_plugins/Grid"),
        ("rviz_common/Group", "rviz_common/Group"),
        ("rviz_imu_plugin/Imu", "rviz_imu_plugin/Imu"),
        ("Group", "Group"),
    ],
)
def test_rviz_1_classes_have_modern_names(written, modern):
    assert to_modern_class(written) == modern


def make_store(cls: str, text: str, *specs: PropertySpec) -> tuple[PropertyStore, yaml_tree.Section]:
    section = yaml_tree.parse(text, "x")
    return PropertyStore("d", section, lambda: specs, lambda _: None, former=get_former_keys(cls)), section


def test_rviz_1_topic_reads_qos_from_sibling_keys():
    properties, section = make_store("rviz/LaserScan", "Queue Size: 7\nTopic: /scan\nUnreliable: true\n", topic_spec())
    assert properties.text("Topic") == "/scan"
    assert properties.number("Topic", "Depth") == 7
    assert properties.text("Topic", "Reliability Policy") == "Best Effort"
    properties.set(("Topic",), "/other")
    properties.set(("Topic", "Depth"), 9)
    properties.set(("Topic", "Reliability Policy"), "Reliable")
    assert yaml.safe_load(yaml_tree.write(section)) == {"Queue Size": 9, "Topic": "/other", "Unreliable": False}


def test_properties_unknown_to_rviz_1_are_written_in_modern_form():
    properties, section = make_store("rviz/LaserScan", "Topic: /scan\n", topic_spec())
    properties.set(("Topic", "Durability Policy"), "Transient Local")
    assert yaml.safe_load(yaml_tree.write(section)) == {
        "Topic": {"Value": "/scan", "Durability Policy": "Transient Local"}
    }
    assert properties.text("Topic") == "/scan"


@pytest.mark.parametrize(
    ("cls", "text", "spec", "value"),
    [
        ("rviz/RobotModel", "Robot Description: my_robot\n", topic_spec("Description Topic"), "my_robot"),
        ("rviz/Marker", "Marker Topic: /m\n", topic_spec(), "/m"),
        ("rviz/Image", "Image Topic: /camera\n", topic_spec(), "/camera"),
        (
            "rviz/InteractiveMarkers",
            "Update Topic: /menu/update\n",
            PropertySpec("Interactive Markers Namespace", "string", ""),
            "/menu",
        ),
    ],
)
def test_rviz_1_keys_are_read_and_written(cls, text, spec, value):
    properties, section = make_store(cls, text, spec)
    assert properties.text(spec.name) == value
    key = text.partition(":")[0]
    before = section.scalar(key).text
    properties.set((spec.name,), "/new")
    assert section.keys() == [key]
    properties.set((spec.name,), value)
    assert section.scalar(key).text == before


def test_rviz_1_keys_are_ignored_in_modern_file():
    properties, _ = make_store("rviz_default_plugins/LaserScan", "Queue Size: 7\nTopic: /scan\n", topic_spec())
    assert properties.number("Topic", "Depth") == 5


def test_standard_deviations_are_converted_to_covariances():
    spec = PropertySpec("Covariance x", "float", 0.25)
    properties, section = make_store("rviz/SetInitialPose", "X std deviation: 0.3\n", spec)
    assert properties.number("Covariance x") == pytest.approx(0.09)
    properties.set(("Covariance x",), 0.16)
    assert float(section.scalar("X std deviation").text) == pytest.approx(0.4)


def test_undo_restores_rviz_1_keys():
    text = "Queue Size: 7\nTopic: /scan\n"
    properties, section = make_store("rviz/LaserScan", text, topic_spec())
    for path, value, keys in (
        (("Topic", "Depth"), 9, ["Queue Size"]),
        (("Topic",), "/b", ["Topic"]),
        (("Topic", "Durability Policy"), "Transient Local", ["Topic"]),
        (("Topic", "Durability Policy"), "Volatile", []),
    ):
        properties.rows()
        with properties.recording() as saved_entries:
            properties.set(path, value)
        assert [saved_entry.key for saved_entry in saved_entries] == keys
        assert properties.restore(saved_entries) == ([path] if keys else [])
        assert yaml_tree.write(section) == text
