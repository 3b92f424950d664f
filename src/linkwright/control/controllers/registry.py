"""The registry of controller classes by type name.

The classes are entry points of the group ``linkwright.controllers``.

The type name ``diff_drive_controller/DiffDriveController``, for example, belongs to a subclass of `Controller`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import extensions

if TYPE_CHECKING:
    from linkwright.control.controllers.controller import Controller

GROUP = "linkwright.controllers"

_REPLACEMENTS = {
    "force_torque_sensor_controller/ForceTorqueSensorController": (
        "force_torque_sensor_broadcaster/ForceTorqueSensorBroadcaster"
    ),
    "four_wheel_steering_controller/FourWheelSteeringController": (
        "ackermann_steering_controller/AckermannSteeringController"
    ),
    "imu_sensor_controller/ImuSensorController": "imu_sensor_broadcaster/IMUSensorBroadcaster",
}
"""For each controller of ROS 1 with other parameters in ROS 2, the type that replaces it."""


def controller_types() -> list[str]:
    """Return the type names of all installed controllers."""
    return list(extensions(GROUP))


def controller_class(type_name: str) -> type[Controller[Any]]:
    """Return the controller class with a type name.

    Raises:
        LinkwrightError: CTL103, no controller has this type name; CTL104, the package that provides it cannot be
            imported.
    """
    entry = extensions(GROUP).get(type_name)
    if entry is None:
        message = phrase("no installed package provides a controller of type '{name}'", name=type_name)
        hint = did_you_mean(type_name, controller_types())
        if type_name in _REPLACEMENTS:
            hint = phrase("use {type}, which replaces this type of ROS 1", type=_REPLACEMENTS[type_name])
        raise LinkwrightError(Diagnostic("CTL103", message, hint=hint))
    message = phrase("the controller '{name}' cannot be imported", name=type_name)
    loaded_class: type[Controller[Any]] = load_extension(entry, "CTL104", message)
    return loaded_class
