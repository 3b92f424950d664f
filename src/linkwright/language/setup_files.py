"""Language features for ``setup.py``: programs, and the files that are installed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.hover import Explanation
from linkwright.language.links import FileReference
from linkwright.language.offers import explain_file, offer_files
from linkwright.language.python_text import Group, Item, Text, python_text
from linkwright.packages.programs.source_programs import find_module_file
from linkwright.packages.readers.entry_points import read_text

_FILE_NAME = "setup.py"
_ENTRY_POINT = re.compile(r"^\s*(?P<name>[^=\s]+)\s*=\s*(?P<module>[\w.]*)(?:\s*:\s*(?P<function>\w*))?")
_FUNCTION = re.compile(r"^(?:async )?def ([A-Za-z]\w*)\s*\(", re.MULTILINE)
_ARGUMENTS = {
    "name": "the name of the package, as in package.xml",
    "version": "the version, as in package.xml",
    "packages": "the Python packages to install",
    "data_files": "other files to install, by their folder",
    "install_requires": "the Python packages that it needs",
    "zip_safe": "whether it can be run from an archive",
    "maintainer": "the name of the maintainer",
    "maintainer_email": "the address of the maintainer",
    "description": "the purpose of the package, as in package.xml",
    "license": "the license, as in package.xml",
    "tests_require": "the Python packages that the tests need",
    "entry_points": "the programs: console_scripts with NAME = MODULE:FUNCTION",
}
_WORD_BEFORE = re.compile(r"[^\W\d]\w*\Z")
_MAX_MODULES = 300


def _find_entry_at(document: Document, offset: int) -> tuple[Text, re.Match[str] | None] | None:
    """Return the program declaration at an offset with its parts, or None."""
    string = python_text(document.text).string_at(offset)
    if string is None:
        return None
    text, item = string
    outer = item.group.parent
    first = outer.parts[0] if outer is not None and outer.parts else None
    is_script = isinstance(first, Text) and first.value.endswith("_scripts") and item.group.opening in ("[", "(")
    return (text, _ENTRY_POINT.match(text.value)) if is_script else None


def _list_modules(folder: Path) -> Iterator[str]:
    """Yield the modules of the Python packages in a folder."""
    for package in sorted(folder.glob("*/__init__.py")):
        for file in sorted(package.parent.rglob("*.py"))[:_MAX_MODULES]:
            if file.name != "__init__.py":
                yield ".".join(file.relative_to(folder).with_suffix("").parts)


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    entry = _find_entry_at(document, offset)
    folder = document.file.parent
    if entry is not None:
        yield from _offer_program_parts(entry[0], offset, folder)
        return
    string = python_text(document.text).string_at(offset)
    if string is None:
        yield from _offer_arguments(document, offset)
        return
    text, item = string
    if _is_installed(item):
        yield from offer_files(folder, text.value[: offset - text.start], offset)
    elif item.keyword == "name":
        yield Completion(folder.name, ItemKind.PACKAGE, text.start)


def _offer_program_parts(text: Text, offset: int, folder: Path) -> Iterator[Completion]:
    typed = text.value[: offset - text.start]
    name, equals, target = typed.partition("=")
    module, colon, function = target.strip().partition(":")
    if colon:
        file = find_module_file(folder, module.strip())
        names = _FUNCTION.findall(read_text(file)) if file is not None else []
        for choice in sorted(names, key=lambda candidate: candidate != "main"):
            yield Completion(choice, ItemKind.FUNCTION, offset - len(function.lstrip()), module)
    elif equals:
        modules = [*_list_modules(folder)]
        for choice in sorted(modules, key=lambda module: module.rpartition(".")[2] != name.strip()):
            yield Completion(choice, ItemKind.FILE, offset - len(module))
    else:
        for choice in _list_modules(folder):
            script = choice.rpartition(".")[2]
            yield Completion(f"{script} = {choice}:main", ItemKind.FUNCTION, text.start)


def _offer_arguments(document: Document, offset: int) -> Iterator[Completion]:
    """Yield completions of the arguments of ``setup`` that the call does not have yet."""
    call = python_text(document.text).call_at(offset)
    typed = _WORD_BEFORE.search(document.text, document.text.rfind("\n", 0, offset) + 1, offset)
    start = offset if typed is None else typed.start()
    if call is None or call.function != "setup" or not document.text[:start].rstrip().endswith(("(", ",")):
        return
    present = {item.keyword for item in call.items}
    for name, meaning in _ARGUMENTS.items():
        if name not in present:
            yield Completion(f"{name}=", ItemKind.ATTRIBUTE, start, "setup", meaning)


def _is_installed(item: Item) -> bool:
    """Return whether an item is a file in ``data_files``, in a list or a glob."""
    current: Item | None = item
    depth = 0
    while current is not None and current.keyword != "data_files":
        current, depth = current.group.parent, depth + 1
    group: Group = item.group
    return current is not None and (group.function == "glob" or (group.opening == "[" and depth > 1))


def _explain(document: Document, offset: int) -> Explanation | None:
    entry = _find_entry_at(document, offset)
    target = next(iter(_define(document, offset)), None)
    text, parts = entry or (None, None)
    if text is not None and parts is not None:
        module, function = parts["module"], parts["function"] or ""
        file_line = "" if target is None else f"\n\n`{target.file}`"
        return Explanation(f"**{parts['name']}**: `{module}:{function}`{file_line}", text.start, text.end)
    string = python_text(document.text).string_at(offset)
    if string is not None and target is not None:
        return Explanation(explain_file(target.file), string[0].start, string[0].end)
    return None


def _define(document: Document, offset: int) -> Iterator[Target]:
    entry = _find_entry_at(document, offset)
    folder = document.file.parent
    if entry is not None:
        parts = entry[1]
        file = find_module_file(folder, parts["module"]) if parts is not None else None
        if parts is not None and file is not None:
            names = _FUNCTION.finditer(read_text(file))
            name_range = next((match.span(1) for match in names if match[1] == parts["function"]), (0, 0))
            yield Target(file, *name_range)
        return
    string = python_text(document.text).string_at(offset)
    if string is not None and _is_installed(string[1]):
        path = _find_file(folder, string[0].value)
        if path is not None:
            yield Target(path)


def _find_file(folder: Path, name: str) -> Path | None:
    try:
        return folder / name if name and "\0" not in name and (folder / name).is_file() else None
    except OSError:
        return None


def _links(document: Document) -> Iterator[FileReference]:
    for text, item in python_text(document.text).strings:
        path = _find_file(document.file.parent, text.value) if _is_installed(item) else None
        if path is not None:
            yield FileReference(text.start, text.end, path)


def _symbols(document: Document) -> Iterator[Symbol]:
    for text, _ in python_text(document.text).strings:
        _, parts = _find_entry_at(document, text.start) or (text, None)
        if parts is not None:
            yield Symbol(parts["name"], SymbolKind.FUNCTION, text.start, text.end, (), parts["module"])


SETUP_FILES = Format(lambda file: file.name == _FILE_NAME, _complete, _explain, _define, _links, _symbols)
"""The format of ``setup.py``."""
