"""Check shared names in MoveIt parameter files: controllers, planners, groups and limited joints."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from linkwright.diagnostics import Phrase, counted, phrase, quoted_names
from linkwright.review.breaking import joint_name_reason
from linkwright.review.caching import cached_in_review
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.arms.lost_plan_groups import is_of_lost_group
from linkwright.review.files.parameters.names import (
    can_evaluate_to,
    find_all_controllers,
    list_part_paths,
    make_controller_reason,
)
from linkwright.review.files.parameters.yaml_values import YamlValue, read_yaml_values
from linkwright.review.joint_limits import LOWER, UPPER, find_narrower_reason
from linkwright.review.texts.list_changes import list_items
from linkwright.review.versions import Version, Versions

_CONTROLLER = re.compile(r"(?:.*[._])?controller_list\[(?!(?:old )?\d+\])(?P<name>[^\]]+)\]")
"""The path of a controller in a list of mappings."""
_PLANNER = re.compile(r"(?:.*\.)?planner_configs\.(?P<name>[^.\[]+)")
"""The path of the settings of a planner."""
_PLANNER_LIST = re.compile(r"(?:.*\.)?planner_configs")
"""The path of the list of the planners of a group."""
_LIMITED_JOINT = re.compile(r"(?:.*\.)?joint_limits\.(?P<name>[^.\[]+)")
"""The path of the limits of a joint."""
_LIMIT = re.compile(r"has_\w+_limits|(max|min)_\w+")
"""The last name in the path of a limit of a joint."""
_POSITION_LIMIT = re.compile(r"(?:.*\.)?joint_limits\.(?P<name>[^.\[]+)\.(?P<side>min|max)_position")
"""The path of a position limit of a joint."""
_POSITION_SIDES = {"min": LOWER, "max": UPPER}
_CONTROLLER_VALUE = re.compile(r"(?P<part>(?:.*[.\[])?(?P<name>[^.\[\]]+)\]?)\.(?P<key>type|joints)")
"""The path of the action or the joints of a controller."""
_SOLVER = re.compile(r"(?:.*\.)?(?P<name>[^.\[]+)\.kinematics_solver")
"""The path of the kinematics solver of a group."""
_ACTION_NAMESPACE = re.compile(r"(?:.*[.\[])?(?P<controller>[^.\[\]]+)\]?\.action_ns")
"""The path of the namespace of the action that MoveIt calls."""

_COMMANDED_CONTROLLERS = re.compile(r"(?:.*[._])?controller_names")
"""The path of the list of the controllers that MoveIt commands. Other programs load them."""
_YAML_SUFFIXES = (".yaml", ".yml")
_SEMANTIC_SUFFIXES = (".srdf", ".srdf.xacro")
_WORD = re.compile(r"[\w./-]+")


class MoveItRules:
    """Decide which changes in a MoveIt parameter file are breaking.

    Args:
        old: the old values by their original paths.
        new: the new values by path.
        versions: the repository before and after the change.
        path: the path of the file in the new version.
    """

    def __init__(
        self, old: Mapping[str, YamlValue], new: Mapping[str, YamlValue], versions: Versions, path: str
    ) -> None:
        self._old = old
        self._versions = versions
        self._path = path
        self._version = versions.new
        self._names = {
            pattern: {match["name"] for part in parts if (match := pattern.fullmatch(part))}
            for parts in [{part for name in new for part in list_part_paths(name)}]
            for pattern in (_CONTROLLER, _PLANNER, _LIMITED_JOINT, _SOLVER)
        }
        self._new_joints = {
            joint
            for name, value in new.items()
            if (controller := _CONTROLLER_VALUE.fullmatch(name)) is not None and controller["key"] == "joints"
            for joint in list_items(value.text)
        }
        parts = {part for name in old for part in list_part_paths(name)}
        self._old_planners = {match["name"] for part in parts if (match := _PLANNER.fullmatch(part))}

    def find_change_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why a changed value is breaking, or None if it is not.

        A planner whose settings were also removed is reported with the settings.
        """
        action = _ACTION_NAMESPACE.fullmatch(parameter)
        if action is not None and old.text and not can_evaluate_to(new.text, old.text):
            name = f"{action['controller']}/{old.text}"
            return phrase("the action server '{name}' gets no goals", name=name)
        reason = self._find_controller_reason(parameter, old, new) or _find_position_reason(parameter, old, new)
        if reason is not None or not _PLANNER_LIST.fullmatch(parameter) or not old.is_list:
            return reason
        items = list_items(new.text)
        removed = {
            name for name in list_items(old.text) if name and not any(can_evaluate_to(item, name) for item in items)
        }
        removed -= {*items, *(self._old_planners - self._names[_PLANNER])}
        return _make_planner_reason(", ".join(sorted(removed))) if removed else None

    def find_removal_reason(self, parameter: str) -> Phrase | None:
        """Return the reason why removing a parameter is breaking, or None if it is not."""
        for part in list_part_paths(parameter):
            for pattern, reason in _REMOVAL_REASONS:
                match = pattern.fullmatch(part)
                if match is not None and self._is_removed(pattern, match["name"]):
                    is_lost = pattern is not _PLANNER and is_of_lost_group(self._versions, self._path, part)
                    return None if is_lost else reason(match["name"])
        return None

    def find_renaming_reason(self, part: str) -> Phrase | None:
        """Return the reason why renaming or moving a part is breaking; None if it is not."""
        joint = _LIMITED_JOINT.fullmatch(part)
        if joint is None:
            solver = f"{part}.kinematics_solver"
            return self.find_removal_reason(solver if solver in self._old else part)
        has_limits = any(
            name.startswith(f"{part}.") and _LIMIT.fullmatch(name.removeprefix(f"{part}.")) for name in self._old
        )
        return (
            joint_name_reason(joint["name"]) if has_limits and self._is_removed(_LIMITED_JOINT, joint["name"]) else None
        )

    def follows_controllers(self, parameter: str, old: YamlValue, new: YamlValue) -> bool:
        """Return whether a list of the controllers that MoveIt commands follows those of the repository.

        The parameter files configure all the added ones, and none of the removed ones.
        """
        if _COMMANDED_CONTROLLERS.fullmatch(parameter) is None:
            return False
        before, after = ({name.strip("/") for name in list_items(value.text)} for value in (old, new))
        configured = _list_configured_controllers(self._version)
        return bool(after - before) and after - before <= configured and configured.isdisjoint(before - after)

    def _find_controller_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why another action, or a lost joint, of a controller is breaking; None if it is not."""
        match = _CONTROLLER_VALUE.fullmatch(parameter)
        is_controller = match is not None and (
            _CONTROLLER.fullmatch(match["part"]) or f"{match['part']}.action_ns" in self._old
        )
        if match is None or not is_controller:
            return None
        if match["key"] == "type":
            is_other = bool(old.text and new.text) and not can_evaluate_to(new.text, old.text)
            return phrase(
                "the controller '{name}' must serve the action '{new}' instead of '{old}'",
                name=match["name"], new=new.text, old=old.text,
            ) if is_other else None  # fmt: skip
        names = (name for name in list_items(old.text) if name and name not in self._new_joints)
        lost = [name for name in names if not any(can_evaluate_to(joint, name) for joint in self._new_joints)]
        if lost and self._are_unknown(lost):
            return None
        return make_uncontrolled_reason(lost) if lost else None

    def _are_unknown(self, joints: Collection[str]) -> bool:
        """Return whether the semantic descriptions of the repository have joints, but none of these."""
        text = "\n".join(map(self._version.text, self._version.paths(_SEMANTIC_SUFFIXES)))
        words = set(_WORD.findall(text))
        has_joints = any(joint in words for joint in self._new_joints)
        return has_joints and "xacro:include" not in text and words.isdisjoint(joints)

    def _is_removed(self, pattern: re.Pattern[str], name: str) -> bool:
        """Return whether the new file has parts of a kind, but none that can have the name.

        A list that was removed as a whole may be in a different file or form.
        """
        names = self._names[pattern]
        return bool(names) and name not in names and not any(can_evaluate_to(new_name, name) for new_name in names)


def make_uncontrolled_reason(joints: Sequence[str]) -> Phrase:
    """Return the reason why a controller that MoveIt commands must not lose joints."""
    return counted(
        "MoveIt finds no controller for the joint {names}", "MoveIt finds no controller for the joints {names}",
        len(joints), names=quoted_names(joints),
    )  # fmt: skip


@cached_in_review(maxsize=4)
def _list_configured_controllers(version: Version) -> frozenset[str]:
    """Return the names of the controllers whose types the parameter files of a version set."""
    return frozenset(name for path in version.paths(_YAML_SUFFIXES) for name in _read_controllers(version, path))


def _read_controllers(version: Version, path: str) -> Iterator[str]:
    text = version.text(path)
    try:
        yield from find_all_controllers(read_yaml_values(text)) if "type:" in text else ()
    except UnreadableFileError:
        return


def _find_position_reason(parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
    """Return the reason why a changed position limit of a joint is breaking; None if it is not."""
    limit = _POSITION_LIMIT.fullmatch(parameter)
    if limit is None:
        return None
    return find_narrower_reason(limit["name"], {_POSITION_SIDES[limit["side"]]: (old.text, new.text)})


def _make_solver_reason(group: str) -> Phrase:
    return phrase("MoveIt has no inverse kinematics for the group '{group}'", group=group)


def _make_planner_reason(name: str) -> Phrase:
    return phrase("programs that plan with the planner '{name}' do not find it", name=name)


_REMOVAL_REASONS = (
    (_CONTROLLER, make_controller_reason),
    (_PLANNER, _make_planner_reason),
    (_SOLVER, _make_solver_reason),
)
"""The reasons why removing a part is breaking, by the path of the part."""
