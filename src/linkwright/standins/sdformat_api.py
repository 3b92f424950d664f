"""The Python bindings of libsdformat for programs that read worlds and models.

Source: sdformat, ``python/src/sdf``. The objects are read-only views of the worlds and models that `linkwright.sdf`
reads. Functions that change them, and functions whose values are objects of ``gz.math``, are not offered; calling one
raises an error that lists the functions that are.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.packages import PackageFinder
from linkwright.packages.active import active_finder
from linkwright.xmltree.reader import read_bytes

if TYPE_CHECKING:
    from linkwright import sdf

SDF_VERSION = "1.12"
"""The newest version of the format that can be read."""
_STRING_NAME = "data-string"
"""The name of a text without a file, as in the messages of libsdformat."""


class SDFErrorsException(RuntimeError):
    """Raised when a file or text has errors.

    Attributes:
        errors: the errors, in the order of the text.
    """

    def __init__(self, errors: list[Error]) -> None:
        super().__init__("\n".join(map(str, errors)))
        self.errors = errors


class Error:
    """An error in a file or text."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        self._diagnostic = diagnostic

    def __str__(self) -> str:
        return str(LinkwrightError(self._diagnostic))

    def message(self) -> str:
        """Return the description of the error."""
        return str(self._diagnostic.message)

    def is_valid(self) -> bool:
        """Return True, because an object of this class always describes an error."""
        return True


class Sensortype(IntEnum):
    """The types of sensors."""

    NONE = 0
    ALTIMETER = 1
    CAMERA = 2
    CONTACT = 3
    DEPTH_CAMERA = 4
    FORCE_TORQUE = 5
    GPU_LIDAR = 7
    IMU = 8
    LOGICAL_CAMERA = 9
    MAGNETOMETER = 10
    MULTICAMERA = 11
    LIDAR = 12
    RFID = 13
    RFIDTAG = 14
    SONAR = 15
    WIRELESS_RECEIVER = 16
    WIRELESS_TRANSMITTER = 17
    AIR_PRESSURE = 18
    RGBD_CAMERA = 19
    THERMAL_CAMERA = 20
    NAVSAT = 21
    SEGMENTATION_CAMERA = 22
    BOUNDINGBOX_CAMERA = 23
    CUSTOM = 24
    WIDE_ANGLE_CAMERA = 25
    AIR_SPEED = 26


_OTHER_SENSOR_TYPES = {
    "boundingbox": Sensortype.BOUNDINGBOX_CAMERA,
    "depth": Sensortype.DEPTH_CAMERA,
    "gps": Sensortype.NAVSAT,
    "gpu_ray": Sensortype.GPU_LIDAR,
    "ray": Sensortype.LIDAR,
    "rgbd": Sensortype.RGBD_CAMERA,
    "segmentation": Sensortype.SEGMENTATION_CAMERA,
    "thermal": Sensortype.THERMAL_CAMERA,
    "wideanglecamera": Sensortype.WIDE_ANGLE_CAMERA,
}
"""The sensor types by their other names, which files may use (``Sensor::Load`` of sdformat)."""


class JointType(IntEnum):
    """The types of joints."""

    INVALID = 0
    BALL = 1
    CONTINUOUS = 2
    FIXED = 3
    GEARBOX = 4
    PRISMATIC = 5
    REVOLUTE = 6
    REVOLUTE2 = 7
    SCREW = 8
    UNIVERSAL = 9


class _View:
    """A read-only view of an element."""

    def __init__(self, content: Any) -> None:
        self._content = content

    def __getattr__(self, name: str) -> NoReturn:
        offered = ", ".join(sorted(attribute for attribute in dir(self) if not attribute.startswith("_")))
        raise AttributeError(
            f"sdformat: {type(self).__name__}.{name} is not available in Linkwright, which offers: {offered}",
            name=name,
            obj=self,
        )


class _NamedView(_View):
    """A view of an element with a name."""

    def name(self) -> str:
        """Return the name of the element."""
        name: str = self._content.name
        return name


