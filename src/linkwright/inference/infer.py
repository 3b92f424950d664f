"""Inference of the elements that a description lacks to be driven in a simulated world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase, quoted_names
from linkwright.inertia import MeshLibrary
from linkwright.inference import gazebo
from linkwright.inference.drives import Verdict, judge
from linkwright.inference.missing import missing_collisions, missing_masses
from linkwright.inference.model import Drive, DriveKind, Finding, Inference, Wheel
from linkwright.inference.undercarriage import Survey, Undercarriage
from linkwright.urdf import Joint, Robot
from linkwright.xmltree import Element

_MOVING = ("revolute", "continuous", "prismatic")
_WORLD = "world"
"""The root that simulators do not move."""

_OPTION = phrase("choose the drive with `--drive KIND`, and the joints of the driven wheels with `--wheels LEFT,RIGHT`")


def infer(robot: Robot, meshes: MeshLibrary, *, kind: DriveKind | None = None, wheels: Sequence[str] = ()) -> Inference:
    """Infer the elements that a description lacks to be driven in a simulated world.

    Elements of the description take precedence: a link's own collisions and masses, and the simulator plugin or
    ``<ros2_control>`` that drives the robot.

    Args:
        robot: the robot; the findings refer to its elements.
        meshes: the library of its meshes.
        kind: the kind of drive chosen by the user, which overrides that of the description.
        wheels: the joints, or the links, of the driven wheels named by the user.

    Raises:
        LinkwrightError: DRIVE210, there is no such wheel; DRIVE211, the wheels do not make a drive of that kind.
    """
    survey = Survey(robot, meshes)
    under = survey.undercarriage()
    chosen = [_chosen(survey, name) for name in wheels]
    asked = kind is not None or bool(chosen)
    own, idle = (None, None) if asked else (gazebo.own_drive(robot), gazebo.idle_drive(robot))
    verdict = Verdict(None, Phrase("")) if own is not None else _verdict(survey, under, kind, chosen)
    if own is None and idle is not None and verdict.drive is None:
        verdict = Verdict(Drive("joints"), phrase("its own controllers do not work here"))
    if asked and verdict.drive is None:
        message = phrase("'{robot}' cannot be driven as requested: {why}", robot=robot.name, why=verdict.reason)
        raise LinkwrightError(Diagnostic("DRIVE211", message, hint=_OPTION))
    return _Inferring(survey, under, verdict, own, idle).result()


class _Inferring:
    """Builds an inference once the drive is known."""

    def __init__(
        self, survey: Survey, under: Undercarriage, verdict: Verdict, own: Element | None, idle: Element | None
    ) -> None:
        self._survey = survey
        self._robot = survey.robot
        self._under = under
        self._verdict = verdict
        self._own, self._idle = own, idle
        drive = verdict.drive
        self._drive = drive
        self._driven = (
            {} if drive is None else {wheel.link: wheel for wheel in (*drive.left, *drive.right, *drive.steered)}
        )
        casters = (*under.casters, *verdict.extra_casters)
        self._casters = tuple(name for name in dict.fromkeys(casters) if name not in self._driven)
        standing = {wheel.link: wheel for wheel in (*under.wheels, *under.crooked)} | self._driven
        self._wheels = standing | {wheel.link: wheel for wheel in survey.rolling if wheel.link in self._casters}
        stands_still = drive is not None and drive.kind == "joints"
        self._fixed_base = self._robot.root == _WORLD or (stands_still and _one_chain(survey))

        names = ("base_footprint", "base_link")
        self._base_frame = next((name for name in names if name in self._robot.links), self._robot.root)

    def result(self) -> Inference:
        """Return the inference."""
        findings = [*missing_collisions(self._survey, self._wheels, self._casters)]
        solid = (*self._wheels, *self._casters)
        findings += missing_masses(self._survey, solid, fixed_base=self._fixed_base)
        masses = self._masses(findings)
        held = self._held()
        findings += self._moved(held, sum(masses.values()))
        ground = self._survey.base_in_root.point((0.0, 0.0, self._under.ground or 0.0))[2]
        fixed = self._fixed_base
        return Inference(
            self._drive, tuple(findings), self._base_frame, self._casters, held, fixed, 0.0 if fixed else ground, masses
        )

    def _masses(self, findings: list[Finding]) -> dict[str, float]:
        links = self._robot.links
        masses = {name: link.inertial.mass for name, link in links.items() if link.inertial is not None}
        names = {id(link.element): name for name, link in links.items()}
        masses |= {
            names[id(finding.owner)]: finding.inertial.mass for finding in findings if finding.inertial is not None
        }
        return {name: mass for name, mass in masses.items() if mass > 0.0}

    def _held(self) -> tuple[str, ...]:
        """Return the joints that nothing else moves, and that a controller must hold."""
        if self._own is not None and self._idle is None:
            return ()
        rolling = {wheel.joint for wheel in self._wheels.values()} | self._under.swivelling
        rolling |= gazebo.controlled_joints(self._robot)
        for wheel in self._wheels.values():
            rolling |= {joint.name for joint in self._survey.chain(self._robot.joints[wheel.joint].parent)}
        commanded = gazebo.commanded_joints(self._robot)
        return tuple(
            joint.name
            for joint in self._robot.joints.values()
            if joint.type in _MOVING and joint.mimic is None and joint.name not in rolling
            if self._own is None or joint.name in commanded
        )

    def _moved(self, held: tuple[str, ...], mass: float) -> Iterator[Finding]:
        """Yield the findings on the drive, the casters and the joints."""
        root = self._robot.element
        if self._idle is not None:
            message = phrase(
                "'{what}', the drive that '{robot}' declares, has no effect here", **self._named(self._idle)
            )
            yield Finding(_at(self._idle, "DRIVE205", message))
        if self._own is not None:
            message = phrase("'{robot}' declares its own drive, '{what}'", **self._named(self._own))
            yield Finding(_at(self._own, "DRIVE202", message))
            yield from self._holding(held)
            return
        drive = self._drive
        if drive is None:
            yield self._undriven()
            return
        if drive.kind != "joints":
            yield from self._turned_axes(drive)
            message = phrase(
                "'{robot}' gets a {kind} drive: {why}",
                robot=self._robot.name,
                kind=drive.kind,
                why=self._verdict.reason,
            )
            yield Finding(
                self._at_root("DRIVE111", message),
                root,
                (gazebo.drive_plugin(self._robot, drive, self._base_frame, mass),),
            )
            yield from self._slippery()
            yield from self._unsupported(drive)
        if self._fixed_base and self._robot.root != _WORLD:
            message = phrase("'{robot}' is fixed to the world: {why}", robot=self._robot.name, why=self._verdict.reason)
            yield Finding(self._at_root("DRIVE113", message), root, tuple(_anchor(self._robot)))
        yield from self._holding(held)
        moving = [joint.name for joint in self._robot.joints.values() if joint.type in _MOVING]
        if moving and not gazebo.publishes_joint_states(self._robot):
            message = phrase("the positions of the joints are published as joint_states")
            yield Finding(self._at_root("DRIVE115", message), root, (gazebo.joint_states(moving),))

    def _holding(self, held: tuple[str, ...]) -> Iterator[Finding]:
        if held:
            message = phrase(
                "nothing drives {joints}: each holds its position until it receives a command",
                joints=quoted_names(held),
            )
            yield Finding(self._at_root("DRIVE114", message), self._robot.element, (gazebo.joint_controllers(held),))

    def _named(self, what: Element) -> dict[str, str]:
        named = what.attributes.get("filename") or what.attributes.get("name") or what.tag
        return {"robot": self._robot.name, "what": named}

    def _undriven(self) -> Finding:
        if not any(joint.type in _MOVING for joint in self._robot.joints.values()):
            message = phrase("no joint of '{robot}' moves: there is nothing to drive", robot=self._robot.name)
            return Finding(self._at_root("DRIVE203", message))
        message = phrase("the drive of '{robot}' is unknown: {why}", robot=self._robot.name, why=self._verdict.reason)
        return Finding(self._at_root("DRIVE201", message, Severity.WARNING, _OPTION))

    def _turned_axes(self, drive: Drive) -> Iterator[Finding]:
        """Yield reversed axes for those that point to the right.

        For plugins of Gazebo, a positive velocity drives forward.
        """
        if drive.kind == "mecanum":
            return
        for wheel in (*drive.left, *drive.right, *drive.steered):
            joint = self._robot.joints[wheel.joint]
            if wheel.axis[1] > 0.0 or joint.element is None:
                continue
            axis = Element("axis", {"xyz": " ".join(gazebo.number(-part + 0.0) for part in joint.axis)})
            message = phrase(
                "the axis of joint '{joint}' points to the right: it is reversed, because a positive "
                "velocity must drive forward",
                joint=joint.name,
            )
            yield Finding(_at(joint.element, "DRIVE110", message), joint.element, (axis,))

    def _slippery(self) -> Iterator[Finding]:
        for name in self._casters:
            element = self._robot.links[name].element
            if element is None or gazebo.has_friction(self._robot, name) or self._rolls_freely(name):
                continue
            message = phrase(
                "link '{link}' touches the ground and is not driven: it slides without friction", link=name
            )
            yield Finding(_at(element, "DRIVE112", message), self._robot.element, (gazebo.slippery(name),))

    def _rolls_freely(self, link: str) -> bool:
        """Return whether a caster rotates about its own axis and about a vertical one, as real casters do."""
        wheel = self._wheels.get(link)
        return wheel is not None and wheel.width is not None and wheel.steering is not None

    def _unsupported(self, drive: Drive) -> Iterator[Finding]:
        if drive.kind == "differential" and not self._casters and len(self._under.wheels) == 2:
            message = phrase(
                "only the two driven wheels of '{robot}' touch the ground: it tips over until another part touches it",
                robot=self._robot.name,
            )
            hint = phrase("add a caster, such as a ball that touches the ground in front of or behind the wheels")
            yield Finding(self._at_root("DRIVE204", message, Severity.WARNING, hint))

    def _at_root(
        self, code: str, message: Phrase, severity: Severity = Severity.INFO, hint: Phrase | None = None
    ) -> Diagnostic:
        return _at(self._robot.element, code, message, severity, hint)


def _at(
    element: Element | None,
    code: str,
    message: Phrase,
    severity: Severity = Severity.INFO,
    hint: Phrase | None = None,
) -> Diagnostic:
    """Return a finding about an element."""
    if element is None:
        return Diagnostic(code, message, None, severity, hint=hint)
    return Diagnostic(code, message, element.span(), severity, hint=hint, source=element.source)


def _verdict(survey: Survey, under: Undercarriage, kind: DriveKind | None, chosen: Sequence[Wheel]) -> Verdict:
    """Return which drive the robot has: wheels, or the joints of a robot with a fixed base."""
    if kind == "joints":
        return Verdict(Drive("joints"), phrase("its joints are driven, as requested"))
    if kind is None and not chosen and survey.robot.root == _WORLD:
        return Verdict(Drive("joints"), phrase("its root is 'world', which does not move"))
    if kind is not None or chosen or under.wheels or under.crooked:
        return judge(survey, under, kind, chosen)
    return _without_wheels(survey, under)


def _without_wheels(survey: Survey, under: Undercarriage) -> Verdict:
    """Return the verdict on a robot without wheels; if it is an arm, its base does not move."""
    if under.hanging:
        wheel, height = under.hanging[0]
        reason = phrase(
            "the wheel on '{joint}' ends {height:.3g} m above the lowest point, which is on link '{link}'",
            joint=wheel.joint,
            height=height,
            link=under.lowest_link,
        )
        return Verdict(None, reason)
    for link, mesh in under.unread.items():
        return Verdict(
            None,
            phrase("the mesh '{mesh}' of link '{link}', which may be a wheel, cannot be read", mesh=mesh, link=link),
        )
    if _one_chain(survey):
        return Verdict(Drive("joints"), phrase("it has no wheels, and all its joints form one chain from a base"))
    return Verdict(None, phrase("it has no wheels, and its base has more than one chain of joints"))


def _one_chain(survey: Survey) -> bool:
    """Return whether only one joint moves relative to the root's body.

    All other joints are then connected through it.
    """
    moving = [joint for joint in survey.robot.joints.values() if joint.type in _MOVING and joint.mimic is None]
    root = survey.bodies.of(survey.robot.root)
    first = [joint for joint in moving if root is not None and joint.parent in root.frames]
    return len(first) == 1


def _chosen(survey: Survey, name: str) -> Wheel:
    """Return the wheel of a joint or link that the user names.

    Raises:
        LinkwrightError: DRIVE210, there is no such wheel.
    """
    joint = survey.robot.joints.get(name) or _joint_of(survey.robot, name)
    if joint is None:
        known = [*survey.robot.joints]
        message = phrase("the robot has no joint '{name}'", name=name)
        raise LinkwrightError(Diagnostic("DRIVE210", message, hint=did_you_mean(name, known)))
    wheel = survey.wheel_on(joint)
    if wheel is None:
        message = phrase(
            "joint '{joint}' does not turn a wheel: a wheel must be round about a horizontal axis and "
            "turn without limits",
            joint=joint.name,
        )
        raise LinkwrightError(_at(joint.element, "DRIVE210", message, Severity.ERROR))
    return wheel


def _joint_of(robot: Robot, link: str) -> Joint | None:
    return next((joint for joint in robot.joints.values() if joint.child == link), None)


def _anchor(robot: Robot) -> Iterator[Element]:
    """Yield the link and joint that fix a robot to the world.

    Simulators do not move a root link named ``world``.
    """
    yield Element("link", {"name": _WORLD})
    joint = Element("joint", {"name": f"{_WORLD}_joint", "type": "fixed"})
    joint.children += [Element("parent", {"link": _WORLD}), Element("child", {"link": robot.root})]
    yield joint
