"""Suppress findings by comments in the files.

``<!-- linkwright: ignore LW204 limit-inverted (reason) -->`` on its own line applies to the following element with its
content. On a line with other content, the comment applies to this line. ``ignore-file`` applies to the whole file. In
files that are not XML, the comment begins with ``#``. A comment without codes suppresses all findings.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, SourceText, phrase
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Edit, Fix
from linkwright.lint.registry import find_rule
from linkwright.lint.selector_words import is_selector, make_selector_hint, to_canonical
from linkwright.lint.selectors import matches
from linkwright.lint.settings import Settings
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.xmltree import Element
from linkwright.xmltree.decoding import decode
from linkwright.xmltree.patches import extend_to_whole_lines, find_element_range
from linkwright.xmltree.reader import read_bytes

UNUSED_CODE = "LW001"
UNKNOWN_CODE = "LW002"

_DIRECTIVE = r"linkwright:[ \t]*(?P<verb>ignore(?:-file)?)(?![\w-])"
_XML_COMMENT = lazy_pattern(rf"<!--\s*{_DIRECTIVE}(?P<selectors>[^(]*?)(?:\((?:(?!-->).)*\)\s*)?-->", re.DOTALL)
_LINE_COMMENT = lazy_pattern(rf"#[ \t]*{_DIRECTIVE}(?P<selectors>[^(\n]*?)(?:\(.*)?$", re.MULTILINE)
_NEXT_TAG = lazy_pattern(r"<!--.*?-->|<\?.*?\?>|<!\[CDATA\[.*?\]\]>|<(?P<tag>[^\s/>!?]+)|</", re.DOTALL)
_SELECTOR = lazy_pattern(r"[^\s,]+")


@dataclass(slots=True)
class Directive:
    """One suppression comment.

    Attributes:
        source: the text that contains the comment.
        start: the character offset of the comment.
        end: the character offset after the comment.
        selectors: the selectors in the comment, each with its offset; empty if the comment suppresses everything.
        ranges: the ranges of character offsets to which the comment applies, or None for the whole file.
        used_selectors: the selectors that suppressed a finding.
    """

    source: SourceText
    start: int
    end: int
    selectors: tuple[tuple[str, int], ...]
    ranges: tuple[tuple[int, int], ...] | None
    used_selectors: set[str] = field(default_factory=set)

    def suppresses(self, code: str, offset: int) -> bool:
        """Return whether the comment suppresses a finding with a code at an offset.

        The selectors that match are recorded as used.
        """
        if self.ranges is not None and not any(start <= offset < end for start, end in self.ranges):
            return False
        if not self.selectors:
            self.used_selectors.add("")
            return True
        matching_selectors = [selector for selector, _ in self.selectors if matches([to_canonical(selector)], code)]
        self.used_selectors.update(matching_selectors)
        return bool(matching_selectors)


class Suppressions:
    """The suppression comments of all files that a check reads.

    Args:
        subject: the subject of the check, whose files are searched for comments.
        settings: the settings, which determine whether unused and unknown suppressions are reported.
    """

    def __init__(self, subject: Subject, settings: Settings) -> None:
        self._settings = settings
        self._overlay = subject.description.overlay
        unused_rule = find_rule(UNUSED_CODE)
        self._reports_unused = unused_rule is not None and settings.runs(unused_rule) and subject.is_whole
        self._directives: dict[str, list[Directive]] = {}
        for path, document in subject.sources.items():
            if document.source is not None:
                self._directives[str(path)] = list(find_directives(document.source))

    def apply(self, diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Return the diagnostics that no comment suppresses, and the findings about the comments."""
        reported = [diagnostic for diagnostic in diagnostics if not self._suppresses(diagnostic)]
        return [*reported, *self._unknown_selector_findings(), *self._unused_comment_findings()]

    def needs_findings_of(self, code: str) -> bool:
        """Return whether the findings with a code are needed, even if not selected.

        Such findings show whether a comment that suppresses them is used.
        """
        if not self._reports_unused:
            return False
        return any(
            not directive.selectors or matches([to_canonical(selector) for selector, _ in directive.selectors], code)
            for directive in self._all_directives()
        )

    def _suppresses(self, diagnostic: Diagnostic) -> bool:
        return any(
            directive.suppresses(diagnostic.code, offset)
            for file, offset in _find_locations(diagnostic)
            for directive in self._file_directives(file)
        )

    def _file_directives(self, file: str) -> list[Directive]:
        if file not in self._directives:
            text = None if self._overlay is None else self._overlay.text(file)
            try:
                text = decode(read_bytes(file), file) if text is None else text
            except LinkwrightError:
                text = ""
            self._directives[file] = list(find_directives(SourceText(file, text)))
        return self._directives[file]

    def _all_directives(self) -> Iterator[Directive]:
        for file_directives in self._directives.values():
            yield from file_directives

    def _unknown_selector_findings(self) -> Iterator[Diagnostic]:
        rule = find_rule(UNKNOWN_CODE)
        if rule is None or not self._settings.runs(rule):
            return
        for directive in self._all_directives():
            for selector, offset in directive.selectors:
                if is_selector(selector):
                    continue
                yield rule.report(
                    phrase("there is no rule '{selector}' to ignore", selector=selector),
                    span=directive.source.span(offset, offset + len(selector)),
                    source=directive.source,
                    hint=make_selector_hint(selector),
                )

    def _unused_comment_findings(self) -> Iterator[Diagnostic]:
        rule = find_rule(UNUSED_CODE)
        if rule is None or not self._reports_unused:
            return
        for directive in self._all_directives():
            selectors = [selector for selector, _ in directive.selectors if is_selector(selector)] or [""]
            unused_selectors = [word for word in selectors if word not in directive.used_selectors]
            if not unused_selectors or (directive.selectors and selectors == [""]):
                continue
            suppressed = ", ".join(f"'{word}'" for word in unused_selectors if word) or "anything"
            fix = None
            if len(unused_selectors) == max(len(directive.selectors), 1):
                fix = Fix((_removal_edit(directive),))
            yield rule.report(
                phrase("this comment suppresses {findings}, but no such finding occurs here", findings=suppressed),
                span=directive.source.span(directive.start, directive.end),
                source=directive.source,
                hint=phrase("remove it") if fix else phrase("remove {findings} from this comment", findings=suppressed),
                fix=fix,
            )


