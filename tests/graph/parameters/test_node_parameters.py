"""Parameters of a node: declaration, overrides, types, ranges and callbacks."""

from __future__ import annotations

import pytest

from linkwright.graph import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    LogLevel,
    Parameter,
    ParameterAlreadyDeclaredException,
    ParameterDescriptor,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterType,
    ParameterUninitializedException,
    SetParametersResult,
)
from linkwright.graph.parameters.parameter import Range
from linkwright.messages import get_message

DescriptorMessage = get_message("rcl_interfaces/msg/ParameterDescriptor")
ResultMessage = get_message("rcl_interfaces/msg/SetParametersResult")
IntegerRange = get_message("rcl_interfaces/msg/IntegerRange")
FloatingPointRange = get_message("rcl_interfaces/msg/FloatingPointRange")


async def test_declared_parameters_use_default_or_override(graph):
    node = graph.create_node("node", parameters={"rate": 50, "zeros": {"arm": {"elbow": 1.5}}})
    assert node.declare_parameter("rate", 10).value == 50
    assert node.declare_parameter("frame", "map").value == "map"
    assert node.declare_parameter("zeros.arm.elbow", 0.0).value == 1.5
    assert node.get_parameter("frame").type_ is ParameterType.STRING
    assert node.parameter_names() == ["use_sim_time", "rate", "frame", "zeros.arm.elbow"]
    assert [parameter.value for parameter in node.get_parameters(["frame", "rate"])] == ["map", 50]
    assert node.has_parameter("rate")
    assert not node.has_parameter("arm")
    assert node.declare_parameter("other", 1, ignore_override=True).value == 1


async def test_overrides_are_declared_on_demand(graph):
    node = graph.create_node("node", parameters={"zeros": {"a": 1.0, "b.c": 2.0}})
    node.declare_parameters_from_overrides()
    node.declare_parameters_from_overrides()
    below = node.get_parameters_by_prefix("zeros")
    assert {name: parameter.value for name, parameter in below.items()} == {"a": 1.0, "b.c": 2.0}
    assert set(node.get_parameters_by_prefix("")) == {"use_sim_time", "zeros.a", "zeros.b.c"}


async def test_overrides_can_be_declared_automatically(graph):
    parameters = [Parameter("a", value=1), Parameter("b", value=["x"])]
    node = graph.create_node("node", parameters=parameters, automatically_declare_parameters_from_overrides=True)
    assert [node.get_parameter(name).value for name in ("a", "b")] == [1, ["x"]]


async def test_override_of_wrong_type_is_rejected_with_hint(graph):
    node = graph.create_node("node", parameters={"frequency": 30, "name": 3, "mixed": [1, "a"]})
    with pytest.raises(InvalidParameterTypeException) as caught:
        node.declare_parameter("frequency", 20.0)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "GRAPH201"
    assert str(caught.value) == (
        "Trying to set parameter 'frequency' to '30' of type 'INTEGER', expecting type 'DOUBLE': frequency"
    )
    assert diagnostic.hint == "write 30.0"
    with pytest.raises(InvalidParameterTypeException) as caught:
        node.declare_parameter("name", "x")
    assert caught.value.diagnostics[0].hint is None
    with pytest.raises(InvalidParameterValueException, match="not a list of one of the allowed types"):
        node.declare_parameter("mixed", ["a"])


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (None, "NOT_SET"),
        (True, "BOOL"),
        (1, "INTEGER"),
        (1.0, "DOUBLE"),
        ("", "STRING"),
        (b"x", "BYTE_ARRAY"),
        ([b"x", b"y"], "BYTE_ARRAY"),
        ([True], "BOOL_ARRAY"),
        ([1, 2], "INTEGER_ARRAY"),
        ((1.0,), "DOUBLE_ARRAY"),
        (["a"], "STRING_ARRAY"),
        ([], "BYTE_ARRAY"),
    ],
)
def test_parameter_type_is_inferred_from_value(value, kind):
    parameter = Parameter("p", value=value)
    assert parameter.type_ is ParameterType[kind]
    round_trip = Parameter.from_parameter_msg(parameter.to_parameter_msg())
    assert (round_trip.name, round_trip.type_) == ("p", parameter.type_)
    assert round_trip.value == ([b"x"] if value == b"x" else list(value) if isinstance(value, tuple) else value)


