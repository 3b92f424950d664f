"""Compare the dependencies in package manifests."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build.cmake_files import CMAKE_FILE
from linkwright.review.files.build.exports import exports_nothing
from linkwright.review.files.build.facts import UNSHARED_PACKAGES, EnvironmentVariables
from linkwright.review.renames.packages import PackageNames, find_renamed_packages
from linkwright.review.versions import Version
from linkwright.xmltree import Element

_VERSION_SIGNS = {"version_lt": "<", "version_lte": "<=", "version_eq": "=", "version_gte": ">=", "version_gt": ">"}
_DEPEND = "depend"
_EXPORTED_TAGS = frozenset({_DEPEND, "build_export_depend", "buildtool_export_depend"})
"""The tags of dependencies that dependents of the package also need to build."""
_EXECUTION_TAGS = frozenset({"depend", "exec_depend", "run_depend"})
_VARIABLE = re.compile(r"\$(\w+)")


class _Dependency(NamedTuple):
    """The tag of a dependency, and the package."""

    tag: str
    package: str


_Elements = Mapping[_Dependency, list[Element]]


class _DependencyChange(NamedTuple):
    """A change to dependencies: the tags in both versions, and whether it is breaking."""

    old_tags: str
    new_tags: str
    is_breaking: bool


def compare_dependencies(pair: FilePair, old: Manifest, new: Manifest) -> None:
    """Report changed dependencies and conditions. Packages with the same change share a line."""
    names = PackageNames(find_renamed_packages(pair.versions))
    new_elements = _group_elements(new)
    old_elements: _Elements = {
        _Dependency(tag, names.translate_package(name)): elements
        for (tag, name), elements in _group_elements(old).items()
    }
    old_elements = _correct_names(pair, old_elements, new_elements)
    is_private = exports_nothing(pair.versions.old, pair.old_path)
    is_moved = bool(find_lost_ros_versions(old, new))
    changes: dict[_DependencyChange, list[_Dependency]] = {}
    for package in dict.fromkeys(key.package for key in (*new_elements, *old_elements)):
        before, after = (
            [key for key in elements if key.package == package] for elements in (old_elements, new_elements)
        )
        removed, added = (
            [key for key in keys if key not in others] for keys, others in ((before, after), (after, before))
        )
        if removed or added:
            is_lost = not is_moved and _is_lost(before, after, old, is_private=is_private)
            change = _DependencyChange(_format_tags(removed), _format_tags(added), is_lost)
            changes.setdefault(change, []).append((added or removed)[0])
        if not (removed and added):
            for key in (key for key in after if key in before):
                _compare_conditions(pair, key, old_elements[key], new_elements[key])
    for change in sorted(changes, key=_make_sort_key):
        _report_change(
            pair, change, changes[change], new_elements if change.new_tags else old_elements, _make_lost_reason(old)
        )
    old_variables, new_variables = (
        EnvironmentVariables(_find_condition_variables(elements)) for elements in (old_elements, new_elements)
    )
    old_variables.compare(pair, new_variables)


def _correct_names(pair: FilePair, old: _Elements, new: _Elements) -> _Elements:
    """Report the names with dashes that have underscores now, and return the old dependencies with the new names.

    The build files already named the package with underscores, which the names of packages of ROS have.
    """
    old_names, new_names = (list(dict.fromkeys(key.package for key in elements)) for elements in (old, new))
    spellings = {name.replace("_", "-"): name for name in new_names if name not in old_names}
    corrected = {
        name: spellings[name]
        for name in old_names
        if name not in new_names and name in spellings and _is_named(pair.versions.old, spellings[name])
    }
    for name, spelling in corrected.items():
        keys = [key for key in new if key.package == spelling]
        text = phrase("{tag}: {old} -> {new}", tag=_format_tags(keys), old=name, new=spelling)
        pair.add(text, pair.location(new[keys[0]][0].span()))
    return {key._replace(package=corrected.get(key.package, key.package)): elements for key, elements in old.items()}


def _is_named(version: Version, package: str) -> bool:
    """Return whether a manifest or build file of a version names a package."""
    word = re.compile(rf"(?<![\w-]){re.escape(package)}(?![\w-])")
    return any(word.search(version.text(path)) for path in version.paths((MANIFEST, CMAKE_FILE)))


def find_lost_ros_versions(old: Manifest, new: Manifest) -> frozenset[int]:
    """Return the versions of ROS for which a package that now builds for another one no longer builds."""
    return old.ros_versions - new.ros_versions if new.ros_versions else frozenset()


def _make_sort_key(change: _DependencyChange) -> int:
    """Return a sort key: additions come first, then removals, then changed tags."""
    return 2 if change.old_tags and change.new_tags else 1 if change.old_tags else 0


def _report_change(
    pair: FilePair, change: _DependencyChange, keys: list[_Dependency], elements: _Elements, reason: Phrase
) -> None:
    """Report a change to dependencies, with their conditions."""
    old_tags, new_tags, is_breaking = change
    packages = ", ".join(_append_conditions(key.package, elements[key]) for key in keys)
    if not old_tags:
        text = phrase("{tags} added: {packages}", tags=new_tags, packages=packages)
    elif not new_tags:
        text = phrase("{tags} removed: {packages}", tags=old_tags, packages=packages)
    else:
        text = phrase("{old} -> {new}: {packages}", old=old_tags, new=new_tags, packages=packages)
    location = pair.location(elements[keys[0]][0].span(), is_old=not new_tags)
    pair.add(text, location, reason if is_breaking else None)


def _append_conditions(package: str, elements: list[Element]) -> str:
    conditions = _format_conditions(elements)
    return f"{package} ({conditions})" if conditions else package


def _is_lost(before: list[_Dependency], after: list[_Dependency], manifest: Manifest, *, is_private: bool) -> bool:
    """Return whether dependents no longer get a package through this one.

    An execution dependency is installed with the package, also for building other packages.

    Args:
        before: the old dependencies on the package.
        after: the new dependencies on the package.
        manifest: the old manifest.
        is_private: whether nothing of the package can be used to build others.
    """
    if any(key.package in UNSHARED_PACKAGES for key in before):
        return False
    old_tags, new_tags = ({key.tag for key in keys} for keys in (before, after))
    if _is_metapackage(manifest):
        return not old_tags.isdisjoint(_EXECUTION_TAGS) and new_tags.isdisjoint(_EXECUTION_TAGS)
    exported_tags = _EXPORTED_TAGS - {_DEPEND} if is_private else _EXPORTED_TAGS
    is_exported = not old_tags.isdisjoint(exported_tags) and manifest.build_type != "ament_python"
    return is_exported and new_tags.isdisjoint(_EXPORTED_TAGS | _EXECUTION_TAGS)


def _is_metapackage(manifest: Manifest) -> bool:
    export = manifest.root.first("export")
    return export is not None and export.first("metapackage") is not None


def _make_lost_reason(manifest: Manifest) -> Phrase:
    """Return the reason why losing a package for dependents is breaking.

    Dependents no longer get the package through this one.
    """
    if _is_metapackage(manifest):
        return phrase("installing the package no longer installs them")
    return phrase("packages that have them only through this package do not build")


def _group_elements(manifest: Manifest) -> _Elements:
    elements: dict[_Dependency, list[Element]] = {}
    for dependency in manifest.dependencies:
        elements.setdefault(_Dependency(dependency.tag, dependency.name), []).append(dependency.element)
    return elements


def _format_tags(keys: list[_Dependency]) -> str:
    return " + ".join(key.tag for key in keys)


def _compare_conditions(pair: FilePair, key: _Dependency, old: list[Element], new: list[Element]) -> None:
    old_text, new_text = _format_conditions(old), _format_conditions(new)
    if old_text != new_text:
        always = phrase("always")
        text = phrase(
            "{tag} {package}: {old} -> {new}",
            tag=key.tag,
            package=key.package,
            old=old_text or always,
            new=new_text or always,
        )
        pair.add(text, pair.location(new[0].span()))


def _format_conditions(elements: list[Element]) -> str:
    """Return the conditions and versions for which a dependency holds; empty for always."""
    texts = [" ".join(_list_condition_parts(element)) for element in elements]
    return "; ".join(texts) if all(texts) else ""


def _list_condition_parts(element: Element) -> Iterator[str]:
    yield from (
        f"{sign} {element.attributes[name]}" for name, sign in _VERSION_SIGNS.items() if name in element.attributes
    )
    condition = " ".join(element.attributes.get("condition", "").split())
    if condition:
        yield f"if {condition}"


def _find_condition_variables(elements: _Elements) -> Iterator[tuple[str, Span | None]]:
    """Yield the environment variables in conditions, each with its location."""
    for element in (element for group in elements.values() for element in group):
        for name in _VARIABLE.findall(element.attributes.get("condition", "")):
            yield name, element.span()
