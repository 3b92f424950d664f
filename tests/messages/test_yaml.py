"""Messages as YAML, CSV and dictionaries, compared with rosidl_runtime_py and PyYAML."""

from __future__ import annotations

from collections import OrderedDict

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.messages import (
    JointState,
    get_message,
    get_service,
    interface_names,
    prototype,
    to_csv,
    to_dict,
    to_yaml,
)
from tests.messages.random_messages import random_message

ALL_MESSAGE_NAMES = interface_names("msg")
OPTIONS = ({}, {"truncate_length": 2}, {"no_arr": True}, {"no_str": True}, {"truncate_length": 0, "no_str": True})


class Dumper(yaml.Dumper):
    """PyYAML's dumper, which writes ordered dictionaries as rosidl_runtime_py does."""


class FastDumper(getattr(yaml, "CDumper", yaml.Dumper)):
    """The same dumper with PyYAML's writer in C, which takes a tenth of the time."""


for dumper_class in (Dumper, FastDumper):
    dumper_class.add_representer(
        OrderedDict,
        lambda dumper, data: yaml.MappingNode(
            "tag:yaml.org,2002:map",
            [(dumper.represent_data(key), dumper.represent_data(value)) for key, value in data.items()],
        ),
    )


def dump_yaml(data, flow_style=False, dumper=Dumper):
    return yaml.dump(data, Dumper=dumper, allow_unicode=True, width=2**31 - 1, default_flow_style=flow_style)


@pytest.mark.parametrize("name", ALL_MESSAGE_NAMES)
def test_to_yaml_matches_pyyaml(name):
    for seed, options in enumerate(OPTIONS):
        message = random_message(get_message(name), seed)
        values = to_dict(message, **options)
        assert to_yaml(message, **options) == dump_yaml(values, dumper=FastDumper)
        assert to_yaml(message, flow_style=True, **options) == dump_yaml(values, True, dumper=FastDumper)


@given(text=st.text(max_size=40))
@settings(max_examples=300)
def test_strings_match_pyyaml(text):
    message = get_message("diagnostic_msgs/msg/DiagnosticStatus")(name=text)
    message.values = [get_message("diagnostic_msgs/msg/KeyValue")(key="k", value=text)]
    assert to_yaml(message) == dump_yaml(to_dict(message))


@given(st.floats())
def test_numbers_match_pyyaml(number):
    message = get_message("std_msgs/msg/Float64")(data=number)
    assert to_yaml(message) == dump_yaml(to_dict(message))


def test_joint_state_as_yaml():
    message = JointState(name=["a", "b"], position=[1.0, 2.5e-7])
    assert to_yaml(message) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\n"
        "name:\n- a\n- b\nposition:\n- 1.0\n- 2.5e-07\nvelocity: []\neffort: []\n"
    )
    assert to_csv(message) == "0,0,,a,b,1.0,2.5e-07,,"
    assert to_csv(JointState()) == "0,0,,,,,"
    assert to_dict(message)["position"] == [1.0, 2.5e-07]


def test_long_and_excluded_values_are_abbreviated():
    message = JointState(name=["left_wheel", "b", "c"], position=[1.0, 2.0, 3.0])
    message.header.frame_id = "base_link"
    short = to_dict(message, truncate_length=2)
    assert short["header"]["frame_id"] == "ba..."
    assert short["name"] == ["le...", "b", "..."]
    assert short["position"] == [1.0, 2.0, "..."]
    assert to_dict(message, no_arr=True)["position"] == "<sequence type: double, length: 3>"
    assert to_dict(message, no_str=True)["header"]["frame_id"] == "<string length: <9>>"
    assert to_csv(message, truncate_length=1) == "0,0,b...,l...,...,1.0,...,,"
    pose = get_message("geometry_msgs/msg/PoseWithCovariance")()
    assert to_dict(pose, no_arr=True)["covariance"] == "<array type: double[36]>"
    descriptor = get_message("rcl_interfaces/msg/ParameterDescriptor")()
    abbreviated = to_dict(descriptor, no_arr=True)["integer_range"]
    assert abbreviated == "<sequence type: rcl_interfaces/msg/IntegerRange[1], length: 0>"


def test_empty_message_is_empty_mapping():
    assert to_yaml(get_message("std_msgs/msg/Empty")()) == "{}\n"
    trigger = get_service("std_srvs/srv/Trigger")
    assert to_yaml(trigger.Event(request=[trigger.Request()])).endswith("request:\n- {}\nresponse: []\n")


def test_bytes_are_written_as_characters():
    assert to_dict(get_message("std_msgs/msg/Byte")(data=b"\xe9")) == {"data": "é"}
    assert to_csv(get_message("std_msgs/msg/Byte")(data=b"a")) == "b'a'"


def test_prototype_has_default_values():
    assert prototype("geometry_msgs/msg/Vector3") == "x: 0.0\ny: 0.0\nz: 0.0\n"
    assert prototype("std_srvs/srv/SetBool") == "data: false\n"
    assert prototype("turtlesim/action/RotateAbsolute") == "theta: 0.0\n"
