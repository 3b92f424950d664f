"""Acoustic receivers of boats: ``libAcousticPingerPlugin.so``.

The receiver measures range, bearing and elevation of a pinger in the axes of the model.

Source: VRX (parameters, defaults, topics, formulas); ros_gz_bridge (types).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot
from typing import Any

import numpy as np

from linkwright.geometry.arrays import quaternion_inverse, rotate
from linkwright.geometry.single import Vector3
from linkwright.messages import Header, get_message
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_PARAMETERS_TYPE, _DOUBLE = "ros_gz_interfaces/msg/ParamVec", 3
_QUANTITIES = ("range", "bearing", "elevation")


@dataclass(frozen=True, kw_only=True)
class PingerParameters:
    """Parameters of ``libAcousticPingerPlugin.so``: the position in m in the world, the rate in Hz."""

    frame_id: str = "pinger"
    topic_name: str = parameter("/pinger/range_bearing", aliases=("topic",))
    set_position_topic: str = "/pinger/set_pinger_position"
    position: Vector3 = (0.0, 0.0, 0.0)
    update_rate: float = 1.0


class AcousticPinger(SimulatedPlugin[PingerParameters]):
    """The substitute for ``libAcousticPingerPlugin.so``."""

    PARAMETERS = PingerParameters
    IGNORED = tuple(f"{name}_noise" for name in _QUANTITIES)
    CARRIED = ("_position",)

    def start(self) -> None:
        """Read the noise, and create the topics.

        Raises:
            LinkwrightError: SIM160, the noise is not valid.
        """
        parameters, element = self.parameters, self.context.element
        self._noises = []
        for name in _QUANTITIES:
            parent = None if element is None else element.first(f"{name}_noise")
            noise = None if parent is None else parent.first("noise")
            self._noises.append((self.number_in(noise, "mean", 0.0), self.number_in(noise, "stddev", 0.0)))
        self.reset()
        self._output = self.node.publisher(_PARAMETERS_TYPE, parameters.topic_name)
        self.node.subscribe("geometry_msgs/msg/Vector3", parameters.set_position_topic, self._on_position)
        self.every(parameters.update_rate, self._publish)

    def reset(self) -> None:
        """Move the pinger to its initial position, and restart the noise."""
        self._position = self.parameters.position
        self._random = self.random

    def _on_position(self, message: Any) -> None:
        self._position = message.x, message.y, message.z

    def _measure(self) -> tuple[float, float, float]:
        """Return the range in m, the bearing in rad and the elevation in rad, without noise."""
        pose = np.array(self.simulation.model_pose(self.context.path.partition("::")[0]))
        x, y, z = rotate(quaternion_inverse(pose[3:]), np.array(self._position) - pose[:3]).tolist()
        return hypot(x, y, z), atan2(y, x), atan2(z, hypot(x, y))

    def _publish(self) -> None:
        if not self._output.is_wanted:
            return
        value_class, parameter_class = (
            get_message(f"rcl_interfaces/msg/{name}") for name in ("ParameterValue", "Parameter")
        )
        parameters = [
            parameter_class(name=name, value=value_class(type=_DOUBLE, double_value=value + self._draw(*noise)))
            for name, value, noise in zip(_QUANTITIES, self._measure(), self._noises, strict=True)
        ]
        header = Header(stamp=self.stamp(), frame_id=self.parameters.frame_id)
        self._output.publish(get_message(_PARAMETERS_TYPE)(header=header, params=parameters))

    def _draw(self, mean: float, deviation: float) -> float:
        return mean + float(self._random.normal(0.0, deviation)) if deviation else mean
