"""A simulated world: its time, its models and their states."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from math import inf, isfinite
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import IDENTITY, Transform, Vector3, compose, cross, invert, quaternion_inverse, rotate
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.models import Model
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.saved import with_saved_state
from linkwright.sdf.worlds import World, find_gravity, find_physics
from linkwright.simulation.actuators import Motor, Servo
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.restitution import Stepper
from linkwright.simulation.scene.bodies import COLLISION_GROUP
from linkwright.simulation.scene.compiling import compile_scene, count_links, find_rejected_models, step_to_nanoseconds
from linkwright.simulation.scene.figures import ACTOR_PERIOD_NS, move_actors, set_kinematic_poses
from linkwright.simulation.scene.meshes import MeshLibrary
from linkwright.simulation.scene.scene import Scene
from linkwright.simulation.schedule import Schedule, Task
from linkwright.simulation.sleep import Sleep
from linkwright.simulation.solver_selection import SolverSelector

_MAX_VALUE = 1e10
"""A position or velocity of at least this value, in m, rad, m/s or rad/s, counts as unstable, as in MuJoCo."""
_SAFE_SQUARED_SUM = _MAX_VALUE * _MAX_VALUE
"""If the sum of squares is below this bound, no single value exceeds `_MAX_VALUE`."""


class UnstableError(LinkwrightError):
    """The error SIM120: a position or velocity is not finite or is out of bounds."""


class Simulation:
    """A simulated world.

    The class never waits and does not use real time: `advance` computes as fast as it can, and the same calls give
    exactly the same results. Only one thread at a time may use a simulation.

    Args:
        world: the world, with its includes resolved.
        finder: the finder of mesh files.
        step: the time step in s; None for the time step of the world.

    Attributes:
        world: the parsed world, with its includes resolved and its saved state applied.
        finder: the finder of mesh files.
        scene: the MuJoCo specification of the world, with its models.
        model, data: MuJoCo's current model and data; both are replaced when models are added or removed.
        revision: the number of times that `model` and `data` were rebuilt.
        time: the simulated time since the start, in nanoseconds.
        step: the time step in nanoseconds.
        wind: the velocity of the air in m/s, in the axes of the world.
        schedule: calls functions at simulated times.
    """

    def __init__(self, world: World, finder: ResourceFinder, *, step: float | None = None) -> None:
        self._mujoco = load_mujoco()
        self.world = with_saved_state(world)
        count_links(self.world.models)
        self.wind = self.world.wind
        self.finder = finder
        self._requested_step = step
        self._meshes = MeshLibrary(finder)
        self.scene = Scene(self.world, self._meshes, step)
        self.revision = 0
        try:
            compiled = compile_scene(self.scene)
        except LinkwrightError:
            rejected = find_rejected_models(self.world, finder)
            if not rejected:
                raise
            self._meshes = MeshLibrary(finder)
            self.scene = Scene(self.world, self._meshes, step, rejected)
            compiled = compile_scene(self.scene)
        self.step = step_to_nanoseconds(self.scene.step, self.world)
        self.time = 0
        self.schedule = Schedule()
        self._sleep = Sleep(self.schedule)
        self._solving = SolverSelector(self.schedule, self._sleep)
        self._bodies: dict[str, int] = {}
        self._joints: dict[str, tuple[int, int]] = {}
        self._pushes: dict[str, dict[Hashable, Array]] = {}
        self._new_servos: list[Servo] = []  # servos that are not in MuJoCo's model yet
        self._is_changed = False  # whether the scene differs from MuJoCo's model
        self._is_reshaped = False  # whether the scene's bodies or joints differ from the model
        self._is_current = False
        self._set_model(*compiled)
        if any(figure.walks_into_bodies for figure in self.scene.figures):
            self.schedule.add(
                ACTOR_PERIOD_NS, lambda: move_actors(self.scene.figures, self.model, self.data, self.seconds), 0
            )

    @property
    def seconds(self) -> float:
        """The simulated seconds since the start."""
        return self.time / NANOSECONDS_PER_SECOND

    def spawn(self, model: Model, name: str, pose: Transform = IDENTITY) -> None:
        """Add a model to the world, and keep the state of the other models.

        Args:
            model: the model, with its includes resolved.
            name: the name of the model, which must be unique.
            pose: the pose of the model's frame in the world.

        Raises:
            LinkwrightError: SIM102, there is already a model with this name.
            FrameError: a link cannot be placed.
        """
        self.scene.add(model, name, pose)
        self.mark_changed()

    def delete(self, name: str) -> None:
        """Remove a model from the world.

        Raises:
            KeyError: there is no model with this name.
        """
        for link in self.scene.models[name].structure.links:
            self._pushes.pop(link.link.name, None)
        self.scene.remove(name)
        self._new_servos = [servo for servo in self._new_servos if servo.model != name]
        self.mark_changed()

    def set_world(self, world: World, finder: ResourceFinder) -> None:
        """Adopt everything except the models from another world.

        This includes gravity, time step, lights and the position on earth.

        Args:
            world: the other world, with its includes resolved.
            finder: the finder of the other world's meshes.
        """
        old_world, self.world, self.finder = self.world, with_saved_state(world), finder
        self.wind = self.world.wind
        self._meshes.set_finder(finder)
        self.scene.set_physics(self.world, self._requested_step or self.scene.choose_step(self.world))
        self.step = round(self.scene.step * NANOSECONDS_PER_SECOND)
        if _get_compiled_properties(old_world) != _get_compiled_properties(self.world):
            self.mark_changed()

    def create_separate_simulation(self, world: World, finder: ResourceFinder) -> Simulation:
        """Return a separate simulation of another world, with the settings of this one."""
        return Simulation(world, finder, step=self._requested_step)

    def set_initial_poses(self, poses: Mapping[str, Transform]) -> None:
        """Set the initial poses of models, and move free models there.

        The velocities of free models become 0. Joint positions are kept.

        Args:
            poses: the pose of the frame of each model in the world, by the names of the models.

        Raises:
            KeyError: there is no model with such a name.
            FrameError: a link cannot be placed.
        """
        for name, pose in poses.items():
            self.scene.set_initial_pose(name, pose)
            self.mark_changed()
        self.refresh()
        for name in poses:
            for link in self.free_links(name):
                joint = self.model.joint(f"{link}#free")
                position_index, velocity_index = int(joint.qposadr[0]), int(joint.dofadr[0])
                self.data.qpos[position_index : position_index + 7] = self.model.qpos0[
                    position_index : position_index + 7
                ]
                self.data.qvel[velocity_index : velocity_index + 6] = 0.0
                self._handle_jump(self.model.jnt_bodyid[joint.id])
        self._is_current = False

    def mark_moved(self) -> None:
        """Record that positions or velocities in `data` were set.

        Dependent values are then updated before their next use.
        """
        self._is_current = False

    def _handle_jump(self, body: Any) -> None:
        """Wake the tree of a body that was moved, and limit the speed at which overlaps separate."""
        self._stepper.expect_overlaps()
        self._sleep.wake_tree(int(self.model.body_treeid[body]))
        self._is_current = False

    def mark_changed(self) -> None:
        """Record that the specification of `scene` was changed, so that it is compiled again."""
        self._is_changed = self._is_reshaped = True

    def free_links(self, name: str) -> list[str]:
        """Return the links of a model that move freely, without a joint to a parent.

        Raises:
            KeyError: there is no such model.
        """
        self.refresh()
        links = [scene_link.link.name for scene_link in self.scene.models[name].structure.links]
        return [link for link in links if self._is_free(link)]

    def _is_free(self, link: str) -> bool:
        body = self.model.body(link)
        return body.jntnum[0] == 1 and bool(self.model.jnt_type[body.jntadr[0]] == self._mujoco.mjtJoint.mjJNT_FREE)

    def add_velocity_motor(self, joint: str, gain: float, limit: float) -> Motor:
        """Add and return a motor that holds the velocity of a joint.

        The arguments are those of `Scene.add_velocity_motor`.
        """
        name = self.scene.add_velocity_motor(joint, gain, limit)
        self._is_changed = True
        return Motor(self, name)

    def enable_rolling(self, joint: str) -> None:
        """Let a wheel roll without slipping, as driven wheels do."""
        self.scene.enable_rolling(joint)
        self._is_changed = True

    def enable_sliding(self, joint: str) -> None:
        """Let a wheel slide in all directions, as if it had rollers.

        The motor of the wheel then has no grip.
        """
        self.scene.enable_sliding(joint)
        self._is_changed = True

    def add_servo(self, joint: str, speed: float = inf) -> Servo:
        """Add and return a servo that holds the position of a joint with one axis.

        Args:
            joint: the name of the joint.
            speed: the maximum speed in rad/s (or m/s), limited to the joint's speed limit. If both are infinite, the
                servo moves at 2 rad/s (or m/s).
        """
        servo = Servo(self, joint, self.scene.add_servo(joint), speed)
        self._new_servos.append(servo)
        self._is_changed = True
        return servo

    def keep_awake(self, link: str) -> None:
        """Keep the bodies that move with a link awake.

        Sleeping bodies have no forces to measure.

        Raises:
            KeyError: there is no such link.
        """
        never_policy = self._mujoco.mjtSleepPolicy.mjSLEEP_NEVER
        self.scene.keep_awake(link, never_policy)
        if self._is_changed:
            return
        tree = int(self.model.body_treeid[self.model.body(link).id])
        if tree >= 0:
            self._sleep.keep_awake(tree)

    def recompile_if_changed(self) -> None:
        """Recompile the MuJoCo model if the scene has changed."""
        if self._is_changed:
            self._set_model(*compile_scene(self.scene, (self.model, self.data)))
            self._bodies, self._joints = {}, {}
            self._is_changed = self._is_reshaped = self._is_current = False
            self.revision += 1
            new_servos, self._new_servos = self._new_servos, []
            for servo in new_servos:
                servo.restart()

    def refresh(self) -> None:
        """Call `recompile_if_changed`, and update the MuJoCo data that is derived from positions."""
        self.recompile_if_changed()
        if not self._is_current:
            mujoco, model, data = self._mujoco, self.model, self.data
            move_actors(self.scene.figures, model, data, self.seconds)
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            mujoco.mj_camlight(model, data)
            mujoco.mj_comVel(model, data)
            self._is_current = True

    def _set_model(self, model: Any, data: Any) -> None:
        """Use another MuJoCo model and its data."""
        self.model, self.data = model, data
        self._state: tuple[Array, Array] = data.qpos, data.qvel
        self._stepper = Stepper(model, data)
        is_allowed = not any(figure.walks_into_bodies for figure in self.scene.figures)
        self._sleep.set_model(model, data, self.time, self.step, is_allowed=is_allowed)
        self._solving.set_model(model, data, self.time, self.step)

    def reset(self) -> None:
        """Restore the initial state, and restart time at 0."""
        self.refresh()
        self._solving.restart()  # Enable sleep first: MuJoCo places static bodies only if sleep is enabled.
        self._mujoco.mj_resetData(self.model, self.data)
        self._stepper.expect_overlaps()
        self._pushes.clear()
        self.time = 0
        self._is_current = False
        self.schedule.restart()

    def advance(self, duration: int) -> None:
        """Advance simulated time, and call scheduled functions at their times.

        Args:
            duration: the minimum time in nanoseconds, which is rounded up to a multiple of the step.

        Raises:
            UnstableError: a position or velocity is no longer finite; the simulation stops.
            LinkwrightError: SIM121, MuJoCo failed.
        """
        end = self.time + duration
        while self.time < end:
            next_task = self.schedule.next_time
            stop_time = end if next_task is None else min(end, max(next_task, self.time + self.step))
            self._make_steps(-(-(stop_time - self.time) // self.step))
            self.schedule.run(self.time)

    def call_every(self, period: int, function: Callable[[], None]) -> Task:
        """Schedule periodic calls of a function, and return the task.

        `period` is in simulated nanoseconds; 0 means after every step.
        """
        return self.schedule.add(max(period, self.step), function, self.time)

    def _make_steps(self, count: int) -> None:
        """Simulate a number of steps, with as little Python code per step as possible."""
        if self._is_changed:
            self.recompile_if_changed()
        mujoco, (positions, velocities) = self._mujoco, self._state
        old_state = positions.tobytes(), velocities.tobytes()  # takes half the time of copying arrays
        try:
            self._stepper.make_steps(count)
        except mujoco.FatalError as error:
            reason = str(error).splitlines()[0]
            raise LinkwrightError(
                Diagnostic("SIM121", phrase("MuJoCo failed: {reason}", reason=foreign(reason)))
            ) from None
        self._is_current = False
        dot = mujoco.mju_dot  # takes half the time of a comparison; numpy's dot warns of overflows
        if (
            not (dot(positions, positions) < _SAFE_SQUARED_SUM and dot(velocities, velocities) < _SAFE_SQUARED_SUM)
            and not self._is_stable()
        ):
            raise self._unstable_error(count, np.frombuffer(old_state[0]), np.frombuffer(old_state[1]))
        self.time += count * self.step

    def _is_stable(self) -> bool:
        return all(bool((np.abs(state) < _MAX_VALUE).all()) for state in self._state)

    def _unstable_error(self, count: int, positions: Array, velocities: Array) -> UnstableError:
        """Restore the last step before a failure, and return the error.

        The steps since the last good state are simulated again to find this step; the error names the fastest body.
        """
        mujoco, model, data, good_state = self._mujoco, self.model, self.data, (positions, velocities)
        for _ in range(count):
            data.qpos[:], data.qvel[:] = good_state
            self._stepper.make_steps(1)
            if not self._is_stable():
                break
            good_state = data.qpos.copy(), data.qvel.copy()
            self.time += self.step
        has_invalid_force = ~np.isfinite(data.xfrc_applied).all(axis=1)
        failed = np.nan_to_num(np.abs(data.qvel), nan=np.inf)
        dof = int(np.argmax(np.where(failed == failed.max(), np.abs(good_state[1]), -1.0)))
        body = int(np.argmax(has_invalid_force)) if has_invalid_force.any() else int(model.dof_bodyid[dof])
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = good_state
        values = {"time": f"{self.seconds:.3f}", "link": model.body(body).name}
        message = phrase("the simulation became unstable at {time} s, at link '{link}'", **values)
        hint = phrase("check its mass, its inertia and its overlaps, or make the time step shorter")
        return UnstableError(Diagnostic("SIM120", message, hint=hint))

    def body(self, name: str) -> int:
        """Return the index of a link's body in MuJoCo's current model.

        Raises:
            KeyError: there is no such link.
        """
        self.refresh()
        if name not in self._bodies:
            self._bodies[name] = int(self.model.body(name).id)
        return self._bodies[name]

    def link_pose(self, name: str) -> Transform:
        """Return the pose of a link's frame in the world.

        Raises:
            KeyError: there is no such link.
        """
        body, data = self.body(name), self.data
        x, y, z = data.xpos[body].tolist()
        qw, qx, qy, qz = data.xquat[body].tolist()
        return x, y, z, qx, qy, qz, qw

    def link_velocity(self, name: str) -> tuple[Array, Array]:
        """Return the linear velocity of a link's origin, and the link's angular velocity.

        Both are in the axes of the world, in m/s and rad/s.
        """
        body, result = self.body(name), np.zeros(6)
        self._mujoco.mj_objectVelocity(self.model, self.data, self._mujoco.mjtObj.mjOBJ_XBODY, body, result, 0)
        return result[3:], result[:3]

    def mass_of(self, name: str) -> float:
        """Return the mass in kg of a model's first link and of everything that moves with it.

        Raises:
            KeyError: there is no such model.
        """
        self.refresh()
        return float(self.model.body_subtreemass[self.model.body(self._first_link(name)[0]).id])

    def wheel_radius(self, link: str) -> float | None:
        """Return the largest radius in m of a wheel's round collisions, or None if there is none.

        Raises:
            KeyError: there is no such link.
        """
        self.refresh()
        geom_types, model, body = self._mujoco.mjtGeom, self.model, self.model.body(link)
        radii = []
        for geom in range(body.geomadr[0], body.geomadr[0] + body.geomnum[0]):
            if model.geom_group[geom] != COLLISION_GROUP:
                continue
            kind = int(model.geom_type[geom])  # An integer of numpy never equals MuJoCo's enum.
            if kind == geom_types.mjGEOM_ELLIPSOID:
                radii.append(float(np.median(model.geom_size[geom])))
            elif kind in (geom_types.mjGEOM_SPHERE, geom_types.mjGEOM_CYLINDER):
                radii.append(float(model.geom_size[geom, 0]))
        return max(radii, default=None)

    def model_pose(self, name: str) -> Transform:
        """Return the pose in the world of a model's frame.

        The frame moves with the model's first link.
        """
        root, offset = self._first_link(name)
        return compose(self.link_pose(root), invert(offset))

    def moves_freely(self, name: str) -> bool:
        """Return whether a model is fixed neither to the world nor to another model.

        Raises:
            KeyError: there is no such model.
        """
        self.refresh()
        return self._is_free(self._first_link(name)[0])

    def set_model_pose(self, name: str, pose: Transform) -> None:
        """Set the pose of a model, and set its velocity to zero.

        Kinematic links are moved only by this method.

        Raises:
            KeyError: there is no such model.
            LinkwrightError: SIM103, the model is fixed to the world or attached to another model.
        """
        self.refresh()
        scene_model = self.scene.models[name]
        displacement = compose(pose, invert(scene_model.pose))
        if set_kinematic_poses(scene_model.structure, displacement, self.model, self.data):
            self._stepper.expect_overlaps()
            self._is_current = False
            return
        if not self.moves_freely(name):
            message = phrase("'{name}' is fixed to the world", name=name)
            hint = phrase("delete it, and spawn it again at the intended pose")
            if scene_model.attached_to:
                other_model = min(scene_model.attached_to)
                message = phrase(
                    "a joint of the world connects '{name}' to '{other_model}'", name=name, other_model=other_model
                )
                hint = phrase("move '{other_model}' instead", other_model=other_model)
            raise LinkwrightError(Diagnostic("SIM103", message, hint=hint))
        root, offset = self._first_link(name)
        joint = self.data.joint(f"{root}#free")
        x, y, z, qx, qy, qz, qw = compose(pose, offset)
        joint.qpos[:] = (x, y, z, qw, qx, qy, qz)
        joint.qvel[:] = 0.0
        self._handle_jump(self.body(root))

    def set_model_velocity(self, name: str, linear: Vector3, angular: Vector3) -> None:
        """Set the velocity of the first link of a free model.

        The velocity is in the axes of the world, in m/s and rad/s.

        Raises:
            KeyError: there is no such model, or it does not move freely.
        """
        self.refresh()
        root, _ = self._first_link(name)
        rotation = self.link_pose(root)[3:]
        self.data.joint(f"{root}#free").qvel[:] = (*linear, *rotate(quaternion_inverse(rotation), angular))
        self._sleep.wake_tree(int(self.model.body_treeid[self.body(root)]))
        self._is_current = False

    def _first_link(self, name: str) -> tuple[str, Transform]:
        """Return the name of a model's first link, and the link's pose in the frame of the model."""
        model = self.scene.models[name]
        first_link = model.structure.links[0].link
        return first_link.name, compose(invert(model.pose), first_link.pose)

    def joint_state(self, name: str) -> tuple[float, float]:
        """Return the position and velocity of a joint with one axis, in rad and rad/s or m and m/s.

        Raises:
            KeyError: there is no such joint, or it does not move.
        """
        if self._is_reshaped:  # Motors do not affect joints, so adding them does not recompile.
            self.recompile_if_changed()
        indices = self._joints.get(name)
        if indices is None:
            joint = self.model.joint(name)
            indices = self._joints[name] = int(joint.qposadr[0]), int(joint.dofadr[0])
        positions, velocities = self._state
        return positions.item(indices[0]), velocities.item(indices[1])

    def set_joint_position(self, name: str, position: float) -> None:
        """Set the position of a joint with one axis, in rad (m), and set its velocity to zero."""
        self.refresh()
        joint = self.data.joint(name)
        joint.qpos[0], joint.qvel[0] = position, 0.0
        self._handle_jump(self.model.jnt_bodyid[joint.id])

    def push_joint(self, name: str, force: float) -> None:
        """Set the torque in N m (force in N) on a joint with one axis, until it is set again.

        The torque is limited by the joint's ``<effort>``, and to the torque that reaches the joint's ``<velocity>``
        within a step.
        """
        self.refresh()
        self.data.joint(name).qfrc_applied[0] = self._clip_force(name, force)

    def _clip_force(self, name: str, force: float) -> float:
        """Return a joint force or torque clipped to the joint's limits, as in gz's engine DART.

        Limits of 0 or less are ignored.
        """
        model, speed_limit = self.model, self.scene.speed_limit(name)
        joint_id = model.joint(name).id
        if model.jnt_actfrclimited[joint_id]:
            lower, upper = model.jnt_actfrcrange[joint_id].tolist()
            force = min(max(force, lower), upper)
        if isfinite(speed_limit):
            _, speed = self.joint_state(name)
            mass = 1.0 / float(model.dof_invweight0[model.jnt_dofadr[joint_id]])
            force_per_speed = (
                mass * NANOSECONDS_PER_SECOND / self.step
            )  # to change the speed by 1 rad/s (1 m/s) within a step
            force = min(
                max(force, min(-(speed_limit + speed) * force_per_speed, 0.0)),
                max((speed_limit - speed) * force_per_speed, 0.0),
            )
        return force

    def push(
        self,
        link: str,
        force: Array | Sequence[float],
        torque: Array | Sequence[float] = (0.0, 0.0, 0.0),
        *,
        by: Hashable = "",
        at: Array | Sequence[float] | None = None,
    ) -> None:
        """Set the force in N and the torque in N m on a link, in world axes.

        Force and torque act until they are set again. The forces of several callers add up; `by` identifies the caller.
        The force acts at the point `at` of the world, or at the center of mass of the link.
        """
        body, forces = self.body(link), self._pushes.setdefault(link, {})
        forces[by] = np.array((*force, *torque))
        if at is not None:
            x, y, z = (at - self.data.xipos[body]).tolist()
            forces[by][3:] += cross((x, y, z), (force[0], force[1], force[2]))
        if not forces[by].any():
            del forces[by]
        self.data.xfrc_applied[body] = sum(forces.values())

    def wake(self) -> None:
        """Wake all bodies, because something may set them in motion."""
        self._sleep.wake()

    def set_gravity(self, gravity: Vector3) -> None:
        """Set the gravity in m/s2, in the axes of the world."""
        self.refresh()
        self.scene.spec.option.gravity = gravity
        self.model.opt.gravity[:] = gravity
        self._sleep.wake()


def _get_compiled_properties(world: World) -> tuple[object, ...]:
    """Return the properties of a world whose change requires rebuilding MuJoCo's model."""
    return find_gravity(world), find_physics(world).max_step_size, world.scene, world.lights
