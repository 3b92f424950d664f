"""The user's YAML files as nodes with locations, for findings about errors in them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    SourceText,
    Span,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import read_text

_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_MAX_DEPTH = 50
_COLON_WITHOUT_SPACE = re.compile(r"^\s*(?:- )?[A-Za-z_][\w ]*:[^\s:/]")


def read_source(path: Path, file_kind: Phrase, code: str) -> SourceText:
    """Return the text of a file that the user has named.

    Args:
        path: the path of the file.
        file_kind: the kind of the file, for the error message.
        code: the code of the error.

    Raises:
        LinkwrightError: the file does not exist, or it cannot be read.
    """
    shown_path = display_path(path)
    try:
        return SourceText(str(path), read_text(path))
    except FileNotFoundError:
        message = phrase("{kind} '{path}' does not exist", kind=file_kind, path=shown_path)
        raise LinkwrightError(Diagnostic(code, message, hint=missing_file_hint(path))) from None
    except (OSError, UnicodeDecodeError) as error:
        reason = foreign(getattr(error, "strerror", None) or error)
        message = phrase("{kind} '{path}' cannot be read: {reason}", kind=file_kind, path=shown_path, reason=reason)
        raise LinkwrightError(Diagnostic(code, message)) from None


class YamlDocument:
    """A YAML document as a tree of nodes.

    Args:
        source: the text of the document.
        code: the code of findings about the document.

    Attributes:
        root: the root node; None if the document is empty.

    Raises:
        LinkwrightError: the text is not valid YAML, or it is nested too deeply.
    """

    def __init__(self, source: SourceText, code: str) -> None:
        self.source = source
        self._code = code
        self.root: yaml.Node | None = self._compose()

    def error(self, message: Phrase, node: yaml.Node | None, hint: Phrase | None = None) -> LinkwrightError:
        """Return an error about a node, or about the entire document if `node` is None."""
        return LinkwrightError(Diagnostic(self._code, message, self.span(node), hint=hint, source=self.source))

    def span(self, node: yaml.Node | None) -> Span:
        """Return the location of a node, or the start of the document if `node` is None."""
        if node is None or node.start_mark is None or node.end_mark is None:
            return self.source.span(0, 0)
        start, end = node.start_mark, node.end_mark
        return Span(self.source.name, start.line + 1, start.column + 1, end.line + 1, end.column + 1)

    def _compose(self) -> yaml.Node | None:
        try:
            depth = 0
            for event in yaml.parse(self.source.text, Loader=_LOADER):
                depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
                if depth > _MAX_DEPTH:
                    raise self.error(
                        phrase(
                            "the document is nested more than {maximum_depth} levels deep", maximum_depth=_MAX_DEPTH
                        ),
                        None,
                    )
            return yaml.compose(self.source.text, Loader=_LOADER)
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            reason = getattr(error, "problem", None) or getattr(error, "reason", None) or str(error)
            span = None if mark is None else self.source.span(self.source.offset(mark.line + 1, mark.column + 1))
            message = phrase("the file is not valid YAML: {problem}", problem=foreign(reason))
            hint = None if mark is None else yaml_hint(self.source, mark.line + 1)
            raise LinkwrightError(Diagnostic(self._code, message, span, hint=hint, source=self.source)) from None


def yaml_hint(source: SourceText, line: int) -> Phrase | None:
    """Return a hint about the line at which a YAML parser failed, or None.

    The cause may be in the line before it.
    """
    previous_line = next((number for number in range(line - 1, 0, -1) if source.line(number).strip()), line)
    for number in (line, previous_line):
        text = source.line(number).partition("#")[0]
        if "\t" in text:
            return phrase("line {line}: indent with spaces: YAML does not allow tabs", line=number)
        if "\uff1a" in text:
            return phrase("line {line}: write ': ' in place of the full-width colon", line=number)
        if _COLON_WITHOUT_SPACE.match(text):
            return phrase("line {line}: write a space after the colon", line=number)
    if previous_line == line:
        return None
    return phrase("compare the indentation of line {line} with that of line {before}", line=line, before=previous_line)
