"""The displays of texts over the scene."""

from __future__ import annotations

import asyncio
import math
import re
from typing import Any, ClassVar

from linkwright.page.protocol.overlays import HorizontalSide, VerticalSide
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.message_drawing import Rgba, read_color
from linkwright.rviz.displays.overlays.base import POINTS_TO_PIXELS, Figure, OverlayDisplay

_TAG = re.compile(r"<br\s*/?>|<[^>]*>")
_LINE_BREAKS = ("<br", "</p")

_POSITION, _FOREGROUND, _BACKGROUND = (f"Overtake {name} Properties" for name in ("Position", "FG Color", "BG Color"))
_DELETE = 1
"""The action that removes a text."""
_SIDES: dict[int, HorizontalSide] = {0: "left", 1: "right", 2: "center"}
_HEIGHTS: dict[int, VerticalSide] = {3: "top", 4: "bottom", 2: "center"}
_HORIZONTAL: dict[str, HorizontalSide] = {side: side for side in _SIDES.values()}
_VERTICAL: dict[str, VerticalSide] = {side: side for side in _HEIGHTS.values()}


def remove_tags(text: str) -> str:
    """Return a text without the tags of HTML, which RViz reads; line breaks stay."""
    return _TAG.sub(lambda match: "\n" if match[0].startswith(_LINE_BREAKS) else "", text)


def _pixels(name: str, default: int, description: str, **options: Any) -> PropertySpec:
    return PropertySpec(name, "int", default, f"{description}, in pixels.", **options)


def _opacity(name: str, description: str) -> PropertySpec:
    return PropertySpec(name, "float", 0.8, description, minimum=0.0, maximum=1.0)


_SWITCHES: Schema = (
    PropertySpec(_POSITION, "bool", False, "Use the place and the size below instead of those of the messages."),
    PropertySpec(_FOREGROUND, "bool", False, "Use the color below instead of that of the messages."),
    PropertySpec(_BACKGROUND, "bool", False, "Use the background below instead of that of the messages."),
    PropertySpec("Align Bottom", "bool", False, "Write the text at the lower edge."),
)

_SIZE_AND_COLORS: Schema = (
    _pixels("width", 128, "Width", minimum=0, when=((_POSITION,), True)),
    _pixels("height", 128, "Height", minimum=0, when=((_POSITION,), True)),
    PropertySpec("text size", "int", 12, "Size of the text, in points.", minimum=0, when=((_POSITION,), True)),
    PropertySpec("Foreground Color", "color", "#19fff0", "Color of the text.", when=((_FOREGROUND,), True)),
    _opacity("Foreground Alpha", "Opacity of the text."),
    PropertySpec("Background Color", "color", "#000000", "Color of the background.", when=((_BACKGROUND,), True)),
    _opacity("Background Alpha", "Opacity of the background."),
)

_ALIGNED_PLACE: Schema = (
    _pixels("hor_dist", 0, "Distance from the side, or from the middle", when=((_POSITION,), True)),
    _pixels("ver_dist", 0, "Distance from the upper or lower edge, or from the middle", when=((_POSITION,), True)),
    PropertySpec(
        "hor_alignment",
        "enum",
        "left",
        "The side of the window.",
        options=tuple(_HORIZONTAL),
        when=((_POSITION,), True),
    ),
    PropertySpec(
        "ver_alignment",
        "enum",
        "top",
        "The upper or lower edge of the window.",
        options=tuple(_VERTICAL),
        when=((_POSITION,), True),
    ),
)


