"""Displays that show frames: Axes, Grid and TF."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from linkwright.diagnostics import Phrase, foreign, phrase
from linkwright.page.protocol.configuration import PropertyChanged, StatusRow
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import (
    FIXED_FRAME,
    Path,
    PropertySpec,
    Schema,
    alpha,
    line_style_spec,
    line_width_spec,
    vector_spec,
)
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay
from linkwright.rviz.frames.stream import make_transform_status

if TYPE_CHECKING:
    from linkwright.graph.names.expressions import Expression


FRAME_TIMEOUT = "Frame Timeout"
"""The property of TF for the time after which a frame without new transforms is removed, in seconds."""

_REFERENCE = "Reference Frame"


class AxesDisplay(ViewerDisplay):
    """A display of the axes of a frame: x red, y green, z blue."""

    CLASS = "rviz_default_plugins/Axes"
    SCHEMA = (
        PropertySpec(_REFERENCE, "frame", FIXED_FRAME, "The frame whose axes are drawn."),
        PropertySpec("Length", "float", 1.0, "Length of each axis, in meters.", minimum=0.0001),
        PropertySpec("Radius", "float", 0.1, "Radius of each axis, in meters.", minimum=0.0001),
    )

    def start(self) -> None:
        """Show in the status whether the frame's pose is known."""
        self.on_frames_changed()

    def on_property_changed(self, path: Path) -> None:
        """Update the status for the newly selected frame."""
        if path == (_REFERENCE,):
            self.on_frames_changed()

    def on_frames_changed(self) -> None:
        """Show in the status whether the frame's pose is known."""
        self.set_status([make_transform_status(self.host.frames, self.properties.text(_REFERENCE))])


class GridDisplay(ViewerDisplay):
    """A display of a grid in a coordinate plane of a frame."""

    CLASS = "rviz_default_plugins/Grid"
    SCHEMA = (
        PropertySpec(_REFERENCE, "frame", FIXED_FRAME, "The frame whose origin is the center of the grid."),
        PropertySpec("Plane Cell Count", "int", 10, "Cells along each side of the grid.", minimum=1, maximum=1000),
        PropertySpec(
            "Normal Cell Count",
            "int",
            0,
            "Layers of cells along the normal of the plane; more than 0 makes a lattice.",
            minimum=0,
            maximum=100,
        ),
        PropertySpec("Cell Size", "float", 1.0, "Side of a cell, in meters.", minimum=0.0001),
        line_style_spec(line_width_spec()),
        PropertySpec("Color", "color", "#a0a0a4", "Color of the lines."),
        alpha("Opacity of the lines: 0 is invisible.", 0.5),
        PropertySpec("Plane", "enum", "XY", "The plane of the grid.", options=("XY", "XZ", "YZ")),
        vector_spec("Offset", "The center of the grid in the reference frame, in meters."),
    )

    def start(self) -> None:
        """Show in the status whether the reference frame's pose is known."""
        self.on_frames_changed()

    def on_property_changed(self, path: Path) -> None:
        """Update the status for the newly selected reference frame."""
        if path == (_REFERENCE,):
            self.on_frames_changed()

    def on_frames_changed(self) -> None:
        """Show in the status whether the reference frame's pose is known."""
        self.set_status([make_transform_status(self.host.frames, self.properties.text(_REFERENCE))])


class FrameFilter:
    """A regular expression that selects frame names.

    Args:
        text: the expression; empty for no filter.

    Attributes:
        text: the expression.
        problem: the reason why the expression is not used, for the status; None if it is used.
    """

    def __init__(self, text: str = "") -> None:
        self.text = text
        self.problem: Phrase | None = None
        self._expression: Expression | None = None  # imported below, because few users write an expression
        self._checked_names: set[str] = set()
        self._matching_names: set[str] = set()
        if text:
            from linkwright.graph.names.expressions import Expression, ExpressionError

            try:
                self._expression = Expression(text)
            except ExpressionError as error:
                self.problem = phrase("This expression is not used: {reason}", reason=foreign(error))

    @property
    def is_used(self) -> bool:
        """Whether there is a valid expression to match."""
        return self._expression is not None

    def found_in(self, names: Collection[str]) -> set[str]:
        """Return the names that contain a match of the expression.

        The set is empty if there is no valid expression, or if matching takes too long.
        """
        if self._expression is not None:
            from linkwright.graph.names.expressions import TooCostlyError

            try:
                new_matches = self._expression.found_in(name for name in names if name not in self._checked_names)
                self._matching_names = new_matches | self._matching_names.intersection(names)
                self._checked_names = set(names)
            except TooCostlyError:
                self._expression, self._matching_names = None, set()
                self.problem = phrase("This expression is not used: matching it with the frame names takes too long")
        return self._matching_names


_WHITELIST, _BLACKLIST = "Filter (whitelist)", "Filter (blacklist)"
_FIXED_PROPERTIES = (
    PropertySpec("Show Names", "bool", False, "Write each frame's name beside it."),
    PropertySpec("Show Axes", "bool", True, "Draw each frame's axes: x red, y green, z blue."),
    PropertySpec("Show Arrows", "bool", True, "Draw an arrow from each frame to its parent."),
    PropertySpec("Marker Scale", "float", 1.0, "Size of names, axes and arrows.", minimum=0.0),
    PropertySpec("Update Interval", "float", 0.0, "Seconds between updates; 0 for every frame.", minimum=0.0),
    PropertySpec(
        FRAME_TIMEOUT,
        "float",
        15.0,
        "Seconds until a frame without new transforms is removed: gray after the first third, hidden after the second.",
        minimum=1.0,
    ),
    PropertySpec(_WHITELIST, "string", "", "A regular expression: only frames in whose name it is found are shown."),
    PropertySpec(_BLACKLIST, "string", "", "A regular expression: frames in whose name it is found are not shown."),
)
_FILTERS = ((_WHITELIST,), (_BLACKLIST,))
_ALL_ENABLED = ("Frames", "All Enabled")
_MAX_TREE_DEPTH = 60
"""The maximum nesting of rows in the Tree, because JSON of a page cannot be nested to any depth."""


