"""Compare the facts of build files that other packages depend on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import PurePosixPath
from typing import TypeAlias

from linkwright.diagnostics import Phrase, Span, joined, phrase, quoted_names
from linkwright.review.changes import MAX_NAMES
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build_commands import compare_other_commands
from linkwright.review.files.cmake_branches import is_test_condition
from linkwright.review.renamed_packages import PackageNames, find_renamed_packages
from linkwright.review.versions import Version

_MIN_FOLDER_PARTS = 3
"""The minimum number of path parts of a folder that replaces its files in a report."""

_PATH_FOLDER = "bin"
"""The folder below the prefix that is in ``PATH``."""
_PROGRAM_FOLDER_PREFIX = "lib/"
"""The start of the folders in which launch files find programs."""


class FactKind(Enum):
    """The kind of a fact: its title, and the reason why removing such a fact is breaking."""

    EXECUTABLE = (
        phrase("installed executables"),
        phrase("launch files and users that start them do not find them"),
    )
    LIBRARY = (
        phrase("installed libraries"),
        phrase("packages and programs that link to them or load them do not build or start"),
    )
    BUILT_EXECUTABLE = (
        phrase("built executables"),
        phrase("launch files and users that start them do not find them"),
    )
    BUILT_LIBRARY = (
        phrase("built libraries"),
        phrase("packages and programs that link to them or load them do not build or start"),
    )
    BUILT_TARGET = (phrase("built targets"), None)
    EXPORTED_TARGET = (phrase("exported targets"), phrase("packages that link to them do not build"))
    EXPORTED_FOLDER = (
        phrase("exported include folders"),
        phrase("packages that include their headers do not build"),
    )
    COMPONENT = (
        phrase("components"),
        phrase("launch files that load them into a container do not find them"),
    )
    PLUGIN_DESCRIPTION = (
        phrase("exported plugin descriptions"),
        phrase("programs that load their classes do not find them"),
    )
    INTERFACE = (phrase("built interfaces"), phrase("programs that use the types do not build or start"))
    INTERFACE_DEPENDENCY = (phrase("dependencies of interfaces"), None)
    DYNAMIC = (
        phrase("descriptions for dynamic_reconfigure"),
        phrase("programs that change the parameters do not build or start"),
    )
    MODULE = (phrase("installed Python modules"), phrase("programs that import them do not find them"))
    ENTRY_POINT = (phrase("entry points"), phrase("programs that load them do not find them"))
    PACKAGE = (phrase("calls of find_package"), None)
    EXPORTED_DEPENDENCY = (
        phrase("exported dependencies"),
        phrase("packages that have them only through this package do not build"),
    )
    STOP = (phrase("errors that stop the build"), None)
    TEST = (phrase("tests"), None)
    SETTING = (phrase("settings"), None)
    INCLUDE_FOLDER = (phrase("absolute include folders"), None)
    FOLDER = (phrase("installed folders that the repository does not have"), None)

    def __init__(self, title: Phrase, reason: Phrase | None) -> None:
        self.title = title
        self.reason = reason


INSTALLED_KINDS = (FactKind.EXECUTABLE, FactKind.LIBRARY)
"""The kinds of targets that are installed."""
BUILT_KINDS = (FactKind.BUILT_EXECUTABLE, FactKind.BUILT_LIBRARY, FactKind.BUILT_TARGET)
"""The kinds of built targets that are reported even if they are not installed."""
_CONDITIONAL_KINDS = (*INSTALLED_KINDS, *BUILT_KINDS, FactKind.COMPONENT, FactKind.STOP, FactKind.PACKAGE)
"""The kinds whose conditions are shown when they are added or removed."""
ANY_VERSION = "any version"
"""The value for a package without a required version."""


@dataclass(frozen=True)
class Fact:
    """A fact of a build file.

    Attributes:
        kind: the kind of thing that the fact describes, such as an installed library.
        name: the name of the target, package or other subject.
        value: a property that may change, such as the function of an executable; empty if there is none.
        span: the location in the file.
        is_value_used: whether other packages use the value, so that a different value is breaking.
        condition: the condition under which the fact holds, as written in the file; empty for always.
    """

    kind: FactKind
    name: str
    value: str = ""
    span: Span | None = None
    is_value_used: bool = False
    condition: str = ""


_STANDARD_VARIABLES = frozenset(
    {"HOME", "PATH", "PWD", "USER", "CC", "CXX", "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH"}
)


class EnvironmentVariables:
    """The environment variables that the build reads, by name, with their locations.

    Args:
        variables: the names and locations. Variables that ROS and the system set themselves are left out.
    """

    def __init__(self, variables: Iterable[tuple[str, Span | None]]) -> None:
        self._spans: dict[str, Span | None] = {}
        for name, span in variables:
            if not name.startswith("ROS_") and name not in _STANDARD_VARIABLES:
                self._spans.setdefault(name, span)

    def compare(self, pair: FilePair, new: EnvironmentVariables) -> None:
        """Report the variables that only one version reads."""
        for name, span in new._spans.items():
            if name not in self._spans:
                text = phrase("environment variable '{name}' decides what is built", name=name)
                pair.add(text, pair.location(span))
        for name, span in self._spans.items():
            if name not in new._spans:
                text = phrase("environment variable '{name}' no longer decides what is built", name=name)
                reason = phrase("a value that a user sets for '{name}' has no effect", name=name)
                pair.add(text, pair.location(span, is_old=True), reason)


@dataclass
class TargetParts:
    """The parts of a target of CMake.

    Attributes:
        libraries: the names of packages and libraries that are linked to it, with their locations.
        sources: its sources relative to the package, with their locations.
        is_test: whether it is a test.
        is_test_program: whether it is a test that is built as a program.
    """

    libraries: dict[str, Span] = field(default_factory=dict)
    sources: dict[str, Span] = field(default_factory=dict)
    is_test: bool = False
    is_test_program: bool = False


@dataclass
class BuildFacts:
    """The facts of a build file.

    Attributes:
        facts: the known facts.
        files: the sources of the installed files relative to the package, by destination relative to the prefix.
        unknown: the reasons why more files may be installed than `files` contains.
        other_commands: the other commands or settings, each with its name and its text.
        package: the path of the folder of the package relative to the root.
        project: the name of the package; empty if it is not known.
        environment: the environment variables that the file reads.
        targets: the parts of targets, by target.
        header_paths: the headers and folders of headers relative to the package that other packages find although
            `files` does not contain them.
    """

    facts: list[Fact] = field(default_factory=list)
    files: dict[str, str] = field(default_factory=dict)
    unknown: frozenset[str] = frozenset()
    other_commands: list[tuple[str, str]] = field(default_factory=list)
    package: str = ""
    project: str = ""
    environment: EnvironmentVariables = field(default_factory=lambda: EnvironmentVariables(()))
    targets: dict[str, TargetParts] = field(default_factory=dict)
    header_paths: frozenset[str] = frozenset()

    @property
    def is_complete(self) -> bool:
        """Whether `files` contains all installed files."""
        return not self.unknown

    def strip_project(self, path: str) -> str:
        """Return an installed path without the name of the package.

        The manifest reports a new package name.
        """
        parts = PurePosixPath(path).parts
        is_own = len(parts) > 1 and parts[1] == self.project
        return PurePosixPath(parts[0], *parts[2:]).as_posix() if is_own else path


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
        _report_renamed(pair, kind, removed, added, _find_renamed_targets(pair, old, new))
        if kind is FactKind.STOP:
            _report_reworded_errors(pair, removed, added)
        _report_unpaired(pair, kind, removed, added, is_replaced=_exports_folders_otherwise(kind, new))
    _report_conditions(pair, conditions)
    _report_repeated_exports(pair, old, new)
    _compare_files(pair, old, new)
    compare_other_commands(pair, old.other_commands, new.other_commands)
    old.environment.compare(pair, new.environment)


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
        pair.add(_format_facts(kind, added, is_added=True), pair.location(added[0].span), reason)
    if removed:
        location = pair.location(removed[0].span, is_old=True)
        is_harmless = is_replaced or all(is_test_condition(fact.condition) for fact in removed)
        reason = None if is_harmless else kind.reason
        pair.add(_format_facts(kind, removed, is_added=False), location, reason)


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
    pair: FilePair, kind: FactKind, removed: list[Fact], added: list[Fact], targets: Mapping[str, str]
) -> None:
    """Report the renamed facts, and remove them from both lists.

    Args:
        pair: both versions of the build file.
        kind: the common kind of all facts.
        removed: the facts of the old version.
        added: the facts of the new version.
        targets: the new names of targets that have the same sources, by old name.
    """
    names = PackageNames(find_renamed_packages(pair.versions))
    for old in list(removed):
        new = next((fact for fact in added if fact.name == names.rename_derived(old.name)), None)
        new = new or next((fact for fact in added if names.has_same_edit(old.name, fact.name)), None)
        new = new or next((fact for fact in added if fact.name == targets.get(old.name)), None)
        if kind is FactKind.TEST:
            new = new or next((fact for fact in added if fact.value == old.name), None)
        if new is not None:
            removed.remove(old)
            added.remove(new)
            text = phrase("{kind}: '{old}' renamed to '{new}'", kind=kind.title, old=old.name, new=new.name)
            pair.add(text, pair.location(new.span), None if is_test_condition(old.condition) else kind.reason)


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


def _find_renamed_targets(pair: FilePair, old: BuildFacts, new: BuildFacts) -> dict[str, str]:
    """Return the new names of renamed targets by old name.

    A renamed target keeps its first source.
    """
    sources = {
        next(iter(parts.sources)): name
        for name, parts in new.targets.items()
        if parts.sources and not old.targets.get(name, TargetParts()).sources
    }
    renamed = {}
    for name, parts in old.targets.items():
        source = next((find_new_source(pair, old, new, item) for item in parts.sources), None)
        if source in sources and not new.targets.get(name, TargetParts()).sources:
            renamed[name] = sources[source]
    return renamed


def find_new_source(pair: FilePair, old: BuildFacts, new: BuildFacts, source: str) -> str:
    """Return the path of a source in the new version.

    Args:
        pair: both versions of the build file.
        old: the facts of the old version.
        new: the facts of the new version.
        source: the path in the old version.

    Returns:
        The path relative to the package; the old path if the file was not renamed.
    """
    path = (PurePosixPath(old.package) / source).as_posix()
    new_path = next((file.new_path for file in pair.versions.changed_files if file.old_path == path), None)
    is_inside = new_path is not None and PurePosixPath(new_path).is_relative_to(new.package)
    return PurePosixPath(new_path).relative_to(new.package).as_posix() if new_path and is_inside else source


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


def list_names(names: Sequence[str]) -> Phrase:
    """Return the names as a list, or the first names and the number of the remaining ones."""
    first = quoted_names(names[:MAX_NAMES])
    if len(names) <= MAX_NAMES:
        return first
    return phrase("{names} and {count} more", names=first, count=len(names) - MAX_NAMES)


def _is_reported(pair: FilePair, facts: BuildFacts, fact: Fact) -> bool:
    """Return whether a difference in a fact is reported here.

    An interface file that only one version has is reported as a file instead.
    """
    if fact.kind is not FactKind.INTERFACE:
        return True
    path = (PurePosixPath(facts.package) / fact.name).as_posix()
    return pair.versions.old.file(path).is_file() == pair.versions.new.file(path).is_file()


# --- installed files --------------------------------------------------------------------------------------------------


def _compare_files(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report files of both versions that only one installs, or whose destination differs."""
    old_sources, new_sources = ({source: target for target, source in facts.files.items()} for facts in (old, new))
    new_sources_by_old = {source: _find_installed_source(pair, old, new, source) for source in old_sources}
    moved: dict[tuple[str, str], list[str]] = {}
    removed: list[str] = []
    for source, target in old_sources.items():
        installed_source = new_sources_by_old[source]
        new_target = None if installed_source is None else new_sources.get(installed_source)
        if installed_source is None or target in new.files:
            continue
        if new_target is None:
            if new.unknown <= old.unknown:
                removed.append(target)
        elif installed_source == source and old.strip_project(target) != new.strip_project(new_target):
            folders = _get_folder(target), _get_folder(new_target)
            is_renamed = folders[0] == folders[1]
            moved.setdefault(folders, []).append(
                f"{_get_file_name(target)} -> {_get_file_name(new_target)}" if is_renamed else _get_file_name(target)
            )
    added = [target for source, target in new_sources.items() if target not in old.files and source not in old_sources]
    _report_moved_files(pair, moved)
    if added and old.unknown <= new.unknown:
        _report_newly_installed_files(pair, old, new, added)
    if removed:
        names = summarize_files(removed, new.files)
        text = phrase("no longer installed: {names}", names=list_names(names))
        pair.add(text, None, phrase("programs that look for the files do not find them"))


