"""The machine-readable formats of diagnostics."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import Diagnostic, Note, Severity, SourceText, counted, phrase, term
from linkwright.diagnostics.formats import FORMATS, format_diagnostics
from linkwright.diagnostics.translation.translate import set_language


@pytest.fixture
def diagnostics(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    source = SourceText(str(tmp_path / "my robots" / "r,1.urdf"), "ab\ncdé\n")
    note = Note("defined: here,\nsee 100%", source.span(0, 2))
    return [
        Diagnostic("LW201", "50% is\nwrong: a,b", source.span(3, 6), Severity.ERROR, (note,), "do: this", source),
        Diagnostic("XML101", "no file", None, Severity.WARNING, (Note("no place"),)),
        Diagnostic("XAC704", "hello", SourceText("<stdin>", "x").span(0, 1), Severity.INFO),
    ]


def test_concise_prints_one_line_per_diagnostic(diagnostics):
    assert format_diagnostics(diagnostics, "concise").splitlines() == [
        "my robots/r,1.urdf:2:1: error[LW201] 50% is wrong: a,b (do: this)",
        "warning[XML101] no file",
        "<stdin>:1:1: info[XAC704] hello",
    ]


def test_json_is_object_with_diagnostics_list(diagnostics, tmp_path):
    data = json.loads(format_diagnostics(diagnostics, "json"))
    assert list(data) == ["diagnostics"]
    file = str(tmp_path / "my robots" / "r,1.urdf")
    assert data["diagnostics"][0] == {
        "code": "LW201",
        "severity": "error",
        "message": "50% is\nwrong: a,b",
        "template": "50% is\nwrong: a,b",
        "arguments": {},
        "file": file,
        "line": 2,
        "column": 1,
        "end_line": 2,
        "end_column": 4,
        "notes": [{"message": "defined: here,\nsee 100%", "file": file, "line": 1, "column": 1}],
        "hints": ["do: this"],
    }
    assert data["diagnostics"][1]["file"] is None
    assert data["diagnostics"][1]["hints"] == []


def test_github_commands_are_escaped(diagnostics):
    first, second, third = format_diagnostics(diagnostics, "github").splitlines()
    assert first == (
        "::error file=my robots/r%2C1.urdf,line=2,endLine=2,col=1,endColumn=3,title=LW201"
        "::50%25 is%0Awrong: a,b%0Anote: defined: here,%0Asee 100%25 (my robots/r,1.urdf:1:1)%0Ahint: do: this"
    )
    assert second == "::warning title=XML101::no file%0Anote: no place"
    assert third == "::notice title=XAC704::hello"


def test_sarif_contains_required_fields(diagnostics):
    log = json.loads(format_diagnostics(diagnostics, "sarif"))
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == ["LW201", "XAC704", "XML101"]
    assert run["tool"]["driver"]["name"] == "linkwright"
    assert run["columnKind"] == "unicodeCodePoints"
    assert run["originalUriBaseIds"]["ROOT"]["uri"].endswith("/")
    first, second, third = run["results"]
    assert [result["level"] for result in run["results"]] == ["error", "warning", "note"]
    assert all(rules[result["ruleIndex"]] == result["ruleId"] for result in run["results"])
    assert first["locations"][0]["physicalLocation"] == {
        "artifactLocation": {"uri": "my%20robots/r%2C1.urdf", "uriBaseId": "ROOT"},
        "region": {"startLine": 2, "startColumn": 1, "endLine": 2, "endColumn": 4},
    }
    assert first["relatedLocations"][0]["message"] == {"text": "defined: here,\nsee 100%"}
    assert "locations" not in second
    assert third["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "urn:linkwright:stdin"


def _made_of_templates():
    return [
        Diagnostic("LW201", phrase("{kind} '{name}' is {share:.0%} off", kind=term("link"), name="a{b}", share=0.5)),
        Diagnostic("LW201", counted("{count} link", "{count} links of {robot}", 3, robot="r2")),
        Diagnostic("LW202", phrase("write ${x}")),
    ]


@pytest.fixture(params=["en", "zh"])
def lang(request):
    set_language(request.param)
    yield request.param
    set_language(None)


@pytest.mark.usefixtures("lang")
def test_json_contains_template_and_arguments():
    data = json.loads(format_diagnostics(_made_of_templates(), "json"))["diagnostics"]
    assert [(diagnostic["template"], diagnostic["arguments"]) for diagnostic in data] == [
        ("{kind} '{name}' is {share:.0%} off", {"kind": "link", "name": "a{b}", "share": 0.5}),
        ("{count} links of {robot}", {"count": 3, "robot": "r2"}),
        ("write ${x}", {}),
    ]


@pytest.mark.usefixtures("lang")
def test_sarif_results_reference_rule_message_strings():
    diagnostics = _made_of_templates()
    (run,) = json.loads(format_diagnostics(diagnostics, "sarif"))["runs"]
    rules = run["tool"]["driver"]["rules"]
    for result, diagnostic in zip(run["results"], diagnostics, strict=True):
        message = result["message"]
        template = rules[result["ruleIndex"]]["messageStrings"][message["id"]]["text"]
        assert template.format(*message.get("arguments", [])) == diagnostic.message
    assert [len(rule["messageStrings"]) for rule in rules] == [2, 1]


def test_empty_list_is_complete_document_in_all_formats():
    assert format_diagnostics([], "concise") == format_diagnostics([], "github") == ""
    assert json.loads(format_diagnostics([], "json")) == {"diagnostics": []}
    assert json.loads(format_diagnostics([], "sarif"))["runs"][0]["results"] == []


def test_unsupported_formats_are_rejected():
    assert FORMATS[0] == "text"
    with pytest.raises(ValueError, match="no format"):
        format_diagnostics([], "text")
    with pytest.raises(ValueError, match="no format"):
        format_diagnostics([], "xml")
