"""Lookup of the classes that simulate plugins and sensors, through entry points.

There are two groups of entry points, in this package and in others. Each entry point names a subclass of
`linkwright.simulation.plugins.plugin.SimulatedPlugin`:

``linkwright.simulated_plugins``
    by library, in the form of `library_name`: ``gazebo_ros_diff_drive``, ``gz-sim-diff-drive-system``.

``linkwright.simulated_sensors``
    by type of sensor (``gpu_lidar``), for sensors that have no publishing plugin, such as the sensors of gz.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from linkwright.diagnostics import phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import EntryPoint, extensions
from linkwright.sdf.figures import ACTOR_COLLISIONS_LIBRARY
from linkwright.sdf.plugins import Plugin, library_name

if TYPE_CHECKING:
    from linkwright.simulation.plugins.plugin import PluginClass

PLUGIN_GROUP, SENSOR_GROUP = "linkwright.simulated_plugins", "linkwright.simulated_sensors"

_SENSORS_BY_SYSTEM = {
    "sensors": ("camera", "depth_camera", "rgbd_camera", "gpu_lidar", "segmentation", "boundingbox_camera", "thermal"),
    "imu": ("imu",),
    "contact": ("contact",),
    "navsat": ("navsat",),
    "altimeter": ("altimeter",),
    "air-pressure": ("air_pressure",),
    "air-speed": ("air_speed",),
    "magnetometer": ("magnetometer",),
    "forcetorque": ("force_torque",),
    "logical-camera": ("logical_camera",),
    "cpu-lidar": ("lidar",),
}
"""The systems of gz that publish measurements, and the types of their sensors."""
_OWN_SYSTEMS = ("physics", "user-commands", "label", "thermal", "thermal-sensor")
"""The systems of gz whose features the simulation itself provides.

These are moving, spawning and deleting models, and the labels and temperatures that cameras see.
"""
_NO_LIBRARY = ("", "__default__", "dummy", "dummyfile")
"""The values of ``filename`` that mean "no library": in generated files, and in the settings of gz for a world."""
_LIBRARIES_WITHOUT_EFFECT = (
    *("CameraPlugin", "ContactPlugin", "DepthCameraPlugin", "GpuRayPlugin", "RayPlugin", "SonarPlugin"),
)
"""Libraries of Gazebo Classic that do nothing but show how such a plugin is written."""
_BUILT_IN = frozenset(
    (
        *(f"gz-sim-{name}-system" for name in (*_OWN_SYSTEMS, *_SENSORS_BY_SYSTEM)),
        *("gazebo_ros_init", "gazebo_ros_factory", "gazebo_ros_force_system", "gazebo_ros_api_plugin"),
        ACTOR_COLLISIONS_LIBRARY,  # the scene gives such actors collisions
        "WaveVisual",  # the page draws the water from what the floating bodies publish
        "rotors_gazebo_ros_interface_plugin",  # the topics of Gazebo's transport are topics of ROS here
        *("rmagine_embree_map_gzplugin", "rmagine_optix_map_gzplugin"),  # lidars see all shapes without a map of them
        *_LIBRARIES_WITHOUT_EFFECT,
    )
)
"""Plugins of other simulators whose work the simulation does itself, so they are not reported as unsupported."""


_OTHER_GZ_LIBRARIES = frozenset(
    (
        *("AcousticPingerPlugin", "BallShooterPlugin", "LightBuoyPlugin"),
        *("AirSpeedPlugin", "GenericMotorModelPlugin", "MotorFailurePlugin", "MovingPlatformController"),
        *("PolyhedraBuoyancyDrag", "PublisherPlugin", "SimpleHydrodynamics", "Surface", "USVWind"),
        *("StationkeepingScoringPlugin", "WayfindingScoringPlugin"),
    )
)
"""Libraries for gz that are not part of gz, by name."""

_LIBRARIES_WITHOUT_NODE = frozenset(
    ("ForceVisual", "LinkPlot3DPlugin", "unitreeDrawForcePlugin", "unitreeFootContactPlugin")
)
"""Libraries for Gazebo Classic whose nodes are not named after the plugin, so that several plugins have one name."""

DEFAULT_GZ_SYSTEMS = tuple(
    Plugin(f"gz-sim-{name}-system") for name in ("physics", "user-commands", "scene-broadcaster")
)
"""The systems that gz loads for a world without plugins."""


def is_gz_library(filename: str) -> bool:
    """Return whether a library is for gz, whose plugins do not have separate nodes."""
    name = library_name(filename)
    return name.startswith("gz-sim-") or name in _OTHER_GZ_LIBRARIES


def shares_node(filename: str) -> bool:
    """Return whether the plugins of a library share the simulator's node."""
    return is_gz_library(filename) or library_name(filename) in _LIBRARIES_WITHOUT_NODE


def is_built_in(filename: str) -> bool:
    """Return whether the simulation itself does the work of a library, or no library is given."""
    return filename in _NO_LIBRARY or library_name(filename) in _BUILT_IN


def find_plugin_class(library: str) -> PluginClass | None:
    """Return the class that simulates the plugin in a library, or None if there is none.

    The library is named as `library_name` returns it.

    Raises:
        LinkwrightError: SIM136, the class cannot be imported.
    """
    return _find_class(PLUGIN_GROUP, library)


def find_sensor_class(kind: str) -> PluginClass | None:
    """Return the class that simulates a sensor type without a plugin, or None if there is none.

    Raises:
        LinkwrightError: SIM136, the class cannot be imported.
    """
    return _find_class(SENSOR_GROUP, kind)


def _find_class(group: str, name: str) -> PluginClass | None:
    entry = extensions(group).get(name)
    return None if entry is None else _load(entry)


@cache
def _load(entry: EntryPoint) -> PluginClass:
    message = phrase("the plugin '{name}' cannot be imported", name=entry.name)
    class_: PluginClass = load_extension(entry, "SIM136", message)
    return class_
