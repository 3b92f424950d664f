"""Problems of frames: no transform, several publishers, or no connection to the other frames."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, did_you_mean, foreign, phrase
from linkwright.doctor.record import Observation, TransformSeen, listed, nodes_of
from linkwright.doctor.robots import MOVING, RobotSeen
from linkwright.graph.endpoints.base import EndpointKind
from linkwright.urdf import Joint

_JOINT_STATE = "sensor_msgs/msg/JointState"
_WORLD, _WORLD_POSES = "world", "/world_poses"
"""The frame of a simulated world, and the topic that tells where its links are."""
_OF_THE_WORLD = ("/world_rays", "/world_rays/others")
"""Topics in frames of a simulated world, ``robot::link``, of which viewers learn by its own topic and not by tf."""


def examine_frames(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    """Yield findings on frames and their transforms."""
    yield from _contradictions(seen)
    yield from _numbers(seen)
    circle = _cycle(seen.transforms)
    if circle:
        yield Diagnostic(
            "DOC307",
            phrase("the parents of frames form a cycle: {circle}", circle=" -> ".join(circle)),
            hint=phrase("two nodes disagree about the parents; publish each frame's transform from one node only"),
        )
    for robot in robots:
        yield from _missing(seen, robot)
    yield from _trees(seen, robots)
    yield from _fixed_frames(seen, robots)
    yield from _frames_of_messages(seen, robots)


def _contradictions(seen: Observation) -> Iterator[Diagnostic]:
    by_child: dict[str, list[TransformSeen]] = {}
    for transform in seen.transforms:
        by_child.setdefault(transform.child, []).append(transform)
    shared: dict[tuple[str, ...], list[str]] = {}
    for child, transforms in sorted(by_child.items()):
        parents = sorted({transform.parent for transform in transforms})
        senders = tuple(sorted({sender for transform in transforms for sender in transform.senders}))
        if len(parents) > 1:
            notes = tuple(
                Note(
                    phrase(
                        "its parent is '{parent}' according to {senders}",
                        senders=listed(transform.senders),
                        parent=transform.parent,
                    )
                )
                for transform in sorted(transforms, key=lambda transform: transform.parent)
            )
            yield Diagnostic(
                "DOC303",
                phrase(
                    "frame '{child}' has {count} parents, {parents}, and jumps between them",
                    child=child,
                    count=len(parents),
                    parents=listed(parents),
                ),
                notes=notes,
                hint=phrase("a frame has one parent: remove one of the publishers, or invert one transform"),
            )
        elif len(senders) > 1:
            shared.setdefault(senders, []).append(child)
    for senders, children in sorted(shared.items()):
        yield Diagnostic(
            "DOC302",
            phrase(
                "{count} nodes publish the transform of {frames}: {senders}",
                count=len(senders),
                frames=_frames(children),
                senders=listed(senders),
            ),
            notes=(Note(phrase("the frames jump between the poses that they publish")),),
            hint=phrase(
                "stop one of them, or configure it not to publish these frames (for example publish_tf: false)"
            ),
        )


def _numbers(seen: Observation) -> Iterator[Diagnostic]:
    for transform in seen.transforms:
        if not transform.valid:
            yield Diagnostic(
                "DOC306",
                phrase(
                    "the transform of frame '{child}' has numbers that are not finite, or a rotation of length zero",
                    child=transform.child,
                ),
                notes=(Note(phrase("it is published by {senders}", senders=listed(transform.senders))),),
                hint=phrase(
                    "check the joint positions and origins from which it is computed; the identity rotation is w: 1"
                ),
            )


def _cycle(transforms: Sequence[TransformSeen]) -> list[str]:
    """Return the frames of a cycle in the tree of frames, or an empty list if there is none.

    The first frame is repeated at the end.
    """
    parent = {transform.child: transform.parent for transform in transforms}
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
    """Yield findings on the frames of a robot's links that have no transform.

    Frames with the same cause share a finding.
    """
    there = {transform.child for transform in seen.transforms}
    without = [joint for joint in robot.joints if robot.frame(joint.child) not in there]
    if not without:
        return
    if len(without) == len(robot.joints) and not any(
        endpoint.name.rpartition("/")[2] in ("tf", "tf_static") for endpoint in seen.of_kind(EndpointKind.PUBLISHER)
    ):
        frames = [robot.frame(joint.child) for joint in without]
        yield Diagnostic(
            "DOC301",
            phrase("there is no transform of {frames}: no node publishes transforms", frames=_frames(frames)),
            notes=(
                Note(
                    phrase(
                        "they are links of the robot on topic '{topic}', published by '{sender}'",
                        topic=robot.topic,
                        sender=robot.sender,
                    )
                ),
            ),
            hint=phrase("start robot_state_publisher with this description"),
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
    return robot.leader(joint) in {joint.name for joint in seen.joints}


def _never_sent(robot: RobotSeen, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    return Diagnostic(
        "DOC304",
        phrase("there is no transform of {frames}: no static transform of it was published", frames=_frames(frames)),
        notes=(Note(phrase("fixed joints: {joints}", joints=listed(joint.name for joint in joints))),),
        hint=phrase(
            "robot_state_publisher publishes them once on /tf_static when it starts: check that it runs "
            "with this description, and that its publisher is transient local, so that late "
            "subscriptions receive them"
        ),
    )


def _without_state(seen: Observation, robot: RobotSeen, joints: Sequence[Joint]) -> Iterator[Diagnostic]:
    names = list(dict.fromkeys(robot.leader(joint) for joint in joints))
    frames = [robot.frame(joint.child) for joint in joints]
    senders = nodes_of(
        endpoint for endpoint in seen.of_kind(EndpointKind.PUBLISHER) if endpoint.type_name == _JOINT_STATE
    )
    published = [joint.name for joint in seen.joints]
    if not senders:
        yield Diagnostic(
            "DOC401",
            phrase("no node publishes joint states, so there is no transform of {frames}", frames=_frames(frames)),
            notes=(Note(phrase("joints of the robot that move: {names}", names=listed(names))),),
            hint=phrase("start joint_state_publisher, joint_state_publisher_gui, or the robot's driver"),
        )
    elif not published:
        yield Diagnostic(
            "DOC402",
            phrase(
                "{senders} did not publish joint states in {seconds:g} s, so there is no transform of {frames}",
                senders=listed(senders),
                seconds=seen.seconds,
                frames=_frames(frames),
            ),
            notes=(Note(phrase("joints of the robot that move: {names}", names=listed(names))),),
            hint=phrase("is it waiting for a description, or for a controller that is not active?"),
        )
    else:
        for name in names:
            behind = [robot.frame(joint.child) for joint in joints if robot.leader(joint) == name]
            near = did_you_mean(name, [other for other in published if other not in robot.joint_names])
            yield Diagnostic(
                "DOC403",
                phrase(
                    "joint '{name}' is not in the joint states, so there is no transform of {frames}",
                    name=name,
                    frames=_frames(behind),
                ),
                notes=(
                    Note(
                        phrase("{senders} publishes {published}", senders=listed(senders), published=listed(published))
                    ),
                ),
                hint=near
                or phrase(
                    "configure its driver or controller to publish it (joint_state_broadcaster: joints), or run "
                    "joint_state_publisher with source_list"
                ),
            )


def _not_followed(seen: Observation, robot: RobotSeen, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    wanted = {robot.leader(joint) for joint in joints}
    topics = sorted({topic for joint in seen.joints if joint.name in wanted for topic in joint.topics})
    heard = nodes_of(
        endpoint
        for endpoint in seen.of_kind(EndpointKind.SUBSCRIPTION)
        if endpoint.name in topics and endpoint.type_name == _JOINT_STATE
    )
    if not heard:
        hint = phrase(
            "no node subscribes to {topics}: remap robot_state_publisher's joint_states to it", topics=listed(topics)
        )
    else:
        hint = phrase(
            "are the stamps of the joint states zero or going back? robot_state_publisher ignores such states"
        )
    return Diagnostic(
        "DOC305",
        phrase(
            "joint {joints} is published, but there is no transform of {frames}",
            joints=listed(joint.name for joint in joints),
            frames=_frames(frames),
        ),
        notes=(Note(phrase("it is published on {topics}", topics=listed(topics))),),
        hint=hint,
    )


def _frames(names: Sequence[str]) -> Phrase:
    if len(names) == 1:
        return phrase("frame {names}", names=listed(names))
    return phrase("{count} frames, {names}", count=len(names), names=listed(names))


def _trees(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    children = {transform.child for transform in seen.transforms}
    roots = sorted({transform.parent for transform in seen.transforms} - children)
    if len(roots) < 2:
        return
    # Missing transforms of robots are reported above, so leave them out here.
    broken = {robot.frame(joint.child) for robot in robots for joint in robot.joints} - children
    apart = [root for root in roots if root not in broken]
    if len(apart) < 2:
        return
    sizes = {root: _size(root, seen.transforms) for root in apart}
    largest = max(apart, key=lambda root: sizes[root])
    notes = tuple(Note(phrase("frames below '{root}': {sizes}", root=root, sizes=sizes[root])) for root in apart)
    others = [root for root in apart if root != largest]
    yield Diagnostic(
        "DOC308",
        phrase("the frames form {count} separate trees", count=len(apart)),
        severity=Severity.WARNING,
        notes=notes,
        hint=phrase(
            "publish a transform between them: ros2 run tf2_ros static_transform_publisher"
            " --frame-id {largest} --child-frame-id {others}",
            largest=largest,
            others=others[0],
        ),
    )


def _size(root: str, transforms: Sequence[TransformSeen]) -> int:
    below: dict[str, set[str]] = {}
    for transform in transforms:
        below.setdefault(transform.parent, set()).add(transform.child)
    found, pending = set(), [root]
    while pending:
        for child in below.get(pending.pop(), ()):
            if child not in found:
                found.add(child)
                pending.append(child)
    return len(found)


def _fixed_frames(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    known = {name for transform in seen.transforms for name in (transform.parent, transform.child)}
    known |= {robot.frame(robot.root) for robot in robots}
    if seen.publishers_of(_WORLD_POSES):
        known.add(_WORLD)  # in the viewer, the frames of tf are in the world frame
    roots = sorted(
        {transform.parent for transform in seen.transforms} - {transform.child for transform in seen.transforms}
    )
    for frame in seen.fixed_frames:
        if frame.name in known:
            continue
        there = (
            phrase("known frames: {known}", known=listed(sorted(known)))
            if known
            else phrase("there are no frames at all")
        )
        near = did_you_mean(frame.name, known)
        yield Diagnostic(
            "DOC309",
            phrase(
                "the fixed frame '{name}' of {source} does not exist, so nothing is shown",
                name=frame.name,
                source=foreign(frame.source),
            ),
            notes=(Note(there),),
            hint=near or _another(roots),
        )


def _frames_of_messages(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    """Yield findings on message frames that have no transform and do not belong to a robot."""
    if not seen.transforms:
        return
    known = {name for transform in seen.transforms for name in (transform.parent, transform.child)}
    robot_frames = {robot.frame(joint.child) for robot in robots for joint in robot.joints}
    robot_frames |= {robot.frame(robot.root) for robot in robots}
    if seen.publishers_of(_WORLD_POSES):
        known.add(_WORLD)
    for frame in seen.frames:
        if frame.topic not in _OF_THE_WORLD and frame.frame not in known | robot_frames:
            yield Diagnostic(
                "DOC310",
                phrase(
                    "'{topic}' of {sender} is in frame '{frame}', which does not exist",
                    topic=frame.topic,
                    sender=listed([frame.sender]),
                    frame=frame.frame,
                ),
                notes=(Note(phrase("known frames: {known}", known=listed(sorted(known)))),),
                hint=did_you_mean(frame.frame, known)
                or phrase(
                    "publish its transform, as static_transform_publisher does, or configure the node to use "
                    "another frame"
                ),
            )


def _another(roots: Sequence[str]) -> Phrase:
    """Return a hint that names a frame to use instead of a fixed frame that does not exist."""
    if not roots:
        return phrase("choose another Fixed Frame")
    if len(roots) == 1:
        return phrase("choose another Fixed Frame; the root of all frames is {roots}", roots=listed(roots))
    return phrase("choose another Fixed Frame; the roots of the trees of frames are {roots}", roots=listed(roots))