class TextOverlayDisplay(OverlayDisplay):
    """A display of texts, whose messages have a place, a size and colors."""

    CLASS = "rviz_2d_overlay_plugins/TextOverlay"
    MESSAGE = "rviz_2d_overlay_msgs/msg/OverlayText"
    SCHEMA: ClassVar[Schema] = (topic_spec(description=MESSAGE), *_SWITCHES, *_ALIGNED_PLACE, *_SIZE_AND_COLORS)

    def figure(self, message: Any) -> Figure | None:
        """Return the text on its background."""
        if message.action == _DELETE:
            return None
        figure, height = self._place(message)
        figure.background = choose_color(self.properties, message.bg_color, _BACKGROUND, "Background")
        color = choose_color(self.properties, message.fg_color, _FOREGROUND, "Foreground")
        is_above = self.properties.flag("Align Bottom")
        y = figure.height if is_above else 0
        figure.add_text(remove_tags(message.text), 0, y, height, color, wrap=figure.width, is_above=is_above)
        return figure

    def _place(self, message: Any) -> tuple[Figure, float]:
        """Return an empty figure, and the height of its text."""
        number = self.properties.number
        if self.properties.flag(_POSITION):
            figure = self.own_place(number("width"), number("height"))
            return figure, number("text size") * POINTS_TO_PIXELS
        return self.place_of(message), message.text_size * POINTS_TO_PIXELS

    def own_place(self, width: float, height: float) -> Figure:
        """Return an empty figure at the place of the properties."""
        number, text = self.properties.number, self.properties.text
        sides = _HORIZONTAL[text("hor_alignment")], _VERTICAL[text("ver_alignment")]
        return Figure(number("hor_dist"), number("ver_dist"), width, height, *sides)

    def place_of(self, message: Any) -> Figure:
        """Return an empty figure at the place of a message."""
        return Figure(
            message.horizontal_distance,
            message.vertical_distance,
            message.width,
            message.height,
            _SIDES.get(message.horizontal_alignment, "left"),
            _HEIGHTS.get(message.vertical_alignment, "top"),
        )


def choose_color(properties: PropertyStore, written: Any, switch: str, name: str) -> Rgba:
    """Return the color of the properties if a switch is on, otherwise that of a message."""
    if properties.flag(switch):
        return read_color(properties.text(f"{name} Color"), properties.number(f"{name} Alpha"))
    return written.r, written.g, written.b, written.a


class JskOverlayTextDisplay(TextOverlayDisplay):
    """A display of texts of an older package, whose places are distances from the upper left corner."""

    CLASS = "jsk_rviz_plugin/OverlayText"
    MESSAGE = "jsk_rviz_plugins/msg/OverlayText"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        *_SWITCHES,
        _pixels("top", 0, "Distance from the upper edge", minimum=0, when=((_POSITION,), True)),
        _pixels("left", 0, "Distance from the left edge", minimum=0, when=((_POSITION,), True)),
        *_SIZE_AND_COLORS,
    )

    def own_place(self, width: float, height: float) -> Figure:
        """Return an empty figure at the place of the properties."""
        return Figure(self.properties.number("left"), self.properties.number("top"), width, height)

    def place_of(self, message: Any) -> Figure:
        """Return an empty figure at the place of a message."""
        return Figure(message.left, message.top, message.width, message.height)


_CENTERED = "keep centered"
_MENU_SIZE = 20 * POINTS_TO_PIXELS
_MENU_LINE = 1.25 * _MENU_SIZE
_MENU_PADDING_X, _MENU_PADDING_Y, _MENU_GAP = 100, 30, 5
_LETTER_WIDTH = 0.55
"""The mean width of a letter, as a multiple of the height of the text."""


