"""Problems of robot descriptions and joint states."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Note, Severity, did_you_mean, foreign, phrase
from linkwright.doctor.record import Observation, listed
from linkwright.urdf import Joint, Robot

MOVING = frozenset({"revolute", "continuous", "prismatic"})
"""Joints whose transforms follow joint states; robot_state_publisher treats all others as fixed."""


@dataclass(frozen=True, slots=True)
class RobotSeen:
    """A robot whose description was observed on a topic.

    Attributes:
        topic: the topic of the description.
        sender: the full name of the node that published the description.
        model: the parsed description.
        prefix: the prefix of frame names, which precedes the names of links (``frame_prefix``).
    """

    topic: str
    sender: str
    model: Robot
    prefix: str = ""

    @property
    def root(self) -> str:
        """The name of the root link, which is not the child of a joint."""
        return self.model.root

    @property
    def joints(self) -> Sequence[Joint]:
        """All joints of the robot."""
        return list(self.model.joints.values())

    @property
    def joint_names(self) -> frozenset[str]:
        """The names of all joints."""
        return frozenset(self.model.joints)

    def frame(self, link: str) -> str:
        """Return the name of the frame of a link."""
        return f"{self.prefix}{link}"

    def leader(self, joint: Joint) -> str:
        """Return the name of the joint whose state determines the position of a joint.

        The result is the joint that it mimics, or else the joint itself.
        """
        followed: set[str] = set()
        while joint.mimic is not None and joint.name not in followed and joint.mimic.joint in self.model.joints:
            followed.add(joint.name)
            joint = self.model.joints[joint.mimic.joint]
        return joint.name


def robots_in(seen: Observation) -> tuple[list[RobotSeen], list[Diagnostic]]:
    """Parse the observed descriptions.

    Returns:
        The robots, and findings on descriptions that cannot be parsed.
    """
    robots: dict[tuple[str, str], RobotSeen] = {}
    found = []
    for description in seen.descriptions:
        reading = DescriptionLibrary().read(description.text)
        if reading.robot is not None:
            prefix = _prefix(reading.robot, seen)
            robots[description.topic, description.text] = RobotSeen(
                description.topic, description.sender, reading.robot, prefix
            )
            continue
        first = reading.diagnostics[0].message if reading.diagnostics else phrase("it is empty")
        found.append(
            Diagnostic(
                "DOC501",
                phrase(
                    "the description that '{sender}' publishes on '{topic}' is not URDF: {first}",
                    sender=description.sender,
                    topic=description.topic,
                    first=foreign(first),
                ),
                hint=phrase("it must be the text of the description, as `xacro FILE` prints it, not a file's name"),
            )
        )
    return list(robots.values()), found


def _prefix(robot: Robot, seen: Observation) -> str:
    """Return the prefix with which most links of a robot occur in the observed frames.

    The result is empty if the frames have no prefix.
    """
    frames = {name for transform in seen.transforms for name in (transform.parent, transform.child)}
    if any(link in frames for link in robot.links):
        return ""
    prefixes = {frame.removesuffix(robot.root) for frame in frames if frame.endswith(robot.root)}
    return max(prefixes, key=lambda prefix: sum(prefix + link in frames for link in robot.links), default="")


def examine_robots(seen: Observation, robots: Sequence[RobotSeen]) -> Iterator[Diagnostic]:
    """Yield findings on descriptions and joint states."""
    yield from _several_descriptions(seen)
    yield from _contradictions(seen)
    if len(robots) == 1:
        yield from _unknown_joints(seen, robots[0])


def _several_descriptions(seen: Observation) -> Iterator[Diagnostic]:
    by_topic: dict[str, dict[str, str]] = {}
    for description in seen.descriptions:
        by_topic.setdefault(description.topic, {})[description.sender] = description.text
    for topic, texts in sorted(by_topic.items()):
        if len(texts) < 2:
            continue
        differ = len(set(texts.values())) > 1
        yield Diagnostic(
            "DOC502",
            phrase(
                "{count} nodes publish '{topic}': {texts}", count=len(texts), topic=topic, texts=listed(sorted(texts))
            ),
            severity=Severity.ERROR if differ else Severity.WARNING,
            notes=(
                Note(
                    phrase("the descriptions differ; subscribers use the last one")
                    if differ
                    else phrase("the descriptions are the same")
                ),
            ),
            hint=phrase("stop one of them, or give each robot its own namespace"),
        )


def _contradictions(seen: Observation) -> Iterator[Diagnostic]:
    shared: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
    for joint in seen.joints:
        if len(joint.senders) > 1 and len(joint.topics) == 1:
            shared.setdefault((joint.senders, joint.topics), []).append(joint.name)
    for (senders, topics), names in sorted(shared.items()):
        yield Diagnostic(
            "DOC404",
            phrase(
                "{count} nodes publish the state of joint {names} on {topics}: {senders}",
                count=len(senders),
                names=listed(names),
                topics=listed(topics),
                senders=listed(senders),
            ),
            severity=Severity.WARNING,
            notes=(Note(phrase("the robot jumps between their values")),),
            hint=phrase(
                "stop one of them: joint_state_publisher_gui is for descriptions without a robot; if a "
                "driver runs too, let it publish to another topic"
            ),
        )


def _unknown_joints(seen: Observation, robot: RobotSeen) -> Iterator[Diagnostic]:
    stated = {joint.name for joint in seen.joints}
    unstated = [joint.name for joint in robot.joints if joint.type in MOVING and joint.name not in stated]
    for joint in seen.joints:
        if joint.name in robot.joint_names:
            continue
        near = did_you_mean(joint.name, unstated) or did_you_mean(joint.name, robot.joint_names)
        yield Diagnostic(
            "DOC405",
            phrase(
                "{senders} publishes joint '{name}', which robot '{model_name}' does not have",
                senders=listed(joint.senders),
                name=joint.name,
                model_name=robot.model.name,
            ),
            severity=Severity.WARNING,
            hint=near or phrase("its joints are {joint_names}", joint_names=listed(sorted(robot.joint_names))),
        )
