"""The inference of the elements that a description lacks to be driven in a simulated world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase, quoted_names
from linkwright.inertia import MeshLibrary
from linkwright.inference import gazebo
from linkwright.inference.drives import DriveVerdict, infer_drive
from linkwright.inference.missing_elements import infer_collisions, infer_masses
from linkwright.inference.results import Drive, DriveKind, Inference, InferredFact, Wheel
from linkwright.inference.undercarriage import Survey, Undercarriage
from linkwright.urdf import Joint, Robot
from linkwright.xmltree import Element

_MOVING_TYPES = ("revolute", "continuous", "prismatic")
_WORLD_LINK = "world"
"""The name of a root link that simulators do not move."""

_DRIVE_HINT = phrase(
    "choose the drive with `--drive KIND`, and the joints of the driven wheels with `--wheels LEFT,RIGHT`"
)


def infer(robot: Robot, meshes: MeshLibrary, *, kind: DriveKind | None = None, wheels: Sequence[str] = ()) -> Inference:
    """Infer the elements that a description lacks to be driven in a simulated world.

    Elements of the description take precedence: collisions and masses of links, and the simulator plugin or
    ``<ros2_control>`` that drives the robot.

    Args:
        robot: the robot; the findings refer to its elements.
        meshes: the library that loads the robot's meshes.
        kind: the kind of drive that the user has chosen, which overrides the kind in the description; None to infer it.
        wheels: the joints, or the links, of the driven wheels that the user has chosen; empty to find them.

    Raises:
        LinkwrightError: DRIVE210, there is no such wheel; DRIVE211, the wheels do not suit that kind of drive.
    """
    survey = Survey(robot, meshes)
    undercarriage = survey.find_undercarriage()
    chosen_wheels = [_find_wheel(survey, name) for name in wheels]
    is_requested = kind is not None or bool(chosen_wheels)
    working_drive, idle_drive = (
        (None, None) if is_requested else (gazebo.find_working_drive(robot), gazebo.find_idle_drive(robot))
    )
    verdict = (
        DriveVerdict(None, Phrase(""))
        if working_drive is not None
        else _choose_drive(survey, undercarriage, kind, chosen_wheels)
    )
    if working_drive is None and idle_drive is not None and verdict.drive is None:
        verdict = DriveVerdict(Drive("joints"), phrase("the controllers of the robot do not work here"))
    if is_requested and verdict.drive is None:
        message = phrase("'{robot}' cannot be driven as requested: {reason}", robot=robot.name, reason=verdict.reason)
        raise LinkwrightError(Diagnostic("DRIVE211", message, hint=_DRIVE_HINT))
    return _InferenceBuilder(survey, undercarriage, verdict, working_drive, idle_drive).build()


class _InferenceBuilder:
    """A builder of the inference of a robot whose drive has been determined."""

    def __init__(
        self,
        survey: Survey,
        undercarriage: Undercarriage,
        verdict: DriveVerdict,
        working_drive: Element | None,
        idle_drive: Element | None,
    ) -> None:
        self._survey = survey
        self._robot = survey.robot
        self._under = undercarriage
        self._verdict = verdict
        self._working_drive, self._idle_drive = working_drive, idle_drive
        drive = verdict.drive
        self._drive = drive
        self._driven_wheels = (
            {} if drive is None else {wheel.link: wheel for wheel in (*drive.left, *drive.right, *drive.steered)}
        )
        casters = (*undercarriage.casters, *verdict.extra_casters)
        self._casters = tuple(name for name in dict.fromkeys(casters) if name not in self._driven_wheels)
        ground_wheels = {
            wheel.link: wheel for wheel in (*undercarriage.wheels, *undercarriage.misaligned)
        } | self._driven_wheels
        self._wheels = ground_wheels | {
            wheel.link: wheel for wheel in survey.rolling_wheels if wheel.link in self._casters
        }
        drives_joints = drive is not None and drive.kind == "joints"
        self._fixed_base = self._robot.root == _WORLD_LINK or (drives_joints and _is_single_chain(survey))

        base_names = ("base_footprint", "base_link")
        self._base_frame = next((name for name in base_names if name in self._robot.links), self._robot.root)

    def build(self) -> Inference:
        """Return the inference with all findings."""
        findings = [*infer_collisions(self._survey, self._wheels, self._casters)]
        solid_links = (*self._wheels, *self._casters)
        findings += infer_masses(self._survey, solid_links, fixed_base=self._fixed_base)
        masses = self._collect_link_masses(findings)
        held_joints = self._find_held_joints()
        findings += self._infer_drive(held_joints, sum(masses.values()))
        ground = self._survey.base_in_root.point((0.0, 0.0, self._under.ground or 0.0))[2]
        is_fixed = self._fixed_base
        return Inference(
            self._drive,
            tuple(findings),
            self._base_frame,
            self._casters,
            held_joints,
            is_fixed,
            0.0 if is_fixed else ground,
            masses,
            gazebo.find_plugins_without_controllers(self._robot),
        )

    def _collect_link_masses(self, findings: list[InferredFact]) -> dict[str, float]:
        links = self._robot.links
        masses = {name: link.inertial.mass for name, link in links.items() if link.inertial is not None}
        name_by_element = {id(link.element): name for name, link in links.items()}
        masses |= {
            name_by_element[id(finding.owner)]: finding.inertial.mass
            for finding in findings
            if finding.inertial is not None
        }
        return {name: mass for name, mass in masses.items() if mass > 0.0}

    def _find_held_joints(self) -> tuple[str, ...]:
        """Return the joints that a controller must hold, because nothing else moves them."""
        if self._working_drive is not None and self._idle_drive is None:
            return ()
        excluded = {wheel.joint for wheel in self._wheels.values()} | self._under.caster_joints
        excluded |= gazebo.find_controlled_joints(self._robot)
        for wheel in self._wheels.values():
            excluded |= {joint.name for joint in self._survey.find_joints_above(self._robot.joints[wheel.joint].parent)}
        commanded = gazebo.find_commanded_joints(self._robot)
        return tuple(
            joint.name
            for joint in self._robot.joints.values()
            if joint.type in _MOVING_TYPES and joint.mimic is None and joint.name not in excluded
            if self._working_drive is None or joint.name in commanded
        )

    def _infer_drive(self, held_joints: tuple[str, ...], mass: float) -> Iterator[InferredFact]:
        """Yield the findings about the drive, the casters and the joints."""
        root = self._robot.element
        if self._idle_drive is not None:
            message = phrase(
                "'{drive}', the drive that '{robot}' declares, has no effect here",
                **self._get_message_values(self._idle_drive),
            )
            yield InferredFact(_create_diagnostic(self._idle_drive, "DRIVE205", message))
        if self._working_drive is not None:
            message = phrase(
                "'{robot}' declares its own drive, '{drive}'", **self._get_message_values(self._working_drive)
            )
            yield InferredFact(_create_diagnostic(self._working_drive, "DRIVE202", message))
            yield from self._infer_held_joints(held_joints)
            return
        drive = self._drive
        if drive is None:
            yield self._create_no_drive_finding()
            return
        if drive.kind != "joints":
            yield from self._infer_reversed_axes(drive)
            message = phrase(
                "the inferred drive of '{robot}' is '{kind}': {reason}",
                robot=self._robot.name,
                kind=drive.kind,
                reason=self._verdict.reason,
            )
            yield InferredFact(
                self._create_root_diagnostic("DRIVE111", message),
                root,
                (gazebo.create_drive_element(self._robot, drive, self._base_frame, mass),),
            )
            yield from self._infer_casters()
            yield from self._infer_tipping(drive)
        if self._fixed_base and self._robot.root != _WORLD_LINK:
            message = phrase(
                "'{robot}' is fixed to the world: {reason}", robot=self._robot.name, reason=self._verdict.reason
            )
            yield InferredFact(
                self._create_root_diagnostic("DRIVE113", message), root, tuple(_create_world_anchor(self._robot))
            )
        yield from self._infer_held_joints(held_joints)
        moving = [joint.name for joint in self._robot.joints.values() if joint.type in _MOVING_TYPES]
        if moving and not gazebo.publishes_joint_states(self._robot):
            message = phrase("the positions of the joints are published as joint_states")
            yield InferredFact(
                self._create_root_diagnostic("DRIVE115", message), root, (gazebo.create_joint_states_element(moving),)
            )

    def _infer_held_joints(self, held_joints: tuple[str, ...]) -> Iterator[InferredFact]:
        if held_joints:
            message = phrase(
                "nothing drives {joints}: each holds its position until it receives a command",
                joints=quoted_names(held_joints),
            )
            yield InferredFact(
                self._create_root_diagnostic("DRIVE114", message),
                self._robot.element,
                (gazebo.create_joint_controllers_element(held_joints),),
            )

    def _get_message_values(self, element: Element) -> dict[str, str]:
        element_name = element.attributes.get("filename") or element.attributes.get("name") or element.tag
        return {"robot": self._robot.name, "drive": element_name}

    def _create_no_drive_finding(self) -> InferredFact:
        if not any(joint.type in _MOVING_TYPES for joint in self._robot.joints.values()):
            message = phrase("no joint of '{robot}' moves: there is nothing to drive", robot=self._robot.name)
            return InferredFact(self._create_root_diagnostic("DRIVE203", message))
        message = phrase(
            "the drive of '{robot}' is unknown: {reason}", robot=self._robot.name, reason=self._verdict.reason
        )
        return InferredFact(self._create_root_diagnostic("DRIVE201", message, Severity.WARNING, _DRIVE_HINT))

    def _infer_reversed_axes(self, drive: Drive) -> Iterator[InferredFact]:
        """Yield findings that reverse the axes of driven wheels if they point to the right.

        Gazebo's plugins drive forward if the velocity about an axis that points to the left is positive.
        """
        if drive.kind == "mecanum":
            return
        for wheel in (*drive.left, *drive.right, *drive.steered):
            joint = self._robot.joints[wheel.joint]
            if wheel.axis[1] > 0.0 or joint.element is None:
                continue
            axis = Element(
                "axis", {"xyz": " ".join(gazebo.format_number(-component + 0.0) for component in joint.axis)}
            )
            message = phrase(
                "the axis of joint '{joint}' points to the right: it is reversed, because a positive "
                "velocity must drive forward",
                joint=joint.name,
            )
            yield InferredFact(_create_diagnostic(joint.element, "DRIVE110", message), joint.element, (axis,))

    def _infer_casters(self) -> Iterator[InferredFact]:
        for name in self._casters:
            element = self._robot.links[name].element
            if element is None or gazebo.has_friction(self._robot, name) or self._rolls_freely(name):
                continue
            message = phrase(
                "link '{link}' touches the ground and is not driven, so its friction is set to zero", link=name
            )
            yield InferredFact(
                _create_diagnostic(element, "DRIVE112", message),
                self._robot.element,
                (gazebo.create_frictionless_element(name),),
            )

    def _rolls_freely(self, link: str) -> bool:
        """Return whether a caster rolls about its own axis and swivels about a vertical axis."""
        wheel = self._wheels.get(link)
        return wheel is not None and wheel.width is not None and wheel.steering is not None

    def _infer_tipping(self, drive: Drive) -> Iterator[InferredFact]:
        if drive.kind == "differential" and not self._casters and len(self._under.wheels) == 2:
            message = phrase(
                "only the two driven wheels of '{robot}' touch the ground: the robot tips over until "
                "another part touches the ground",
                robot=self._robot.name,
            )
            hint = phrase("add a caster, such as a ball that touches the ground in front of or behind the wheels")
            yield InferredFact(self._create_root_diagnostic("DRIVE204", message, Severity.WARNING, hint))

    def _create_root_diagnostic(
        self, code: str, message: Phrase, severity: Severity = Severity.INFO, hint: Phrase | None = None
    ) -> Diagnostic:
        return _create_diagnostic(self._robot.element, code, message, severity, hint)


def _create_diagnostic(
    element: Element | None,
    code: str,
    message: Phrase,
    severity: Severity = Severity.INFO,
    hint: Phrase | None = None,
) -> Diagnostic:
    """Return a diagnostic at an element's position, or without a position for None."""
    if element is None:
        return Diagnostic(code, message, None, severity, hint=hint)
    return Diagnostic(code, message, element.span(), severity, hint=hint, source=element.source)


