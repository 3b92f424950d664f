"""Compare the names that other files use: macros, their parameters, and arguments."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import replace

from linkwright.diagnostics import Phrase, counted, joined_first, phrase, quoted_names
from linkwright.review.parts.chosen_parts import compare_chosen_parts
from linkwright.review.parts.default_values import collect_new_values
from linkwright.review.parts.include_graph import IncludeGraph, IncludeGraphs
from linkwright.review.parts.macro_parameters import format_default, format_parameter, has_default
from linkwright.review.parts.outline import MacroOutline, Outline
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.parts.renamed_names import find_renamed_names
from linkwright.review.parts.undefined_names import find_lost_definitions, find_undefined_names, find_unmet_condition
from linkwright.review.parts.unused_arguments import is_unused_argument
from linkwright.review.parts.written_contents import MAX_MACROS, format_added_macro
from linkwright.review.texts.list_changes import change_text
from linkwright.review.texts.merging import name_edit
from linkwright.xacro.macros import Parameter
from linkwright.xmltree import Element

_MAX_PLACES = 4
"""The maximum number of calls of a macro that are named."""


def compare_macros(pair: PartPair, graphs: IncludeGraphs, renamed: Mapping[str, str]) -> None:
    """Report the macros and parameters that the new version of a part adds, removes or changes.

    Args:
        pair: both versions of the part.
        graphs: the includes of both versions.
        renamed: the new names of macros, by their old names.
    """
    added: list[MacroOutline] = []
    for name, macro in pair.new.macros.items():
        if name in pair.old.macros:
            _compare_parameters(pair, pair.old.macros[name], macro)
            _report_undefined_names(pair, graphs.new, pair.old.macros[name], macro)
        elif name not in renamed.values() and not _declares_macro(graphs.old, pair.old_path, name):
            added.append(macro)
    for macro in added:
        text = format_added_macro(macro, shows_contents=len(added) <= MAX_MACROS)
        pair.add(text, None, macro.element)
    lost = find_lost_definitions(graphs, pair)
    if lost:
        text = phrase("no longer defines {names}, which its macros use", names=quoted_names(lost))
        reason = phrase("calls of the macros fail unless the caller defines the names")
        pair.add(text, pair.old.root, pair.new.root, reason)
    edits: dict[Hashable, list[str]] = {}
    for old_name, name in renamed.items():
        edits.setdefault(name_edit(old_name, name), []).append(old_name)
    for name, macro in pair.old.macros.items():
        if name in renamed:
            new = pair.new.macros[renamed[name]]
            first, *others = edits[name_edit(name, new.name)]
            if name == first:
                text = phrase("macro '{old}' renamed to '{name}'", old=name, name=new.name)
                pair.add(text, macro.element, new.element, make_macro_removal_reason())
                names = tuple(f"{other} -> {renamed[other]}" for other in others)
                pair.changes[-1] = replace(pair.changes[-1], other_names=names)
            _compare_parameters(pair, macro, new)
        elif name not in pair.new.macros and not _declares_macro(graphs.new, pair.new_path, name):
            _report_lost_macro(pair, macro, graphs.new)


def _report_lost_macro(pair: PartPair, macro: MacroOutline, graph: IncludeGraph) -> None:
    paths = graph.find_files_with_macro(macro.name)
    if not paths:
        pair.add(phrase("macro '{name}' removed", name=macro.name), macro.element, None, make_macro_removal_reason())
        return
    text = phrase("macro '{name}' moved to {path}", name=macro.name, path=", ".join(paths[:2]))
    reason = phrase("descriptions that include only this file do not find the macro")
    pair.add(text, macro.element, None, reason)


def make_macro_removal_reason() -> Phrase:
    """Return the reason why removing a macro is breaking."""
    return phrase("descriptions that call the macro cannot be expanded")


def _declares_macro(graph: IncludeGraph, path: str, name: str) -> bool:
    return graph.declares(path, lambda outline: name in outline.macros)


def _report_undefined_names(pair: PartPair, graph: IncludeGraph, old: MacroOutline, new: MacroOutline) -> None:
    """Report the names that a macro newly uses although nothing defines them, with a condition unmet by default."""
    values = collect_new_values(pair, new.name)
    groups: dict[str | None, list[str]] = {}
    for name in find_undefined_names(graph, pair.new_path, old, new):
        groups.setdefault(find_unmet_condition(new, name, values), []).append(name)
    for condition, names in groups.items():
        text = phrase("macro '{name}': uses {names}, which nothing defines", name=new.name, names=quoted_names(names))
        reason: Phrase | None = phrase("calls of the macro fail unless the caller defines the name")
        if condition is not None:
            text = phrase("{change} ({condition})", change=text, condition=condition)
            used = [name for name in new.parameters if re.search(rf"\b{re.escape(name)}\b", condition)]
            if used and not any(name in old.parameters for name in used):
                reason = None
        pair.add(text, old.element, new.element, reason)


def _compare_parameters(pair: PartPair, old: MacroOutline, new: MacroOutline) -> None:
    """Report the added and removed parameters of a macro, and changed defaults."""
    removed = [name for name in old.parameters if name not in new.parameters]
    added = [parameter for name, parameter in new.parameters.items() if name not in old.parameters]
    renamed = dict(
        find_renamed_names(
            {name: old.parameters[name].default for name in removed},
            {parameter.name: parameter.default for parameter in added},
            old.element,
            new.element,
        )
    )
    for old_name, name in renamed.items():
        change = phrase("parameter {old} renamed to {name}", old=old_name, name=name)
        text = phrase("macro '{name}': {change}", name=new.name, change=change)
        pair.add(text, old.element, new.element, _make_passed_reason(pair, new, [old_name]))
    removed = [name for name in removed if name not in renamed]
    added = [parameter for parameter in added if parameter.name not in renamed.values()]
    _report_unpaired_parameters(pair, old, new, removed, added)
    for name, parameter in new.parameters.items():
        if name in old.parameters:
            _compare_defaults(pair, old, new, old.parameters[name], parameter)


def _report_unpaired_parameters(
    pair: PartPair, old: MacroOutline, new: MacroOutline, removed: Sequence[str], added: Sequence[Parameter]
) -> None:
    """Report removed parameters, and added parameters with and without a default."""
    required = [parameter.name for parameter in added if not has_default(parameter)]
    optional = [format_parameter(parameter) for parameter in added if has_default(parameter)]
    for names, change, reason in (
        (
            removed,
            counted("parameter {names} removed", "parameters {names} removed", len(removed), names=", ".join(removed)),
            _make_passed_reason(pair, new, removed),
        ),
        (
            required,
            counted(
                "parameter {names} without a default added",
                "parameters {names} without a default added",
                len(required),
                names=", ".join(required),
            ),
            _make_required_reason(pair, new, required),
        ),
        (
            optional,
            counted("parameter {names} added", "parameters {names} added", len(optional), names=", ".join(optional)),
            None,
        ),
    ):
        if names:
            text = phrase("macro '{name}': {change}", name=new.name, change=change)
            pair.add(text, old.element, new.element, reason)


def _make_passed_reason(pair: PartPair, macro: MacroOutline, names: Sequence[str]) -> Phrase:
    """Return why removed parameters of a macro are breaking, with calls of the repository that still pass them."""
    places = _find_places(pair, macro, lambda call: any(name in call.attributes for name in names))
    if places is None:
        return phrase("calls that pass it cannot be expanded")
    return phrase("calls that pass it cannot be expanded, such as {places}", places=places)


def _make_required_reason(pair: PartPair, macro: MacroOutline, names: Sequence[str]) -> Phrase:
    """Return why parameters without a default are breaking, with calls of the repository that do not pass them."""
    values = [name for name in names if not name.startswith("*")]
    places = _find_places(pair, macro, lambda call: any(name not in call.attributes for name in values))
    text = counted(
        "calls that do not pass it cannot be expanded", "calls that do not pass them cannot be expanded", len(names)
    )
    return text if places is None else phrase("{text}, such as {places}", text=text, places=places)


def _find_places(pair: PartPair, macro: MacroOutline, is_left: Callable[[Element], bool]) -> Phrase | None:
    """Return the first calls of a macro that fulfill a condition, as paths with lines; None if there are none."""
    calls = [(path, call.span()) for path, call in pair.find_new_calls(macro.name) if is_left(call)]
    places = [f"{path}:{span.line}" for path, span in calls if span is not None]
    return joined_first(places, _MAX_PLACES) if places else None


def _compare_defaults(
    pair: PartPair, old_macro: MacroOutline, new_macro: MacroOutline, old: Parameter, new: Parameter
) -> None:
    if format_default(old) == format_default(new):
        return
    reason = None
    if not has_default(new):
        change = phrase("parameter {name} no longer has a default", name=new.name)
        reason = _make_required_reason(pair, new_macro, [new.name])
    elif not has_default(old):
        change = phrase("parameter {name} has the default {value}", name=new.name, value=format_default(new))
    else:
        name = phrase("default of parameter {name}", name=new.name)
        change = change_text(name, format_default(old), format_default(new))
    text = phrase("macro '{name}': {change}", name=new_macro.name, change=change)
    pair.add(text, old_macro.element, new_macro.element, reason)


def compare_arguments(pair: PartPair, graphs: IncludeGraphs) -> None:
    """Report the arguments that the new version of a file adds, removes, renames or changes.

    An argument that moves between a robot and its parts is not reported.
    """
    added = {
        name: element
        for name, element in pair.new.arguments.items()
        if name not in pair.old.arguments and not _is_declared_by_robots(graphs.old, pair.old_path, name)
    }
    removed = {
        name: element
        for name, element in pair.old.arguments.items()
        if name not in pair.new.arguments and not _is_declared_by_robots(graphs.new, pair.new_path, name)
    }
    renamed = find_renamed_names(_get_defaults(removed), _get_defaults(added), pair.old.root, pair.new.root)
    old_names = {name: old_name for old_name, name in renamed}
    for name, element in pair.new.arguments.items():
        if name in pair.old.arguments:
            _compare_argument(pair, pair.old.arguments[name], element)
        elif name in old_names:
            old_name = old_names[name]
            text = phrase("argument '{old}' renamed to '{name}'", old=old_name, name=name)
            pair.add(text, removed.pop(old_name), element, _find_lost_value_reason(pair, graphs.old, old_name))
        elif name in added:
            _report_added_argument(pair, name, element)
    for name, element in removed.items():
        reason = _find_lost_value_reason(pair, graphs.old, name)
        text = phrase("argument '{name}' removed", name=name)
        pair.add(text if reason else phrase("unused argument '{name}' removed", name=name), element, None, reason)


def _report_added_argument(pair: PartPair, name: str, element: Element) -> None:
    default = element.attributes.get("default")
    if default is None:
        reason = phrase("callers must pass '{name}'", name=name)
        pair.add(phrase("argument '{name}' without a default added", name=name), None, element, reason)
        return
    pair.add(phrase("argument '{name}' added, with the default '{value}'", name=name, value=default), None, element)


def _find_lost_value_reason(pair: PartPair, graph: IncludeGraph, name: str) -> Phrase | None:
    """Return why removing an argument is breaking, or None if its values had no effect."""
    if is_unused_argument(graph, pair.old_path, name):
        return None
    return phrase("a value that a caller passes for '{name}' has no effect", name=name)


def _get_defaults(arguments: Mapping[str, Element]) -> dict[str, str | None]:
    return {name: element.attributes.get("default") for name, element in arguments.items()}


def _compare_argument(pair: PartPair, old: Element, new: Element) -> None:
    name = new.attributes["name"]
    old_default, new_default = old.attributes.get("default"), new.attributes.get("default")
    if old_default == new_default:
        return
    if old_default is None and new_default is not None:
        pair.add(phrase("argument '{name}' has the default '{value}' now", name=name, value=new_default), old, new)
        return
    if new_default is None:
        text = phrase("argument '{name}' no longer has a default", name=name)
        pair.add(text, old, new, phrase("callers must pass '{name}'", name=name))
        return
    text = change_text(phrase("default of argument '{name}'", name=name), old_default or "''", new_default or "''")
    if pair.is_complete or pair.is_read(is_old=False):
        pair.add(text, old, new)  # the robots show the effect
        return
    parts = compare_chosen_parts(pair.old, pair.new, name, (old_default or "", new_default))
    reason = phrase("robots of callers that do not pass '{name}' lack these parts", name=name)
    pair.add(parts.describe(text), old, new, reason if parts.removed else None)


def _is_declared_by_robots(graph: IncludeGraph, path: str, name: str) -> bool:
    """Return whether all robots that include a file declare an argument."""

    def is_declared(outline: Outline) -> bool:
        return name in outline.arguments

    robots = graph.find_robots_with(path) or [path]
    return all(graph.declares(robot, is_declared) for robot in robots)


def find_renamed_macros(pair: PartPair, similarity: Mapping[tuple[str, str], float]) -> Iterator[tuple[str, str]]:
    """Yield the old and new names of renamed macros, whose contents are similar.

    Args:
        pair: both versions of the part.
        similarity: the share of equal elements of two macros, from 0 to 1, by their names.
    """
    used_names: set[str] = set()
    for name in pair.old.macros:
        if name in pair.new.macros:
            continue
        unused = [other for other in pair.new.macros if other not in pair.old.macros and other not in used_names]
        best = max(unused, key=lambda other: similarity[name, other], default=None)
        if best is not None and similarity[name, best] > 0:
            used_names.add(best)
            yield name, best
