"""Compare two versions of a description with each argument set of its callers."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Iterator, Sequence, Sized
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkwright.descriptions.comparison import Comparison, Difference, DifferenceLocation, sentence
from linkwright.diagnostics import Phrase, joined, phrase, term
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.argument_sets import find_distinct_arguments
from linkwright.review.breaking import find_breaking_reason, frame_reason, message_frame_reason
from linkwright.review.changes import Change, Effect, Location, Problem
from linkwright.review.controller_files import find_controller_file_reason
from linkwright.review.drawings.images import render_collisions, render_views
from linkwright.review.drawings.scenes import build_robot_scene
from linkwright.review.failures import make_problem
from linkwright.review.file_pair import FilePair
from linkwright.review.files.arms.semantics import find_disabled_collisions
from linkwright.review.frames import UNMOVED, SharedFrames
from linkwright.review.joint_limits import find_limits_reason
from linkwright.review.left_names import find_left_names, is_searched_property
from linkwright.review.names_in_plugins import find_old_path
from linkwright.review.parts.expanded import find_expanded_elements
from linkwright.review.plugins import (
    find_added_topics,
    find_default_topic_reason,
    find_missing_topics_reason,
    find_offered_topics,
    format_contents,
    is_still_offered,
    names_same_topic,
)
from linkwright.review.renames.replaced_plugins import PluginReplacement, merge_replaced_plugins
from linkwright.review.renames.sensors import SensorReplacement, merge_renamed_sensors, merge_sensor_frames
from linkwright.review.robots.added_links import AddedLinks
from linkwright.review.robots.argument_names import ArgumentNames, find_argument_names
from linkwright.review.robots.cases import Case, find_cases, find_switched_cases
from linkwright.review.robots.collisions import compare_collisions, may_change_collisions
from linkwright.review.robots.figures import RobotMeasures, compare_figures
from linkwright.review.robots.joined_values import JoinedDifferences, join_value_differences
from linkwright.review.robots.omitted_calls import find_lost_call_reason, find_passed_name_reason, find_title
from linkwright.review.robots.parent_changes import ParentChanges
from linkwright.review.robots.reversed_axes import find_reversal_reason
from linkwright.review.robots.switched_parts import SwitchedParts
from linkwright.review.robots.unused_references import UnusedReferences
from linkwright.review.simulators import find_lost_manager_reason, find_simulator_reason
from linkwright.review.texts.element_values import format_own_content
from linkwright.review.texts.merged_reasons import merge_reasons
from linkwright.review.texts.merging import merge_changes
from linkwright.review.texts.motions import add_motion, compute_angle
from linkwright.urdf import Robot
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

_FIND_EXPRESSION = b"$(find "
_REFERENCE_ATTRIBUTE = "reference"
"""The attribute of ``<gazebo>`` that names the link or joint, and thus the extension."""
_DETAILS_OF_INERTIAL = ("origin rpy 0 0 0", "inertia ixy", "inertia ixz", "inertia iyz")


def compare_descriptions(pair: FilePair) -> None:
    """Compare two versions of a description with each set of argument values."""
    groups: dict[Hashable, _Group] = {}
    collisions: list[Change] = []
    drawn_case = ""
    first_case: Case | None = None
    for case in _find_cases_to_compare(pair, groups):
        pair.cases.append(case.name)
        if case.old.robot is None or case.new.robot is None:
            continue
        pair.expanded.update(find_expanded_elements(pair.versions, case.old, case.new))
        comparison = case.models.compare(case.old.robot, case.new.robot)
        frames = SharedFrames(case.old.robot, case.new.robot, comparison.links)
        names = find_argument_names(first_case, case)
        first_case = first_case or case
        for change in _compare_robots(pair, comparison, frames, case):
            groups.setdefault(names.make_key(change), _Group(change)).add(change, case.name, names)
        if case.partial is not None and case.partial.has_stand_ins:
            continue  # where the links are is unknown
        try:
            if _draw(pair, comparison, frames, case):
                drawn_case = case.name
            if len(pair.cases) == 1 and case.partial is None:
                collisions += _measure(pair, comparison, frames, case)
        except Exception as error:  # noqa: BLE001 - any error; the changes are still reported
            text = phrase("a part of the comparison is missing: {reason}", reason=make_problem(error).text)
            pair.problems.append(Problem(text, is_bug=True))
    pair.changes += merge_changes(group.change(pair.cases) for group in _merge_groups(groups.values()))
    pair.changes += collisions
    if len(set(pair.cases)) > 1:
        _name_arguments(pair, drawn_case)


def _draw(pair: FilePair, comparison: Comparison, frames: SharedFrames, case: Case) -> bool:
    """Draw both robots, unless they were drawn with other arguments, and return whether they are drawn."""
    old, new = case.old.robot, case.new.robot
    if old is None or new is None or not pair.drawings.images or pair.images:
        return False
    pair.images += render_views(case.models, old, new, comparison, frames)
    pair.images += render_collisions(case.models, old, new, comparison, frames)
    if pair.images and pair.drawings.scenes:
        roots = pair.versions.old.root, pair.versions.new.root
        pair.scene = build_robot_scene(case.models, case.old, case.new, roots)
    return bool(pair.images)


def _measure(pair: FilePair, comparison: Comparison, frames: SharedFrames, case: Case) -> Iterator[Change]:
    """Compare the figures of both robots, and yield the links that newly collide."""
    if case.old.robot is None or case.new.robot is None:
        return
    old = RobotMeasures(case.old.robot, case.models.old, UNMOVED, frames.old)
    old_joints = {name: old_name for old_name, name in comparison.joints.items()}
    new = RobotMeasures(case.new.robot, case.models.new, frames.new_root, frames.new, old_joints)
    pair.figures += compare_figures(old, new)
    if may_change_collisions(comparison.differences):
        disabled = find_disabled_collisions(pair.versions.new.root)
        yield from compare_collisions(old, new, comparison.links, disabled)


def _name_arguments(pair: FilePair, drawn_case: str) -> None:
    """Add the arguments with which the robot was measured and drawn, unless they are the defaults."""
    if pair.cases[0]:
        arguments = find_distinct_arguments(pair.cases[0], pair.cases)
        pair.figures[:] = [replace(figure, arguments=arguments) for figure in pair.figures]
    if pair.images and drawn_case:
        arguments = find_distinct_arguments(drawn_case, pair.cases)
        note = phrase("drawn with {arguments}", arguments=arguments)
        pair.images[0] = replace(pair.images[0], notes=(note, *pair.images[0].notes))


def _find_cases_to_compare(pair: FilePair, groups: Sized) -> Iterator[Case]:
    """Yield the cases of callers, and inverted boolean arguments if these show no change."""
    compared = []
    for case in find_cases(pair):
        compared.append(case)
        yield case
    if not groups:
        yield from find_switched_cases(pair, compared)


@dataclass
class _Group:
    """A change with its reasons, and the links, joints and argument sets in which it occurs."""

    first: Change
    names: dict[str, str] = field(default_factory=dict)
    cases: dict[str, None] = field(default_factory=dict)
    reasons: dict[str, Phrase | None] = field(default_factory=dict)

    def add(self, change: Change, case: str, names: ArgumentNames) -> None:
        """Add the same change to a link, joint or extension, perhaps with the name of another argument set."""
        self.names.setdefault(names.translate(change.name), change.name)
        self.cases[case] = None
        self.reasons.setdefault(names.translate(str(change.reason)), change.reason)

    def change(self, all_cases: Sequence[str]) -> Change:
        cases = () if len(self.cases) == len(set(all_cases)) else tuple(self.cases)
        reason = merge_reasons(self.reasons.values())
        return replace(self.first, cases=cases, reason=reason, other_names=tuple(self.names.values())[1:])


def _merge_groups(groups: Iterable[_Group]) -> Iterable[_Group]:
    """Return the groups, with the same change in the files of several argument sets merged."""
    merged: dict[Hashable, _Group] = {}
    for group in groups:
        key = group.first.effect, str(group.first.sentence), tuple(group.names.values())
        existing = merged.setdefault(key, group)
        if existing is group:
            continue
        existing.cases |= group.cases
        if group.first.location is not None:
            existing.first = replace(
                existing.first, other_locations=(*existing.first.other_locations, group.first.location)
            )
    return merged.values()


# --- changes in a robot ----------------------------------------------------------------------------------------------


def _compare_robots(pair: FilePair, comparison: Comparison, frames: SharedFrames, case: Case) -> Iterator[Change]:
    old, new, partial = case.old.robot, case.new.robot, case.partial
    if old is None or new is None:
        return
    has_other_root = comparison.links.get(old.root, "") != new.root and (partial is None or partial.has_certain_roots())
    if has_other_root:
        yield _make_root_change(old, new, frames)
    added_names = find_added_topics(comparison.differences)
    pair.added_topics |= find_offered_topics(comparison.differences)
    differences = merge_sensor_frames(merge_renamed_sensors(merge_replaced_plugins(comparison.differences)))
    added_links = AddedLinks(differences, new)
    switched_parts = SwitchedParts(pair, case)
    has_known_poses = partial is None or not partial.has_stand_ins
    parents = ParentChanges(comparison, new, frames if has_known_poses else None)
    references = UnusedReferences(old if partial is None else None)
    unevaluated: dict[str, None] = {}
    for difference in join_value_differences(differences):
        if added_links.is_in_line_of_link(difference):
            continue
        if partial is not None and not partial.is_certain(difference):
            if partial.may_be_defined_elsewhere(difference):
                location = _find_difference_location(pair, difference)
                if location is not None and partial.lacks_file(location.file):
                    continue  # the line about the missing file tells it
                removal = format_difference(difference)
                text = phrase("{change}, unless a missing package defines it", change=removal)
                yield Change(text, location=location)
            elif partial.has_unevaluated_side(difference):
                unevaluated[find_title(difference)[1]] = None
            continue
        if has_other_root and (difference.subject, difference.kind, difference.name) == ("link", "removed", old.root):
            continue
        if partial is None and _names_lost_link(difference, old, new) and is_searched_property(difference.property):
            continue  # `find_left_names` finds it
        reason = None
        if _names_lost_link(difference, old, new):
            reason = phrase("the link '{name}' no longer exists", name=difference.new or "")
        elif references.find_name(difference) is None and not names_same_topic(
            difference, old.extensions, new.extensions
        ):
            reason = (
                (None if is_still_offered(difference, added_names) else find_breaking_reason(difference, old, new))
                or find_missing_topics_reason(difference, added_names)
                or find_lost_manager_reason(difference, new.extensions, pair.versions)
                or _find_frame_reason(difference)
                or find_default_topic_reason(difference, new.extensions)
                or find_lost_call_reason(difference, comparison.differences)
                or find_passed_name_reason(difference)
                or find_controller_file_reason(difference, pair.versions)
                or _find_simulator_reason(pair, difference)
                or _find_expression_reason(pair, difference)
                or find_reversal_reason(difference, old, new, frames if has_known_poses else None)
                or find_limits_reason(
                    difference.values if isinstance(difference, JoinedDifferences) else (difference,), new
                )
            )
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        text = added_links.sentence(difference) or parents.sentence(difference) or format_difference(difference)
        text = references.add_name(text, difference)
        if _names_lost_link(difference, old, new):
            text = phrase(
                "{subject} '{name}': {property} still names '{value}'",
                subject=term(difference.subject),
                name=difference.name,
                property=difference.property,
                value=difference.new or "",
            )
        if difference.subject == "link" and difference.kind == "renamed":
            motion = frames.motion(difference.old or "") if has_known_poses else None
            text = text if motion is None else add_motion(text, *motion)
        yield Change(
            switched_parts.add_switch(text, difference),
            effect,
            reason,
            _find_mesh_location(pair, case, difference) or _find_difference_location(pair, difference),
        )
    if unevaluated:
        pair.add_unevaluated(list(unevaluated))
    if partial is None:
        links, joints = old.links.keys() - new.links.keys(), old.joints.keys() - new.joints.keys()
        yield from find_left_names(new.extensions, links, joints, pair.location)


def _names_lost_link(difference: Difference, old: Robot, new: Robot) -> bool:
    """Return whether a value in an extension is the name of a renamed link, and did not follow the new name."""
    return (
        (difference.subject, difference.kind) == ("extension", "changed")
        and difference.old == difference.new
        and difference.new in old.links.keys() - new.links.keys()
    )


def _make_root_change(old: Robot, new: Robot, frames: SharedFrames) -> Change:
    text = phrase("root link '{old}' -> '{new}'", old=old.root, new=new.root)
    if frames.are_aligned:
        text = phrase(
            "{change} (both robots are compared in the frame of '{link}')", change=text, link=frames.reference
        )
    if old.root in new.links:
        reason = phrase("programs that use '{old}' as the base frame of the robot get other transforms", old=old.root)
        return Change(text, Effect.BREAKING, reason)
    return Change(text, Effect.BREAKING, frame_reason(old.root))


def _find_simulator_reason(pair: FilePair, difference: Difference) -> Phrase | None:
    """Return the reason why hardware for another simulator is breaking, or None if it is not."""
    location = _find_difference_location(pair, difference)
    path = None if location is None or location.is_old else location.file
    return find_simulator_reason(difference, pair.versions, path)


def _find_frame_reason(difference: Difference) -> Phrase | None:
    """Return the reason why a sensor that no longer names the frame of its messages is breaking, or None."""
    frame = difference.lost_frame if isinstance(difference, SensorReplacement) else None
    return None if frame is None else message_frame_reason(frame)


def _find_expression_reason(pair: FilePair, difference: Difference) -> Phrase | None:
    """Return why a new expression in the name of a mesh or texture is breaking, or None.

    In a file that ends with ``.urdf``, only xacro evaluates it. A robot that includes the file is read by xacro.
    """
    location = _find_difference_location(pair, difference)
    if location is None or location.file != pair.new_path:
        return None
    locations = difference.old_place, difference.new_place
    if difference.kind != "changed" or not difference.old or not difference.new or None in locations:
        return None
    if "mesh" not in difference.new and "texture" not in difference.property:
        return None
    if [_is_expression_in_urdf(location) for location in locations if location is not None] != [False, True]:
        return None
    return phrase("programs that read the file without xacro do not find the file that it names")


def _is_expression_in_urdf(location: DifferenceLocation) -> bool:
    """Return whether the value at a location in a ``.urdf`` file contains ``$(find PACKAGE)``."""
    path = Path(location.span.file)
    if path.suffix != ".urdf":
        return False
    lines = read_bytes(path).splitlines()
    return location.span.line <= len(lines) and _FIND_EXPRESSION in lines[location.span.line - 1]


def _find_mesh_location(pair: FilePair, case: Case, difference: Difference) -> Location | None:
    """Return the location of a mesh file whose contents differ; None for other differences."""
    _, is_mesh, uri = difference.property.partition(" mesh ")
    if not is_mesh or difference.subject != "link":
        return None
    path = pair.versions.new.relative(case.models.new.resolve(uri))
    return None if path is None else Location(path, 1, 1)


def _find_difference_location(pair: FilePair, difference: Difference) -> Location | None:
    """Return the location of the new value, or else of the old value.

    The result is None for files outside the repository.
    """
    new, old = difference.new_place, difference.old_place
    return (pair.location(new.span) if new else None) or (pair.location(old.span, is_old=True) if old else None)


def format_difference(difference: Difference) -> Phrase:
    """Return a difference in one line. A moved or rotated frame also has the distance or angle."""
    if isinstance(difference, JoinedDifferences):
        return difference.sentence()
    if isinstance(difference, PluginReplacement):
        name = f"{term(difference.subject)} '{difference.name}'"
        return phrase("{entry}: {change}", entry=name, change=difference.text)
    text = sentence(difference, find_title(difference))
    old_path = find_old_path(difference, difference.property)
    if old_path is not None:
        return phrase(
            "{subject} '{name}': {property} renamed to '{new}'",
            subject=term(difference.subject),
            name=difference.name,
            property=old_path,
            new=difference.new or "",
        )
    if difference.element is not None:
        contents = _format_element(difference.element)
        if difference.kind == "changed":
            return _format_presence(difference, contents)
        return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)
    if difference.kind == "changed" and (difference.old is None or difference.new is None):
        return _format_presence(difference, _format_known_value(difference))
    if difference.old is None or difference.new is None or not difference.property.endswith(("xyz", "rpy")):
        return text
    try:
        old, new = ([float(word) for word in value.split()] for value in (difference.old, difference.new))
    except ValueError:
        return text
    if len(old) != len(new) or len(old) != 3:
        return text
    if difference.property.endswith("origin xyz"):
        return phrase("{change} (moved by {distance:.4g} m)", change=text, distance=math.dist(old, new))
    if difference.property.endswith("origin rpy"):
        return phrase("{change} (rotated by {angle:.3g}°)", change=text, angle=compute_angle(old, new))
    return text


def _format_element(element: Element) -> Phrase | None:
    """Return the attributes of an element except its name, and its values, or None."""
    parts = [as_phrase(format_own_content(element, (_REFERENCE_ATTRIBUTE,))), format_contents(element)]
    return joined(list(filter(None, parts))) if any(parts) else None


def _format_known_value(difference: Difference) -> str:
    """Return the only value of a difference, with its unit."""
    value = difference.old if difference.new is None else _drop_details(difference)
    return " ".join(filter(None, (value, difference.unit)))


def _format_presence(difference: Difference, value: str | None) -> Phrase:
    """Return the line about an added or removed property or part, with its value."""
    (subject, name), part = find_title(difference), difference.property
    if difference.new is not None and not value:
        return phrase("{subject} '{name}': {property} added", subject=subject, name=name, property=part)
    if difference.new is not None:
        return phrase(
            "{subject} '{name}': {property} added: {new}", subject=subject, name=name, property=part, new=value
        )
    if not value:
        return phrase("{subject} '{name}': {property} removed", subject=subject, name=name, property=part)
    return phrase(
        "{subject} '{name}': {property} removed: {value}", subject=subject, name=name, property=part, value=value
    )


def _drop_details(difference: Difference) -> str:
    """Return the values of an added part.

    An inertial is shown without products of inertia and axes.
    """
    parts = (difference.new or "").split(", ")
    if difference.property == "inertial":
        parts = [part for part in parts if not part.startswith(_DETAILS_OF_INERTIAL)]
    return ", ".join(parts)
