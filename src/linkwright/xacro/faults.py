"""Mistakes that occur when a text is evaluated, and the origin of elements.

The code that finds a mistake has the text and the offsets in it, but not the element that contains the text.
Therefore, a `Fault` first has offsets only. The code that evaluates the text of an element adds the location, and
each property on the way adds a note.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby

from linkwright.diagnostics import Diagnostic, Note, Phrase, SourceText, Span, phrase, term
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xmltree import Element, Text

_MAX_NOTES = 10


class Frame:
    """A macro call or an include, with the frame that encloses it.

    Attributes:
        macro: the macro's name, or None for an include.
        site: the element that calls the macro or includes the file.
        outer: the frame of the enclosing call or include, or None.
        depth: the number of frames up to and including this one.
    """

    __slots__ = ("depth", "macro", "outer", "site")

    def __init__(self, macro: str | None, site: Element, outer: Frame | None) -> None:
        self.macro = macro
        self.site = site
        self.outer = outer
        self.depth: int = 1 if outer is None else outer.depth + 1

    def note(self) -> Note:
        """Return a note on this call or include for a message."""
        text = (
            phrase("included from here")
            if self.macro is None
            else phrase("in macro '{macro}' called here", macro=self.macro)
        )
        return Note(text, self.site.span())


class Origin(NamedTuple):
    """The origin of an element of an expansion.

    Attributes:
        span: the location where the element is written, or None for an element created by a program.
        trail: notes on the enclosing macro calls and includes, innermost first.
    """

    span: Span | None
    trail: tuple[Note, ...]


def frames(innermost: Frame | None) -> Iterator[Frame]:
    """Yield the frames from the innermost to the outermost."""
    frame = innermost
    while frame is not None:
        yield frame
        frame = frame.outer


def trail(innermost: Frame | None) -> tuple[Note, ...]:
    """Return notes on all frames, innermost first.

    If there are very many frames, the outermost frames are only counted.
    """
    notes: list[Note] = []
    for site, same_site_frames in groupby(frames(innermost), key=lambda frame: frame.site):
        same_site = list(same_site_frames)
        if len(notes) == _MAX_NOTES and same_site[0].depth > 1:
            notes.append(Note(phrase("and {depth} more enclosing calls and includes", depth=same_site[0].depth)))
            break
        note = same_site[0].note()
        if len(same_site) > 1:
            note = Note(phrase("{message}, {count} times", message=note.message, count=len(same_site)), site.span())
        notes.append(note)
    return tuple(notes)


def origin_of(element: Element) -> Origin:
    """Return the origin of an element of an expansion."""
    frame = element.origin
    return Origin(element.span(), trail(frame if isinstance(frame, Frame) else None))


# These patterns are compiled on first use, because few files need them.
_COMMENT = r"(?s)<!--.*?-->"
_CONDITION_OR_MACRO_TAG = r"""<(/?)xacro:(if|unless|macro)\b(?:[^>"'/]|"[^"]*"|'[^']*'|/(?!>))*(/?)>"""
"""A tag that begins or ends a condition or a macro."""


class InactiveDefinition(NamedTuple):
    """A definition of a name that is not in effect where the name is used.

    Attributes:
        note: the message and the location of the definition.
        hint: advice for fixing the mistake, or None if the definition does not determine the fix.
    """

    note: Note
    hint: Phrase | None = None


class Fault(Exception):  # noqa: N818 - it becomes a diagnostic, and is not part of the public errors
    """Raised when a text that is evaluated contains a mistake.

    Attributes:
        code: the diagnostic's code.
        message: the diagnostic's message.
        start: the offset of the mistake in the text being evaluated, or None for the whole text.
        end: the offset after the mistake, or None for the whole text.
        hint: advice for fixing the mistake.
        span: the location of the mistake, or None until it is known.
        source: the text that contains the span.
        notes: notes on how the evaluation reached this location, innermost first.
        next_note: the text of the note for the next enclosing location, such as "property 'a' is used here".
        missing_name: the name of the missing property, or None for other mistakes.
    """

    def __init__(
        self, code: str, message: Phrase, start: int | None = None, end: int | None = None, hint: Phrase | None = None
    ) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.start = start
        self.end = end
        self.hint = hint
        self.span: Span | None = None
        self.source: SourceText | None = None
        self.notes: list[Note] = []
        self.next_note = phrase("from here")
        self.missing_name: str | None = None

    def shift_to_enclosing_text(self, start: int, end: int, shift: int | None = None) -> None:
        """Convert the offsets to offsets in the enclosing text.

        If `shift` is given and the offsets are known, `shift` is added to them. If not, the mistake extends from
        `start` to `end`.
        """
        if self.start is None or self.end is None or shift is None:
            self.start, self.end = start, end
        else:
            self.start, self.end = self.start + shift, self.end + shift

    def locate_in_attribute(self, element: Element, name: str, shift: int = 0) -> None:
        """Set the location to an attribute's value, or add a note if the location is already set.

        `shift` is the offset of the evaluated text in the value.
        """
        start = None if self.start is None else self.start + shift
        end = None if self.end is None else self.end + shift
        self._add_location(element.source, attribute_span(element, name, start, end))

    def locate_in_text(self, text: Text) -> None:
        """Set the location to character data, or add a note if the location is already set."""
        self._add_location(text.source, text_part_span(text, self.start, self.end))

    def locate_at(self, element: Element) -> None:
        """Set the location to an element, for an evaluated text without a source."""
        self._add_location(element.source, element.span())

    def find_inactive_definition(self) -> InactiveDefinition | None:
        """Return a definition of the missing property that is not in effect here, or None.

        Only the same file is searched. A definition without the xacro prefix also changes the hint.
        """
        if self.missing_name is None or self.source is None:
            return None
        if self.hint is not None and self.hint.startswith(f"'{self.missing_name}' is defined"):
            return None
        used_at = None if self.span is None else self.source.offset(self.span.line, self.span.column)
        definition = inactive_definition(self.source, "property", self.missing_name, used_at=used_at)
        if definition is None and (
            unprefixed := inactive_definition(self.source, "property", self.missing_name, prefix="")
        ):
            self.hint = phrase("write <xacro:property where it is defined: without the prefix the tag has no effect")
            return unprefixed
        return definition

    def _add_location(self, source: SourceText | None, span: Span | None) -> None:
        if self.span is None:
            self.source, self.span = source, span
        elif span is not None:
            self.notes.append(Note(self.next_note, span))
        self.start = self.end = None


def inactive_definition(
    source: SourceText, tag: str, name: str, prefix: str = "xacro:", used_at: int | None = None
) -> InactiveDefinition | None:
    """Return a definition of a name in a file that is not in effect at an offset, or None."""
    if f"<{prefix}{tag}" not in source.text:
        return None  # return early to avoid compiling the patterns below
    text, definitions = _find_definitions(source.text, prefix + tag)
    start = definitions.get(name)
    if start is None:
        return None
    values = {"tag": term(tag), "name": name}
    hint = None
    if not prefix:
        message = phrase("a {tag} '{name}' is written here without the prefix 'xacro:'", **values)
    elif used_at is not None and start < used_at and _is_conditional(text[:start]):
        message = phrase("a {tag} '{name}' is defined here, under a condition that does not hold", **values)
        hint = phrase("use it under the same condition, or also define it for the other case")
    else:
        message = phrase("a {tag} '{name}' is defined here, but after its use or outside its scope", **values)
    span = source.span(start, start + len(f"<{prefix}{tag}"))
    return InactiveDefinition(Note(message, span), hint)


@lru_cache(maxsize=16)
def _find_definitions(text: str, tag: str) -> tuple[str, dict[str, int]]:
    """Return a text without its comments, and the offset of the first element by name.

    Only elements with the given tag are considered.

    Spaces replace the comments, so that offsets stay valid.

    The result is stored, because a description whose arguments are missing has hundreds of undefined names.
    """
    text = re.sub(_COMMENT, lambda comment: " " * len(comment[0]), text)
    pattern = rf"""<{tag}\s(?:[^>"']|"[^"]*"|'[^']*')*?\bname\s*=\s*(?:"([^"]*)"|'([^']*)')"""
    definitions: dict[str, int] = {}
    for match in re.finditer(pattern, text):
        definitions.setdefault(match[1] or match[2] or "", match.start())
    return text, definitions


def _is_conditional(preceding_text: str) -> bool:
    """Return whether a text ends inside a condition that is not inside a macro.

    Definitions inside a macro are local.
    """
    open_tags: list[str] = []
    for closing_slash, tag, self_closing_slash in re.findall(_CONDITION_OR_MACRO_TAG, preceding_text):
        if closing_slash:
            while open_tags and open_tags.pop() != tag:
                pass
        elif not self_closing_slash:
            open_tags.append(tag)
    return bool(open_tags) and "macro" not in open_tags


def attribute_span(element: Element, name: str, start: int | None, end: int | None) -> Span | None:
    """Return the location of a part of an attribute's value, as exactly as possible, or None."""
    from linkwright.xmltree.positions import attribute_value_range, find_raw_offset

    source = element.source
    if source is None:
        return None
    value_range = attribute_value_range(source.text, element.offset, name)
    if value_range is None or start is None or end is None:
        return element.attribute_span(name)
    value = element.attributes.get(name)
    raw_value = source.text[value_range[0] : value_range[1]]
    if raw_value == value:
        return source.span(value_range[0] + start, value_range[0] + end)
    if "&" not in raw_value and "\n" not in raw_value and "\t" not in raw_value and value is not None:
        return source.span(*value_range)  # the value differs from the source, such as in a block that was evaluated
    return source.span(
        find_raw_offset(source.text, *value_range, start), find_raw_offset(source.text, *value_range, end)
    )


def attribute_name_span(element: Element, name: str) -> Span | None:
    """Return the location of an attribute's name, or of the element if it lacks the attribute.

    The result is None if the element was created by a program.
    """
    from linkwright.xmltree.positions import attribute_name_range

    source = element.source
    if source is None:
        return None
    name_range = attribute_name_range(source.text, element.offset, name)
    return source.span(*name_range) if name_range else element.span()


def text_part_span(text: Text, start: int | None, end: int | None) -> Span | None:
    """Return the location of a part of some character data, as exactly as possible, or None."""
    from linkwright.xmltree.positions import find_raw_offset

    source = text.source
    if source is None:
        return None
    content = source.text
    limit = content.find("<", text.offset)
    limit = len(content) if limit < 0 else limit
    if start is None or end is None:
        return source.span(text.offset, limit)
    if content.startswith(text.data, text.offset):
        return source.span(text.offset + start, text.offset + end)
    return source.span(
        find_raw_offset(content, text.offset, limit, start), find_raw_offset(content, text.offset, limit, end)
    )


def find_xml_hint(diagnostic: Diagnostic) -> Phrase | None:
    """Return the hint of an XML error, or None.

    For an undeclared prefix ``xacro``, the hint is the namespace declaration.
    """
    if diagnostic.code == "XML205" and diagnostic.message.startswith("the prefix 'xacro'"):
        return phrase('declare it on the root element: xmlns:xacro="http://www.ros.org/wiki/xacro"')
    return diagnostic.hint
