"""Keep the catalogs of other languages and the source together.

Usage: python tools/catalogs.py [update | check | compile]

``update`` writes the texts of the source, and the titles of the pages of `linkwright explain`, into the catalogs: new
texts have no translation yet, and texts that the source no longer has are removed. ``check`` prints which texts lack a
translation, are stale or have other placeholders, and which files ``update`` would change; then it exits with 1.
``compile`` writes the files that the program reads, where they are older than the catalogs.
"""

from __future__ import annotations

import ast
import os
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime, timezone
from functools import partial
from inspect import cleandoc
from io import BytesIO
from pathlib import Path
from string import Formatter

from babel.messages.catalog import Catalog, Message
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

PACKAGE = Path(__file__).resolve().parent.parent / "src" / "linkwright"
FOLDER = PACKAGE / "diagnostics" / "translation"

LOOKUP_CONTEXTS = ("term", "foreign")
"""Contexts of texts that come from tables, files and other programs, not all of which are in the source."""

TITLES = "rule"
"""The context of the titles of pages: first lines of rules' docstrings, and headings of files for other codes."""

_PAGE_TITLE = re.compile(r"^## [A-Z]+[0-9]{3}: (.+)$", re.MULTILINE)
_HEADER = "# What Linkwright says, in {}.\n# Entries are kept by `python tools/catalogs.py update`."
_DATED_FIELDS = ('"POT-', '"PO-Rev', '"Last-', '"Language-Team', '"Generated', '"Report', '"Project', "# FIRST", "#,")
_NO_DATE = datetime(1970, 1, 1, tzinfo=timezone.utc)


@dataclass
class Template:
    """A template of the source.

    Attributes:
        template: the English text; the singular if `plural` is set.
        plural: the plural, or None.
        filled: whether the template has arguments; without arguments, braces are literal.
        places: the locations of the template, as ``file:line``.
    """

    template: str
    plural: str | None
    filled: bool
    places: list[str] = field(default_factory=list)

    @property
    def rooms(self) -> list[str]:
        """The rooms that contain the template."""
        return sorted({place.partition("/")[0] for place in self.places})


class Source:
    """The texts of the modules below a folder.

    Attributes:
        templates: the templates, by their English texts.
        titles: maps the titles of the pages of `linkwright explain` to their locations.
        problems: the calls that cannot be translated, one line for each.
    """

    def __init__(self, package: Path = PACKAGE) -> None:
        self.templates: dict[str, Template] = {}
        self.titles: dict[str, str] = {}
        self.problems: list[str] = []
        for path in sorted(package.rglob("*.py")):
            name = path.relative_to(package).as_posix()
            tree = ast.parse(path.read_text(encoding="utf-8"))
            for node in ast.walk(tree):
                if name.startswith("lint/rules/") and isinstance(node, ast.ClassDef):
                    self._record_rule(node, f"{name}:{node.lineno}")
                if name.startswith("cli/"):
                    self._record_help(node, f"{name}:{getattr(node, 'lineno', 0)}")
                if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                    self._record_call(node, node.func.id, f"{name}:{node.lineno}")
        for path in sorted(package.glob("lint/pages/*.md")):
            for title in _PAGE_TITLE.findall(path.read_text(encoding="utf-8")):
                self.titles.setdefault(title.strip(), path.relative_to(package).as_posix())

    def _record_rule(self, node: ast.ClassDef, place: str) -> None:
        """Record the title of a rule, which is a class with a code."""
        attribute_names = {
            ast.unparse(statement.targets[0]) for statement in node.body if isinstance(statement, ast.Assign)
        }
        if "code" in attribute_names:
            title = cleandoc(ast.get_docstring(node) or "").partition("\n")[0]
            self.titles.setdefault(title.rstrip("."), place)

    def _record_help(self, node: ast.AST, place: str) -> None:
        """Record the help texts of commands, from their table and from calls of parsers."""
        named = isinstance(node, ast.Assign) and ast.unparse(node.targets[0])
        if named in ("COMMANDS", "GROUPS") and isinstance(node.value, ast.Dict):
            texts = [text for table in ast.walk(node.value) if isinstance(table, ast.Dict) for text in table.values]
        elif named and named.endswith("_HELP"):
            texts = [node.value]
        elif isinstance(node, ast.keyword) and node.arg and node.arg.endswith(("help", "title", "description")):
            texts = [node.value]
            if isinstance(node.value, (ast.JoinedStr, ast.BinOp, ast.IfExp)):
                self.problems.append(f"{place}: the help text is no literal")
        else:
            return
        for text in texts:
            if isinstance(text, ast.Constant) and isinstance(text.value, str):
                self.templates.setdefault(text.value, Template(text.value, None, False)).places.append(place)

    def _record_call(self, node: ast.Call, function_name: str, place: str) -> None:
        if function_name == "phrase":
            texts, argument_names = node.args[:1], set()
        elif function_name == "counted":
            texts, argument_names = node.args[:2], {"count"}
        else:
            return
        templates = [text.value for text in texts if isinstance(text, ast.Constant) and isinstance(text.value, str)]
        if not templates or len(templates) < len(texts):
            self.problems.append(f"{place}: the template is no literal")
            return
        argument_names |= {keyword.arg for keyword in node.keywords}
        for template in templates:
            placeholder_names = find_placeholders(template) if argument_names else set()
            if None not in argument_names and (
                not placeholder_names <= argument_names
                or (function_name == "phrase" and argument_names > placeholder_names)
            ):
                self.problems.append(f"{place}: the placeholders of '{template}' are not its arguments")
        plural = templates[1] if len(templates) > 1 else None
        known_template = self.templates.setdefault(templates[0], Template(templates[0], plural, bool(argument_names)))
        if plural != known_template.plural:
            self.problems.append(f"{place}: '{known_template.template}' occurs with and without a plural")
        known_template.places.append(place)


