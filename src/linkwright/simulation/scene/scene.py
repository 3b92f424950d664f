"""A world as a MuJoCo specification, with a body for each link, a joint for each joint, and geoms for the shapes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product
from math import inf, isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, phrase
from linkwright.geometry.single import IDENTITY, Transform, compose, invert, rotate
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.sdf.worlds import World, gravity_of, physics_of
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.bodies import SECOND_AXIS, BodyWriter, hinge_anchors
from linkwright.simulation.scene.connections import Connected, connections_of, model_of
from linkwright.simulation.scene.couplings import gearbox_coupling, screw_coupling
from linkwright.simulation.scene.figures import draw, figures_of
from linkwright.simulation.scene.meshes import MeshLibrary, changed_at
from linkwright.simulation.scene.shapes import set_pose
from linkwright.simulation.scene.structure import HeldLink, PlacedJoint, Structure, structure_of
from linkwright.simulation.scene.wheels import SKIDDING_GRIP, make_omnidirectional, make_rolling, make_sliding
from linkwright.xmltree import Element

_USUAL_STEP = 0.001
"""The default time step in s."""
_ANCHORS_APART = 0.1
"""The distance in m of the two points that hold the axis of a hinge which closes a loop."""
_LOOP_STEPS = 4.0
"""The time constant of constraints that close a loop, in steps."""
_WHEELS_THAT_ROLL = 2
"""The greatest number of rolling wheels on a link: with more, some slip in every turn."""
_GREATEST_JUMP = 1.0
"""The greatest change of a wheel's speed in the air within a step, by a motor at its greatest torque, in rad/s.

A wheel alone weighs so little that 5 N m would turn it 14 rad/s faster in 1 ms, past the target, and back in the
next: it slips, leaves the ground and stays away from it. Motors with gears have rotors that weigh more than wheels.
"""
SERVO = "#servo"
"""The separator of a joint's name and a number in the names of servo constraints."""
_SERVO_TIME = 0.02
"""The time constant of a servo in s."""


@dataclass(slots=True)
class SceneModel:
    """A model of a scene.

    Attributes:
        name: the name of the model in the world.
        model: the parsed model.
        pose: the pose of the model's frame in the world when the model was added.
        structure: the links and joints of the model.
        parts: the parts of the model in the specification, in the order in which they were added: root bodies,
            constraints and actuators.
        files: the mesh files of the model and their modification times, in ns since the epoch.
        hangs_on: the earlier models to which joints of the world connect the model.
    """

    name: str
    model: Model
    pose: Transform
    structure: Structure
    parts: list[Any] = field(default_factory=list)
    files: dict[Path, int] = field(default_factory=dict)
    hangs_on: frozenset[str] = frozenset()

    @property
    def is_outdated(self) -> bool:
        """Whether a mesh file has changed since the model was added."""
        return any(changed_at(path) != changed for path, changed in self.files.items())


