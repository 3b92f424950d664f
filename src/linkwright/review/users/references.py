"""Find paths to missing files and refused script options in launch files."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import SourceText, Span, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.packages.readers.launch_files import read_launch_file
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.launches.programs.missing import RepositoryPackage, find_packages
from linkwright.review.launches.programs.script_options import find_refused_options
from linkwright.review.launches.switched_off_files import is_switched_off
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.sources.names import PYTHON_SUFFIX
from linkwright.review.users.installed_readers import find_named_paths
from linkwright.review.versions import Version, Versions

LAUNCH_SUFFIXES = (".launch.py", "_launch.py", ".launch.xml", "_launch.xml", ".launch", ".launch.yaml", ".launch.yml")
"""The ends of the names of launch files whose paths are searched."""


_COMMENT = re.compile(r"#[^\n]*")
_WORD = re.compile(r"[\w.-]+")
_FILE_USE = re.compile(
    r"\b(?:exists|isfile|is_file|isdir|is_dir|write|write_text|dump|copy\w*|mkdir|makedirs|glob|listdir)\s*\("
    r"|\bopen\s*\([^\n]*[\"'][wax][bt+]*[\"']|^\s*except\b",
    re.MULTILINE,
)
"""A statement with which a launch file checks whether a file exists, or makes one."""


def find_lost_references(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield launch files with paths to missing files or refused options, and the changes.

    A missing file exists only in the old version, or a changed launch file names it for the first time.
    So is a file that the build file does not install, although it installs the launch file. Both are not breaking in an
    added launch file, which has no users yet, or if only a new argument that is off by default needs the file.
    A script does not accept a refused option.
    """
    yield from find_refused_options(versions, changed_files)
    lost = {file.old_path for file in changed_files if file.old_path and file.old_path != file.new_path}
    names = {PurePosixPath(path).name for path in lost}
    changed = {file.new_path: file.old_path for file in changed_files if file.new_path}
    renamed = PackageNames(find_renamed_packages(versions))
    for path in find_launch_files(versions.new):
        text = versions.new.text(path) if names or path in changed else ""
        is_user = any(name in text for name in names)
        if not is_user and path not in changed:
            continue
        source = SourceText(str(versions.new.file(path)), text)
        known = None
        if path in changed and not _may_make_files(text, path):
            known = _list_known_paths(versions.old, changed[path], renamed)
        reported: set[tuple[str, str]] = set()
        named = list(find_share_paths(source, path))
        dropped = (known or set()) - {(package, subpath) for package, subpath, _ in named}
        for package, subpath, span in named:
            if (package, subpath) in reported:
                continue
            reported.add((package, subpath))
            if is_user and _is_lost(versions, path, package, subpath, lost):
                yield path, _make_change(path, package, subpath, span, is_lost=True)
            elif known is not None and (package, subpath) not in known and "*" not in subpath:
                change = _explain_missing(versions.new, path, package, subpath, span)
                if change is not None:
                    old_path = changed[path]  # an added file has no users yet
                    is_harmless = (
                        old_path is None
                        or _replaces_missing(versions.old, old_path, package, subpath, dropped)
                        or _is_beside_others(versions, path, package, subpath, known - dropped)
                        or is_switched_off(versions, path, old_path, package, subpath)
                    )
                    yield path, replace(change, effect=Effect.CHANGED, reason=None) if is_harmless else change


def _list_known_paths(version: Version, path: str | None, renamed: PackageNames) -> set[tuple[str, str]]:
    """Return the paths that the old version of a launch file names, with the new names of renamed packages."""
    source = SourceText(str(version.file(path or "")), version.text(path) if path else "")
    paths = {(package, subpath) for package, subpath, _ in find_share_paths(source, path or "")}
    for package, subpath in tuple(paths):
        new_package = renamed.translate_package(package)
        paths.add((new_package, subpath))
        share = version.share_of(package, version.file(path or "").parent)
        if share is None or not (share / subpath).exists():  # a file that was there must be renamed, too
            paths.add((new_package, renamed.rename_derived(subpath)))
    return paths


def _replaces_missing(
    version: Version, path: str, package: str, subpath: str, dropped: Collection[tuple[str, str]]
) -> bool:
    """Return whether a path takes the place of one in the same folder that launch files did not find either.

    Args:
        version: the old version.
        path: the path of the launch file in it.
        package: the package of the new path.
        subpath: the path in the package.
        dropped: the packages and paths that only the old version names.
    """
    file, span = PurePosixPath(subpath), Span(path, 1, 1, 1, 1)
    return any(
        (other_package, other.parent, other.suffix) == (package, file.parent, file.suffix)
        and _explain_missing(version, path, package, str(other), span) is not None
        for other_package, other in ((name, PurePosixPath(text)) for name, text in dropped)
    )


