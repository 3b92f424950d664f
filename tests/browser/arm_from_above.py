"""The arm seen from above, with a known scale of pixels.

It also receives the messages of the page's tools.
"""

from __future__ import annotations

from typing import Any

import yaml

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String
from tests.browser.conftest import TIMEOUT_S, state, until
from tests.viewer.scene import ARM
from tests.waiting import wait_until

PIXELS_PER_METER = 50.0
"""The scale of the file's TopDownOrtho view in pixels per meter."""
CONFIG = {
    "Visualization Manager": {
        "Displays": [
            {"Class": "rviz_default_plugins/Grid", "Name": "Grid", "Enabled": True},
            {
                "Class": "rviz_default_plugins/RobotModel",
                "Name": "RobotModel",
                "Enabled": True,
                "Description Topic": {"Value": "/robot_description"},
            },
            {
                "Class": "rviz_default_plugins/PointStamped",
                "Name": "Clicks",
                "Enabled": True,
                "Topic": {"Value": "/clicked_point"},
            },
        ],
        "Global Options": {"Fixed Frame": "base", "Background Color": "48; 48; 48", "Frame Rate": 30},
        "Views": {"Current": {"Class": "rviz_default_plugins/TopDownOrtho", "Scale": PIXELS_PER_METER}, "Saved": None},
    }
}
TIP = (3.0, 1.0)
"""The position of the arm's ball as seen from above, in meters."""


class ArmPage:
    """A page that shows the arm from above, and the messages that its tools publish."""

    def __init__(self, viewer: Any, page: Any) -> None:
        self.viewer, self.page = viewer, page
        self.messages: dict[str, list[Any]] = {}
        for kind, topic in (
            ("PoseWithCovarianceStamped", "/initialpose"),
            ("PoseStamped", "/goal_pose"),
            ("PointStamped", "/clicked_point"),
        ):
            messages = self.messages[topic] = []
            viewer.run(
                lambda kind=kind, topic=topic, messages=messages: viewer.node.create_subscription(
                    f"geometry_msgs/msg/{kind}", topic, messages.append, 10
                )
            )

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """Return the page's pixel of a point of the fixed frame, while the file's view is shown."""
        box = self.page.locator("canvas").first.bounding_box()
        return box["x"] + box["width"] / 2 + x * PIXELS_PER_METER, box["y"] + box["height"] / 2 - y * PIXELS_PER_METER

    def click(self, x: float, y: float, **options: Any) -> None:
        pixel = self.pixel(x, y)
        self.page.mouse.move(*pixel)
        self.page.mouse.click(*pixel, **options)

    def drag(self, start: tuple[float, float], end: tuple[float, float], button: str = "left") -> None:
        (x0, y0), (x1, y1) = self.pixel(*start), self.pixel(*end)
        self.page.mouse.move(x0, y0)
        self.page.mouse.down(button=button)
        self.page.mouse.move((x0 + x1) / 2, (y0 + y1) / 2)
        self.page.mouse.move(x1, y1)
        self.page.mouse.up(button=button)

    def press(self, key: str) -> str:
        """Press a key, and return the class of the current tool."""
        self.page.keyboard.press(key)
        return state(self.page, "tool.class").rpartition("/")[2]

    def single_message(self, topic: str) -> Any:
        """Wait for a topic's message, and return it; fail if it has several."""
        wait_until(lambda: self.messages[topic], TIMEOUT_S)
        (message,) = self.messages[topic]
        return message

    def show(self, view: str) -> dict[str, Any]:
        self.page.get_by_label("Type", exact=True).select_option(label=view)
        until(self.page, f"lw.view.type === '{view}'")
        return state(self.page, "view")

    def selected_keys(self) -> list[str]:
        return [item["key"] for item in state(self.page, "selection")]

    def saved_settings(self) -> dict[str, Any]:
        text = self.viewer.run(self.viewer.viewer.config.text)
        return yaml.safe_load(text)["Visualization Manager"]


def open_scene(start_viewer: Any, open_page: Any) -> ArmPage:
    """Publish the arm, and open a page that shows it from above.

    The arguments are the fixtures of these names.
    """
    viewer = start_viewer(yaml.safe_dump(CONFIG))
    viewer.publish("/robot_description", String(data=ARM), DESCRIPTION_QOS)
    viewer.place("tip", *TIP, 0.0)
    viewer.place("mark", 0.0, 0.0, 0.0, parent="tip")
    scene = ArmPage(viewer, open_page(viewer))
    until(scene.page, "lw.tools.length === 8 && lw.frames.tip !== undefined")
    viewer.settle(scene.page)
    return scene
