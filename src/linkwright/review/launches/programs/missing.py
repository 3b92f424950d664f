"""Find launch files that start programs which the packages of the repository do not have."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.lint.targets import find_targets
from linkwright.packages.manifest import MANIFEST, package_name
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.caching import cached_in_review
from linkwright.review.changes import Change, Effect, Location, Subject
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build.facts import BuildFacts, FactKind
from linkwright.review.installed_paths import read_package_facts
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.launches.common_files import find_known_files
from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, PROGRAM_KINDS, Entry
from linkwright.review.launches.programs.generation import may_make_files
from linkwright.review.launches.reading import read_outline
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.versions import TEST_FOLDERS, Version, Versions
from linkwright.xacro.cache import read_document

_BUILD_SUFFIXES = ("CMakeLists.txt", ".cmake", "setup.py", "setup.cfg", "pyproject.toml")
_PROGRAM_KINDS = (FactKind.EXECUTABLE, FactKind.BUILT_EXECUTABLE)
_SCRIPT_SUFFIXES = (".py", ".sh", ".bash", ".pl", ".rb")
_STARTS = (
    "starts '{package}/{name}', which does not exist",
    "starts '{package}/{name}', which is no longer installed",
    "starts '{package}/{name}', which no longer exists",
    "starts '{package}/{name}', which is not executable",
)
_FINDING = "LW844"
"""The finding about a program that a launch file starts and that does not exist."""
_FILE_FINDING = "LW842"
"""The finding about a file that a launch file names and that does not exist."""
MISSING_FILE = "names '{file}' of '{package}', which does not exist"
"""The sentence about such a file."""
_LOST_ENTRY_POINTS = (
    "executable '{name}': its module '{module}' was removed",
    "executable '{name}': its function '{function}' was removed",
)
_ENTRY_POINT_FINDING = "LW827"
"""The finding about an executable whose module or function does not exist."""
_FINDINGS = {
    **dict.fromkeys(_STARTS, _FINDING),
    **dict.fromkeys(_LOST_ENTRY_POINTS, _ENTRY_POINT_FINDING),
    MISSING_FILE: _FILE_FINDING,
}
"""The finding about the same problem, by the sentence of the change."""
_COMMENT = re.compile(r"#[^\n]*")
_COMPUTED_NAME = re.compile(
    r"\b(?:foreach|macro|function|include)\s*\(|add_executable\s*\(\s*[^\s)]*\$\{(?!PROJECT_NAME\})"
    r"|\b(?:OUTPUT_NAME|SUFFIX)\s+[^\s)]*\$|\bfor\b.*\bin\b",
    re.IGNORECASE,
)
"""A command of a build file that may build programs whose names it does not contain."""
_PACKAGE_OF_PATH = re.compile(r"\$\(find(?:-pkg-share|-pkg-prefix)? (?P<package>[\w.-]+)\)")
_UNKNOWN_PROGRAM = re.compile(r"[$/*:\s]")
"""A character of a name that is computed, or that is the class of a component."""
_FILE_OF_PACKAGE = re.compile(r"\$\(find-pkg-share (?P<package>[\w.-]+)\)/(?P<path>[^$]+)")
_INCLUDED_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?P<path>[^$]*\.(?:launch|xml|py|ya?ml))")


@dataclass(frozen=True)
class RepositoryPackage:
    """The programs of a package in one version.

    Args:
        version: the version of the repository.
        folder: the folder of the package relative to the root; empty for the root.
    """

    version: Version
    folder: str

    @cached_property
    def facts(self) -> BuildFacts | None:
        """The facts of the build file, or None if it cannot be read."""
        return read_package_facts(self.version, self.folder)

    @cached_property
    def names(self) -> frozenset[str]:
        """The names of all files of the package."""
        return frozenset(name for _, _, names in os.walk(self.version.file(self.folder)) for name in names)

    @cached_property
    def is_ros1(self) -> bool:
        """Whether launch files also find the scripts in the source folder of the package."""
        return Manifest(read_document(str(self.version.file(self.folder) / MANIFEST))).is_ros1

    @cached_property
    def build_text(self) -> str:
        """The text of all build files."""
        return "\n".join(self.version.text(path) for path in self.version.paths(_BUILD_SUFFIXES, self.folder))

    @cached_property
    def programs(self) -> frozenset[str]:
        """The names of the programs that the package builds or installs and whose scripts exist."""
        if self.facts is None:
            return frozenset()
        programs = {fact.name for fact in self.facts.facts if fact.kind in _PROGRAM_KINDS}
        installed = {
            PurePosixPath(target).name: source
            for target, source in self.facts.files.items()
            if PurePosixPath(target).parts[:2] == ("lib", self.facts.project)
        }
        programs |= installed.keys()
        return frozenset(
            name for name in programs if not name.endswith(_SCRIPT_SUFFIXES) or self._may_have_script(name, installed)
        )

    def _may_have_script(self, name: str, installed: Mapping[str, str]) -> bool:
        source = PurePosixPath(installed.get(name, name)).name
        is_built = self.facts is not None and (name in self.facts.targets or "entry_points" in self.build_text)
        return source in self.names or is_built or self.may_generate

    @cached_property
    def may_generate(self) -> bool:
        """Whether the build can make files, or a part of the package is in another repository."""
        submodules = map(PurePosixPath, self.version.submodules)
        return may_make_files(self.build_text) or any(path.is_relative_to(self.folder) for path in submodules)

    @cached_property
    def may_compute_names(self) -> bool:
        """Whether the build may make programs whose names the build files do not contain."""
        return _COMPUTED_NAME.search(_COMMENT.sub("", self.build_text)) is not None

    def _names_foreign_path(self, name: str) -> bool:
        """Return whether a build file names a script by a path that may lead out of the package."""
        paths = re.findall(rf"[^\s\"'()]*{re.escape(name)}", self.build_text)
        return any(".." in path or "$" in path for path in paths)

    def has_only_unexecutable(self, name: str) -> bool:
        """Return whether launch files of ROS 1 find a script in the source folder only, where it is not executable."""
        if not self.is_ros1 or name in self.programs or self.facts is None or self.facts.unknown:
            return False
        paths = [path for path in self.version.paths((name,), self.folder) if PurePosixPath(path).name == name]
        return bool(paths) and not any(os.access(self.version.file(path), os.X_OK) for path in paths)

    def has(self, name: str) -> bool:
        """Return whether launch files certainly find a program."""
        return name in self.programs or (self.is_ros1 and name in self.names)

    def lacks(self, name: str) -> bool:
        """Return whether launch files certainly do not find a program."""
        if self.has(name) or self.may_generate or self.facts is None:
            return False
        if name.endswith(_SCRIPT_SUFFIXES):
            if name in self.names and (self.facts.unknown or PurePosixPath(name).stem in self.build_text):
                return False
            return not self._names_foreign_path(name) and not {name + ".in", PurePosixPath(name).stem} & self.names
        return not re.search(rf"(?<![\w.-]){re.escape(name)}(?![\w.-])", self.build_text)


def find_missing_programs(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that start a program which the new version does not have, each with a change.

    The program was removed, or a changed launch file starts it for the first time and it does not exist.
    """
    changed = {file.new_path: file.old_path for file in changed_files if file.new_path}
    packages = _find_shared_packages(versions)
    folders = {versions.old.package_of(file.old_path) for file in changed_files if file.old_path}
    changed_packages = {name for name, (old, _) in packages.items() if old.folder in folders}
    new_names = {package.old_name: package.new_name for package in find_renamed_packages(versions)}
    for path in find_launch_files(versions.new):
        text = versions.new.text(path)
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
            continue
        if path not in changed and not any(name in text for name in changed_packages):
            continue
        old_path = changed.get(path, path)
        old_nodes = _read_nodes(versions.old, old_path) if old_path else []
        old_names = {_translate_package(entry.name, new_names) for entry in old_nodes}
        reported: set[str] = set()
        for entry in _read_nodes(versions.new, path):
            package, _, name = entry.name.partition("/")
            if package not in packages or not name or entry.name in reported or _UNKNOWN_PROGRAM.search(name):
                continue
            old, new = packages[package]
            is_first = path in changed and entry.name not in old_names
            is_script = name.endswith(_SCRIPT_SUFFIXES)
            is_unexecutable = is_first and is_script and new.has_only_unexecutable(name)
            if not is_unexecutable and not new.lacks(name):
                continue
            change = None
            if is_unexecutable:
                change = phrase("starts '{package}/{name}', which is not executable", name=name, package=package)
            elif old.has(name) and package in changed_packages:
                change = _make_removal_change(package, name, is_left=name in new.names)
            elif is_first and (is_script or not new.may_compute_names):
                change = phrase("starts '{package}/{name}', which does not exist", name=name, package=package)
            if change is not None:
                reported.add(entry.name)
                location = Location(path, entry.span.line, entry.span.column)
                yield path, Change(change, Effect.BREAKING, phrase("the node does not start"), location)