def find_placeholders(template: str) -> set[str]:
    """Return the placeholders of a template, each with its format.

    Raises:
        ValueError: the braces do not match.
    """
    return {name for _, name, _, _ in Formatter().parse(template) if name is not None}


def find_problems(catalog: Catalog, source: Source) -> Iterator[str]:
    """Yield the texts of a catalog that are missing or stale, or have other placeholders."""
    yield from source.problems
    for message in catalog:
        if not message.id:
            continue
        english = message.id if isinstance(message.id, str) else message.id[0]
        if not message.string or not all(_list_translations(message)):
            yield f"'{english}' is not translated"
        elif message.context == TITLES:
            if english not in source.titles:
                yield f"no page has the title '{english}'"
        elif message.context not in LOOKUP_CONTEXTS:
            if english not in source.templates:
                yield f"nothing says '{english}'"
            elif source.templates[english].filled and any(
                map(partial(_has_other_placeholders, message.id), _list_translations(message))
            ):
                yield f"the translation of '{english}' has other placeholders"
    for english, template in source.templates.items():
        if catalog.get(english) is None:
            yield f"{template.places[0]}: '{english}' is not in the catalog"
    for title, place in source.titles.items():
        if catalog.get(title, TITLES) is None:
            yield f"{place}: the title '{title}' is not in the catalog"


def _list_translations(message: Message) -> tuple[str, ...]:
    return (message.string,) if isinstance(message.string, str) else tuple(message.string)


def _has_other_placeholders(english: str | tuple[str, str], translation: str) -> bool:
    """Return whether a translation has other placeholders.

    For a plural, the number is optional.
    """
    plural = english if isinstance(english, str) else english[1]
    free = set() if isinstance(english, str) else {("count", "")}
    return _list_formats(plural) - free != _list_formats(translation) - free


def _list_formats(template: str) -> set[tuple[str, str | None]]:
    return {(name, spec) for _, name, spec, _ in Formatter().parse(template) if name is not None}


def update_catalog(catalog: Catalog, source: Source) -> Catalog:
    """Return the catalog with the texts of the source.

    Templates come first, in the order of rooms, then titles, then the rest.
    """
    new = Catalog(catalog.locale, "linkwright", _HEADER.format(catalog.locale.english_name), fuzzy=False)
    for template in sorted(source.templates.values(), key=lambda item: (item.rooms, item.template)):
        identity = (template.template, template.plural) if template.plural else template.template
        old_message = catalog.get(template.template)
        string = old_message.string if old_message is not None else ""
        if template.plural and isinstance(string, str):
            string = (string,) * catalog.num_plurals
        elif not template.plural and not isinstance(string, str):
            string = string[0]
        new.add(identity, string, locations=[(room, None) for room in template.rooms])
    for title in sorted(source.titles):
        old_message = catalog.get(title, TITLES)
        new.add(title, old_message.string if old_message is not None else "", context=TITLES)
    lookup_messages = [message for message in catalog if message.context in LOOKUP_CONTEXTS]
    for message in sorted(lookup_messages, key=lambda item: (item.context, item.id)):
        new.add(message.id, message.string, context=message.context)
    return new


def read_catalog(path: Path) -> Catalog:
    """Return the catalog in a file."""
    with path.open("rb") as file:
        return read_po(file, locale=path.stem, domain="linkwright")


def format_catalog(catalog: Catalog) -> str:
    """Return the content of a catalog's file, with a line for each text and without dates."""
    text = BytesIO()
    write_po(text, catalog, width=0, include_lineno=False)
    head, _, entries = text.getvalue().decode("utf-8").partition("\n\n")
    kept_lines = [line for line in head.splitlines() if not line.startswith(_DATED_FIELDS)]
    return "\n".join(kept_lines) + "\n\n" + entries


def compile_catalogs() -> None:
    """Write the ``.mo`` files of newer catalogs, with content that does not depend on the time."""
    for path in sorted(FOLDER.glob("*.po")):
        target = path.with_suffix(".mo")
        if not target.exists() or target.stat().st_mtime_ns < path.stat().st_mtime_ns:
            # Written completely or not at all, outside the folders of builds, because tests and builds run in parallel.
            part = FOLDER / "__pycache__" / f"{target.name}.{os.getpid()}"
            part.parent.mkdir(exist_ok=True)
            catalog = read_catalog(path)
            catalog.creation_date = _NO_DATE
            with part.open("wb") as file:
                write_mo(file, catalog)
            part.replace(target)


def main(words: list[str]) -> int:
    """Run the requested action, and return the exit status."""
    if words == ["compile"]:
        compile_catalogs()
        return 0
    if words not in (["update"], ["check"]):
        print(__doc__, file=sys.stderr)
        return 2
    source = Source()
    all_problems = list(source.problems)
    for path in sorted(FOLDER.glob("*.po")):
        new_text = format_catalog(update_catalog(read_catalog(path), source))
        if words == ["update"]:
            path.write_text(new_text, encoding="utf-8")
        problems = list(find_problems(read_catalog(path), source))
        if not problems and path.read_text(encoding="utf-8") != new_text:
            problems.append("its entries stand otherwise than `python tools/catalogs.py update` puts them: run it")
        all_problems += [f"{path.name}: {problem}" for problem in problems]
    for problem in dict.fromkeys(all_problems):
        print(problem, file=sys.stderr)
    return int(bool(all_problems))


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
