"""Find options that launch files pass and scripts refuse, and missing options."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, SourceText, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.readers.python2 import as_python3
from linkwright.packages.readers.python_values import PythonFile, argument_of, called_name
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.launch_paths import is_launch_file
from linkwright.review.launches.outlines import PROGRAM_KINDS, Entry, LaunchOutline
from linkwright.review.launches.programs.default_names import find_script
from linkwright.review.launches.reading import read_outline
from linkwright.review.sources.reading import try_read_source
from linkwright.review.texts.list_changes import list_items
from linkwright.review.versions import Version, Versions

LAUNCH_SUFFIXES = (".launch", "launch.py", "launch.xml", "launch.yaml", "launch.yml")
"""The ends of the names of launch files."""
_OPTION = re.compile(r"--[A-Za-z][\w-]*")
_END_OF_OPTIONS = "--ros-args"
_HELP_OPTION = "--help"
_ADD_METHOD = "add_argument"
_PARSER_CLASS = "ArgumentParser"
_OPEN_PARSERS = ("parse_known_args", "parse_known_intermixed_args", "add_subparsers")
"""The calls after which a script can have other options, or accepts any."""


@dataclass(frozen=True)
class _Options:
    """The options of a script.

    Attributes:
        names: the options that it accepts.
        required: those that it requires.
    """

    names: frozenset[str]
    required: frozenset[str]


@dataclass(frozen=True)
class _Fault:
    """An option, refused or missing, that prevents a script from starting.

    Attributes:
        program: the name of the script.
        option: the name of the option.
        is_missing: True if the launch file lacks a required option, False if the script refuses the option.
    """

    program: str
    option: str
    is_missing: bool

    @property
    def text(self) -> Phrase:
        if self.is_missing:
            return phrase("'{option}' is not passed to '{program}'", option=self.option, program=self.program)
        return phrase("'{option}' is passed to '{program}'", option=self.option, program=self.program)

    @property
    def reason(self) -> Phrase:
        if self.is_missing:
            return phrase("'{program}' requires '{option}'", option=self.option, program=self.program)
        return phrase("'{program}' does not accept '{option}'", option=self.option, program=self.program)


def find_refused_options(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files with options that scripts no longer accept.

    Each comes with a change.
    """
    old_paths = {file.new_path: file.old_path for file in changed_files if file.new_path}
    for path in _find_launch_files(versions, changed_files):
        new = _find_faults(versions.new, path)
        old_path = old_paths.get(path, path)
        old = _find_faults(versions.old, old_path) if new and old_path else {}
        for fault, entry in new.items():
            if fault not in old:
                location = Location(path, entry.span.line, entry.span.column)
                yield path, Change(fault.text, Effect.BREAKING, fault.reason, location)


def _find_launch_files(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[str]:
    """Yield the changed launch files, and those that name a changed script with options."""
    changed = {file.new_path for file in changed_files if file.new_path}
    scripts = {
        PurePosixPath(path).stem
        for path in changed
        if PurePosixPath(path).suffix in (".py", "") and _PARSER_CLASS in versions.new.text(path)
    }
    for path in versions.new.paths(LAUNCH_SUFFIXES) if scripts else sorted(changed):
        if path.endswith(LAUNCH_SUFFIXES) and is_launch_file(path):
            text = versions.new.text(path) if path not in changed else ""
            if path in changed or any(script in text for script in scripts):
                yield path


def _find_faults(version: Version, path: str) -> dict[_Fault, Entry]:
    """Return the options that prevent scripts from starting, each with the node."""
    try:
        outline = read_outline(version.file(path), version.root)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return {}
    faults: dict[_Fault, Entry] = {}
    for entry in outline.entries:
        script = find_script(version.root, entry.name) if entry.kind in PROGRAM_KINDS else None
        options = None if script is None else _read_options(script)
        if script is None or options is None:
            continue
        passed, is_complete = _parse_passed_options(entry, outline)
        refused = [name for name in passed if not accepts_option(options.names, name)]
        missing = options.required - set(passed) if is_complete else frozenset()
        faults |= {_Fault(script.name, name, is_missing=False): entry for name in refused}
        faults |= {_Fault(script.name, name, is_missing=True): entry for name in sorted(missing)}
    return faults


def read_accepted_options(script: Path) -> frozenset[str] | None:
    """Return the options that a script accepts, or None if they are not known or it has none."""
    options = _read_options(script)
    return None if options is None else options.names


def accepts_option(options: Collection[str], name: str) -> bool:
    """Return whether a script accepts an option.

    argparse also accepts the beginning of an option.
    """
    return name == _HELP_OPTION or any(option.startswith(name) for option in options)


def _parse_passed_options(entry: Entry, outline: LaunchOutline) -> tuple[list[str], bool]:
    """Return the options that a node passes to its program, and whether all are known."""
    text = entry.settings.get("arguments", "")
    words = list_items(text) if text.startswith("[") else text.split()
    words = [part for word in words for part in outline.resolve(word).split()]
    is_complete = not any("$(" in word or "(" in word for word in words) and not text.startswith("[[")
    if _END_OF_OPTIONS in words:
        words = words[: words.index(_END_OF_OPTIONS)]
    names = [word.partition("=")[0] for word in words]
    return [name for name in names if _OPTION.fullmatch(name)], is_complete


def _read_options(script: Path) -> _Options | None:
    """Return the options of a script, or None if they are unknown.

    They are unknown without an option parser, or if it accepts any option.
    """
    source = try_read_source(script)
    if source is None or _PARSER_CLASS not in source.text or any(name in source.text for name in _OPEN_PARSERS):
        return None
    try:
        python = _parse(source)
    except (ValueError, SyntaxError, RecursionError):
        return None
    names: set[str] = set()
    required: set[str] = set()
    for call in (node for node in ast.walk(python.tree) if isinstance(node, ast.Call)):
        function = called_name(call).rpartition(".")[2]
        if function == _PARSER_CLASS and argument_of(call, "parents") is not None:
            return None
        if _is_passed_on(python, call):
            return None
        if function != _ADD_METHOD:
            continue
        texts = [python.text(argument) for argument in call.args]
        if not texts or None in texts:
            return None  # a name that is not written in the script
        options = [text for text in texts if text is not None and text.startswith("--")]
        names.update(options)
        value = argument_of(call, "required")
        if options and isinstance(value, ast.Constant) and value.value is True and len(texts) == 1:
            required.add(options[0])
    return _Options(frozenset(names), frozenset(required))


def _is_passed_on(python: PythonFile, call: ast.Call) -> bool:
    """Return whether a call passes a parser to a function, which may add other options."""
    values = [*call.args, *(keyword.value for keyword in call.keywords)]
    values = [python.resolved(value) for value in values if isinstance(value, ast.Name)]
    return any(isinstance(value, ast.Call) and called_name(value).endswith(_PARSER_CLASS) for value in values)


def _parse(source: SourceText) -> PythonFile:
    try:
        return PythonFile(source)
    except SyntaxError:
        return PythonFile(SourceText(source.name, as_python3(source.text)))
