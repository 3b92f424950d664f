"""Compare two versions of a description with each argument set of its callers."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Iterator, Sequence, Sized
from dataclasses import dataclass, field, replace
from pathlib import Path

from linkwright.descriptions.comparison import Comparison, Difference, DifferenceLocation, sentence
from linkwright.diagnostics import Phrase, joined, phrase, term
from linkwright.diagnostics.phrase import as_phrase
from linkwright.geometry.single import Pose, pose_quaternion
from linkwright.review.breaking import breaking_reason, frame_reason
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.drawings.images import collision_images, view_images
from linkwright.review.drawings.scenes import robot_scene
from linkwright.review.element_values import own_content
from linkwright.review.file_pair import FilePair
from linkwright.review.files.semantics import find_disabled_collisions
from linkwright.review.frames import UNMOVED, SharedFrames
from linkwright.review.merging import common_reason, merge_changes
from linkwright.review.names_in_plugins import path_of_renamed
from linkwright.review.parts.expanded import find_expanded_elements
from linkwright.review.left_names import find_left_names
from linkwright.review.plugins import added_topics, contents_text, is_still_offered, missing_topics_reason
from linkwright.review.replaced_plugins import PluginReplacement, merge_replaced_plugins
from linkwright.review.robots.added_links import AddedLinks
from linkwright.review.robots.cases import Case, find_cases, find_switched_cases
from linkwright.review.robots.collisions import collision_changes, may_change_collisions
from linkwright.review.robots.figures import RobotMeasures, figures_of
from linkwright.review.robots.joined_values import JoinedDifferences, join_value_differences
from linkwright.urdf import Robot
from linkwright.xmltree import Element
from linkwright.xmltree.reader import read_bytes

_EXPRESSION = b"$(find "
_REFERENCE = "reference"
"""The attribute of ``<gazebo>`` that names the link or joint, and thus the extension."""
_DETAILS_OF_INERTIAL = ("origin rpy 0 0 0", "inertia ixy", "inertia ixz", "inertia iyz")


def compare_descriptions(pair: FilePair) -> None:
    """Compare two versions of a description with each set of argument values."""
    groups: dict[Hashable, _Group] = {}
    collisions: list[Change] = []
    for case in _cases_to_compare(pair, groups):
        pair.cases.append(case.name)
        if case.old.robot is None or case.new.robot is None:
            continue
        pair.expanded.update(find_expanded_elements(pair.versions, case.old, case.new))
        comparison = case.models.compare(case.old.robot, case.new.robot)
        frames = SharedFrames(case.old.robot, case.new.robot, comparison.links)
        for change in _find_changes(pair, comparison, frames, case):
            group = groups.setdefault(change.identity, _Group(change))
            group.names[change.name] = None
            group.cases[case.name] = None
            group.reasons.append(change.reason)
        if case.partial is not None and case.partial.has_stand_ins:
            continue  # where the links are is unknown
        if pair.drawings.images and not pair.images:
            pair.images += view_images(case.models, case.old.robot, case.new.robot, comparison, frames)
            pair.images += collision_images(case.models, case.old.robot, case.new.robot, comparison, frames)
            if pair.images and pair.drawings.scenes:
                roots = pair.versions.old.root, pair.versions.new.root
                pair.scene = robot_scene(case.models, case.old, case.new, roots)
        if len(pair.cases) == 1 and case.partial is None:
            old = RobotMeasures(case.old.robot, case.models.old, UNMOVED, frames.old)
            old_joints = {name: old_name for old_name, name in comparison.joints.items()}
            new = RobotMeasures(case.new.robot, case.models.new, frames.new_root, frames.new, old_joints)
            pair.figures += figures_of(old, new)
            if may_change_collisions(comparison.differences):
                disabled = find_disabled_collisions(pair.versions.new.root)
                collisions = list(collision_changes(old, new, comparison.links, disabled))
    pair.changes += merge_changes(group.change(pair.cases) for group in _merge_groups(groups.values()))
    pair.changes += collisions


def _cases_to_compare(pair: FilePair, groups: Sized) -> Iterator[Case]:
    """Yield the cases of callers and, if these show no change, cases with inverted boolean arguments."""
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
    names: dict[str, None] = field(default_factory=dict)
    cases: dict[str, None] = field(default_factory=dict)
    reasons: list[Phrase | None] = field(default_factory=list)

    def change(self, all_cases: Sequence[str]) -> Change:
        cases = () if len(self.cases) == len(set(all_cases)) else tuple(self.cases)
        reason = common_reason(self.reasons)
        return replace(self.first, cases=cases, reason=reason, other_names=tuple(self.names)[1:])


def _merge_groups(groups: Iterable[_Group]) -> Iterable[_Group]:
    """Return the groups, with the same change in the files of several argument sets merged."""
    united: dict[Hashable, _Group] = {}
    for group in groups:
        key = group.first.effect, str(group.first.sentence), tuple(group.names)
        known = united.setdefault(key, group)
        if known is group:
            continue
        known.cases |= group.cases
        if group.first.location is not None:
            known.first = replace(known.first, other_locations=(*known.first.other_locations, group.first.location))
    return united.values()


# --- changes of a robot ----------------------------------------------------------------------------------------------


def _find_changes(pair: FilePair, comparison: Comparison, frames: SharedFrames, case: Case) -> Iterator[Change]:
    old, new, partial = case.old.robot, case.new.robot, case.partial
    if old is None or new is None:
        return
    has_other_root = comparison.links.get(old.root, "") != new.root and (partial is None or partial.has_certain_roots())
    if has_other_root:
        yield _root_change(old, new, frames)
    added = added_topics(comparison.differences)
    differences = merge_replaced_plugins(comparison.differences)
    added_links = AddedLinks(differences, new)
    for difference in join_value_differences(differences):
        if added_links.is_in_line_of_link(difference):
            continue
        if partial is not None and not partial.is_certain(difference):
            continue
        if has_other_root and (difference.subject, difference.kind, difference.name) == ("link", "removed", old.root):
            continue
        reason = (
            (None if is_still_offered(difference, added) else breaking_reason(difference, old, new))
            or missing_topics_reason(difference, added)
            or _expression_reason(difference)
        )
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        text = added_links.sentence(difference) or sentence_of_difference(difference)
        if difference.subject == "link" and difference.kind == "renamed":
            is_placed = partial is None or not partial.has_stand_ins
            text = _with_motion(text, frames.distance(difference.old or "") if is_placed else None)
        yield Change(text, effect, reason, _mesh_location(pair, case, difference) or _difference_location(pair, difference))
    if partial is None:
        links, joints = old.links.keys() - new.links.keys(), old.joints.keys() - new.joints.keys()
        yield from find_left_names(new.extensions, links, joints, pair.location)


def _root_change(old: Robot, new: Robot, frames: SharedFrames) -> Change:
    text = phrase("root link '{old}' -> '{new}'", old=old.root, new=new.root)
    if frames.are_aligned:
        text = phrase(
            "{change} (both robots are compared in the frame of '{link}')", change=text, link=frames.reference
        )
    if old.root in new.links:
        reason = phrase("programs that use '{old}' as the base frame of the robot get other transforms", old=old.root)
        return Change(text, Effect.BREAKING, reason)
    return Change(text, Effect.BREAKING, frame_reason(old.root))


def _expression_reason(difference: Difference) -> Phrase | None:
    """Return the reason why an expression in a URDF file name is breaking: only xacro evaluates it."""
    places = difference.old_place, difference.new_place
    if difference.kind != "changed" or not difference.old or not difference.new or None in places:
        return None
    if "mesh" not in difference.new and "texture" not in difference.property:
        return None
    if [_is_expression_in_urdf(place) for place in places if place is not None] != [False, True]:
        return None
    return phrase("programs that read the file without xacro do not find the file that it names")


def _is_expression_in_urdf(place: DifferenceLocation) -> bool:
    """Return whether the value at a location in a ``.urdf`` file contains ``$(find PACKAGE)``."""
    path = Path(place.span.file)
    if path.suffix != ".urdf":
        return False
    lines = read_bytes(path).splitlines()
    return place.span.line <= len(lines) and _EXPRESSION in lines[place.span.line - 1]


def _with_motion(text: Phrase, distance: float | None) -> Phrase:
    """Return the sentence about a renamed link, with the distance in m if it moved."""
    return text if distance is None else phrase("{change} (moved by {distance:.4g} m)", change=text, distance=distance)


def _mesh_location(pair: FilePair, case: Case, difference: Difference) -> Location | None:
    """Return the location of the mesh file if the contents of a mesh differ; None for other differences."""
    _, is_mesh, address = difference.property.partition(" mesh ")
    if not is_mesh or difference.subject != "link":
        return None
    path = pair.versions.new.relative(case.models.new.resolve(address))
    return None if path is None else Location(path, 1, 1)


def _difference_location(pair: FilePair, difference: Difference) -> Location | None:
    """Return the location of the new value, or else of the old value; None for files outside the repository."""
    new, old = difference.new_place, difference.old_place
    return (pair.location(new.span) if new else None) or (pair.location(old.span, is_old=True) if old else None)


def sentence_of_difference(difference: Difference) -> Phrase:
    """Return a difference in one line. A moved or rotated frame also has the distance or angle."""
    if isinstance(difference, JoinedDifferences):
        return difference.sentence()
    if isinstance(difference, PluginReplacement):
        name = f"{term(difference.subject)} '{difference.name}'"
        return phrase("{entry}: {change}", entry=name, change=difference.text)
    text = sentence(difference)
    old_path = path_of_renamed(difference, difference.property)
    if old_path is not None:
        return phrase(
            "{subject} '{name}': {property} renamed to '{new}'",
            subject=term(difference.subject),
            name=difference.name,
            property=old_path,
            new=difference.new or "",
        )
    if difference.element is not None:
        contents = _element_contents(difference.element)
        if difference.kind == "changed":
            return _presence_text(difference, contents)
        return text if contents is None else phrase("{change}: {contents}", change=text, contents=contents)
    if difference.kind == "changed" and (difference.old is None or difference.new is None):
        return _presence_text(difference, _known_value(difference))
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
        return phrase("{change} (rotated by {angle:.3g}°)", change=text, angle=_angle_between(old, new))
    return text


def _element_contents(element: Element) -> Phrase | None:
    """Return the attributes of an element except its name, and its values; None if there are none."""
    parts = [as_phrase(own_content(element, (_REFERENCE,))), contents_text(element)]
    return joined(list(filter(None, parts))) if any(parts) else None


def _known_value(difference: Difference) -> str:
    """Return the only value of a difference, with its unit."""
    value = difference.old if difference.new is None else _without_details(difference)
    return " ".join(filter(None, (value, difference.unit)))


def _presence_text(difference: Difference, value: str | None) -> Phrase:
    """Return the line about an added or removed property or part, with its value."""
    subject, name, part = term(difference.subject), difference.name, difference.property
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


def _without_details(difference: Difference) -> str:
    """Return the values of an added part. An inertial is shown without products of inertia and axes."""
    parts = (difference.new or "").split(", ")
    if difference.property == "inertial":
        parts = [part for part in parts if not part.startswith(_DETAILS_OF_INERTIAL)]
    return ", ".join(parts)


def _angle_between(old: Sequence[float], new: Sequence[float]) -> float:
    """Return the angle in degrees between two rotations, each in roll, pitch and yaw in rad."""
    first, second = (pose_quaternion(Pose((0.0, 0.0, 0.0), (rpy[0], rpy[1], rpy[2]))) for rpy in (old, new))
    cosine = abs(sum(a * b for a, b in zip(first, second, strict=True)))
    return math.degrees(2.0 * math.acos(min(1.0, cosine)))
