"""Format a comparison as text for users and as data for programs."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.descriptions.comparison.compare import Comparison
from linkwright.descriptions.comparison.difference import Difference, DifferenceLocation
from linkwright.diagnostics import Phrase, Span, counted, phrase, term
from linkwright.diagnostics.translation import localized
from linkwright.loading.lean_typing import Any

Label = Callable[[str], str]
"""A function that returns the name of a file for users."""


def as_text(comparison: Comparison, label: Label) -> str:
    """Return a line for each difference, followed by its locations, in the user's language.

    Args:
        comparison: the differences.
        label: a function that returns the name of a file for users.
    """
    differences = comparison.differences
    if not differences:
        return localized(phrase("no differences")) + "\n"
    lines = []
    for difference in differences:
        locations = [
            _format_location(location, label)
            for location in (difference.old_place, difference.new_place)
            if location is not None
        ]
        lines += [localized(sentence(difference)), *(["  " + " -> ".join(locations)] if locations else [])]
    lines.append(localized(counted("{count} difference", "{count} differences", len(differences))))
    return "\n".join(lines) + "\n"


def sentence(difference: Difference, title: tuple[Phrase, str] | None = None) -> Phrase:
    """Return a description of a change in one line.

    Args:
        difference: the change.
        title: the kind and the name of the changed object; None for those of the difference.
    """
    subject, name = title or (term(difference.subject), difference.name)
    if difference.kind == "added":
        return phrase("{subject} '{name}' added", subject=subject, name=name)
    if difference.kind == "removed":
        return phrase("{subject} '{name}' removed", subject=subject, name=name)
    if difference.kind == "renamed":
        return phrase("{subject} '{old}' renamed to '{name}'", subject=subject, old=difference.old or "", name=name)
    return phrase(
        "{subject} '{name}': {property} {old} -> {new}",
        subject=subject,
        name=name,
        property=difference.property,
        old=_format_value(difference.old),
        new=" ".join(filter(None, (_format_value(difference.new), difference.unit))),
    )


def _format_value(value: str | None) -> str:
    """Return a value, ``-`` for none, and quotation marks for an empty one."""
    return "-" if value is None else value or "''"


def as_data(comparison: Comparison, label: Label) -> list[dict[str, Any]]:
    """Return the differences as JSON-ready data.

    Lines and columns start at 1, and are None if there is no location.
    """
    return [
        {
            "subject": difference.subject,
            "name": difference.name,
            "kind": difference.kind,
            "property": difference.property,
            "old": difference.old,
            "new": difference.new,
            "unit": difference.unit,
            "old_place": _convert_location(difference.old_place, label),
            "new_place": _convert_location(difference.new_place, label),
        }
        for difference in comparison.differences
    ]


def _convert_location(location: DifferenceLocation | None, label: Label) -> dict[str, Any] | None:
    if location is None:
        return None
    return {**_convert_span(location.span, label), "calls": [_convert_span(call, label) for call in location.calls]}


def _convert_span(span: Span, label: Label) -> dict[str, Any]:
    return {"file": label(span.file), "line": span.line, "column": span.column}


def _format_location(location: DifferenceLocation, label: Label) -> str:
    """Return a location as text, with the innermost call or include that produced the element.

    Outer calls are only in the data for programs.
    """
    position = _format_position(location.span, label)
    if not location.calls:
        return position
    return localized(
        phrase("{location} called at {call}", location=position, call=_format_position(location.calls[0], label))
    )


def _format_position(span: Span, label: Label) -> str:
    return f"{label(span.file)}:{span.line}:{span.column}"
