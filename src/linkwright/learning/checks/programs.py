"""Lookup of the programs of the learner's packages, and explanations of their failures."""

from __future__ import annotations

import ast
import importlib
import linecache
import re
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, nearest, phrase, quoted_names
from linkwright.diagnostics.lookalikes import lookalike_hint
from linkwright.learning.checks.findings import add_hint, describe_error
from linkwright.learning.checks.node_hints import hint_about_line
from linkwright.learning.checks.not_yet import NotYet

if TYPE_CHECKING:
    from linkwright.packages.readers.installed import EntryPoint

_EXCEEDED_BUDGET = re.compile(r"without waiting, at (.+?):(\d+)")
_ENTRY_WITHOUT_COMMA = re.compile(r"""['"]\s*[\w-]+\s*=\s*[\w.]+:\w+\s*['"][ \t]*\n\s*['"]""")
_ENTRY_WITHOUT_FUNCTION = re.compile(r"""['"]\s*([\w-]+)\s*=\s*([A-Za-z_]\w*(?:\.\w+)+)\s*['"]""")
_MEMORY_ADDRESS = re.compile(r" at 0x[0-9a-f]+")


def find_program(folder: Path, package: str, name: str) -> Callable[[], object]:
    """Return a function that runs the ``main`` of an executable from a package's ``setup.py``.

    The returned function imports the learner's module when it is called. Pass it to `SteppedGraph.start_program`.

    Args:
        folder: the folder of the package.
        package: the name of the package.
        name: the name of the executable.

    Raises:
        NotYet: the package declares no such executable, or has no such module.
    """
    from linkwright import standins
    from linkwright.learning.checks.installed_files import expect_valid_setup
    from linkwright.packages.programs.source_programs import find_module_file, find_python_root, find_source_programs

    expect_valid_setup(folder)
    _expect_complete_entries(folder / "setup.py")
    entries = find_source_programs(folder).entry_points
    if name not in entries:
        raise NotYet(_explain_missing_executable(name, entries))
    entry = entries[name]
    root = find_python_root(folder, package)
    path = None if root is None else find_module_file(root, entry.module)
    if root is None or path is None:
        raise NotYet(_explain_missing_module(name, entry, folder, package))
    _expect_function(path, entry.function)
    standins.activate()
    if str(root) not in sys.path:
        sys.path.insert(0, str(root))

    def main() -> object:
        module = importlib.import_module(entry.module)
        function = getattr(module, entry.function, None)
        if function is None:
            raise NotYet(phrase("{module} has no function '{function}'", module=entry.module, function=entry.function))
        return function()

    return main


def _expect_complete_entries(path: Path) -> None:
    """Require each entry of ``setup.py`` to end with a comma and to name a function.

    Raises:
        NotYet: a comma is missing between two entries, or an entry names only a module.
    """
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    if match := _ENTRY_WITHOUT_COMMA.search(text):
        line = text.count("\n", 0, match.start()) + 1
        raise NotYet(phrase("setup.py, line {line}: a comma is missing at the end of the line", line=line))
    if match := _ENTRY_WITHOUT_FUNCTION.search(text):
        line = text.count("\n", 0, match.start()) + 1
        module, _, function = match[2].rpartition(".")
        is_module = path.parent.joinpath(*match[2].split(".")).with_suffix(".py").is_file()
        written = f"{match[1]} = {match[2]}:main" if is_module else f"{match[1]} = {module}:{function}"
        raise NotYet(
            phrase("setup.py, line {line}: the entry names no function; write '{written}'", line=line, written=written)
        )


def _explain_missing_executable(name: str, entries: Mapping[str, EntryPoint]) -> Phrase:
    """Return the message for an executable that ``setup.py`` does not declare."""
    if similar := nearest(name, entries, 1):
        return phrase("setup.py declares no executable '{name}'; there is '{similar}'", name=name, similar=similar[0])
    message = phrase("setup.py declares no executable '{name}' in 'console_scripts'", name=name)
    if not entries:
        return message
    return phrase("{message}; there is '{similar}'", message=message, similar=next(iter(entries)))


