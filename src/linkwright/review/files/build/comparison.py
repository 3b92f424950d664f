"""Compare two versions of a build file."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import PurePosixPath
from typing import TypeAlias

from linkwright.diagnostics import Phrase, Span, joined, phrase
from linkwright.packages.manifest import MANIFEST, ROSBUILD_MANIFEST
from linkwright.review.changes import Change, Effect
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.cmake_branches import is_test_condition
from linkwright.review.files.build.commands import compare_other_commands
from linkwright.review.files.build.facts import (
    ANY_VERSION,
    BUILT_KINDS,
    INSTALLED_KINDS,
    WITHOUT_NOTHING,
    BuildFacts,
    Fact,
    FactKind,
    find_renamed_targets,
    list_names,
)
from linkwright.review.files.build.installed_files import compare_installed_files
from linkwright.review.files.build.missing_sources import names_missing_file
from linkwright.review.files.build.unused_exports import is_unused_export
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.versions import Version

_KNOWN_MODULES = sys.stdlib_module_names | {
    *("action_msgs", "ament_index_python", "builtin_interfaces", "cv_bridge", "geometry_msgs", "launch", "launch_ros"),
    *("launch_testing", "launch_xml", "launch_yaml", "message_filters", "nav_msgs", "rcl_interfaces", "rclpy"),
    *("roslaunch", "roslib", "rospkg", "rospy", "sensor_msgs", "std_msgs", "std_srvs", "tf", "tf2_py", "tf2_ros"),
    *("urdf_parser_py", "xacro"),
}
"""The modules of Python and of packages of ROS that programs of all packages import."""
_NUMBER = re.compile(r"-?\d+\Z")
"""The number of the version at the end of the name of a package."""
_REFERENCE = re.compile(r"\$\{[^{}]*\}")
"""A variable with a value that only CMake knows."""
_PATH_FOLDER = "bin"
"""The folder below the prefix that is in ``PATH``."""
_PROGRAM_FOLDER_PREFIX = "lib/"
"""The start of the folders in which launch files find programs."""
_CMAKE_COMMENT = re.compile(r"#[^\n]*")
_CATKIN_COMMAND = re.compile(
    r"^[ \t]*(?P<name>catkin_\w+|add_(?:message|service|action)_files|generate_messages)\s*\(", re.MULTILINE
)
_CATKIN_WORD = re.compile(
    r"catkin|CATKIN|^[ \t]*(?:include|macro|function|if)\s*\(\s*(?!NOT CMAKE_|CMAKE_|BUILD_TESTING)", re.MULTILINE
)
"""A text with which a build file may find catkin, define the commands itself, or call them under a condition."""
_CONDITIONAL_KINDS = (*INSTALLED_KINDS, *BUILT_KINDS, FactKind.COMPONENT, FactKind.STOP, FactKind.PACKAGE)
"""The kinds whose conditions are shown when they are added or removed."""


def compare_build_files(
    pair: FilePair,
    read: Callable[[Version, str], BuildFacts],
    compare_more: Callable[[FilePair, BuildFacts, BuildFacts], None] | None = None,
) -> None:
    """Compare two versions of a build file.

    Args:
        pair: both versions of the build file.
        read: the function that returns the facts of a version, from its path in the repository.
        compare_more: a function that compares parts specific to this kind of build file.
    """
    sides = ((pair.versions.old, pair.old_path), (pair.versions.new, pair.new_path))
    versions = {version.file(path): (version, path) for version, path in sides}
    facts = pair.read(lambda file: read(*versions[file]))
    if facts is not None:
        _compare_facts(pair, *facts)
        if compare_more is not None:
            compare_more(pair, *facts)
        _drop_reasons_of_failed_build(pair)


def _drop_reasons_of_failed_build(pair: FilePair) -> None:
    """Tell that only the old build file of ament calls commands of catkin, which it does not find: it built nothing."""
    if _CATKIN_COMMAND.search(pair.versions.new.text(pair.new_path)):
        return
    text = _CMAKE_COMMENT.sub("", pair.versions.old.text(pair.old_path))
    command = _CATKIN_COMMAND.search(text)
    if command is None or _CATKIN_WORD.search(_CATKIN_COMMAND.sub("", text)) or "ament_package" not in text:
        return
    pair.changes[:] = [replace(change, effect=Effect.CHANGED, reason=None) for change in pair.changes]
    sentence = phrase("the old version calls '{name}' without catkin, so that its build fails", name=command["name"])
    pair.changes.append(Change(sentence))


def _compare_facts(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report the differences between the facts of two versions of a build file."""
    conditions: dict[tuple[str, str], list[Fact]] = {}
    for kind in FactKind:
        old_facts, new_facts = _index_facts(
            *(
                [fact for fact in facts.facts if fact.kind is kind and _is_reported(pair, facts, fact)]
                for facts in (old, new)
            )
        )
        for name, fact in new_facts.items():
            if name in old_facts:
                _compare_values(pair, (old, old_facts[name]), (new, fact))
        for name, fact in new_facts.items():
            if name in old_facts and old_facts[name].condition != fact.condition:
                conditions.setdefault((old_facts[name].condition, fact.condition), []).append(fact)
        added = [fact for name, fact in new_facts.items() if name not in old_facts]
        removed = [fact for name, fact in old_facts.items() if name not in new_facts]
        if kind in BUILT_KINDS:
            installed = {fact.name for facts in (old, new) for fact in facts.facts if fact.kind in INSTALLED_KINDS}
            added = [fact for fact in added if fact.name not in installed | _find_test_programs(old)]
            removed = [fact for fact in removed if fact.name not in installed | _find_test_programs(new)]
        private = old.private_libraries if kind is FactKind.BUILT_LIBRARY else frozenset()
        _report_renamed(pair, kind, removed, added, find_renamed_targets(pair.versions, old, new), private)
        if kind is FactKind.STOP:
            _report_reworded_errors(pair, removed, added)
        else:
            _report_replaced(pair, kind, removed, added)
        missing = [fact for fact in removed if names_missing_file(pair.versions.old, pair.old_path, fact)]
        removed = [fact for fact in removed if fact not in missing]
        _report_missing(pair, missing)
        unused = [
            fact
            for fact in removed
            if fact.name in private or is_unused_export(pair.versions.old, pair.old_path, old, new, fact)
        ]
        _report_unpaired(pair, kind, unused, [], is_replaced=True)
        used = [fact for fact in removed if fact not in unused]
        _report_unpaired(pair, kind, used, added, is_replaced=_exports_folders_otherwise(kind, new))
    _report_conditions(pair, conditions)
    _report_repeated_exports(pair, old, new)
    compare_installed_files(pair, old, new)
    _report_defined_routines(pair, old, new)
    old_commands, new_commands = (
        [command for command in facts.other_commands if command[0] not in (old.routines | new.routines)]
        for facts in (old, new)
    )
    compare_other_commands(pair, old_commands, new_commands)
    old.environment.compare(pair, new.environment)


