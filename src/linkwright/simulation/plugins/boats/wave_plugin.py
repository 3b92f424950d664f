"""The base class of plugins that float on waves.

Each of them reads ``<wavefield>``, and follows the parameters that are published on a topic. Before the first
message, a ``<wavefield>`` without ``<wave>`` is calm.

Source: VRX (parameters, topics, defaults). There, waves of the default parameters grow until the first message.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields, replace
from typing import Any, Generic, TypeVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.simulation.plugins.boats.waves import WaveField, WaveParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.water import WaterSurface

P = TypeVar("P")

WAVEFIELD = "wavefield"
_DEFAULT_TOPIC = "/wavefield/parameters"
_PARAMETERS_TYPE = "ros_gz_interfaces/msg/ParamVec"
_VALUE_FIELDS = ("", "bool_value", "integer_value", "double_value", "string_value")
"""The field of a parameter's value for each number of its type."""
_TYPES = {"model": str, "number": int}
"""The types of parameters that are not ``float``."""


class WavePlugin(SimulatedPlugin[P], ABC, Generic[P]):
    """A plugin that knows the height of waves."""

    CARRIED = ("_waves",)

    def start_waves(self) -> None:
        """Read the waves, and subscribe to their parameters.

        Raises:
            LinkwrightError: SIM160, a parameter of the waves is not valid.
        """
        self._waves = self._read_waves()
        wavefield = self._wavefield()
        topic = self.text_in(wavefield, "topic") or _DEFAULT_TOPIC
        self.node.subscribe(_PARAMETERS_TYPE, f"/{topic.lstrip('/')}", self._on_parameters)

    def reset(self) -> None:
        """Restore the waves of the description."""
        self._waves = self._read_waves()

    @property
    def has_waves(self) -> bool:
        """Whether there are waves."""
        return self._waves is not None

    def wave_heights(self, points: Array) -> Array:
        """Return the height of the waves above calm water at points x, y of the world in m, shape (m,)."""
        if self._waves is None:
            return np.zeros(len(points))
        return self._waves.heights(points, self.simulation.seconds, sine=self.gazebo_mistakes)

    @property
    @abstractmethod
    def fluid_level(self) -> float:
        """The height of calm water in the world, in m."""

    @property
    def water(self) -> WaterSurface:
        """The surface of the water."""
        if self._waves is None:
            return WaterSurface(self.fluid_level)
        rows = self._waves.wave_rows(sine=self.gazebo_mistakes)
        return WaterSurface(self.fluid_level, max(self._waves.parameters.tau, 0.0), rows)

    def _wavefield(self) -> Any:
        return None if self.context.element is None else self.context.element.first(WAVEFIELD)

    def _read_waves(self) -> WaveField | None:
        wavefield = self._wavefield()
        wave = None if wavefield is None else wavefield.first("wave")
        if wave is None:
            return None
        changes: dict[str, Any] = {}
        for field in fields(WaveParameters):
            if field.name == "model":
                changes["model"] = self.text_in(wave, "model") or WaveParameters().model
            else:
                number = self.number_in(wave, field.name, float(getattr(WaveParameters(), field.name)))
                changes[field.name] = _TYPES.get(field.name, float)(number)
        parameters = WaveParameters(**changes)
        mistake = parameters.find_mistake()
        if mistake is not None:
            raise self.parameter_error(
                phrase("plugin '{plugin}': {mistake}", plugin=self.context.name, mistake=mistake), wave
            )
        return WaveField(parameters)

    def _on_parameters(self, message: Any) -> None:
        names = {field.name for field in fields(WaveParameters)}
        old_parameters = WaveParameters() if self._waves is None else self._waves.parameters
        changes = {}
        for item in message.params:
            if item.name in names and 0 < item.value.type < len(_VALUE_FIELDS):
                changes[item.name] = getattr(item.value, _VALUE_FIELDS[item.value.type])
        try:
            parameters = replace(
                old_parameters, **{name: _TYPES.get(name, float)(value) for name, value in changes.items()}
            )
        except ValueError:
            mistake = phrase("a parameter of the waves is not a number")
        else:
            if parameters == old_parameters and self._waves is not None:
                return
            found = parameters.find_mistake()
            if found is None:
                self._waves = WaveField(parameters)
                return
            mistake = found
        self.node.logger.warning(
            phrase(
                "plugin '{plugin}': {mistake}; the waves stay as they are", plugin=self.context.name, mistake=mistake
            )
        )
