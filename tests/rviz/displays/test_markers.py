"""The Marker and MarkerArray displays."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.packages import PackageFinder
from linkwright.page.files import MeshIndex
from linkwright.rviz import RvizConfig
from linkwright.rviz.markers import BadMarkerError, MarkerStore, read_marker
from tests.viewer.contents import unpack
from tests.viewer.scene import open_world
from tests.waiting import eventually

Marker = get_message("visualization_msgs/msg/Marker")
MarkerArray = get_message("visualization_msgs/msg/MarkerArray")
Point = get_message("geometry_msgs/msg/Point")
ColorRGBA = get_message("std_msgs/msg/ColorRGBA")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/{cls}
      Enabled: true
      Name: Marks
      Namespaces:
        hidden: false
      Topic:
        Value: /marks
  Global Options:
    Fixed Frame: base
"""


def make_marker(number: int = 0, *, ns: str = "a", kind: int = Marker.CUBE, frame: str = "base", **fields) -> Marker:
    message = Marker(ns=ns, id=number, type=kind)
    message.header.frame_id = frame
    message.scale.x = message.scale.y = message.scale.z = 1.0
    message.color.a = 1.0
    message.points = [Point(x=float(x), y=float(y), z=float(z)) for x, y, z in fields.pop("points", ())]
    message.pose.position.x = float(fields.pop("x", 0.0))
    for name, value in fields.items():
        setattr(message, name, value)
    return message


class Watcher:
    """A simulated page with the store's content at its last update."""

    def __init__(self, store: MarkerStore) -> None:
        self.store = store
        self.seen = 0
        self.markers: dict[str, dict] = {}

    def look(self) -> dict | None:
        frame, self.seen = self.store.since(self.seen)
        if frame is None:
            return None
        content = unpack(frame).fields
        if content["everything"]:
            self.markers.clear()
        for identity in content["removed_ids"]:
            self.markers.pop(identity, None)
        self.markers.update({marker["id"]: marker for marker in content["markers"]})
        return content


def publisher_and_watcher(world, message_type=Marker):
    publisher = world.graph.create_node("marks").create_publisher(message_type, "/marks", 10)
    (display,) = world.viewer.displays
    (store,) = display.data()
    return publisher, Watcher(store), display


def status_rows(display) -> dict[str, tuple[str, str]]:
    return {row.name: (row.level, row.text) for row in display.status}


async def test_marker_stays_where_its_frame_was():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, _ = publisher_and_watcher(world)
        world.move({("base", "tip"): (1, 2, 3, 0, 0, 2**-0.5, 2**-0.5)}, static=True)
        publisher.publish(make_marker(7, frame="tip", x=1))
        await world.settle()
        page.look()
        (shown,) = page.markers.values()
        assert (shown["id"], shown["shape"], shown["frame"]) == ("a/7", "cube", "")
        np.testing.assert_allclose(shown["pose"], [1, 3, 3, 0, 0, 2**-0.5, 2**-0.5], atol=1e-6)


async def test_frame_locked_marker_follows_its_frame():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, _ = publisher_and_watcher(world)
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        publisher.publish(make_marker(frame="tip", x=1, frame_locked=True))
        await world.settle()
        page.look()
        assert page.markers["a/0"]["frame"] == "tip"
        assert page.markers["a/0"]["pose"] == [1, 0, 0, 0, 0, 0, 1]


async def test_marker_appears_once_its_frame_is_known():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, display = publisher_and_watcher(world)
        publisher.publish(make_marker(frame="tip"))
        await world.settle()
        page.look()
        assert page.markers == {}
        level, text = status_rows(display)["a/0"]
        assert level == "error"
        assert text.startswith("For frame [tip]: No transform to fixed frame [base].  TF error: [")
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        page.look()
        assert list(page.markers) == ["a/0"]
        assert "a/0" not in status_rows(display)