def _explain_missing_module(name: str, entry: EntryPoint, folder: Path, package: str) -> Phrase:
    """Return the message for an executable whose module is missing, with the correct entry."""
    message = phrase("the module '{module}' of the executable '{name}' is missing", name=name, module=entry.module)
    for ending in (".py", f".{entry.function}", ".main"):
        shorter = entry.module.removesuffix(ending)
        if shorter != entry.module:
            written = f"{name} = {shorter}:{entry.function}"
            return phrase("{message}; write '{written}'", message=message, written=written)
    if not entry.module.startswith(f"{package}."):
        written = f"{name} = {package}.{entry.module}:{entry.function}"
        return phrase("{message}; write '{written}'", message=message, written=written)
    inner = folder / package
    if not (inner / "__init__.py").is_file() and inner.is_dir():
        return phrase("{message}: the folder '{folder}' needs a file __init__.py", message=message, folder=inner.name)
    path = entry.module.replace(".", "/") + ".py"
    if (folder / Path(path).name).is_file():
        return phrase(
            "{message}; move '{file}' into the folder '{folder}'", message=message, file=Path(path).name, folder=package
        )
    return phrase("{message}; create the file '{path}' in the package", message=message, path=path)


def _expect_function(path: Path, function: str) -> None:
    """Require a module to define a function, without running the module.

    Raises:
        NotYet: the module does not define the function, or cannot be parsed.
    """
    try:
        tree = ast.parse(path.read_bytes(), str(path))
    except (SyntaxError, ValueError) as error:
        raise NotYet(describe_failure(error, path.parent)) from None
    names = {name for statement in tree.body for name in _iterate_names(statement)}
    if function not in names and "*" not in names:
        message = phrase("{file} has no function '{function}'", file=path.name, function=function)
        for statement in tree.body:
            inner = [part.name for part in getattr(statement, "body", ()) if isinstance(part, ast.FunctionDef)]
            if isinstance(statement, ast.ClassDef) and function in inner:
                raise NotYet(
                    phrase(
                        "{message}: it is inside the class '{name}'; begin 'def {function}' at the left margin",
                        message=message,
                        name=statement.name,
                        function=function,
                    )
                )
        functions = [statement.name for statement in tree.body if isinstance(statement, ast.FunctionDef)]
        if not functions:
            raise NotYet(message)
        raise NotYet(phrase("{message}; it has {names}", message=message, names=quoted_names(functions)))


def _iterate_names(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement of a module defines."""
    if isinstance(statement, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        yield statement.name
    elif isinstance(statement, (ast.Import, ast.ImportFrom)):
        yield from (alias.asname or alias.name for alias in statement.names)
    else:
        for node in ast.walk(statement):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
                yield node.id
            elif isinstance(node, ast.FunctionDef):
                yield node.name
            elif isinstance(node, ast.alias):
                yield node.asname or node.name


def describe_failure(error: Exception, workspace: Path) -> Phrase:
    """Return an exception as one sentence, with the last traceback line in the learner's files."""
    from linkwright.launch.errors.user_code import create_hint

    text = _MEMORY_ADDRESS.sub("", f"{type(error).__name__}: {error}")
    if isinstance(error, ImportError):
        text = text.removesuffix(f" ({error.path})")  # of the module, which is none of the learner's files
    frames = traceback.extract_tb(error.__traceback__)
    own_frames = [frame for frame in frames if Path(frame.filename).is_relative_to(workspace)]
    if isinstance(error, LinkwrightError) and (error.diagnostics[0].span is not None or not own_frames):
        return describe_error(error)
    if isinstance(error, SyntaxError) and error.filename and Path(error.filename).is_relative_to(workspace):
        text = f"{type(error).__name__}: {error.msg}"
        hint = lookalike_hint(error.text or "") if "invalid character" in error.msg else None
        path, line = error.filename, error.lineno or 1
    elif own_frames:
        path, line = own_frames[-1].filename, own_frames[-1].lineno or 1
        hint = (
            _hint_about_own_module(error, Path(path))
            or create_hint(error)
            or hint_about_line(error, linecache.getline(path, line))
        )
        if isinstance(error, LinkwrightError):
            text, hint = error.diagnostics[0].message, error.diagnostics[0].hint or hint
    elif match := _EXCEEDED_BUDGET.search(text):
        return phrase(
            "{file}, line {line}: a loop runs without waiting; call rclpy.spin_once(node) or time.sleep(...) in it; "
            "a callback must return, so remove a loop in it",
            file=Path(match[1]).name,
            line=int(match[2]),
        )
    elif isinstance(error, TimeoutError) and not str(error):
        return phrase("the computer was too busy to run the check; check again")
    else:
        return phrase("the check failed: {error}", error=foreign(text))
    described = phrase("{file}, line {line}: {error}", file=Path(path).name, line=line, error=foreign(text))
    return add_hint(described, hint)


def _hint_about_own_module(error: Exception, path: Path) -> Phrase | None:
    """Return a hint if a module is imported without its package's name, or None."""
    name = error.name if isinstance(error, ModuleNotFoundError) else None
    if name is None or not path.with_name(f"{name}.py").is_file():
        return None
    return phrase("write 'from {package}.{module} import ...'", package=path.parent.name, module=name)