@pytest.mark.parametrize("value", [[1, 1.0], [None], {}, object(), [[1]]])
def test_unsupported_parameter_values_are_rejected(value):
    with pytest.raises(TypeError, match="The given value is not "):
        Parameter("p", value=value)


def test_type_and_value_must_agree():
    with pytest.raises(ValueError, match=r"Type 'Type.DOUBLE' and value '1' do not agree"):
        Parameter("p", Parameter.Type.DOUBLE, 1)
    with pytest.raises(TypeError, match="type must be an instance of"):
        Parameter("p", 3, 1)
    assert Parameter("p", Parameter.Type.DOUBLE_ARRAY, []).value == []


async def test_empty_list_fits_every_array_type(graph):
    node = graph.create_node("node", parameters={"sources": []})
    assert node.declare_parameter("sources", [1.0]).type_ is ParameterType.DOUBLE_ARRAY
    node.declare_parameter("names", [], ParameterDescriptor(type=ParameterType.STRING_ARRAY))
    results = node.set_parameters([Parameter("names", value=["a"]), Parameter("names", value=[1])])
    assert [result.successful for result in results] == [True, False]
    assert node.set_parameters([Parameter("names", value=[])])[0].successful
    assert node.get_parameter("names").type_ is ParameterType.STRING_ARRAY


async def test_set_parameters_requires_declaration_and_type(graph):
    node = graph.create_node("node")
    node.declare_parameter("rate", 10)
    node.declare_parameter("model", "mbot", DescriptorMessage(read_only=True))
    node.declare_parameter("anything", None, ParameterDescriptor(dynamic_typing=True))
    results = node.set_parameters(
        [
            Parameter("rate", value=20),
            Parameter("rate", value=1.5),
            Parameter("model", value="other"),
            Parameter("rate"),
            Parameter("anything", value="x"),
        ]
    )
    assert results == [
        ResultMessage(successful=True),
        ResultMessage(successful=False, reason="Wrong parameter type, expected 'Type.INTEGER' got 'Type.DOUBLE'"),
        ResultMessage(successful=False, reason="Trying to set a read-only parameter: model."),
        ResultMessage(successful=False, reason="Static parameter cannot be undeclared"),
        ResultMessage(successful=True),
    ]
    assert node.get_parameter("rate").value == 20
    assert node.get_parameter("model").value == "mbot"
    assert node.set_parameters([Parameter("anything", value=3.5)])[0].successful
    assert node.set_parameters([Parameter("anything")])[0].successful
    assert not node.has_parameter("anything")
    with pytest.raises(ParameterNotDeclaredException, match=r"undeclared parameter\(s\): \['rat'\]") as caught:
        node.set_parameters([Parameter("rat", value=1)])
    assert caught.value.diagnostics[0].hint == "did you mean 'rate'?"


async def test_undeclared_parameters_can_be_allowed(graph):
    node = graph.create_node("node", allow_undeclared_parameters=True)
    assert node.get_parameter("a").type_ is ParameterType.NOT_SET
    assert node.describe_parameter("a") == DescriptorMessage()
    assert node.get_parameter_type("a") == 0
    assert node.set_parameters([Parameter("a", value=1), Parameter("a", value="text")])[1].successful
    assert node.get_parameter("a").value == "text"
    assert node.describe_parameter("a").dynamic_typing
    assert node.set_descriptor("b", DescriptorMessage()).type == 0


