"""The values of all expressions, as shown in an editor."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.xacro.session import Inputs
from linkwright.xacro.tracing.values import evaluate_expressions

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


def find_values(text: str, **arguments: str) -> dict[str, tuple[str, ...]]:
    """Return the values of each text with expressions, by its position."""
    document_text = f"{HEAD}{text}</robot>"
    expressions = evaluate_expressions(Inputs("r.xacro", arguments, text=document_text))
    return {document_text[part.start : part.end]: part.values for part in expressions}


def test_values_of_each_macro_call_are_listed():
    text = '<xacro:macro name="m" params="n"><link name="${n}_l"/></xacro:macro><xacro:m n="a"/><xacro:m n="b"/>'
    assert find_values(text) == {"${n}": ("'a'", "'b'"), "${n}_l": ("'a_l'", "'b_l'")}


def test_evaluation_has_call_and_names():
    text = (
        f'{HEAD}<xacro:property name="w" value="2"/><xacro:macro name="m" params="n">'
        '<link name="l${n * w}"/></xacro:macro>\n<xacro:m n="3"/></robot>'
    )
    expressions = evaluate_expressions(Inputs("r.xacro", {}, text=text))
    (part,) = (part for part in expressions if text[part.start : part.end] == "${n * w}")
    (evaluation,) = part.evaluations
    assert evaluation.value == "6"
    assert evaluation.names == (("n", "3"), ("w", "2"))
    assert evaluation.frame is not None
    assert evaluation.frame.site.span().line == 2


def test_properties_conditions_parameters_and_texts_have_values():
    text = (
        '<xacro:property name="a" value="2"/><xacro:property name="b" value="${a + 1}"/>'
        '<xacro:macro name="m" params="n k:=${a*10}"><gazebo>${n + k}</gazebo></xacro:macro>'
        '<xacro:if value="${b == 3}"><xacro:m n="${b}"/></xacro:if>'
    )
    expected = {"${a + 1}": ("3",), "${b == 3}": ("True",), "${b}": ("3",), "${a*10}": ("20",), "${n + k}": ("23",)}
    assert find_values(text) == expected


def test_arguments_determine_values():
    text = '<xacro:arg name="side" default="left"/><link name="$(arg side)"/>'
    assert find_values(text) == {"$(arg side)": ("'left'",)}
    assert find_values(text, side="right") == {"$(arg side)": ("'right'",)}


def test_values_before_error_are_listed():
    assert find_values('<link name="${1 + 1}"/><link name="${missing}"/>') == {"${1 + 1}": ("2",)}


@pytest.mark.parametrize("text", ["<a", '<link name="${1 +"/>', '<xacro:include filename="missing.xacro"/>'])
def test_malformed_text_has_no_values(text):
    assert find_values(text) == {}


def test_expression_with_side_effect_is_evaluated_once():
    text = (
        '<xacro:property name="items" value="${[1, 2, 3]}"/><link name="l${items.pop(0)}"/><link name="k${items[0]}"/>'
    )
    expression_values = find_values(text)
    assert "${items.pop(0)}" not in expression_values
    assert expression_values["${items[0]}"] == ("2",)


def test_included_files_have_values(tmp_path: Path):
    (tmp_path / "part.xacro").write_text(f'{HEAD}<link name="${{p}}"/></robot>')
    main = tmp_path / "main.xacro"
    main.write_text(f'{HEAD}<xacro:property name="p" value="x"/><xacro:include filename="part.xacro"/></robot>')
    (expression,) = evaluate_expressions(Inputs(str(main), {}))
    assert (Path(expression.file).name, expression.values) == ("part.xacro", ("'x'",))


def test_macro_parameter_list_has_no_value():
    text = '<xacro:macro name="m" params="n:=${k}"><link name="${n}"/></xacro:macro><xacro:m n="a"/>'
    assert find_values(f'<xacro:property name="k" value="2"/>{text}') == {"${n}": ("'a'",)}


def test_values_before_malformed_parameter_list_remain():
    text = """<link name="${1 + 1}"/><xacro:macro name="m" params="a:='${'"/><xacro:m a="1"/>"""
    assert find_values(text) == {"${1 + 1}": ("2",)}
