"""The reasons why no edit of the text makes exactly the requested change."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.descriptions.editing.text_ranges import TextRange
from linkwright.diagnostics import Diagnostic, Note, display_path, joined, phrase
from linkwright.loading.lean_dataclasses import dataclass

_MAX_NAMES = 6


@dataclass(frozen=True, slots=True)
class Attempt:
    """A candidate whose edit failed.

    Attributes:
        text_range: the range of the candidate's text.
        side_effects: the names of the other parts that the edit would change.
        forbidden: the reason why the file must not be written, or None.
        is_choice: whether the text is a factor that selects a side.
        may_be_choice: whether the text may be such a factor.
        fails_to_expand: whether the description could not be expanded with the edit.
    """

    text_range: TextRange
    side_effects: tuple[str, ...] = ()
    forbidden: Diagnostic | None = None
    is_choice: bool = False
    may_be_choice: bool = False
    fails_to_expand: bool = False


def refusal(text_range: TextRange, index: int | None, attempts: Sequence[Attempt], tag: str = "") -> Diagnostic:
    """Return the finding with the reason why an edit is refused.

    Args:
        text_range: the range of the attribute's text, or the position at which it would be added.
        index: the index of the number that cannot be changed, or None for an attribute that is missing.
        attempts: the failed candidates, in the order in which they were tried.
        tag: the tag of the element that would be added.
    """
    text = " ".join(text_range.text.split())
    attempts_by_span = {
        attempt.text_range.span: attempt
        for attempt in attempts
        if attempt.text_range != text_range and (attempt.side_effects or attempt.is_choice)
    }
    notes = tuple(map(_make_attempt_note, attempts_by_span.values()))[:_MAX_NAMES]
    best_attempt = min(
        (attempt for attempt in attempts if attempt.side_effects),
        key=lambda attempt: (len(attempt.side_effects), attempt.may_be_choice),
        default=None,
    )
    forbidden = next((attempt.forbidden for attempt in attempts if attempt.forbidden is not None), None)
    if best_attempt is not None:
        names_text = _join_names(best_attempt.side_effects)
        hint = phrase(
            "add a parameter or property for this part to the macro or expression here, or change the "
            "text for all of these parts"
        )
        if index is None:
            message = phrase("adding <{tag}> here would also change {parts}", tag=tag, parts=names_text)
        else:
            message = phrase(
                "another number in '{expression}' would also change {parts}", expression=text, parts=names_text
            )
        return Diagnostic("EDIT104", message, text_range.span, notes=notes, hint=hint, source=text_range.source)
    if forbidden is not None:
        return forbidden
    message = phrase("no number gives '{expression}' the requested value", expression=text)
    hint = phrase("write a number, or a sum that contains a number, in place of the expression")
    return Diagnostic("EDIT105", message, text_range.span, notes=notes, hint=hint, source=text_range.source)


def _make_attempt_note(attempt: Attempt) -> Note:
    text = " ".join(attempt.text_range.text.split())
    if attempt.is_choice:
        return Note(
            phrase("'{text}' is a factor that selects a side, so it is not changed", text=text),
            attempt.text_range.span,
        )
    return Note(
        phrase("'{text}' also determines {parts}", text=text, parts=_join_names(attempt.side_effects)),
        attempt.text_range.span,
    )


def _join_names(names: Sequence[str]) -> object:
    shown_names = list(names[:_MAX_NAMES])
    if len(names) > len(shown_names):
        shown_names.append(str(phrase("{count} more", count=len(names) - len(shown_names))))
    return joined(shown_names)


def forbidden_file(path: str, reason: object) -> Diagnostic:
    """Return the finding that a file must not be written."""
    message = phrase("'{path}' is not written: {reason}", path=display_path(path), reason=reason)
    hint = phrase("open the description from your own workspace, or change a copy of the file")
    return Diagnostic("EDIT106", message, hint=hint)


def changed_file(path: str) -> Diagnostic:
    """Return the finding that a file is not written because another program has changed it."""
    message = phrase(
        "another program has changed '{path}' since it was read, so it is not written", path=display_path(path)
    )
    return Diagnostic("EDIT107", message, hint=phrase("check the current robot, and repeat the edit"))