async def test_statically_typed_parameter_can_be_uninitialized(graph):
    node = graph.create_node("node", parameters={"given": 3})
    node.declare_parameter("later", Parameter.Type.INTEGER)
    assert node.declare_parameter("given", Parameter.Type.INTEGER).value == 3
    with pytest.raises(ParameterUninitializedException, match="The parameter 'later' is not initialized"):
        node.get_parameter("later")
    assert node.get_parameter_or("later", Parameter("later", value=7)).value == 7
    assert node.get_parameter_or("gone").type_ is ParameterType.NOT_SET
    assert not node.set_parameters([Parameter("later", value="x")])[0].successful
    assert node.set_parameters([Parameter("later", value=1)])[0].successful
    assert node.get_parameter_or("later").value == 1
    with pytest.raises(ValueError, match=r"Cannot declare parameter {x} as statically typed of type NOT_SET"):
        node.declare_parameter("x", Parameter.Type.NOT_SET)
    with pytest.raises(ValueError, match="default value of type PARAMETER_NOT_SET"):
        node.declare_parameter("x", None, ParameterDescriptor())
    with pytest.raises(ValueError, match="`dynamic_typing=True` is not allowed"):
        node.declare_parameter("x", Parameter.Type.BOOL, ParameterDescriptor(dynamic_typing=True))
    with pytest.warns(UserWarning, match="declaring a parameter only providing its name is deprecated"):
        node.declare_parameter("x")


async def test_declare_parameters_prepends_namespace(graph):
    node = graph.create_node("node", parameters={"arm.a": 5})
    declared = node.declare_parameters("arm", [("a", 1), ("b", Parameter.Type.STRING), ("c", 2.0, DescriptorMessage())])
    assert [(parameter.name, parameter.value) for parameter in declared] == [
        ("arm.a", 5),
        ("arm.b", None),
        ("arm.c", 2.0),
    ]
    with pytest.raises(TypeError, match="Invalid parameter tuple length at index 0"):
        node.declare_parameters("", [()])
    with pytest.raises(TypeError, match="First element 1 at index 1 in parameters list is not a str"):
        node.declare_parameters("", [("x", 1), (1,)])
    with pytest.raises(TypeError, match="Third element 3 at index 0 in parameters list is not a ParameterDescriptor"):
        node.declare_parameters("", [("x", 1, 3)])
    with pytest.raises(InvalidParameterException, match=r"Invalid parameter name: $"):
        node.declare_parameter("", 1)
    assert not node.has_parameter("x")


async def test_last_of_duplicate_declarations_applies(graph):
    node = graph.create_node("node")
    declared = node.declare_parameters("", [("a", 1), ("b", 2), ("a", 3)])
    assert [(parameter.name, parameter.value) for parameter in declared] == [("a", 3), ("b", 2), ("a", 3)]
    with pytest.raises(ParameterAlreadyDeclaredException, match=r"a.*b"):
        node.declare_parameters("", [("c", 1), ("a", 1), ("b", 1)])
    assert not node.has_parameter("c")


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (0, None),
        (10, None),
        (4, None),
        (11, "Parameter p out of range. Min: 0, Max: 10, value: 11"),
        (5, "The parameter value for p is not a valid step. Min: 0, max: 10, value: 5, step: 2"),
    ],
)
async def test_integer_range_is_enforced(graph, value, reason):
    node = graph.create_node("node")
    descriptor = DescriptorMessage(integer_range=[IntegerRange(from_value=0, to_value=10, step=2)])
    node.declare_parameter("p", 2, descriptor)
    result = node.set_parameters_atomically([Parameter("p", value=value)])
    assert (result.successful, result.reason) == (reason is None, reason or "")


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (0.5, None),
        (2.0, None),
        (1.0, None),
        (2.1, "Parameter p out of range Min: 0.5, Max: 2.0, value: 2.1"),
        (
            1.1,
            "The parameter value for p is not close enough to a valid step. Min: 0.5, max: 2.0, value: 1.1, step: 0.25",
        ),
    ],
)
async def test_floating_point_range_is_enforced(graph, value, reason):
    node = graph.create_node("node")
    node.declare_parameter("p", 0.75, ParameterDescriptor(floating_point_range=[Range(0.5, 2.0, 0.25)]))
    result = node.set_parameters_atomically([Parameter("p", value=value)])
    assert (result.successful, result.reason) == (reason is None, reason or "")
    assert node.describe_parameter("p").floating_point_range == [
        FloatingPointRange(from_value=0.5, to_value=2.0, step=0.25)
    ]