def _choose_drive(
    survey: Survey, undercarriage: Undercarriage, kind: DriveKind | None, chosen_wheels: Sequence[Wheel]
) -> DriveVerdict:
    """Return the drive of a robot: by its wheels, or by joints if its base is fixed."""
    if kind == "joints":
        return DriveVerdict(Drive("joints"), phrase("its joints are driven, as requested"))
    if kind is None and not chosen_wheels and survey.robot.root == _WORLD_LINK:
        return DriveVerdict(Drive("joints"), phrase("its root is 'world', which does not move"))
    if kind is not None or chosen_wheels or undercarriage.wheels or undercarriage.misaligned:
        return infer_drive(survey, undercarriage, kind, chosen_wheels)
    return _infer_drive_without_wheels(survey, undercarriage)


def _infer_drive_without_wheels(survey: Survey, undercarriage: Undercarriage) -> DriveVerdict:
    """Return the drive of a robot without wheels: by joints if it is an arm, else none."""
    if undercarriage.raised_wheels:
        wheel, height = undercarriage.raised_wheels[0]
        reason = phrase(
            "the wheel on '{joint}' is {height:.3g} m above the robot's lowest point, which is on link '{link}'",
            joint=wheel.joint,
            height=height,
            link=undercarriage.lowest_link,
        )
        return DriveVerdict(None, reason)
    for link, mesh in undercarriage.unreadable_meshes.items():
        return DriveVerdict(
            None,
            phrase("the mesh '{mesh}' of link '{link}', which may be a wheel, cannot be read", mesh=mesh, link=link),
        )
    if _is_single_chain(survey):
        return DriveVerdict(Drive("joints"), phrase("it has no wheels, and all its joints form one chain from a base"))
    return DriveVerdict(None, phrase("it has no wheels, and its base has more than one chain of joints"))


