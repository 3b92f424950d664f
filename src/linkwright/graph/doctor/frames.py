"""Troubles of frames: which have no transform and why, which have two, and how they hang together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Note, Severity, did_you_mean
from linkwright.graph.doctor.record import Observation, TransformSeen, listed, nodes_of
from linkwright.graph.doctor.robots import MOVING, RobotSeen
from linkwright.graph.transport import EndpointKind
from linkwright.urdf import Joint

_JOINT_STATE = "sensor_msgs/msg/JointState"


def examine_frames(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    """What is wrong with frames."""
    yield from _contradictions(seen)
    yield from _numbers(seen)
    circle = _circle(seen.transforms)
    if circle:
        yield Diagnostic(
            "DOC307",
            f"the parents of frames go in a circle: {' -> '.join(circle)}",
            hint="two nodes disagree who is whose parent; publish each frame's transform from one node only",
        )
    for robot in robots:
        yield from _missing(seen, robot)
    yield from _trees(seen, robots)
    yield from _fixed_frames(seen, robots)


def _contradictions(seen: Observation) -> Iterator[Diagnostic]:
    by_child: dict[str, list[TransformSeen]] = {}
    for each in seen.transforms:
        by_child.setdefault(each.child, []).append(each)
    shared: dict[tuple[str, ...], list[str]] = {}
    for child, transforms in sorted(by_child.items()):
        parents = sorted({each.parent for each in transforms})
        senders = tuple(sorted({sender for each in transforms for sender in each.senders}))
        if len(parents) > 1:
            notes = tuple(
                Note(f"{listed(each.senders)} says '{each.parent}' is its parent")
                for each in sorted(transforms, key=lambda each: each.parent)
            )
            yield Diagnostic(
                "DOC303",
                f"frame '{child}' has {len(parents)} parents, {listed(parents)}, and jumps between them",
                notes=notes,
                hint="a frame has one parent: leave one of the publishers out, or turn one transform round",
            )
        elif len(senders) > 1:
            shared.setdefault(senders, []).append(child)
    for senders, children in sorted(shared.items()):
        frames = f"frame {listed(children)}" if len(children) == 1 else f"{len(children)} frames, {listed(children)}"
        yield Diagnostic(
            "DOC302",
            f"{len(senders)} nodes publish the transform of {frames}: {listed(senders)}",
            notes=(Note("what is shown jumps between what they say"),),
            hint="end one of them, or have it leave these frames out (such as publish_tf: false)",
        )


def _numbers(seen: Observation) -> Iterator[Diagnostic]:
    for each in seen.transforms:
        if not each.valid:
            yield Diagnostic(
                "DOC306",
                f"the transform of frame '{each.child}' has numbers that are none, or a rotation of length zero",
                notes=(Note(f"it is published by {listed(each.senders)}"),),
                hint="look at the joint positions and origins that go into it; a rotation that turns nothing is w: 1",
            )


def _circle(transforms: Sequence[TransformSeen]) -> list[str]:
    """The frames on a way from parent to parent that comes back to its start; empty when there is none."""
    parent = {each.child: each.parent for each in transforms}
    done: set[str] = set()
    for start in parent:
        way: list[str] = []
        frame: str | None = start
        while frame is not None and frame not in done:
            if frame in way:
                return [*way[way.index(frame) :], frame]
            way.append(frame)
            frame = parent.get(frame)
        done.update(way)
    return []


def _missing(seen: Observation, robot: RobotSeen) -> Iterator[Diagnostic]:
    """Why the frames of a robot's links are not there; frames with the same reason together."""
    there = {each.child for each in seen.transforms}
    without = [joint for joint in robot.joints if robot.frame(joint.child) not in there]
    if not without:
        return
    if len(without) == len(robot.joints) and not any(
        endpoint.name.rpartition("/")[2] in ("tf", "tf_static") for endpoint in seen.of_kind(EndpointKind.PUBLISHER)
    ):
        frames = [robot.frame(joint.child) for joint in without]
        yield Diagnostic(
            "DOC301",
            f"there is no transform of {_frames(frames)}: nobody publishes transforms",
            notes=(Note(f"they are links of the robot on topic '{robot.topic}', published by '{robot.sender}'"),),
            hint="start robot_state_publisher with this description",
        )
        return
    fixed = [joint for joint in without if joint.type not in MOVING]
    unstated = [joint for joint in without if joint.type in MOVING and not _has_state(seen, robot, joint)]
    stated = [joint for joint in without if joint.type in MOVING and _has_state(seen, robot, joint)]
    if fixed:
        yield _never_sent(robot, fixed)
    if unstated:
        yield from _without_state(seen, robot, unstated)
    if stated:
        yield _not_followed(seen, robot, stated)


def _has_state(seen: Observation, robot: RobotSeen, joint: Joint) -> bool:
    return robot.leader(joint) in {each.name for each in seen.joints}


