"""Compare the files that two versions of a build file install."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from pathlib import PurePosixPath

from linkwright.diagnostics import Phrase, counted, joined_first, phrase
from linkwright.packages.manifest import MANIFEST
from linkwright.review.changes import MAX_NAMES, Change, Effect
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.facts import BuildFacts, find_own_include_text, list_names, summarize_files
from linkwright.review.renames.packages import PackageNames, find_renamed_packages

_HEADERS = "include/"
_EXPORTED_DESCRIPTION = re.compile(r"\bplugin\s*=\s*[\"']\$\{prefix\}/([\w./-]+)[\"']")
"""The description of plugins that a manifest exports. pluginlib finds the file by this entry."""
_MIN_FOLDERS = 3
"""The minimum number of folders with the same change of their destination that share a line."""


def compare_installed_files(pair: FilePair, old: BuildFacts, new: BuildFacts) -> None:
    """Report files of both versions that only one installs, or whose destination differs."""
    old_sources, new_sources = ({source: target for target, source in facts.files.items()} for facts in (old, new))
    new_sources_by_old = {source: _find_installed_source(pair, old, new, source) for source in old_sources}
    names_of_packages = PackageNames(find_renamed_packages(pair.versions))
    is_renamed_package = old.project != new.project
    exported = _EXPORTED_DESCRIPTION.findall(pair.versions.new.text(f"{new.package}/{MANIFEST}".lstrip("/")))
    moved: dict[tuple[str, str], list[str]] = {}
    moved_with_export: dict[tuple[str, str], list[str]] = {}
    removed: list[str] = []
    renamed_headers: list[str] = []
    for source, target in old_sources.items():
        installed_source = new_sources_by_old[source]
        new_target = None if installed_source is None else new_sources.get(installed_source)
        if installed_source is None or target in new.files:
            continue
        if new_target is None:
            if new.unknown <= old.unknown:
                removed.append(target)
        elif (
            installed_source == source
            and old.strip_project(target) != new.strip_project(new_target)
            and not _keeps_include_text(source, old.find_include_texts(target), new.find_include_texts(new_target))
        ):
            folders = _get_folder(target), _get_folder(new_target)
            is_renamed = folders[0] == folders[1]
            is_exported = new_target.removeprefix(f"share/{new.project}/") in exported
            (moved_with_export if is_exported else moved).setdefault(folders, []).append(
                f"{_get_file_name(target)} -> {_get_file_name(new_target)}" if is_renamed else _get_file_name(target)
            )
        elif (
            is_renamed_package
            and target.startswith(_HEADERS)
            and names_of_packages.rename_derived(target) not in new.files
        ):
            renamed_headers.append(f"{target.removeprefix(_HEADERS)} -> {new_target.removeprefix(_HEADERS)}")
    added = [target for source, target in new_sources.items() if target not in old.files and source not in old_sources]
    if is_renamed_package:
        known = {names_of_packages.rename_derived(target) for target in old.files}
        known |= {new_sources[source] for source in new_sources_by_old.values() if source in new_sources}
        added = [target for target in added if target not in known]
    _report_moved_files(pair, moved, phrase("programs that look for the files do not find them"))
    _report_moved_files(pair, moved_with_export, None)
    if renamed_headers:
        text = phrase("headers renamed: {names}", names=list_names(renamed_headers))
        pair.add(text, None, phrase("code of other packages that includes them does not build"))
    if added and old.unknown <= new.unknown:
        _report_newly_installed_files(pair, old, new, added)
    for_tests = [target for target in removed if target in old.test_files]
    if for_tests:
        names = list_names(summarize_files(for_tests, new.files))
        pair.add(phrase("no longer installed for tests: {names}", names=names), None)
    removed = [target for target in removed if old.offers_file(target)]
    if removed:
        reason = phrase("programs that look for the files do not find them")
        pair.changes.append(make_uninstalled_change(summarize_files(removed, new.files), reason))


def make_uninstalled_change(names: Sequence[str], reason: Phrase | None) -> Change:
    """Return the breaking change that a build file no longer installs files and folders."""
    text = phrase("no longer installed: {names}", names=list_names(names))
    return Change(text, Effect.BREAKING, reason, uninstalled=tuple(names))


def _keeps_include_text(source: str, old: Collection[str], new: Collection[str]) -> bool:
    """Return whether other packages include an installed header as before, or as the sources do, which failed before.

    Args:
        source: the path of the header relative to the package.
        old: the texts by which other packages include the old file.
        new: the texts by which they include the new file.
    """
    own_text = find_own_include_text(source)
    return bool(old) and (set(new).issuperset(old) or (own_text in new and own_text not in old))


def _report_moved_files(pair: FilePair, moved: Mapping[tuple[str, str], Sequence[str]], reason: Phrase | None) -> None:
    """Report installed files with a different destination, by their old and new folders.

    Folders that are in another folder together, with the same paths in it, share a line.
    """
    groups: dict[tuple[str, str], dict[str, int]] = {}
    for folders, names in moved.items():
        old_base, new_base, inner = _split_moved_folder(*folders)
        groups.setdefault((old_base, new_base), {})[inner] = len(names)
    groups = {bases: counts for bases, counts in groups.items() if len(counts) >= _MIN_FOLDERS and all(bases)}
    for (old_base, new_base), counts in groups.items():
        items = [
            counted("{folder} with {count} file", "{folder} with {count} files", count, folder=f"'{folder or '.'}/'")
            for folder, count in counts.items()
        ]
        text = phrase(
            "installed in {new} instead of {old}: {names}",
            old=old_base,
            new=new_base,
            names=joined_first(items, MAX_NAMES),
        )
        pair.add(text, None, reason)
    for (old_folder, new_folder), names in moved.items():
        if _split_moved_folder(old_folder, new_folder)[:2] in groups:
            continue
        text = phrase(
            "installed in {new} instead of {old}: {names}", old=old_folder, new=new_folder, names=list_names(names)
        )
        if old_folder == new_folder:
            text = phrase(
                "installed under another name in {folder}: {names}", folder=old_folder, names=list_names(names)
            )
        pair.add(text, None, reason)


def _split_moved_folder(old: str, new: str) -> tuple[str, str, str]:
    """Return the parts of two paths before their common end, and this end."""
    old_parts, new_parts = PurePosixPath(old).parts, PurePosixPath(new).parts
    common = 0
    while common < min(len(old_parts), len(new_parts)) and old_parts[-1 - common] == new_parts[-1 - common]:
        common += 1
    bases = ("/".join(parts[: len(parts) - common]) for parts in (old_parts, new_parts))
    return next(bases), next(bases), "/".join(old_parts[len(old_parts) - common :])


def _report_newly_installed_files(pair: FilePair, old: BuildFacts, new: BuildFacts, added: Sequence[str]) -> None:
    """Report newly installed folders, newly installed files of the old version, and files of other folders."""
    names_of_packages = PackageNames(find_renamed_packages(pair.versions))
    old_files = {names_of_packages.rename_derived(target): source for target, source in old.files.items()}
    read = {_get_folder(source) for source in old.files.values()}
    known = [name for name in added if _is_in_old_version(pair, old, new.files[name])]
    known += [name for name in added if name not in known and _get_folder(new.files[name]) not in read]
    folders = [name for name in summarize_files(added, old_files) if name.endswith("/")]
    shown = list(dict.fromkeys([*folders, *summarize_files(known, old_files)]))
    if shown:
        pair.add(phrase("installed now: {names}", names=list_names(shown)), None)


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


def _get_folder(path: str) -> str:
    return PurePosixPath(path).parent.as_posix()


def _get_file_name(path: str) -> str:
    return PurePosixPath(path).name
