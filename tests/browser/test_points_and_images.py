"""Clouds, scans, maps and images, published to a viewer and checked in a real browser."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import numpy as np
import pytest
import yaml
from playwright.sync_api import Error

from linkwright.messages import get_message
from tests.browser.conftest import count_frames, state, until, wait_until_equal
from tests.browser.live import POLL_PERIOD_S
from tests.browser.pixels import Color, colors_at
from tests.images.test_images import image
from tests.rviz.clouds.test_clouds import make_cloud, make_depth_image, make_scan, xyz_array
from tests.rviz.displays.test_cloud_displays import make_camera_info, with_frame
from tests.rviz.displays.test_map_displays import make_cell_grid, make_grid, make_update
from tests.viewer.packed_images import make_compressed_image, make_depth_message, make_jpeg
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

PIXELS_PER_METER = 50.0
"""The scale of the TopDownOrtho view in pixels per meter, which gives the position of each pixel."""
BACKGROUND = (48, 48, 48)
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


def display_entry(cls: str, **properties: Any) -> dict[str, Any]:
    properties_by_name = {name.replace("_", " "): value for name, value in properties.items()}
    return {"Class": f"rviz_default_plugins/{cls}", "Name": cls, "Enabled": True, **properties_by_name}


def make_config(*displays: dict[str, Any]) -> str:
    view = {"Class": "rviz_default_plugins/TopDownOrtho", "Scale": PIXELS_PER_METER}
    options = {"Fixed Frame": "base", "Background Color": "48; 48; 48", "Frame Rate": 30}
    manager = {"Displays": list(displays), "Global Options": options, "Views": {"Current": view, "Saved": None}}
    return yaml.safe_dump({"Visualization Manager": manager})


def colors_from_above(page: Any, *points: tuple[float, float]) -> list[Color]:
    """Return the colors at points of the fixed frame, as seen from above."""
    box = page.locator(".canvas-box canvas").bounding_box()
    x0, y0 = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    return colors_at(page, *((x0 + x * PIXELS_PER_METER, y0 - y * PIXELS_PER_METER) for x, y in points))


def drawing_of(page: Any, display: int = 0) -> dict[str, Any]:
    drawing: dict[str, Any] = state(page, f"displays[{display}].drawn")
    return drawing


def three_points(**fields: Any) -> Any:
    array = xyz_array([(-2, 0, 0), (0, 0, 0), (2, 0, 0)], ("rgb", "u4"), ("intensity", "f4"))
    array["rgb"], array["intensity"] = [0xFF0000, 0x00FF00, 0x0000FF], [1, 2, 3]
    return make_cloud(array, **fields)


def set_property(viewer: Any, display: int, path: tuple[str, ...], value: object) -> None:
    viewer.run(lambda: viewer.viewer.displays[display].set_property(path, value))


def test_point_cloud_is_drawn_in_all_styles(start_viewer, open_page):
    size = {"Size (m)": 0.6, "Size (Pixels)": 30}
    viewer = start_viewer(make_config(display_entry("PointCloud2", Topic={"Value": "/cloud"}, **size)))
    page = open_page(viewer, wait=False)
    viewer.place("lidar", 0.0, 1.0, 0.0)
    viewer.publish("/cloud", three_points(frame="lidar"))
    until(page, "lw.displays[0]?.drawn?.points === 3")
    assert drawing_of(page)["bounds"] == [[-2, 1, 0], [2, 1, 0]]
    for style in ("Flat Squares", "Points", "Squares", "Spheres", "Boxes", "Tiles"):
        set_property(viewer, 0, ("Style",), style)
        until(page, f"lw.displays[0].drawn.style === '{style}'")
        viewer.settle(page)
        inner_distance = 0.2 if style == "Spheres" else 0.26
        points = [(-2.0, 1.0), (0.0, 1.0), (2.0, 1.0), (0.35, 1.0), (inner_distance, 1.0), (0.27, 1.27)]

        def read_appearance(points: list[tuple[float, float]] = points) -> tuple[list[Color], bool, bool]:
            *colors, near_edge, corner = colors_from_above(page, *points)
            return colors, near_edge[1] > 100, corner == BACKGROUND

        wait_until_equal(read_appearance, ([RED, GREEN, BLUE, BACKGROUND], True, style == "Spheres"))
    set_property(viewer, 0, ("Style",), "Flat Squares")
    set_property(viewer, 0, ("Alpha",), 0.5)
    wait_until_equal(lambda: colors_from_above(page, (-2.0, 1.0)), [pytest.approx((152, 24, 24), abs=2)])


def test_clicked_point_is_selected_and_shows_fields(start_viewer, open_page):
    viewer = start_viewer(make_config(display_entry("PointCloud2", Topic={"Value": "/cloud"}, **{"Size (m)": 0.2})))
    page = open_page(viewer, wait=False)
    viewer.publish("/cloud", three_points())
    until(page, "lw.displays[0]?.drawn?.points === 3")
    page.get_by_role("tab", name="Selection", exact=True).click()
    box = page.locator(".canvas-box canvas").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    viewer.settle(page)
    page.mouse.click(*middle)
    page.keyboard.press("s")
    page.mouse.click(*middle)
    until(page, "lw.selection.length === 1")
    assert state(page, "selection")[0]["key"] == ":1"
    tree = page.get_by_role("tree", name="Selection")
    tree.get_by_text("intensity").wait_for()
    text = tree.inner_text()
    assert "Point 1" in text
    assert "0; 255; 0" in text


def test_large_cloud_is_updated_continuously(start_viewer, open_page):
    viewer = start_viewer(
        make_config(display_entry("PointCloud2", Topic={"Value": "/cloud"}, Color_Transformer="AxisColor"))
    )
    page = open_page(viewer, wait=False)
    rng = np.random.default_rng(0)
    array = np.zeros(100_000, xyz_array([]).dtype)
    for name in "xyz":
        array[name] = rng.uniform(-3, 3, array.size)
    # The first message arrives while the page starts, and the others follow at once. The last one is drawn completely.
    for number in range(10):
        array["x"][0] = 4.0 + number  # the bounds show which message is drawn
        viewer.publish("/cloud", make_cloud(array))
    until(page, "lw.displays[0]?.drawn?.bounds?.[1][0] === 13 && lw.displays[0].drawn.points === 100000")
    # Messages that arrive after the previous one is drawn are all drawn.
    for number in range(3):
        array["x"][0] = 20.0 + number
        viewer.publish("/cloud", make_cloud(array))
        until(page, f"lw.displays[0].drawn.bounds[1][0] === {20 + number} && lw.displays[0].drawn.points === 100000")


def test_laser_scan_temperature_and_grid_cells_are_drawn(start_viewer, open_page):
    displays = (
        display_entry("LaserScan", Topic={"Value": "/scan"}, **{"Size (m)": 0.5}),
        display_entry("Temperature", Topic={"Value": "/temperature"}, **{"Size (m)": 0.5}),
        display_entry("GridCells", Topic={"Value": "/cells"}),
    )
    viewer = start_viewer(make_config(*displays))
    page = open_page(viewer, wait=False)
    viewer.place("thermometer", 0.0, -2.0, 0.0)
    viewer.publish("/scan", with_frame(make_scan([1.0, 2.0, 3.0], [0.0, 1.0, 2.0])))
    temperature = get_message("sensor_msgs/msg/Temperature")(temperature=100.0)
    viewer.publish("/temperature", with_frame(temperature, "thermometer"))
    viewer.publish("/cells", make_cell_grid(-1.5, width=1.0, height=0.5))
    until(page, "lw.displays[0]?.drawn?.points === 3 && lw.displays[1].drawn.points === 1")
    until(page, "lw.displays[2].drawn.cells === 1")
    viewer.settle(page)
    points = (1.0, 0.0), (-3.0, 0.0), (0.0, -2.0), (-1.9, 0.2), (-1.9, 0.3)
    wait_until_equal(lambda: colors_from_above(page, *points), [RED, (255, 0, 255), RED, (25, 255, 0), BACKGROUND])


def test_map_is_drawn_and_updated(start_viewer, open_page):
    displays = (
        display_entry("Map", Topic={"Value": "/map"}, Alpha=1.0),
        display_entry("PointCloud2", Topic={"Value": "/cloud"}, **{"Size (m)": 0.2}),
    )
    viewer = start_viewer(make_config(*displays))
    page = open_page(viewer, wait=False)
    viewer.publish("/map", make_grid(data=[0, 100, -1, 50, 110, -128]))
    until(page, "lw.displays[0]?.drawn?.cells === 6")
    # The corner is at x = -1, and cells are half a meter wide.
    points = [(-0.75, 0.25), (-0.25, 0.25), (0.25, 0.25), (-0.75, 0.75), (-0.25, 0.75), (0.25, 0.75)]
    shades = [(255, 255, 255), (0, 0, 0), (112, 137, 134), (128, 128, 128), (0, 255, 0), (255, 0, 0)]
    wait_until_equal(lambda: colors_from_above(page, *points), shades)
    set_property(viewer, 0, ("Color Scheme",), "costmap")
    wait_until_equal(
        lambda: colors_from_above(page, *points[:4]), [BACKGROUND, (255, 0, 255), (112, 137, 134), (127, 0, 128)]
    )
    set_property(viewer, 0, ("Color Scheme",), "raw")
    set_property(viewer, 0, ("Binary representation",), True)
    set_property(viewer, 0, ("Binary threshold",), 50)
    wait_until_equal(
        lambda: colors_from_above(page, *points[:4]), [(0, 0, 0), (255, 255, 255), (255, 255, 255), (255, 255, 255)]
    )
    set_property(viewer, 0, ("Binary representation",), False)
    set_property(viewer, 0, ("Color Scheme",), "map")
    viewer.publish("/map_updates", make_update(0, 0, 1, 1, [100]))
    until(page, "lw.displays[0].drawn.counts[100] === 2")
    wait_until_equal(lambda: colors_from_above(page, points[0]), [(0, 0, 0)])


def test_map_drawn_behind_does_not_hide_points(start_viewer, open_page):
    displays = (
        display_entry("PointCloud2", Topic={"Value": "/cloud"}, **{"Size (m)": 0.4}),
        display_entry("Map", Topic={"Value": "/map"}, Alpha=1.0, Draw_Behind=True),
    )
    viewer = start_viewer(make_config(*displays))
    page = open_page(viewer, wait=False)
    viewer.place("cellar", 0.0, 0.0, -3.0)
    viewer.publish("/map", make_grid())
    viewer.publish("/cloud", three_points(frame="cellar"))
    until(page, "lw.displays[0]?.drawn?.points === 3 && lw.displays[1].drawn.cells === 6")
    viewer.settle(page)
    wait_until_equal(lambda: colors_from_above(page, (0.0, 0.0), (0.1, 0.1)), [GREEN, GREEN])
    set_property(viewer, 1, ("Draw Behind",), False)
    viewer.settle(page)
    wait_until_equal(lambda: colors_from_above(page, (0.1, 0.1)) != [GREEN], True)


def test_image_has_its_own_panel(start_viewer, open_page):
    viewer = start_viewer(make_config(display_entry("Image", Topic={"Value": "/image"})))
    page = open_page(viewer, wait=False)
    page.get_by_text("No image").wait_for()
    pixels = np.zeros((20, 40, 3), np.uint8)
    pixels[:, :20], pixels[:, 20:] = (255, 0, 0), (0, 0, 255)
    viewer.publish("/image", image("rgb8", 40, 20, pixels.tobytes()))
    until(page, "lw.displays[0]?.drawn?.width === 40")
    assert drawing_of(page)["corner"] == [255, 0, 0, 255]

    def read_appearance() -> tuple[bool, list[Color]]:
        box = page.locator(".image-panel canvas").bounding_box()
        positions = [(0.4, box["height"] / 2), (0.6, box["height"] / 2), (0.5, 1.0)]
        colors = colors_at(page, *((box["x"] + share * box["width"], box["y"] + y) for share, y in positions))
        return box["height"] > box["width"] / 2, colors

    # The image keeps its proportions: the area above and below it is black.
    wait_until_equal(read_appearance, (True, [RED, BLUE, (0, 0, 0)]))

    page.locator(".panel-tab", has_text="Image").locator(".tab-close").click()
    until(page, "lw.displays[0].enabled === false")
    page.locator(".image-panel").wait_for(state="detached")
    wait_until(lambda: not viewer.viewer.displays[0].enabled)  # the page disables the display before the server does
    viewer.run(lambda: viewer.viewer.manager.tree.check(viewer.viewer.displays[0], True))
    page.locator(".image-panel").wait_for()
    page.reload()
    page.locator(".image-panel").wait_for()
    assert page.locator(".image-panel").count() == 1


_CHANGE_LAYERS = """() => {
  const id = "changing-layer";
  const mark = document.getElementById(id) ?? document.body.appendChild(document.createElement("div"));
  const layer = mark.style.willChange === "transform" ? "auto" : "transform";
  mark.id = id;
  mark.style.cssText =
    `position: fixed; right: 0; bottom: 0; width: 1px; height: 1px; z-index: 2147483647; will-change: ${layer}`;
  return true;
}"""
"""Adds or removes a layer above all others, which changes no other layer.

