"""Decide whether another default of a parameter is breaking, because it names a topic, service or frame."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.caching import cached_in_review
from linkwright.review.sources.names import DefaultName, NameKind, SourceNames
from linkwright.review.sources.parameter_defaults import SUM
from linkwright.review.sources.separate_programs import find_programs
from linkwright.review.versions import Version

_SETTING_SUFFIXES = (".yaml", ".yml", ".launch", ".launch.py", ".xml")
"""The ends of the names of files that set parameters of nodes."""
_LAUNCH_SUFFIXES = (".launch", ".launch.py", ".launch.xml")


def find_default_reason(
    parameter: str, old: SourceNames, new: SourceNames, find_removal_reason: Callable[[DefaultName], Phrase | None]
) -> Phrase | None:
    """Return the reason why another default of a parameter is breaking; None if it is not.

    Args:
        parameter: the name of the parameter.
        old: the names in the old source.
        new: the names in the new source.
        find_removal_reason: returns the reason why removing a name is breaking.
    """
    name = parameter.lstrip("~/")
    lost = {item for item in old.default_names if name in item.parameter.split(SUM)} - new.default_names
    for item in sorted(lost, key=lambda lost_item: (lost_item.kind.name, lost_item.name)):
        used = {
            other.name.lstrip("/")
            for other in new.default_names
            if (other.parameter, other.kind) == (item.parameter, item.kind)
        }
        is_given = bool(used) or _is_empty_by_default(item, new)
        reason = find_removal_reason(item) if is_given and item.name.lstrip("/") not in used else None
        if reason is not None:
            return phrase("by default, {reason}", reason=reason)
    return None


def _is_empty_by_default(item: DefaultName, new: SourceNames) -> bool:
    """Return whether a parameter is an empty text by default, and the source has its old default nowhere else."""
    defaults = [known.type for known in new.of_kind(NameKind.PARAMETER) if known.name.lstrip("~/") == item.parameter]
    return defaults in (["''"], ['""']) and all(known.name != item.name for known in new.of_kind(item.kind))


def is_set_in_package(version: Version, package: str | None, parameter: str, path: str) -> bool:
    """Return whether a launch file or parameter file of a package may set a parameter, which hides its default.

    A launch file that names programs of the package, but none that contains the source, sets it for other nodes.

    Args:
        version: the version of the repository.
        package: the folder of the package; None if the source is in none.
        parameter: the name of the parameter.
        path: the path of the source that reads it.
    """
    if package is None:
        return False
    setting = _compile_setting(parameter)
    own, others = find_programs(version, package, path)
    for setting_path in version.paths(_SETTING_SUFFIXES, package):
        text = version.text(setting_path)
        is_of_others = setting_path.endswith(_LAUNCH_SUFFIXES) and _names(text, others) and not _names(text, own)
        if setting.search(text) and not (own and is_of_others):
            return True
    return False


@cached_in_review(maxsize=256)
def is_set_in_repository(version: Version, parameter: str) -> bool:
    """Return whether a launch file or parameter file of any package may set a parameter of any node."""
    setting = _compile_setting(parameter)
    return any(setting.search(version.text(path)) for path in version.paths(_SETTING_SUFFIXES))


def _compile_setting(parameter: str) -> re.Pattern[str]:
    """Return the pattern of the name of a parameter where a file sets it."""
    name = re.escape(parameter.lstrip("~/"))
    return re.compile(rf"(?<![\w/.-]){name}[\"']?\s*:|[\"']~?{name}[\"']")


def _names(text: str, programs: Collection[str]) -> bool:
    """Return whether a launch file starts one of several programs by its name."""
    return any(re.search(rf"\b(?:exec|executable|type)\s*=\s*[\"']{re.escape(item)}[\"']", text) for item in programs)