class Plugin(_NamedView):
    """A library that the simulator loads."""

    def filename(self) -> str:
        """Return the file name of the library."""
        filename: str = self._content.filename
        return filename

    def __str__(self) -> str:
        from linkwright.xmltree import Element, write_element

        element = Element("plugin", {"name": self._content.name, "filename": self._content.filename})
        if self._content.element is not None:
            element.children = self._content.element.children
        return write_element(element)

    __repr__ = __str__


class _PluginOwner(_NamedView):
    """A view of an element with plugins."""

    def plugins(self) -> list[Plugin]:
        """Return the plugins of the element."""
        return [Plugin(plugin) for plugin in self._content.plugins]


def _with_children(**classes: type[_View]) -> Callable[[type[_View]], type[_View]]:
    """Return a decorator that adds the functions for each kind of child.

    For the kind ``link`` they are ``link_count()``, ``link_by_index(index)``, ``link_by_name(name)`` and
    ``link_name_exists(name)``. Without such a child, the result is None. The children are direct ones.
    """

    def add_functions(cls: type[_View]) -> type[_View]:
        for kind, child_class in classes.items():
            _add_functions_of_kind(cls, kind, child_class)
        return cls

    return add_functions


def _add_functions_of_kind(cls: type[_View], kind: str, child_class: type[_View]) -> None:
    def count(self: _View) -> int:
        return len(getattr(self._content, f"{kind}s"))

    def by_index(self: _View, index: int) -> _View | None:
        children = getattr(self._content, f"{kind}s")
        return child_class(children[index]) if 0 <= index < len(children) else None

    def by_name(self: _View, name: str) -> _View | None:
        children = getattr(self._content, f"{kind}s")
        return next((child_class(child) for child in children if child.name == name), None)

    def name_exists(self: _View, name: str) -> bool:
        return any(child.name == name for child in getattr(self._content, f"{kind}s"))

    for function in (count, by_index, by_name, name_exists):
        setattr(cls, f"{kind}_{function.__name__}", function)


class Sensor(_PluginOwner):
    """A sensor of a link or joint."""

    def type(self) -> Sensortype:
        """Return the type; `Sensortype.NONE` for an unknown type."""
        name = self._content.type
        return _OTHER_SENSOR_TYPES.get(name) or Sensortype.__members__.get(name.upper(), Sensortype.NONE)

    def type_str(self) -> str:
        """Return the name of the type, such as ``gpu_lidar``."""
        return self.type().name.lower()

    def topic(self) -> str:
        """Return the topic of the measurements, or an empty string for the default topic."""
        topic: str = self._content.topic
        return topic

    def frame_id(self) -> str:
        """Return the frame of the messages, or an empty string for the default frame."""
        frame: str = self._content.frame_id
        return frame

    def update_rate(self) -> float:
        """Return the measurements per second, or 0 for one per step."""
        rate: float = self._content.update_rate
        return rate


class Frame(_NamedView):
    """A frame of a model or world."""

    def attached_to(self) -> str:
        """Return the name of the element with which the frame moves."""
        name: str = self._content.attached_to
        return name


class Light(_NamedView):
    """A light of a world or link."""


class Visual(_NamedView):
    """A shape of a link that is rendered."""


class Collision(_NamedView):
    """A shape of a link that collides."""


@_with_children(sensor=Sensor)
class Joint(_NamedView):
    """A joint of a model or world."""

    def type(self) -> JointType:
        """Return the type; `JointType.INVALID` for an unknown type."""
        return JointType.__members__.get(self._content.type.upper(), JointType.INVALID)

    def parent_name(self) -> str:
        """Return the name of the parent link or frame."""
        name: str = self._content.parent
        return name

    def child_name(self) -> str:
        """Return the name of the child link or frame."""
        name: str = self._content.child
        return name


@_with_children(visual=Visual, collision=Collision, light=Light, sensor=Sensor)
class Link(_NamedView):
    """A rigid body of a model."""

    def enable_gravity(self) -> bool:
        """Return whether gravity acts on the link."""
        enabled: bool = self._content.gravity
        return enabled

    def kinematic(self) -> bool:
        """Return whether the link moves without reacting to forces."""
        kinematic: bool = self._content.kinematic
        return kinematic