Chromium reports its layers only when they change. Without this change, a page that had drawn its last frame before the
report was requested would never report them.
"""


def compositing_layers(page: Any) -> list[str]:
    """Return the browser's compositing layers of the page, by the attributes of their elements."""
    tools = page.context.new_cdp_session(page)
    messages: list[list[dict[str, Any]]] = []
    tools.on("LayerTree.layerTreeDidChange", lambda event: messages.append(event.get("layers", [])))
    tools.send("DOM.enable")
    tools.send("LayerTree.enable")
    wait_until(lambda: page.evaluate(_CHANGE_LAYERS) and any(messages), pause=POLL_PERIOD_S)
    nodes = [layer["backendNodeId"] for layer in next(filter(None, reversed(messages))) if "backendNodeId" in layer]
    elements = []
    for node in nodes:
        with suppress(Error):  # the page removed the element after the report
            elements.append(tools.send("DOM.describeNode", {"backendNodeId": node})["node"])
    tools.detach()
    return [" ".join([node["nodeName"], *node.get("attributes", [])]) for node in elements]


def test_image_is_composited_without_repainting_page(start_viewer, open_page):
    viewer = start_viewer(make_config(display_entry("Image", Topic={"Value": "/image"})))
    page = open_page(viewer, wait=False)
    viewer.publish("/image", image("rgb8", 40, 20, bytes(2400)))
    until(page, "lw.displays[0]?.drawn?.width === 40")
    own_layers = ("CANVAS height 20 width 40", "CANVAS data-engine", "DIV class orientation")
    wait_until_equal(
        lambda: [any(layer.startswith(prefix) for layer in compositing_layers(page)) for prefix in own_layers],
        [True, True, True],
    )


