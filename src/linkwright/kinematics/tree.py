"""Forward kinematics of a whole robot."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import prod

import numpy as np
from numpy.typing import ArrayLike

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, term
from linkwright.geometry.arrays import Array
from linkwright.kinematics.forward import ManyConfigurations, OneConfiguration
from linkwright.kinematics.layout import MOVING, lay_out, resolve_mimics
from linkwright.urdf import Robot


class UnknownNameError(LinkwrightError):
    """A joint or link that the robot does not have.

    Attributes:
        name: the name that was asked for.
    """

    def __init__(self, code: str, kind: str, name: str, known: Sequence[str], hint: Phrase | None = None) -> None:
        self.name = name
        message = phrase("the robot has no {kind} '{name}'", kind=term(kind), name=name)
        super().__init__(Diagnostic(code, message, hint=hint or did_you_mean(name, known)))


class KinematicTree:
    """The kinematic tree of a robot: link poses for joint positions.

    Revolute, continuous and prismatic joints move. A mimic joint follows the joint at the end of its chain of mimics;
    when that chain goes in a circle or to a joint that does not exist, the joint moves by itself. A planar joint stands
    still, as robot_state_publisher's kdl_parser makes it fixed; a floating joint stands still at its origin, for its
    transform comes from elsewhere. An axis need not have unit length; nothing moves about a zero axis. Limits are not
    applied. Links that do not hang from the root are left out.

    Attributes:
        joint_names: the joints that have a position, in the order of the file; mimic joints have none.
        link_names: parents before children, the root first.
    """

    def __init__(self, robot: Robot) -> None:
        layout = lay_out(robot)
        moving = {joint.name for joint in layout.body_joints}
        free, followers = resolve_mimics(robot, moving)
        self.joint_names: tuple[str, ...] = free
        self.link_names: tuple[str, ...] = layout.link_names
        self._joint_places = {name: place for place, name in enumerate(free)}
        self._link_places = {name: place for place, name in enumerate(layout.link_names)}
        self._followers = followers
        self._types = {joint.name: joint.type for joint in robot.joints.values()}
        names = [joint.name for joint in layout.body_joints]
        sources = np.array([self._joint_places.get(followers[name].leader, -1) for name in names], dtype=np.intp)
        self._sources = sources
        self._factors = np.array([followers[name].factor for name in names])
        self._offsets = np.array([followers[name].offset for name in names])
        self._plain = bool(
            np.all(self._factors == 1) and np.all(self._offsets == 0) and np.all(sources >= 0) and len(names) > 0
        )
        self._one = OneConfiguration(layout)
        self._many = ManyConfigurations(layout)

    def forward(self, positions: ArrayLike | Mapping[str, float]) -> Array:
        """The frames of all links in the root link's frame.

        Args:
            positions: in rad or m, shape (joints,) or (..., joints) in the order of `joint_names`; or a mapping as for
                `positions`.

        Returns:
            Homogeneous matrices, shape (links, 4, 4) or (..., links, 4, 4) in the order of `link_names`, float64.

        Raises:
            ValueError: the shape is another one.
            UnknownNameError: a name in the mapping is not one of `joint_names`.
        """
        if isinstance(positions, Mapping):
            positions = self.positions(positions)
        given = np.asarray(positions, dtype=np.float64)
        count = len(self.joint_names)
        if given.ndim == 0 or given.shape[-1] != count:
            raise ValueError(f"positions of shape {given.shape}; ({count},) or (configurations, {count}) is expected")
        if given.ndim == 1:
            return self._one.frames(self._body_positions(given))
        shape = given.shape[:-1]
        flat = self._body_positions(given.reshape(prod(shape), count))
        return self._many.frames(flat).reshape(*shape, len(self.link_names), 4, 4)

    def positions(self, by_name: Mapping[str, float], default: float = 0.0) -> Array:
        """Positions in the order of `joint_names` from positions by name; those not given take the default.

        Raises:
            UnknownNameError: KIN101 for a name that is not a joint of the robot, KIN102 for a joint without a position
                of its own.
        """
        positions = np.full(len(self.joint_names), default, dtype=np.float64)
        for name, position in by_name.items():
            place = self._joint_places.get(name)
            if place is None:
                raise self._unknown_joint(name)
            positions[place] = position
        return positions

    def link_index(self, name: str) -> int:
        """The place of a link in `link_names`.

        Raises:
            UnknownNameError: KIN103, the robot has no such link.
        """
        try:
            return self._link_places[name]
        except KeyError:
            raise UnknownNameError("KIN103", "link", name, self.link_names) from None

    def _body_positions(self, positions: Array) -> Array:
        """The positions of the bodies' joints, mimic joints included; shape (..., bodies - 1)."""
        if self._plain:
            return positions.take(self._sources, axis=-1)
        if not len(self.joint_names):
            positions = np.zeros((*positions.shape[:-1], 1))
        followed = positions.take(np.maximum(self._sources, 0), axis=-1)
        followed[..., self._sources < 0] = 0.0  # followers of a joint that does not move
        followed *= self._factors
        followed += self._offsets
        return followed

    def _unknown_joint(self, name: str) -> UnknownNameError:
        follower = self._followers.get(name)
        if follower is not None:
            hint = phrase("it mimics '{leader}': give the position of that joint", leader=follower.leader)
            return UnknownNameError("KIN102", "joint with a position of its own called", name, (), hint)
        if name in self._types and self._types[name] not in MOVING:
            hint = phrase("it is {types} and does not move", types=self._types[name])
            return UnknownNameError("KIN102", "joint with a position of its own called", name, (), hint)
        return UnknownNameError("KIN101", "joint", name, self.joint_names)
