"""Markers and interactive markers, drawn and used in a real browser."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.browser.conftest import until
from tests.browser.live import configuration
from tests.rviz.displays.test_interactive_markers import Control, Feedback, MarkerServer
from tests.rviz.displays.test_interactive_markers import make_marker as interactive_marker
from tests.rviz.displays.test_markers import ColorRGBA, Marker, MarkerArray, make_marker
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

MARKERS = configuration(
    """
- Class: rviz_default_plugins/Grid
  Enabled: true
  Name: Grid
- Class: rviz_default_plugins/MarkerArray
  Enabled: true
  Name: Marks
  Topic:
    Value: /marks
""",
    distance=12,
)
CUBE_STL = b"""solid c
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid c
"""


def make_color(r: float, g: float, b: float, a: float = 1.0):
    return ColorRGBA(r=r, g=g, b=b, a=a)


def make_all_markers(mesh: Path) -> list[Marker]:
    """Return a marker of each type, in a row along y."""
    triangle = [(0, 0, 0), (1, 0, 0), (0, 0, 1)]
    rainbow = [make_color(1.0, 0.0, 0.0), make_color(0.0, 1.0, 0.0), make_color(0.0, 0.0, 1.0)]
    markers = [
        make_marker(0, kind=Marker.ARROW, color=make_color(1.0, 0.5, 0.0)),
        make_marker(1, kind=Marker.CUBE, color=make_color(0.0, 1.0, 0.0)),
        make_marker(2, kind=Marker.SPHERE, color=make_color(0.0, 0.0, 1.0, 0.5)),
        make_marker(3, kind=Marker.CYLINDER, color=make_color(1.0, 1.0, 0.0)),
        make_marker(4, kind=Marker.LINE_STRIP, points=triangle, colors=rainbow),
        make_marker(5, kind=Marker.LINE_LIST, points=[*triangle, (1, 0, 1)], color=make_color(1.0, 0.0, 1.0)),
        make_marker(6, kind=Marker.CUBE_LIST, points=triangle, colors=rainbow),
        make_marker(7, kind=Marker.SPHERE_LIST, points=triangle, color=make_color(0.2, 0.8, 0.8)),
        make_marker(8, kind=Marker.POINTS, points=triangle, colors=rainbow),
        make_marker(9, kind=Marker.TEXT_VIEW_FACING, text="hello\n你好", color=make_color(1.0, 1.0, 1.0)),
        make_marker(10, kind=Marker.MESH_RESOURCE, mesh_resource=mesh.as_uri(), color=make_color(1.0, 0.0, 0.0)),
        make_marker(11, kind=Marker.TRIANGLE_LIST, points=triangle, colors=rainbow, color=make_color(1.0, 1.0, 1.0)),
        make_marker(12, kind=12, points=[*triangle, (1, 0, 1)], color=make_color(0.6, 0.3, 1.0)),
    ]
    for number, example in enumerate(markers):
        example.pose.position.y = (number - 6) * 1.5
        small = example.type in (
            Marker.LINE_STRIP,
            Marker.LINE_LIST,
            Marker.CUBE_LIST,
            Marker.SPHERE_LIST,
            Marker.POINTS,
            12,
        )
        if small:
            example.scale.x, example.scale.y, example.scale.z = (0.1, 0.2, 0.2)
        if example.type == Marker.ARROW:
            example.scale.y = example.scale.z = 0.2
    return markers


def test_all_marker_types_are_drawn(start_viewer, open_page, tmp_path):
    mesh = tmp_path / "triangle.stl"
    mesh.write_bytes(CUBE_STL)
    viewer = start_viewer(MARKERS)
    page = open_page(viewer, wait=False)
    viewer.publish("/marks", MarkerArray(markers=make_all_markers(mesh)))
    until(page, "Object.keys(lw.displays[1]?.drawn?.markers ?? {}).length === 13")
    viewer.settle(page)  # markers are listed before they have poses
    drawing = page.evaluate("() => window.linkwright.displays[1].drawn")
    assert drawing["markers"]["a/0"] == "arrow"
    assert drawing["markers"]["a/12"] == "arrow_strip"
    low, high = drawing["bounds"]
    assert low[1] == pytest.approx(-9.2, abs=0.1)
    assert high[1] == pytest.approx(9.2, abs=0.2)
    assert {level for level, _ in viewer.status("Marks").values()} == {"ok"}
    viewer.publish("/marks", MarkerArray(markers=[make_marker(1, action=Marker.DELETE)]))
    until(page, "!('a/1' in lw.displays[1].drawn.markers)")
    viewer.publish("/marks", MarkerArray(markers=[make_marker(0, ns="", action=Marker.DELETEALL)]))
    until(page, "Object.keys(lw.displays[1].drawn.markers).length === 0")


def test_unreadable_marker_mesh_is_reported(start_viewer, open_page, tmp_path):
    mesh = tmp_path / "broken.glb"
    mesh.write_text("no mesh")
    viewer = start_viewer(MARKERS)
    page = open_page(viewer, wait=False)
    mesh_marker = make_marker(1, kind=Marker.MESH_RESOURCE, mesh_resource=mesh.as_uri())
    viewer.publish("/marks", MarkerArray(markers=[mesh_marker]))
    until(page, "lw.displays[1]?.status.some(row => row.name === 'a/1' && row.level === 'error')")
    assert "Mesh resource marker [a/1]" in viewer.status("Marks")["a/1"][1]


def test_box_selection_ignores_hidden_markers(start_viewer, open_page):
    viewer = start_viewer(MARKERS.replace("Pitch: 0.6", "Pitch: 0").replace("Yaw: 0.8", "Yaw: 0"))
    page = open_page(viewer, wait=False)
    wall, hidden, neighbor = (
        make_marker(number, kind=Marker.CUBE, color=make_color(0.0, 1.0, 0.0)) for number in range(3)
    )
    wall.pose.position.x, wall.scale.y, wall.scale.z = 2.0, 3.0, 3.0
    neighbor.pose.position.y = 3.0
    viewer.publish("/marks", MarkerArray(markers=[wall, hidden, neighbor]))
    until(page, "Object.keys(lw.displays[1]?.drawn?.markers ?? {}).length === 3")
    viewer.settle(page)
    page.keyboard.press("s")
    until(page, "lw.tool.class.endsWith('/Select')")
    box = page.locator(".canvas-box canvas").bounding_box()
    page.mouse.move(box["x"] + 20, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] - 20, box["y"] + box["height"] - 20, steps=5)
    page.mouse.up()
    until(page, "JSON.stringify(lw.selection).includes('a/2')")
    assert "a/0" in (selection := page.evaluate("() => JSON.stringify(window.linkwright.selection)"))
    assert "a/1" not in selection


INTERACTIVE = configuration(
    """