def _is_beside_others(
    versions: Versions, path: str, package: str, subpath: str, named: Collection[tuple[str, str]]
) -> bool:
    """Return whether a launch file of ROS 1 named other files of a folder that its package did not install either.

    It only works with the source folder of the package, in which the new file is, too.

    Args:
        versions: both versions.
        path: the path of the launch file.
        package: the package of the new path.
        subpath: the path in the package.
        named: the packages and paths that both versions of the launch file name.
    """
    owner, folder = find_packages(versions.old).get(package), PurePosixPath(subpath).parent
    others = [other for name, other in named if name == package and PurePosixPath(other).parent == folder]
    is_source = owner is not None and owner.is_ros1 and not _is_missing(versions.new, package, subpath)
    return is_source and any(_is_left_out(versions.old, owner, path, other) for other in others if owner is not None)


def _may_make_files(text: str, path: str) -> bool:
    """Return whether a launch file in Python checks which files exist, or makes files."""
    return path.endswith(PYTHON_SUFFIX) and _FILE_USE.search(text) is not None


def find_share_paths(source: SourceText, path: str) -> Iterator[tuple[str, str, Span]]:
    """Yield the paths in share folders that a launch file names.

    Each is given as the package, the path in it, and the location in the launch file.
    """
    if path.endswith(PYTHON_SUFFIX):
        for item in read_launch_file(source, path).paths:
            yield item.package, item.path, item.span
        return
    for named_path in find_named_paths(source, path):
        if named_path.package and named_path.path and named_path.is_complete:
            yield named_path.package, named_path.path, named_path.span


def _explain_missing(version: Version, path: str, package: str, subpath: str, span: Span) -> Change | None:
    """Return the change that a launch file names a missing file, or None if the file may exist."""
    if _is_missing(version, package, subpath):
        return _make_change(path, package, subpath, span, is_lost=False)
    owner = find_packages(version).get(package)
    if owner is None or not _is_left_out(version, owner, path, subpath):
        return None
    text = phrase("names '{file}' of '{package}', which is not installed", file=subpath, package=package)
    reason = phrase("the launch file does not find the file")
    if owner.is_ros1:
        reason = phrase("the launch file does not find the file in an installed workspace")
    return Change(text, Effect.BREAKING, reason, Location(path, span.line, span.column))


def _is_left_out(version: Version, owner: RepositoryPackage, path: str, subpath: str) -> bool:
    """Return whether build files install a launch file, but not a file that exists and that it names."""
    facts = owner.facts
    file = PurePosixPath(owner.folder) / subpath
    if facts is None or not version.file(file.as_posix()).is_file():
        return False
    words = set(_WORD.findall(_COMMENT.sub("", owner.build_text)))
    if not facts.is_complete and words.intersection(PurePosixPath(subpath).parts):
        return False  # a command whose effect is unknown may install it
    folder = version.package_of(path)
    user = next((package for package in find_packages(version).values() if package.folder == folder), None)
    is_installed = user is not None and path in _list_installed(user)
    target = f"share/{facts.project}/{subpath}"
    return (
        is_installed and bool(facts.files) and not ({file.as_posix(), target} & {*_list_installed(owner), *facts.files})
    )


def _list_installed(package: RepositoryPackage) -> set[str]:
    """Return the paths of the files that a package installs, relative to the root."""
    files = () if package.facts is None else package.facts.files.values()
    return {(PurePosixPath(package.folder) / source).as_posix() for source in files}


def _is_missing(version: Version, package: str, subpath: str) -> bool:
    """Return whether a package of the repository certainly does not have a file."""
    owner = find_packages(version).get(package)
    share = version.shares.get(package)
    if owner is None or share is None or (share / subpath).exists() or ".." in PurePosixPath(subpath).parts:
        return False
    path = PurePosixPath(owner.folder) / subpath
    commit = version.commit
    unknown = set() if commit is None else {*commit.removed_links, *commit.missing_files}
    is_unknown = any(part.as_posix() in unknown for part in (path, *path.parents))
    return (
        not owner.may_generate
        and owner.facts is not None
        and path.name not in owner.build_text
        and not is_unknown
        and not version.ignores(path.as_posix())
    )


def _is_lost(versions: Versions, path: str, package: str, subpath: str, lost: Collection[str]) -> bool:
    """Return whether a file of a package was removed or renamed."""
    old_share, new_share = (
        version.share_of(package, version.file(path).parent) for version in (versions.old, versions.new)
    )
    if new_share is not None and (new_share / subpath).exists():
        return False
    if old_share is None and new_share is not None:  # build tools skipped the old package
        return versions.new.relative(new_share / subpath) in lost
    if old_share is None or not (old_share / subpath).is_file():
        return False
    return versions.old.relative(old_share / subpath) in lost


def _make_change(path: str, package: str, subpath: str, span: Span, *, is_lost: bool) -> Change:
    text = phrase("names '{file}' of '{package}', which does not exist", file=subpath, package=package)
    if is_lost:
        text = phrase("names '{file}' of '{package}', which no longer exists", file=subpath, package=package)
    reason = phrase("the launch file does not find the file")
    return Change(text, Effect.BREAKING, reason, Location(path, span.line, span.column))
