"""Hold the Chinese messages and the source together: what is said and not translated, and what is said no more.

Usage: python tools/messages.py [--check] [CODE ...]

Without ``--check`` it prints the messages, notes and hints of the program, or of these codes, as JSON in the form of
the catalogues, with their translations so far. With ``--check`` it names the texts that lack a translation and the
translations that no text needs, and exits with 1 when there are any.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from linkwright.diagnostics.translation.catalogue import FOLDERS, FOREIGN, Catalogue

sys.path.insert(0, str(Path(__file__).resolve().parent))

from message_templates import Said, Templates

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "linkwright"
_FILLER = re.compile(r"[⟦⟧\d\s,.:;'\"()/<>=%-]*")
_OPEN_KINDS = frozenset({FOREIGN, "python", "reason", "meaning", "unit", "count", "searched", "part", "owner", "kind"})
"""Kinds of phrases that the source puts together while it runs; the tests that run it tell whether they are known."""


class Check:
    """The catalogue of one language against the texts of the source."""

    def __init__(self, folder: Path, said: Sequence[Said]) -> None:
        self._catalogue = Catalogue(folder)
        self._said = said

    def missing(self) -> Iterator[str]:
        """Every text that has no translation, or whose translation has a part that has none."""
        seen = set()
        for each in self._said:
            text = filled(each.template)
            self._catalogue.missing.clear()
            self._catalogue.text(text, *_keys(each))
            found = self._catalogue.find(text, *_keys(each))
            swallowed = () if found is None else found[0].kept(found[1])
            english = [("a hole", value) for value in swallowed if re.search("[a-z]{3} [a-z]{2}", value)]
            for key, part in [*self._catalogue.missing, *english]:
                if not _FILLER.fullmatch(part) and (key, part) not in seen:
                    seen.add((key, part))
                    shown = re.sub(r"⟦\d+⟧", "{}", part)
                    yield f'{each.place}: {each.kind} {each.code}: {key} lacks "{shown}"'

    def stale(self) -> Iterator[str]:
        """Every translation of a code or shared text that nothing in the source is matched by."""
        used, phrases, known = set(), set(), {}
        kinds = _OPEN_KINDS | {name for _, each in self._catalogue.templates() for name in each.conversions}
        kinds = {name for name in kinds if name.islower()}  # a code may be one too: it has texts of its own
        for key, template in self._catalogue.templates():
            pair = template.english, template.translation
            known[pair] = key
            if key in kinds:
                phrases.add(pair)
        for each in self._said:
            for key in _keys(each):
                found = self._catalogue.find(filled(each.template), key)
                if found:
                    used.add((found[0].english, found[0].translation))
        for pair, key in known.items():
            if pair not in used and pair not in phrases and re.search("[A-Za-z]", pair[0]):
                yield f'{key}: nothing says "{pair[0]}"'

    def translation(self, said: Said) -> str:
        """The translation of a text, or an empty string."""
        found = self._catalogue.find(filled(said.template), *_keys(said))
        return found[0].translation if found else ""


def _keys(said: Said) -> tuple[str, ...]:
    """Where the program looks for the translation of a text."""
    shared = f"{said.kind}s"
    return (said.code, shared) if said.code else (shared,)


def filled(template: str) -> str:
    """A text of a template, with something in its holes."""
    numbers = iter(range(template.count("{}")))
    return re.sub(r"\{\}", lambda _: f"⟦{next(numbers)}⟧", template)


def problems() -> list[str]:
    """All that is missing or stale, for every language."""
    said = Templates(PACKAGE).said()
    found: list[str] = []
    for folder in FOLDERS.values():
        check = Check(folder, said)
        found += [*check.missing(), *check.stale()]
    return found


def listing(words: Sequence[str]) -> dict[str, dict[str, str]]:
    """The texts by code, each with its translation so far."""
    said = Templates(PACKAGE).said()
    check = Check(FOLDERS["zh"], said)
    listed: dict[str, dict[str, str]] = {}
    for each in said:
        key = _keys(each)[0]
        if not words or key.startswith(tuple(words)):
            listed.setdefault(key, {})[each.template] = check.translation(each)
    return listed


def main(words: Sequence[str]) -> int:
    """Print the texts, or with ``--check`` what is wrong with the catalogues."""
    if "--check" not in words:
        print(json.dumps(listing(words), ensure_ascii=False, indent=2))
        return 0
    found = problems()
    for problem in found:
        print(problem, file=sys.stderr)
    if found:
        print("the catalogues are in src/linkwright/diagnostics/translation/", file=sys.stderr)
    return int(bool(found))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
