"""Find files that a build file no longer installs because they were removed or renamed."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change, Effect
from linkwright.review.files.build.facts import BuildFacts, FactKind, list_names, summarize_files
from linkwright.review.files.build.installed_files import make_uninstalled_change
from linkwright.review.installed_paths import find_build_file, find_python_packages, read_package_facts
from linkwright.review.kinds import find_rule
from linkwright.review.launch_paths import contains_actions
from linkwright.review.renames.packages import find_renamed_packages
from linkwright.review.sources.reading import is_generated, read_source_names
from linkwright.review.versions import TEST_FOLDERS, Version, Versions

_HEADERS = "include/"
_TARGETS = (FactKind.EXECUTABLE, FactKind.LIBRARY, FactKind.EXPORTED_TARGET)
"""The kinds of targets of a removed build file that others start or link to."""
_TEST_CONDITION = "BUILD_TESTING"


def find_lost_files(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the build files that no longer install files of the old version, with changes.

    Files with their own comparison are left out.
    """
    moved_packages = {package.old_folder for package in find_renamed_packages(versions)}
    changed = {file.path for file in changed_files}
    removed = {file.old_path for file in changed_files if file.new_path is None}
    packages: dict[str, list[ChangedFile]] = {}
    for file in changed_files:
        if file.old_path is None or file.old_path == file.new_path or file.is_submodule:
            continue
        package = versions.old.package_of(file.old_path)
        if package is None or package in moved_packages or _is_material_of_lost_meshes(versions.new, file.old_path):
            continue
        if _reports_nothing(versions.old, file.old_path):
            packages.setdefault(package, []).append(file)
    for package, files in packages.items():
        path = find_build_file(versions.new, package)
        old, new = read_package_facts(versions.old, package), read_package_facts(versions.new, package)
        if path is not None and old is not None and new is not None:
            changes = [
                *_find_lost_targets(files, old, new, is_compared=path in changed),
                *_find_lost_modules(versions, files, old),
            ]
            if find_build_file(versions.old, package) in removed:
                changes += _find_lost_facts(old, new)
            yield from ((path, change) for change in changes)


def _is_material_of_lost_meshes(version: Version, path: str) -> bool:
    """Return whether a file has materials of OBJ meshes, all of which left its folder and have lines of their own."""
    return path.endswith(".mtl") and not any(version.file(path).parent.glob("*.obj"))


def _reports_nothing(version: Version, path: str) -> bool:
    """Return whether no other line tells that a file is removed, as for a launch file with any name."""
    rule = find_rule(path)
    return (rule is None or rule.removal_reason is None) and not contains_actions(version, path)


def _find_lost_targets(
    files: Sequence[ChangedFile], old: BuildFacts, new: BuildFacts, *, is_compared: bool
) -> Iterator[Change]:
    """Yield the changes about files that are no longer installed.

    Headers and other files get separate changes.
    """
    if not new.unknown <= old.unknown:
        return
    sources = {_relative_to_package(old, file.old_path or ""): file for file in files}
    installed = set(new.files.values())
    lost = []
    for target, source in old.files.items():
        file = sources.get(source)
        if file is None or target in new.files or not old.offers_file(target):
            continue
        if is_compared and file.new_path is not None and _relative_to_package(new, file.new_path) not in installed:
            continue  # the comparison of the build files reports it
        lost.append(target)
    headers = [target for target in lost if target.startswith(_HEADERS)]
    other_targets = [target for target in lost if target not in headers]
    for targets, reason in (
        (headers, phrase("code of other packages that includes them does not build")),
        (other_targets, phrase("programs that look for the files do not find them")),
    ):
        if targets:
            yield make_uninstalled_change(summarize_files(targets, new.files), reason)


def _find_lost_facts(old: BuildFacts, new: BuildFacts) -> Iterator[Change]:
    """Yield the changes about targets of a removed build file that the build file in its place does not have."""
    if new.unknown:
        return
    kept = {fact.name for fact in new.facts} | {PurePosixPath(target).stem for target in new.files}
    for kind in _TARGETS:
        facts = [fact for fact in old.facts if fact.kind is kind and _TEST_CONDITION not in fact.condition]
        names = list(dict.fromkeys(fact.name for fact in facts if PurePosixPath(fact.name).stem not in kept))
        if names:
            text = phrase("{kind} removed: {names}", kind=kind.title, names=list_names(names))
            yield Change(text, Effect.BREAKING, kind.reason)
            kept |= {PurePosixPath(name).stem for name in names}


def _relative_to_package(facts: BuildFacts, path: str) -> str:
    """Return a path relative to the package, or unchanged if the file is outside of it."""
    pure_path = PurePosixPath(path)
    return pure_path.relative_to(facts.package).as_posix() if pure_path.is_relative_to(facts.package) else path


def _find_lost_modules(versions: Versions, files: Sequence[ChangedFile], old: BuildFacts) -> Iterator[Change]:
    """Yield the changes about removed and renamed Python modules."""
    packages = find_python_packages(versions.old, old.package)
    removed: dict[bool, list[str]] = {}
    for file in files:
        module = _find_module_name(old, file.old_path or "", packages)
        if module is None:
            continue
        is_harmless = read_source_names(versions.old.file(file.old_path or "")).is_program
        is_harmless = is_harmless or (file.new_path is None and is_generated(versions.old.text(file.old_path or "")))
        new_module = None if file.new_path is None else _find_module_name(old, file.new_path, packages)
        if new_module is None:
            removed.setdefault(is_harmless, []).append(module)
        elif new_module != module:
            text = phrase("Python module '{old}' renamed to '{new}'", old=module, new=new_module)
            yield _make_module_change(text, is_harmless=is_harmless)
    for is_harmless, names in removed.items():
        text = phrase("{kind} removed: {names}", kind=FactKind.MODULE.title, names=list_names(names))
        yield _make_module_change(text, is_harmless=is_harmless)


def _make_module_change(text: Phrase, *, is_harmless: bool) -> Change:
    """Return the change to a module.

    The change is not breaking for a program or a generated module.
    """
    return Change(text) if is_harmless else Change(text, Effect.BREAKING, FactKind.MODULE.reason)


def _find_module_name(facts: BuildFacts, path: str, packages: Collection[str]) -> str | None:
    """Return the module name of a file in an installed Python package; None for other files."""
    pure_path = PurePosixPath(_relative_to_package(facts, path))
    if pure_path.suffix != ".py" or not TEST_FOLDERS.isdisjoint(pure_path.parts):
        return None
    for package in packages:
        folder = PurePosixPath(package)
        for base in (folder, PurePosixPath("src") / folder):
            if pure_path.is_relative_to(base):
                parts = (*PurePosixPath(folder.name).parts, *pure_path.relative_to(base).with_suffix("").parts)
                return ".".join(part for part in parts if part != "__init__")
    return None
