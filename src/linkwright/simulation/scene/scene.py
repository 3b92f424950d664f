"""The MuJoCo specification of a world: bodies for links, joints and geoms for shapes."""

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
from linkwright.geometry.single import IDENTITY, Transform, Vector3, compose, invert, rotate
from linkwright.sdf.frames import FrameError, Frames
from linkwright.sdf.models import Model
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.sdf.worlds import World, find_gravity, find_physics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.scene.bodies import SECOND_AXIS_SUFFIX, BodyWriter, compute_hinge_anchors
from linkwright.simulation.scene.breaking import is_breakable, is_rigid, prepare_to_break
from linkwright.simulation.scene.connections import ConnectedModel, find_connections, get_model_name
from linkwright.simulation.scene.couplings import add_gearbox_coupling, add_screw_coupling
from linkwright.simulation.scene.figures import add_figure, create_figures
from linkwright.simulation.scene.meshes import MeshLibrary, get_modification_time_ns
from linkwright.simulation.scene.shapes import set_pose
from linkwright.simulation.scene.structure import KinematicTrees, PlacedJoint, TreeLink, build_kinematic_trees
from linkwright.simulation.scene.wheels import SKIDDING_GRIP, make_omnidirectional, make_rolling, make_sliding
from linkwright.xmltree import Element

_DEFAULT_STEP = 0.001
"""The default time step in s."""
_ANCHOR_DISTANCE = 0.1
"""The distance in m between the two points that hold the axis of a loop-closing hinge."""
_LOOP_STEPS = 4.0
"""The time constant of constraints that close a loop, in time steps."""
_MAX_ROLLING_WHEELS = 2
"""The maximum number of driven wheels on a link that can roll. With more, some wheels slip in every turn."""
_MAX_ROTOR = 20.0
"""The maximum inertia of a motor's rotor in kg m2, divided by the time step in s."""
_MAX_SPEED_CHANGE = 1.0
"""The maximum change of a free wheel's speed in rad/s that a motor causes within a step.

The inertia of the wheel alone is so low that 5 N m change its speed by 14 rad/s in 1 ms. The speed would overshoot the
target in alternate directions, and the wheel would slip and leave the ground. The rotor of a real geared motor has
more effective inertia than the wheel.
"""
SERVO_SUFFIX = "#servo"
"""The separator between the joint's name and a number in the name of a servo constraint."""
SERVO_TIME_CONSTANT = 0.02
"""The time constant of a servo in s."""


@dataclass(slots=True)
class SceneModel:
    """A model of a scene.

    Attributes:
        name: the name of the model in the world.
        model: the parsed model.
        pose: the initial pose of the model's frame in the world.
        structure: the links and joints of the model.
        parts: the elements of the specification to delete with the model, in the order in which they were added: root
            bodies, constraints, contact exclusions and actuators.
        files: the modification times of the model's mesh files when the model was added, in ns since the epoch.
        attached_to: the names of the earlier models to which joints of the world connect the model.
    """

    name: str
    model: Model
    pose: Transform
    structure: KinematicTrees
    parts: list[Any] = field(default_factory=list)
    files: dict[Path, int] = field(default_factory=dict)
    attached_to: frozenset[str] = frozenset()

    @property
    def is_outdated(self) -> bool:
        """Whether a mesh file has changed since the model was added."""
        return any(
            get_modification_time_ns(path) != modification_time_ns for path, modification_time_ns in self.files.items()
        )


