"""The comparison of a description in two versions, with each set of argument values that its callers pass."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from linkwright.descriptions import Description
from linkwright.descriptions.comparison import Comparison, Difference, sentence
from linkwright.descriptions.pairs import Model, Pair
from linkwright.diagnostics import LinkwrightError, Phrase, phrase, term
from linkwright.geometry.single import Pose, pose_quaternion
from linkwright.lint.checking import Checker
from linkwright.review.breaking import breaking_reason
from linkwright.review.changes import Change, Effect, Location
from linkwright.review.collisions import collision_changes
from linkwright.review.figures import RobotMeasures, figures_of
from linkwright.review.file_pair import FilePair
from linkwright.review.frames import UNMOVED, SharedFrames
from linkwright.review.images import view_images
from linkwright.review.merging import merged
from linkwright.review.names_in_plugins import path_of_renamed
from linkwright.review.parts.expanded import expanded_places
from linkwright.review.plugins import added_topics, contents_text, missing_topics_reason
from linkwright.review.scenes import robot_scene
from linkwright.review.versions import Version
from linkwright.urdf import Robot

_MAX_CASES = 12
"""The maximum number of argument sets to compare. Vendors' launch files can combine hundreds."""


@dataclass(frozen=True)
class _Case:
    """A description in both versions with one set of argument values.

    Attributes:
        name: the values as ``name:=value`` words; empty for the defaults.
        old: the old description.
        new: the new description.
        models: both models.
    """

    name: str
    old: Description
    new: Description
    models: Pair


def compare_descriptions(pair: FilePair) -> None:
    """Compare two versions of a description with each set of argument values."""
    groups: dict[Hashable, _Group] = {}
    collisions: list[Change] = []
    for case in _cases(pair):
        pair.cases.append(case.name)
        if case.old.robot is None or case.new.robot is None:
            continue
        pair.expanded.update(expanded_places(pair.versions, case.old, case.new))
        comparison = case.models.compare(case.old.robot, case.new.robot)
        frames = SharedFrames(case.old.robot, case.new.robot, comparison.links)
        for change in _changes(pair, comparison, frames, case.old.robot, case.new.robot):
            group = groups.setdefault(change.identity, _Group(change))
            group.names[change.name] = None
            group.cases[case.name] = None
        if pair.drawings.images and not pair.images:
            pair.images += view_images(case.models, case.old.robot, case.new.robot, comparison, frames)
            if pair.images and pair.drawings.scenes:
                roots = pair.versions.old.root, pair.versions.new.root
                pair.scene = robot_scene(case.models, case.old, case.new, roots)
        if len(pair.cases) == 1:
            old = RobotMeasures(case.old.robot, case.models.old, UNMOVED, frames.old)
            new = RobotMeasures(case.new.robot, case.models.new, frames.new_root, frames.new)
            pair.figures += figures_of(old, new)
            collisions = list(collision_changes(old, new))
    pair.changes += merged(group.change(pair.cases) for group in groups.values())
    pair.changes += collisions


@dataclass
class _Group:
    """A change with the names of the links or joints, and of the argument sets, with which it occurs."""

    first: Change
    names: dict[str, None] = field(default_factory=dict)
    cases: dict[str, None] = field(default_factory=dict)

    def change(self, all_cases: Sequence[str]) -> Change:
        cases = () if len(self.cases) == len(set(all_cases)) else tuple(self.cases)
        return replace(self.first, cases=cases, other_names=tuple(self.names)[1:])


def _cases(pair: FilePair) -> Iterator[_Case]:
    """Yield the description with each set of values that one of the versions is called with.

    Sets with which neither version can be read are problems, as are those with which only one can.
    """
    sets: dict[str, Mapping[str, str]] = {}
    for version, path in ((pair.versions.new, pair.new_path), (pair.versions.old, pair.old_path)):
        for values in _argument_sets(version, path):
            sets.setdefault(_case_name(values, version), values)
    if len(sets) > _MAX_CASES:
        text = phrase(
            "only {count} of {total} sets of argument values were compared", count=_MAX_CASES, total=len(sets)
        )
        pair.add_problem(text)
    for name, values in list(sets.items())[:_MAX_CASES]:
        models = Pair(pair.versions.old.model(pair.old_path, values), pair.versions.new.model(pair.new_path, values))
        old = _read(pair, models.old, pair.versions.old)
        new = _read(pair, models.new, pair.versions.new)
        if old is not None and new is not None:
            yield _Case(name, old, new, models)


