"""Currents of the water: ``libuuv_underwater_current_ros_plugin.so``.

The speed, the horizontal and the vertical angle of the current are random processes of first order within limits. The
current is published, and services read and set the processes.

Source: uuv_simulator (parameters, defaults, topics, services, processes). There, the quantities decay to 0 instead of
their means.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from math import cos, sin
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.messages import Header, Vector3, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_QUANTITIES = {"velocity": "velocity", "horz_angle": "horizontal_angle", "vert_angle": "vertical_angle"}
"""The names of the quantities in services, and their elements."""
_TWIST_TYPE = "geometry_msgs/msg/TwistStamped"
_SERVICES = "uuv_world_ros_plugins_msgs/srv"
_RATE_HZ = 20.0


@dataclass(frozen=True, slots=True)
class CurrentModel:
    """A random process of first order.

    Attributes:
        mean: the mean.
        min, max: the limits.
        mu: the rate in 1/s at which deviations decay.
        noise: the amplitude of the noise that is added in each step.
    """

    mean: float = 0.0
    min: float = -1.0
    max: float = 1.0
    mu: float = 0.0
    noise: float = 0.0

    @property
    def is_valid(self) -> bool:
        """Whether the limits contain the mean, and the other values are in their ranges."""
        return self.min < self.max and self.min <= self.mean <= self.max and 0.0 <= self.mu <= 1.0 and self.noise >= 0.0


class UnderwaterCurrent(SimulatedPlugin[NoParameters]):
    """The substitute for ``libuuv_underwater_current_ros_plugin.so``."""

    IGNORED = ("namespace", "constant_current")
    CARRIED = ("_models", "_values")

    def start(self) -> None:
        """Read the processes, and create the topic and the services.

        Raises:
            LinkwrightError: SIM160, a process is not valid.
        """
        element = self.context.element
        current = None if element is None else element.first("constant_current")
        self._initial_models = {name: self._read_model(current, tag) for name, tag in _QUANTITIES.items()}
        namespace = self.text_in(element, "namespace").strip("/")
        prefix = f"/{namespace}" if namespace else ""
        topic = self.text_in(current, "topic").lstrip("/") or "current_velocity"
        self.reset()
        self._output = self.node.publisher(_TWIST_TYPE, f"{prefix}/{topic}")
        for name in _QUANTITIES:
            self.node.service(
                f"{_SERVICES}/GetCurrentModel", f"{prefix}/get_current_{name}_model", partial(self._get_model, name)
            )
            self.node.service(
                f"{_SERVICES}/SetCurrentModel", f"{prefix}/set_current_{name}_model", partial(self._set_model, name)
            )
            if name != "velocity":
                self.node.service(
                    f"{_SERVICES}/SetCurrentDirection", f"{prefix}/set_current_{name}", partial(self._set_angle, name)
                )
        self.node.service(f"{_SERVICES}/SetCurrentVelocity", f"{prefix}/set_current_velocity", self._set_velocity)
        self.every(0.0, self._advance)
        self.every(_RATE_HZ, self._publish)

    def reset(self) -> None:
        """Restore the processes of the description."""
        self._random = self.random
        self._models = dict(self._initial_models)
        self._values = {name: model.mean for name, model in self._models.items()}

    def _read_model(self, current: Element | None, tag: str) -> CurrentModel:
        element = None if current is None else current.first(tag)
        default = CurrentModel()
        model = CurrentModel(
            self.number_in(element, "mean", default.mean),
            self.number_in(element, "min", default.min),
            self.number_in(element, "max", default.max),
            self.number_in(element, "mu", default.mu),
            self.number_in(element, "noiseAmp", default.noise),
        )
        if not model.is_valid:
            message = phrase(
                "plugin '{plugin}': <{tag}> needs <mean> between <min> and <max>, <mu> from 0 to 1, and <noiseAmp> of "
                "at least 0",
                plugin=self.context.name,
                tag=tag,
            )
            raise self.parameter_error(message, element)
        return model

    def _advance(self) -> None:
        seconds = self.simulation.step / NANOSECONDS_PER_SECOND
        for name, model in self._models.items():
            center = 0.0 if self.gazebo_mistakes else model.mean
            value = center + (1.0 - seconds * model.mu) * (self._values[name] - center)
            if model.noise:
                value += model.noise * float(self._random.uniform(-0.5, 0.5))
            self._values[name] = min(max(value, model.min), model.max)

    @property
    def velocity(self) -> tuple[float, float, float]:
        """The velocity of the water in m/s, in world axes."""
        speed, horizontal, vertical = (self._values[name] for name in _QUANTITIES)
        return (
            speed * cos(horizontal) * cos(vertical),
            speed * sin(horizontal) * cos(vertical),
            speed * sin(vertical),
        )

    def _publish(self) -> None:
        message = get_message(_TWIST_TYPE)(header=Header(stamp=self.stamp(), frame_id="world"))
        x, y, z = self.velocity
        message.twist.linear = Vector3(x=x, y=y, z=z)
        self._output.publish(message)

    def _try_model(self, name: str, model: CurrentModel) -> bool:
        """Replace a process if the new one is valid, and return whether it is."""
        if model.is_valid and bool(np.isfinite(model.mean)):
            self._models[name], self._values[name] = model, model.mean
            return True
        return False

    def _get_model(self, name: str, _: Any, response: Any) -> Any:
        model = self._models[name]
        response.mean, response.min, response.max = model.mean, model.min, model.max
        response.mu, response.noise = model.mu, model.noise
        return response

    def _set_model(self, name: str, request: Any, response: Any) -> Any:
        mean, lower, upper = request.mean, request.min, request.max
        if name == "velocity":
            mean, lower, upper = max(mean, 0.0), max(lower, 0.0), max(upper, 0.0)
        response.success = self._try_model(name, CurrentModel(mean, lower, upper, request.mu, request.noise))
        return response

    def _set_angle(self, name: str, request: Any, response: Any) -> Any:
        response.success = self._try_model(name, replace(self._models[name], mean=request.angle))
        return response

    def _set_velocity(self, request: Any, response: Any) -> Any:
        means = {name: getattr(request, tag) for name, tag in _QUANTITIES.items()}
        models = {name: replace(self._models[name], mean=mean) for name, mean in means.items()}
        response.success = all(model.is_valid for model in models.values())
        if response.success:
            for name, model in models.items():
                self._try_model(name, model)
        return response
