"""Report the arguments of launch files that the new version no longer uses."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.effects import explain_argument_removal
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline
from linkwright.review.sources.names import PYTHON_SUFFIX

_ARGUMENT_WITH_DEFAULT = re.compile(r"\$\(var ([\w.-]+) ")
_USED_ARGUMENT = re.compile(r"\$\((?:var|arg) ([\w./-]+)")
_COMMENT = re.compile(r"<!--.*?-->|^\s*#[^\n]*", re.DOTALL | re.MULTILINE)
_COMPUTED_USE = re.compile(r"\bLaunchConfiguration\(\s*(?![\"'\s])|\blaunch_configurations\b(?!\[[\"'])")
"""A use of an argument whose name a Python file computes."""
_PASSING_ATTRIBUTE = "pass_all_args"
"""The attribute with which an include of ROS 1 passes all arguments."""


def report_unused_arguments(
    pair: FilePair, old: LaunchOutline, new: LaunchOutline, paired_old: Sequence[Entry], removed: Sequence[Entry]
) -> None:
    """Report the arguments that only the old version uses.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
        paired_old: the old actions that the new version also has.
        removed: the other old actions. Of their arguments, only those are reported that started them.
    """
    _report_undeclared(pair, old, new)
    content = _read_code(pair.new_file)
    if _PASSING_ATTRIBUTE in content:
        return
    arguments = {entry.name for entry in old.entries if _is_argument(entry)}
    switches = {name for name in arguments if _is_switch(name, removed, old)}
    old_names = switches | {name for name in arguments if _is_used(name, paired_old)}
    if not new.is_ros1 and any(entry.kind == "include" for entry in new.entries):
        old_names = switches  # an included file may use any other argument
    for entry in new.entries:
        if not _is_argument(entry) or entry.name not in old_names or _is_used(entry.name, new.entries):
            continue
        if not _may_use(content, entry.name):
            text = phrase("argument '{name}' is no longer used", name=entry.name)
            reason = phrase("a value that a caller passes for '{name}' has no effect", name=entry.name)
            pair.add(text, pair.location(entry.span), reason)


def uses_argument(file: Path, name: str, entries: Sequence[Entry], *, is_declared: bool = True) -> bool:
    """Return whether a launch file may use an argument, apart from the files that it includes.

    Args:
        file: the launch file.
        name: the name of the argument.
        entries: the actions of the launch file, also those that functions of other files make.
        is_declared: whether the file declares the argument. Otherwise, only certain uses count.
    """
    others = [entry for entry in entries if entry.kind != "argument" or entry.name != name]
    if not is_declared:
        return _is_used(name, others)
    text = _COMMENT.sub("", _read_text(file))
    return _is_used(name, others) or _may_use(text, name) or _COMPUTED_USE.search(text) is not None


def _may_use(text: str, name: str) -> bool:
    """Return whether a file may use an argument outside of its declaration."""
    pattern = re.escape(name)
    is_in_expression = re.search(rf"\$\([^<>]*?(?<![\w.-]){pattern}(?![\w.-])", text)
    return is_in_expression is not None or len(re.findall(rf"[\"']{pattern}[\"']", text)) > 1


def _report_undeclared(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the undeclared arguments that only the old version names."""
    used = {name: entry for entry in old.entries for name in _find_names_with_default(entry)}
    declared = {entry.name for outline in (old, new) for entry in outline.entries if entry.has_value}
    text = _read_text(pair.new_file) if used.keys() - declared else ""
    for name, entry in used.items():
        if name not in declared and not re.search(rf"\b{re.escape(name)}\b", text):
            location = pair.location(entry.span, is_old=True)
            pair.add(
                phrase("argument '{name}' removed", name=name),
                location,
                explain_argument_removal(name, is_ros1=old.is_ros1),
            )


def _read_code(file: Path) -> str:
    """Return the text of a launch file without comments, and in Python without unused variables."""
    text = _COMMENT.sub("", _read_text(file))
    if file.suffix != PYTHON_SUFFIX:
        return text
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return text
    while True:
        remover = _UnusedVariableRemover(tree)
        tree = remover.visit(tree)
        if not remover.has_removed:
            return ast.unparse(tree)


class _UnusedVariableRemover(ast.NodeTransformer):
    """Removes the assignments of variables that nothing reads.

    Args:
        tree: the code.
    """

    def __init__(self, tree: ast.AST) -> None:
        names = (node for node in ast.walk(tree) if isinstance(node, ast.Name))
        self._loaded = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        self.has_removed = False

    def visit_Assign(self, node: ast.Assign) -> ast.stmt:
        """Return a statement without effect in place of an assignment to variables that nothing reads."""
        if all(isinstance(target, ast.Name) and target.id not in self._loaded for target in node.targets):
            self.has_removed = True
            return ast.copy_location(ast.Pass(), node)
        return node


def _read_text(file: Path) -> str:
    return file.read_text("utf-8", errors="replace")


def _find_names_with_default(entry: Entry) -> list[str]:
    return [name for text in (entry.name, *entry.settings.values()) for name in _ARGUMENT_WITH_DEFAULT.findall(text)]


def _is_argument(entry: Entry) -> bool:
    return entry.kind == "argument" and "value" not in entry.settings


def _is_switch(name: str, removed: Sequence[Entry], old: LaunchOutline) -> bool:
    """Return whether the old file used an argument only to start removed actions, and did not start them by default."""
    started = [entry for entry in removed if name in _USED_ARGUMENT.findall(entry.settings.get(CONDITION, ""))]
    is_off = all(evaluate_condition(old.resolve(entry.settings[CONDITION])) is not True for entry in started)
    others = [entry for entry in old.entries if not any(entry is other for other in started)]
    return bool(started) and is_off and not _is_used(name, others)


def _is_used(name: str, entries: Sequence[Entry]) -> bool:
    """Return whether an action uses an argument."""
    return any(
        name in _USED_ARGUMENT.findall(text) for entry in entries for text in (entry.name, *entry.settings.values())
    )