def lacks_program(version: Version, entry: Entry) -> bool:
    """Return whether a launch action starts a program that its package in the repository certainly does not have."""
    package, _, name = entry.name.partition("/")
    owner = find_packages(version).get(package) if entry.kind in PROGRAM_KINDS else None
    if owner is None or not name or _UNKNOWN_PROGRAM.search(name):
        return False
    return owner.lacks(name) and (name.endswith(_SCRIPT_SUFFIXES) or not owner.may_compute_names)


def lacks_executable(version: Version, entry: Entry) -> bool:
    """Return whether a launch action starts a program that its package lacks, or a script that is not executable."""
    package, _, name = entry.name.partition("/")
    owner = find_packages(version).get(package) if entry.kind in PROGRAM_KINDS else None
    is_unexecutable = owner is not None and name.endswith(_SCRIPT_SUFFIXES) and owner.has_only_unexecutable(name)
    return is_unexecutable or lacks_program(version, entry)


def lacks_included_file(version: Version, entry: Entry) -> bool:
    """Return whether a launch action includes a file that its package in the repository certainly does not install."""
    match = _FILE_OF_PACKAGE.fullmatch(entry.name) if entry.kind == "include" else None
    owner = None if match is None else find_packages(version).get(match["package"])
    if match is None or owner is None or owner.facts is None or owner.is_ros1:
        return False
    target = f"share/{owner.facts.project}/{match['path']}"
    is_known = owner.facts.is_complete and not owner.may_generate and owner.facts.project == match["package"]
    return is_known and bool(owner.facts.files) and target not in owner.facts.files


