"""Checks references by name in joints and poses."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Phrase, Severity, did_you_mean, joined, phrase
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.joints import Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.links import Collision, Link, Visual
from linkwright.sdf.models import Frame, Model
from linkwright.sdf.poses import MODEL, SEPARATOR, WORLD, RawPose
from linkwright.sdf.report import described
from linkwright.sdf.sensors import Sensor
from linkwright.sdf.worlds import Sdf, World
from linkwright.xmltree import Element


def check_references(sdf: Sdf) -> list[Diagnostic]:
    """Return the findings on references by name, without duplicates.

    The includes of the file must have been resolved.
    """
    found: dict[tuple[object, str], Diagnostic] = {}
    inserted = (model for world in sdf.worlds for state in world.states for model in state.insertions.models)
    owners: tuple[World | Model, ...] = (*sdf.worlds, *sdf.models, *inserted)
    for owner in owners:
        for diagnostic in _check(owner, Frames(owner)):
            found.setdefault((diagnostic.span, str(diagnostic.message)), diagnostic)
    return list(found.values())


def _check(owner: World | Model, frames: Frames) -> Iterator[Diagnostic]:
    links = owner.links if isinstance(owner, Model) else ()
    if isinstance(owner, Model):
        yield from _model(owner, frames)
    placed: tuple[Link | Frame | Model, ...] = (*links, *owner.frames, *owner.models)
    for item in placed:
        yield from _pose(item.pose, item.element, frames)
    for frame in owner.frames:
        if frame.attached_to and not _is_known(frame.attached_to, frames):
            yield _unknown(frame.element, "attached_to", frame.attached_to, frames)
    for link in links:
        parts: tuple[Visual | Collision | Sensor | Light, ...] = (
            *link.visuals,
            *link.collisions,
            *link.sensors,
            *link.lights,
        )
        for part in parts:
            # libsdformat resolves these references only when needed, and continues if a frame is missing.
            yield from (
                diagnostic.with_changes(severity=Severity.WARNING)
                for diagnostic in _pose(part.pose, part.element, frames)
            )
    for joint in owner.joints:
        yield from _joint(joint, frames)
    yield from _check_cycles((*owner.frames, *links, *owner.joints, *owner.models), frames)
    for model in owner.models:
        if frames.named.get(model.name) is model:
            yield from _check(model, frames.inside(model.name))


def _model(model: Model, frames: Frames) -> Iterator[Diagnostic]:
    if not (model.links or model.models or model.includes or model.static):
        message = phrase("{whose} has no links", whose=_described(model.element))
        yield _error("SDF132", message, model.element, hint=phrase("a model that moves has at least one <link>"))
    for attribute in ("canonical_link", "placement_frame"):
        name = getattr(model, attribute)
        if name and not _is_known(name, frames):
            yield _unknown(model.element, attribute, name, frames)


def _joint(joint: Joint, frames: Frames) -> Iterator[Diagnostic]:
    for end in ("parent", "child"):
        name = getattr(joint, end)
        if not name or (name == WORLD and end == "parent") or _is_known(name, frames):
            continue
        element = joint.element.first(end) if joint.element is not None else None
        message = phrase(
            "<{tag}> of {owner} names '{name}', which does not exist",
            tag=end,
            owner=_described(joint.element),
            name=name,
        )
        yield _error("SDF140", message, element or joint.element, hint=did_you_mean(name, _linkable(frames)))
    if joint.parent and joint.parent == joint.child:
        message = phrase("{owner} connects '{name}' with itself", owner=_described(joint.element), name=joint.child)
        yield _error("SDF140", message, joint.element)
    yield from _pose(joint.pose, joint.element, frames)
    for axis, tag in ((joint.axis, "axis"), (joint.axis2, "axis2")):
        if axis is not None and axis.expressed_in and not _is_known(axis.expressed_in, frames):
            element = joint.element.first(tag) if joint.element is not None else None
            xyz = element.first("xyz") if element is not None else None
            yield _unknown(xyz, "expressed_in", axis.expressed_in, frames)


def _pose(pose: RawPose | None, element: Element | None, frames: Frames) -> Iterator[Diagnostic]:
    if pose is None or not pose.relative_to or _is_known(pose.relative_to, frames):
        return
    written = element.first("pose") if element is not None else None
    attribute = "relative_to" if written is not None and "relative_to" in written.attributes else "frame"
    yield _unknown(written, attribute, pose.relative_to, frames)


def _check_cycles(parts: tuple[Frame | Link | Joint | Model, ...], frames: Frames) -> Iterator[Diagnostic]:
    """Yield a finding for each cycle of frames whose poses are relative to each other."""
    reported: set[frozenset[str]] = set()
    for part in parts:
        circle = _find_cycle(part.name, frames)
        if not circle or frozenset(circle) in reported:
            continue
        reported.add(frozenset(circle))
        message = phrase("frames are relative to each other in a cycle: {value}", value=" -> ".join(circle))
        named = frames.named.get(circle[0])
        yield _error(
            "SDF142",
            message,
            (named or part).element,
            hint=phrase("make the pose of one of them independent of the others"),
        )


def _find_cycle(name: str, frames: Frames) -> tuple[str, ...]:
    """Return the cycle of frames on which the pose of a frame depends; empty if there is none."""
    try:
        frames.pose(name)
    except FrameError as error:
        return error.circle
    return ()


def _is_known(name: str, frames: Frames) -> bool:
    """Return whether a frame exists, or may exist in an include that cannot be resolved."""
    if name in frames:
        return True
    head = name.partition(SEPARATOR)[0]
    if head in frames.named and head != name:
        inner = frames.named[head]
        return isinstance(inner, Model) and bool(inner.includes)
    return bool(frames.owner.includes)


def _unknown(element: Element | None, attribute: str, name: str, frames: Frames) -> Diagnostic:
    message = phrase("'{attribute}' names '{name}', which does not exist", attribute=attribute, name=name)
    hint = did_you_mean(name, frames.named) or phrase(
        "choose from {names}", names=joined([*frames.named][:8] or [MODEL])
    )
    return _error("SDF141", message, element, attribute, hint)


def _linkable(frames: Frames) -> list[str]:
    return [name for name, part in frames.named.items() if not isinstance(part, Joint)]


def _described(element: Element | None) -> Phrase:
    return phrase("a model") if element is None else described(element)


def _error(
    code: str, message: Phrase, element: Element | None, attribute: str | None = None, hint: Phrase | None = None
) -> Diagnostic:
    if element is None:
        return Diagnostic(code, message, None, Severity.ERROR, hint=hint)
    span = element.attribute_span(attribute) if attribute and attribute in element.attributes else element.span()
    return Diagnostic(code, message, span, Severity.ERROR, hint=hint, source=element.source)