class OverlayMenuDisplay(OverlayDisplay):
    """A display of a menu, with a mark beside the current entry."""

    CLASS = "jsk_rviz_plugin/OverlayMenu"
    MESSAGE = "jsk_rviz_plugins/msg/OverlayMenu"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        _pixels("left", 128, "Distance from the left edge", minimum=0, when=((_CENTERED,), False)),
        _pixels("top", 128, "Distance from the upper edge", minimum=0, when=((_CENTERED,), False)),
        PropertySpec(_CENTERED, "bool", True, "Show the menu in the middle of the window."),
        PropertySpec(_FOREGROUND, "bool", True, "Use the color below instead of that of the messages."),
        PropertySpec(_BACKGROUND, "bool", True, "Use the background below instead of that of the messages."),
        PropertySpec("Foreground Color", "color", "#19fff0", "Color of the texts.", when=((_FOREGROUND,), True)),
        PropertySpec("Foreground Alpha", "float", 1.0, "Opacity of the texts.", minimum=0.0, maximum=1.0),
        PropertySpec("Background Color", "color", "#000000", "Color of the background.", when=((_BACKGROUND,), True)),
        PropertySpec("Background Alpha", "float", 0.5, "Opacity of the background.", minimum=0.0, maximum=1.0),
    )

    def figure(self, message: Any) -> Figure | None:
        """Return the title, and below it the entries of the menu."""
        if message.action == message.ACTION_CLOSE:
            return None
        lines = [message.title, *message.menus]
        width = max(map(len, lines)) * _LETTER_WIDTH * _MENU_SIZE + 2 * _MENU_PADDING_X
        height = (_MENU_LINE + _MENU_GAP) * len(lines) + 2 * _MENU_PADDING_Y
        if self.properties.flag(_CENTERED):
            figure = Figure(0, 0, width, height, "center", "center")
        else:
            figure = Figure(self.properties.number("left"), self.properties.number("top"), width, height)
        figure.background = choose_color(self.properties, message.bg_color, _BACKGROUND, "Background")
        color = choose_color(self.properties, message.fg_color, _FOREGROUND, "Foreground")
        figure.add_text(message.title, _MENU_PADDING_X, _MENU_GAP, _MENU_SIZE, color)
        underline = _MENU_GAP + _MENU_LINE
        figure.add_line([(_MENU_PADDING_X / 2, underline), (width - _MENU_PADDING_X / 2, underline)], 1, color)
        for index, entry in enumerate(message.menus):
            y = _MENU_PADDING_Y + (_MENU_LINE + _MENU_GAP) * (index + 1)
            figure.add_text(entry, _MENU_PADDING_X, y, _MENU_SIZE, color)
            if index == message.current_index:
                x, middle, size = _MENU_PADDING_X / 2, y + _MENU_SIZE / 2, _MENU_SIZE / 2
                figure.add_area([(x, middle - size), (x + size, middle), (x, middle + size)], color)
        return figure


_FADE_PERIOD_S = 0.1


class StringStampedOverlayDisplay(OverlayDisplay):
    """A display of texts, which stay for a time and fade when an empty one follows."""

    CLASS = "autoware_string_stamped_rviz_plugin/StringStampedOverlayDisplay"
    MESSAGE = "autoware_internal_debug_msgs/msg/StringStamped"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE),
        PropertySpec("Text Color", "color", "#19fff0", "Color of the text."),
        _pixels("Left", 1024, "Distance from the left edge", minimum=0),
        _pixels("Top", 128, "Distance from the upper edge", minimum=0),
        _pixels("Value height offset", 0, "Distance of the text from the upper edge of the figure"),
        _pixels("Font Size", 15, "Height of the text", minimum=1),
        PropertySpec("Max Letter Num", "int", 100, "The number of letters for which there is room.", minimum=10),
        PropertySpec("Time To Keep Last Diag", "float", 1.0, "Seconds that the last text stays.", minimum=0.0),
        PropertySpec("Time To Erase Last Diag", "float", 2.0, "Seconds in which it fades then.", minimum=0.001),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._shown_text = ""
        self._emptied_s: float | None = None
        self._fade_timer: asyncio.TimerHandle | None = None

    def stop(self) -> None:
        """Unsubscribe, and stop fading."""
        self._cancel_fading()
        super().stop()

    def reset(self) -> None:
        """Discard the text."""
        self._cancel_fading()
        self._shown_text = ""
        super().reset()

    def figure(self, message: Any) -> Figure | None:
        """Return the text of a message, or the last text while it fades."""
        now_s = asyncio.get_running_loop().time()
        if message.data:
            self._cancel_fading()
            self._shown_text = message.data
        elif self._emptied_s is None:
            self._emptied_s = now_s
        opacity = 1.0
        if self._emptied_s is not None:
            keep_s = self.properties.number("Time To Keep Last Diag")
            erase_s = self.properties.number("Time To Erase Last Diag")
            opacity = min(1.0, 1.0 - (now_s - self._emptied_s - keep_s) / erase_s)
            self._schedule_fading(opacity)
        if opacity <= 0 or not self._shown_text:
            return None
        number = self.properties.number
        height, offset = number("Font Size"), number("Value height offset")
        lines = self._shown_text.count("\n") + 1
        figure = Figure(number("Left"), number("Top"), height * number("Max Letter Num"), offset + 1.3 * height * lines)
        figure.add_text(self._shown_text, 0, offset, height, read_color(self.properties.text("Text Color"), opacity))
        return figure

    def _schedule_fading(self, opacity: float) -> None:
        if opacity > 0 and self._fade_timer is None:
            self._fade_timer = asyncio.get_running_loop().call_later(_FADE_PERIOD_S, self._fade)

    def _fade(self) -> None:
        self._fade_timer = None
        self.show_again()

    def _cancel_fading(self) -> None:
        self._emptied_s = None
        if self._fade_timer is not None:
            self._fade_timer.cancel()
            self._fade_timer = None


