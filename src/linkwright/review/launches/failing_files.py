"""Find launch files that cannot start, whatever callers pass. Changes to such a file break nothing."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from linkwright.diagnostics import Phrase, SourceText, Span, phrase
from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION
from linkwright.packages.readers.python_values import parse_python
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.included import MAX_INCLUDE_DEPTH, IncludedActions
from linkwright.review.launches.outlines import CONDITION, FAILURES, Entry, LaunchOutline
from linkwright.review.launches.programs.missing import find_missing_file, lacks_executable, lacks_program
from linkwright.review.launches.programs.sources import try_read_outline
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.sources.reading import read_source_names, try_read_source
from linkwright.review.versions import Version


class LaunchFailure(NamedTuple):
    """A reason why a launch file never starts.

    Attributes:
        reason: the reason.
        span: the location of the cause.
    """

    reason: Phrase
    span: Span


def find_failure(version: Version, path: str, outline: LaunchOutline, depth: int = 0) -> LaunchFailure | None:
    """Return a reason why a launch file fails without any condition, or None if it may start.

    Args:
        version: the version of the repository.
        path: the path of the launch file, relative to the root.
        outline: the actions of the file.
        depth: the number of files that include it.
    """
    file = version.file(path)
    if file.suffix == PYTHON_SUFFIX:
        return _find_undefined_name(file) or _find_failing_action(version, path, outline, depth)
    undeclared = IncludedActions(version, path, outline).find_undeclared_arguments() if outline.is_ros1 else {}
    for name, (entry, _) in undeclared.items():
        if _is_unconditional(entry):
            return LaunchFailure(phrase("the argument '{name}' is not declared", name=name), entry.span)
    return _find_failing_action(version, path, outline, depth)


def report_repair(pair: FilePair, failure: LaunchFailure | None, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report that a launch file can start now, unless the new version also fails.

    A file of ROS 1 also starts if it does not find a program. The report names the nodes whose programs exist now.

    Args:
        pair: both versions of the launch file.
        failure: the reason why the old version fails; None if it may start.
        old: the outline of the old version.
        new: the outline of the new version.
    """
    versions = pair.versions
    if failure is None and old.is_ros1 and new.is_ros1:
        names = {entry.name for entry in old.entries if lacks_executable(versions.old, entry)}
        found = {entry.name: entry for entry in new.entries if entry.name in names}
        for name, entry in found.items():
            if not lacks_executable(versions.new, entry):
                text = phrase("before this change, no executable program '{name}' was found to start", name=name)
                pair.add(text, pair.location(entry.span))
    elif failure is not None and find_failure(versions.new, pair.new_path, new) is None:
        text = phrase("before this change, the launch file always failed: {reason}", reason=failure.reason)
        pair.add(text, pair.location(failure.span, is_old=True))


def _is_unconditional(entry: Entry) -> bool:
    return not entry.settings.get(CONDITION)


def _find_failing_action(version: Version, path: str, outline: LaunchOutline, depth: int) -> LaunchFailure | None:
    """Return the reason why the first action fails that can never be made or executed, or None if there is none."""
    actions = IncludedActions(version, path, outline)
    for entry in filter(_is_unconditional, outline.entries):
        missing = find_missing_file(version, entry, actions.file)
        if missing is not None:
            package, file = missing
            return LaunchFailure(
                phrase("the package '{package}' has no file '{path}'", package=package, path=file), entry.span
            )
        if not outline.is_ros1 and lacks_program(version, entry):
            package, _, program = entry.name.partition("/")
            text = phrase("the package '{package}' has no program '{name}'", package=package, name=program)
            return LaunchFailure(text, entry.span)
        if not entry.settings.keys().isdisjoint(FAILURES):
            return LaunchFailure(phrase("an action has wrong arguments"), entry.span)
        included = actions.find_included_file(entry, actions.file) if depth < MAX_INCLUDE_DEPTH else None
        included_path = None if included is None else version.relative(included)
        included_outline = None if included_path is None else try_read_outline(version, included_path)
        if included_path is not None and included_outline is not None:
            failure = find_failure(version, included_path, included_outline, depth + 1)
            if failure is not None:
                reason = phrase("{reason} (in {file})", reason=failure.reason, file=included_path)
                return LaunchFailure(reason, entry.span)
    return None


def _find_undefined_name(file: Path) -> LaunchFailure | None:
    """Return the failure because of an undefined name in a statement that a Python file executes in any case."""
    undefined = read_source_names(file).undefined_names
    source: SourceText | None = try_read_source(file) if undefined else None
    try:
        tree = None if source is None else parse_python(source.text)
    except (SyntaxError, ValueError):
        return None
    names = [] if tree is None else sorted(_find_executed_names(tree), key=lambda name: (name.lineno, name.col_offset))
    for name in names:
        if name.id in undefined:
            return LaunchFailure(phrase("nothing defines '{name}'", name=name.id), undefined[name.id])
    return None


def _find_executed_names(tree: ast.Module) -> Iterator[ast.Name]:
    """Yield the names that the module and its main function read outside of other functions and compound statements."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == LAUNCH_FUNCTION]
    bodies: Sequence[list[ast.stmt]] = [tree.body, *(function.body for function in functions)]
    for body in bodies:
        for statement in body:
            if isinstance(statement, (ast.Assign, ast.Expr, ast.Return)):
                yield from _find_evaluated_names(statement)
            if isinstance(statement, (ast.Return, ast.Raise)):
                break


def _find_evaluated_names(node: ast.AST) -> Iterator[ast.Name]:
    """Yield the names in an expression whose values it certainly reads."""
    if isinstance(node, (ast.Lambda, ast.IfExp, ast.BoolOp, ast.GeneratorExp, ast.ListComp, ast.DictComp, ast.SetComp)):
        return
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
        yield node
    for child in ast.iter_child_nodes(node):
        yield from _find_evaluated_names(child)