def find_missing_file(version: Version, entry: Entry, includer: Path) -> tuple[str, str] | None:
    """Return the package and path of an included launch file that certainly does not exist, or None.

    The build may install a file elsewhere, so no folder of the package has a file of this name.

    Args:
        version: the version of the repository.
        entry: the action that includes the file.
        includer: the launch file with the action.
    """
    match = _INCLUDED_FILE.fullmatch(entry.name) if entry.kind == "include" else None
    if match is None:
        return None
    package, path = match["package"], match["path"]
    owner, known = find_packages(version).get(package), find_known_files(package)
    if owner is None:
        is_common = known is not None and version.share_of(package, includer.parent) is None
        return (package, path) if is_common and known is not None and PurePosixPath(path).name not in known else None
    name = PurePosixPath(path).name
    is_missing = name not in owner.names and f"{name}.in" not in owner.names and not owner.may_generate
    return (package, path) if is_missing or lacks_included_file(version, entry) else None


def _translate_package(program: str, new_names: Mapping[str, str]) -> str:
    """Return a program with the new name of its package."""
    package, separator, name = program.partition("/")
    return f"{new_names.get(package, package)}{separator}{name}"


def find_old_package_names(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the launch files that still use the old name of a renamed package, each with a change."""
    if not any(PurePosixPath(file.path).name == MANIFEST for file in changed_files):
        return
    new_names = {package.old_name: package.new_name for package in find_renamed_packages(versions)}
    new_names = {old: new for old, new in new_names.items() if old != new and old not in versions.new.shares}
    for path in find_launch_files(versions.new) if new_names else ():
        text = versions.new.text(path)
        is_test = not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts)
        reported: set[str] = set()
        for entry in [] if is_test or not any(name in text for name in new_names) else read_actions(versions.new, path):
            for package in _find_named_packages(entry):
                if package not in new_names or package in reported:
                    continue
                reported.add(package)
                change = phrase(
                    "names the package '{package}', whose name is '{name}' now",
                    package=package,
                    name=new_names[package],
                )
                location = Location(path, entry.span.line, entry.span.column)
                yield (
                    path,
                    Change(change, Effect.BREAKING, phrase("the launch file does not find the package"), location),
                )


def uses_package(version: Version, path: str, package: str) -> bool:
    """Return whether a launch file uses a package in an action that its defaults may make, apart from tests."""
    if not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts) or package not in version.text(path):
        return False
    try:
        outline = read_outline(version.file(path), version.root)
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return False
    return any(
        package in _find_named_packages(entry)
        and evaluate_condition(outline.resolve(entry.settings.get(CONDITION, ""))) is not False
        for entry in outline.entries
    )


def _find_named_packages(entry: Entry) -> Iterator[str]:
    """Yield the packages whose programs or files an action uses."""
    if entry.kind in PROGRAM_KINDS and "/" in entry.name:
        yield entry.name.partition("/")[0]
    for text in (entry.name, *entry.settings.values()):
        yield from (match["package"] for match in _PACKAGE_OF_PATH.finditer(text))


def drop_told_findings(subjects: Sequence[Subject], findings: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Return the findings without those about programs and files that a breaking line of the same file names."""
    told = {
        (subject.path, _FINDINGS[change.sentence.template], change.sentence.arguments.get(_get_key(change.sentence)))
        for subject in subjects
        for change in subject.changes
        if change.sentence.template in _FINDINGS
    }
    return [finding for finding in findings if _get_missing(finding) not in told]


def _get_key(sentence: Phrase) -> str:
    """Return the argument of a sentence that names the missing program or file."""
    return "file" if sentence.template == MISSING_FILE else "name"


def _get_missing(finding: Diagnostic) -> tuple[str, str, object]:
    """Return the file, the code, and the name of the program or file of a finding."""
    arguments = getattr(finding.message, "arguments", {})
    path = "" if finding.span is None else finding.span.file
    return path, finding.code, arguments.get("path" if finding.code == _FILE_FINDING else "executable")


def _make_removal_change(package: str, name: str, *, is_left: bool) -> Phrase:
    if is_left:
        return phrase("starts '{package}/{name}', which is no longer installed", name=name, package=package)
    return phrase("starts '{package}/{name}', which no longer exists", name=name, package=package)


def _find_shared_packages(versions: Versions) -> dict[str, tuple[RepositoryPackage, RepositoryPackage]]:
    """Return the packages that both versions have exactly once, by their new name."""
    old, new = find_packages(versions.old), find_packages(versions.new)
    shared = {name: (old[name], new[name]) for name in old if name in new}
    for package in find_renamed_packages(versions):
        if package.old_name in old and package.new_name in new:
            shared.setdefault(package.new_name, (old[package.old_name], new[package.new_name]))
    return shared


@cached_in_review(maxsize=8)
def find_packages(version: Version) -> dict[str, RepositoryPackage]:
    """Return the packages that a version has exactly once, by name.

    A package below another one of its name does not count: colcon and catkin do not search in the folder of a package.
    """
    found: dict[str, list[RepositoryPackage]] = {}
    for folder in find_targets([version.root]).packages:
        name, path = package_name(folder), version.relative(folder)
        if name is not None and path is not None:
            found.setdefault(name, []).append(RepositoryPackage(version, "" if path == "." else path))
    outer = {name: [item for item in packages if not _is_below(item, packages)] for name, packages in found.items()}
    return {name: packages[0] for name, packages in outer.items() if len(packages) == 1}


def _is_below(package: RepositoryPackage, others: Sequence[RepositoryPackage]) -> bool:
    """Return whether the folder of a package is below that of another one."""
    parents = PurePosixPath(package.folder).parents if package.folder else ()
    return any(PurePosixPath(other.folder) in parents for other in others)


def _read_nodes(version: Version, path: str) -> list[Entry]:
    """Return the nodes of a launch file; none if it cannot be read."""
    return [entry for entry in read_actions(version, path) if entry.kind in PROGRAM_KINDS]


def read_actions(version: Version, path: str) -> list[Entry]:
    """Return the actions of a launch file; none if it cannot be read."""
    try:
        return read_outline(version.file(path), version.root).entries
    except (LinkwrightError, UnreadableFileError, OSError, ValueError, RecursionError):
        return []
