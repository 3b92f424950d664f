"""The InteractiveMarkers display, with a server of the test."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from linkwright.messages import get_message, get_service
from linkwright.packages import PackageFinder
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.markers import MarkerFeedback
from linkwright.rviz import RvizConfig
from linkwright.rviz.markers import BadMarkerError
from linkwright.rviz.markers.interactive import read_interactive_marker
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world
from tests.waiting import eventually

InteractiveMarker = get_message("visualization_msgs/msg/InteractiveMarker")
Control = get_message("visualization_msgs/msg/InteractiveMarkerControl")
Feedback = get_message("visualization_msgs/msg/InteractiveMarkerFeedback")
Pose = get_message("visualization_msgs/msg/InteractiveMarkerPose")
Update = get_message("visualization_msgs/msg/InteractiveMarkerUpdate")
Marker = get_message("visualization_msgs/msg/Marker")
MenuEntry = get_message("visualization_msgs/msg/MenuEntry")
GetInteractiveMarkers = get_service("visualization_msgs/srv/GetInteractiveMarkers")

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/InteractiveMarkers
      Enabled: true
      Name: Handles
      Interactive Markers Namespace: /handles
  Global Options:
    Fixed Frame: base
"""


def make_marker(name: str, *controls: Control, x: float = 0.0, frame: str = "base") -> InteractiveMarker:
    message = InteractiveMarker(name=name, description=f"the {name}", scale=2.0, controls=list(controls))
    message.header.frame_id = frame
    message.pose.position.x = float(x)
    return message


class MarkerServer:
    """A fake of interactive_markers' InteractiveMarkerServer with its topics."""

    def __init__(self, graph, *markers: InteractiveMarker) -> None:
        node = graph.create_node("handle_server")
        self.markers = {marker.name: marker for marker in markers}
        self.sequence = 0
        self.feedback: list[Feedback] = []
        self._updates = node.create_publisher(Update, "/handles/update", 100)
        node.create_subscription(Feedback, "/handles/feedback", self.feedback.append, 100)
        node.create_service(GetInteractiveMarkers, "/handles/get_interactive_markers", self._answer)

    def _answer(self, request, response):
        response.sequence_number = self.sequence
        response.markers = list(self.markers.values())
        return response

    def update(self, **fields) -> None:
        self.sequence += 1
        self._updates.publish(Update(server_id="s", seq_num=self.sequence, type=Update.UPDATE, **fields))

    def keep_alive(self, sequence: int | None = None) -> None:
        number = self.sequence if sequence is None else sequence
        self._updates.publish(Update(server_id="s", seq_num=number, type=Update.KEEP_ALIVE))


def contents_by_name(world) -> dict[str, dict]:
    """Return a page's content by kind and name."""
    (display,) = world.viewer.displays
    return {
        f"{content.fields['kind']} {content.fields['name']}": content.fields for content in unpack_contents(display)
    }


def display_status(world) -> dict[str, tuple[str, str]]:
    (display,) = world.viewer.displays
    return {row.name: (row.level, row.text) for row in display.status}


async def wait_until_connected(world) -> None:
    initialized = ("ok", "Initialized interactive marker client")
    await eventually(
        lambda: display_status(world).get("Interactive Marker Client") == initialized,
        what=lambda: str(display_status(world)),
    )
    await world.settle()


async def test_interactive_markers_are_added_moved_and_removed():
    async with open_world(RvizConfig.parse(FILE)) as world:
        server = MarkerServer(world.graph, make_marker("one", x=1))
        await wait_until_connected(world)
        assert contents_by_name(world)["interactive_marker one"]["pose"] == [1, 0, 0, 0, 0, 0, 1]
        server.update(markers=[make_marker("two", x=2)])
        await world.settle()
        assert sorted(contents_by_name(world)) == ["interactive_marker one", "interactive_marker two"]
        moved = Pose(name="two")
        moved.pose.position.x = 5.0
        server.update(poses=[moved])
        await world.settle()
        assert contents_by_name(world)["interactive_marker_moved two"]["pose"] == [5, 0, 0, 0, 0, 0, 1]
        server.update(erases=["two"])
        await world.settle()
        assert sorted(contents_by_name(world)) == ["interactive_marker one"]


async def test_updates_wait_while_time_is_paused():
    async with open_world(RvizConfig.parse(FILE)) as world:
        server = MarkerServer(world.graph, make_marker("one"))
        await wait_until_connected(world)
        world.viewer.manager.set_time(paused=True, mode="Off", source="")
        server.update(markers=[make_marker("two")])
        server.update(erases=["one"])
        await world.settle()
        assert sorted(contents_by_name(world)) == ["interactive_marker one"]
        world.viewer.manager.set_time(paused=False, mode="Off", source="")
        assert sorted(contents_by_name(world)) == ["interactive_marker two"]


async def test_lost_update_requests_markers_again():
    async with open_world(RvizConfig.parse(FILE)) as world:
        server = MarkerServer(world.graph, make_marker("one"))
        await wait_until_connected(world)
        server.markers = {"three": make_marker("three")}
        server.sequence = 7
        server.keep_alive()
        await world.settle()
        assert contents_by_name(world) == {}
        await wait_until_connected(world)
        assert sorted(contents_by_name(world)) == ["interactive_marker three"]


