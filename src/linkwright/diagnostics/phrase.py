"""Translatable texts, which consist of an English template and its arguments.

A `Phrase` is an ordinary string that contains the English text. To translate it, a reader looks up its template in the
catalogue of another language, and formats the result with the same arguments, which are translated if they are phrases
themselves.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linkwright.loading.lean_typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from typing_extensions import Self

TERMS = "term"
"""The context of words that tables and files hold, such as ``link``, in catalogues."""

FOREIGN = "foreign"
"""The context of texts from other programs: Python, the operating system, libraries."""

RULES = "rule"
"""The context of the titles of the pages of rules and other diagnostic codes."""


class Wording(Protocol):
    """The catalogue of a language, like gettext's translations.

    An unknown text is returned unchanged.
    """

    def gettext(self, message: str, /) -> str:
        """Return the template in this language."""

    def ngettext(self, one: str, many: str, count: int, /) -> str:
        """Return the singular or plural template for a count, in this language."""

    def pgettext(self, context: str, message: str, /) -> str:
        """Return the translation of a template that depends on the context."""


class Phrase(str):
    """An English text that can be translated; created by `phrase` and the functions after it.

    Attributes:
        template: the text with a named placeholder for each argument; without arguments, the text itself with its
            braces.
        arguments: the values of the placeholders: phrases, the user's own words, numbers.
    """

    __slots__ = ("arguments", "template")
    template: str
    arguments: Mapping[str, object]

    def __new__(cls, template: str, arguments: Mapping[str, object] | None = None) -> Self:
        """Create the phrase by filling in its template."""
        kept = {name: _kept(value) for name, value in (arguments or {}).items()}
        self = super().__new__(cls, template.format_map(kept) if kept else template)
        self.template = template
        self.arguments = kept
        return self

    def __str__(self) -> Phrase:
        """Return the phrase itself.

        The text of an exception raised with it is therefore still a phrase.
        """
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.arguments)

    def translated_text(self, wording: Wording) -> str:
        """Return the text in another language."""
        return self._filled(wording.gettext(self.template), wording) if self.template else ""

    @property
    def chosen_template(self) -> str:
        """The English template; for a phrase with singular and plural, the template for its count."""
        return self.template

    def translated(self, wording: Wording) -> Phrase:
        """Return the text in another language, with its template and arguments."""
        return _Translated(self.translated_text(wording), self)

    def _filled(self, template: str, wording: Wording) -> str:
        if not self.arguments:
            return template
        from string import Formatter  # imported here, because commands in English do not need it

        text = ""
        after_phrase = False
        for literal, name, spec, _ in Formatter().parse(template):
            text = _spaced(text, literal) if after_phrase else text + literal
            if name is None:
                continue
            value = self.arguments[name]
            after_phrase = isinstance(value, Phrase)
            if isinstance(value, Phrase):
                text = _spaced(text, value.translated_text(wording))
            else:
                text += format(value, spec or "")
        return text


class _Translated(Phrase):
    """A phrase in another language."""

    __slots__ = ("original",)
    original: Phrase

    def __new__(cls, text: str, original: Phrase) -> Self:
        self = super().__new__(cls, text)
        self.template = original.template
        self.arguments = original.arguments
        self.original = original
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (str.__str__(self), self.original)

    @property
    def chosen_template(self) -> str:
        return self.original.chosen_template

    def translated_text(self, wording: Wording) -> str:
        return self.original.translated_text(wording)


class _Counted(Phrase):
    """A phrase with a singular and a plural template."""

    __slots__ = ("several",)
    several: str

    def __new__(cls, template: str, arguments: Mapping[str, object], several: str) -> Self:
        self = super().__new__(cls, template if arguments["count"] == 1 else several, arguments)
        self.template = template
        self.several = several
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.arguments, self.several)

    @property
    def chosen_template(self) -> str:
        return self.template if self.arguments["count"] == 1 else self.several

    def translated_text(self, wording: Wording) -> str:
        count = self.arguments["count"]
        assert isinstance(count, int)
        return self._filled(wording.ngettext(self.template, self.several, count), wording)


class _Known(Phrase):
    """A text that is looked up as a whole, in a context."""

    __slots__ = ("context",)
    context: str

    def __new__(cls, template: str, context: str) -> Self:
        self = super().__new__(cls, template)
        self.context = context
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.context)

    def translated_text(self, wording: Wording) -> str:
        return wording.pgettext(self.context, self.template) if self.template else ""


class _Joined(Phrase):
    """Several texts joined with separators."""

    __slots__ = ("items", "last", "separator")
    items: tuple[str, ...]
    separator: str
    last: str

    def __new__(cls, items: tuple[str, ...], separator: str, last: str) -> Self:
        self = super().__new__(cls, _in_a_row(items, separator, last))
        self.items = items
        self.separator = separator
        self.last = last
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.items, self.separator, self.last)

    def translated_text(self, wording: Wording) -> str:
        items = [item.translated_text(wording) if isinstance(item, Phrase) else item for item in self.items]
        return _in_a_row(items, wording.pgettext(TERMS, self.separator), wording.pgettext(TERMS, self.last))


def phrase(template: str, **arguments: object) -> Phrase:
    """Return a text that can be translated.

    Args:
        template: the English text, which must be a literal, because the catalogues are checked against the literals in
            the source. Each argument has a placeholder with its name, optionally with a number format: ``{length:g}
            m``.
        arguments: the user's own words, numbers, or phrases, which are translated, too.
    """
    return Phrase(template, arguments)


def counted(one: str, several: str, count: int, **arguments: object) -> Phrase:
    """Return a translatable text with a count, whose English has a singular and a plural.

    Args:
        one: the template for the singular; ``{count}`` is the number.
        several: the template for any other number.
        count: the number.
        arguments: the other arguments of the templates.
    """
    return _Counted(one, {"count": count, **arguments}, several)


def term(word: str) -> Phrase:
    """Return a phrase for a term from a table or a file, such as the tag ``link``.

    It is translated as a whole, among the terms.
    """
    return _Known(word, TERMS)


def title_of_page(text: str) -> Phrase:
    """Return a phrase for the title of the page on a rule or diagnostic code.

    It is translated as a whole, among the titles.
    """
    return _Known(text, RULES)


def foreign(words: object) -> Phrase:
    """Return a phrase for a text of another program, such as an exception's.

    It is translated if a catalogue has it.
    """
    text = str(words)
    return text if isinstance(text, Phrase) else _Known(text, FOREIGN)


def quoted(name: object) -> Phrase:
    """Return a name in the quotation marks of the language."""
    return phrase("'{name}'", name=name)


def joined(texts: Iterable[str], separator: str = ", ", last: str | None = None) -> Phrase:
    """Join texts, as in ``a, b or c``.

    Args:
        texts: the user's own words or phrases.
        separator: the text between two items.
        last: the separator before the last item, such as ``" or "``.
    """
    return _Joined(tuple(texts), separator, separator if last is None else last)


def quoted_names(names: Iterable[object], last: str | None = None) -> Phrase:
    """Join names, each in quotation marks: ``'a', 'b' or 'c'``."""
    return joined(map(quoted, names), last=last)


def as_phrase(text: str) -> Phrase:
    """Return the text if it is a phrase, else a phrase that consists of the text."""
    return text if isinstance(text, Phrase) else Phrase(text)


def _kept(value: object) -> object:
    return value if isinstance(value, (str, int, float)) else str(value)


def _in_a_row(items: Iterable[str], separator: str, last: str) -> str:
    *first, end = items or ("",)
    return f"{separator.join(first)}{last}{end}" if first else end


def _spaced(left: str, right: str) -> str:
    """Join two texts, with a space between Latin and Chinese letters, as is usual in Chinese."""
    return f"{left} {right}" if _meet(left[-1:], right[:1]) else left + right


def _meet(left: str, right: str) -> bool:
    return (_is_latin(left, "<>)") and _is_chinese(right)) or (_is_chinese(left) and _is_latin(right, "<("))


def _is_latin(letter: str, signs: str) -> bool:
    return (letter.isascii() and letter.isalnum()) or (letter != "" and letter in signs)


def _is_chinese(letter: str) -> bool:
    return "\u4e00" <= letter <= "\u9fff"
