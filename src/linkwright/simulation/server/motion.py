"""Transfer of the motion of a model to the changed model that replaces it."""

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
        linear: the linear velocity of the first link in m/s, in world axes.
        angular: the angular velocity of the first link in rad/s, in world axes.
        joints: the MuJoCo type, positions and velocities of each joint, by name.
    """

    pose: Transform
    linear: Vector3
    angular: Vector3
    joints: dict[str, tuple[int, Array, Array]]


def record_motion(simulation: Simulation, name: str) -> Motion:
    """Return the current motion of a model.

    Raises:
        KeyError: there is no such model.
    """
    pose = simulation.model_pose(name)
    first_link = simulation.scene.models[name].structure.links[0].link.name
    linear, angular = simulation.link_velocity(first_link)
    joints = {}
    for joint, index in _find_joint_indices(simulation, name).items():
        view = simulation.data.joint(index)
        joints[joint] = int(simulation.model.jnt_type[index]), view.qpos.copy(), view.qvel.copy()
    return Motion(pose, tuple(linear.tolist()), tuple(angular.tolist()), joints)


def restore_motion(simulation: Simulation, name: str, motion: Motion, *, keeps_pose: bool) -> None:
    """Apply the motion of a replaced model to the model that replaces it.

    A joint keeps its positions and velocities if both models have a joint of this name and type.

    Args:
        simulation: the simulation of the world.
        name: the name of the new model.
        motion: the motion of the replaced model.
        keeps_pose: whether a free model also gets the pose and velocity of the replaced model.

    Raises:
        KeyError: there is no such model.
    """
    free_joints = {f"{link}#free": link for link in simulation.free_links(name)}
    for joint, index in _find_joint_indices(simulation, name).items():
        kind, position, velocity = motion.joints.get(joint, (-1, None, None))
        if joint not in free_joints and kind == int(simulation.model.jnt_type[index]):
            view = simulation.data.joint(index)
            view.qpos[:], view.qvel[:] = position, velocity
    simulation.mark_moved()
    if keeps_pose and free_joints:
        _set_state(simulation, name, motion, free_joints)


def _set_state(simulation: Simulation, name: str, motion: Motion, free_joints: dict[str, str]) -> None:
    """Set the poses of the free links and the velocity of the model.

    The first link and new links get their initial poses relative to the model's frame; other links keep their poses and
    velocities.
    """
    model = simulation.scene.models[name]
    poses = {tree_link.link.name: tree_link.link.pose for tree_link in model.structure.links}
    displacement = compose(motion.pose, invert(model.pose))
    for index, (joint, link) in enumerate(free_joints.items()):
        view = simulation.data.joint(joint)
        if index and joint in motion.joints:
            _, view.qpos[:], view.qvel[:] = motion.joints[joint]
        else:
            x, y, z, qx, qy, qz, qw = compose(displacement, poses[link])
            view.qpos[:] = x, y, z, qw, qx, qy, qz
    simulation.mark_moved()
    if simulation.moves_freely(name):
        simulation.set_model_velocity(name, motion.linear, motion.angular)


def _find_joint_indices(simulation: Simulation, name: str) -> dict[str, int]:
    """Return the indices of a model's joints in MuJoCo's model, by name."""
    simulation.refresh()
    model, indices = simulation.model, {}
    for tree_link in simulation.scene.models[name].structure.links:
        body = model.body(tree_link.link.name)
        for index in range(int(body.jntadr[0]), int(body.jntadr[0]) + int(body.jntnum[0])):
            indices[model.joint(index).name] = index
    return indices
