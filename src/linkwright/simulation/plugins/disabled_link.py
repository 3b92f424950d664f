"""A link without dynamics until something touches it.

The library is ``libroboticsgroup_gazebo_disable_link_plugin.so``.

Source: roboticsgroup_gazebo_plugins (the parameter), and ODE: a disabled body moves again as soon as it touches a
moving body, and a body that a joint connects to an enabled one is enabled at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MIN_SPEED = 1e-6
"""The speed in m/s or rad/s from which the link counts as moved by something else."""


@dataclass(frozen=True, kw_only=True)
class DisabledLinkParameters:
    """Parameters of the plugin."""

    link: str = parameter()


class DisabledLink(SimulatedPlugin[DisabledLinkParameters]):
    """The substitute for ``libroboticsgroup_gazebo_disable_link_plugin.so``.

    The link floats until it is moved.
    """

    PARAMETERS = DisabledLinkParameters

    def start(self) -> None:
        """Find the link, and disable it if no joint connects it to another link."""
        scene = self.simulation.scene
        self._link = self.link(self.parameters.link)
        self._is_connected = any(self._link in (joint.parent, joint.child) for joint in scene.joints.values())
        if self._is_connected:
            self.node.logger.warning(
                phrase(
                    "link '{link}' is not disabled: joints connect it to other links, which enable it, as in Gazebo",
                    link=self.parameters.link,
                )
            )
            return
        self._original_compensation = float(scene.bodies[self._link].gravcomp)
        self._disable()
        self.every(0.0, self._enable_if_moved)

    def reset(self) -> None:
        """Disable the link again, because simulated time restarts."""
        if not self._is_connected:
            self._disable()

    def _disable(self) -> None:
        self._is_enabled = False
        self._set_compensation(1.0)

    def _enable_if_moved(self) -> None:
        """Enable the link if something has set it in motion."""
        if self._is_enabled:
            return
        linear, angular = self.simulation.link_velocity(self._link)
        if max(np.abs(linear).max(), np.abs(angular).max()) > _MIN_SPEED:
            self._is_enabled = True
            self._set_compensation(self._original_compensation)

    def _set_compensation(self, fraction: float) -> None:
        """Set the fraction of gravity that does not act on the link."""
        self.simulation.scene.bodies[self._link].gravcomp = fraction
        self.simulation.mark_changed()