class TfDisplay(ViewerDisplay):
    """A display of all frames as axes, names and arrows to their parents.

    The page adds the read-only rows of RViz to each frame (parent, position, orientation), see `Property`.
    """

    CLASS = "rviz_default_plugins/TF"
    SCHEMA = _FIXED_PROPERTIES

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        self._shown_frames: tuple[str, ...] = ()
        self._parents: tuple[tuple[str, str | None], ...] = ()
        self._schema: Schema | None = None
        self._whitelist = FrameFilter()
        self._blacklist = FrameFilter()
        super().__init__(host, identity, config)

    def schema(self) -> Schema:
        """Return the fixed properties, a check box for each frame, and the tree of frames."""
        if self._schema is None:
            self._schema = (*self.SCHEMA, self._make_frames_spec(), self._make_tree_spec())
        return self._schema

    def start(self) -> None:
        """Show the current frames."""
        self.on_frames_changed()

    def on_property_changed(self, path: Path) -> None:
        """Apply a new filter, a new frame timeout, or the check box of one frame or of all frames."""
        if path in _FILTERS:
            self.on_frames_changed()
        elif path == (FRAME_TIMEOUT,):
            self.host.on_fading_changed()
        elif path == _ALL_ENABLED:
            value = self.properties.flag(*_ALL_ENABLED)
            for name in self._check_box_names():
                self.properties.set(("Frames", name), value)
            self.publish_properties()
        elif path[0] == "Frames" and not self.properties.flag(*path) and self.properties.flag(*_ALL_ENABLED):
            self.properties.set(_ALL_ENABLED, False)
            self.pages.publish(PropertyChanged(self.property_id(_ALL_ENABLED), False))

    def on_enabled_changed(self) -> None:
        """Update the status of the frames, and notify the host.

        The host fades frames only for enabled displays.
        """
        self.host.on_fading_changed()
        super().on_enabled_changed()

    def on_frames_changed(self) -> None:
        """Update the rows of the frames if they have changed, and the status of each frame."""
        frames = self.host.frames
        shown_names = tuple(sorted(self._filter_names(set(frames.names))))
        parent_by_name = {
            name: frames.names[parent] if parent >= 0 else None
            for name, parent in zip(frames.names, frames.parents, strict=True)
        }
        parents = tuple((name, parent_by_name[name]) for name in shown_names)
        if (shown_names, parents) != (self._shown_frames, self._parents):
            self._shown_frames, self._parents, self._schema = shown_names, parents, None
            self.publish_properties()
        filters = ((_WHITELIST, self._whitelist), (_BLACKLIST, self._blacklist))
        problems = [
            StatusRow(name, "error", frame_filter.problem) for name, frame_filter in filters if frame_filter.problem
        ]
        self.set_status(problems + [self._make_frame_status(name) for name in shown_names])

    def _make_frame_status(self, name: str) -> StatusRow:
        problem = self.host.frames.find_problem(name)
        return StatusRow(name, "warn", problem) if problem else StatusRow(name, "ok", phrase("Transform OK"))

    def _filter_names(self, names: set[str]) -> set[str]:
        """Return the names that match the whitelist and do not match the blacklist.

        A filter that is empty or not valid has no effect.
        """
        whitelist, blacklist = (self.properties.text(*path) for path in _FILTERS)
        if whitelist != self._whitelist.text:
            self._whitelist = FrameFilter(whitelist)
        if blacklist != self._blacklist.text:
            self._blacklist = FrameFilter(blacklist)
        matches = self._whitelist.found_in(names)
        if self._whitelist.is_used:
            names = matches
        return names - self._blacklist.found_in(names)

    def _check_box_names(self) -> list[str]:
        return [name for name in self._shown_frames if name != _ALL_ENABLED[1]]

    def _make_frames_spec(self) -> PropertySpec:
        frame_specs = tuple(
            PropertySpec(name, "bool", True, "Draw this frame.", nested=True, details="frame")
            for name in self._check_box_names()
        )
        all_spec = PropertySpec(_ALL_ENABLED[1], "bool", True, "Enable or disable all frames.")
        return PropertySpec(
            "Frames", "group", description="The frames that tf knows.", children=(all_spec, *frame_specs)
        )

    def _make_tree_spec(self) -> PropertySpec:
        children: dict[str | None, list[str]] = {}
        shown_names = set(self._shown_frames)
        for name, parent in self._parents:
            children.setdefault(parent if parent in shown_names else None, []).append(name)
        roots = tuple(_make_tree(name, children, 1) for name in children.get(None, ()))
        return PropertySpec("Tree", "group", description="The tree of frames.", children=roots)


def _make_tree(name: str, children: dict[str | None, list[str]], depth: int) -> PropertySpec:
    names = children.get(name, [])
    if names and depth == _MAX_TREE_DEPTH:
        continuation = PropertySpec("...", "group", description="The chain continues; it is too long to be shown here.")
        return PropertySpec(name, "group", children=(continuation,))
    return PropertySpec(name, "group", children=tuple(_make_tree(child, children, depth + 1) for child in names))
