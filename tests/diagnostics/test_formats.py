"""The forms of diagnostics for programs."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import Diagnostic, Note, Severity, SourceText
from linkwright.diagnostics.formats import FORMATS, format_diagnostics


@pytest.fixture
def found(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    source = SourceText(str(tmp_path / "my robots" / "r,1.urdf"), "ab\ncdé\n")
    note = Note("defined: here,\nsee 100%", source.span(0, 2))
    return [
        Diagnostic("LW201", "50% is\nwrong: a,b", source.span(3, 6), Severity.ERROR, (note,), "do: this", source),
        Diagnostic("XML101", "no file", None, Severity.WARNING, (Note("no place"),)),
        Diagnostic("XAC704", "hello", SourceText("<stdin>", "x").span(0, 1), Severity.INFO),
    ]


def test_concise_is_a_line_each(found):
    assert format_diagnostics(found, "concise").splitlines() == [
        "my robots/r,1.urdf:2:1: error[LW201] 50% is wrong: a,b (do: this)",
        "warning[XML101] no file",
        "<stdin>:1:1: info[XAC704] hello",
    ]


def test_json_is_an_object_with_a_list(found, tmp_path):
    data = json.loads(format_diagnostics(found, "json"))
    assert list(data) == ["diagnostics"]
    file = str(tmp_path / "my robots" / "r,1.urdf")
    assert data["diagnostics"][0] == {
        "code": "LW201",
        "severity": "error",
        "message": "50% is\nwrong: a,b",
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


def test_github_commands_are_escaped(found):
    first, second, third = format_diagnostics(found, "github").splitlines()
    assert first == (
        "::error file=my robots/r%2C1.urdf,line=2,endLine=2,col=1,endColumn=3,title=LW201"
        "::50%25 is%0Awrong: a,b%0Anote: defined: here,%0Asee 100%25 (my robots/r,1.urdf:1:1)%0Ahint: do: this"
    )
    assert second == "::warning title=XML101::no file%0Anote: no place"
    assert third == "::notice title=XAC704::hello"


def test_sarif_has_what_the_standard_requires(found):
    log = json.loads(format_diagnostics(found, "sarif"))
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == ["LW201", "XAC704", "XML101"]
    assert run["tool"]["driver"]["name"] == "linkwright"
    assert run["columnKind"] == "unicodeCodePoints"
    assert run["originalUriBaseIds"]["ROOT"]["uri"].endswith("/")
    first, second, third = run["results"]
    assert [each["level"] for each in run["results"]] == ["error", "warning", "note"]
    assert all(rules[each["ruleIndex"]] == each["ruleId"] for each in run["results"])
    assert first["locations"][0]["physicalLocation"] == {
        "artifactLocation": {"uri": "my%20robots/r%2C1.urdf", "uriBaseId": "ROOT"},
        "region": {"startLine": 2, "startColumn": 1, "endLine": 2, "endColumn": 4},
    }
    assert first["relatedLocations"][0]["message"] == {"text": "defined: here,\nsee 100%"}
    assert "locations" not in second
    assert third["locations"][0]["physicalLocation"]["artifactLocation"]["uri"] == "urn:linkwright:stdin"


def test_no_diagnostics_are_a_whole_document_too():
    assert format_diagnostics([], "concise") == format_diagnostics([], "github") == ""
    assert json.loads(format_diagnostics([], "json")) == {"diagnostics": []}
    assert json.loads(format_diagnostics([], "sarif"))["runs"][0]["results"] == []


def test_text_is_not_written_here():
    assert FORMATS[0] == "text"
    with pytest.raises(ValueError, match="no format"):
        format_diagnostics([], "text")
    with pytest.raises(ValueError, match="no format"):
        format_diagnostics([], "xml")
