"""Report the arguments of launch files that the new version no longer uses."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from pathlib import Path

from linkwright.diagnostics import phrase
from linkwright.packages.readers.python_values import parse_python
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.argument_uses import USED_ARGUMENT, is_used, may_use, read_code
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.effects import explain_argument_removal
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.outlines import CONDITION, PASSES_ALL_ARGUMENTS, Entry, LaunchOutline
from linkwright.review.sources.names import PYTHON_SUFFIX

_ARGUMENT_WITH_DEFAULT = re.compile(r"\$\(var ([\w.-]+) ")
"""The attribute with which an include of ROS 1 passes all arguments."""


def report_unused_arguments(
    pair: FilePair, old: LaunchOutline, new: IncludedActions, paired_old: Sequence[Entry], removed: Sequence[Entry]
) -> None:
    """Report the arguments that only the old version uses.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the actions of the new file with those of its included files, which may use an argument, too.
        paired_old: the old actions that the new version also has.
        removed: the other old actions. Of their arguments, only those are reported that started them.
    """
    outline = new.outline
    _report_undeclared(pair, old, outline)
    content = _read_used_code(pair.new_file)
    if PASSES_ALL_ARGUMENTS in content:
        return
    arguments = {entry.name for entry in old.entries if _is_argument(entry)}
    switches = {name for name in arguments if _is_switch(name, removed, old)}
    old_names = switches | {name for name in arguments if is_used(name, paired_old)}
    if not outline.is_ros1 and any(entry.kind == "include" for entry in outline.entries):
        old_names = switches  # an included file may use any other argument
    for entry in outline.entries:
        if not _is_argument(entry) or entry.name not in old_names or is_used(entry.name, outline.entries):
            continue
        if not (may_use(content, entry.name) or new.may_use(entry.name)):
            text = phrase("argument '{name}' is no longer used", name=entry.name)
            reason = phrase("a value that a caller passes for '{name}' has no effect", name=entry.name)
            pair.add(text, pair.location(entry.span), reason)


def _report_undeclared(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the undeclared arguments that only the old version names."""
    used = {name: entry for entry in old.entries for name in _find_names_with_default(entry)}
    declared = {entry.name for outline in (old, new) for entry in outline.entries if entry.has_value}
    text = pair.new_file.read_text("utf-8", errors="replace") if used.keys() - declared else ""
    for name, entry in used.items():
        if name not in declared and not re.search(rf"\b{re.escape(name)}\b", text):
            location = pair.location(entry.span, is_old=True)
            pair.add(
                phrase("argument '{name}' removed", name=name),
                location,
                explain_argument_removal(name, is_ros1=old.is_ros1),
            )


def _read_used_code(file: Path) -> str:
    """Return the text of a launch file without comments, and in Python without unused variables."""
    text = read_code(file)
    if file.suffix != PYTHON_SUFFIX:
        return text
    try:
        tree = parse_python(text)
    except (SyntaxError, ValueError):
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


def _find_names_with_default(entry: Entry) -> list[str]:
    return [name for text in (entry.name, *entry.settings.values()) for name in _ARGUMENT_WITH_DEFAULT.findall(text)]


def _is_argument(entry: Entry) -> bool:
    return entry.kind == "argument" and "value" not in entry.settings


def _is_switch(name: str, removed: Sequence[Entry], old: LaunchOutline) -> bool:
    """Return whether the old file used an argument only to start removed actions, and did not start them by default."""
    started = [entry for entry in removed if name in USED_ARGUMENT.findall(entry.settings.get(CONDITION, ""))]
    is_off = all(evaluate_condition(old.resolve(entry.settings[CONDITION])) is not True for entry in started)
    others = [entry for entry in old.entries if not any(entry is other for other in started)]
    return bool(started) and is_off and not is_used(name, others)
