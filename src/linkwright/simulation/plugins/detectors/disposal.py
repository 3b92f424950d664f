"""Models that a link touches are taken away: ``libObjectDisposalPlugin.so``.

Source: ARIAC (parameters, defaults, the condition for a model).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import IDENTITY
from linkwright.sdf.frames import transform_of
from linkwright.sdf.poses import POSE, SEPARATOR
from linkwright.sdf.reader import read_element
from linkwright.sdf.report import SdfReport
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.contact import ContactSensor
from linkwright.simulation.sensors.mount import Mount


@dataclass(frozen=True, kw_only=True)
class DisposalParameters:
    """Parameters of ``libObjectDisposalPlugin.so``; an update rate of 0 means after each step."""

    contact_sensor_name: str = parameter()
    update_rate: float = 0.0
    center_of_gravity_check: bool = False


class ObjectDisposal(SimulatedPlugin[DisposalParameters]):
    """The substitute for ``libObjectDisposalPlugin.so``.

    A model that touches the collision of a contact sensor is moved to a pose in the world. With the check, only a model
    whose center of mass is above or below the link is moved.
    """

    PARAMETERS = DisposalParameters
    IGNORED = ("disposal_pose", "contact_side_normal")

    def start(self) -> None:
        """Find the contact sensor, and read the pose.

        Raises:
            LinkwrightError: SIM160, the sensor or the pose is missing.
        """
        element = self.context.element
        pose_element = None if element is None else element.first("disposal_pose")
        if pose_element is None:
            message = phrase("plugin '{plugin}' needs a <disposal_pose>", plugin=self.context.name)
            raise self.parameter_error(message)
        self._pose = transform_of(read_element(pose_element, POSE, SdfReport()).pose)
        model, name = self.context.model, self.parameters.contact_sensor_name
        found = [
            (link.name, sensor.contact)
            for link in (() if model is None else model.links)
            for sensor in link.sensors
            if sensor.name == name and sensor.type == "contact"
        ]
        if not found:
            message = phrase(
                "plugin '{plugin}': there is no contact sensor '{name}'", plugin=self.context.name, name=name
            )
            raise self.parameter_error(message)
        link_name, contact = found[0]
        self._link = self.link(link_name)
        collisions = [] if contact is None or contact.collision == "__default__" else [contact.collision]
        self._contacts = ContactSensor(Mount(self.simulation, self._link, IDENTITY), collisions)
        self.every(self.parameters.update_rate, self._dispose)

    def _dispose(self) -> None:
        simulation = self.simulation
        others = {contact.collision2.partition(SEPARATOR)[0] for contact in self._contacts.measure()}
        for name in sorted(others & simulation.scene.models.keys()):
            if simulation.moves_freely(name) and (
                not self.parameters.center_of_gravity_check or self._is_above_or_below(name)
            ):
                simulation.set_model_pose(name, self._pose)

    def _is_above_or_below(self, name: str) -> bool:
        """Return whether the center of mass of a model is in the box around the link, at any height."""
        model, data = self.simulation.model, self.simulation.data
        bodies = [self.simulation.body(link.link.name) for link in self.simulation.scene.models[name].structure.links]
        masses = model.body_mass[bodies]
        center = masses @ data.xipos[bodies] / (masses.sum() or 1.0)
        low, high = self._find_box()
        return bool(((low <= center[:2]) & (center[:2] <= high)).all())

    def _find_box(self) -> tuple[Array, Array]:
        """Return the corners of the box around the collisions of the link, x and y in m."""
        model, data = self.simulation.model, self.simulation.data
        geoms = np.nonzero(model.geom_bodyid == self.simulation.body(self._link))[0]
        rotations = data.geom_xmat[geoms].reshape(-1, 3, 3)
        centers = data.geom_xpos[geoms] + np.einsum("gij,gj->gi", rotations, model.geom_aabb[geoms, :3])
        halves = np.einsum("gij,gj->gi", np.abs(rotations), model.geom_aabb[geoms, 3:])
        return (centers - halves).min(axis=0)[:2], (centers + halves).max(axis=0)[:2]
