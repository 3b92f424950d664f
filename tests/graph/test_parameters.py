import pytest

from linkwright.graph import (
    InvalidParameterTypeError,
    InvalidParameterValueError,
    LogLevel,
    Parameter,
    ParameterAlreadyDeclaredError,
    ParameterDescriptor,
    ParameterNotDeclaredError,
    ParameterType,
    SetParametersResult,
)


async def test_declared_parameters_have_their_default_or_what_is_given(graph):
    node = graph.create_node("node", parameters={"rate": 50, "zeros": {"arm": {"elbow": 1.5}}})
    assert node.declare_parameter("rate", 10).value == 50
    assert node.declare_parameter("frame", "map").value == "map"
    assert node.declare_parameter("zeros.arm.elbow", 0.0).value == 1.5
    assert node.get_parameter("frame").type_ is ParameterType.STRING
    assert node.list_parameters() == ["use_sim_time", "rate", "frame", "zeros.arm.elbow"]
    assert [each.value for each in node.get_parameters(["frame", "rate"])] == ["map", 50]
    assert node.has_parameter("rate")
    assert not node.has_parameter("arm")


async def test_what_is_given_is_declared_on_demand(graph):
    node = graph.create_node("node", parameters={"zeros": {"a": 1.0, "b.c": 2.0}})
    node.declare_parameters_from_overrides()
    node.declare_parameters_from_overrides()
    below = node.get_parameters_by_prefix("zeros")
    assert {name: parameter.value for name, parameter in below.items()} == {"a": 1.0, "b.c": 2.0}


async def test_a_value_of_another_type_is_refused_with_a_hint(graph):
    node = graph.create_node("node", parameters={"frequency": 30, "name": 3, "mixed": [1, "a"]})
    with pytest.raises(InvalidParameterTypeError) as caught:
        node.declare_parameter("frequency", 20.0)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "GRAPH201"
    assert diagnostic.message == (
        "parameter 'frequency' has invalid type: Wrong parameter type, parameter {frequency} is of type "
        "{double}, setting it to {integer} is not allowed"
    )
    assert diagnostic.hint == "write 30.0"
    with pytest.raises(InvalidParameterTypeError) as caught:
        node.declare_parameter("name", "x")
    assert caught.value.diagnostics[0].hint is None
    with pytest.raises(InvalidParameterValueError, match="not a value that a parameter can have"):
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
        ([True], "BOOL_ARRAY"),
        ([1, 2], "INTEGER_ARRAY"),
        ((1.0,), "DOUBLE_ARRAY"),
        (["a"], "STRING_ARRAY"),
        ([], "STRING_ARRAY"),
    ],
)
def test_types_of_values(value, kind):
    assert Parameter("p", value=value).type_ is ParameterType[kind]


@pytest.mark.parametrize("value", [[1, 1.0], [True, 1], {}, object(), [[1]], [None]])
def test_values_that_no_parameter_has(value):
    with pytest.raises(TypeError, match="is not a value that a parameter can have"):
        Parameter("p", value=value)


def test_type_and_value_must_agree():
    with pytest.raises(ValueError, match="parameter 'p' is of type double"):
        Parameter("p", Parameter.Type.DOUBLE, 1)
    assert Parameter("p", Parameter.Type.DOUBLE_ARRAY, []).value == []


async def test_any_array_can_be_empty(graph):
    node = graph.create_node("node", parameters={"sources": []})
    node.declare_parameter("sources", [1.0])
    node.declare_parameter("names", [], ParameterDescriptor(type=ParameterType.STRING_ARRAY))
    results = node.set_parameters([Parameter("names", value=["a"]), Parameter("names", value=[1])])
    assert [result.successful for result in results] == [True, False]


async def test_setting_obeys_declaration_and_type(graph):
    node = graph.create_node("node")
    node.declare_parameter("rate", 10)
    node.declare_parameter("model", "mbot", ParameterDescriptor(read_only=True))
    node.declare_parameter("anything")
    results = node.set_parameters(
        [
            Parameter("rate", value=20),
            Parameter("rate", value=1.5),
            Parameter("speed", value=1.5),
            Parameter("model", value="other"),
            Parameter("anything", value="x"),
        ]
    )
    assert results == [
        SetParametersResult(successful=True),
        SetParametersResult(
            successful=False,
            reason="Wrong parameter type, parameter {rate} is of type {integer}, setting it to {double} is not "
            "allowed.",
        ),
        SetParametersResult(successful=False, reason="parameter 'speed' cannot be set because it was not declared"),
        SetParametersResult(successful=False, reason="parameter 'model' cannot be set because it is read-only"),
        SetParametersResult(successful=True),
    ]
    assert node.get_parameter("rate").value == 20
    assert node.get_parameter("model").value == "mbot"


async def test_callbacks_may_refuse_with_a_reason(graph):
    node = graph.create_node("node", parameters={"late": -1})
    applied = []

    def check(parameters):
        if any(parameter.value < 0 for parameter in parameters):
            return SetParametersResult(successful=False, reason="must not be negative")
        return SetParametersResult(successful=True)

    node.declare_parameter("a", 1)
    node.declare_parameter("b", 1)
    node.add_on_set_parameters_callback(check)
    node.add_post_set_parameters_callback(lambda given: applied.append([each.name for each in given]))
    good, bad = Parameter("a", value=2), Parameter("b", value=-2)
    assert node.set_parameters([good, bad])[1].reason == "must not be negative"
    assert (node.get_parameter("a").value, node.get_parameter("b").value) == (2, 1)
    assert not node.set_parameters_atomically([Parameter("a", value=3), bad]).successful
    assert node.get_parameter("a").value == 2
    assert node.set_parameters_atomically([Parameter("a", value=3), Parameter("b", value=4)]).successful
    assert applied == [["a"], ["a", "b"]]
    with pytest.raises(InvalidParameterValueError, match="parameter 'late' could not be set: must not be"):
        node.declare_parameter("late", 1)
    assert not node.has_parameter("late")


async def test_misuse_is_told(graph):
    node = graph.create_node("node")
    node.declare_parameter("publish_frequency", 20.0)
    with pytest.raises(ParameterAlreadyDeclaredError, match="'publish_frequency' is already declared"):
        node.declare_parameter("publish_frequency", 20.0)
    with pytest.raises(ParameterNotDeclaredError, match="'publish_frequncy' is not declared") as caught:
        node.get_parameter("publish_frequncy")
    assert caught.value.diagnostics[0].hint == "did you mean 'publish_frequency'?"


async def test_simulated_time_is_not_there_and_says_so(graph, log):
    graph.create_node("quiet", parameters={"use_sim_time": False})
    assert log == []
    graph.create_node("node", parameters={"use_sim_time": True})
    assert log[0].level is LogLevel.WARN
    assert "use_sim_time" in log[0].text
