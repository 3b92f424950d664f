"""The texts of one other language: a folder of JSON files, one for each room.

Each file maps a code (or several, separated by blanks) to the templates of its messages and hints. A key in lower case
is a kind of phrase instead: ``hints`` and ``notes`` hold what many codes share, the others are named by the holes
that they fill, as in ``{0:owner}``.
"""

from __future__ import annotations

import json
import re
from collections import deque
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from linkwright.diagnostics.translation.templates import Table, Template

FOLDERS = {"zh": Path(__file__).parent / "zh_cn"}
"""The catalogues by language."""

FOREIGN = "foreign"
"""The kind of what other programs say (Python, the operating system), which is known in part only."""
_LENIENT = frozenset({FOREIGN, "python", "reason", "refusal"})
"""Conversions of texts that may be foreign."""

_DEEPEST = 10
"""How far phrases nest; a text that was made up to nest further stays as it is from there on."""
_BETWEEN = re.compile("(?<=')(, | or | and )(?=')")
_QUOTED = re.compile("^'(.*)'", re.DOTALL)
_REST = re.compile("(?<=') and ([0-9]+) more$")


class Catalogue:
    """The texts of one language.

    Args:
        folder: with the files.
        remember: how much of what was looked for in vain to keep in `missing`; None for all.

    Attributes:
        missing: what was looked for in vain, as (code or kind, English text).
    """

    def __init__(self, folder: Path, remember: int | None = None) -> None:
        self._pairs: dict[str, dict[str, str]] = {}
        self._tables: dict[str, Table] = {}
        self.missing: deque[tuple[str, str]] = deque(maxlen=remember)
        self._depth = 0
        for path in sorted(folder.glob("*.json")):
            for keys, pairs in json.loads(path.read_text(encoding="utf-8")).items():
                for key in keys.split():
                    self._pairs.setdefault(key, {}).update(pairs)

    def templates(self) -> Iterator[tuple[str, Template]]:
        """Every template with its code or kind."""
        for key in self._pairs:
            table = self._table(key)
            assert table is not None
            for template in table:
                yield key, template

    def text(self, text: str, *keys: str) -> str:
        """A text in this language, looked for under codes and kinds in this order; itself when it is not known."""
        found = self.find(text, *keys)
        if found is None:
            self.missing.append((keys[0], text))
            return text
        template, values = found
        return template.fill(values, self._convert)

    def find(self, text: str, *keys: str) -> tuple[Template, tuple[str, ...]] | None:
        """The template of a text with what is in its holes, or None."""
        for key in keys:
            table = self._table(key)
            found = None if table is None else table.find(text)
            if found is not None:
                return found[0], tuple(found[1])
        return None

    def _table(self, key: str) -> Table | None:
        if key not in self._tables and key in self._pairs:
            self._tables[key] = Table(self._pairs[key].items())
        return self._tables.get(key)

    def _convert(self, conversion: str, text: str) -> str:
        if self._depth == _DEEPEST:
            return text
        self._depth += 1
        try:
            return self._converted(conversion, text)
        finally:
            self._depth -= 1

    def _converted(self, conversion: str, text: str) -> str:
        if conversion == "list":
            return _listed(text)
        if conversion in _LENIENT:
            found = self.find(text, conversion, FOREIGN)
            if found is None:
                self.missing.append((FOREIGN, text))
                return text
            return found[0].fill(found[1], self._convert)
        if conversion == "several":  # several phrases of the kind 'part', separated by commas
            return "、".join(self.text(part, "part") for part in text.split(", "))
        return self.text(text, conversion)


def _listed(text: str) -> str:
    """A list such as ``'a', 'b' or 'c'``, ``'a', 'b' and 3 more``, or ``a, b, c``, with this language's signs."""
    if not text.startswith("'"):
        return text.replace(", ", "、")
    rest = _REST.search(text)
    if rest is not None:
        return f"{_listed(text[: rest.start()])}和另外 {rest[1]} 个"
    pieces = _BETWEEN.split(text)
    pieces[::2] = [_QUOTED.sub("“\\1”", piece) for piece in pieces[::2]]
    pieces[1::2] = ["或" if between == " or " else "、" for between in pieces[1::2]]
    return "".join(pieces)


@cache
def catalogue(language: str) -> Catalogue:
    """The catalogue of a language other than English; read once."""
    return Catalogue(FOLDERS[language], remember=0)
