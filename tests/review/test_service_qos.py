"""The lines of a review about the QoS of services and their clients."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = """from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        super().__init__('arm')
        self.create_service(Trigger, 'go', self.go{service})
        self.create_client(Trigger, 'come'{client})
"""
CPP = """void Arm::start() {{
  service_ = create_service<Trigger>("go", std::bind(&Arm::go, this, _1, _2){service});
  client_ = create_client<Trigger>("come"{client});
}}
"""
PROFILE = ", qos_profile={}"


@pytest.mark.parametrize(
    ("path", "old", "new", "expected", "is_breaking"),
    [
        ("a.py", {}, {"service": PROFILE.format("qos_profile_sensor_data")},
         "service 'go': QoS default -> qos_profile_sensor_data", True),
        ("a.py", {"client": PROFILE.format("qos_profile_sensor_data")}, {},
         "service client 'come': QoS qos_profile_sensor_data -> default", False),
        ("a.py", {}, {"client": PROFILE.format("QoSProfile(depth=1)")},
         "service client 'come': QoS default -> QoSProfile(depth=1)", False),
        ("a.cpp", {}, {"service": ", rclcpp::SensorDataQoS()"},
         "service 'go': QoS default -> rclcpp::SensorDataQoS()", True),
        ("a.cpp", {"client": ", rmw_qos_profile_services_default"}, {"client": ", rclcpp::SensorDataQoS()"},
         "service client 'come': QoS default -> rclcpp::SensorDataQoS()", True),
    ],
)  # fmt: skip
def test_another_qos_of_a_service_is_told(repository, compare, path, old, new, expected, is_breaking):
    empty = {"service": "", "client": ""}
    text = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, f"arm/{path}": text.format(**{**empty, **old})})
    repository.write({f"arm/{path}": text.format(**{**empty, **new})})
    result = compare(repository)
    assert sentences(result.subjects[0]) == [expected]
    assert breaking(result) == ([expected] if is_breaking else [])


@pytest.mark.parametrize(
    ("path", "argument"),
    [("a.py", PROFILE.format("self.profile")), ("a.cpp", ", profile_"), ("a.cpp", ", rclcpp::ServicesQoS()")],
)
def test_an_unknown_or_equal_qos_of_a_service_is_not_told(repository, compare, path, argument):
    text = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, f"arm/{path}": text.format(service="", client="")})
    repository.write({f"arm/{path}": text.format(service=argument, client=argument)})
    assert all("QoS" not in sentence for sentence in sentences(compare(repository).subjects[0]))
