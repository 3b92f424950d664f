"""The values of the expressions in a file, in all its descriptions and argument sets."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.language.includes import real_path
from linkwright.language.workspace import Workspace
from linkwright.xacro.faults import Frame, frames
from linkwright.xacro.session import Inputs
from linkwright.xacro.tracing.values import Evaluation, evaluate_expressions
from linkwright.xmltree import Overlay

_MAX_EXPANSIONS = 12
"""The maximum number of expansions for the values of one file."""
_MAX_VALUES = 8
_MAX_INLINE_VALUES = 3
_MAX_CALLS = 2
_MAX_NAMES = 6
_MAX_LABEL = 60
"""The maximum number of characters of a macro call, or of the values in an inlay hint."""


@dataclass(slots=True)
class EvaluatedText:
    """A text with expressions, or one of its expressions, with the values.

    Attributes:
        start: the character offset of the text.
        end: the offset after its last character.
        evaluations: the evaluations, each with the arguments of the description that differ from the defaults.
    """

    start: int
    end: int
    evaluations: list[tuple[Evaluation, Mapping[str, str]]] = field(default_factory=list)

    def values(self) -> list[str]:
        """Return the distinct values in Python notation, in the order of their first evaluations."""
        return list(dict.fromkeys(evaluation.value for evaluation, _ in self.evaluations))


def evaluate_file(workspace: Workspace, texts: Mapping[Path, str], file: Path) -> list[EvaluatedText]:
    """Return the values of the texts with expressions in a file, in no particular order.

    Args:
        workspace: the folders that the editor has opened.
        texts: the texts of the open files.
        file: a description, or a file that descriptions include.
    """
    overlay = Overlay({str(path): text for path, text in texts.items()})
    evaluated_texts: dict[tuple[int, int], EvaluatedText] = {}
    calls = (
        (entry, values)
        for entry in workspace.index.entries(file, texts)
        for values, _ in workspace.argument_calls(entry)
    )
    for _, (entry, values) in zip(range(_MAX_EXPANSIONS), calls, strict=False):
        inputs = Inputs(str(entry), values, workspace.finder(entry), overlay=overlay)
        for expression in evaluate_expressions(inputs):
            if real_path(expression.file) == file:
                key = expression.start, expression.end
                text = evaluated_texts.setdefault(key, EvaluatedText(*key))
                text.evaluations += [(evaluation, values) for evaluation in expression.evaluations]
    return list(evaluated_texts.values())


def find_value_at(texts: Sequence[EvaluatedText], offset: int) -> EvaluatedText | None:
    """Return the smallest text with values around an offset, or None if there is none."""
    texts_at_offset = [text for text in texts if text.start <= offset <= text.end and text.values()[0]]
    return min(texts_at_offset, key=lambda text: text.end - text.start, default=None)


def outermost_texts(texts: Sequence[EvaluatedText]) -> Iterator[EvaluatedText]:
    """Yield the texts that are not part of another text, in text order.

    Args:
        texts: the texts of a file, as `evaluate_file` returns them.
    """
    end = 0
    for text in sorted(texts, key=lambda text: (text.start, -text.end)):
        if text.start >= end:
            end = text.end
            yield text


def shorten_values(text: EvaluatedText) -> str:
    """Return the first values of a text on one line, for an inlay hint."""
    values = [value[1:-1] if value[:1] in ("'", '"') else value for value in text.values() if value]
    short_text = " | ".join(values[:_MAX_INLINE_VALUES]) + (" | ..." if len(values) > _MAX_INLINE_VALUES else "")
    return _shorten(short_text)


def describe_values(text: EvaluatedText, source: str) -> str:
    """Return the values of a text in Markdown, each with its macro calls or arguments.

    Args:
        text: a text with expressions, and its evaluations.
        source: the text as written.
    """
    groups: dict[tuple[str, str], list[tuple[Evaluation, Mapping[str, str]]]] = {}
    for evaluation, arguments in text.evaluations:
        names = ", ".join(f"`{name}` = `{value}`" for name, value in evaluation.names[:_MAX_NAMES])
        groups.setdefault((evaluation.value, names), []).append((evaluation, arguments))
    if len(groups) == 1:
        ((value, names),) = groups
        return f"`{source}` = `{value}`" + (f" ({names})" if names else "")
    lines = [
        f"- `{value}`{_describe_origin(evaluations)}" + (f" ({names})" if names else "")
        for (value, names), evaluations in [*groups.items()][:_MAX_VALUES]
    ]
    if len(groups) > _MAX_VALUES:
        lines.append("- ...")
    return f"`{source}`\n\n" + "\n".join(lines)


def _describe_origin(evaluations: Sequence[tuple[Evaluation, Mapping[str, str]]]) -> str:
    """Return the macro calls that lead to a value, and the arguments other than defaults."""
    calls = [call for call in dict.fromkeys(_describe_call(evaluation.frame) for evaluation, _ in evaluations) if call]
    origin = f" {', '.join(calls[:_MAX_CALLS])}" + (", ..." if len(calls) > _MAX_CALLS else "")
    arguments = evaluations[0][1]
    if arguments and all(values for _, values in evaluations):
        origin += f" `{_shorten(' '.join(f'{name}:={value}' for name, value in arguments.items()))}`"
    return "" if origin == " " else origin


def _describe_call(frame: Frame | None) -> str:
    """Return the innermost macro call with its file and line, or empty outside macros."""
    call = next((frame for frame in frames(frame) if frame.macro is not None), None)
    if call is None:
        return ""
    call_text = " ".join([call.macro or "", *(f'{name}="{value}"' for name, value in call.site.attributes.items())])
    span = call.site.span()
    return f"`{_shorten(call_text)}`" + ("" if span is None else f" ({Path(span.file).name}:{span.line})")


def _shorten(text: str) -> str:
    return text if len(text) <= _MAX_LABEL else f"{text[: _MAX_LABEL - 3]}..."