- Class: rviz_default_plugins/InteractiveMarkers
  Enabled: true
  Name: Handles
  Interactive Markers Namespace: /handles
  Show Visual Aids: true
""",
    distance=8,
    pitch=1.4,
    yaw=-1.5708,
)


def test_interactive_marker_is_dragged_along_its_axis(start_viewer, open_page):
    along_x = Control(name="x", interaction_mode=Control.MOVE_AXIS)
    viewer = start_viewer(INTERACTIVE)
    server = viewer.run(lambda: MarkerServer(viewer._graph, interactive_marker("one", along_x)))
    page = open_page(viewer, wait=False)
    until(page, "lw.displays[0]?.drawn?.one !== undefined")
    until(page, "lw.tools.length > 0")
    page.keyboard.press("i")
    until(page, "lw.tool.class.endsWith('/Interact')")
    viewer.settle(page)
    box = page.locator("canvas").first.bounding_box()
    # The camera is above, x to the right: the arrow ends at x = 1.8.
    middle = (box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    meter = box["height"] / (2 * 8 * 0.4142)
    start = (middle[0] + 1.4 * meter, middle[1])
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(start[0] + meter / 2, start[1] + 5, steps=4)
    page.mouse.move(start[0] + meter, start[1] + 10, steps=4)
    until(page, "lw.displays[0].drawn.one.aided")
    page.mouse.up()
    until(page, "!lw.displays[0].drawn.one.aided")
    until(page, "lw.displays[0].drawn.one.pose[0] > 0.7")
    pose = page.evaluate("() => window.linkwright.displays[0].drawn.one.pose")
    assert pose[0] == pytest.approx(1.0, abs=0.15)
    assert pose[1:3] == [0, 0]

    def events() -> list[int]:
        return viewer.run(lambda: [feedback.event_type for feedback in server.feedback])

    wait_until(lambda: events()[-1] == Feedback.MOUSE_UP, what=events)
    assert events()[0] == Feedback.MOUSE_DOWN
    assert Feedback.POSE_UPDATE in events()
    last = viewer.run(lambda: server.feedback[-1])
    assert last.pose.position.x == pytest.approx(pose[0])
    assert (last.marker_name, last.control_name) == ("one", "x")