class Scene:
    """A world as a MuJoCo specification.

    Bodies and joints are named as in the world: ``robot::arm::tip``. The second axis of a joint has the suffix ``#2``,
    and the free joint of a body has the name of the body with the suffix ``#free``.

    Args:
        world: the world, with its includes resolved and as it was saved (`linkwright.sdf.saved`).
        meshes: the library of meshes.
        step: the time step in s; by default the time step of the world.
        refused: names of models that are left out, and the reasons.

    Attributes:
        spec: the specification.
        step: the time step in s.
        models: the models by name, in the order in which they were added.
        joints: the movable joints of models, by name.
        bodies: the bodies of the specification, by the names of the links.
        figures: actors and roads, which are visible but have no contacts.
    """

    def __init__(
        self,
        world: World,
        meshes: MeshLibrary,
        step: float | None = None,
        refused: Mapping[str, Phrase] = MappingProxyType({}),
    ) -> None:
        self._findings: list[Diagnostic] = []
        self.step = step or self.step_of(world)
        self.models: dict[str, SceneModel] = {}
        self.joints: dict[str, PlacedJoint] = {}
        self.bodies: dict[str, Any] = {}
        self._mujoco = mujoco = load_mujoco()
        self.spec = mujoco.MjSpec()
        meshes.spec = self.spec
        self._writer = BodyWriter(meshes)
        self._meshes = meshes
        self._motors = 0
        self._driven: dict[str, dict[str, float]] = {}  # by model: the driven joints and their rotor inertias
        self._unsettled: set[str] = set()
        self.spec.modelname = world.name or WORLD
        self.spec.compiler.degree = False
        self.spec.compiler.balanceinertia = True
        self.spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
        self._set_options(world)
        frames = Frames(world)
        self._connections = connections_of(world)
        for model in self._in_order(world.models):
            if model.name in refused:
                message = phrase("model '{name}' is left out: {why}", name=model.name, why=refused[model.name])
                self._warn("SIM117", message, model.element)
            elif model.name not in self.models:  # `check` reports duplicate names
                self._add_or_report(model, frames)
        self.figures = figures_of(world, meshes)
        for figure in self.figures:
            draw(figure, self.spec, self._writer)

    def _in_order(self, models: Iterable[Model]) -> list[Model]:
        """Return models ordered so that each follows the models to which it is attached."""
        models = list(models)
        place = {name: number for number, name in enumerate(self.in_order([model.name for model in models]))}
        return sorted(models, key=lambda model: place[model.name])

    def in_order(self, names: Sequence[str]) -> list[str]:
        """Return model names ordered so that each follows the models to which it is attached."""
        return self._connections.in_order(names)

    def step_of(self, world: World) -> float:
        """Return the time step of a world in s; if it is 0, report this and return one millisecond."""
        physics = physics_of(world)
        if physics.max_step_size:
            return physics.max_step_size
        message = phrase("the time step is 0 s; the world is simulated in steps of {step} s", step=_USUAL_STEP)
        self._warn("SIM106", message, physics.element)
        return _USUAL_STEP

    def _add_or_report(self, model: Model, frames: Frames) -> None:
        try:
            self.add(model, model.name, frames.pose(model.name))
        except FrameError as error:
            values = {"name": model.name, "frame": error.name}
            message = phrase("model '{name}' is left out: the pose of '{frame}' in it is not defined", **values)
            self._warn("SIM116", message, model.element)

    def _warn(self, code: str, message: Phrase, element: Element | None) -> None:
        span = element.span() if element is not None else None
        source = element.source if element is not None else None
        self._findings.append(Diagnostic(code, message, severity=Severity.WARNING, span=span, source=source))

    def set_physics(self, world: World, step: float) -> None:
        """Adopt gravity and the joints between models from another world, and set the time step in s.

        The models do not change.
        """
        self._connections = connections_of(world)
        self.spec.option.gravity = list(gravity_of(world))
        if step == self.step:
            return
        self.step = self.spec.option.timestep = step
        self._unsettled |= self._driven.keys()
        loops = (self._mujoco.mjtEq.mjEQ_WELD, self._mujoco.mjtEq.mjEQ_CONNECT)
        for equality in self.spec.equalities:
            if equality.type in loops:
                equality.solref = [_LOOP_STEPS * step, 1.0]

    def _set_options(self, world: World) -> None:
        """Set MuJoCo's options to values found by experiments with wheels, casters and resting bodies.

        See decision 0042.
        """
        option = self.spec.option
        option.timestep = self.step
        option.gravity = list(gravity_of(world))
        option.cone = self._mujoco.mjtCone.mjCONE_ELLIPTIC
        option.impratio = 10.0
        option.noslip_iterations = 3  # otherwise a wheel that accelerates suddenly jumps
        option.integrator = self._mujoco.mjtIntegrator.mjINT_DISCRETE
        option.enableflags |= self._mujoco.mjtEnableBit.mjENBL_SLEEP
        option.disableflags |= self._mujoco.mjtDisableBit.mjDSBL_AUTORESET

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The findings on parts that cannot be simulated."""
        return [*self._findings, *self._writer.diagnostics, *self._meshes.diagnostics]

    def add(self, model: Model, name: str, pose: Transform) -> SceneModel:
        """Add a model to the scene.

        Args:
            model: the model, with its includes resolved.
            name: the name of the model in the world, which must be unique.
            pose: the pose of the model's frame in the world.

        Raises:
            FrameError: a link of the model cannot be placed.
            LinkwrightError: SIM102, there is already a model with this name.
        """
        if name in self.models:
            raise LinkwrightError(Diagnostic("SIM102", phrase("a model '{name}' already exists", name=name)))
        connected = self._connections.of(structure_of(model, name, pose), name, pose, self.models)
        structure = connected.structure
        added = self.models[name] = SceneModel(name, model, pose, structure, hangs_on=connected.hangs_on)
        poses = {
            held.link.name: held.link.pose
            for each in (name, *connected.hangs_on)
            for held in self.models[each].structure.links
        }
        own = {held.link.name for held in structure.links}
        self._meshes.used.clear()
        for held in structure.links:
            body = self._add_link(held, poses)
            if body.parent == self.spec.worldbody or body.parent.name not in own:
                added.parts.append(body)
        added.files = dict(self._meshes.used)
        for held in structure.links:
            added.parts += self._mimic_constraints(held.joint)
            if held.joint is not None and held.joint.name in self.joints:
                added.parts += screw_coupling(self.spec, held.joint)
        for joint in (*structure.loops, *connected.loops):
            added.parts += self._closed(joint, poses)
            if joint.joint.type == "gearbox":
                added.parts += gearbox_coupling(self.spec, joint, self._moving((name, *connected.hangs_on)))
        added.parts += self._strangers(structure)
        added.parts += self._neighbour_exclusions(connected)
        return added

    def place(self, name: str, pose: Transform) -> None:
        """Set the initial pose of a model.

        Args:
            name: the name of the model.
            pose: the pose of the model's frame in the world.

        Raises:
            KeyError: there is no model with this name.
            FrameError: a link of the model cannot be placed.
        """
        placed = self.models[name]
        placed.structure = structure_of(placed.model, name, pose)
        placed.pose = pose
        for held in placed.structure.links:
            body = self.bodies[held.link.name]
            if body.parent == self.spec.worldbody:
                set_pose(body, held.link.pose)
            if held.joint is not None and held.joint.name in self.joints:
                self.joints[held.joint.name] = held.joint

    def remove(self, name: str) -> None:
        """Remove a model.

        Raises:
            KeyError: there is no model with this name.
            ValueError: another model is attached to this model.
        """
        hanging = self.attached_models(name)
        if hanging:
            raise ValueError(f"{', '.join(hanging)} must be removed before {name}")
        model = self.models.pop(name)
        self._driven.pop(name, None)
        for part in reversed(model.parts):
            self.spec.delete(part)
        for held in model.structure.links:
            del self.bodies[held.link.name]
            if held.joint is not None:
                self.joints.pop(held.joint.name, None)

    def attached_models(self, name: str) -> list[str]:
        """Return the models that joints of the world attach to a model, directly or indirectly.

        The models are in the order in which they were added.
        """
        found = {name}
        for model in self.models.values():  # Attached models are added later.
            if model.hangs_on & found:
                found.add(model.name)
        return [model for model in self.models if model in found - {name}]

    def add_velocity_motor(self, joint: str, gain: float, limit: float) -> str:
        """Add a motor that holds the velocity of a joint, and let the wheel on the joint roll.

        Args:
            joint: the name of the joint.
            gain: the torque per velocity error, in N m s/rad (N s/m).
            limit: the maximum torque in N m (N).

        Returns:
            The name of MuJoCo's actuator, whose control value is the velocity in rad/s (m/s).
        """
        actuator = self._actuator(joint, limit)
        actuator.set_to_velocity(kv=gain)
        self.let_roll(joint, min(limit / _GREATEST_JUMP, gain))
        return str(actuator.name)

    def speed_limit(self, joint: str) -> float:
        """Return the speed limit of a joint with one axis in rad/s (m/s); infinite if there is none."""
        limit = self.joints[joint].axes[0][0].limit.velocity if joint in self.joints else inf
        return limit if limit > 0.0 else inf

    def let_roll(self, joint: str, rotor: float = 0.0) -> None:
        """Let a wheel roll without slipping.

        Args:
            joint: the name of the joint.
            rotor: the inertia of the motor's rotor, in kg m2 per second of the time step.
        """
        model = joint.partition(SEPARATOR)[0]
        self._unsettled.add(model)
        rotors = self._driven.setdefault(model, {})
        rotors[joint] = max(rotor, rotors.get(joint, 0.0))

    def let_slide(self, joint: str) -> None:
        """Let a wheel slide in all directions, as if it had rollers; its motor then has no grip."""
        body = self.bodies[self.joints[joint].child]
        for geom in body.geoms:
            self._writer.grips.pop(geom.name, None)
        make_omnidirectional(body, self.step)

    def add_servo(self, joint: str) -> str:
        """Add a servo that holds the position of a joint with one axis against any load.

        Returns:
            The name of MuJoCo's constraint, whose first data value is the position relative to the initial one.
        """
        self._motors += 1
        equality = self.spec.add_equality(type=self._mujoco.mjtEq.mjEQ_JOINT, name=f"{joint}{SERVO}{self._motors}")
        equality.name1 = joint
        equality.data[:5] = 0.0
        equality.solref, equality.solimp[:2] = [_SERVO_TIME, 1.0], [0.99, 0.999]
        self.models[joint.partition(SEPARATOR)[0]].parts.append(equality)
        return str(equality.name)

    def weld(self, parent: str, child: str, pose: Transform) -> None:
        """Fix a link to another one until `unweld` is called or one of the links is removed.

        The models of the two links do not collide.

        Args:
            parent: the name of the link that holds the child.
            child: the name of the link that is held.
            pose: the pose of the child in the frame of the parent.
        """
        name = _weld_name(parent, child)
        equality = self._add_equality(self._mujoco.mjtEq.mjEQ_WELD, (parent, child))
        x, y, z, qx, qy, qz, qw = pose
        equality.name = name
        equality.data[:10] = [0.0, 0.0, 0.0, x, y, z, qw, qx, qy, qz]
        models = {model_of(parent), model_of(child)}
        if len(models) > 1:
            links = ([held.link for held in self.models[model].structure.links] for model in sorted(models))
            touching = ([link.name for link in item if link.link.collisions] for item in links)
            for number, (one, other) in enumerate(product(*touching)):
                self.spec.add_exclude(name=f"{name}{number}", bodyname1=one, bodyname2=other)

    def unweld(self, parent: str, child: str) -> None:
        """Remove the constraint and the contact exclusions that `weld` has added."""
        name = _weld_name(parent, child)
        parts = (*self.spec.equalities, *self.spec.excludes)
        for part in [part for part in parts if part.name.startswith(name)]:
            self.spec.delete(part)

    def is_welded(self, parent: str, child: str) -> bool:
        """Return whether `weld` has fixed a child link to a parent link."""
        return self.spec.equality(_weld_name(parent, child)) is not None

    def _actuator(self, joint: str, limit: float) -> Any:
        self._motors += 1
        actuator = self.spec.add_actuator(name=f"{joint}#motor{self._motors}", target=joint)
        actuator.trntype = self._mujoco.mjtTrn.mjTRN_JOINT
        actuator.forcelimited = isfinite(limit)
        if actuator.forcelimited:
            actuator.forcerange = [-limit, limit]
        self.models[joint.partition(SEPARATOR)[0]].parts.append(actuator)
        return actuator

    def keep_awake(self, link: str, never: Any) -> None:
        """Prevent the bodies that move with a link from falling asleep.

        A static link is ignored, because it never sleeps. `never` is MuJoCo's value for this policy.

        Raises:
            KeyError: there is no such link.
        """
        body, root = self.bodies[link], None
        while body != self.spec.worldbody:
            root = body if len(body.joints) else root
            body = body.parent
        if root is not None:
            root.sleep = never

    def settle(self) -> None:
        """Set the surfaces of wheels and casters of models with motors, after all motors were added."""
        for name in self._unsettled & self.models.keys():
            driven = {self.joints[joint].child: joint for joint in self._driven[name]}
            sides = Counter(self.joints[joint].parent for joint in driven.values())
            greatest = SKIDDING_GRIP if max(sides.values(), default=0) > _WHEELS_THAT_ROLL else inf
            for held in self.models[name].structure.links:
                body = self.bodies[held.link.name]
                if held.link.name in driven:
                    joint = self.spec.joint(driven[held.link.name])
                    joint.armature = self._driven[name][joint.name] * self.step
                    make_rolling(self.spec, body, joint, self.step, self._writer.grips, greatest)
                else:
                    make_sliding(body, self._writer.unspecified)
        self._unsettled.clear()

    def _add_link(self, held: HeldLink, poses: dict[str, Transform]) -> Any:
        placed = held.link
        link, joint = placed.link, None if placed.static else held.joint
        parent, above = self.spec.worldbody, IDENTITY
        if joint is not None and joint.parent != WORLD:
            parent, above = self.bodies[joint.parent], poses[joint.parent]
        driven = joint is None and link.kinematic and not placed.static  # Forces do not move such a body.
        body = self.bodies[placed.name] = parent.add_body(name=placed.name, mocap=driven)
        set_pose(body, compose(invert(above), placed.pose))
        fixed = placed.static or driven
        if not fixed:
            self._writer.set_mass(body, link, placed.frames)
            body.gravcomp = 0.0 if link.gravity else 1.0
            if joint is None:
                body.add_freejoint().name = f"{placed.name}#free"
            else:
                self._writer.add_joint(body, joint, placed.pose)
                self.joints[joint.name] = joint
        else:
            body.explicitinertial, body.ipos = True, [0.0, 0.0, 0.0]  # for the rays of MuJoCo 3
        self._writer.add_visuals(body, link, placed.frames, fixed=fixed)
        self._writer.add_collisions(body, link, placed.frames, fixed=fixed)
        return body

    def _moving(self, models: Iterable[str]) -> list[PlacedJoint]:
        """Return the joints of the given models that are simulated as movable."""
        held = (link for name in models for link in self.models[name].structure.links)
        return [link.joint for link in held if link.joint is not None and link.joint.name in self.joints]

    def _mimic_constraints(self, joint: PlacedJoint | None) -> Iterator[Any]:
        """Yield equality constraints for the mimic axes of a joint."""
        if joint is None or joint.name not in self.joints:
            return
        for number, (axis, _) in enumerate(joint.axes):
            if axis.mimic is None:
                continue
            owner, separator, _ = joint.name.rpartition(SEPARATOR)
            leader = f"{owner}{separator}{axis.mimic.joint}{SECOND_AXIS if axis.mimic.axis == 'axis2' else ''}"
            if leader.removesuffix(SECOND_AXIS) not in self.joints:
                continue  # `check` reports this axis.
            equality = self.spec.add_equality(type=self._mujoco.mjtEq.mjEQ_JOINT)
            equality.name1, equality.name2 = f"{joint.name}{SECOND_AXIS if number else ''}", leader
            offset = axis.mimic.offset - axis.mimic.multiplier * axis.mimic.reference
            equality.data[:5] = [offset, axis.mimic.multiplier, 0.0, 0.0, 0.0]
            yield equality

    def _closed(self, joint: PlacedJoint, poses: dict[str, Transform]) -> Iterator[Any]:
        """Yield the equality constraints of a joint that closes a loop.

        A joint of a type that cannot close a loop is reported.
        """
        kinds, ends = self._mujoco.mjtEq, (joint.child, joint.parent)
        points = hinge_anchors(joint, _ANCHORS_APART) if joint.axes else [joint.pose[:3]]
        if joint.joint.type == "fixed":
            yield self._add_equality(kinds.mjEQ_WELD, ends)
        elif joint.joint.type in ("revolute", "hinge", "continuous", "ball"):
            into_child = IDENTITY if joint.child == WORLD else invert(poses[joint.child])
            for point in points[: 1 if joint.joint.type == "ball" else 2]:
                equality = self._add_equality(kinds.mjEQ_CONNECT, ends)
                moved = rotate(into_child[3:], point)
                equality.data[:3] = [a + b for a, b in zip(moved, into_child[:3], strict=True)]
                yield equality
        elif joint.joint.type != "gearbox":
            message = phrase(
                "joint '{name}' is left out: a joint of type {kind} cannot close a loop",
                name=joint.name,
                kind=joint.joint.type,
            )
            self._warn("SIM118", message, joint.joint.element)

    def _add_equality(self, kind: Any, ends: tuple[str, str]) -> Any:
        equality = self.spec.add_equality(type=kind, objtype=self._mujoco.mjtObj.mjOBJ_BODY)
        equality.solref = [_LOOP_STEPS * self.step, 1.0]
        equality.name1, equality.name2 = ends[0], "" if ends[1] == WORLD else ends[1]
        return equality

    def _strangers(self, structure: Structure) -> Iterator[Any]:
        """Yield contact exclusions for pairs of links of a model, unless ``<self_collide>`` is set."""
        touching = [held.link for held in structure.links if held.link.link.collisions and not held.link.static]
        for one, other in combinations(touching, 2):
            if not (_collides(one.link.self_collide, one.model) and _collides(other.link.self_collide, other.model)):
                yield self.spec.add_exclude(bodyname1=one.name, bodyname2=other.name)

    def _neighbour_exclusions(self, connected: Connected) -> Iterator[Any]:
        """Yield contact exclusions for pairs of links that joints of the world connect."""
        own = {held.link.name for held in connected.structure.links}
        hung = (held.joint for held in connected.structure.links if held.joint is not None)
        joints = (*(joint for joint in hung if joint.parent not in own), *connected.loops)
        for one, other in {tuple(sorted((joint.parent, joint.child))): None for joint in joints}:
            if WORLD not in (one, other):
                yield self.spec.add_exclude(bodyname1=one, bodyname2=other)


def _weld_name(parent: str, child: str) -> str:
    return f"{parent}#{child}#"


def _collides(setting: bool | None, model: Model) -> bool:
    return model.self_collide if setting is None else setting
