"""The displays of the objects that Autoware detects, tracks and predicts."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from linkwright.messages import get_message
from linkwright.rviz.config.schema import PropertySpec, Schema, alpha, topic_spec
from linkwright.rviz.displays.autoware.object_shapes import ObjectDrawing, Style
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import Rgba, read_color

_Classification = get_message("autoware_perception_msgs/msg/ObjectClassification")
_ORIENTATION_AVAILABLE = get_message("autoware_perception_msgs/msg/TrackedObjectKinematics").AVAILABLE
_CLASSES = {
    _Classification.UNKNOWN: ("UNKNOWN", "#ffffff"),
    _Classification.CAR: ("CAR", "#1e90ff"),
    _Classification.BUS: ("BUS", "#1e90ff"),
    _Classification.PEDESTRIAN: ("PEDESTRIAN", "#ffc0cb"),
    _Classification.ANIMAL: ("ANIMAL", "#ff69b4"),
    _Classification.HAZARD: ("HAZARD", "#ff4500"),
    _Classification.BICYCLE: ("CYCLIST", "#770b20"),
    _Classification.MOTORCYCLE: ("MOTORCYCLE", "#770b20"),
    _Classification.TRAILER: ("TRAILER", "#1e90ff"),
    _Classification.TRUCK: ("TRUCK", "#1e90ff"),
}
_PATH_COLORS = ("#ff0000", "#00ff00", "#0000ff", "#ffff00", "#00ffff", "#ff00ff", "#ff8000", "#8000ff", "#00ff80")
_COLOR, _PER_CLASS, _LINE_WIDTH, _DYNAMIC = "Color", "Per Class Color", "Line Width", "Dynamic Status"


def _flags(name: str, *rows: tuple[str, bool, str], extra: Schema = ()) -> PropertySpec:
    children = tuple(PropertySpec(row, "bool", shown, description) for row, shown, description in rows)
    return PropertySpec(name, "group", children=(*children, *extra))


_SCHEMA: Schema = (
    PropertySpec(_LINE_WIDTH, "float", 0.03, "Width of all lines, in meters.", minimum=0.0),
    PropertySpec(_COLOR, "color", "#ffffff", "Color of all objects without Per Class Color."),
    PropertySpec(
        _PER_CLASS,
        "bool",
        False,
        "Use a color for each class.",
        children=tuple(PropertySpec(name, "color", color, "Color of this class.") for name, color in _CLASSES.values()),
    ),
    alpha("Opacity of the objects.", 0.999),
    _flags(
        "Shape",
        ("BBox Footprint", False, "Also draw the footprint of boxes, if the message has one."),
        extra=(
            PropertySpec(
                "Shape Type",
                "enum",
                "Skeleton 3D",
                "Whether shapes are drawn as edges, as outlines on the ground, or filled.",
                options=("Skeleton 3D", "Skeleton 2D", "Fill", "None"),
            ),
        ),
    ),
    _flags(
        "Text",
        ("Label", True, "Write the most likely class."),
        ("UUID", True, "Write the start of the ID."),
        ("Velocity", False, "Write the velocity, in km/h."),
        ("Acceleration", False, "Write the acceleration, in m/s²."),
        ("Existence Probability", False, "Write the probability that the object exists."),
    ),
    _flags(
        "Path",
        ("Predicted Path", True, "Draw the predicted paths."),
        ("Path Confidence", True, "Write the probability of each predicted path."),
        ("Path Footprint", False, "Draw the outline of the object along its predicted paths."),
        extra=(
            PropertySpec(
                "Path Resolution",
                "enum",
                "Normal",
                "Simple draws every other point of predicted paths.",
                options=("Normal", "Simple"),
            ),
        ),
    ),
    _flags(
        "Vector",
        ("Twist", True, "Draw the velocity as a line."),
        ("Yaw Rate", False, "Draw the angle that the object turns in a second."),
    ),
    _flags(
        "Covariance",
        ("Pose", True, "Draw the uncertainty of the position."),
        ("Yaw", False, "Draw the uncertainty of the heading."),
        ("Twist", False, "Draw the uncertainty of the velocity."),
        ("Yaw Rate", False, "Draw the uncertainty of the yaw rate."),
        extra=(
            PropertySpec(
                "Confidence Interval",
                "enum",
                "95%",
                "The probability that the value is within the drawn region.",
                options=("70%", "85%", "95%", "99%"),
            ),
        ),
    ),
)


@dataclass(frozen=True, slots=True)
class ObjectState:
    """The common properties of the three kinds of objects.

    Attributes:
        pose: the geometry_msgs/msg/PoseWithCovariance.
        twist: the geometry_msgs/msg/TwistWithCovariance.
        acceleration: the geometry_msgs/msg/AccelWithCovariance, or None.
        identity: the hexadecimal ID, or an empty string.
        paths: the predicted paths.
        has_heading: whether the front of the object is known.
    """

    pose: Any
    twist: Any
    acceleration: Any
    identity: str
    paths: Sequence[Any]
    has_heading: bool


class DetectedObjectsDisplay(MessageMarkersDisplay):
    """A display of detected objects. They are drawn until the next message."""

    CLASS = "autoware_perception_rviz_plugin/DetectedObjects"
    MESSAGE = "autoware_perception_msgs/msg/DetectedObjects"
    SCHEMA = (topic_spec(description=MESSAGE), *_SCHEMA)

    def state_of(self, each: Any) -> ObjectState:
        """Return the state of an object of the message."""
        kinematics = each.kinematics
        has_heading = kinematics.orientation_availability == _ORIENTATION_AVAILABLE
        return ObjectState(kinematics.pose_with_covariance, kinematics.twist_with_covariance, None, "", (), has_heading)

    def is_shown(self, each: Any) -> bool:  # a subclass selects
        """Return whether an object of the message is drawn."""
        return True

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the shapes, texts, paths, vectors and uncertainties that are switched on."""
        for number, each in enumerate(message.objects):
            if not self.is_shown(each):
                continue
            state = self.state_of(each)
            label, color = self._classify(each.classification)
            style = Style(color, self._path_color(state.identity), self.properties.number(_LINE_WIDTH))
            drawing = ObjectDrawing(number, state.pose, each.shape, style, has_heading=state.has_heading)
            yield from drawing.shape(
                self.properties.text("Shape", "Shape Type"), footprint=self._is_on("Shape", "BBox Footprint")
            )
            yield from self._make_texts(drawing, state, label, each.existence_probability)
            yield from self._make_paths(drawing, state)
            yield from self._make_vectors(drawing, state)

    def _make_texts(self, drawing: ObjectDrawing, state: ObjectState, label: str, probability: float) -> Iterator[Any]:
        texts = {
            "Label": (label, 0.0),
            "UUID": (state.identity[:4], -0.5),
            "Velocity": (f"{int(drawing.speed(state.twist) * 3.6)}[km/h]", -1.0),
            "Existence Probability": (f"{probability:.2f}", 0.5),
        }
        if state.acceleration is not None:
            texts["Acceleration"] = (f"{drawing.acceleration(state.acceleration):.1f}[m/s^2]", -1.5)
        for name, (text, offset) in texts.items():
            if text and self._is_on("Text", name):
                yield drawing.text(name.lower(), text, offset)

    def _make_paths(self, drawing: ObjectDrawing, state: ObjectState) -> Iterator[Any]:
        step = 2 if self.properties.text("Path", "Path Resolution") == "Simple" else 1
        for index, path in enumerate(state.paths):
            poses = path.path[::step]
            if len(poses) < 2:  # a line has two ends
                continue
            if self._is_on("Path", "Predicted Path"):
                yield drawing.path(index, poses)
            if self._is_on("Path", "Path Footprint"):
                yield drawing.path_footprint(index, poses)
            if self._is_on("Path", "Path Confidence"):
                yield drawing.path_text(index, path.path[-1], f"{path.confidence:.2f}")

    def _make_vectors(self, drawing: ObjectDrawing, state: ObjectState) -> Iterator[Any]:
        probability = float(self.properties.text("Covariance", "Confidence Interval").rstrip("%")) / 100
        if self._is_on("Vector", "Twist"):
            yield drawing.twist(state.twist)
        if self._is_on("Vector", "Yaw Rate"):
            yield drawing.yaw_rate(state.twist)
        if self._is_on("Covariance", "Pose"):
            yield from drawing.position_region(probability)
        if self._is_on("Covariance", "Yaw"):
            yield from drawing.yaw_region(probability)
        if self._is_on("Covariance", "Twist"):
            yield from drawing.twist_region(state.twist, probability)
        if self._is_on("Covariance", "Yaw Rate"):
            yield from drawing.yaw_rate_region(state.twist, probability)

    def _classify(self, classification: Sequence[Any]) -> tuple[str, Rgba]:
        """Return the name and the color of the most likely class."""
        best = max(classification, key=lambda each: each.probability, default=None)
        name, _ = _CLASSES.get(best.label if best else _Classification.UNKNOWN, _CLASSES[_Classification.UNKNOWN])
        path = (_PER_CLASS, name) if self._is_on(_PER_CLASS) else (_COLOR,)
        return name, read_color(self.properties.text(*path), self.properties.number("Alpha"))

    def _path_color(self, identity: str) -> Rgba:
        """Return a color that is the same in each message about an object."""
        return read_color(_PATH_COLORS[zlib.crc32(identity.encode()) % len(_PATH_COLORS)], 0.6)

    def _is_on(self, *path: str) -> bool:
        return self.properties.flag(*path)


