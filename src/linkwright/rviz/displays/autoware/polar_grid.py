"""The display of Autoware's polar grid: circles around a frame, and a wave that runs outwards."""

from __future__ import annotations

import asyncio
import math
import time

import numpy as np

from linkwright.geometry.single import IDENTITY
from linkwright.page.outbox import Payload
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import FIXED_FRAME, Path, PropertySpec
from linkwright.rviz.displays.base.display import DisplayHost, ViewerDisplay
from linkwright.rviz.displays.message_drawing import read_color
from linkwright.rviz.frames.stream import make_transform_status
from linkwright.rviz.markers import MarkerStore
from linkwright.rviz.markers.shapes import make_marker

_REFERENCE = "Reference Frame"
_MAX_CIRCLES = 1000
_CORNERS = 2 * math.pi * np.arange(73) / 72
_LINE_WIDTH_M = 0.1
_WAVE_PERIOD_S = 0.1
"""Seconds between two positions of the wave: each is a message of 1 kB to every page."""


def _opacity_specs(kind: str, subject: str) -> tuple[PropertySpec, ...]:
    return tuple(
        PropertySpec(f"{end} {kind}", "float", default, f"Opacity of {subject} {place}.", minimum=0.0, maximum=1.0)
        for end, default, place in (("Max", 0.5, "at the center"), ("Min", 0.01, "at Max Range"))
    )


class PolarGridDisplay(ViewerDisplay):
    """A display of circles around a frame."""

    CLASS = "rviz_plugins/PolarGridDisplay"
    DRAWN_AS = "rviz_default_plugins/MarkerArray"
    SCHEMA = (
        PropertySpec(_REFERENCE, "frame", FIXED_FRAME, "The frame whose origin is the center of the circles."),
        PropertySpec("Delta Range", "float", 10.0, "Distance between two circles, in meters.", minimum=0.1),
        PropertySpec("Max Range", "float", 200.0, "Radius of the largest circle, in meters.", minimum=0.0),
        PropertySpec("Wave Velocity", "float", 10.0, "Velocity of the wave, in m/s.", minimum=0.0),
        PropertySpec("Color", "color", "#ffffff", "Color of the circles."),
        PropertySpec("Wave Color", "color", "#ffffff", "Color of the wave."),
        *_opacity_specs("Alpha", "the circles"),
        *_opacity_specs("Wave Alpha", "the wave"),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._store = MarkerStore(identity)
        self._wave_timer: asyncio.TimerHandle | None = None

    def start(self) -> None:
        """Draw the circles, and start the wave."""
        self._draw()

    def stop(self) -> None:
        """Stop the wave."""
        self._cancel_wave()

    def on_property_changed(self, path: Path) -> None:  # every property changes the circles
        """Draw the circles again."""
        self._draw()

    def on_enabled_changed(self) -> None:
        """Draw or remove the circles."""
        self._draw()

    def on_frames_changed(self) -> None:
        """Show in the status whether the frame's pose is known."""
        self.set_status([make_transform_status(self.host.frames, self.properties.text(_REFERENCE))])

    def data(self) -> list[Payload]:
        """Return the store, from which the circles are packed."""
        return [self._store]

    def _draw(self) -> None:
        self._store.clear()
        if self.enabled:
            distance, maximum = self.properties.number("Delta Range"), self.properties.number("Max Range")
            for number in range(1, min(int(maximum / distance + 1e-9), _MAX_CIRCLES) + 1):
                self._put_circle("circles", str(number), number * distance, "Color", "Alpha")
        self._move_wave()
        self.on_frames_changed()

    def _move_wave(self) -> None:
        """Draw the wave where it is now, and move it again later."""
        self._cancel_wave()
        velocity, maximum = self.properties.number("Wave Velocity"), self.properties.number("Max Range")
        if self.enabled and velocity > 0 and maximum > 0 and self.properties.number("Max Wave Alpha") > 0:
            radius = time.monotonic() * velocity % maximum
            self._put_circle("wave", "0", radius, "Wave Color", "Wave Alpha")
            self._wave_timer = asyncio.get_running_loop().call_later(_WAVE_PERIOD_S, self._move_wave)
        self.pages.send_data(self._store.key, self._store)

    def _cancel_wave(self) -> None:
        if self._wave_timer is not None:
            self._wave_timer.cancel()
            self._wave_timer = None

    def _put_circle(self, namespace: str, name: str, radius: float, color: str, opacity: str) -> None:
        share = radius / max(self.properties.number("Max Range"), 1e-9)
        maximum, minimum = self.properties.number(f"Max {opacity}"), self.properties.number(f"Min {opacity}")
        rgba = read_color(self.properties.text(color), maximum + share * (minimum - maximum))
        ring = np.stack([np.cos(_CORNERS), np.sin(_CORNERS), np.zeros(len(_CORNERS))], axis=1)
        points = (radius * ring).astype(np.float32)
        scale = (_LINE_WIDTH_M, 0.0, 0.0)
        self._store.put(
            make_marker(namespace, name, "line_strip", IDENTITY, scale, rgba, frame=self._frame(), points=points)
        )

    def _frame(self) -> str:
        frame = self.properties.text(_REFERENCE)
        return "" if frame == FIXED_FRAME else frame