def find_directives(source: SourceText) -> Iterator[Directive]:
    """Yield the suppression comments of a text in source order."""
    text = source.text
    if "linkwright:" not in text:
        return
    is_xml = text.lstrip("\ufeff \t\r\n").startswith("<")
    for match in (_XML_COMMENT if is_xml else _LINE_COMMENT).finditer(text):
        selectors = tuple(
            (selector[0], match.start("selectors") + selector.start())
            for selector in _SELECTOR.finditer(match["selectors"])
        )
        ranges = (
            None
            if match["verb"] == "ignore-file"
            else _find_suppressed_ranges(text, match.start(), match.end(), is_xml)
        )
        yield Directive(source, match.start(), match.end(), selectors, ranges)


def _find_suppressed_ranges(text: str, start: int, end: int, is_xml: bool) -> tuple[tuple[int, int], ...]:
    line_start = text.rfind("\n", 0, start) + 1
    line_end = text.find("\n", end)
    line_end = len(text) if line_end < 0 else line_end + 1
    text_before, text_after = text[line_start:start].strip(), text[end:line_end].strip()
    line = (line_start, line_end)
    if text_before or not is_xml:
        return (line,) if text_before else (_find_following_line(text, line_end),)
    following_range = _find_following_element(text, end)
    if following_range is None:
        return (line,) if text_after else ()
    return (line, following_range) if text_after else (following_range,)


def _find_following_line(text: str, start: int) -> tuple[int, int]:
    end = text.find("\n", start)
    return start, len(text) if end < 0 else end + 1


def _find_following_element(text: str, end: int) -> tuple[int, int] | None:
    match = _NEXT_TAG.search(text, end)
    while match is not None and match["tag"] is None and match[0] != "</":
        match = _NEXT_TAG.search(text, match.end())
    if match is None or match["tag"] is None:
        return None
    return find_element_range(Element(match["tag"], source=SourceText("", text), offset=match.start()))


def _find_locations(diagnostic: Diagnostic) -> Iterator[tuple[str, int]]:
    """Yield the file and character offset of a finding and of the calls that produced it.

    The calls are the macro calls and includes that contain the finding's element.
    """
    if diagnostic.span is not None:
        if diagnostic.source is not None and diagnostic.source.name == diagnostic.span.file:
            source = diagnostic.source
        else:
            source = _read_source(diagnostic.span.file)
        yield diagnostic.span.file, source.offset(diagnostic.span.line, diagnostic.span.column)
    if not isinstance(diagnostic, Finding) or diagnostic.element is None or diagnostic.element.origin is None:
        return
    from linkwright.xacro.faults import Frame, frames

    innermost = diagnostic.element.origin
    for frame in frames(innermost if isinstance(innermost, Frame) else None):
        if frame.site.source is not None:
            yield frame.site.source.name, frame.site.offset


def _read_source(file: str) -> SourceText:
    try:
        return SourceText(file, Path(file).read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return SourceText(file, "")


def _removal_edit(directive: Directive) -> Edit:
    text, start, end = directive.source.text, directive.start, directive.end
    lines = extend_to_whole_lines(text, start, end)
    if lines != (start, end):
        return Edit(directive.source.name, *lines, "")
    while start and text[start - 1] in " \t":
        start -= 1
    return Edit(directive.source.name, start, end, "")