async def test_feedback_of_user_is_published_to_server():
    async with open_world(RvizConfig.parse(FILE)) as world:
        server = MarkerServer(world.graph, make_marker("one", frame="base"))
        await wait_until_connected(world)
        (display,) = world.viewer.displays
        pose = [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]
        display.receive(MarkerFeedback(display.id, "one", "grip", "pose_update", pose, 0, [0.5, 0.0, 0.0]))
        display.receive(MarkerFeedback(display.id, "one", "grip", "menu_select", pose, 4, []))
        display.receive(MarkerFeedback(display.id, "none", "grip", "mouse_up", pose, 0, []))
        display.receive(MarkerFeedback(display.id, "one", "grip", "mouse_up", pose[:3], 0, []))
        await world.settle()
        first, second = server.feedback
        assert (first.event_type, first.marker_name, first.control_name) == (Feedback.POSE_UPDATE, "one", "grip")
        assert (first.pose.position.x, first.pose.position.z, first.mouse_point.x) == (1, 3, 0.5)
        assert first.header.frame_id == "base"
        assert first.client_id == f"/rviz2/{display.id}"
        assert (first.mouse_point_valid, second.mouse_point_valid) == (True, False)
        assert (second.event_type, second.menu_entry_id) == (Feedback.MENU_SELECT, 4)


async def test_display_waits_for_missing_server_with_warning():
    async with open_world(RvizConfig.parse(FILE)) as world:
        missing = ("warn", "Service is not available: /handles/get_interactive_markers")
        await eventually(lambda: display_status(world).get("Interactive Marker Client") == missing)
        MarkerServer(world.graph, make_marker("one"))
        await wait_until_connected(world)


async def test_empty_namespace_is_reported():
    async with open_world(RvizConfig.parse(FILE.replace("/handles", '""'))) as world:
        assert display_status(world)["Interactive Marker Client"] == ("error", "Error connecting: empty namespace")


async def test_marker_appears_once_its_frame_is_known():
    async with open_world(RvizConfig.parse(FILE)) as world:
        MarkerServer(world.graph, make_marker("one", frame="tip"))
        await wait_until_connected(world)
        assert contents_by_name(world) == {}
        assert display_status(world)["one"][0] == "error"
        world.move({("base", "tip"): (1, 0, 0, 0, 0, 0, 1)}, static=True)
        await world.settle()
        assert sorted(contents_by_name(world)) == ["interactive_marker one"]
        assert "one" not in display_status(world)


async def test_disabled_display_unsubscribes_from_server():
    async with open_world(RvizConfig.parse(FILE)) as world:
        server = MarkerServer(world.graph, make_marker("one"))
        await wait_until_connected(world)
        (display,) = world.viewer.displays
        display.set_checked(False)
        display.on_enabled_changed()
        assert contents_by_name(world) == {}
        assert server._updates.get_subscription_count() == 0


def read_transparency(message: InteractiveMarker, transparent: bool = True):
    index = MeshIndex(PackageFinder(start=Path("/nonexistent"), environment={}))
    return read_interactive_marker(
        message, index, lambda reference, frame: (10, 0, 0, 0, 0, 0, 1), transparent=transparent
    )


def test_move_axis_control_has_two_arrows_in_color_of_axis():
    control = Control(name="x", interaction_mode=Control.MOVE_AXIS)
    (control,) = read_transparency(make_marker("one", control)).controls
    first, second = control.markers
    assert (first.shape, first.color) == ("arrow", [1, 0, 0, 0.5])
    np.testing.assert_allclose(first.points, [[1, 0, 0], [1.8, 0, 0]])
    np.testing.assert_allclose(second.points, [[-1, 0, 0], [-1.8, 0, 0]])
    np.testing.assert_allclose(first.scale, [0.3, 0.5, 0.4])


@pytest.mark.parametrize(
    ("mode", "shades"),
    [(Control.MOVE_PLANE, []), (Control.ROTATE_AXIS, [0.6, 1.0]), (Control.MOVE_ROTATE, [0.6, 1.0])],
)
def test_rotation_control_has_ring(mode, shades):
    control = Control(name="z", interaction_mode=mode)
    control.orientation.w = control.orientation.y = 2**-0.5
    (control,) = read_transparency(make_marker("one", control), transparent=False).controls
    (ring,) = control.markers
    assert ring.shape == "triangle_list"
    assert ring.color[3] == 1.0
    radii = np.linalg.norm(ring.points, axis=1)
    assert sorted({round(float(radius), 6) for radius in radii}) == [0.5, 0.65]
    assert len(ring.points) == 36 * 6
    assert sorted({round(float(shade), 6) for shade in ring.colors[:, 2]}) == shades
    assert len(ring.colors) in (0, 72)


def test_menu_control_without_markers_is_view_facing_text():
    control = Control(name="m", interaction_mode=Control.MENU, description="Options")
    message = make_marker("one", control)
    message.menu_entries = [MenuEntry(id=1, title="Go"), MenuEntry(id=2, parent_id=1, title="Home")]
    shape = read_transparency(message)
    (control,) = shape.controls
    assert (control.orientation_mode, control.markers[0].text) == ("view_facing", "Options")
    assert [(entry.id, entry.parent, entry.title) for entry in shape.menu] == [(1, 0, "Go"), (2, 1, "Home")]


def test_controls_with_same_name_get_unique_names():
    names = [
        control.name
        for control in read_transparency(make_marker("one", *(Control(name="a") for _ in range(3)))).controls
    ]
    assert names == ["a", "a_u0", "a_u1"]


def test_marker_of_control_is_transformed_to_control_frame():
    box = Marker(type=Marker.CUBE)
    box.header.frame_id = "tip"
    box.color.a = 1.0
    (control,) = read_transparency(make_marker("one", Control(name="c", markers=[box]), x=4)).controls
    assert control.markers[0].pose[:3] == [6, 0, 0]
    assert control.markers[0].scale == [1, 1, 1]


def test_nonfinite_values_are_rejected():
    with pytest.raises(BadMarkerError, match="invalid floats"):
        read_transparency(make_marker("one", x=float("nan")))
