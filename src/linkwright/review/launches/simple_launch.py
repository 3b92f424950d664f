"""Compare the arguments that launch files declare by ``declare_arg`` of the package simple_launch."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from contextlib import suppress

from linkwright.diagnostics import phrase
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.argument_uses import read_code
from linkwright.review.launches.effects import explain_argument_removal, find_addition_reason
from linkwright.review.launches.outlines import CodePart, Entry, LaunchOutline
from linkwright.review.launches.titles import format_added_entry

_CLASS = "SimpleLauncher"
_METHOD = "declare_arg"


def report_declared_arguments(
    pair: FilePair, removed: Sequence[CodePart], added: Sequence[CodePart], old: LaunchOutline, new: LaunchOutline
) -> tuple[list[CodePart], list[CodePart]]:
    """Report the arguments that only one version declares or uses, and return the other statements.

    Args:
        pair: both versions of the launch file.
        removed: the statements that only the old version has.
        added: the statements that only the new version has.
        old: the old outline.
        new: the new outline.
    """
    texts = read_code(pair.old_file), read_code(pair.new_file)
    if not all(_CLASS in text for text in texts):
        return list(removed), list(added)
    sides = [{entry.name: entry for entry in map(_read_declaration, outline.code) if entry} for outline in (old, new)]
    told = set[str]()
    for name, entry in sides[0].items():
        was_used = _count_uses(texts[0], name) > 1
        if name not in sides[1] and _count_uses(texts[1], name) == 0:
            told.add(name)
            text = phrase("argument '{name}' removed", name=name)
            text = text if was_used else phrase("{change}; the file did not use it", change=text)
            reason = explain_argument_removal(name) if was_used else None
            pair.add(text, pair.location(entry.span, is_old=True), reason)
        elif name in sides[1] and was_used and _count_uses(texts[1], name) == 1:
            reason = phrase("a value that a caller passes for '{name}' has no effect", name=name)
            text = phrase("argument '{name}' is no longer used", name=name)
            pair.add(text, pair.location(sides[1][name].span), reason)
    for name, entry in sides[1].items():
        if name not in sides[0] and _count_uses(texts[0], name) == 0:
            told.add(name)
            pair.add(format_added_entry(entry), pair.location(entry.span), find_addition_reason(entry, new))
    rests = [
        [part for part in parts if (declared := _read_declaration(part)) is None or declared.name not in told]
        for parts in (removed, added)
    ]
    return rests[0], rests[1]


def _read_declaration(part: CodePart) -> Entry | None:
    """Return the argument that a statement declares, or None for other statements."""
    with suppress(SyntaxError, ValueError):
        statement = ast.parse(part.source).body[0]
        call = statement.value if isinstance(statement, (ast.Expr, ast.Assign)) else None
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr == _METHOD:
            values = {keyword.arg or "": keyword.value for keyword in call.keywords}
            values |= dict(zip(("name", "default_value"), call.args, strict=False))
            name, default = values.get("name"), values.get("default_value")
            if isinstance(name, ast.Constant) and isinstance(name.value, str):
                settings = {} if default is None else {"default": ast.unparse(default).strip("'\"")}
                return Entry("argument", name.value, settings, part.span)
    return None


def _count_uses(text: str, name: str) -> int:
    """Return how often a launch file has the name of an argument as a text, or uses all arguments."""
    return len(re.findall(rf"[\"']{re.escape(name)}[\"']", text)) + 2 * len(re.findall(r"\.arg_map\(\s*\)", text))
