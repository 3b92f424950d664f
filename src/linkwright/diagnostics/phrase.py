"""Translatable texts: an English template with its arguments.

A `Phrase` is an ordinary string that contains the English text. For another language, the template is looked up in
that language's catalog and formatted with the same arguments. Arguments that are phrases are translated as
well.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linkwright.loading.lean_typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from typing_extensions import Self

TERMS = "term"
"""The context of terms from tables and files, such as ``link``, in catalogs."""

FOREIGN = "foreign"
"""The context of texts from other programs: Python, the operating system and libraries."""

RULES = "rule"
"""The context of titles of pages about rules and other diagnostic codes."""


class Catalog(Protocol):
    """The catalog of a language, with the interface of gettext's translations.

    A text that the catalog lacks is returned unchanged.
    """

    def gettext(self, message: str, /) -> str:
        """Return the translation of a template."""

    def ngettext(self, one: str, many: str, count: int, /) -> str:
        """Return the translation of a singular or plural template for a count."""

    def pgettext(self, context: str, message: str, /) -> str:
        """Return the translation of a template that depends on the context."""


class Phrase(str):
    """An English text that can be translated, created by the functions of this module.

    Attributes:
        template: the text with a named placeholder for each argument; without arguments, the literal text.
        arguments: the values of the placeholders: phrases, names from the user's input, and numbers.
    """

    __slots__ = ("arguments", "template")
    template: str
    arguments: Mapping[str, object]

    def __new__(cls, template: str, arguments: Mapping[str, object] | None = None) -> Self:
        """Create the phrase by filling in its template."""
        values = {name: _to_argument(value) for name, value in (arguments or {}).items()}
        self = super().__new__(cls, template.format_map(values) if values else template)
        self.template = template
        self.arguments = values
        return self

    def __str__(self) -> Phrase:
        """Return the phrase itself.

        Therefore, the text of an exception that was raised with a phrase is still a phrase.
        """
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.arguments)

    def translated_text(self, catalog: Catalog) -> str:
        """Return the text in another language."""
        return self._fill(catalog.gettext(self.template), catalog) if self.template else ""

    def with_arguments(self, **arguments: object) -> Phrase:
        """Return the phrase with new values; values for unknown arguments are ignored."""
        changes = {name: value for name, value in arguments.items() if name in self.arguments}
        result: Phrase = type(self)(self.template, {**self.arguments, **changes}, *self.__reduce__()[1][2:])
        return result

    @property
    def chosen_template(self) -> str:
        """The English template.

        For a counted phrase, this is the singular or the plural, depending on the count.
        """
        return self.template

    def translated(self, catalog: Catalog) -> Phrase:
        """Return the phrase with its text in another language, and the same template and arguments."""
        return _Translated(self.translated_text(catalog), self)

    def _fill(self, template: str, catalog: Catalog) -> str:
        if not self.arguments:
            return template
        from string import Formatter  # imported here, because commands in English do not need it

        text = ""
        after_phrase = False
        for literal, name, spec, _ in Formatter().parse(template):
            text = _join_spaced(text, literal) if after_phrase else text + literal
            if name is None:
                continue
            value = self.arguments[name]
            after_phrase = isinstance(value, Phrase)
            if isinstance(value, Phrase):
                text = _join_spaced(text, value.translated_text(catalog))
            else:
                text += format(value, spec or "")
        return text


class _Translated(Phrase):
    """A phrase with its text in another language."""

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

    def translated_text(self, catalog: Catalog) -> str:
        return self.original.translated_text(catalog)


class _Counted(Phrase):
    """A phrase with a singular and a plural template."""

    __slots__ = ("plural",)
    plural: str

    def __new__(cls, template: str, arguments: Mapping[str, object], plural: str) -> Self:
        self = super().__new__(cls, template if arguments["count"] == 1 else plural, arguments)
        self.template = template
        self.plural = plural
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.arguments, self.plural)

    @property
    def chosen_template(self) -> str:
        return self.template if self.arguments["count"] == 1 else self.plural

    def translated_text(self, catalog: Catalog) -> str:
        count = self.arguments["count"]
        assert isinstance(count, int)
        return self._fill(catalog.ngettext(self.template, self.plural, count), catalog)


class _ContextPhrase(Phrase):
    """A text that is translated as a whole, in a context of the catalog."""

    __slots__ = ("context",)
    context: str

    def __new__(cls, template: str, context: str) -> Self:
        self = super().__new__(cls, template)
        self.context = context
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.template, self.context)

    def translated_text(self, catalog: Catalog) -> str:
        return catalog.pgettext(self.context, self.template) if self.template else ""


class _Foreign(_ContextPhrase):
    """A text of another program.

    The catalog contains the text unchanged, or with ``'…'`` for each quoted part.
    """

    __slots__ = ()

    def translated_text(self, catalog: Catalog) -> str:
        text = super().translated_text(catalog)
        parts = self.template.split("'")
        if text != self.template or len(parts) % 2 == 0:
            return text
        quoted_parts = parts[1::2]
        parts[1::2] = [_ELLIPSIS] * len(quoted_parts)
        pattern = "'".join(parts)
        translation = catalog.pgettext(self.context, pattern)
        if translation == pattern or translation.count(_ELLIPSIS) != len(quoted_parts):
            return text
        ends = translation.split(_ELLIPSIS)
        return ends[0] + "".join(part + end for part, end in zip(quoted_parts, ends[1:], strict=True))


_ELLIPSIS = "…"


class _Joined(Phrase):
    """Several texts, joined with separators."""

    __slots__ = ("items", "last", "separator")
    items: tuple[str, ...]
    separator: str
    last: str

    def __new__(cls, items: tuple[str, ...], separator: str, last: str) -> Self:
        self = super().__new__(cls, _join_items(items, separator, last))
        self.items = items
        self.separator = separator
        self.last = last
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[object, ...]]:
        return type(self), (self.items, self.separator, self.last)

    def translated_text(self, catalog: Catalog) -> str:
        items = [item.translated_text(catalog) if isinstance(item, Phrase) else item for item in self.items]
        return _join_items(items, catalog.pgettext(TERMS, self.separator), catalog.pgettext(TERMS, self.last))


def phrase(template: str, **arguments: object) -> Phrase:
    """Return a text that can be translated.

    Args:
        template: the English text. It must be a literal, because the catalogs are checked against the literals in the
            source. Each argument has a placeholder with its name, optionally with a number format: ``{length:g} m``.
        arguments: names from the user's input, numbers, or phrases; phrases are translated as well.
    """
    return Phrase(template, arguments)


def counted(singular: str, plural: str, count: int, **arguments: object) -> Phrase:
    """Return a translatable text with a count, which selects the singular or the plural.

    Args:
        singular: the template for the singular; ``{count}`` is the number.
        plural: the template for any other number.
        count: the number that selects the template.
        arguments: the other arguments of the templates.
    """
    return _Counted(singular, {"count": count, **arguments}, plural)


def term(word: str) -> Phrase:
    """Return a phrase for a term from a table or a file, such as the tag ``link``.

    The term is translated as a whole, with the context for terms.
    """
    return _ContextPhrase(word, TERMS)


def title_of_page(text: str) -> Phrase:
    """Return a phrase for the title of the page about a rule or diagnostic code.

    The title is translated as a whole, with the context for titles.
    """
    return _ContextPhrase(text, RULES)


def foreign(words: object) -> Phrase:
    """Return a phrase for a text from another program, such as an exception's.

    The text is translated if a catalog contains it, as it is or with ``'…'`` for each part in quotation marks.
    """
    text = str(words)
    return text if isinstance(text, Phrase) else _Foreign(text, FOREIGN)


def quoted(name: object) -> Phrase:
    """Return a name in the quotation marks of the language."""
    return phrase("'{name}'", name=name)


def joined(texts: Iterable[str], separator: str = ", ", last: str | None = None) -> Phrase:
    """Join texts, as in ``a, b or c``.

    Args:
        texts: phrases, or names from the user's input.
        separator: the text between two items.
        last: the separator before the last item, such as ``" or "``; None for `separator`.
    """
    return _Joined(tuple(texts), separator, separator if last is None else last)


def joined_first(texts: Iterable[str], limit: int) -> Phrase:
    """Join the first `limit` texts, and add the number of the others: ``a, b and 3 more``.

    A single other text is joined, too.
    """
    all_texts = list(texts)
    shown = count_shown(len(all_texts), limit)
    shown_texts = joined(all_texts[:shown])
    if len(all_texts) == shown:
        return shown_texts
    return phrase("{names} and {count} more", names=shown_texts, count=len(all_texts) - shown)


def count_shown(count: int, limit: int) -> int:
    """Return how many of some items to show: at most a limit, and one more instead of ``and 1 more``."""
    return count if count <= limit + 1 else limit


def quoted_names(names: Iterable[object], last: str | None = None) -> Phrase:
    """Join names, each in quotation marks: ``'a', 'b' or 'c'``."""
    return joined(map(quoted, names), last=last)


def listed_items(text: object) -> tuple[str, ...]:
    """Return the texts that `joined` joined, or nothing for any other text."""
    return text.items if isinstance(text, _Joined) else ()


def as_phrase(text: str) -> Phrase:
    """Return the text if it is a phrase, else a phrase that consists of the text."""
    return text if isinstance(text, Phrase) else Phrase(text)


def _to_argument(value: object) -> object:
    return value if isinstance(value, (str, int, float)) else str(value)


def _join_items(items: Iterable[str], separator: str, last: str) -> str:
    *leading, final = items or ("",)
    return f"{separator.join(leading)}{last}{final}" if leading else final


def _join_spaced(left: str, right: str) -> str:
    """Join two texts, with a space between a Latin and a Chinese letter, as usual in Chinese."""
    return f"{left} {right}" if _needs_space(left[-1:], right[:1]) else left + right


def _needs_space(left: str, right: str) -> bool:
    return (_is_latin(left, "<>)") and _is_chinese(right)) or (_is_chinese(left) and _is_latin(right, "<("))


def _is_latin(letter: str, signs: str) -> bool:
    return (letter.isascii() and letter.isalnum()) or (letter != "" and letter in signs)


def _is_chinese(letter: str) -> bool:
    return "\u4e00" <= letter <= "\u9fff"
