"""Class names from a model's metadata or from a label file."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.files.input_files import read_text

_MAX_METADATA_LENGTH = 1_000_000
"""The maximum length of metadata in characters. Longer text is not parsed."""
_FORMAT_HINT = phrase("write one name per line, or YAML with a list of names or a mapping from 0, 1, 2, ... to names")


def parse_metadata_names(text: str) -> tuple[str, ...] | None:
    """Return the class names in a model's metadata, in order, or None if they are not usable.

    Args:
        text: a Python literal of a dictionary or a list, as Ultralytics' exporters write it. It is never executed.
    """
    if len(text) > _MAX_METADATA_LENGTH:
        return None
    try:
        return _order_names(ast.literal_eval(text))
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None


def read_labels(path: Path) -> tuple[str, ...]:
    """Read the class names in a label file, in order.

    Args:
        path: a text file with one name per line; or a YAML or JSON file (by its suffix) with a list, a mapping from
            numbers to names, or either of them below ``names``, as in the data files of YOLO.

    Raises:
        LinkwrightError: VISION108, the file cannot be read or has another format.
    """
    try:
        text = read_text(path, "utf-8-sig")
        if path.suffix.lower() in (".yaml", ".yml", ".json"):
            document = yaml.safe_load(text)  # every JSON file is also YAML
        else:
            document = [line.strip() for line in text.splitlines() if line.strip()]
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        message = phrase("cannot read the labels in '{path}': {reason}", path=path, reason=_describe_read_error(error))
        raise LinkwrightError(Diagnostic("VISION108", message, hint=_FORMAT_HINT)) from None
    names = _order_names(document.get("names", document) if isinstance(document, Mapping) else document)
    if names is None:
        message = phrase("there are no labels in '{path}'", path=path)
        raise LinkwrightError(Diagnostic("VISION108", message, hint=_FORMAT_HINT))
    return names


def _describe_read_error(error: OSError | UnicodeDecodeError | yaml.YAMLError) -> Phrase:
    if isinstance(error, OSError):
        return foreign(error.strerror or error)
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        mark = error.problem_mark
        return phrase(
            "line {line}, column {column}: {problem}",
            line=mark.line + 1,
            column=mark.column + 1,
            problem=foreign(error.problem),
        )
    return phrase("it is not text in UTF-8") if isinstance(error, UnicodeDecodeError) else foreign(error)


def _order_names(names_or_mapping: Any) -> tuple[str, ...] | None:
    if isinstance(names_or_mapping, Mapping):
        try:
            names_by_number = {int(key): value for key, value in names_or_mapping.items()}
        except (TypeError, ValueError):
            return None
        if sorted(names_by_number) != list(range(len(names_or_mapping))):
            return None
        names_or_mapping = [names_by_number[index] for index in range(len(names_or_mapping))]
    if not isinstance(names_or_mapping, Sequence) or isinstance(names_or_mapping, str | bytes) or not names_or_mapping:
        return None
    if not all(isinstance(name, str | int | float) for name in names_or_mapping):
        return None
    return tuple(map(str, names_or_mapping))
