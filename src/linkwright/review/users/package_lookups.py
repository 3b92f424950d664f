"""Find files that look for the files of another package than before, on which their package does not depend."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import PurePosixPath

from linkwright.diagnostics import LinkwrightError, Phrase, SourceText, Span, phrase, quoted_names
from linkwright.files.git_repository import ChangedFile
from linkwright.lint.dependencies import depends_indirectly_on, is_in_every_workspace
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.texts.comments import CPP_SUFFIXES, XML_SUFFIXES, without_comments
from linkwright.review.versions import TEST_FOLDERS, Version, Versions
from linkwright.xacro.cache import read_document

_SUFFIXES = (".py", *CPP_SUFFIXES, *XML_SUFFIXES, ".launch.yaml", ".launch.yml")
_SUBSTITUTION = re.compile(r"\$\(find(?:-pkg-share)?\s+(?P<package>[\w.-]+)\s*\)")
_CPP_LOOKUP = re.compile(r"\b(?:get_package_share_directory|package::getPath)\s*\(\s*\"(?P<package>[\w.-]+)\"\s*\)")
_PYTHON_LOOKUPS = ("get_package_share_directory", "get_package_share_path", "FindPackageShare")
_ROS1_LOOKUPS = ("get_path", "get_pkg_dir")
_ROS1_MODULES = re.compile(r"\b(?:rospkg|roslib)\b")


def find_new_lookups(versions: Versions, changed_files: Sequence[ChangedFile]) -> Iterator[tuple[str, Change]]:
    """Yield the files that look for another package that their own package does not name, each with a change.

    A package that the repository has, that every installation has, or that another file of the package looked for
    before, does not count. Tests are left out.
    """
    renamed = PackageNames(find_renamed_packages(versions))
    for file in changed_files:
        old_path, new_path = file.old_path, file.new_path
        if old_path is None or new_path is None or file.is_submodule or not new_path.endswith(_SUFFIXES):
            continue
        if not TEST_FOLDERS.isdisjoint(PurePosixPath(new_path).parts):
            continue
        old = {renamed.rename_derived(name) for name in _read_lookups(versions.old, old_path)}
        new = _read_lookups(versions.new, new_path)
        lost, gained = sorted(old - new.keys()), {name: span for name, span in new.items() if name not in old}
        for name, span in gained.items() if lost else ():
            is_new = not _is_looked_up(versions.old, old_path, renamed, name)
            if is_new and not _is_available(versions.new, new_path, name):
                yield new_path, _make_change(new_path, name, lost, span)


def _make_change(path: str, name: str, lost: Sequence[str], span: Span) -> Change:
    text = phrase(
        "looks for files of '{name}' instead of {names}, but package.xml does not name '{name}'",
        name=name,
        names=quoted_names(lost),
    )
    return Change(text, Effect.BREAKING, _make_reason(name), Location(path, span.line, span.column))


def _make_reason(name: str) -> Phrase:
    return phrase("it fails where '{name}' is not installed", name=name)


def drop_told_lookups(changes: Sequence[Change]) -> list[Change]:
    """Return the changes of a file without lookups of packages that another breaking change of it names."""
    lookup = _make_reason("").template
    reasons = [change.reason for change in changes if change.reason is not None]
    told = {reason.arguments.get("name") for reason in reasons if reason.template != lookup}
    return [
        change
        for change in changes
        if change.reason is None or change.reason.template != lookup or change.reason.arguments.get("name") not in told
    ]


def _is_looked_up(version: Version, path: str, renamed: PackageNames, name: str) -> bool:
    """Return whether a file of the package of a path looks for a package in a version, by the new name of it."""
    folder = version.package_of(path)
    return any(
        any(renamed.rename_derived(other) == name for other in _read_lookups(version, file))
        for file in version.paths(_SUFFIXES)
        if version.package_of(file) == folder and TEST_FOLDERS.isdisjoint(PurePosixPath(file).parts)
    )


def _is_available(version: Version, path: str, name: str) -> bool:
    """Return whether a package is there for a file: through its package's dependencies, or in the repository."""
    folder = version.package_of(path)
    if folder is None or version.share_of(name, version.file(path).parent) is not None:
        return True
    try:
        manifest = Manifest(read_document(str(version.file(folder) / MANIFEST)))
    except LinkwrightError:
        return True
    return (
        manifest.declares(name)
        or any("$" in dependency.name for dependency in manifest.dependencies)
        or is_in_every_workspace(name, is_ros1=manifest.is_ros1)
        or depends_indirectly_on(manifest, name, version.finder(version.file(folder)))
    )


def _read_lookups(version: Version, path: str) -> dict[str, Span]:
    """Return the packages whose share folder a file looks for, each with the first location."""
    source = SourceText(str(version.file(path)), version.text(path))
    lookups: dict[str, Span] = {}
    if path.endswith(".py"):
        for name, span in _read_python_lookups(source):
            lookups.setdefault(name, span)
        return lookups
    pattern = _CPP_LOOKUP if path.endswith(CPP_SUFFIXES) else _SUBSTITUTION
    for match in pattern.finditer(without_comments(source.text, path)):
        lookups.setdefault(match["package"], source.span(match.start("package"), match.end("package")))
    return lookups


def _read_python_lookups(source: SourceText) -> Iterator[tuple[str, Span]]:
    with suppress(SyntaxError, ValueError, RecursionError):
        python = PythonFile(source)
        names = (*_PYTHON_LOOKUPS, *(_ROS1_LOOKUPS if _ROS1_MODULES.search(source.text) else ()))
        for call in python.calls(*names):
            name = python.text(call.args[0]) if call.args else None
            if name is not None:
                yield name, python.span(call.args[0])
