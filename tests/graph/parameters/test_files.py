"""Parameter files: values, nested names and node name wildcards."""

from __future__ import annotations

import math

import pytest

from linkwright.diagnostics import LinkwrightError, Severity, SourceText
from linkwright.graph.parameters.files import parse_parameters, parse_value, read_parameter_file


def read_rules(text: str):
    return parse_parameters(SourceText("params.yaml", text))


def parameter_values(text: str):
    return read_rules(f"/**:\n  ros__parameters:\n    {text}\n").for_node("/node")


@pytest.mark.parametrize(
    ("word", "value"),
    [
        *((word, True) for word in ("y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON")),
        *((word, False) for word in ("n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF")),
        ("yEs", "yEs"),
        ("12", 12),
        ("-3", -3),
        ("+3", 3),
        ("0x1F", 31),
        ("-0x10", -16),
        ("017", 15),
        ("08", 8.0),
        ("1_000", "1_000"),
        ("9223372036854775807", 2**63 - 1),
        ("9223372036854775808", 9223372036854775808.0),
        ("1.5", 1.5),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("1E-2", 0.01),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("+.Inf", math.inf),
        ("inf", math.inf),
        ("0x1p3", 8.0),
        ("1.2.3", "1.2.3"),
        ("null", "null"),
        ("~", "~"),
        ('"5"', "5"),
        ("'yes'", "yes"),
        ("two words", "two words"),
        ("!!str 5", "5"),
        ('""', ""),
        ("2024-01-01", "2024-01-01"),
        ("[]", []),
        ("[1, 2]", [1, 2]),
        ("[1.0, .5]", [1.0, 0.5]),
        ("[yes, no]", [True, False]),
        ("[a, 'b', \"c\"]", ["a", "b", "c"]),
    ],
)
def test_scalars_are_parsed_like_rcl(word, value):
    value_read = parameter_values(f"p: {word}")["p"]
    assert (value_read, type(value_read)) == (value, type(value))
    assert parse_value(word, "p") == value


def test_nan_is_parsed():
    assert math.isnan(parameter_values("p: .nan")["p"])
    assert math.isnan(parameter_values("p: .NaN")["p"])


def test_nested_names_are_joined_and_later_entries_override():
    rules = read_rules(
        """
talker:
  ros__parameters: {a: 1, nested: {b: {c: 2}, d: 3}}
/robot:
  talker:
    ros__parameters:
      a: 4
  left/arm:
    ros__parameters: {a: 5}
talker:
  ros__parameters: {e: 6}
"""
    )
    assert rules.for_node("/talker") == {"a": 1, "nested.b.c": 2, "nested.d": 3, "e": 6}
    assert rules.for_node("/robot/talker") == {"a": 4}
    assert rules.for_node("/robot/left/arm") == {"a": 5}
    assert rules.for_node("/listener") == {}


@pytest.mark.parametrize(
    ("pattern", "fits", "misses"),
    [
        ("/**", ["/a", "/a/b", "/a/b/c"], []),
        ("/*", ["/a"], ["/a/b"]),
        ("/**/talker", ["/talker", "/a/talker", "/a/b/talker"], ["/listener", "/talker/x"]),
        ("/*/talker", ["/a/talker"], ["/talker", "/a/b/talker"]),
        ("/ns/*/talker", ["/ns/x/talker"], ["/ns/talker", "/other/x/talker"]),
        ("/ns/**", ["/ns/a", "/ns/a/b"], ["/a"]),
        ("talker", ["/talker"], ["/a/talker"]),
        ("/**" * 300 + "/talker", ["/talker", "/a/b/talker"], ["/a/b/c/listener"]),
    ],
)
def test_node_name_wildcards_match(pattern, fits, misses):
    rules = read_rules(f"{pattern}: {{ros__parameters: {{a: 1}}}}")
    assert [name for name in [*fits, *misses] if rules.for_node(name)] == fits


def test_patterns_apply_in_order_of_appearance():
    rules = read_rules("/**: {ros__parameters: {a: 1, b: 1}}\n/node: {ros__parameters: {a: 2}}")
    assert rules.for_node("/node") == {"a": 2, "b": 1}
    later_rules = read_rules("/**: {ros__parameters: {a: 3}}")
    rules.add(later_rules)
    assert rules.for_node("/node") == {"a": 2, "b": 1}
    assert rules.for_node("/other") == {"a": 3, "b": 1}
    other = read_rules("/node: {ros__parameters: {a: 2}}")
    other.add(later_rules)
    assert other.for_node("/node") == {"a": 3}


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("[[1], [2]]", "the list of parameter 'a.b' contains a list"),
        ("[{c: 1}, 2]", "the list of parameter 'a.b' contains a mapping"),
        ("[1, {c: [{d: 1}, [2]]}, 3]", "the list of parameter 'a.b' contains a mapping"),
        ("[1, [], 3]", "the list of parameter 'a.b' contains a list"),
    ],
)
def test_unsupported_list_is_skipped_and_rest_is_read(value, message):
    any_node = f"/**:\n  ros__parameters:\n    first: 1\n    a:\n      b: {value}\n      c: [2]\n"
    rules = read_rules(f"{any_node}x:\n  ros__parameters: {{y: 3}}\n")
    assert rules.for_node("/x") == {"first": 1, "a.c": [2], "y": 3}
    (finding,) = rules.skipped_findings_for("/x")
    assert (finding.message, finding.severity) == (message, Severity.WARNING)
    assert str(finding.span).startswith("params.yaml:5:")


