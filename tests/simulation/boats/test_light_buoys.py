"""Light buoys: the sequence of colors, for cameras and on the page."""

from __future__ import annotations

import pytest

from linkwright.simulation.plugins.drawings import has_drawings
from linkwright.simulation.plugins.particles import PARTICLES_TOPIC
from linkwright.testing import Recording
from tests.simulation.fluids.server import weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import world

RED, GREEN, BLUE, OFF = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)


def buoy(colors: tuple[str, str, str] = ("red", "Green", "blue"), visual: str = "buoy::base::panel_2") -> str:
    elements = "".join(f"<color_{number}>{color}</color_{number}>" for number, color in enumerate(colors, 1))
    plugin = (
        f'<plugin name="vrx::LightBuoyPlugin" filename="libLightBuoyPlugin.so">{elements}<visuals><visual>{visual}'
        "</visual></visuals></plugin>"
    )
    panels = "".join(
        f'<visual name="panel_{number}"><pose>0 0 {number} 0 0 0</pose><geometry><box><size>0.2 0.01 0.4</size></box>'
        f"</geometry>{plugin if number == 1 else ''}</visual>"
        for number in (1, 2)
    )
    return (
        '<model name="buoy"><pose>1 0 0 0 0 0</pose><link name="base"><inertial><mass>1</mass></inertial>'
        f"{panels}</link></model>"
    )


def get_color(server, panel: int) -> tuple[float, ...]:
    return tuple(server.simulation.model.geom(f"buoy::base::panel_{panel}#visual").rgba[:3].tolist())


async def test_named_panel_shows_three_colors_and_two_dark_seconds():
    async with weightless_server(buoy()) as (server, _, log):
        other_color = get_color(server, 1)
        server.advance(SECOND_NS // 2)
        shown = []
        for _ in range(7):
            shown.append(get_color(server, 2))
            server.advance(SECOND_NS)
        assert shown == [RED, GREEN, BLUE, OFF, OFF, RED, GREEN]
        assert get_color(server, 1) == other_color
        assert not log, [record.text for record in log]


async def test_page_draws_the_panel():
    async with weightless_server(buoy()) as (server, graph, _):
        recording = Recording(graph, server.node, PARTICLES_TOPIC)
        server.advance(3 * SECOND_NS // 2)
        await graph.settle()
        (marker,) = recording.last.markers
        assert (marker.color.r, marker.color.g, marker.color.b) == GREEN
        assert (marker.pose.position.x, marker.pose.position.z) == pytest.approx((1.0, 2.0))
        assert (marker.scale.x, marker.scale.y, marker.scale.z) == pytest.approx((0.2, 0.01, 0.4), abs=0.01)
    assert has_drawings(world(buoy()))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (buoy(("red", "pink", "blue")), "the color 'pink' must be one of red, green, blue, yellow, off"),
        (buoy(visual="buoy::base::lamp"), "there is no visual 'buoy::base::lamp'"),
    ],
)
async def test_mistakes_are_told_of(text, message):
    async with weightless_server(text) as (_, __, log):
        assert message in log[0].text
