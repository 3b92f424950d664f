"""The comparison of the dependencies in manifests of packages."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.file_pair import FilePair
from linkwright.review.files.build_facts import EnvironmentVariables
from linkwright.review.renamed_packages import PackageNames, renamed_packages
from linkwright.xmltree import Element

_VERSIONS = {"version_lt": "<", "version_lte": "<=", "version_eq": "=", "version_gte": ">=", "version_gt": ">"}
_EXPORTED = frozenset({"depend", "build_export_depend", "buildtool_export_depend"})
"""The tags of dependencies that packages that depend on the package have, too, when they are built."""
_EXECUTION = frozenset({"depend", "exec_depend", "run_depend"})
_VARIABLE = re.compile(r"\$(\w+)")


class _Key(NamedTuple):
    """The tag of a dependency, and the package."""

    tag: str
    package: str


_Elements = Mapping[_Key, list[Element]]


def compare_dependencies(pair: FilePair, old: Manifest, new: Manifest) -> None:
    """Add the changed dependencies: those with the same tags in one line, and changed conditions."""
    names = PackageNames(renamed_packages(pair.versions))
    new_elements = _elements(new)
    old_elements = {_Key(tag, names.of_package(name)): found for (tag, name), found in _elements(old).items()}
    packages = dict.fromkeys(key.package for key in (*new_elements, *old_elements))
    retagged: dict[tuple[str, str], list[_Key]] = {}
    added: dict[str, list[_Key]] = {}
    removed: dict[str, list[_Key]] = {}
    for package in packages:
        gone = [key for key in old_elements if key.package == package and key not in new_elements]
        come = [key for key in new_elements if key.package == package and key not in old_elements]
        if gone and come:
            retagged.setdefault((_tags(gone), _tags(come)), []).append(come[0])
            continue
        for keys, groups in ((come, added), (gone, removed)):
            if keys:
                groups.setdefault(_tags(keys), []).append(keys[0])
        for key in (key for key in new_elements if key.package == package and key in old_elements):
            _compare_conditions(pair, key, old_elements[key], new_elements[key])
    for tags, keys in added.items():
        text = phrase("{tags} added: {packages}", tags=tags, packages=_packages(keys))
        pair.add(text, pair.location(_span(new_elements, keys[0])))
    for tags, keys in removed.items():
        text = phrase("{tags} removed: {packages}", tags=tags, packages=_packages(keys))
        pair.add(text, pair.location(_span(old_elements, keys[0]), is_old=True), _reason(tags, old))
    for (old_tags, new_tags), keys in retagged.items():
        text = phrase("{old} -> {new}: {packages}", old=old_tags, new=new_tags, packages=_packages(keys))
        pair.add(text, pair.location(_span(new_elements, keys[0])))
    old_variables, new_variables = (
        EnvironmentVariables(_variables(elements)) for elements in (old_elements, new_elements)
    )
    old_variables.compare(pair, new_variables)


def _reason(tags: str, manifest: Manifest) -> Phrase | None:
    """Return why it is breaking that dependencies are gone, or None if others do not have them through the package.

    Args:
        tags: the tags of the dependencies.
        manifest: the old manifest.
    """
    names = set(tags.split(" + "))
    export = manifest.root.first("export")
    if export is not None and export.first("metapackage") is not None and not names.isdisjoint(_EXECUTION):
        return phrase("installing the package does not install them any more")
    if names.isdisjoint(_EXPORTED) or manifest.build_type == "ament_python":
        return None
    return phrase("packages that have them only through this package do not build")


def _elements(manifest: Manifest) -> _Elements:
    elements: dict[_Key, list[Element]] = {}
    for dependency in manifest.dependencies:
        elements.setdefault(_Key(dependency.tag, dependency.name), []).append(dependency.element)
    return elements


def _tags(keys: list[_Key]) -> str:
    return " + ".join(key.tag for key in keys)


def _packages(keys: list[_Key]) -> str:
    return ", ".join(key.package for key in keys)


def _span(elements: _Elements, key: _Key) -> Span | None:
    return elements[key][0].span()


def _compare_conditions(pair: FilePair, key: _Key, old: list[Element], new: list[Element]) -> None:
    old_text, new_text = _conditions(old), _conditions(new)
    if str(old_text) != str(new_text):
        text = phrase("{tag} {package}: {old} -> {new}", tag=key.tag, package=key.package, old=old_text, new=new_text)
        pair.add(text, pair.location(new[0].span()))


def _conditions(elements: list[Element]) -> Phrase | str:
    """Return when a package is a dependency: the conditions and versions of all its tags, or always."""
    texts = [" ".join(_condition(element)) for element in elements]
    return "; ".join(texts) if all(texts) else phrase("always")


def _condition(element: Element) -> Iterator[str]:
    yield from (f"{sign} {element.attributes[name]}" for name, sign in _VERSIONS.items() if name in element.attributes)
    condition = " ".join(element.attributes.get("condition", "").split())
    if condition:
        yield f"if {condition}"


def _variables(elements: _Elements) -> Iterator[tuple[str, Span | None]]:
    """Yield the environment variables in conditions, each with its location."""
    for element in (element for group in elements.values() for element in group):
        for name in _VARIABLE.findall(element.attributes.get("condition", "")):
            yield name, element.span()