def test_compressed_image_is_decoded_by_browser(start_viewer, open_page):
    viewer = start_viewer(make_config(display_entry("Image", Topic={"Value": "/image/compressed"})))
    page = open_page(viewer, wait=False)
    # An image of one blue pixel.
    data = page.evaluate(
        "async () => { const c = new OffscreenCanvas(1, 1); const g = c.getContext('2d'); g.fillStyle = '#0000ff';"
        " g.fillRect(0, 0, 1, 1); const b = await c.convertToBlob({ type: 'image/png' });"
        " return [...new Uint8Array(await b.arrayBuffer())]; }"
    )
    message = get_message("sensor_msgs/msg/CompressedImage")(format="rgb8; png compressed", data=bytes(data))
    viewer.publish("/image/compressed", message)
    until(page, "lw.displays[0]?.drawn?.width === 1 && lw.displays[0].drawn.corner[2] === 255")


def test_camera_display_shows_scene_over_image(start_viewer, open_page):
    displays = (
        display_entry("Camera", Topic={"Value": "/camera/image"}, **{"Image Rendering": "background"}),
        display_entry("PointCloud2", Topic={"Value": "/cloud"}, Style="Boxes", **{"Size (m)": 0.4}),
    )
    viewer = start_viewer(make_config(*displays))
    page = open_page(viewer, wait=False)
    # The camera is at the origin and looks along x: its z axis points ahead, and its x axis to the right.
    viewer.place("camera", 0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)
    viewer.publish("/camera/camera_info", make_camera_info(40, 30))
    info = make_camera_info(40, 30)
    info.p = np.array([20.0, 0, 20, 0, 0, 20.0, 15, 0, 0, 0, 1, 0])
    viewer.publish("/camera/camera_info", info)
    viewer.publish("/camera/image", with_frame(image("rgb8", 40, 30, bytes([255, 255, 0]) * 1200), "camera"))
    until(page, "lw.displays[0]?.drawn?.image?.[0] === 40 && lw.displays[0].drawn.width > 0")
    wait_until_equal(lambda: drawing_of(page)["middle"], [255, 255, 0, 255])  # the next frame has the image
    assert drawing_of(page)["position"] == pytest.approx([0, 0, 0])
    viewer.publish("/cloud", three_points())
    until(page, "lw.displays[0].drawn.middle[0] < 200 && lw.displays[0].drawn.middle[2] > 100")  # blue, 2 m ahead
    set_property(viewer, 0, ("Visibility", "PointCloud2"), False)
    until(page, "lw.displays[0].drawn.middle[0] === 255")
    set_property(viewer, 0, ("Visibility", "PointCloud2"), True)
    set_property(viewer, 0, ("Image Rendering",), "overlay")
    set_property(viewer, 0, ("Overlay Alpha",), 1.0)
    viewer.settle(page)
    until(page, "lw.displays[0].drawn.middle[1] === 255")


