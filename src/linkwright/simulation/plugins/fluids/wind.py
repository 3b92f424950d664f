"""Wind that changes with time, and its force on links: ``gz-sim-wind-effects-system``.

The wind of the world rises, varies as a sine and has noise, in magnitude, direction and vertical speed. It pushes the
links with ``<enable_wind>``: a force of the link's mass, times a factor, times the velocity of the air past the link.
``libWindPlugin.so`` of Gazebo Classic has the same parameters.

Source: gz-sim and Gazebo Classic (parameters, defaults, formulas). The topic of gz with the type ``gz.msgs.Wind`` has
no counterpart in ROS and is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, radians, sin

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_MIN_TIME_S = 1e-6


@dataclass(slots=True)
class _Fluctuation:
    """A fluctuating quantity of the wind.

    It is the sum of a mean that follows the world's wind with delay, a sine, and noise.

    Attributes:
        rise_time: the time constant of the delay, in s.
        amplitude: the amplitude of the sine, in the unit of the quantity or as a fraction of the mean.
        period: the period of the sine, in s.
        noise_mean, noise_deviation: the mean and the standard deviation of the noise, in the unit of the quantity.
        mean: the current mean.
    """

    rise_time: float
    amplitude: float
    period: float
    noise_mean: float
    noise_deviation: float
    mean: float

    def follow(self, target: float, seconds: float) -> None:
        """Move the mean toward a target for a time in s."""
        self.mean += (target - self.mean) * seconds / self.rise_time

    def compute_sine(self, seconds: float) -> float:
        """Return the sine at a simulated time in s."""
        return self.amplitude * sin(2 * pi * seconds / self.period)

    def draw_noise(self, random: np.random.Generator) -> float:
        """Return a value of the noise."""
        if self.noise_mean == 0.0 and self.noise_deviation == 0.0:
            return 0.0
        return float(random.normal(self.noise_mean, self.noise_deviation))


class WindEffects(SimulatedPlugin[NoParameters]):
    """The substitute for ``gz-sim-wind-effects-system`` and ``libWindPlugin.so``."""

    IGNORED = ("horizontal", "vertical", "force_approximation_scaling_factor")  # read by start and reset

    def start(self) -> None:
        """Read the parameters.

        Raises:
            LinkwrightError: SIM160, a parameter is not a number, or a time constant is not positive.
        """
        self._factor = self.number_in(self.context.element, "force_approximation_scaling_factor", 1.0)
        self._revision = -1
        self._masses: dict[str, float] = {}
        self.reset()
        self.every(0.0, self._apply_wind)

    def reset(self) -> None:
        """Restart the wind from calm air, with the direction of the world's wind."""
        element = self.context.element
        horizontal = None if element is None else element.first("horizontal")
        x, y, _ = self.simulation.world.wind
        self._random = self.random
        self._magnitude = self._read_fluctuation(horizontal, "magnitude", "amplitude_percent", 0.0)
        self._direction = self._read_fluctuation(horizontal, "direction", "amplitude", degrees(atan2(y, x)))
        self._vertical = self._read_fluctuation(element, "vertical", "amplitude", 0.0)

    def stop(self) -> None:
        """Restore the wind of the world."""
        self.simulation.wind = self.simulation.world.wind

    def _read_fluctuation(self, parent: Element | None, tag: str, amplitude_tag: str, mean: float) -> _Fluctuation:
        element = None if parent is None else parent.first(tag)
        sine = None if element is None else element.first("sin")
        noise = None if element is None else element.first("noise")
        rise_time = self.number_in(element, "time_for_rise", 1.0)
        period = self.number_in(sine, "period", 1.0)
        if min(rise_time, period) < _MIN_TIME_S:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <time_for_rise> and <period> of <{parent}> must be greater than 0",
                    plugin=self.context.name,
                    parent=tag,
                )
            )
        return _Fluctuation(
            rise_time,
            self.number_in(sine, amplitude_tag, 0.0),
            period,
            self.number_in(noise, "mean", 0.0),
            self.number_in(noise, "stddev", 0.0),
            mean,
        )

    def _apply_wind(self) -> None:
        simulation = self.simulation
        simulation.refresh()
        if self._revision != simulation.revision:
            self._revision, self._masses = simulation.revision, self._find_pushed_masses()
        self._update_wind()
        wind = np.array(simulation.wind)
        for link, mass in self._masses.items():
            linear, _ = simulation.link_velocity(link)
            self.push(link, mass * self._factor * (wind - linear))

    def _find_pushed_masses(self) -> dict[str, float]:
        """Return the masses in kg of the links on which the wind acts, by the names of the links."""
        simulation = self.simulation
        links = [
            tree_link.link
            for scene_model in simulation.scene.models.values()
            for tree_link in scene_model.structure.links
        ]
        return {
            link.name: float(simulation.model.body_mass[simulation.body(link.name)])
            for link in links
            if not link.static and (link.link.enable_wind or link.model.enable_wind)
        }

    def _update_wind(self) -> None:
        """Compute the wind, with the direction in degrees as in the parameters."""
        simulation, random = self.simulation, self._random
        step = simulation.step / NANOSECONDS_PER_SECOND
        x, y, z = simulation.world.wind
        self._magnitude.follow(hypot(x, y), step)
        self._direction.follow(degrees(atan2(y, x)), step)
        self._vertical.follow(z, step)
        seconds = simulation.seconds
        magnitude = self._magnitude.mean * (1.0 + self._magnitude.compute_sine(seconds)) + self._magnitude.draw_noise(
            random
        )
        angle = radians(
            self._direction.mean + self._direction.compute_sine(seconds) + self._direction.draw_noise(random)
        )
        vertical = self._vertical.mean + self._vertical.draw_noise(random)
        simulation.wind = (magnitude * cos(angle), magnitude * sin(angle), vertical)