_DISTANCES = (
    (10.0, 1.0, 1, "m"),
    (1000.0, 1.0, 0, "m"),
    (10_000.0, 1e-3, 2, "km"),
    (100_000.0, 1e-3, 1, "km"),
    (math.inf, 1e-3, 0, "km"),
)
"""The largest distance in meters, the factor to the unit, the number of decimals, and the unit."""

_TIMES = (
    (60.0, 1.0, 0, "sec"),
    (600.0, 1 / 60, 1, "min"),
    (3600.0, 1 / 60, 0, "min"),
    (36_000.0, 1 / 3600, 1, "hrs"),
    (math.inf, 1 / 3600, 0, "hrs"),
)
"""The same for times in seconds."""


class MissionDetailsDisplay(OverlayDisplay):
    """A display of the remaining distance and time of a trip."""

    CLASS = "autoware_mission_details_overlay_rviz_plugin/MissionDetailsDisplay"
    MESSAGE = "autoware_internal_msgs/msg/MissionRemainingDistanceTime"
    TOPIC = ("Remaining Distance and Time Topic",)
    SCHEMA: ClassVar[Schema] = (
        topic_spec(TOPIC[0], "/planning/mission_remaining_distance_time", MESSAGE, messages=(MESSAGE,)),
        _pixels("Width", 170, "Width", minimum=1),
        _pixels("Height", 100, "Height", minimum=1),
        _pixels("Right", 10, "Distance from the right edge"),
        _pixels("Top", 10, "Distance from the upper edge"),
        PropertySpec("Background Alpha", "float", 0.3, "Opacity of the background.", minimum=0.0, maximum=1.0),
        PropertySpec("Background Color", "color", "#000000", "Color of the background."),
        PropertySpec("Text Color", "color", "#c2c2c2", "Color of the texts."),
    )

    def figure(self, message: Any) -> Figure | None:
        """Return the distance above the time, on a rounded background."""
        number = self.properties.number
        width, height = number("Width"), number("Height")
        background = read_color(self.properties.text("Background Color"), number("Background Alpha"))
        place = (number("Right"), number("Top"), width, height)
        figure = Figure(*place, horizontal="right", background=background, corner=height / 2)
        color, size = read_color(self.properties.text("Text Color")), 0.2 * height
        rows = (_shorten(message.remaining_distance, _DISTANCES), _shorten(message.remaining_time, _TIMES))
        for row, (amount, unit) in enumerate(rows):
            y = (0.325 + 0.35 * row) * height - size / 2
            figure.add_text(amount, 0.6 * width, y, size, color, align="right")
            figure.add_text(unit, 0.6 * width + 8, y, size, color)
        return figure


def _shorten(amount: float, rows: tuple[tuple[float, float, int, str], ...]) -> tuple[str, str]:
    """Return an amount with few digits, and its unit."""
    factor, digits, unit = next((row[1:] for row in rows if amount <= row[0]), rows[-1][1:])
    return f"{amount * factor:.{digits}f}", unit
