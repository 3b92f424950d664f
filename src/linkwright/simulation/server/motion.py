"""Preserves the motion of a model that is replaced by a changed one."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Transform, Vector3, compose, invert
from linkwright.simulation.simulation import Simulation


@dataclass(frozen=True, slots=True)
class Motion:
    """The pose, velocities and joint states of a model.

    Attributes:
        pose: the pose of the model's frame in the world.
        linear: the velocity of the first link in m/s, in the axes of the world.
        angular: the angular velocity of the first link in rad/s, in the axes of the world.
        joints: the type, positions and velocities of the model's joints in MuJoCo, by name.
    """

    pose: Transform
    linear: Vector3
    angular: Vector3
    joints: dict[str, tuple[int, Array, Array]]


def motion_of(simulation: Simulation, name: str) -> Motion:
    """Return the current motion of a model.

    Raises:
        KeyError: there is no such model.
    """
    pose = simulation.model_pose(name)
    first = simulation.scene.models[name].structure.links[0].link.name
    linear, angular = simulation.link_velocity(first)
    joints = {}
    for joint, number in _joints(simulation, name).items():
        view = simulation.data.joint(number)
        joints[joint] = int(simulation.model.jnt_type[number]), view.qpos.copy(), view.qvel.copy()
    return Motion(pose, tuple(linear.tolist()), tuple(angular.tolist()), joints)


def resume(simulation: Simulation, name: str, motion: Motion, *, here: bool) -> None:
    """Apply the motion of a replaced model to its successor.

    Joints continue if they exist in both models with the same type.

    Args:
        simulation: the simulation of the world.
        name: the name of the model.
        motion: the motion of the replaced model.
        here: whether a free model also continues at the pose and velocity of the replaced model.

    Raises:
        KeyError: there is no such model.
    """
    free = {f"{link}#free": link for link in simulation.free_links(name)}
    for joint, number in _joints(simulation, name).items():
        kind, position, velocity = motion.joints.get(joint, (-1, None, None))
        if joint not in free and kind == int(simulation.model.jnt_type[number]):
            view = simulation.data.joint(number)
            view.qpos[:], view.qvel[:] = position, velocity
    simulation.set_moved()
    if here and free:
        _put(simulation, name, motion, free)


def _put(simulation: Simulation, name: str, motion: Motion, free: dict[str, str]) -> None:
    """Set the poses of the free links, and the velocity of the model.

    The first link and new links follow the frame of the model; other links keep their own poses and velocities.
    """
    model = simulation.scene.models[name]
    poses = {held.link.name: held.link.pose for held in model.structure.links}
    moved = compose(motion.pose, invert(model.pose))
    for number, (joint, link) in enumerate(free.items()):
        view = simulation.data.joint(joint)
        if number and joint in motion.joints:
            _, view.qpos[:], view.qvel[:] = motion.joints[joint]
        else:
            x, y, z, qx, qy, qz, qw = compose(moved, poses[link])
            view.qpos[:] = x, y, z, qw, qx, qy, qz
    simulation.set_moved()
    if simulation.moves_freely(name):
        simulation.set_model_velocity(name, motion.linear, motion.angular)


def _joints(simulation: Simulation, name: str) -> dict[str, int]:
    """Return the indices of a model's joints in MuJoCo's model, by name."""
    simulation.refresh()
    model, found = simulation.model, {}
    for held in simulation.scene.models[name].structure.links:
        body = model.body(held.link.name)
        for number in range(int(body.jntadr[0]), int(body.jntadr[0]) + int(body.jntnum[0])):
            found[model.joint(number).name] = number
    return found
