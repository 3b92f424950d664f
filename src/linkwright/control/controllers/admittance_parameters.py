"""The parameters of ``admittance_controller/AdmittanceController``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np

from linkwright.control.hardware.interfaces import ACCELERATION, EFFORT, POSITION, VELOCITY
from linkwright.control.motion.admittance import AdmittanceSettings
from linkwright.diagnostics import Phrase, phrase
from linkwright.nodes.parameter_tables import HUMBLE, Check, at_least, not_empty, one_of, parameter

_INTERFACES = (POSITION, VELOCITY, ACCELERATION, EFFORT)


def _numbers(count: int, low: float = -inf, high: float = inf) -> Check:
    """Return a validator that requires a number of values within limits."""

    def check(name: str, value: Sequence[float]) -> Phrase | None:
        if len(value) != count:
            return phrase(
                "parameter '{name}' must have {expected} values, but it has {count}",
                name=name,
                expected=count,
                count=len(value),
            )
        for item in value:
            if not low <= item <= high:
                return phrase(
                    "Parameter '{name}' with the value {value:g} must be from {low:g} to {high:g}",
                    name=name,
                    value=item,
                    low=low,
                    high=high,
                )
        return None

    return check


@dataclass(frozen=True, kw_only=True)
class KinematicsParameters:
    """The chain of the arm. The plugin names are required, but Linkwright computes the kinematics itself."""

    plugin_name: str = parameter("", description="the kinematics plugin", check=not_empty)
    plugin_package: str = parameter("", description="the base package of the kinematics plugin", check=not_empty)
    base: str = parameter("", description="the first link of the chain", check=not_empty)
    tip: str = parameter("", description="the last link of the chain", check=not_empty)
    alpha: float = parameter(0.01, description="the damping of the inverse of the Jacobian", check=at_least(0.0))
    group_name: str = parameter("", description="without effect")


@dataclass(frozen=True, kw_only=True)
class FrameParameters:
    """A link of the chain."""

    id: str = parameter("", description="the link", check=not_empty)
    external: bool = parameter(False, only=HUMBLE, description="without effect")


@dataclass(frozen=True, kw_only=True)
class SensorParameters:
    """The force-torque sensor."""

    name: str = parameter("", description="the name of the sensor in ros2_control", check=not_empty)
    frame: FrameParameters = FrameParameters()
    filter_coefficient: float = parameter(0.05, description="the weight of the newest wrench, from 0 to 1")


@dataclass(frozen=True, kw_only=True)
class FrameGroup:
    """A group with a frame."""

    frame: FrameParameters = FrameParameters()


@dataclass(frozen=True, kw_only=True)
class CenterOfGravity:
    """The center of gravity and the weight of the tool below the sensor."""

    pos: tuple[float, ...] = parameter((), description="the center of gravity, 3 values in m", check=_numbers(3))
    force: float = parameter(0.0, description="the weight, in N")


@dataclass(frozen=True, kw_only=True)
class GravityCompensation:
    """The compensation of the weight of the tool."""

    frame: FrameParameters = FrameParameters()
    CoG: CenterOfGravity = CenterOfGravity()


@dataclass(frozen=True, kw_only=True)
class AxesParameters:
    """The constants of the six axes of the control frame: x, y, z and the rotations about them."""

    selected_axes: tuple[bool, ...] = parameter((), description="whether the axis yields to forces", check=_numbers(6))
    mass: tuple[float, ...] = parameter(
        (), description="the masses in kg and moments of inertia in kg m²", check=_numbers(6, 0.0001, 1e6)
    )
    damping_ratio: tuple[float, ...] = parameter(
        (), description="the damping ratios, damping / (2 * sqrt(mass * stiffness))", check=_numbers(6)
    )
    stiffness: tuple[float, ...] = parameter(
        (), description="the stiffness in N/m and Nm/rad", check=_numbers(6, 0.0, 1e8)
    )
    joint_damping: float = parameter(
        5.0, description="the damping of the joint velocities, in 1/s", check=at_least(0.0)
    )


@dataclass(frozen=True, kw_only=True)
class AdmittanceParameters:
    """Parameters of the controller."""

    joints: tuple[str, ...] = parameter((), read_only=True, description="the joints of the chain", check=not_empty)
    command_joints: tuple[str, ...] = parameter(
        (), read_only=True, description="the joints of the command interfaces, if they differ"
    )
    command_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the commanded interfaces", check=one_of(*_INTERFACES)
    )
    state_interfaces: tuple[str, ...] = parameter(
        (), read_only=True, description="the measured interfaces", check=one_of(*_INTERFACES)
    )
    chainable_command_interfaces: tuple[str, ...] = parameter(
        (POSITION, VELOCITY), read_only=True, description="the references", check=one_of(POSITION, VELOCITY)
    )
    kinematics: KinematicsParameters = KinematicsParameters()
    ft_sensor: SensorParameters = SensorParameters()
    control: FrameGroup = FrameGroup()
    fixed_world_frame: FrameGroup = FrameGroup()
    gravity_compensation: GravityCompensation = GravityCompensation()
    admittance: AxesParameters = AxesParameters()
    enable_parameter_update_without_reactivation: bool = parameter(
        True, description="whether changed parameters apply at once, not from the next activation"
    )

    @property
    def settings(self) -> AdmittanceSettings:
        """The frames and constants for `Admittance`."""
        axes, gravity = self.admittance, self.gravity_compensation
        mass, stiffness = np.array(axes.mass), np.array(axes.stiffness)
        return AdmittanceSettings(
            sensor_frame=self.ft_sensor.frame.id,
            control_frame=self.control.frame.id,
            world_frame=self.fixed_world_frame.frame.id,
            gravity_frame=gravity.frame.id,
            center_of_gravity=np.array(gravity.CoG.pos),
            weight=gravity.CoG.force,
            filter_coefficient=self.ft_sensor.filter_coefficient,
            selected_axes=np.array(axes.selected_axes, dtype=float),
            mass=mass,
            stiffness=stiffness,
            damping=np.array(axes.damping_ratio) * 2.0 * np.sqrt(mass * stiffness),
            joint_damping=axes.joint_damping,
            alpha=self.kinematics.alpha,
        )

    @property
    def frames(self) -> dict[str, str]:
        """The links that must belong to the chain, by parameter."""
        return {
            "ft_sensor.frame.id": self.ft_sensor.frame.id,
            "control.frame.id": self.control.frame.id,
            "fixed_world_frame.frame.id": self.fixed_world_frame.frame.id,
            "gravity_compensation.frame.id": self.gravity_compensation.frame.id,
        }
