"""Parameters of launched nodes: values, types and files."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from launch.frontend.parse_substitution import parse_substitution
from launch.substitutions import LaunchConfiguration, TextSubstitution
from launch_ros.actions import SetParameter
from launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from launch_ros.substitutions import Parameter as ParameterSubstitution
from launch_ros.utilities import evaluate_parameters, normalize_parameters

from launch import LaunchContext
from launch.frontend import Parser
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.ros.parameters import evaluate_own_parameters

Write = Callable[[str, str], Path]


@pytest.fixture
def context() -> LaunchContext:
    context = LaunchContext()
    context.launch_configurations.update(
        number="3", truth="true", word="on", text="a: b", model="<robot> a: b\n</robot>"
    )
    return context


def evaluated_parameters(context: LaunchContext, *parameters: Any, node: str = "/talker") -> dict[str, Any]:
    return evaluate_own_parameters(normalize_parameters(list(parameters)), context).values(context, node)


def error_message(error: BaseException) -> str:
    assert isinstance(error, LinkwrightError)
    (diagnostic,) = error.diagnostics
    return diagnostic.message


class TestParameters:
    def test_python_values_keep_their_types(self, context: LaunchContext) -> None:
        parameters = {"a": 1, "b": 1.5, "c": True, "d": "true", "e": [1, 2], "f": ["x", "y"], "g": [1, 2.5], "h": ""}
        assert evaluated_parameters(context, parameters) == {**parameters, "g": [1.0, 2.5]}

    def test_substitutions_are_parsed_as_yaml(self, context: LaunchContext) -> None:
        parameters = evaluated_parameters(
            context,
            {
                "a": LaunchConfiguration("number"),
                "b": LaunchConfiguration("truth"),
                "c": LaunchConfiguration("word"),
                "d": ["/", LaunchConfiguration("number")],
                "e": [[LaunchConfiguration("number")], [TextSubstitution(text="4")]],
            },
        )
        assert parameters == {"a": 3, "b": True, "c": True, "d": "/3", "e": [3, 4]}

    @pytest.mark.parametrize(
        ("name", "kind", "value"),
        [
            ("number", None, 3),
            ("number", int, 3),
            ("number", float, 3.0),
            ("number", str, "3"),
            ("truth", bool, True),
            ("text", str, "a: b"),
            ("list", list[int], [1, 2]),
        ],
    )
    def test_parameter_value_is_converted_to_type(
        self, context: LaunchContext, name: str, kind: Any, value: Any
    ) -> None:
        context.launch_configurations["list"] = "[1, 2]"
        parameters = evaluated_parameters(context, {"p": ParameterValue(LaunchConfiguration(name), value_type=kind)})
        assert parameters == {"p": value}
        assert type(parameters["p"]) is type(value)

    def test_value_of_wrong_type_is_rejected(self, context: LaunchContext) -> None:
        with pytest.raises(ValueError) as caught:
            evaluated_parameters(context, {"p": ParameterValue(LaunchConfiguration("word"), value_type=int)})
        assert "parameter 'p' is not of the requested type int" in error_message(caught.value)

    def test_nested_dictionaries_and_substituted_names_are_flattened(self, context: LaunchContext) -> None:
        parameters = evaluated_parameters(
            context, {"zeros": {"joint": 1.0, ("n", LaunchConfiguration("number")): 2.0}, "a.b": 1}
        )
        assert parameters == {"zeros.joint": 1.0, "zeros.n3": 2.0, "a.b": 1}

    def test_later_values_override_earlier(self, context: LaunchContext) -> None:
        assert evaluated_parameters(context, {"a": 1, "b": 1}, {"a": 2}, Parameter("b", 3)) == {"a": 2, "b": 3}

    def test_untyped_description_is_one_error_with_fix(self, context: LaunchContext) -> None:
        with pytest.raises(LinkwrightError) as caught:
            evaluated_parameters(context, {"robot_description": LaunchConfiguration("model")})
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "LAUNCH132"
        assert "parameter 'robot_description' has no type and is not YAML" in diagnostic.message
        assert "ParameterValue(VALUE, value_type=str)" in (diagnostic.hint or "")
        assert diagnostic.span is not None
        assert diagnostic.span.file == __file__

    def test_description_without_colons_is_passed_unchanged(self, context: LaunchContext) -> None:
        text = '<robot name="r">\n  <link name="a"/>\n</robot>'
        context.launch_configurations["model"] = text
        assert evaluated_parameters(context, {"robot_description": LaunchConfiguration("model")}) == {
            "robot_description": text
        }

    @pytest.mark.parametrize(
        ("value", "message"),
        [
            ("{a: 1}", "its value is a mapping, which is not a parameter type"),
            ("[1, x]", "is a list of mixed items (int, str)"),
            ("[]", "is an empty list, whose type is unknown"),
            ("[[1], [2]]", "is a list of items of type list"),
        ],
    )
    def test_unsupported_yaml_values_are_rejected(self, context: LaunchContext, value: str, message: str) -> None:
        context.launch_configurations["odd"] = value
        with pytest.raises(TypeError) as caught:
            evaluated_parameters(context, {"p": LaunchConfiguration("odd")})
        assert message in error_message(caught.value)

    def test_empty_substitution_is_empty_string(self, context: LaunchContext) -> None:
        context.launch_configurations["nothing"] = ""
        assert evaluated_parameters(context, {"p": LaunchConfiguration("nothing")}) == {"p": ""}

    @pytest.mark.parametrize(
        ("parameters", "message"),
        [
            ([{"p": object()}], "is of type object, which is not a parameter type"),
            ([{"p": Path("/x")}], "is a Path"),
            ([{"p": [1, 2, [3, 4]]}], "contains an item of type list"),
            ([{"g": {"h": {5: "x"}}}], "the name of a parameter must be a string, not 5"),
            ([5.0], "contains an item of type float"),
            ({"a": 5}, "'parameters' of a node must be a list"),
            ("/path.yaml", "'parameters' of a node must be a list"),
        ],
    )
    def test_invalid_parameter_forms_are_rejected_at_construction(self, parameters: Any, message: str) -> None:
        with pytest.raises(TypeError) as caught:
            normalize_parameters(parameters)
        assert message in error_message(caught.value)

    def test_plain_strings_are_not_parsed_as_yaml(self, context: LaunchContext) -> None:
        parameters = {"a": "1", "b": ["true", "2"], "c": "{x: y}"}
        assert evaluated_parameters(context, parameters) == parameters

    def test_evaluated_parameters_keep_files_and_flatten_dictionaries(self, context: LaunchContext) -> None:
        parameters = normalize_parameters(["/a.yaml", {"n": {"x": 1}, "l": [1, 2.5]}, Path("/b.yaml")])
        assert evaluate_parameters(context, parameters) == (
            Path("/a.yaml"),
            {"n.x": 1, "l": (1.0, 2.5)},
            Path("/b.yaml"),
        )


class TestParameterFiles:
    FILE = """