async def test_filter_size_limits_markers_waiting_for_frames():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, display = publisher_and_watcher(world)
        display.set_property(("Topic", "Filter size"), 2)
        publisher.publish(make_marker(0))
        for number in (1, 2, 3, 1, 4):
            publisher.publish(make_marker(number, frame="later"))
            await world.settle()
        assert set(status_rows(display)) >= {"a/1", "a/4"}
        assert not {"a/2", "a/3"} & set(status_rows(display))
        world.move({("base", "later"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        page.look()
        assert sorted(page.markers) == ["a/0", "a/1", "a/4"]


async def test_markers_are_deleted_individually_and_all():
    async with open_world(RvizConfig.parse(FILE.format(cls="MarkerArray"))) as world:
        publisher, page, _ = publisher_and_watcher(world, MarkerArray)
        publisher.publish(MarkerArray(markers=[make_marker(n, ns=ns) for ns in "ab" for n in range(3)]))
        await world.settle()
        assert page.look()["everything"] is True
        assert len(page.markers) == 6
        publisher.publish(MarkerArray(markers=[make_marker(1, action=Marker.DELETE)]))
        await world.settle()
        change = page.look()
        assert (change["everything"], change["removed_ids"], change["markers"]) == (False, ["a/1"], [])
        publisher.publish(MarkerArray(markers=[make_marker(0, ns="b", action=Marker.DELETEALL)]))
        await world.settle()
        page.look()
        assert sorted(page.markers) == ["a/0", "a/2"]
        publisher.publish(MarkerArray(markers=[make_marker(0, ns="", action=Marker.DELETEALL), make_marker(9)]))
        await world.settle()
        page.look()
        assert list(page.markers) == ["a/9"]


async def test_marker_disappears_after_lifetime():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, _ = publisher_and_watcher(world)
        short_lived = make_marker(1)
        short_lived.lifetime.nanosec = 1_000_000
        publisher.publish(short_lived)
        publisher.publish(make_marker(2))
        await world.settle()
        page.look()
        assert sorted(page.markers) == ["a/1", "a/2"]

        def list_markers() -> list[str]:
            page.look()
            return list(page.markers)

        await eventually(lambda: list_markers() == ["a/2"])


async def test_namespace_checkboxes_follow_file():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, _, display = publisher_and_watcher(world)
        publisher.publish(make_marker(ns="seen"))
        publisher.publish(make_marker(ns="hidden"))
        await world.settle()
        (row,) = [row for row in display.properties.rows() if row.name == "Namespaces"]
        assert {child.name: child.value for child in row.children} == {"seen": True, "hidden": False}
        display.set_property(("Namespaces",), False)
        (row,) = [row for row in display.properties.rows() if row.name == "Namespaces"]
        assert {child.value for child in row.children} == {False}


async def test_duplicate_markers_in_message_are_reported():
    async with open_world(RvizConfig.parse(FILE.format(cls="MarkerArray"))) as world:
        publisher, page, display = publisher_and_watcher(world, MarkerArray)
        publisher.publish(MarkerArray(markers=[make_marker(1, x=1), make_marker(1, x=2)]))
        await world.settle()
        assert status_rows(display)["Duplicate Marker Check"] == (
            "error",
            "Multiple Markers in the same MarkerArray message had the same ns and id: (a, 1)",
        )
        page.look()
        assert page.markers["a/1"]["pose"][0] == 2


async def test_late_page_receives_all_markers():
    async with open_world(RvizConfig.parse(FILE.format(cls="Marker"))) as world:
        publisher, page, display = publisher_and_watcher(world)
        for number in range(3):
            publisher.publish(make_marker(number))
            await world.settle()
            page.look()
        late_watcher = Watcher(display.data()[0])
        late_watcher.look()
        assert sorted(late_watcher.markers) == sorted(page.markers) == ["a/0", "a/1", "a/2"]
        assert late_watcher.look() is None


def test_page_receives_all_markers_after_missing_too_many_changes(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.markers.shapes._MAX_REMOVED_IDS", 2)
    store = MarkerStore("d")
    page = Watcher(store)
    shapes = [read_marker(make_marker(number), index()).shape for number in range(5)]
    for shape in shapes:
        store.put(shape)
    page.look()
    for shape in shapes[:4]:
        store.remove(shape.id)
    assert page.look()["everything"] is True
    assert list(page.markers) == ["a/4"]


def index() -> MeshIndex:
    from pathlib import Path

    return MeshIndex(PackageFinder(start=Path("/nonexistent"), environment={}))


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (make_marker(kind=Marker.ARROW, points=SQUARE[:1]), "only specified one point of a point to point arrow."),
        (make_marker(kind=Marker.LINE_LIST, points=SQUARE), "Line list marker [a/0] has an odd number of points."),
        (make_marker(kind=Marker.TRIANGLE_LIST), "TriMesh marker [a/0] has no points."),
        (make_marker(kind=Marker.TRIANGLE_LIST, points=SQUARE[:2]), "not divisible by 3 [2]"),
        (make_marker(kind=99), "Unknown marker type: 99"),
        (make_marker(x=math.nan), "Contains invalid floating point values (nans or infs)"),
        (
            make_marker(kind=Marker.POINTS, points=[(math.inf, 0, 0)]),
            "Contains invalid floating point values (nans or infs)",
        ),
        (
            make_marker(kind=Marker.MESH_RESOURCE, mesh_resource="package://none/a.stl"),
            "could not load [package://none/a.stl]",
        ),
    ],
)
def test_invalid_marker_is_rejected_with_message_of_rviz(message, text):
    with pytest.raises(BadMarkerError) as raised:
        read_marker(message, index())
    assert text in str(raised.value)


@pytest.mark.parametrize(
    ("message", "warning"),
    [
        (make_marker(), None),
        (
            make_marker(scale=get_message("geometry_msgs/msg/Vector3")(x=1.0, y=0.0, z=1.0)),
            "Scale of 0 in one of x/y/z",
        ),
        (
            make_marker(kind=Marker.POINTS, points=SQUARE, colors=[ColorRGBA(r=1.0)] * 3),
            "All points have a zero alpha value.",
        ),
    ],
)
def test_suspicious_marker_has_warning(message, warning):
    assert read_marker(message, index()).warning == warning


def test_zero_quaternion_is_identity():
    message = make_marker()
    message.pose.orientation.w = 0.0
    assert read_marker(message, index()).shape.pose == [0, 0, 0, 0, 0, 0, 1]


def test_all_marker_types_have_shapes():
    kinds = []
    for kind in range(13):
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 0), (1, 0, 0), (1, 1, 0)] if kind > 3 else []
        if kind != Marker.MESH_RESOURCE:
            kinds.append(read_marker(make_marker(kind=kind, points=points), index()).shape.shape)
    assert len(set(kinds)) == 12


def test_mesh_may_be_embedded_in_message():
    message = make_marker(kind=Marker.MESH_RESOURCE, mesh_use_embedded_materials=True)
    message.mesh_file.filename = "part.STL"
    message.mesh_file.data = b"solid"
    mesh = read_marker(message, index()).shape.mesh
    assert (mesh.format, mesh.url, bytes(mesh.data), mesh.embedded) == ("stl", None, b"solid", True)
