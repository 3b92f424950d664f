"""Names of topics, types and services on DDS."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.wire.dds.names import (
    Role,
    RosName,
    format_endpoint_id,
    parse_ros_name,
    parse_service_type,
    parse_user_data,
    to_dds_topic,
)
from linkwright.wire.type_names import to_ros_type, to_wire_type

words = st.from_regex(r"[a-z_][a-z0-9_]{0,8}", fullmatch=True)
names = st.lists(words, min_size=1, max_size=3).map(lambda parts: "/" + "/".join(parts))


@given(st.sampled_from(Role), names)
def test_ros_names_round_trip(role, name):
    assert parse_ros_name(to_dds_topic(role, name)) == RosName(role, name)


@given(words, st.sampled_from(["msg", "srv", "action"]), st.from_regex(r"[A-Z][A-Za-z0-9]{0,8}", fullmatch=True))
def test_type_names_round_trip(package, kind, name):
    assert to_ros_type(to_wire_type(f"{package}/{kind}/{name}")) == f"{package}/{kind}/{name}"


def test_dds_names_match_ros():
    assert to_dds_topic(Role.TOPIC, "/joint_states") == "rt/joint_states"
    assert to_dds_topic(Role.REQUEST, "/node/get_parameters") == "rq/node/get_parametersRequest"
    assert to_dds_topic(Role.REPLY, "/node/get_parameters") == "rr/node/get_parametersReply"
    assert to_dds_topic(Role.TOPIC, "/joint_states", plain=True) == "/joint_states"
    assert to_wire_type("std_srvs/srv/SetBool_Request") == "std_srvs::srv::dds_::SetBool_Request_"


@pytest.mark.parametrize("topic", ["ros_discovery_info", "rt", "xy/name", "rq/askedReply", "rq/Request", "/plain"])
def test_other_topics_are_not_ros_names(topic):
    assert parse_ros_name(topic) is None


@pytest.mark.parametrize("name", ["Plain", "a::b::C", "std_msgs::msg::String_", "std_msgs::msg::dds_::String"])
def test_other_types_are_not_ros_types(name):
    assert to_ros_type(name) is None
    assert parse_service_type(name) is None


def test_request_and_response_types_map_to_service_type():
    assert parse_service_type("std_srvs::srv::dds_::SetBool_Request_") == "std_srvs/srv/SetBool"
    assert parse_service_type("std_srvs::srv::dds_::SetBool_Response_") == "std_srvs/srv/SetBool"
    assert parse_service_type("std_srvs::srv::dds_::SetBool_") is None
    assert parse_service_type("demo::action::dds_::Count_SendGoal_Request_") == "demo/action/Count_SendGoal"


def test_user_data_is_parsed_like_rmw():
    assert parse_user_data(b"enclave=/;") == {"enclave": "/"}
    assert parse_user_data(b"clientid= 1.2.ff;typehash=RIHS01_00;") == {"clientid": "1.2.ff", "typehash": "RIHS01_00"}
    assert parse_user_data(b"") == {}
    assert parse_user_data(b"\xff;=x;nothing") == {}


def test_endpoint_id_matches_rmw_cyclonedds():
    assert format_endpoint_id(bytes([1, 2, 0xAB])) == " 1.2.ab"