def _never_sent(robot: RobotSeen, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    return Diagnostic(
        "DOC304",
        f"there is no transform of {_frames(frames)}: no static transform of it was published",
        notes=(Note(f"fixed joints: {listed(joint.name for joint in joints)}"),),
        hint="robot_state_publisher publishes those once on /tf_static when it starts: is it running with this "
        "description, and is its publisher transient local so that late comers get them?",
    )


def _without_state(seen: Observation, robot: RobotSeen, joints: Sequence[Joint]) -> Iterator[Diagnostic]:
    names = list(dict.fromkeys(robot.leader(joint) for joint in joints))
    frames = [robot.frame(joint.child) for joint in joints]
    senders = nodes_of(
        endpoint for endpoint in seen.of_kind(EndpointKind.PUBLISHER) if endpoint.type_name == _JOINT_STATE
    )
    published = [each.name for each in seen.joints]
    if not senders:
        yield Diagnostic(
            "DOC401",
            f"nobody publishes joint states, so there is no transform of {_frames(frames)}",
            notes=(Note(f"joints of the robot that move: {listed(names)}"),),
            hint="start joint_state_publisher, joint_state_publisher_gui, or the robot's driver",
        )
    elif not published:
        yield Diagnostic(
            "DOC402",
            f"{listed(senders)} did not publish joint states in {seen.seconds:g} s, so there is no transform of "
            f"{_frames(frames)}",
            notes=(Note(f"joints of the robot that move: {listed(names)}"),),
            hint="is it waiting for a description, or for a controller that is not active?",
        )
    else:
        for name in names:
            behind = [robot.frame(joint.child) for joint in joints if robot.leader(joint) == name]
            near = did_you_mean(name, [each for each in published if each not in robot.joint_names])
            yield Diagnostic(
                "DOC403",
                f"joint '{name}' is not in the joint states, so there is no transform of {_frames(behind)}",
                notes=(Note(f"{listed(senders)} publishes {listed(published)}"),),
                hint=near
                or "have its driver or controller publish it (joint_state_broadcaster: joints), or run "
                "joint_state_publisher with source_list",
            )


def _not_followed(seen: Observation, robot: RobotSeen, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    wanted = {robot.leader(joint) for joint in joints}
    topics = sorted({topic for each in seen.joints if each.name in wanted for topic in each.topics})
    heard = nodes_of(
        endpoint
        for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION)
        if endpoint.name in topics and endpoint.type_name == _JOINT_STATE
    )
    if not heard:
        hint = f"nobody subscribes to {listed(topics)}: remap robot_state_publisher's joint_states to it"
    else:
        hint = "are the stamps of the joint states zero or going back? robot_state_publisher ignores such states"
    return Diagnostic(
        "DOC305",
        f"joint {listed(joint.name for joint in joints)} is published, but there is no transform of {_frames(frames)}",
        notes=(Note(f"it is published on {listed(topics)}"),),
        hint=hint,
    )


def _frames(names: Sequence[str]) -> str:
    return f"frame {listed(names)}" if len(names) == 1 else f"{len(names)} frames, {listed(names)}"


def _trees(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    children = {each.child for each in seen.transforms}
    roots = sorted({each.parent for each in seen.transforms} - children)
    if len(roots) < 2:
        return
    # A robot's own missing transforms were told above; they need no second finding.
    broken = {robot.frame(joint.child) for robot in robots for joint in robot.joints} - children
    apart = [root for root in roots if root not in broken]
    if len(apart) < 2:
        return
    sizes = {root: _size(root, seen.transforms) for root in apart}
    largest = max(apart, key=lambda root: sizes[root])
    notes = tuple(Note(f"frames below '{root}': {sizes[root]}") for root in apart)
    others = [root for root in apart if root != largest]
    yield Diagnostic(
        "DOC308",
        f"frames fall into {len(apart)} trees that nothing connects",
        severity=Severity.WARNING,
        notes=notes,
        hint=f"publish a transform between them: ros2 run tf2_ros static_transform_publisher --frame-id {largest} "
        f"--child-frame-id {others[0]}",
    )


def _size(root: str, transforms: Sequence[TransformSeen]) -> int:
    below: dict[str, set[str]] = {}
    for each in transforms:
        below.setdefault(each.parent, set()).add(each.child)
    found, pending = set(), [root]
    while pending:
        for child in below.get(pending.pop(), ()):
            if child not in found:
                found.add(child)
                pending.append(child)
    return len(found)


def _fixed_frames(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    known = {name for each in seen.transforms for name in (each.parent, each.child)}
    known |= {robot.frame(robot.root) for robot in robots}
    roots = sorted({each.parent for each in seen.transforms} - {each.child for each in seen.transforms})
    for frame in seen.fixed_frames:
        if frame.name in known:
            continue
        there = f"frames there are: {listed(sorted(known))}" if known else "there are no frames at all"
        near = did_you_mean(frame.name, known)
        yield Diagnostic(
            "DOC309",
            f"the fixed frame '{frame.name}' of {frame.source} does not exist, so nothing is shown",
            notes=(Note(there),),
            hint=near or _another(roots),
        )


def _another(roots: Sequence[str]) -> str:
    """What to do about a fixed frame that is none of the frames."""
    if not roots:
        return "choose another Fixed Frame"
    if len(roots) == 1:
        return f"choose another Fixed Frame; the root of all frames is {listed(roots)}"
    return f"choose another Fixed Frame; the roots of the trees of frames are {listed(roots)}"
