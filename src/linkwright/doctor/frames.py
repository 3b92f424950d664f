"""Problems of frames: missing transforms, several publishers, and separate trees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, did_you_mean, foreign, phrase
from linkwright.doctor.record import Observation, ObservedTransform, format_names, list_node_names
from linkwright.doctor.robots import MOVING_TYPES, ObservedRobot
from linkwright.graph.endpoints.base import EndpointKind
from linkwright.urdf import Joint

_JOINT_STATE = "sensor_msgs/msg/JointState"
_WORLD, _WORLD_POSES = "world", "/world_poses"
"""The frame of a simulated world, and the topic with the poses of its links."""
_WORLD_TOPICS = ("/world_rays", "/world_rays/others")
"""Topics whose messages are in frames ``robot::link`` of a simulated world.

Viewers receive the poses of these frames on a separate topic and not by tf."""


def examine_frames(observation: Observation, robots: Sequence[ObservedRobot]) -> Iterator[Diagnostic]:
    """Yield findings about frames and their transforms."""
    yield from _examine_contradictions(observation)
    yield from _examine_numbers(observation)
    cycle = _find_cycle(observation.transforms)
    if cycle:
        yield Diagnostic(
            "DOC307",
            phrase("the parents of frames form a cycle: {cycle}", cycle=" -> ".join(cycle)),
            hint=phrase("publish each frame's transform from one node only: two nodes disagree about the parents"),
        )
    for robot in robots:
        yield from _examine_missing(observation, robot)
    yield from _examine_trees(observation, robots)
    yield from _examine_fixed_frames(observation, robots)
    yield from _examine_message_frames(observation, robots)


def _examine_contradictions(observation: Observation) -> Iterator[Diagnostic]:
    by_child: dict[str, list[ObservedTransform]] = {}
    for transform in observation.transforms:
        by_child.setdefault(transform.child, []).append(transform)
    children_by_senders: dict[tuple[str, ...], list[str]] = {}
    for child, transforms in sorted(by_child.items()):
        parents = sorted({transform.parent for transform in transforms})
        senders = tuple(sorted({sender for transform in transforms for sender in transform.senders}))
        if len(parents) > 1:
            notes = tuple(
                Note(
                    phrase(
                        "its parent is '{parent}' according to {senders}",
                        senders=format_names(transform.senders),
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
                    parents=format_names(parents),
                ),
                notes=notes,
                hint=phrase("remove one of the publishers, or invert one transform: a frame has only one parent"),
            )
        elif len(senders) > 1:
            children_by_senders.setdefault(senders, []).append(child)
    for senders, children in sorted(children_by_senders.items()):
        yield Diagnostic(
            "DOC302",
            phrase(
                "{count} nodes publish the transform of {frames}: {senders}",
                count=len(senders),
                frames=_format_frames(children),
                senders=format_names(senders),
            ),
            notes=(Note(phrase("the frames jump between the published poses")),),
            hint=phrase(
                "stop one of them, or configure it not to publish these frames (for example publish_tf: false)"
            ),
        )


def _examine_numbers(observation: Observation) -> Iterator[Diagnostic]:
    for transform in observation.transforms:
        if not transform.is_valid:
            yield Diagnostic(
                "DOC306",
                phrase(
                    "the transform of frame '{child}' has numbers that are not finite, or a rotation of length zero",
                    child=transform.child,
                ),
                notes=(Note(phrase("published by {senders}", senders=format_names(transform.senders))),),
                hint=phrase(
                    "check the joint positions and origins from which it is computed; the identity rotation is w: 1"
                ),
            )


def _find_cycle(transforms: Sequence[ObservedTransform]) -> list[str]:
    """Return the frames of a cycle in the tree of frames, or an empty list.

    The first frame is repeated as the last one.
    """
    parents = {transform.child: transform.parent for transform in transforms}
    visited: set[str] = set()
    for start in parents:
        path: list[str] = []
        frame: str | None = start
        while frame is not None and frame not in visited:
            if frame in path:
                return [*path[path.index(frame) :], frame]
            path.append(frame)
            frame = parents.get(frame)
        visited.update(path)
    return []


def _examine_missing(observation: Observation, robot: ObservedRobot) -> Iterator[Diagnostic]:
    """Yield findings about the frames of a robot's links that have no transform.

    Frames whose transforms are missing for the same reason share a finding.
    """
    existing_frames = {transform.child for transform in observation.transforms}
    missing_joints = [joint for joint in robot.joints if robot.frame(joint.child) not in existing_frames]
    if not missing_joints:
        return
    if len(missing_joints) == len(robot.joints) and not any(
        endpoint.name.rpartition("/")[2] in ("tf", "tf_static")
        for endpoint in observation.endpoints_of_kind(EndpointKind.PUBLISHER)
    ):
        frames = [robot.frame(joint.child) for joint in missing_joints]
        yield Diagnostic(
            "DOC301",
            phrase(
                "there is no transform of {frames}, because no node publishes transforms",
                frames=_format_frames(frames),
            ),
            notes=(
                Note(
                    phrase(
                        "these frames are links of the robot on topic '{topic}', published by '{sender}'",
                        topic=robot.topic,
                        sender=robot.sender,
                    )
                ),
            ),
            hint=phrase("start robot_state_publisher with this description"),
        )
        return
    fixed_joints = [joint for joint in missing_joints if joint.type not in MOVING_TYPES]
    joints_without_state = [
        joint for joint in missing_joints if joint.type in MOVING_TYPES and not _has_state(observation, robot, joint)
    ]
    joints_with_state = [
        joint for joint in missing_joints if joint.type in MOVING_TYPES and _has_state(observation, robot, joint)
    ]
    if fixed_joints:
        yield _make_missing_static_finding(robot, fixed_joints)
    if joints_without_state:
        yield from _make_missing_state_findings(observation, robot, joints_without_state)
    if joints_with_state:
        yield _make_unused_state_finding(observation, robot, joints_with_state)


def _has_state(observation: Observation, robot: ObservedRobot, joint: Joint) -> bool:
    return robot.find_leader(joint) in {joint.name for joint in observation.joints}


def _make_missing_static_finding(robot: ObservedRobot, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    return Diagnostic(
        "DOC304",
        phrase(
            "there is no transform of {frames}, because no static transform was published",
            frames=_format_frames(frames),
        ),
        notes=(Note(phrase("fixed joints: {joints}", joints=format_names(joint.name for joint in joints))),),
        hint=phrase(
            "check that robot_state_publisher runs with this description and that its publisher of /tf_static is "
            "transient local, because it publishes the transforms of fixed joints only once"
        ),
    )


def _make_missing_state_findings(
    observation: Observation, robot: ObservedRobot, joints: Sequence[Joint]
) -> Iterator[Diagnostic]:
    names = list(dict.fromkeys(robot.find_leader(joint) for joint in joints))
    frames = [robot.frame(joint.child) for joint in joints]
    senders = list_node_names(
        endpoint
        for endpoint in observation.endpoints_of_kind(EndpointKind.PUBLISHER)
        if endpoint.type_name == _JOINT_STATE
    )
    published_joints = [joint.name for joint in observation.joints]
    if not senders:
        yield Diagnostic(
            "DOC401",
            phrase(
                "no node publishes joint states, so there is no transform of {frames}", frames=_format_frames(frames)
            ),
            notes=(Note(phrase("joints of the robot that move: {names}", names=format_names(names))),),
            hint=phrase("start joint_state_publisher, joint_state_publisher_gui, or the robot's driver"),
        )
    elif not published_joints:
        yield Diagnostic(
            "DOC402",
            phrase(
                "{senders} did not publish joint states in {seconds:g} s, so there is no transform of {frames}",
                senders=format_names(senders),
                seconds=observation.seconds,
                frames=_format_frames(frames),
            ),
            notes=(Note(phrase("joints of the robot that move: {names}", names=format_names(names))),),
            hint=phrase("check whether the publisher waits for a description, or for a controller that is not active"),
        )
    else:
        for name in names:
            affected_frames = [robot.frame(joint.child) for joint in joints if robot.find_leader(joint) == name]
            suggestion = did_you_mean(
                name, [candidate for candidate in published_joints if candidate not in robot.joint_names]
            )
            yield Diagnostic(
                "DOC403",
                phrase(
                    "joint '{name}' is not in the joint states, so there is no transform of {frames}",
                    name=name,
                    frames=_format_frames(affected_frames),
                ),
                notes=(
                    Note(
                        phrase(
                            "joint states of {published} are published by {senders}",
                            senders=format_names(senders),
                            published=format_names(published_joints),
                        )
                    ),
                ),
                hint=suggestion
                or phrase(
                    "configure the driver or controller of the joint to publish its state (joint_state_broadcaster: "
                    "joints), or run joint_state_publisher with source_list"
                ),
            )


def _make_unused_state_finding(observation: Observation, robot: ObservedRobot, joints: Sequence[Joint]) -> Diagnostic:
    frames = [robot.frame(joint.child) for joint in joints]
    leader_names = {robot.find_leader(joint) for joint in joints}
    topics = sorted({topic for joint in observation.joints if joint.name in leader_names for topic in joint.topics})
    subscribers = list_node_names(
        endpoint
        for endpoint in observation.endpoints_of_kind(EndpointKind.SUBSCRIPTION)
        if endpoint.name in topics and endpoint.type_name == _JOINT_STATE
    )
    if not subscribers:
        hint = phrase(
            "no node subscribes to {topics}: remap joint_states of robot_state_publisher to this topic",
            topics=format_names(topics),
        )
    else:
        hint = phrase(
            "check the stamps of the joint states; robot_state_publisher ignores states whose stamp is zero or "
            "goes back"
        )
    return Diagnostic(
        "DOC305",
        phrase(
            "the state of joint {joints} is published, but there is no transform of {frames}",
            joints=format_names(joint.name for joint in joints),
            frames=_format_frames(frames),
        ),
        notes=(Note(phrase("published on {topics}", topics=format_names(topics))),),
        hint=hint,
    )


def _format_frames(names: Sequence[str]) -> Phrase:
    if len(names) == 1:
        return phrase("frame {names}", names=format_names(names))
    return phrase("{count} frames, {names}", count=len(names), names=format_names(names))


def _examine_trees(observation: Observation, robots: Sequence[ObservedRobot]) -> Iterator[Diagnostic]:
    children = {transform.child for transform in observation.transforms}
    roots = sorted({transform.parent for transform in observation.transforms} - children)
    if len(roots) < 2:
        return
    # Missing transforms of robots are reported by other findings, so they are omitted here.
    reported_frames = {robot.frame(joint.child) for robot in robots for joint in robot.joints} - children
    separate_roots = [root for root in roots if root not in reported_frames]
    if len(separate_roots) < 2:
        return
    sizes = {root: _compute_tree_size(root, observation.transforms) for root in separate_roots}
    largest = max(separate_roots, key=lambda root: sizes[root])
    notes = tuple(
        Note(phrase("frames below '{root}': {sizes}", root=root, sizes=sizes[root])) for root in separate_roots
    )
    other_roots = [root for root in separate_roots if root != largest]
    yield Diagnostic(
        "DOC308",
        phrase("the frames form {count} separate trees", count=len(separate_roots)),
        severity=Severity.WARNING,
        notes=notes,
        hint=phrase(
            "publish a transform between them: ros2 run tf2_ros static_transform_publisher"
            " --frame-id {largest} --child-frame-id {others}",
            largest=largest,
            others=other_roots[0],
        ),
    )


def _compute_tree_size(root: str, transforms: Sequence[ObservedTransform]) -> int:
    children_by_parent: dict[str, set[str]] = {}
    for transform in transforms:
        children_by_parent.setdefault(transform.parent, set()).add(transform.child)
    descendants, pending = set(), [root]
    while pending:
        for child in children_by_parent.get(pending.pop(), ()):
            if child not in descendants:
                descendants.add(child)
                pending.append(child)
    return len(descendants)


def _examine_fixed_frames(observation: Observation, robots: Sequence[ObservedRobot]) -> Iterator[Diagnostic]:
    known_frames = {name for transform in observation.transforms for name in (transform.parent, transform.child)}
    known_frames |= {robot.frame(robot.root) for robot in robots}
    if observation.find_publishers(_WORLD_POSES):
        known_frames.add(_WORLD)  # in the viewer, the frames of tf are in the world frame
    if not known_frames and not observation.frames:
        return  # nothing needs a frame, such as beside the turtles of turtlesim
    roots = sorted(
        {transform.parent for transform in observation.transforms}
        - {transform.child for transform in observation.transforms}
    )
    for frame in observation.fixed_frames:
        if frame.name in known_frames:
            continue
        known_note = (
            phrase("known frames: {known}", known=format_names(sorted(known_frames)))
            if known_frames
            else phrase("there are no frames")
        )
        suggestion = did_you_mean(frame.name, known_frames)
        yield Diagnostic(
            "DOC309",
            phrase(
                "the fixed frame '{name}' of {source} does not exist, so nothing is shown",
                name=frame.name,
                source=foreign(frame.source),
            ),
            notes=(Note(known_note),),
            hint=suggestion or _make_other_frame_hint(roots),
        )


def _examine_message_frames(observation: Observation, robots: Sequence[ObservedRobot]) -> Iterator[Diagnostic]:
    """Yield findings about message frames that have no transform and do not belong to a robot."""
    if not observation.transforms:
        return
    known_frames = {name for transform in observation.transforms for name in (transform.parent, transform.child)}
    robot_frames = {robot.frame(joint.child) for robot in robots for joint in robot.joints}
    robot_frames |= {robot.frame(robot.root) for robot in robots}
    if observation.find_publishers(_WORLD_POSES):
        known_frames.add(_WORLD)
    for frame in observation.frames:
        if frame.topic not in _WORLD_TOPICS and frame.frame not in known_frames | robot_frames:
            yield Diagnostic(
                "DOC310",
                phrase(
                    "{sender} publishes '{topic}' in frame '{frame}', which does not exist",
                    topic=frame.topic,
                    sender=format_names([frame.sender]),
                    frame=frame.frame,
                ),
                notes=(Note(phrase("known frames: {known}", known=format_names(sorted(known_frames)))),),
                hint=did_you_mean(frame.frame, known_frames)
                or phrase(
                    "publish a transform of the frame, for example with static_transform_publisher, or configure the "
                    "node to use another frame"
                ),
            )


def _make_other_frame_hint(roots: Sequence[str]) -> Phrase:
    """Return a hint to choose another Fixed Frame, with the roots of the frame trees."""
    if not roots:
        return phrase("choose another Fixed Frame")
    if len(roots) == 1:
        return phrase("choose another Fixed Frame; the root of all frames is {roots}", roots=format_names(roots))
    return phrase("choose another Fixed Frame; the roots of the trees of frames are {roots}", roots=format_names(roots))
