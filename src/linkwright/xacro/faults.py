"""A mistake found while evaluating a text, on its way to a diagnostic; and the origin of an element.

The code that finds a mistake knows the text and the offsets in it, but not the element that holds the text. So a
`Fault` starts with offsets, gets its place from the evaluation of an element's text, and a note for each property.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby

from linkwright.diagnostics import Note, Phrase, SourceText, Span, phrase, term
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.xmltree import Element, Text

_SHOWN = 10


class Frame:
    """A macro call or an include, and the one that it happened in.

    Attributes:
        macro: the macro's name, or None for an include.
        site: the element that calls or includes.
        around: the frame that the call or include happened in, or None.
        depth: how many frames there are, this one included.
    """

    __slots__ = ("around", "depth", "macro", "site")

    def __init__(self, macro: str | None, site: Element, around: Frame | None) -> None:
        self.macro = macro
        self.site = site
        self.around = around
        self.depth: int = 1 if around is None else around.depth + 1

    def note(self) -> Note:
        """Its note in a message."""
        what = (
            phrase("included from here")
            if self.macro is None
            else phrase("in macro '{macro}' called here", macro=self.macro)
        )
        return Note(what, self.site.span())


class Origin(NamedTuple):
    """Where an element of an expansion comes from.

    Attributes:
        span: where it is written; None for an element made by a program.
        trail: the macro calls and includes around it, innermost first.
    """

    span: Span | None
    trail: tuple[Note, ...]


def frames(innermost: Frame | None) -> Iterator[Frame]:
    """The frames from the innermost one outwards."""
    frame = innermost
    while frame is not None:
        yield frame
        frame = frame.around


def trail(innermost: Frame | None) -> tuple[Note, ...]:
    """The notes of all frames, innermost first; of very many, the outermost are counted only."""
    notes: list[Note] = []
    for site, group in groupby(frames(innermost), key=lambda frame: frame.site):
        repeated = list(group)
        if len(notes) == _SHOWN and repeated[0].depth > 1:
            notes.append(Note(phrase("and {depth} more calls and includes around it", depth=repeated[0].depth)))
            break
        note = repeated[0].note()
        if len(repeated) > 1:
            note = Note(phrase("{message}, {count} times", message=note.message, count=len(repeated)), site.span())
        notes.append(note)
    return tuple(notes)


def origin_of(element: Element) -> Origin:
    """Where an element of an expansion comes from."""
    frame = element.origin
    return Origin(element.span(), trail(frame if isinstance(frame, Frame) else None))


# Not compiled here: few files need them.
_COMMENT = r"(?s)<!--.*?-->"
_BLOCK = r"""<(/?)xacro:(if|unless|macro)\b(?:[^>"'/]|"[^"]*"|'[^']*'|/(?!>))*(/?)>"""
"""A tag that begins or ends a condition or a macro."""


class Elsewhere(NamedTuple):
    """Where a file defines a name that is not in effect where it is used.

    Attributes:
        note: the message and the place of the definition.
        hint: how to fix it, if that depends on why it is not in effect.
    """

    note: Note
    hint: Phrase | None = None


class Fault(Exception):  # noqa: N818 - it becomes a diagnostic, and is not part of the public errors
    """A user's mistake.

    Attributes:
        code: the diagnostic's code.
        message: the diagnostic's message.
        start: offset of the mistake in the text being evaluated, or None for all of it.
        end: where it ends (exclusive), or None.
        hint: how to fix it.
        span: the place of the mistake, once it is known.
        source: the text that the span is in.
        notes: how the evaluation reached that place, innermost first.
        passing: the text of the note for the next place on the way out, such as "property 'a' is used here".
        missing: the name of the property that is missing, if that is the mistake.
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
        self.passing = phrase("from here")
        self.missing: str | None = None

    def within(self, start: int, end: int, shift: int | None = None) -> None:
        """Seen from the text around: the mistake is inside its `start` to `end`, or at `shift` plus its offsets."""
        if self.start is None or self.end is None or shift is None:
            self.start, self.end = start, end
        else:
            self.start, self.end = self.start + shift, self.end + shift

    def place_in_attribute(self, element: Element, name: str, shift: int = 0) -> None:
        """The text is the value of an attribute, or the part of it that begins at `shift`."""
        start = None if self.start is None else self.start + shift
        end = None if self.end is None else self.end + shift
        self._place(element.source, attribute_part(element, name, start, end))

    def place_in_text(self, text: Text) -> None:
        """The text is character data."""
        self._place(text.source, text_part(text, self.start, self.end))

    def place_at(self, element: Element) -> None:
        """Place it at an element that represents a text without a source."""
        self._place(element.source, element.span())

    def elsewhere(self) -> Elsewhere | None:
        """Where the missing property is defined in the same file, in vain for this place."""
        if self.missing is None or self.source is None:
            return None
        if self.hint is not None and self.hint.startswith(f"'{self.missing}' is defined"):
            return None
        used_at = None if self.span is None else self.source.offset(self.span.line, self.span.column)
        found = definition_elsewhere(self.source, "property", self.missing, used_at=used_at)
        if found is None and (bare := definition_elsewhere(self.source, "property", self.missing, prefix="")):
            self.hint = phrase("write <xacro:property where it is defined: without the prefix the tag has no effect")
            return bare
        return found

    def _place(self, source: SourceText | None, span: Span | None) -> None:
        if self.span is None:
            self.source, self.span = source, span
        elif span is not None:
            self.notes.append(Note(self.passing, span))
        self.start = self.end = None


def definition_elsewhere(
    source: SourceText, tag: str, name: str, prefix: str = "xacro:", used_at: int | None = None
) -> Elsewhere | None:
    """Return where a file defines a name, if that is not in effect at an offset where it is used."""
    if f"<{prefix}{tag}" not in source.text:
        return None  # without compiling the patterns below
    text = re.sub(_COMMENT, lambda comment: " " * len(comment[0]), source.text)
    pattern = rf"""<{prefix}{tag}\s(?:[^>"']|"[^"]*"|'[^']*')*?\bname\s*=\s*["']{re.escape(name)}["']"""
    match = re.search(pattern, text)
    if match is None:
        return None
    values = {"tag": term(tag), "name": name}
    hint = None
    if not prefix:
        message = phrase("a {tag} '{name}' is written here without the prefix 'xacro:'", **values)
    elif used_at is not None and match.start() < used_at and _is_conditional(text[: match.start()]):
        message = phrase("a {tag} '{name}' is defined here, under a condition that does not hold", **values)
        hint = phrase("use it under the same condition, or define it for the other case, too")
    else:
        message = phrase("a {tag} '{name}' is defined here, which is too late or not in scope there", **values)
    span = source.span(match.start(), match.start() + len(f"<{prefix}{tag}"))
    return Elsewhere(Note(message, span), hint)


def _is_conditional(before: str) -> bool:
    """Whether the end of a text is inside a condition, and not inside a macro, whose definitions are its own."""
    open_tags: list[str] = []
    for closing, tag, single in re.findall(_BLOCK, before):
        if closing:
            while open_tags and open_tags.pop() != tag:
                pass
        elif not single:
            open_tags.append(tag)
    return bool(open_tags) and "macro" not in open_tags


def attribute_part(element: Element, name: str, start: int | None, end: int | None) -> Span | None:
    """The place of a part of an attribute's value, as exactly as possible."""
    from linkwright.xmltree.positions import attribute_value_range, raw_offset

    source = element.source
    if source is None:
        return None
    written = attribute_value_range(source.text, element.offset, name)
    if written is None or start is None or end is None:
        return element.attribute_span(name)
    value = element.attributes.get(name)
    raw = source.text[written[0] : written[1]]
    if raw == value:
        return source.span(written[0] + start, written[0] + end)
    if "&" not in raw and "\n" not in raw and "\t" not in raw and value is not None:
        return source.span(*written)  # a block that was evaluated: the value differs from the source
    return source.span(raw_offset(source.text, *written, start), raw_offset(source.text, *written, end))


def attribute_name(element: Element, name: str) -> Span | None:
    """The place of an attribute's name; that of the element where it has no such attribute."""
    from linkwright.xmltree.positions import attribute_name_range

    source = element.source
    if source is None:
        return None
    written = attribute_name_range(source.text, element.offset, name)
    return source.span(*written) if written else element.span()


def text_part(text: Text, start: int | None, end: int | None) -> Span | None:
    """The place of a part of some character data, as exactly as possible."""
    from linkwright.xmltree.positions import raw_offset

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
    return source.span(raw_offset(content, text.offset, limit, start), raw_offset(content, text.offset, limit, end))
