"""Comments that suppress a finding: where one is inserted, and the codes in those that exist."""

from __future__ import annotations

import ast
import io
import tokenize
from pathlib import Path

import yaml

from linkwright.diagnostics import SourceText
from linkwright.language.proof import Edit, edited
from linkwright.language.written import innermost, written_elements
from linkwright.lint.suppression import directives
from linkwright.lint.targets import XML_FILES
from linkwright.packages.readers.cmake_syntax import statements
from linkwright.xmltree.patches import line_ending
from linkwright.xmltree.tokens import Kind, tokens

REASON = "reason"
"""The text in the parentheses of a new comment, which the user replaces."""
_MAX_TEXT = 500_000
"""Characters; longer files are made by programs."""
_UNREAD = (".sdf", ".world", ".sdf.xacro", ".world.xacro")
"""Files whose findings cannot be suppressed by comments."""


def suppression(text: str, file: Path, code: str, offset: int) -> Edit | None:
    """Return the edit that inserts a comment that suppresses a finding, with a place for the reason.

    Args:
        text: the text of the file.
        file: the file.
        code: the code of the finding.
        offset: the character offset of the finding.

    Returns:
        The edit, or None if no comment can suppress it.
    """
    if file.name.endswith(_UNREAD) or not 0 <= offset <= len(text) <= _MAX_TEXT:
        return None
    is_xml = file.name.endswith((*XML_FILES, ".xml"))
    if is_xml != text.lstrip("\ufeff \t\r\n").startswith("<"):
        return None
    if is_xml:
        edits = [edit for edit in _in_xml(text, file, code, offset) if not _is_in_markup(text, edit.start)]
    else:
        edits = [edit for edit in _in_lines(text, file, code, offset) if _is_harmless(text, edit)]
    return next((edit for edit in edits if _suppresses(text, edit, code, offset)), None)


def code_at(text: str, offset: int) -> tuple[str, int] | None:
    """Return the code in a suppression comment at an offset, and where it starts; None if there is none."""
    if "linkwright:" not in text:
        return None
    for directive in directives(SourceText("", text)):
        if directive.start <= offset <= directive.end:
            for selector, start in directive.selectors:
                if start <= offset <= start + len(selector):
                    return selector, start
    return None


def _in_xml(text: str, file: Path, code: str, offset: int) -> list[Edit]:
    """Return comments to try: on a line of their own, at the end of the line, and before the element."""
    element = innermost(written_elements(text), offset)
    if element is None:
        return []
    comment = f"<!-- linkwright: ignore {code} ({REASON}) -->"
    line = text.rfind("\n", 0, element.start) + 1
    blanks = text[line : element.start]
    above = [] if blanks.strip() else [Edit(file, line, line, f"{blanks}{comment}{line_ending(text)}")]
    end = _line_end(text, offset)
    behind = [Edit(file, end, end, f" {comment}")]
    inside = [Edit(file, element.start, element.start, f"{comment} ")]
    return [*behind, *above] if element.parent is None else [*above, *behind, *inside]


def _is_in_markup(text: str, offset: int) -> bool:
    """Return whether an offset is inside of a tag, comment or CDATA section."""
    for token in tokens(text):
        if token.end > offset:
            return token.start < offset and token.kind is not Kind.TEXT
    return False


def _in_lines(text: str, file: Path, code: str, offset: int) -> list[Edit]:
    """Return comments to try: on a line of their own with the indentation of the line, and at its end."""
    comment = f"# linkwright: ignore {code} ({REASON})"
    line, end = text.rfind("\n", 0, offset) + 1, _line_end(text, offset)
    written = text[line:end]
    blanks = written[: len(written) - len(written.lstrip())]
    return [Edit(file, line, line, f"{blanks}{comment}{line_ending(text)}"), Edit(file, end, end, f"  {comment}")]


def _line_end(text: str, offset: int) -> int:
    end = text.find("\n", offset)
    end = len(text) if end < 0 else end
    return end - 1 if text[end - 1 : end] == "\r" else end


def _suppresses(text: str, edit: Edit, code: str, offset: int) -> bool:
    moved = offset + (len(edit.text) if edit.start <= offset else 0)
    new = edited(text, [edit])
    return any(directive.suppresses(code, moved) for directive in directives(SourceText("", new)))


def _is_harmless(text: str, edit: Edit) -> bool:
    """Return whether a comment changes nothing in the meaning of a file, whose format must be known."""
    return _meaning(text, edit.file) == _meaning(edited(text, [edit]), edit.file)


def _meaning(text: str, file: Path) -> object:
    """Return what a file means apart from its comments; the text itself if its format is not known."""
    try:
        if file.name.endswith(".py"):
            kinds = (tokenize.COMMENT, tokenize.NL)
            words = [word for word in tokenize.generate_tokens(io.StringIO(text).readline) if word.type not in kinds]
            return ast.dump(ast.parse(text)), len(words)
        if file.name.endswith((".yaml", ".yml")):
            events = yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
            return [(type(event), getattr(event, "value", None)) for event in events]
        if file.name == "CMakeLists.txt":
            return [(one.name, [word.text for word in one.tokens]) for one in statements(SourceText("", text))]
    except (SyntaxError, ValueError, RecursionError, MemoryError, tokenize.TokenError, yaml.YAMLError):
        return text
    return text