def _is_single_chain(survey: Survey) -> bool:
    """Return whether exactly one movable joint is attached to the root's body.

    All other movable joints are then below that joint.
    """
    moving_joints = [
        joint for joint in survey.robot.joints.values() if joint.type in _MOVING_TYPES and joint.mimic is None
    ]
    root = survey.bodies.of(survey.robot.root)
    root_joints = [joint for joint in moving_joints if root is not None and joint.parent in root.frames]
    return len(root_joints) == 1


def _find_wheel(survey: Survey, name: str) -> Wheel:
    """Return the wheel on a joint or link that the user has named.

    Raises:
        LinkwrightError: DRIVE210, there is no such wheel.
    """
    joint = survey.robot.joints.get(name) or _find_parent_joint(survey.robot, name)
    if joint is None:
        joint_names = [*survey.robot.joints]
        message = phrase("the robot has no joint '{name}'", name=name)
        raise LinkwrightError(Diagnostic("DRIVE210", message, hint=did_you_mean(name, joint_names)))
    wheel = survey.find_wheel(joint)
    if wheel is None:
        message = phrase(
            "joint '{joint}' does not turn a wheel: a wheel must be round about a horizontal axis and "
            "turn without limits",
            joint=joint.name,
        )
        raise LinkwrightError(_create_diagnostic(joint.element, "DRIVE210", message, Severity.ERROR))
    return wheel


def _find_parent_joint(robot: Robot, link: str) -> Joint | None:
    return next((joint for joint in robot.joints.values() if joint.child == link), None)


def _create_world_anchor(robot: Robot) -> Iterator[Element]:
    """Yield the link and the joint that fix a robot to the world.

    Simulators do not move a root link with the name ``world``.
    """
    yield Element("link", {"name": _WORLD_LINK})
    joint = Element("joint", {"name": f"{_WORLD_LINK}_joint", "type": "fixed"})
    joint.children += [Element("parent", {"link": _WORLD_LINK}), Element("child", {"link": robot.root})]
    yield joint
