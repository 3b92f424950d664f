"""Substitutions in the text of XML and YAML launch files."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from launch.frontend.expose import expose_substitution
from launch.frontend.parse_substitution import parse_if_substitutions, parse_substitution
from launch.substitutions import (
    AllSubstitution,
    AnySubstitution,
    EnvironmentVariable,
    PathJoinSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFileDir,
)
from launch.utilities import perform_substitutions

from launch import LaunchContext, Substitution
from linkwright.diagnostics import LinkwrightError


class FixedSubstitution(Substitution):
    def __init__(self, text: str) -> None:
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text


@expose_substitution("said")
def parse_fixed(data):
    return FixedSubstitution, {"text": "|".join("".join(part.perform(None) for part in word) for word in data)}


def substitution_texts(value: str) -> list[str]:
    return [part.perform(LaunchContext()) for part in parse_substitution(value)]


@pytest.mark.parametrize(
    ("written", "parts"),
    [
        ("", [""]),
        ("plain 'text' with \"quotes\" 10e4", ["plain 'text' with \"quotes\" 10e4"]),
        ("a_$(said b)_c_$(said d)", ["a_", "b", "_c_", "d"]),
        ("$0 $1 $", ["$0 $1 $"]),
        ("$(said '$0 $1')", ["$0 $1"]),
        (r"\$(said b)", ["$(said b)"]),
        (r"$(said what/\$\(x y\\\)) 10)", [r"what/$(x|y\)", " 10)"]),
        ("$(said what/$(said x) 10) 10)", ["what/x|10", " 10)"]),
        ("$(said 'something $(said 10)')", ["something 10"]),
        (r'$(said "a_$(said \"b\")" "$(said c)_d")', ['a_"b"|c_d']),
        ("$(said \"a_$(said 'b')\" '$(said c)_d')", ["a_'b'|c_d"]),
        ("$(said  a   b )", ["a|b"]),
        ("$(said '' a)", ["|a"]),
    ],
)
def test_text_is_split_into_substitutions(written: str, parts: list[str]) -> None:
    assert substitution_texts(written) == parts


def test_substitution_names_map_to_classes() -> None:
    [environment] = parse_substitution("$(env NAME 'a b')")
    assert isinstance(environment, EnvironmentVariable)
    assert environment.name[0].perform(None) == "NAME"
    assert environment.default_value[0].perform(None) == "a b"
    [environment_variable] = parse_substitution("$(env NAME)")
    assert environment_variable.default_value is None
    assert isinstance(parse_substitution("$(dirname)")[0], ThisLaunchFileDir)
    assert isinstance(parse_substitution("$(path-join a b)")[0], PathJoinSubstitution)
    assert isinstance(parse_substitution("$(any 1 0)")[0], AnySubstitution)
    assert isinstance(parse_substitution("$(all)")[0], AllSubstitution)


@pytest.mark.parametrize(
    ("written", "value"),
    [
        (r"$(eval '\'asd\' + \'bsd\'')", "asdbsd"),
        ('$(eval "ceil(1.3)")', "2"),
        ('$(eval "math.ceil(1.3)" "math")', "2"),
        ('$(eval "math.isfinite(sys.maxsize)" " math,sys ")', "True"),
        ("$(and true $(not false))", "true"),
        ("$(or 0 off)", "false"),
        ("$(equals 10 10.0)", "true"),
        ("$(not-equals nan nan)", "true"),
        ("$(if on yes no)", "yes"),
        ("$(string-join . a b$(said c))", "a.bc"),
        ("$(string-strip '  a ')", "a"),
        ("$(is-empty '')$(not-empty '')", "truefalse"),
        ("$(path-join a 'b c' d)", "a/b c/d"),
    ],
)
def test_substitutions_are_evaluated(written: str, value: str) -> None:
    assert perform_substitutions(LaunchContext(), parse_substitution(written)) == value


def test_eval_without_module_raises_name_error() -> None:
    [expression] = parse_substitution('$(eval "ceil(1.3)" "")')
    assert isinstance(expression, PythonExpression)
    with pytest.raises(NameError):
        expression.perform(LaunchContext())


def test_anon_returns_same_name_for_same_id() -> None:
    context = LaunchContext()
    first, second, other = (
        parse_substitution(text)[0].perform(context) for text in ("$(anon a)", "$(anon a)", "$(anon b)")
    )
    assert first == second != other
    assert first.startswith("a_")


@pytest.mark.parametrize(
    ("written", "message", "hint"),
    [
        ("$(var x", "has no closing parenthesis", "add ')' at its end"),
        ("$( var x)", "'$(' is not followed by a name", None),
        ("$(said 'a)", "the quote ' is not closed", None),
        ("$(said a(b))", "'('", "put quotes around the argument"),
        ("$(said a'b')", "there is an unexpected quote in an argument, after 'a'", "quote the whole argument"),
        ("$(vra x)", "there is no substitution 'vra'", "did you mean 'var'?"),
        ("$(not a b)", "not substitution expects 1 argument", None),
        ("$(env)", "env substitution expects 1 or 2 arguments", None),
        ("$(path-join)", "expects at least 1 argument", None),
    ],
)
def test_malformed_substitutions_are_rejected(written: str, message: str, hint: str | None) -> None:
    with pytest.raises(LinkwrightError) as raised:
        parse_substitution(written)
    [diagnostic] = raised.value.diagnostics
    assert diagnostic.code == "LAUNCH119"
    assert message in diagnostic.message
    if hint:
        assert hint in (diagnostic.hint or "")


def test_grammar_errors_have_documented_exception_types() -> None:
    with pytest.raises(RuntimeError, match="Unknown substitution: vra"):
        parse_substitution("$(vra x)")
    with pytest.raises(ValueError, match="cannot be parsed"):
        parse_substitution("$(var x")
    with pytest.raises(SubstitutionFailure):
        parse_substitution("$(not maybe)")[0].perform(LaunchContext())


def test_parse_if_substitutions_keeps_plain_values() -> None:
    assert parse_if_substitutions(1) == 1
    assert parse_if_substitutions("a") == "a"
    assert len(parse_if_substitutions("[$(said a), $(said b)]")) == 5
    mixed = parse_if_substitutions(["$(said a)", 1])
    assert isinstance(mixed[0][0], FixedSubstitution)
    assert mixed[1] == 1
    with pytest.raises(ValueError, match="non-uniform"):
        parse_if_substitutions(["$(said a)", 1, 1.0])


@given(st.text(max_size=40))
def test_escaped_text_round_trips(text: str) -> None:
    escaped = "".join("\\" + character if character in "\\$" else character for character in text)
    assert "".join(substitution_texts(escaped)) == text


@given(st.text(alphabet="$()'\" \\avr", max_size=25))
def test_arbitrary_text_is_parsed_or_rejected_with_diagnostic(text: str) -> None:
    try:
        parts = parse_substitution(text)
    except LinkwrightError as error:
        assert error.diagnostics[0].code == "LAUNCH119"  # noqa: PT017 - either is fine
    else:
        assert all(isinstance(part, Substitution) for part in parts)


@given(st.lists(st.text(alphabet="ab c'\"\\$()", max_size=6), max_size=4))
def test_quoted_arguments_round_trip(words: list[str]) -> None:
    def quoted(word: str) -> str:
        return "'" + "".join("\\" + character if character in "'\\$" else character for character in word) + "'"

    [part] = (
        parse_substitution("$(said " + " ".join(map(quoted, words)) + ")") if words else [TextSubstitution(text="")]
    )
    assert part.perform(LaunchContext()) == "|".join(words)