def _report_defined_routines(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report the functions and macros that one version calls and only the other version defines.

    The calls themselves are not changes: only one version shows the commands that they run.
    """
    for name in dict.fromkeys(name for name, _ in old.other_commands if name in new.routines - old.routines):
        pair.add(phrase("'{name}', which the file already called, is defined now", name=name), None)
    for name in dict.fromkeys(name for name, _ in new.other_commands if name in old.routines - new.routines):
        pair.add(phrase("'{name}', which the file still calls, is no longer defined", name=name), None)


_FactIndex: TypeAlias = "dict[tuple[str, str | None], Fact]"
"""The facts of a kind in a version, by name and, for some calls of find_package, condition."""


def _index_facts(old: Sequence[Fact], new: Sequence[Fact]) -> tuple[_FactIndex, _FactIndex]:
    """Return the facts of a kind in two versions. Facts that belong together have the same key.

    The last fact of a name counts, except for packages: calls of find_package under different conditions are
    different facts. If both versions have a package under conditions that the other lacks, these calls are one fact.
    """
    sides = old, new
    if not any(fact.kind is FactKind.PACKAGE for fact in (*old, *new)):
        return {(fact.name, None): fact for fact in old}, {(fact.name, None): fact for fact in new}
    old_keys, new_keys = ({(fact.name, fact.condition) for fact in facts} for facts in sides)
    changed = {name for name, _ in old_keys - new_keys} & {name for name, _ in new_keys - old_keys}
    indexes: list[_FactIndex] = []
    for facts in sides:
        index: _FactIndex = {}
        conditions: dict[str, dict[str, None]] = {}
        for fact in facts:
            key = fact.name, fact.condition
            if fact.name in changed and key not in old_keys & new_keys:
                conditions.setdefault(fact.name, {})[fact.condition] = None
                index[fact.name, None] = replace(fact, condition=_join_conditions(list(conditions[fact.name])))
            else:
                index[key] = fact
        indexes.append(index)
    return indexes[0], indexes[1]


def _join_conditions(conditions: Sequence[str]) -> str:
    """Return the condition under which one of several conditions holds. An empty condition always holds."""
    if "" in conditions:
        return ""
    if len(conditions) == 1:
        return conditions[0]
    return " OR ".join(f"({text})" if " AND " in text else text for text in conditions)


def _find_test_programs(facts: BuildFacts) -> set[str]:
    """Return the targets that are built as programs of tests."""
    return {name for name, parts in facts.targets.items() if parts.is_test_program}


def _compare_values(pair: FilePair, old: tuple[BuildFacts, Fact], new: tuple[BuildFacts, Fact]) -> None:
    """Report a changed value of a fact, unless only the name of the package in a path changed."""
    (old_facts, old_fact), (new_facts, new_fact) = old, new
    if not old_fact.value or not new_fact.value:
        return
    if old_facts.strip_project(old_fact.value) == new_facts.strip_project(new_fact.value):
        return
    kind = new_fact.kind
    text = phrase(
        "{kind}: '{name}': {old} -> {new}",
        kind=kind.title,
        name=new_fact.name,
        old=old_fact.value,
        new=new_fact.value,
    )
    reason = kind.reason if new_fact.is_value_used else None
    is_executable = kind is FactKind.EXECUTABLE
    if is_executable and old_fact.value == _PATH_FOLDER and new_fact.value.startswith(_PROGRAM_FOLDER_PREFIX):
        reason = phrase("commands that find it through PATH fail; launch files find it only now")
    pair.add(text, pair.location(new_fact.span), reason)


def _exports_folders_otherwise(kind: FactKind, new: BuildFacts) -> bool:
    """Return whether exported targets bring folders of headers with them."""
    return kind is FactKind.EXPORTED_FOLDER and any(name == "ament_export_targets" for name, _ in new.other_commands)


def _report_unpaired(
    pair: FilePair, kind: FactKind, removed: Sequence[Fact], added: Sequence[Fact], *, is_replaced: bool
) -> None:
    """Report the facts of a kind that only one version has. Removed facts that others replace are not breaking."""
    if added:
        reason = None
        if kind is FactKind.STOP:
            reason = phrase("the build fails under a condition under which it did not fail before")
        elif kind is FactKind.PACKAGE:
            reason = next((found for found in (_find_guard_reason(pair, fact) for fact in added) if found), None)
        elif kind is FactKind.MODULE:
            reason = _find_hidden_reason(pair, [fact.name for fact in added])
        pair.add(_format_facts(kind, added, is_added=True), pair.location(added[0].span), reason)
    if removed:
        location = pair.location(removed[0].span, is_old=True)
        is_harmless = is_replaced or all(
            is_test_condition(fact.condition) or _was_outside_packages(pair, fact) for fact in removed
        )
        reason = None if is_harmless else kind.reason
        pair.add(_format_facts(kind, removed, is_added=False), location, reason)


def _was_outside_packages(pair: FilePair, fact: Fact) -> bool:
    """Return whether no launch file found an old program, because its folder had no manifest and is none of PATH."""
    is_in_package = pair.versions.old.package_of(pair.old_path, (MANIFEST, ROSBUILD_MANIFEST)) is not None
    return fact.kind is FactKind.EXECUTABLE and fact.value.startswith(_PROGRAM_FOLDER_PREFIX) and not is_in_package


def _can_be_same(name: str, known: str) -> bool:
    """Return whether a name with variables, such as ``gz-sim${VERSION}``, can be a known name."""
    parts = _REFERENCE.split(name)
    return len(parts) > 1 and any(parts) and re.fullmatch(".*".join(map(re.escape, parts)), known) is not None


def _report_missing(pair: FilePair, facts: Sequence[Fact]) -> None:
    """Report removed facts about files that the old version does not have."""
    if facts:
        text = phrase(
            "{change}; the old version does not have the files",
            change=_format_facts(facts[0].kind, facts, is_added=False),
        )
        pair.add(text, pair.location(facts[0].span, is_old=True))


def _report_repeated_exports(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report the plugin descriptions that the new version exports more than once under the same condition."""
    spans: dict[tuple[str, str, str], list[Span | None]] = {}
    old_counts: dict[tuple[str, str, str], int] = {}
    for fact in old.facts:
        key = fact.name, fact.value, fact.condition
        old_counts[key] = old_counts.get(key, 0) + (fact.kind is FactKind.PLUGIN_DESCRIPTION)
    for fact in new.facts:
        if fact.kind is FactKind.PLUGIN_DESCRIPTION:
            spans.setdefault((fact.name, fact.value, fact.condition), []).append(fact.span)
    for key, found in spans.items():
        if len(found) > max(old_counts.get(key, 0), 1):
            text = phrase("plugin description '{name}' is exported {count} times", name=key[0], count=len(found))
            pair.add(text, pair.location(found[-1]))


def _report_renamed(
    pair: FilePair,
    kind: FactKind,
    removed: list[Fact],
    added: list[Fact],
    targets: Mapping[str, str],
    private: Collection[str],
) -> None:
    """Report the renamed facts, and remove them from both lists.

    Args:
        pair: both versions of the build file.
        kind: the common kind of all facts.
        removed: the facts of the old version.
        added: the facts of the new version.
        targets: the new names of targets that have the same sources, by old name.
        private: the names of facts that nothing outside of the package uses.
    """
    names = PackageNames(find_renamed_packages(pair.versions))
    for old in list(removed):
        new = next((fact for fact in added if fact.name == names.rename_derived(old.name)), None)
        new = new or next((fact for fact in added if names.has_same_edit(old.name, fact.name)), None)
        new = new or next((fact for fact in added if fact.name == targets.get(old.name)), None)
        if kind is FactKind.COMPONENT and new is None and len(removed) == len(added) == 1:
            new = next((fact for fact in added if _is_same_component(old.name, fact.name)), None)
        if kind is FactKind.TEST:
            new = new or next((fact for fact in added if fact.value == old.name), None)
        if new is not None:
            removed.remove(old)
            added.remove(new)
            text = phrase("{kind}: '{old}' renamed to '{new}'", kind=kind.title, old=old.name, new=new.name)
            is_harmless = old.name in private or is_test_condition(old.condition)
            pair.add(text, pair.location(new.span), None if is_harmless else kind.reason)


def _is_same_component(old: str, new: str) -> bool:
    """Return whether two names of components are of one class: they share the namespace or the last part."""
    (old_scope, _, old_class), (new_scope, _, new_class) = old.rpartition("::"), new.rpartition("::")
    return old_class == new_class or (bool(old_scope) and old_scope == new_scope)


def _report_replaced(pair: FilePair, kind: FactKind, removed: list[Fact], added: list[Fact]) -> None:
    """Report names that take the place of a removed one, and remove them from both lists.

    These are packages whose name ends with another number, such as ``gz-sim8``, and names with variables that can be
    the old name.
    """
    for old in list(removed):
        base = _NUMBER.sub("", old.name) if kind is FactKind.PACKAGE else old.name
        new = next((fact for fact in added if base != old.name and _NUMBER.sub("", fact.name) == base), None)
        new = new or next((fact for fact in added if _can_be_same(fact.name, old.name)), None)
        if new is not None:
            removed.remove(old)
            added.remove(new)
            text = phrase("{kind}: '{old}' replaced by '{new}'", kind=kind.title, old=old.name, new=new.name)
            pair.add(text, pair.location(new.span), _find_guard_reason(pair, new))


def _find_guard_reason(pair: FilePair, fact: Fact) -> Phrase | None:
    """Return the reason why a new package is breaking, because nothing is built without it; None if it is not.

    A package that the manifest names is installed.
    """
    folder = pair.versions.new.package_of(pair.new_path) or ""
    manifest = pair.versions.new.text((PurePosixPath(folder) / MANIFEST).as_posix())
    if not fact.value.endswith(WITHOUT_NOTHING) or fact.name in manifest:
        return None
    return phrase("without '{name}', which package.xml does not name, nothing is built", name=fact.name)


def _find_hidden_reason(pair: FilePair, modules: Sequence[str]) -> Phrase | None:
    """Return the reason why newly installed modules are breaking, because they hide others; None if they are not.

    The modules of packages come before those of Python in the search path.
    """
    folder = pair.versions.new.package_of(pair.new_path) or ""
    manifest = pair.versions.new.text((PurePosixPath(folder) / MANIFEST).as_posix())
    hidden = [name for name in modules if name in _KNOWN_MODULES and f"<name>{name}</name>" not in manifest]
    if not hidden:
        return None
    return phrase("programs that import the known module '{name}' find this one instead", name=hidden[0])


def _report_reworded_errors(pair: FilePair, removed: list[Fact], added: list[Fact]) -> None:
    """Report errors with a different text under the same condition.

    They are removed from both lists.
    """
    for old in list(removed):
        new = next((fact for fact in added if fact.condition == old.condition), None)
        if new is not None:
            removed.remove(old)
            added.remove(new)
            text = phrase("the error '{old}' has another text: '{new}'", old=old.name, new=new.name)
            pair.add(text, pair.location(new.span))


def _format_facts(kind: FactKind, facts: Sequence[Fact], *, is_added: bool) -> Phrase:
    texts = [_format_fact(fact) for fact in facts]
    return _format_list(kind.title, texts, is_added=is_added)


def _format_fact(fact: Fact) -> str:
    """Return the name of a fact, with its value or condition if a reader needs it."""
    has_version = fact.kind is FactKind.PACKAGE and fact.value not in ("", ANY_VERSION)
    text = f"{fact.name} {fact.value}" if has_version or fact.kind is FactKind.SETTING else fact.name
    is_unconditional = not fact.condition or fact.kind not in _CONDITIONAL_KINDS
    return text if is_unconditional else f"{text} (if {fact.condition})"


def _report_conditions(pair: FilePair, conditions: Mapping[tuple[str, str], Sequence[Fact]]) -> None:
    """Report facts whose condition changed. Facts with the same change share a line."""
    for (old_condition, new_condition), facts in conditions.items():
        kinds = dict.fromkeys(fact.kind for fact in facts)
        groups = (
            phrase(
                "{kind} {names}", kind=kind.title, names=list_names([fact.name for fact in facts if fact.kind is kind])
            )
            for kind in kinds
        )
        text = phrase(
            "{subjects}: {old} -> {new}",
            subjects=joined(groups, "; "),
            old=_format_condition(old_condition),
            new=_format_condition(new_condition),
        )
        pair.add(text, pair.location(facts[0].span))


def _format_condition(condition: str) -> Phrase:
    return phrase("if {condition}", condition=condition) if condition else phrase("always")


def _format_list(title: Phrase, names: Sequence[str], *, is_added: bool) -> Phrase:
    names_text = list_names(names)
    if is_added:
        return phrase("{kind} added: {names}", kind=title, names=names_text)
    return phrase("{kind} removed: {names}", kind=title, names=names_text)


def _is_reported(pair: FilePair, facts: BuildFacts, fact: Fact) -> bool:
    """Return whether a difference in a fact is reported here.

    An interface file that only one version has is reported as a file instead.
    """
    if fact.kind is not FactKind.INTERFACE:
        return True
    path = (PurePosixPath(facts.package) / fact.name).as_posix()
    return pair.versions.old.file(path).is_file() == pair.versions.new.file(path).is_file()