async def test_default_out_of_range_is_rejected(graph):
    node = graph.create_node("node")
    with pytest.raises(InvalidParameterValueException, match=r"Invalid parameter value \(9\) .* out of range"):
        node.declare_parameter("p", 9, ParameterDescriptor(integer_range=[Range(0, 1)]))
    assert not node.has_parameter("p")


@pytest.mark.parametrize("descriptor_type", [ParameterDescriptor, DescriptorMessage])
async def test_descriptor_can_be_shared_by_parameters(graph, descriptor_type):
    node = graph.create_node("sharing")
    descriptor = descriptor_type(read_only=True)
    node.declare_parameter("wide", 1.5, descriptor)
    node.declare_parameter("whole", 2, descriptor)
    descriptions = node.describe_parameters(["wide", "whole"])
    assert [(description.name, description.type, description.read_only) for description in descriptions] == [
        ("wide", 3, True),
        ("whole", 2, True),
    ]
    assert not descriptor.name


async def test_descriptors_are_returned_and_replaced(graph):
    node = graph.create_node("node")
    node.declare_parameter("p", 5, ParameterDescriptor(description="how many"))
    assert node.describe_parameter("p") == DescriptorMessage(name="p", type=2, description="how many")
    assert [descriptor.name for descriptor in node.describe_parameters(["p", "use_sim_time"])] == [
        "p",
        "use_sim_time",
    ]
    narrow_range = DescriptorMessage(type=2, integer_range=[IntegerRange(from_value=0, to_value=3)])
    with pytest.raises(InvalidParameterValueException):
        node.set_descriptor("p", narrow_range)
    assert node.set_descriptor("p", narrow_range, Parameter("p", value=2).get_parameter_value()).integer_value == 2
    assert node.get_parameter("p").value == 2
    assert node.describe_parameter("p") is narrow_range
    node.declare_parameter("fixed", 1, DescriptorMessage(read_only=True))
    with pytest.raises(ParameterImmutableException):
        node.set_descriptor("fixed", narrow_range)
    with pytest.raises(ParameterNotDeclaredException):
        node.set_descriptor("gone", narrow_range)


async def test_undeclare_parameter_removes_parameter(graph):
    node = graph.create_node("node")
    node.declare_parameter("a", 1)
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    node.undeclare_parameter("a")
    assert not node.has_parameter("a")
    with pytest.raises(ParameterNotDeclaredException):
        node.undeclare_parameter("a")
    with pytest.raises(ParameterImmutableException, match="Attempted to modify read-only parameter: fixed"):
        node.undeclare_parameter("fixed")


async def test_set_callbacks_reject_with_reason(graph):
    node = graph.create_node("node", parameters={"late": -1})
    applied = []

    def check(parameters):
        if any(parameter.value < 0 for parameter in parameters):
            return SetParametersResult(successful=False, reason="must not be negative")
        return ResultMessage(successful=True)

    node.declare_parameter("a", 1)
    node.declare_parameter("b", 1)
    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(
        lambda parameters: applied.append([parameter.name for parameter in parameters])
    )
    valid, invalid = Parameter("a", value=2), Parameter("b", value=-2)
    assert node.set_parameters([valid, invalid])[1].reason == "must not be negative"
    assert (node.get_parameter("a").value, node.get_parameter("b").value) == (2, 1)
    assert not node.set_parameters_atomically([Parameter("a", value=3), invalid]).successful
    assert node.get_parameter("a").value == 2
    assert node.set_parameters_atomically([Parameter("a", value=3), Parameter("b", value=4)]).successful
    assert applied == [["a"], ["a", "b"]]
    with pytest.raises(InvalidParameterValueException, match="Reason: must not be negative: late"):
        node.declare_parameter("late", 1)
    assert not node.has_parameter("late")


