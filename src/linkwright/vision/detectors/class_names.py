"""Names of classes: those in a model's metadata, and those in a file of labels."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.input_files import read_text

_LARGEST = 1_000_000
"""Characters of metadata that are read as names."""


def names_in_metadata(text: str) -> tuple[str, ...] | None:
    """The classes that a model's metadata name, in order; None when they name none that can be used.

    Args:
        text: a dictionary or a list as Python writes it, which is how Ultralytics' exporters keep it. Nothing of it is
            run.
    """
    if len(text) > _LARGEST:
        return None
    try:
        return _in_order(ast.literal_eval(text))
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return None


def read_labels(path: Path) -> tuple[str, ...]:
    """The classes that a file names, in order.

    Args:
        path: a text with a name in each line; or YAML or JSON (by its ending) with a list, a mapping from numbers to
            names, or one of these below ``names``, as in the data files of YOLO.

    Raises:
        LinkwrightError: VISION108 it cannot be read, or has another form.
    """
    try:
        text = read_text(path, "utf-8-sig")
        if path.suffix.lower() not in (".yaml", ".yml", ".json"):
            return tuple(line.strip() for line in text.splitlines() if line.strip())
        document = yaml.safe_load(text)  # JSON is YAML
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        message = phrase("cannot read the labels in '{path}': {reason}", path=path, reason=foreign(reason))
        raise LinkwrightError(Diagnostic("VISION108", message)) from None
    names = _in_order(document.get("names", document) if isinstance(document, Mapping) else document)
    if names is None:
        message = phrase("there are no labels in '{path}'", path=path)
        hint = phrase("write a list of names, or a mapping from 0, 1, 2, ... to names")
        raise LinkwrightError(Diagnostic("VISION108", message, hint=hint))
    return names


def _in_order(found: Any) -> tuple[str, ...] | None:
    if isinstance(found, Mapping):
        try:
            numbered = {int(key): value for key, value in found.items()}
        except (TypeError, ValueError):
            return None
        if sorted(numbered) != list(range(len(found))):
            return None
        found = [numbered[index] for index in range(len(found))]
    if not isinstance(found, Sequence) or isinstance(found, str | bytes) or not found:
        return None
    if not all(isinstance(each, str | int | float) for each in found):
        return None
    return tuple(map(str, found))
