"""Checks of references by name in models, frames, joints and poses."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Phrase, Severity, did_you_mean, joined, phrase
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.joints import Joint
from linkwright.sdf.lights import Light
from linkwright.sdf.links import Collision, Link, Visual
from linkwright.sdf.models import Frame, Model
from linkwright.sdf.poses import MODEL, SEPARATOR, WORLD, RawPose
from linkwright.sdf.report import describe_element
from linkwright.sdf.sensors import Sensor
from linkwright.sdf.worlds import Sdf, World
from linkwright.xmltree import Element


def check_references(sdf: Sdf) -> list[Diagnostic]:
    """Return the findings on references by name, without duplicates.

    Includes must be resolved first.
    """
    findings: dict[tuple[object, str], Diagnostic] = {}
    inserted_models = (model for world in sdf.worlds for state in world.states for model in state.insertions.models)
    owners: tuple[World | Model, ...] = (*sdf.worlds, *sdf.models, *inserted_models)
    for owner in owners:
        for diagnostic in _check_owner(owner, Frames(owner)):
            findings.setdefault((diagnostic.span, str(diagnostic.message)), diagnostic)
    return list(findings.values())


def _check_owner(owner: World | Model, frames: Frames) -> Iterator[Diagnostic]:
    links = owner.links if isinstance(owner, Model) else ()
    if isinstance(owner, Model):
        yield from _check_model(owner, frames)
    posed_elements: tuple[Link | Frame | Model, ...] = (*links, *owner.frames, *owner.models)
    for posed_element in posed_elements:
        yield from _check_pose(posed_element.pose, posed_element.element, frames)
    for frame in owner.frames:
        if frame.attached_to and not _is_known(frame.attached_to, frames):
            yield _make_missing_frame_error(frame.element, "attached_to", frame.attached_to, frames)
    for link in links:
        link_children: tuple[Visual | Collision | Sensor | Light, ...] = (
            *link.visuals,
            *link.collisions,
            *link.sensors,
            *link.lights,
        )
        for link_child in link_children:
            # libsdformat resolves these references only when needed, and continues if a frame is missing.
            yield from (
                diagnostic.with_changes(severity=Severity.WARNING)
                for diagnostic in _check_pose(link_child.pose, link_child.element, frames)
            )
    for joint in owner.joints:
        yield from _check_joint(joint, frames)
    yield from _check_cycles((*owner.frames, *links, *owner.joints, *owner.models), frames)
    for model in owner.models:
        if frames.elements_by_name.get(model.name) is model:
            yield from _check_owner(model, frames.inside(model.name))


def _check_model(model: Model, frames: Frames) -> Iterator[Diagnostic]:
    if not (model.links or model.models or model.includes or model.static):
        message = phrase("{element} has no links", element=_describe(model.element))
        yield _make_error("SDF132", message, model.element, hint=phrase("add a <link>, or make the model static"))
    for attribute in ("canonical_link", "placement_frame"):
        name = getattr(model, attribute)
        if name and not _is_known(name, frames):
            yield _make_missing_frame_error(model.element, attribute, name, frames)


def _check_joint(joint: Joint, frames: Frames) -> Iterator[Diagnostic]:
    for end_tag in ("parent", "child"):
        name = getattr(joint, end_tag)
        if not name or (name == WORLD and end_tag == "parent") or _is_known(name, frames):
            continue
        element = joint.element.first(end_tag) if joint.element is not None else None
        message = phrase(
            "<{tag}> of {owner} refers to '{name}', which does not exist",
            tag=end_tag,
            owner=_describe(joint.element),
            name=name,
        )
        yield _make_error(
            "SDF140", message, element or joint.element, hint=did_you_mean(name, _list_link_candidates(frames))
        )
    if joint.parent and joint.parent == joint.child:
        message = phrase("{owner} connects '{name}' to itself", owner=_describe(joint.element), name=joint.child)
        yield _make_error("SDF140", message, joint.element)
    yield from _check_pose(joint.pose, joint.element, frames)
    for axis, tag in ((joint.axis, "axis"), (joint.axis2, "axis2")):
        if axis is not None and axis.expressed_in and not _is_known(axis.expressed_in, frames):
            element = joint.element.first(tag) if joint.element is not None else None
            xyz = element.first("xyz") if element is not None else None
            yield _make_missing_frame_error(xyz, "expressed_in", axis.expressed_in, frames)


def _check_pose(pose: RawPose | None, element: Element | None, frames: Frames) -> Iterator[Diagnostic]:
    if pose is None or not pose.relative_to or _is_known(pose.relative_to, frames):
        return
    pose_element = element.first("pose") if element is not None else None
    attribute = "relative_to" if pose_element is not None and "relative_to" in pose_element.attributes else "frame"
    yield _make_missing_frame_error(pose_element, attribute, pose.relative_to, frames)


def _check_cycles(elements: tuple[Frame | Link | Joint | Model, ...], frames: Frames) -> Iterator[Diagnostic]:
    """Yield a finding for each cycle of relative poses."""
    reported: set[frozenset[str]] = set()
    for element in elements:
        cycle = _find_cycle(element.name, frames)
        if not cycle or frozenset(cycle) in reported:
            continue
        reported.add(frozenset(cycle))
        message = phrase("the poses of these frames depend on each other in a cycle: {value}", value=" -> ".join(cycle))
        first_element = frames.elements_by_name.get(cycle[0])
        yield _make_error(
            "SDF142",
            message,
            (first_element or element).element,
            hint=phrase("make the pose of one frame independent of the other frames"),
        )


def _find_cycle(name: str, frames: Frames) -> tuple[str, ...]:
    """Return the cycle of frames on which the pose of a frame depends, or an empty tuple."""
    try:
        frames.pose(name)
    except FrameError as error:
        return error.cycle
    return ()


def _is_known(name: str, frames: Frames) -> bool:
    """Return whether a frame exists, or may exist in an include that cannot be resolved."""
    if name in frames:
        return True
    head = name.partition(SEPARATOR)[0]
    if head in frames.elements_by_name and head != name:
        nested_model = frames.elements_by_name[head]
        return isinstance(nested_model, Model) and bool(nested_model.includes)
    return bool(frames.owner.includes)


def _make_missing_frame_error(element: Element | None, attribute: str, name: str, frames: Frames) -> Diagnostic:
    message = phrase("'{attribute}' refers to '{name}', which does not exist", attribute=attribute, name=name)
    hint = did_you_mean(name, frames.elements_by_name) or phrase(
        "choose from {names}", names=joined([*frames.elements_by_name][:8] or [MODEL])
    )
    return _make_error("SDF141", message, element, attribute, hint)


def _list_link_candidates(frames: Frames) -> list[str]:
    return [name for name, element in frames.elements_by_name.items() if not isinstance(element, Joint)]


def _describe(element: Element | None) -> Phrase:
    return phrase("a model") if element is None else describe_element(element)


def _make_error(
    code: str, message: Phrase, element: Element | None, attribute: str | None = None, hint: Phrase | None = None
) -> Diagnostic:
    if element is None:
        return Diagnostic(code, message, None, Severity.ERROR, hint=hint)
    span = element.attribute_span(attribute) if attribute and attribute in element.attributes else element.span()
    return Diagnostic(code, message, span, Severity.ERROR, hint=hint, source=element.source)