def test_depth_image_is_drawn_as_points(start_viewer, open_page):
    topics = {"Depth Map Topic": "/depth/image", "Color Image Topic": "/color/image"}
    viewer = start_viewer(make_config(display_entry("DepthCloud", **topics)))
    page = open_page(viewer, wait=False)
    viewer.publish("/depth/camera_info", make_camera_info(2, 1))
    viewer.publish("/color/image", with_frame(image("rgb8", 2, 1, bytes([255, 0, 0, 0, 255, 0]))))
    viewer.publish("/depth/image", with_frame(make_depth_image([[2.0, 4.0]])))
    until(page, "lw.displays[0]?.drawn?.points === 2")
    wait_until_equal(lambda: drawing_of(page)["bounds"], [[0, 0, 2], [2, 0, 4]])
    # The width of a pixel is half its distance: 1 m and 2 m here.
    wait_until_equal(lambda: colors_from_above(page, (-0.3, 0.0), (2.8, 0.0)), [RED, GREEN])


def test_depth_cloud_uses_chosen_image_transports(start_viewer, open_page):
    topics = {"Depth Map Topic": "/depth/image", "Color Image Topic": "/color/image"}
    hints = {"Depth Map Transport Hint": "theora", "Color Transport Hint": "compressed"}
    viewer = start_viewer(
        make_config(
            display_entry("DepthCloud", **topics, **hints),
            display_entry("Image", Topic={"Value": "/depth/image/compressedDepth"}),
        )
    )
    page = open_page(viewer, wait=False)
    assert "choose raw, compressed" in viewer.status("DepthCloud")["Depth Map Transport Hint"][1]
    set_property(viewer, 0, ("Depth Map Transport Hint",), "compressedDepth")
    viewer.publish("/depth/camera_info", make_camera_info(2, 1))
    viewer.publish(
        "/color/image/compressed", make_compressed_image("rgb8; jpeg compressed bgr8", make_jpeg((0, 0, 255), 2, 1))
    )
    viewer.publish("/depth/image/compressedDepth", make_depth_message(np.array([[2000, 4000]], np.uint16), "rvl"))
    until(page, "lw.displays[0]?.drawn?.points === 2 && lw.displays[1].drawn?.width === 2")
    viewer.settle(page)
    assert drawing_of(page)["bounds"] == [[0, 0, 2], [2, 0, 4]]
    assert drawing_of(page)["firstColor"][2] > 240
    assert drawing_of(page, 1)["corner"] == [0, 0, 0, 255]


def test_idle_displays_are_not_redrawn(start_viewer, open_page):
    viewer = start_viewer(
        make_config(
            display_entry("PointCloud2", Topic={"Value": "/cloud"}), display_entry("Map", Topic={"Value": "/map"})
        )
    )
    page = open_page(viewer, wait=False)
    viewer.publish("/cloud", three_points())
    viewer.publish("/map", make_grid())
    until(page, "lw.displays[0]?.drawn?.points === 3 && lw.displays[1].drawn.cells === 6")
    viewer.settle(page)
    wait_until_equal(lambda: count_frames(page), 0)
    assert count_frames(page) == 0
