"""Diagnostics as SARIF 2.1.0 (OASIS), the format that code scanning services read."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from pathlib import Path
from string import Formatter

from linkwright._version import __version__
from linkwright.diagnostics.diagnostic import Diagnostic, Severity, Span
from linkwright.diagnostics.phrase import Phrase, as_phrase
from linkwright.loading.lean_typing import Any

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}
_ROOT_ID = "ROOT"


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return diagnostics as the text of a SARIF log with one run.

    Files below the current folder get relative names.
    """
    diagnostic_list = list(diagnostics)
    codes = sorted({diagnostic.code for diagnostic in diagnostic_list})
    log = {
        "$schema": _SCHEMA,
        "version": "2.1.0",
        "runs": [
            {
                "tool": {
                    "driver": {
                        "name": "linkwright",
                        "version": __version__,
                        "rules": [_create_rule(code, diagnostic_list) for code in codes],
                    }
                },
                "originalUriBaseIds": {_ROOT_ID: {"uri": Path.cwd().as_uri() + "/"}},
                "columnKind": "unicodeCodePoints",
                "results": [_create_result(diagnostic, codes.index(diagnostic.code)) for diagnostic in diagnostic_list],
            }
        ],
    }
    return json.dumps(log, indent=2, ensure_ascii=False) + "\n"


def _create_rule(code: str, diagnostics: Iterable[Diagnostic]) -> dict[str, Any]:
    """Return the SARIF rule for a code, with the templates of its messages.

    The ID of a message is its English template.
    """
    messages = {
        diagnostic.message: as_phrase(diagnostic.message) for diagnostic in diagnostics if diagnostic.code == code
    }
    templates = {message.chosen_template: {"text": _number_placeholders(message)[0]} for message in messages.values()}
    return {"id": code, "messageStrings": templates}


def _create_message(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return the message of a diagnostic for SARIF (SARIF 2.1.0, 3.11).

    The message contains the text, and the template's ID and the arguments for grouping or translation.
    """
    message = as_phrase(diagnostic.message)
    hint = f". Hint: {diagnostic.hint}" if diagnostic.hint else ""
    result: dict[str, Any] = {"text": message + hint, "id": message.chosen_template}
    arguments = _number_placeholders(message)[1]
    return {**result, "arguments": arguments} if arguments else result


def _number_placeholders(message: Phrase) -> tuple[str, list[str]]:
    """Return the template of a message with numbered placeholders, and their values in order.

    SARIF uses numbers in place of names.
    """
    template = message.chosen_template
    if not message.arguments:
        return _escape_braces(template), []
    text = ""
    arguments: list[str] = []
    for literal, name, format_spec, _ in Formatter().parse(template):
        text += _escape_braces(literal)
        if name is not None:
            text += f"{{{len(arguments)}}}"
            arguments.append(format(message.arguments[name], format_spec or ""))
    return text, arguments


def _escape_braces(text: str) -> str:
    return text.replace("{", "{{").replace("}", "}}")


def _create_result(diagnostic: Diagnostic, rule_index: int) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": diagnostic.code,
        "ruleIndex": rule_index,
        "level": _LEVELS[diagnostic.severity],
        "message": _create_message(diagnostic),
    }
    if diagnostic.span is not None:
        result["locations"] = [{"physicalLocation": _create_location(diagnostic.span)}]
    related = [
        {"id": index, "message": {"text": note.message}, "physicalLocation": _create_location(note.span)}
        for index, note in enumerate(diagnostic.notes)
        if note.span is not None
    ]
    if related:
        result["relatedLocations"] = related
    return result


def _create_location(span: Span) -> dict[str, Any]:
    return {
        "artifactLocation": _create_artifact(span.file),
        "region": {
            "startLine": span.line,
            "startColumn": span.column,
            "endLine": span.end_line,
            "endColumn": span.end_column,
        },
    }


def _create_artifact(file: str) -> dict[str, str]:
    if file.startswith("<"):
        return {"uri": f"urn:linkwright:{file.strip('<>')}"}
    relative = os.path.relpath(file)
    if relative.startswith(".."):
        return {"uri": Path(file).absolute().as_uri()}
    from urllib.parse import quote

    return {"uri": quote(os.fsencode(relative.replace(os.sep, "/"))), "uriBaseId": _ROOT_ID}
