"""The lines of a review about the QoS of topics, by the rules for offered and requested QoS."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PUBLISHER = "void Arm::start() {{ p_ = create_publisher<std_msgs::msg::Bool>({name}, {qos}); }}\n"
SUBSCRIPTION = "void Arm::start() {{ s_ = create_subscription<std_msgs::msg::Bool>({name}, {qos}, f); }}\n"


def review_qos(repository, compare, call, old, new, name='"ready"'):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": call.format(name=name, qos=old)})
    repository.write({"arm/src/arm.cpp": call.format(name=name, qos=new)})
    result = compare(repository)
    return [sentence for subject in result.subjects for sentence in sentences(subject)], bool(breaking(result))


@pytest.mark.parametrize(
    ("call", "old", "new", "is_breaking"),
    [
        (PUBLISHER, "rclcpp::QoS(10)", "rclcpp::QoS(1).transient_local()", False),
        (PUBLISHER, "rclcpp::QoS(1).transient_local()", "rclcpp::QoS(1)", True),
        (PUBLISHER, "rclcpp::QoS(1).transient_local()", "arm::LatchedQoS()", False),
        (PUBLISHER, "arm::StateQoS()", "rclcpp::SensorDataQoS()", False),
        (PUBLISHER, "10", "rclcpp::SensorDataQoS()", True),
        (PUBLISHER, "rclcpp::QoS(1).deadline(100ms)", "rclcpp::QoS(1).deadline(1s)", True),
        (PUBLISHER, "rclcpp::QoS(1).deadline(100ms)", "rclcpp::QoS(1)", True),
        (PUBLISHER, "rclcpp::QoS(1).deadline(100ms)", "rclcpp::QoS(1).deadline(std::chrono::milliseconds(50))", False),
        (SUBSCRIPTION, "rclcpp::QoS(1).deadline(100ms)", "rclcpp::QoS(1).deadline(1s)", False),
        (SUBSCRIPTION, "rclcpp::QoS(1)", "rclcpp::QoS(1).deadline(1s)", True),
        (SUBSCRIPTION, "rclcpp::SensorDataQoS()", "10", True),
        (SUBSCRIPTION, "rclcpp::SensorDataQoS()", "arm::CommandQoS()", False),
        (SUBSCRIPTION, "rclcpp::SensorDataQoS()", "rclcpp::BestAvailableQoS()", False),
        (SUBSCRIPTION, "10", "rclcpp::QoS(1).transient_local()", True),
    ],
)  # fmt: skip
@pytest.mark.parametrize("name", ['"ready"', "topic_"])
def test_only_a_qos_that_certainly_does_not_fit_is_breaking(repository, compare, call, old, new, is_breaking, name):
    lines, found = review_qos(repository, compare, call, old, new, name)
    kind = "publisher" if call == PUBLISHER else "subscription"
    name = name.strip('"')
    assert lines == [f"{kind} '{name}': QoS {old} -> {new}"]
    assert found is is_breaking


@pytest.mark.parametrize("new", ["rclcpp::QoS(10)", "rclcpp::QoS{10}", "rclcpp::QoS(rclcpp::KeepLast(10)).reliable()"])
def test_another_notation_of_a_qos_is_no_change(repository, compare, new):
    lines, _ = review_qos(repository, compare, PUBLISHER, "10", new)
    assert all("QoS " not in line for line in lines)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("10", "QoSPresetProfiles.SENSOR_DATA.value",
         ["publisher 'ready': type Bool -> Int8", "publisher 'ready': QoS 10 -> QoSPresetProfiles.SENSOR_DATA.value"]),
        ("10", "QoSPresetProfiles.DEFAULT.value", ["publisher 'ready': type Bool -> Int8"]),
    ],
)  # fmt: skip
def test_preset_profile_of_a_topic_with_another_type(repository, compare, old, new, expected):
    source = "from rclpy.node import Node\nclass Arm(Node):\n    def start(self):\n"
    source += "        self.pub = self.create_publisher({}, 'ready', {})\n"
    repository.commit({**MANIFEST, "arm/arm/arm.py": source.format("Bool", old)})
    repository.write({"arm/arm/arm.py": source.format("Int8", new)})
    assert breaking(compare(repository)) == expected


@pytest.mark.parametrize(
    ("qos", "shown"),
    [
        ("QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)", "'state' (String, transient_local)"),
        ("qos_profile_sensor_data", "'state' (String, best_effort)"),
        ("10", "'state' (String)"),
    ],
)
def test_added_topic_with_another_qos_than_the_default_is_told_with_it(repository, compare, qos, shown):
    text = "from rclpy.node import Node\n\n\nclass Arm(Node):\n    def __init__(self):\n        {}\n"
    repository.commit({**MANIFEST, "arm/arm.py": text.format("pass")})
    repository.write({"arm/arm.py": text.format(f"self.create_publisher(String, 'state', {qos})")})
    (found,) = compare(repository).subjects
    assert f"publishers added: {shown}" in sentences(found)