/**:
  ros__parameters:
    everywhere: 1
    deep: {x: 1}
talker:
  ros__parameters: {own: 2}
/robot:
  talker:
    ros__parameters: {own: 3}
/robot/*:
  ros__parameters: {star: 4}
listener:
  ros__parameters: {own: 5}
"""

    @pytest.mark.parametrize(
        ("node", "expected"),
        [
            ("/talker", {"everywhere": 1, "deep.x": 1, "own": 2}),
            ("/robot/talker", {"everywhere": 1, "deep.x": 1, "own": 3, "star": 4}),
            ("/other", {"everywhere": 1, "deep.x": 1}),
        ],
    )
    def test_parameter_file_sections_match_node_name(
        self, context: LaunchContext, write: Write, node: str, expected: dict
    ) -> None:
        path = write("p.yaml", self.FILE)
        assert evaluated_parameters(context, str(path), node=node) == expected
        assert evaluated_parameters(context, path, node=node) == expected
        assert evaluated_parameters(context, ParameterFile(path), node=node) == expected

    def test_substitutions_in_parameter_file_are_evaluated(self, context: LaunchContext, write: Write) -> None:
        path = write(
            "p.yaml",
            "/**: {ros__parameters: {a: $(var number), b: $(env LW_NONE x), c: '$(var n$(var word) d)', "
            "d: $(find-pkg-share my_robot_description)}}",
        )
        parameters = evaluated_parameters(context, ParameterFile(path, allow_substs=True))
        assert parameters["a"] == 3
        assert parameters["b"] == "x"
        assert parameters["c"] == "d"
        assert parameters["d"].endswith("my_robot_description")

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("a: [", "the parameter file is not valid YAML"),
            ("a: 1", "'a' has a value, but only parameters below 'ros__parameters' can have values"),
            ("/**: {ros__parameters: {a: $(var nmber)}}", "launch configuration 'nmber' is not set"),
            ("/**: {ros__parameters: {a: $(vra number)}}", "there is no substitution 'vra'"),
            ("/**: {ros__parameters: {a: $(var number}}", "has no closing parenthesis"),
        ],
    )
    def test_invalid_parameter_files_are_reported(
        self, context: LaunchContext, write: Write, text: str, message: str
    ) -> None:
        with pytest.raises(LinkwrightError) as caught:
            evaluated_parameters(context, ParameterFile(write("p.yaml", text), allow_substs=True))
        (diagnostic,) = caught.value.diagnostics
        assert message in diagnostic.message
        assert diagnostic.span is not None
        assert diagnostic.span.file.endswith("p.yaml")

    def test_comments_in_parameter_file_are_kept(self, context: LaunchContext, write: Write) -> None:
        text = "/**:  # $(nothing of the kind)\n  ros__parameters:\n    a: '# $(var number)'  # $(var none)\n"
        assert evaluated_parameters(context, ParameterFile(write("p.yaml", text), allow_substs=True)) == {"a": "# 3"}

    def test_file_with_substitutions_is_written_and_cleaned_up(self, context: LaunchContext, write: Write) -> None:
        file = ParameterFile(write("p.yaml", "/**: {ros__parameters: {a: $(var number)}}"), allow_substs=True)
        path = file.evaluate(context)
        assert file.param_file == path
        assert path.read_text() == "/**: {ros__parameters: {a: 3}}"
        file.cleanup()
        assert not path.exists()

    def test_missing_parameter_file_raises_file_not_found(self, context: LaunchContext, tmp_path: Path) -> None:
        with pytest.raises(FileNotFoundError) as caught:
            evaluated_parameters(context, str(tmp_path / "none.yaml"))
        assert "none.yaml' does not exist" in error_message(caught.value)

    def test_empty_parameter_file_is_accepted(self, context: LaunchContext, write: Write) -> None:
        assert evaluated_parameters(context, str(write("p.yaml", ""))) == {}


@pytest.mark.parametrize(
    ("kind", "text", "items"),
    [
        ("int", "1,2", [1, 2]),
        ("float", "1.0,2.5", [1.0, 2.5]),
        ("bool", "true,false", [True, False]),
        ("str", "1,a", ["1", "a"]),
    ],
)
def test_typed_lists_are_parsed_in_xml_and_yaml(context: LaunchContext, kind: str, text: str, items: list[Any]) -> None:
    for type_name in (f"list_of_{kind}", f"list[{kind}]"):
        xml = f'<param name="p" value="{text}" value-sep="," type="{type_name}"/>'
        assert evaluated_parameters(
            context, *parse_parameters(f'<launch><node pkg="a" exec="b">{xml}</node></launch>')
        ) == {"p": items}
        parts = text.split(",")
        expected_parts = [f"'{part}'" for part in parts] if kind == "str" else parts
        tag = f"{{name: p, value: [{', '.join(expected_parts)}], type: '{type_name}'}}"
        yaml = f"launch:\n- node: {{pkg: a, exec: b, param: [{tag}]}}\n"
        assert evaluated_parameters(context, *parse_parameters(yaml)) == {"p": items}


def parse_parameters(text: str) -> list[Any]:
    """Return the parameters of the only node of a launch file."""
    entity, parser = Parser.load(io.StringIO(text))
    (node,) = parser.parse_description(entity).entities
    return node._Node__parameters


def test_parameter_substitution_accepts_default(context: LaunchContext) -> None:
    assert ParameterSubstitution("none", default="x").perform(context) == "x"
    assert ParameterSubstitution("none", default=[LaunchConfiguration("number"), "4"]).perform(context) == "34"
    assert ParameterSubstitution("none", default=5).perform(context) == "5"
    (parsed_one,) = parse_substitution("$(param none $(var number))")
    assert parsed_one.perform(context) == "3"
    SetParameter("known", 7).execute(context)
    assert ParameterSubstitution("known", default="x").perform(context) == "7"
    with pytest.raises(LinkwrightError, match="no SetParameter"):
        ParameterSubstitution("none").perform(context)