class Scene:
    """The MuJoCo specification of a world.

    Models can be added and removed.

    Bodies and joints have their names in the world, such as ``robot::arm::tip``. The second axis of a joint has the
    suffix ``#2``, and the free joint of a body has the name of the body with the suffix ``#free``.

    Args:
        world: the world, with its includes resolved and its saved state applied (`linkwright.sdf.saved`).
        meshes: the library of meshes.
        step: the time step in s; None for the time step of the world.
        exclusion_reasons: the reasons for which models are left out, by model name.

    Attributes:
        spec: the specification.
        step: the time step in s.
        models: the models by name, in the order in which they were added.
        joints: the movable joints of models, by name.
        bodies: the bodies of the specification, by link name.
        figures: actors and roads, which are visible; only actors that collide have contacts.
    """

    def __init__(
        self,
        world: World,
        meshes: MeshLibrary,
        step: float | None = None,
        exclusion_reasons: Mapping[str, Phrase] = MappingProxyType({}),
    ) -> None:
        self._findings: list[Diagnostic] = []
        self.step = step or self.choose_step(world)
        self.models: dict[str, SceneModel] = {}
        self.joints: dict[str, PlacedJoint] = {}
        self.bodies: dict[str, Any] = {}
        self._mujoco = mujoco = load_mujoco()
        self.spec = mujoco.MjSpec()
        meshes.spec = self.spec
        self._writer = BodyWriter(meshes)
        self._meshes = meshes
        self._actuator_count = 0
        self._rotor_inertias: dict[str, dict[str, float]] = {}  # by model: the driven joints and their rotor inertias
        self._unsettled_models: set[str] = set()
        self.spec.modelname = world.name or WORLD
        self.spec.compiler.degree = False
        self.spec.compiler.balanceinertia = True
        self.spec.compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
        self._set_options(world)
        frames = Frames(world)
        self._connections = find_connections(world)
        for model in self._sort_models(world.models):
            if model.name in exclusion_reasons:
                message = phrase(
                    "model '{name}' is left out: {reason}", name=model.name, reason=exclusion_reasons[model.name]
                )
                self._warn("SIM117", message, model.element)
            elif model.name not in self.models:  # `check` reports duplicate names
                self._add_or_report(model, frames)
        self.figures = create_figures(world, meshes)
        for figure in self.figures:
            add_figure(figure, self.spec, self._writer)

    def _sort_models(self, models: Iterable[Model]) -> list[Model]:
        """Return models in an order in which each follows the models to which it is attached."""
        models = list(models)
        positions = {
            name: index for index, name in enumerate(self.sort_by_attachment([model.name for model in models]))
        }
        return sorted(models, key=lambda model: positions[model.name])

    def sort_by_attachment(self, names: Sequence[str]) -> list[str]:
        """Return model names in an order in which each follows the models it is attached to."""
        return self._connections.sort_by_attachment(names)

    def choose_step(self, world: World) -> float:
        """Return the time step of a world in s.

        If the time step is 0, report a finding and return the default.
        """
        physics = find_physics(world)
        if physics.max_step_size:
            return physics.max_step_size
        message = phrase("the time step is 0 s; the world is simulated in steps of {step} s", step=_DEFAULT_STEP)
        self._warn("SIM106", message, physics.element)
        return _DEFAULT_STEP

    def _add_or_report(self, model: Model, frames: Frames) -> None:
        try:
            self.add(model, model.name, frames.pose(model.name))
        except FrameError as error:
            values = {"name": model.name, "frame": error.name}
            message = phrase("model '{name}' is left out: the pose of its frame '{frame}' is not defined", **values)
            self._warn("SIM116", message, model.element)

    def _warn(self, code: str, message: Phrase, element: Element | None) -> None:
        span = element.span() if element is not None else None
        source = element.source if element is not None else None
        self._findings.append(Diagnostic(code, message, severity=Severity.WARNING, span=span, source=source))

    def set_physics(self, world: World, step: float) -> None:
        """Set the time step in s, and adopt gravity and joints between models of another world.

        The models do not change.
        """
        self._connections = find_connections(world)
        self.spec.option.gravity = list(find_gravity(world))
        if step == self.step:
            return
        self.step = self.spec.option.timestep = step
        self._unsettled_models |= self._rotor_inertias.keys()
        loop_constraints = (self._mujoco.mjtEq.mjEQ_WELD, self._mujoco.mjtEq.mjEQ_CONNECT)
        for equality in self.spec.equalities:
            if equality.type in loop_constraints:
                equality.solref = [_LOOP_STEPS * step, 1.0]

    def _set_options(self, world: World) -> None:
        """Set MuJoCo's options to values from experiments with wheels, casters and resting bodies.

        See decision 0042.
        """
        option = self.spec.option
        option.timestep = self.step
        option.gravity = list(find_gravity(world))
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
            FrameError: the pose of a link is not defined.
            LinkwrightError: SIM102, there is already a model with this name.
        """
        if name in self.models:
            raise LinkwrightError(Diagnostic("SIM102", phrase("a model '{name}' already exists", name=name)))
        connected = self._connections.connect(build_kinematic_trees(model, name, pose), name, pose, self.models)
        structure = connected.structure
        scene_model = self.models[name] = SceneModel(name, model, pose, structure, attached_to=connected.attached_to)
        poses = {
            tree_link.link.name: tree_link.link.pose
            for model_name in (name, *connected.attached_to)
            for tree_link in self.models[model_name].structure.links
        }
        own_links = {tree_link.link.name for tree_link in structure.links}
        self._meshes.used.clear()
        for tree_link in structure.links:
            body = self._add_link(tree_link, poses)
            if body.parent == self.spec.worldbody or body.parent.name not in own_links:
                scene_model.parts.append(body)
        scene_model.files = dict(self._meshes.used)
        for tree_link in structure.links:
            scene_model.parts += self._add_mimic_constraints(tree_link.joint)
            if tree_link.joint is not None and tree_link.joint.name in self.joints:
                scene_model.parts += add_screw_coupling(self.spec, tree_link.joint)
        for joint in (*structure.loops, *connected.loops):
            constraints = [*self._add_loop_constraints(joint, poses)]
            scene_model.parts += constraints
            if is_breakable(joint.joint):
                scene_model.parts += prepare_to_break(self.spec, joint.name, constraints)
            if joint.joint.type == "gearbox":
                scene_model.parts += add_gearbox_coupling(
                    self.spec, joint, self._find_movable_joints((name, *connected.attached_to))
                )
        scene_model.parts += self._add_self_collision_exclusions(structure)
        scene_model.parts += self._add_neighbor_exclusions(connected)
        return scene_model

    def set_initial_pose(self, name: str, pose: Transform) -> None:
        """Set the initial pose of a model.

        Args:
            name: the name of the model.
            pose: the pose of the model's frame in the world.

        Raises:
            KeyError: there is no model with this name.
            FrameError: the pose of a link is not defined.
        """
        scene_model = self.models[name]
        scene_model.structure = build_kinematic_trees(scene_model.model, name, pose)
        scene_model.pose = pose
        for tree_link in scene_model.structure.links:
            body = self.bodies[tree_link.link.name]
            if body.parent == self.spec.worldbody:
                set_pose(body, tree_link.link.pose)
            if tree_link.joint is not None and tree_link.joint.name in self.joints:
                self.joints[tree_link.joint.name] = tree_link.joint

    def remove(self, name: str) -> None:
        """Remove a model.

        Raises:
            KeyError: there is no model with this name.
            ValueError: another model is attached to this model.
        """
        attached = self.find_attached_models(name)
        if attached:
            raise ValueError(f"{', '.join(attached)} must be removed before {name}")
        model = self.models.pop(name)
        self._rotor_inertias.pop(name, None)
        for part in reversed(model.parts):
            self.spec.delete(part)
        for tree_link in model.structure.links:
            del self.bodies[tree_link.link.name]
            if tree_link.joint is not None:
                self.joints.pop(tree_link.joint.name, None)

    def find_attached_models(self, name: str) -> list[str]:
        """Return the models that joints of the world attach to a model, directly or indirectly.

        The result is in the order in which the models were added.
        """
        attached = {name}
        for model in self.models.values():  # Attached models are added later.
            if model.attached_to & attached:
                attached.add(model.name)
        return [model for model in self.models if model in attached - {name}]

    def add_velocity_motor(self, joint: str, gain: float, limit: float) -> str:
        """Add a motor that controls the velocity of a joint.

        The wheel on the joint then rolls without slipping.

        Args:
            joint: the name of the joint.
            gain: the torque per velocity error, in N m s/rad (N s/m).
            limit: the maximum torque in N m (N); infinite for no limit.

        Returns:
            The name of MuJoCo's actuator, whose control value is the velocity in rad/s (m/s).
        """
        actuator = self._add_actuator(joint, limit)
        actuator.set_to_velocity(kv=gain)
        self.enable_rolling(joint, min(limit / _MAX_SPEED_CHANGE, gain, _MAX_ROTOR))
        return str(actuator.name)

    def speed_limit(self, joint: str) -> float:
        """Return the speed limit of a joint's first axis in rad/s (m/s), or infinity for none."""
        limit = self.joints[joint].axes[0][0].limit.velocity if joint in self.joints else inf
        return limit if limit > 0.0 else inf

    def enable_rolling(self, joint: str, rotor: float = 0.0) -> None:
        """Make the wheel on a joint roll without slipping, after `set_wheel_surfaces` is called.

        Args:
            joint: the name of the joint.
            rotor: the inertia of the motor's rotor in kg m2, divided by the time step in s.
        """
        model = joint.partition(SEPARATOR)[0]
        self._unsettled_models.add(model)
        rotors = self._rotor_inertias.setdefault(model, {})
        rotors[joint] = max(rotor, rotors.get(joint, 0.0))

    def enable_sliding(self, joint: str) -> None:
        """Make the wheel on a joint slide in all directions, as if it had rollers.

        The motor of the wheel then has no grip.
        """
        body = self.bodies[self.joints[joint].child]
        for geom in body.geoms:
            self._writer.grip_by_geom.pop(geom.name, None)
        make_omnidirectional(body, self.step)

    def add_servo(self, joint: str) -> str:
        """Add a servo that holds the position of a joint with one axis against any load.

        Returns:
            The name of MuJoCo's constraint; its first data value is the position relative to the initial position.
        """
        self._actuator_count += 1
        equality = self.spec.add_equality(
            type=self._mujoco.mjtEq.mjEQ_JOINT, name=f"{joint}{SERVO_SUFFIX}{self._actuator_count}"
        )
        equality.name1 = joint
        equality.data[:5] = 0.0
        equality.solref, equality.solimp[:2] = [SERVO_TIME_CONSTANT, 1.0], [0.99, 0.999]
        self.models[joint.partition(SEPARATOR)[0]].parts.append(equality)
        return str(equality.name)

    def weld(self, parent: str, child: str, pose: Transform, *, is_colliding: bool = False) -> None:
        """Fix a link to another link until `unweld` is called or one of the links is removed.

        Args:
            parent: the name of the parent link.
            child: the name of the child link.
            pose: the pose of the child link in the frame of the parent link.
            is_colliding: whether the models of the two links collide with each other meanwhile.
        """
        name = _get_weld_name(parent, child)
        equality = self._add_equality(self._mujoco.mjtEq.mjEQ_WELD, (parent, child))
        x, y, z, qx, qy, qz, qw = pose
        equality.name = name
        equality.data[:10] = [0.0, 0.0, 0.0, x, y, z, qw, qx, qy, qz]
        models = {get_model_name(parent), get_model_name(child)}
        if len(models) > 1 and not is_colliding:
            links_by_model = (
                [tree_link.link for tree_link in self.models[model].structure.links] for model in sorted(models)
            )
            colliding_links = (
                [link.name for link in model_links if link.link.collisions] for model_links in links_by_model
            )
            for index, (first, second) in enumerate(product(*colliding_links)):
                self.spec.add_exclude(name=f"{name}{index}", bodyname1=first, bodyname2=second)

    def unweld(self, parent: str, child: str) -> None:
        """Remove the constraint and the contact exclusions that `weld` added for these links."""
        name = _get_weld_name(parent, child)
        parts = (*self.spec.equalities, *self.spec.excludes)
        for part in [part for part in parts if part.name.startswith(name)]:
            self.spec.delete(part)

    def is_welded(self, parent: str, child: str) -> bool:
        """Return whether `weld` has fixed a child link to a parent link."""
        return self.spec.equality(_get_weld_name(parent, child)) is not None

    def _add_actuator(self, joint: str, limit: float) -> Any:
        self._actuator_count += 1
        actuator = self.spec.add_actuator(name=f"{joint}#motor{self._actuator_count}", target=joint)
        actuator.trntype = self._mujoco.mjtTrn.mjTRN_JOINT
        actuator.forcelimited = isfinite(limit)
        if actuator.forcelimited:
            actuator.forcerange = [-limit, limit]
        self.models[joint.partition(SEPARATOR)[0]].parts.append(actuator)
        return actuator

    def keep_awake(self, link: str, sleep_policy: Any) -> None:
        """Prevent the bodies that move with a link from falling asleep.

        A static link is ignored, because it never sleeps. `sleep_policy` is MuJoCo's value for bodies that stay awake.

        Raises:
            KeyError: there is no such link.
        """
        body, root = self.bodies[link], None
        while body != self.spec.worldbody:
            root = body if len(body.joints) else root
            body = body.parent
        if root is not None:
            root.sleep = sleep_policy

    def set_wheel_surfaces(self) -> None:
        """Set the surfaces of the wheels and casters of models with new motors.

        Call this after adding motors.
        """
        for name in self._unsettled_models & self.models.keys():
            wheel_joints = {self.joints[joint].child: joint for joint in self._rotor_inertias[name]}
            wheel_counts = Counter(self.joints[joint].parent for joint in wheel_joints.values())
            max_grip = SKIDDING_GRIP if max(wheel_counts.values(), default=0) > _MAX_ROLLING_WHEELS else inf
            for tree_link in self.models[name].structure.links:
                body = self.bodies[tree_link.link.name]
                if tree_link.link.name in wheel_joints:
                    joint = self.spec.joint(wheel_joints[tree_link.link.name])
                    joint.armature = self._rotor_inertias[name][joint.name] * self.step
                    make_rolling(self.spec, body, joint, self.step, self._writer.grip_by_geom, max_grip)
                else:
                    make_sliding(body, self._writer.geoms_without_friction)
        self._unsettled_models.clear()

    def _add_link(self, tree_link: TreeLink, poses: dict[str, Transform]) -> Any:
        placed_link = tree_link.link
        link, joint = placed_link.link, None if placed_link.static else tree_link.joint
        parent, parent_pose = self.spec.worldbody, IDENTITY
        if joint is not None and joint.parent != WORLD:
            parent, parent_pose = self.bodies[joint.parent], poses[joint.parent]
        is_kinematic = joint is None and link.kinematic and not placed_link.static  # Forces do not move such a body.
        body = self.bodies[placed_link.name] = parent.add_body(name=placed_link.name, mocap=is_kinematic)
        set_pose(body, compose(invert(parent_pose), placed_link.pose))
        is_fixed = placed_link.static or is_kinematic
        if not is_fixed:
            self._writer.set_mass(body, link, placed_link.frames)
            body.gravcomp = 0.0 if link.gravity else 1.0
            if joint is None:
                body.add_freejoint().name = f"{placed_link.name}#free"
            else:
                self._writer.add_joint(body, joint, placed_link.pose)
                self.joints[joint.name] = joint
        else:
            body.explicitinertial, body.ipos = True, [0.0, 0.0, 0.0]  # otherwise rays of MuJoCo 3 miss the body
        self._writer.add_visuals(body, link, placed_link.frames, fixed=is_fixed)
        rolls = joint is not None and joint.is_continuous
        self._writer.add_collisions(body, link, placed_link.frames, fixed=is_fixed, rolls=rolls)
        return body

    def _find_movable_joints(self, models: Iterable[str]) -> list[PlacedJoint]:
        """Return the movable joints of some models."""
        tree_links = (link for name in models for link in self.models[name].structure.links)
        return [link.joint for link in tree_links if link.joint is not None and link.joint.name in self.joints]

    def _add_mimic_constraints(self, joint: PlacedJoint | None) -> Iterator[Any]:
        """Add and yield an equality constraint for each mimic axis of a joint."""
        if joint is None or joint.name not in self.joints:
            return
        for index, (axis, _) in enumerate(joint.axes):
            if axis.mimic is None:
                continue
            owner, separator, _ = joint.name.rpartition(SEPARATOR)
            leader = f"{owner}{separator}{axis.mimic.joint}{SECOND_AXIS_SUFFIX if axis.mimic.axis == 'axis2' else ''}"
            if leader.removesuffix(SECOND_AXIS_SUFFIX) not in self.joints:
                continue  # `check` reports this axis.
            equality = self.spec.add_equality(type=self._mujoco.mjtEq.mjEQ_JOINT)
            equality.name1, equality.name2 = f"{joint.name}{SECOND_AXIS_SUFFIX if index else ''}", leader
            offset = axis.mimic.offset - axis.mimic.multiplier * axis.mimic.reference
            equality.data[:5] = [offset, axis.mimic.multiplier, 0.0, 0.0, 0.0]
            yield equality

    def _add_loop_constraints(self, joint: PlacedJoint, poses: dict[str, Transform]) -> Iterator[Any]:
        """Add and yield the equality constraints of a joint that closes a loop.

        A joint whose type cannot close a loop is reported.
        """
        kinds, link_names = self._mujoco.mjtEq, (joint.child, joint.parent)
        points = compute_hinge_anchors(joint, _ANCHOR_DISTANCE) if joint.axes else [joint.pose[:3]]
        if joint.joint.type == "fixed" or (is_breakable(joint.joint) and is_rigid(joint.joint)):
            equality = self._add_equality(kinds.mjEQ_WELD, link_names)
            equality.data[:3] = _locate(joint.pose[:3], IDENTITY if joint.parent == WORLD else poses[joint.parent])
            yield equality
        elif joint.joint.type in ("revolute", "hinge", "continuous", "ball"):
            child_pose = IDENTITY if joint.child == WORLD else poses[joint.child]
            for point in points[: 1 if joint.joint.type == "ball" else 2]:
                equality = self._add_equality(kinds.mjEQ_CONNECT, link_names)
                equality.data[:3] = _locate(point, child_pose)
                yield equality
        elif joint.joint.type != "gearbox":
            message = phrase(
                "joint '{name}' is left out: a joint of type {kind} cannot close a loop",
                name=joint.name,
                kind=joint.joint.type,
            )
            self._warn("SIM118", message, joint.joint.element)

    def _add_equality(self, kind: Any, link_names: tuple[str, str]) -> Any:
        equality = self.spec.add_equality(type=kind, objtype=self._mujoco.mjtObj.mjOBJ_BODY)
        equality.solref = [_LOOP_STEPS * self.step, 1.0]
        equality.name1, equality.name2 = link_names[0], "" if link_names[1] == WORLD else link_names[1]
        return equality

    def _add_self_collision_exclusions(self, structure: KinematicTrees) -> Iterator[Any]:
        """Add and yield contact exclusions for links of a model without ``<self_collide>``.

        A pair of links may collide only if both have ``<self_collide>``.
        """
        colliding_links = [
            tree_link.link
            for tree_link in structure.links
            if tree_link.link.link.collisions and not tree_link.link.static
        ]
        for first, second in combinations(colliding_links, 2):
            if not (
                _self_collides(first.link.self_collide, first.model)
                and _self_collides(second.link.self_collide, second.model)
            ):
                yield self.spec.add_exclude(bodyname1=first.name, bodyname2=second.name)

    def _add_neighbor_exclusions(self, connected: ConnectedModel) -> Iterator[Any]:
        """Add and yield contact exclusions for pairs of links that joints of the world connect."""
        own_links = {tree_link.link.name for tree_link in connected.structure.links}
        parent_joints = (tree_link.joint for tree_link in connected.structure.links if tree_link.joint is not None)
        joints = (*(joint for joint in parent_joints if joint.parent not in own_links), *connected.loops)
        for first, second in {tuple(sorted((joint.parent, joint.child))): None for joint in joints}:
            if WORLD not in (first, second):
                yield self.spec.add_exclude(bodyname1=first, bodyname2=second)


def _locate(point: Vector3, pose: Transform) -> list[float]:
    """Return a point of the world in the frame at a pose."""
    to_frame = invert(pose)
    return [a + b for a, b in zip(rotate(to_frame[3:], point), to_frame[:3], strict=True)]


def _get_weld_name(parent: str, child: str) -> str:
    return f"{parent}#{child}#"


def _self_collides(setting: bool | None, model: Model) -> bool:
    return model.self_collide if setting is None else setting