async def test_set_callbacks_run_last_added_first_and_can_be_removed(graph):
    node = graph.create_node("node")
    node.declare_parameter("a", 1)
    node.declare_parameter("b", 1)
    calls = []

    def pre(parameters):
        calls.append("pre")
        return [*parameters, Parameter("b", value=parameters[0].value * 2)]

    def first(_):
        calls.append("first")
        return SetParametersResult(successful=True)

    def second(_):
        calls.append("second")
        return SetParametersResult(successful=True)

    def post(parameters):
        calls.append([parameter.name for parameter in parameters])

    node.add_pre_set_parameters_callback(pre)
    node.add_on_set_parameters_callback(first)
    node.add_on_set_parameters_callback(second)
    node.add_post_set_parameters_callback(post)
    assert node.set_parameters([Parameter("a", value=3)])[0].successful
    assert calls == ["pre", "second", "first", ["a", "b"]]
    assert node.get_parameter("b").value == 6
    node.remove_pre_set_parameters_callback(pre)
    node.remove_on_set_parameters_callback(first)
    node.remove_on_set_parameters_callback(second)
    node.remove_post_set_parameters_callback(post)
    node.set_parameters([Parameter("a", value=4)])
    assert len(calls) == 4
    for remove in (node.remove_pre_set_parameters_callback, node.remove_post_set_parameters_callback):
        with pytest.raises(ValueError):
            remove(pre)
    node.add_pre_set_parameters_callback(lambda _: [])
    assert "parameter list cannot be empty" in node.set_parameters([Parameter("a", value=5)])[0].reason


async def test_parameters_are_listed_by_prefix_and_depth(graph):
    node = graph.create_node("node")
    for name in ("a", "arm.b", "arm.hand.c", "arm.hand.d", "army"):
        node.declare_parameter(name, 1)

    def listed(prefixes, depth):
        result = node.list_parameters(prefixes, depth)
        return list(result.names), list(result.prefixes)

    all_names = ["use_sim_time", "a", "arm.b", "arm.hand.c", "arm.hand.d", "army"]
    assert listed([], 0) == (all_names, ["arm", "arm.hand"])
    assert listed([], 1) == (["use_sim_time", "a", "army"], [])
    assert listed(["arm"], 0) == (["arm.b", "arm.hand.c", "arm.hand.d"], ["arm", "arm.hand"])
    assert listed(["arm"], 1) == (["arm.b"], ["arm"])
    assert listed(["arm.hand.c", "a"], 1) == (["a", "arm.hand.c"], ["arm.hand"])
    with pytest.raises(TypeError, match="prefixes argument must be a list"):
        node.list_parameters("arm", 0)
    with pytest.raises(ValueError, match="greater than or equal to zero"):
        node.list_parameters([], -1)


async def test_duplicate_and_undeclared_parameters_are_reported(graph):
    node = graph.create_node("node")
    node.declare_parameter("publish_frequency", 20.0)
    with pytest.raises(ParameterAlreadyDeclaredException, match=r"already declared: \['publish_frequency'\]"):
        node.declare_parameter("publish_frequency", 20.0)
    with pytest.raises(ParameterNotDeclaredException, match=r"undeclared parameter.*: publish_frequncy") as caught:
        node.get_parameter("publish_frequncy")
    assert caught.value.diagnostics[0].hint == "did you mean 'publish_frequency'?"
    with pytest.raises(TypeError, match="All names must be instances of type str"):
        node.get_parameters([1])
    with pytest.raises(TypeError, match="parameter must be instance of type"):
        node.set_parameters_atomically(["a"])


async def test_use_sim_time_logs_no_warnings(graph, log):
    graph.create_node("node", parameters={"use_sim_time": True})
    assert [record for record in log if record.level >= LogLevel.WARN] == []


async def test_set_callback_without_result_rejects(graph):
    node = graph.create_node("node")
    node.declare_parameter("a", 1)
    node.add_on_set_parameters_callback(lambda _: None)
    with pytest.warns(UserWarning, match="it should return SetParametersResult: .*<lambda>"):
        result = node.set_parameters_atomically([Parameter("a", value=2)])
    assert (result.successful, result.reason) == (False, "Callback returned an invalid type")
    assert node.get_parameter("a").value == 1
