"""Diagnostics, errors that contain several, and their form as data."""

from __future__ import annotations

import json
import pickle

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, Severity, Span, has_errors, to_data

SPAN = Span("robot.urdf", 3, 5, 3, 9)


def test_to_data_contains_all_fields():
    diagnostic = Diagnostic("URDF121", "message", SPAN, Severity.WARNING, (Note("n", SPAN), Note("m")), "hint")
    data = to_data(diagnostic)
    assert data == {
        "code": "URDF121",
        "severity": "warning",
        "message": "message",
        "template": "message",
        "arguments": {},
        "file": "robot.urdf",
        "line": 3,
        "column": 5,
        "end_line": 3,
        "end_column": 9,
        "notes": [
            {"message": "n", "file": "robot.urdf", "line": 3, "column": 5},
            {"message": "m", "file": None, "line": None, "column": None},
        ],
        "hints": ["hint"],
    }
    assert json.loads(json.dumps(data)) == data


def test_to_data_without_span_has_null_location():
    data = to_data(Diagnostic("XML101", "no such file"))
    assert data["file"] is data["line"] is data["column"] is data["end_line"] is data["end_column"] is None
    assert data["notes"] == data["hints"] == []


def test_error_text_lists_all_diagnostics():
    error = LinkwrightError(Diagnostic("A1", "first", SPAN), Diagnostic("A2", "second"))
    assert str(error) == "robot.urdf:3:5: first\nsecond"
    assert [diagnostic.code for diagnostic in error.diagnostics] == ["A1", "A2"]


def test_error_requires_at_least_one_diagnostic():
    with pytest.raises(ValueError, match="needs a diagnostic"):
        LinkwrightError()


def test_has_errors_ignores_warnings_and_infos():
    warning, info = (Diagnostic("A1", "m", severity=severity) for severity in (Severity.WARNING, Severity.INFO))
    assert not has_errors([])
    assert not has_errors([warning, info])
    assert has_errors([warning, Diagnostic("A2", "m")])


class OtherArgumentsError(LinkwrightError):
    def __init__(self, name: str) -> None:
        super().__init__(Diagnostic("XML101", f"no file '{name}'"), Diagnostic("XML102", "nothing else"))
        self.name = name


def test_pickled_error_keeps_type_and_diagnostics():
    error = OtherArgumentsError("robot.urdf")
    received = pickle.loads(pickle.dumps(error))
    assert type(received) is OtherArgumentsError
    assert (received.name, received.diagnostics, str(received)) == ("robot.urdf", error.diagnostics, str(error))