class Model(_PluginOwner):
    """A model of links, joints and nested models."""

    def static(self) -> bool:
        """Return whether the model never moves."""
        static: bool = self._content.static
        return static

    def self_collide(self) -> bool:
        """Return whether the links of the model collide with each other."""
        collides: bool = self._content.self_collide
        return collides

    def canonical_link_name(self) -> str:
        """Return the name of the canonical link, or an empty string for the first link."""
        name: str = self._content.canonical_link
        return name


_with_children(link=Link, joint=Joint, frame=Frame, model=Model)(Model)


@_with_children(model=Model, frame=Frame, joint=Joint, light=Light)
class World(_PluginOwner):
    """A world of models."""


class Root(_View):
    """The content of a file or text: worlds, or a single model or light."""

    def __init__(self) -> None:
        super().__init__(None)

    def load(self, filename: str) -> None:
        """Read a file in SDF or URDF. The includes are replaced by the included models.

        Raises:
            SDFErrorsException: the file cannot be read or has errors.
        """
        self._load(lambda: read_bytes(filename), Path(filename).absolute())

    def load_sdf_string(self, sdf: str) -> None:
        """Read a text in SDF or URDF. The includes are replaced by the included models.

        Raises:
            SDFErrorsException: the text has errors.
        """
        self._load(lambda: sdf, Path.cwd() / _STRING_NAME)

    def _load(self, get_text: Callable[[], str | bytes], path: Path) -> None:
        try:
            self._content, diagnostics = _read(get_text(), path)
        except LinkwrightError as error:
            raise SDFErrorsException([Error(diagnostic) for diagnostic in error.diagnostics]) from error
        errors = [Error(diagnostic) for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR]
        if errors:
            raise SDFErrorsException(errors)

    def version(self) -> str:
        """Return the SDF version of the file, or an empty string before a file is read."""
        return "" if self._content is None else self._content.version

    def model(self) -> Model | None:
        """Return the model of a file without a world, or None."""
        models = () if self._content is None else self._content.models
        return Model(models[0]) if models else None

    def light(self) -> Light | None:
        """Return the light of a file without a world, or None."""
        lights = () if self._content is None else self._content.lights
        return Light(lights[0]) if lights else None

    def world_count(self) -> int:
        """Return the number of worlds."""
        return 0 if self._content is None else len(self._content.worlds)

    def world_by_index(self, index: int) -> World | None:
        """Return a world, or None if there are fewer worlds."""
        return World(self._content.worlds[index]) if 0 <= index < self.world_count() else None

    def world_name_exists(self, name: str) -> bool:
        """Return whether there is a world with a name."""
        return self._content is not None and any(world.name == name for world in self._content.worlds)


def _read(text: str | bytes, path: Path) -> tuple[sdf.worlds.Sdf | None, list[Diagnostic]]:
    """Return the content of a text in SDF or URDF, and the findings.

    Raises:
        LinkwrightError: the text is not XML.
    """
    from linkwright.sdf.from_urdf import model_from_robot
    from linkwright.sdf.includes import resolve_includes
    from linkwright.sdf.reader import read
    from linkwright.sdf.resources import ResourceFinder
    from linkwright.sdf.text import parse_as_gazebo
    from linkwright.sdf.worlds import Sdf
    from linkwright.urdf.reader import read as read_robot

    document, _ = parse_as_gazebo(text, path.name)
    if document.root.tag == "robot":
        robot_reading = read_robot(document)
        if robot_reading.robot is None or not robot_reading.robot.root:
            return None, list(robot_reading.diagnostics)
        conversion = model_from_robot(robot_reading.robot, lump_fixed_joints=True)
        return Sdf(SDF_VERSION, models=(conversion.model,)), list(robot_reading.diagnostics)
    reading = read(document)
    if reading.sdf is None:
        return None, list(reading.diagnostics)
    packages = active_finder() or PackageFinder(start=[Path.cwd()])
    included = resolve_includes(reading.sdf, path, ResourceFinder(packages))
    return included.sdf, [*reading.diagnostics, *included.diagnostics]
