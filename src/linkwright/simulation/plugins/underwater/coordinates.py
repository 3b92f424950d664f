"""Services for positions on earth: ``libuuv_sc_ros_interface_plugin.so``.

They convert between positions in the world and latitude, longitude and altitude, and read and set the origin.

Source: uuv_simulator (services). A new origin changes the services only, not the sensors of the world.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.earth import Globe

_SERVICES = "uuv_world_ros_plugins_msgs/srv"


class SphericalInterface(SimulatedPlugin[NoParameters]):
    """The substitute for ``libuuv_sc_ros_interface_plugin.so``."""

    CARRIED = ("_coordinates",)

    def start(self) -> None:
        """Offer the services."""
        self.reset()
        for srv_type, name, callback in (
            ("GetOriginSphericalCoord", "get_origin_spherical_coordinates", self._get_origin),
            ("SetOriginSphericalCoord", "set_origin_spherical_coordinates", self._set_origin),
            ("TransformToSphericalCoord", "transform_to_spherical_coordinates", self._to_spherical),
            ("TransformFromSphericalCoord", "transform_from_spherical_coordinates", self._from_spherical),
        ):
            self.node.service(f"{_SERVICES}/{srv_type}", f"/gazebo/{name}", callback)

    def reset(self) -> None:
        """Restore the origin of the world."""
        self._coordinates = self.context.world.spherical_coordinates or SphericalCoordinates()

    def _get_origin(self, _: Any, response: Any) -> Any:
        coordinates = self._coordinates
        response.latitude_deg, response.longitude_deg = coordinates.latitude_deg, coordinates.longitude_deg
        response.altitude = coordinates.elevation
        return response

    def _set_origin(self, request: Any, response: Any) -> Any:
        self._coordinates = replace(
            self._coordinates,
            latitude_deg=request.latitude_deg,
            longitude_deg=request.longitude_deg,
            elevation=request.altitude,
        )
        response.success = True
        return response

    def _to_spherical(self, request: Any, response: Any) -> Any:
        point = np.array((request.input.x, request.input.y, request.input.z))
        response.latitude_deg, response.longitude_deg, response.altitude = Globe(self._coordinates).to_geodetic(point)
        return response

    def _from_spherical(self, request: Any, response: Any) -> Any:
        point = Globe(self._coordinates).from_geodetic(request.latitude_deg, request.longitude_deg, request.altitude)
        response.output.x, response.output.y, response.output.z = point.tolist()
        return response