def _report_moved_files(pair: FilePair, moved: Mapping[tuple[str, str], Sequence[str]]) -> None:
    """Report installed files with a different destination, by their old and new folders."""
    for (old_folder, new_folder), names in moved.items():
        text = phrase(
            "installed in {new} instead of {old}: {names}", old=old_folder, new=new_folder, names=list_names(names)
        )
        if old_folder == new_folder:
            text = phrase(
                "installed under another name in {folder}: {names}", folder=old_folder, names=list_names(names)
            )
        pair.add(text, None, phrase("programs that look for the files do not find them"))


def _report_newly_installed_files(pair: FilePair, old: BuildFacts, new: BuildFacts, added: Sequence[str]) -> None:
    """Report newly installed folders, newly installed files of the old version, and files of other folders."""
    read = {_get_folder(source) for source in old.files.values()}
    known = [name for name in added if _is_in_old_version(pair, old, new.files[name])]
    known += [name for name in added if name not in known and _get_folder(new.files[name]) not in read]
    folders = [name for name in summarize_files(added, old.files) if name.endswith("/")]
    names = list(dict.fromkeys([*folders, *summarize_files(known, old.files)]))
    if names:
        pair.add(phrase("installed now: {names}", names=list_names(names)), None)


def _find_installed_source(pair: FilePair, old: BuildFacts, new: BuildFacts, source: str) -> str | None:
    """Return the path of an installed file in the new version; None if it is absent there."""
    path = (PurePosixPath(old.package) / source).as_posix()
    new_path = next((file.new_path for file in pair.versions.changed_files if file.old_path == path), path)
    if new_path is None or not pair.versions.new.file(new_path).is_file():
        return None
    pure_path = PurePosixPath(new_path)
    return pure_path.relative_to(new.package).as_posix() if pure_path.is_relative_to(new.package) else None


def _is_in_old_version(pair: FilePair, old: BuildFacts, source: str) -> bool:
    return pair.versions.old.file((PurePosixPath(old.package) / source).as_posix()).is_file()


def summarize_files(targets: Sequence[str], others: Mapping[str, str]) -> list[str]:
    """Return installed files, or their folders.

    A folder replaces its files if the other version installs nothing in it.
    """
    other_folders = {parent.as_posix() for target in others for parent in PurePosixPath(target).parents}
    names: dict[str, None] = {}
    for target in targets:
        parents = (parent for parent in PurePosixPath(target).parents if len(parent.parts) >= _MIN_FOLDER_PARTS)
        folders = [parent.as_posix() for parent in parents]
        outermost = next((folder for folder in reversed(folders) if folder not in other_folders), None)
        names[target if outermost is None else f"{outermost}/"] = None
    return list(names)


def _get_folder(path: str) -> str:
    return PurePosixPath(path).parent.as_posix()


def _get_file_name(path: str) -> str:
    return PurePosixPath(path).name


# --- other commands ---------------------------------------------------------------------------------------------------
