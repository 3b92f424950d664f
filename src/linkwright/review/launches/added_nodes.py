"""Decide which added launch actions are breaking: they may fail, take the place of others or rename topics.

So may a removed remapping for the nodes that follow.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.effects import find_addition_reason, offers_nothing
from linkwright.review.launches.include_trees import IncludeTree, find_moved_remapping
from linkwright.review.launches.included import IncludedActions
from linkwright.review.launches.name_effects import find_remapping_reason
from linkwright.review.launches.outlines import CONDITION, REMAPPING, Entry, LaunchOutline, without_condition
from linkwright.review.launches.programs.sides import Side, find_old_side, is_new_name
from linkwright.review.launches.python.package_lookups import looks_up_package
from linkwright.review.required_packages import is_undeclared_and_new
from linkwright.review.sources.names import PYTHON_SUFFIX

_PROGRAM = re.compile(r"(?P<package>[a-z][a-z0-9_]*)/\S+")
_RUN_COMMAND = re.compile(r"\[?(?:ros2,? run|rosrun),? (?P<package>[a-z][a-z0-9_]*),? .+")
"""The command of a process, as a text or a list of words, that starts a program of a package."""
_INCLUDED_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w-]+)\)/.+")


def explain_addition(
    pair: FilePair, entry: Entry, removed: Sequence[Entry], included: tuple[IncludedActions, IncludedActions]
) -> Phrase | None:
    """Return the reason why an added action is breaking, or None if it is not.

    Args:
        pair: both versions of the launch file.
        entry: the action that only the new version has.
        removed: the actions that only the old version has.
        included: the actions of both versions with those of the included files.
    """
    old, new = (actions.outline for actions in included)
    if entry.kind == "remapping":
        return _find_group_remapping_reason(pair, entry, included)
    if entry.kind == "argument" and _is_read_without_declaration(entry.name, old):
        return None  # callers had to pass it before, too
    reason = find_addition_reason(entry, new) or find_missing_package_reason(pair, entry, new)
    return reason or _find_remapping_reason(entry, removed, old, new)


def _is_read_without_declaration(name: str, outline: LaunchOutline) -> bool:
    """Return whether a launch file reads an argument without a default, which it does not declare."""
    if any(entry.name == name for entry in outline.entries if entry.has_value):
        return False
    substitutions = (f"$(var {name})", f"$(arg {name})")
    texts = (text for entry in outline.entries for text in (entry.name, *entry.settings.values()))
    return any(substitution in text for text in texts for substitution in substitutions)


def find_missing_package_reason(pair: FilePair, entry: Entry, outline: LaunchOutline) -> Phrase | None:
    """Return the reason why the package of an action is missing, or None if it is not certainly missing.

    The action must start if callers pass no values, or the launch file must look up the package in any case.
    """
    package = _find_package(entry, outline)
    if package is None or offers_nothing(entry):
        return None
    starts = evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) is True
    if not starts and not (entry.kind == "include" and looks_up_package(pair.new_file, package)):
        return None
    if not is_undeclared_and_new(pair.versions, pair.new_path, package):
        return None
    if entry.kind == "include":
        return phrase("package.xml does not name '{name}', without which the launch file fails", name=package)
    return phrase("package.xml does not name '{name}', without which the node does not start", name=package)


def _find_remapping_reason(
    entry: Entry, removed: Sequence[Entry], old: LaunchOutline, new: LaunchOutline
) -> Phrase | None:
    """Return the reason why the remappings of a node are breaking that takes the place of an included file.

    Only absolute names of the node, which it had before, count.
    """
    package = _find_package(entry, new) if entry.kind == "node" else None
    included = [other for other in removed if other.kind == "include" and _find_package(other, old) == package]
    conditions = {other.settings.get(CONDITION) for other in included}
    if package is None or conditions != {entry.settings.get(CONDITION)}:
        return None
    names = {
        without_condition(setting).removeprefix(REMAPPING): value
        for setting, value in entry.settings.items()
        if setting.startswith(REMAPPING)
    }
    lost = [name for name, value in names.items() if name.startswith("/") and new.resolve(value) != name]
    if not lost:
        return None
    return phrase(
        "if the included file published or served {names}, programs that use the names do not find them",
        names=quoted_names(lost),
    )


def _find_group_remapping_reason(
    pair: FilePair, entry: Entry, included: tuple[IncludedActions, IncludedActions]
) -> Phrase | None:
    """Return the reason why an added remapping for the nodes that follow is breaking, or None if it is not.

    A node that both versions start may publish or serve the name. One of an unknown included file counts, too.
    """
    old, new = (actions.outline for actions in included)
    trees = IncludeTree(included[1]), IncludeTree(included[0])
    if evaluate_condition(new.resolve(entry.settings.get(CONDITION, ""))) is False:
        return None
    if find_moved_remapping(entry, *trees) is not None or _is_remapped_by_nodes(entry.name, old):
        return None
    programs = _count_followers(included[1], entry) & included[0].count_all_started_programs()
    sides = _find_sides(pair, entry.name, programs)
    offering = sides - {Side.USES, Side.LACKS}
    if not offering:
        return None
    target = entry.settings.get("to")
    return find_remapping_reason(entry.name, None, target, new, new, is_known=sides == {Side.OFFERS})


def may_be_offered(pair: FilePair, remapping: Entry, included: tuple[IncludedActions, IncludedActions]) -> bool:
    """Return whether a node that both versions start may offer a name that a removed action remapped for it.

    Args:
        pair: both versions of the launch file.
        remapping: the action that only the old version has.
        included: the actions of both versions with those of the included files.
    """
    old, new = included
    programs = _count_followers(old, remapping) & new.count_all_started_programs()
    return not _find_sides(pair, remapping.name, programs) <= {Side.USES, Side.LACKS}


def _count_followers(actions: IncludedActions, remapping: Entry) -> Counter[tuple[str, str]]:
    """Return the programs that start with a remapping: those of its group, or in Python all of the file."""
    if actions.file.suffix == PYTHON_SUFFIX:
        return actions.count_all_started_programs()
    followers = [entry for entry in actions.outline.entries if remapping.name in dict(entry.remappings)]
    resolve = actions.outline.resolve
    included = sum(map(actions.count_started_programs, followers), Counter[tuple[str, str]]())
    return included + Counter((entry.kind, resolve(entry.name)) for entry in followers if entry.kind == "node")


def _find_sides(pair: FilePair, name: str, programs: Iterable[tuple[str, str]]) -> set[Side]:
    """Return whether programs offer or use a name that only their groups remap."""
    roots = pair.versions.old.root, pair.versions.new.root
    sides = set()
    for kind, program in programs:
        file = _INCLUDED_FILE.fullmatch(program) if kind == "include" else None
        program = f"{file['package']}/" if file is not None else program
        if kind in ("include", "node") and not is_new_name(program, name, *roots):
            sides.add(find_old_side(program, name, *roots))
    return sides


def _is_remapped_by_nodes(name: str, outline: LaunchOutline) -> bool:
    """Return whether nodes of a launch file remap a name themselves."""
    settings = {without_condition(setting) for entry in outline.entries for setting in entry.settings}
    return f"{REMAPPING}{name}" in settings


def _find_package(entry: Entry, outline: LaunchOutline) -> str | None:
    """Return the package of a program or of an included file; None for other actions."""
    pattern = {"node": _PROGRAM, "process": _RUN_COMMAND, "include": _INCLUDED_FILE}.get(entry.kind)
    match = None if pattern is None else pattern.fullmatch(outline.resolve(entry.name))
    return None if match is None else match["package"]