class TrackedObjectsDisplay(DetectedObjectsDisplay):
    """A display of tracked objects, which have an ID and an acceleration."""

    CLASS = "autoware_perception_rviz_plugin/TrackedObjects"
    MESSAGE = "autoware_perception_msgs/msg/TrackedObjects"
    SCHEMA = (
        topic_spec(description=MESSAGE),
        PropertySpec(
            _DYNAMIC,
            "enum",
            "All",
            "Whether moving or resting objects are drawn.",
            options=("All", "Dynamic", "Static"),
        ),
        *_SCHEMA,
    )

    def state_of(self, each: Any) -> ObjectState:
        """Return the state of an object of the message."""
        kinematics = each.kinematics
        return ObjectState(
            kinematics.pose_with_covariance,
            kinematics.twist_with_covariance,
            kinematics.acceleration_with_covariance,
            bytes(each.object_id.uuid).hex(),
            (),
            kinematics.orientation_availability == _ORIENTATION_AVAILABLE,
        )

    def is_shown(self, each: Any) -> bool:
        """Return whether an object is drawn, by whether it moves."""
        wanted = self.properties.text(_DYNAMIC)
        return wanted == "All" or each.kinematics.is_stationary == (wanted == "Static")


class PredictedObjectsDisplay(DetectedObjectsDisplay):
    """A display of objects with the paths that they are expected to take."""

    CLASS = "autoware_perception_rviz_plugin/PredictedObjects"
    MESSAGE = "autoware_perception_msgs/msg/PredictedObjects"
    SCHEMA = (topic_spec(description=MESSAGE), *_SCHEMA)

    def state_of(self, each: Any) -> ObjectState:
        """Return the state of an object of the message."""
        kinematics = each.kinematics
        return ObjectState(
            kinematics.initial_pose_with_covariance,
            kinematics.initial_twist_with_covariance,
            kinematics.initial_acceleration_with_covariance,
            bytes(each.object_id.uuid).hex(),
            list(kinematics.predicted_paths),
            has_heading=True,
        )