def test_entries_of_the_only_mapping_of_a_list_are_parameters():
    """rcl reads them so, and the example of gpio_controllers contains them."""
    text = "n:\n  ros__parameters:\n    a:\n      b:\n        - interfaces: [p, q]\n          other: [1]\n      c: 2\n"
    rules = read_rules(text)
    assert rules.for_node("/n") == {"a.b.interfaces": ["p", "q"], "a.b.other": [1], "a.c": 2}
    assert not list(rules.skipped_findings_for("/n"))


@pytest.mark.parametrize("text", ["", "# only a comment\n", "node:\n  ros__parameters:\n"])
def test_empty_files_and_sections_are_accepted(text):
    assert read_rules(text).for_node("/node") == {}


@pytest.mark.parametrize(
    ("text", "place", "message", "hint"),
    [
        (
            "node:\n  ros__parameters:\n    a: [1, 2.5]",
            "3:12",
            "the list of parameter 'a' begins with a value of type integer but contains one of type double",
            "write the first value as 1.0, or make all values integers",
        ),
        (
            "node:\n  ros__parameters:\n    a: [1.5, 2]",
            "3:14",
            "the list of parameter 'a' begins with a value of type double but contains one of type integer",
            "write 2.0",
        ),
        (
            "node:\n  ros__parameters:\n    a: [x, 2]",
            "3:12",
            "the list of parameter 'a' begins with a value of type string but contains one of type integer",
            'write "2"',
        ),
        ("node:\n  ros__parameters:\n    a:", "3:7", "parameter 'a' has no value", 'write "" for an empty string'),
        (
            "node:\n  ros_parameters:\n    a: 1",
            "3:8",
            "'a' has a value, but only parameters below 'ros__parameters' can have values",
            "did you mean 'ros__parameters'?",
        ),
        (
            "node:\n  ros__parametrs: 1",
            "2:19",
            "'ros__parametrs' has a value, but only parameters below 'ros__parameters' can have values",
            "did you mean 'ros__parameters'?",
        ),
        (
            "ros__parameters:\n  a: 1",
            "1:1",
            "there is no node name above 'ros__parameters'",
            (
                "write a mapping from node names to 'ros__parameters', and below it a mapping from parameter "
                "names to values"
            ),
        ),
        (
            "- a",
            "1:1",
            "a parameter file must be a mapping",
            (
                "write a mapping from node names to 'ros__parameters', and below it a mapping from parameter "
                "names to values"
            ),
        ),
        (
            "my-node:\n  ros__parameters:\n    a: 1",
            "1:1",
            "'my-node' is not a node name",
            "use letters, digits and '_', and do not begin with a digit; * and ** match any name",
        ),
        (
            "node:\n  ros__parameters:\n    a: &x 1\n    b: *x",
            "4:8",
            "aliases are not supported in parameter files",
            "write the value instead of the alias",
        ),
        ("node:\n  ros__parameters: 3", "2:20", "'ros__parameters' must be a mapping of names to values", None),
    ],
)
def test_invalid_file_is_reported_with_location(text, place, message, hint):
    with pytest.raises(LinkwrightError) as caught:
        read_rules(text)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.message, diagnostic.hint) == ("GRAPH212", message, hint)
    assert str(diagnostic.span) == f"params.yaml:{place}"


def test_tabs_and_yaml_errors_are_reported():
    with pytest.raises(LinkwrightError, match=r"params.yaml:2:1: parameter file is not YAML: ") as caught:
        read_rules("node:\n\tros__parameters:\n\t\ta: 1")
    assert caught.value.diagnostics[0].hint == "line 2: indent with spaces: YAML does not allow tabs"
    with pytest.raises(LinkwrightError, match="parameter file is not YAML"):
        read_rules("node: {ros__parameters: {a: [1, ")


def test_missing_file_suggests_nearest(tmp_path):
    (tmp_path / "params.yaml").write_text("node: {ros__parameters: {a: 1}}")
    assert read_parameter_file(tmp_path / "params.yaml").for_node("/node") == {"a": 1}
    with pytest.raises(LinkwrightError, match=r"param.yaml' does not exist") as caught:
        read_parameter_file(tmp_path / "param.yaml")
    assert "params.yaml" in caught.value.diagnostics[0].hint
    (tmp_path / "latin").write_bytes(b"\xff")
    for name in (".", "latin"):
        with pytest.raises(LinkwrightError, match="cannot be read"):
            read_parameter_file(tmp_path / name)


def test_command_line_values_are_parsed():
    assert parse_value("", "p") == ""
    with pytest.raises(LinkwrightError, match="the value of parameter 'p' is a mapping"):
        parse_value("{a: 1}", "p")
    with pytest.raises(LinkwrightError, match="not YAML"):
        parse_value("[", "p")