def _argument_sets(version: Version, path: str) -> list[Mapping[str, str]]:
    """Return the values with which a description is called, or its defaults if it is not."""
    checker = Checker(folders=(version.root,))
    return [values for values, _ in checker.calls(version.file(path), ())] or [{}]


def _case_name(values: Mapping[str, str], version: Version) -> str:
    """Return the values as they are written on the command line, without the folder of the version."""
    text = " ".join(f"{name}:={value}" for name, value in sorted(values.items()))
    return text.replace(str(version.root), ".")


def _read(pair: FilePair, model: Model, version: Version) -> Description | None:
    try:
        return model.read()
    except LinkwrightError as error:
        first = error.diagnostics[0]
        location = "" if first.span is None else f"{model.display_name(first.span.file)}:{first.span.line}: "
        pair.add_unreadable(version, phrase("{location}{reason}", location=location, reason=first.message))
        return None


# --- changes of a robot ----------------------------------------------------------------------------------------------


def _changes(pair: FilePair, comparison: Comparison, frames: SharedFrames, old: Robot, new: Robot) -> Iterator[Change]:
    if old.root != new.root:
        text = phrase("root link '{old}' -> '{new}'", old=old.root, new=new.root)
        if frames.are_aligned:
            text = phrase(
                "{change} (both robots are compared in the frame of '{link}')", change=text, link=frames.reference
            )
        yield Change(
            text,
            Effect.BREAKING,
            phrase("programs that use '{old}' as the base frame of the robot get other transforms", old=old.root)
            if old.root in new.links
            else phrase("programs that look up the frame '{name}' do not find it", name=old.root),
        )
    added = added_topics(comparison.differences)
    for difference in comparison.differences:
        reason = breaking_reason(difference, old, new) or missing_topics_reason(difference, added)
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        text = sentence_of_difference(difference)
        if difference.subject == "link" and difference.kind == "renamed":
            text = _with_motion(text, frames.distance(difference.old or ""))
        yield Change(text, effect, reason, _location(pair, difference))


def _with_motion(text: Phrase, distance: float | None) -> Phrase:
    """Return the sentence about a renamed link with the distance by which it has moved, if it has."""
    return text if distance is None else phrase("{change} (moved by {distance:.4g} m)", change=text, distance=distance)


def _location(pair: FilePair, difference: Difference) -> Location | None:
    """Return where the new value is, or else the old value; None for files outside the repository."""
    new, old = difference.new_place, difference.old_place
    return (pair.location(new.span) if new else None) or (pair.location(old.span, is_old=True) if old else None)


def sentence_of_difference(difference: Difference) -> Phrase:
    """Return a difference in one line. A moved or rotated frame also has the distance or angle."""
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
    contents = None if difference.element is None else contents_text(difference.element)
    if contents is not None:
        change = _presence(difference) if difference.kind == "changed" else text
        return phrase("{change}: {contents}", change=change, contents=contents)
    if difference.kind == "changed" and (difference.old is None or difference.new is None):
        return _presence(difference)
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


def _presence(difference: Difference) -> Phrase:
    """Return in one line that a property or a part was added or removed."""
    subject, name = term(difference.subject), difference.name
    if difference.new is None:
        return phrase(
            "{subject} '{name}': {property} removed", subject=subject, name=name, property=difference.property
        )
    return phrase(
        "{subject} '{name}': {property} added: {new}",
        subject=subject,
        name=name,
        property=difference.property,
        new=" ".join(filter(None, (difference.new, difference.unit))),
    )


def _angle_between(old: Sequence[float], new: Sequence[float]) -> float:
    """Return the angle in degrees between two rotations, each in roll, pitch and yaw in rad."""
    first, second = (pose_quaternion(Pose((0.0, 0.0, 0.0), (rpy[0], rpy[1], rpy[2]))) for rpy in (old, new))
    cosine = abs(sum(a * b for a, b in zip(first, second, strict=True)))
    return math.degrees(2.0 * math.acos(min(1.0, cosine)))
