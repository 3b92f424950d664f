"""Reader for the installed files in the syntax tree of a ``setup.py``.

A ``setup.py`` is read for each ``$(find PACKAGE)`` in sources. To save time, the records in this module and in the
modules that it imports are named tuples or plain classes, which Python creates six times as fast as data classes.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from glob import glob
from pathlib import Path

from linkwright.diagnostics import SourceText, Span
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.packages.readers.installed import ENTRY_POINT_LINE, PROGRAM_GROUP, InstalledFile
from linkwright.packages.readers.python_values import Pattern, PythonFile, argument_of, called_name


class SyntaxProblem(NamedTuple):
    """The reason why a file is not valid Python, and its location."""

    message: str
    span: Span


class DataFile(NamedTuple):
    """A file or a pattern of files that is installed.

    Attributes:
        text: the file or pattern, relative to the package.
        is_pattern: whether the text is a pattern that is passed to ``glob``.
        recursive: whether ``**`` in the pattern matches any number of folders.
        destination: the destination folder, relative to the prefix, or None if it is not known.
        span: the location of the text.
    """

    text: str
    is_pattern: bool
    recursive: bool
    destination: str | None
    span: Span

    def files(self, package: Path) -> list[str]:
        """Return the matching files of a package, as paths relative to the package, with slashes."""
        if not self.is_pattern:
            return [self.text] if (package / self.text).exists() else []
        # glob is used as in setup.py: the rules of Path.glob for hidden files and "**" are different.
        names = glob(self.text, root_dir=package, recursive=self.recursive)  # noqa: PTH207
        return [name.replace("\\", "/") for name in names if (package / name).is_file()]


class Program(NamedTuple):
    """An executable: its name, its module and function, and the location of its definition."""

    executable: str
    module: str
    function: str | None
    span: Span


class SetupFile:
    """The installed files, packages and executables of a ``setup.py``.

    Attributes:
        tree: the syntax tree, or None if the file is not valid Python.
        error: the syntax error, or None if the file is valid Python.
        has_call: whether the file calls ``setup``.
        name: the name of the package, with its location; None if it is not known.
        installed: the files in ``data_files``.
        data_files_span: the location of ``data_files``, or else of the call of ``setup``.
        is_complete: whether `installed` contains all data files.
        packages: the listed Python packages, with their locations; None if the file searches for packages.
        entry_points: the executables.
        entry_points_complete: whether `entry_points` contains all executables.
    """

    def __init__(self, source: SourceText) -> None:
        self.source = source
        self.tree: ast.Module | None = None
        self.error: SyntaxProblem | None = None
        self.has_call = False
        self.name: tuple[str, Span] | None = None
        self.installed: list[DataFile] = []
        self.data_files_span: Span | None = None
        self.is_complete = True
        self.packages: list[tuple[str, Span]] | None = None
        self.entry_points: list[Program] = []
        self.entry_points_complete = True

    def installed_files(self, package: Path) -> Iterator[InstalledFile]:
        """Yield each known file that ``data_files`` installs.

        Args:
            package: the package's folder.
        """
        if self.tree is not None and not (self.is_complete and all(item.destination for item in self.installed)):
            from linkwright.packages.readers.setup_run import run_setup

            files = run_setup(self.tree, package)
            if files is not None:
                yield from files
                return
        for item in self.installed:
            if item.destination is not None:
                for file in item.files(package):
                    yield InstalledFile(file, f"{item.destination.rstrip('/')}/{file.rpartition('/')[2]}")


def read_setup(source: SourceText) -> SetupFile:
    """Read the facts of a ``setup.py``."""
    facts = SetupFile(source)
    try:
        python_file = PythonFile(source)
    except (SyntaxError, ValueError) as error:
        facts.error = make_syntax_problem(source, error)
        return facts
    facts.tree = python_file.tree
    call = next(python_file.calls("setup"), None)
    if call is None:
        return facts
    facts.has_call = True
    if any(keyword.arg is None for keyword in call.keywords):
        facts.is_complete = facts.entry_points_complete = False
    name = argument_of(call, "name")
    text = python_file.text(name)
    if name is not None and text is not None:
        facts.name = text, python_file.span(name)
    try:
        _DataFilesReader(python_file, facts).read(argument_of(call, "data_files"), call)
    except RecursionError:  # raised for lists that contain each other, or a thousand terms
        facts.is_complete = False
    _read_packages(python_file, facts, argument_of(call, "packages"))
    _read_entry_points(python_file, facts, argument_of(call, "entry_points"))
    return facts


def make_syntax_problem(source: SourceText, error: SyntaxError | ValueError) -> SyntaxProblem:
    """Return the reason why a text is not valid Python, and its location."""
    if not isinstance(error, SyntaxError):
        return SyntaxProblem(str(error), source.span(0))
    start = source.offset(error.lineno or 1, max(error.offset or 1, 1))
    return SyntaxProblem(error.msg, source.span(start, start + 1))


class _DataFilesReader:
    """A reader of the entries of ``data_files`` into the facts of a ``setup.py``."""

    def __init__(self, python_file: PythonFile, facts: SetupFile) -> None:
        self._python_file = python_file
        self._facts = facts
        self._visited_names: set[str] = set()  # the names of lists that were already read

    def read(self, node: ast.expr | None, call: ast.Call) -> None:
        self._facts.data_files_span = self._python_file.span(node if node is not None else call.func)
        if node is not None:
            self._read_entries(node)

    def _read_entries(self, node: ast.expr) -> None:
        if isinstance(node, ast.Name):
            self._read_entries_of_name(node)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            self._read_entries(node.left)
            self._read_entries(node.right)
        elif isinstance(node, (ast.List, ast.Tuple)):
            for entry in node.elts:
                self._read_entry(entry)
        else:
            self._facts.is_complete = False

    def _read_entries_of_name(self, node: ast.Name) -> None:
        if node.id in self._visited_names:
            return
        self._visited_names.add(node.id)
        value = self._python_file.assigned_expression(node.id)
        if value is None:
            self._facts.is_complete = False
        else:
            self._read_entries(value)
            self._read_additions(node.id)

    def _read_entry(self, node: ast.expr) -> None:
        if isinstance(node, ast.Starred):
            self._read_entries(node.value)
            return
        node = self._python_file.resolved(node)
        if not isinstance(node, (ast.Tuple, ast.List)) or len(node.elts) != 2:
            self._facts.is_complete = False
            return
        self._read_sources(node.elts[1], self._python_file.text(node.elts[0]))

    def _read_sources(self, node: ast.expr, destination: str | None) -> None:
        if isinstance(node, ast.Name) and any(self._python_file.calls("append", "extend", "insert", owner=node.id)):
            self._facts.is_complete = False
        node = self._python_file.resolved(node)
        value = self._python_file.value(node)
        span = self._python_file.span(node)
        if isinstance(value, Pattern):
            self._add(value.text, destination, span, value)
        elif isinstance(value, str):
            self._add(value, destination, span, None)
        elif isinstance(node, (ast.List, ast.Tuple)):
            for item in node.elts:
                self._read_sources(item.value if isinstance(item, ast.Starred) else item, destination)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
            self._read_sources(node.left, destination)
            self._read_sources(node.right, destination)
        else:
            self._facts.is_complete = False

    def _add(self, text: str, destination: str | None, span: Span, pattern: Pattern | None) -> None:
        recursive = pattern is not None and pattern.recursive
        text = text.removeprefix("./")
        self._facts.installed.append(DataFile(text, pattern is not None, recursive, destination, span))

    def _read_additions(self, name: str) -> None:
        """Record the entries added by ``name.append(...)``, ``name.extend(...)``, ``name += ...``."""
        for node in ast.walk(self._python_file.tree):
            if isinstance(node, ast.Call) and called_name(node) in (f"{name}.append", f"{name}.extend"):
                if len(node.args) != 1:
                    continue
                if called_name(node).endswith("append"):
                    self._read_entry(node.args[0])
                else:
                    self._read_entries(node.args[0])
            elif isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name) and node.target.id == name:
                self._read_entries(node.value)


def _read_packages(python_file: PythonFile, facts: SetupFile, node: ast.expr | None) -> None:
    node = None if node is None else python_file.resolved(node)
    if not isinstance(node, (ast.List, ast.Tuple)):
        return
    facts.packages = []
    for item in node.elts:
        text = python_file.text(item)
        if text is not None:
            facts.packages.append((text, python_file.span(item)))


def _read_entry_points(python_file: PythonFile, facts: SetupFile, node: ast.expr | None) -> None:
    if node is None:
        return
    node = python_file.resolved(node)
    if not isinstance(node, ast.Dict):
        facts.entry_points_complete = False
        return
    for key, value in zip(node.keys, node.values, strict=True):
        if python_file.text(key) != PROGRAM_GROUP:
            continue
        scripts = python_file.resolved(value)
        if not isinstance(scripts, (ast.List, ast.Tuple)):
            facts.entry_points_complete = False
            continue
        for script in scripts.elts:
            text = python_file.text(script)
            match = ENTRY_POINT_LINE.match(text) if text is not None else None
            if match is None:
                facts.entry_points_complete = False
            else:
                facts.entry_points.append(Program(match[1], match[2], match[3], python_file.span(script)))
