"""Report the arguments that a launch file uses and that nothing declares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from linkwright.diagnostics import phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.included import IncludedActions, UndeclaredArgument, find_callers
from linkwright.review.launches.outlines import Entry, LaunchOutline
from linkwright.review.launches.titles import format_title
from linkwright.review.sources.names import PYTHON_SUFFIX


def find_new_undeclared_arguments(
    pair: FilePair, old: LaunchOutline, new: LaunchOutline
) -> dict[str, UndeclaredArgument]:
    """Return the arguments that are undeclared only in the new version, by name.

    In ROS 1, every file must declare the arguments that it uses.
    """
    if pair.new_path.endswith(PYTHON_SUFFIX) and not is_launch_file_name(pair.new_path):
        return {}  # a module with functions for launch files
    before = IncludedActions(pair.versions.old, pair.old_path, old).find_undeclared_arguments()
    after = IncludedActions(pair.versions.new, pair.new_path, new).find_undeclared_arguments()
    return {
        name: argument
        for name, argument in after.items()
        if (name not in before or argument.is_certain > before[name].is_certain)
        and not _is_declared_by_caller(pair, name)
    }


def _is_declared_by_caller(pair: FilePair, name: str) -> bool:
    """Return whether a launch file that includes this one passes or declares the argument."""
    return any(
        name in include.settings or (not outline.is_ros1 and name in outline.values)
        for outline, include in find_callers(pair.versions.new, pair.new_path, name)
    )


def report_undeclared_arguments(
    pair: FilePair, undeclared: Mapping[str, UndeclaredArgument], removed: Sequence[Entry], *, is_ros1: bool
) -> None:
    """Report the arguments that only the new version uses without a declaration.

    In ROS 2, a file that starts this one may declare them.

    Args:
        pair: both versions of the launch file.
        undeclared: an action that uses each argument, by the name of the argument.
        removed: the actions that only the old version has, such as the declarations of these arguments.
        is_ros1: whether it is a launch file of ROS 1.
    """
    declared_before = {entry.name for entry in removed if entry.kind == "argument"}
    for name, (entry, is_certain) in undeclared.items():
        location = pair.location(entry.span)
        if name in declared_before and is_certain:
            text = phrase("argument '{name}' removed", name=name)
            reason = phrase("the launch file still uses '{name}', and fails if no other file declares it", name=name)
            if is_ros1:
                reason = phrase("the launch file still uses '{name}', and fails", name=name)
            pair.add(text, location, reason)
        elif is_certain:
            text = phrase("{entry} uses argument '{name}', which is not declared", entry=format_title(entry), name=name)
            reason = phrase("the launch file fails if no other file declares '{name}'", name=name)
            reason = phrase("the launch file fails") if is_ros1 else reason
            pair.add(text, location, reason)
        elif name not in declared_before:
            text = phrase(
                "{entry} uses argument '{name}', which no launch file of the repository declares",
                entry=format_title(entry),
                name=name,
            )
            pair.add(text, location)
