"""Problems of robot descriptions and joint states."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Note, Severity, did_you_mean, foreign, phrase
from linkwright.doctor.record import Observation, format_names
from linkwright.urdf import Joint, Robot

MOVING_TYPES = frozenset({"revolute", "continuous", "prismatic"})
"""The types of joints whose transforms follow joint states.

robot_state_publisher treats other joints as fixed.
"""


@dataclass(frozen=True, slots=True)
class ObservedRobot:
    """A robot whose description was observed on a topic.

    Attributes:
        topic: the topic of the description.
        sender: the full name of the node that published the description.
        model: the parsed description.
        prefix: the prefix of the robot's frames (``frame_prefix``), which precedes the names of links.
    """

    topic: str
    sender: str
    model: Robot
    prefix: str = ""

    @property
    def root(self) -> str:
        """The name of the root link.

        The root link is not the child of any joint.
        """
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
        """Return the name of the frame that belongs to a link."""
        return f"{self.prefix}{link}"

    def find_leader(self, joint: Joint) -> str:
        """Return the name of the joint whose state determines the position of a joint.

        For a mimic joint, the result is the joint that it mimics; for any other joint, the joint itself.
        """
        visited: set[str] = set()
        while joint.mimic is not None and joint.name not in visited and joint.mimic.joint in self.model.joints:
            visited.add(joint.name)
            joint = self.model.joints[joint.mimic.joint]
        return joint.name


def find_robots(observation: Observation) -> tuple[list[ObservedRobot], list[Diagnostic]]:
    """Return the robots with an observed description, and findings about invalid descriptions.

    A description is invalid if it cannot be parsed.
    """
    robots: dict[tuple[str, str], ObservedRobot] = {}
    findings = []
    for description in observation.descriptions:
        read_description = DescriptionLibrary().read(description.text)
        if read_description.robot is not None:
            prefix = _find_frame_prefix(read_description.robot, observation)
            robots[description.topic, description.text] = ObservedRobot(
                description.topic, description.sender, read_description.robot, prefix
            )
            continue
        error_text = read_description.diagnostics[0].message if read_description.diagnostics else phrase("it is empty")
        findings.append(
            Diagnostic(
                "DOC501",
                phrase(
                    "the description that '{sender}' publishes on '{topic}' is not URDF: {first}",
                    sender=description.sender,
                    topic=description.topic,
                    first=foreign(error_text),
                ),
                hint=phrase("publish the text of the description, as `xacro FILE` prints it, not the name of a file"),
            )
        )
    return list(robots.values()), findings


def _find_frame_prefix(robot: Robot, observation: Observation) -> str:
    """Return the prefix with which most links of a robot occur in the observed transforms.

    The prefix is empty if the observed frames have none.
    """
    frames = {name for transform in observation.transforms for name in (transform.parent, transform.child)}
    if any(link in frames for link in robot.links):
        return ""
    prefixes = {frame.removesuffix(robot.root) for frame in frames if frame.endswith(robot.root)}
    return max(prefixes, key=lambda prefix: sum(prefix + link in frames for link in robot.links), default="")


def examine_robots(observation: Observation, robots: Sequence[ObservedRobot]) -> Iterator[Diagnostic]:
    """Yield findings about robot descriptions and joint states."""
    yield from _examine_descriptions(observation)
    yield from _examine_joint_senders(observation)
    if len(robots) == 1:
        yield from _examine_unknown_joints(observation, robots[0])


def _examine_descriptions(observation: Observation) -> Iterator[Diagnostic]:
    by_topic: dict[str, dict[str, str]] = {}
    for description in observation.descriptions:
        by_topic.setdefault(description.topic, {})[description.sender] = description.text
    for topic, texts in sorted(by_topic.items()):
        if len(texts) < 2:
            continue
        are_different = len(set(texts.values())) > 1
        yield Diagnostic(
            "DOC502",
            phrase(
                "{count} nodes publish '{topic}': {texts}",
                count=len(texts),
                topic=topic,
                texts=format_names(sorted(texts)),
            ),
            severity=Severity.ERROR if are_different else Severity.WARNING,
            notes=(
                Note(
                    phrase("the descriptions differ, and subscribers use the last one")
                    if are_different
                    else phrase("the descriptions are the same")
                ),
            ),
            hint=phrase("stop one of them, or give each robot its own namespace"),
        )


def _examine_joint_senders(observation: Observation) -> Iterator[Diagnostic]:
    names_by_senders: dict[tuple[tuple[str, ...], tuple[str, ...]], list[str]] = {}
    for joint in observation.joints:
        if len(joint.senders) > 1 and len(joint.topics) == 1:
            names_by_senders.setdefault((joint.senders, joint.topics), []).append(joint.name)
    for (senders, topics), names in sorted(names_by_senders.items()):
        yield Diagnostic(
            "DOC404",
            phrase(
                "{count} nodes publish the state of joint {names} on {topics}: {senders}",
                count=len(senders),
                names=format_names(names),
                topics=format_names(topics),
                senders=format_names(senders),
            ),
            severity=Severity.WARNING,
            notes=(Note(phrase("the robot jumps between the published values")),),
            hint=phrase(
                "stop one of them; joint_state_publisher_gui is only for descriptions without a running robot, "
                "and a second driver must publish to another topic"
            ),
        )


def _examine_unknown_joints(observation: Observation, robot: ObservedRobot) -> Iterator[Diagnostic]:
    published_names = {joint.name for joint in observation.joints}
    unpublished_names = [
        joint.name for joint in robot.joints if joint.type in MOVING_TYPES and joint.name not in published_names
    ]
    for joint in observation.joints:
        if joint.name in robot.joint_names:
            continue
        suggestion = did_you_mean(joint.name, unpublished_names) or did_you_mean(joint.name, robot.joint_names)
        yield Diagnostic(
            "DOC405",
            phrase(
                "{senders} publishes the state of joint '{name}', which robot '{model_name}' does not have",
                senders=format_names(joint.senders),
                name=joint.name,
                model_name=robot.model.name,
            ),
            severity=Severity.WARNING,
            hint=suggestion
            or phrase("the joints of the robot are {joint_names}", joint_names=format_names(sorted(robot.joint_names))),
        )
