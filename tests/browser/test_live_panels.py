"""The live panels in a real browser.

The tests cover plots, topics, node graph, parameters, log and teleop pad.
"""

from __future__ import annotations

import asyncio
import csv
import math
import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import pytest
from playwright.sync_api import Error, Page

from linkwright.graph import ParameterDescriptor
from linkwright.graph.parameters.parameter import Range
from linkwright.messages import get_message
from tests.browser.conftest import until, wait_until_equal
from tests.browser.live import LiveViewer, configuration
from tests.waiting import wait_until

pytestmark = pytest.mark.browser

FLOAT = get_message("std_msgs/msg/Float64")
JOINT_STATE = get_message("sensor_msgs/msg/JointState")
TWIST = get_message("geometry_msgs/msg/Twist")
GRID = "- Class: rviz_default_plugins/Grid\n  Enabled: true\n  Name: Grid"


@dataclass
class Robot:
    """Nodes that publish a current at 1 kHz and joints at 50 Hz.

    They also have parameters, log, and receive velocities.
    """

    viewer: LiveViewer
    velocities: list[tuple[float, float]] = field(default_factory=list)

    async def start(self) -> None:
        graph = self.viewer.node.graph
        current = graph.create_node("motor", namespace="/left").create_publisher(FLOAT, "/left/current", 1000)
        arm = graph.create_node("arm")
        joints = arm.create_publisher(JOINT_STATE, "/joint_states", 10)
        graph.create_node("planner").create_subscription(JOINT_STATE, "/joint_states", lambda _: None, 10)
        graph.create_node("gripper", namespace="/left").create_subscription(FLOAT, "/left/current", lambda _: None, 10)
        self.base = graph.create_node("base")
        self.base.create_subscription(TWIST, "/cmd_vel", self._on_velocity, 10)
        limits = ParameterDescriptor(description="Greatest speed", floating_point_range=[Range(0.0, 2.0)])
        self.base.declare_parameter("speed", 1.5, limits)
        self.base.declare_parameter("wheels", ["left", "right"])
        self._task = asyncio.get_running_loop().create_task(self._publish(arm, current, joints))

    async def _publish(self, arm, current, joints) -> None:
        start, sent = time.monotonic(), 0
        while True:
            await asyncio.sleep(0.02)
            while sent < (time.monotonic() - start) * 1000:
                current.publish(FLOAT(data=math.sin(sent / 200)))
                sent += 1
            message = JOINT_STATE(name=["shoulder", "elbow"], position=[0.25, math.sin(sent / 500)])
            message.header.stamp = arm.get_clock().now().to_msg()
            joints.publish(message)

    def _on_velocity(self, message) -> None:
        self.velocities.append((message.linear.x, message.angular.z))

    def log_texts(self, *texts: str) -> None:
        for text in texts:
            self.viewer.run(lambda text=text: self.base.get_logger().warning(text))

    async def stop(self) -> None:
        self._task.cancel()


@pytest.fixture
def robot(start_viewer: Callable[..., LiveViewer]) -> Iterator[Robot]:
    robot = Robot(start_viewer(configuration(GRID)))
    robot.viewer.run(robot.start)
    yield robot
    robot.viewer.run(robot.stop)


@pytest.fixture
def page(robot: Robot, open_page: Callable[..., Page]) -> Page:
    return open_page(robot.viewer, wait=False)


def open_panel(page: Page, name: str) -> None:
    page.get_by_role("button", name="Panels").click()
    page.get_by_role("menuitemcheckbox", name=name, exact=True).click()


def add_series(page: Page, text: str) -> None:
    page.get_by_role("button", name="Add a series").first.click()
    page.get_by_role("combobox", name=re.compile("^Topic and field")).fill(text)
    page.keyboard.press("Enter")


def subscriber_count(robot: Robot, topic: str) -> int:
    return robot.viewer.run(lambda: robot.viewer.node.graph.count_subscribers(topic))


MONITOR = "lw.panels.monitor"


def test_topic_fields_are_plotted(page: Page, robot: Robot):
    open_panel(page, "Plots")
    # The list offers the fields of a topic with the names from its messages.
    page.get_by_role("button", name="Add a series").click()
    page.keyboard.type("/joint")
    page.get_by_role("option", name="/joint_states").wait_for()
    page.keyboard.press("Enter")
    page.get_by_role("option", name="/joint_states.position[shoulder]").click()
    add_series(page, "/left/current.data")
    until(page, f"{MONITOR}.plots[0].series.length === 2 && {MONITOR}.plots[0].series[1].samples > 1500")
    first, second = page.evaluate("window.linkwright.panels.monitor.plots[0].series")
    assert (first["name"], first["last"]) == ("/joint_states.position[shoulder]", 0.25)
    assert -1 <= second["last"] <= 1
    wait_until_equal(lambda: len(find_drawn_colors(page)), 2)
    # During a pause the time window stays, and sampling continues.
    page.get_by_role("button", name="Pause").first.click()
    window = page.evaluate("window.linkwright.panels.monitor.window")
    count = page.evaluate("window.linkwright.panels.monitor.plots[0].series[1].samples")
    until(page, f"{MONITOR}.plots[0].series[1].samples > {count + 200}")
    assert page.evaluate("window.linkwright.panels.monitor.window") == window
    # The file contains the samples of the visible time window.
    with page.expect_download() as download:
        page.get_by_role("button", name="Save the values of this plot").click()
    rows = list(csv.reader(download.value.path().read_text().splitlines()))
    assert rows[0] == ["time", "/joint_states.position[shoulder]", "/left/current.data"]
    assert len(rows) > 1500
    assert all(window[0] - 1e-5 <= float(row[0]) <= window[1] + 1e-5 for row in rows[1:])
    page.get_by_role("button", name="Resume").click()
    until(page, f"{MONITOR}.window[1] > {window[1]}")
    # Removing a series ends its subscription, and closing the panel ends all of them.
    page.get_by_role("button", name="Remove /joint_states.position[shoulder]").click()
    wait_until(lambda: subscriber_count(robot, "/joint_states") == 1)
    open_panel(page, "Plots")
    wait_until(lambda: subscriber_count(robot, "/left/current") == 1)


def test_plot_library_loads_with_first_plot_and_its_style(page: Page):
    until(page, "document.querySelectorAll('main canvas').length > 0")
    request_count = (
        "performance.getEntriesByType('resource').filter(({ name }) => name.includes('plot-library')).length"
    )
    assert page.evaluate(request_count) == 0
    # The plot must not appear before its style sheet is loaded.
    page.evaluate(
        """() => new MutationObserver((_, observer) => {
            const drawn = document.querySelector(".u-over");
            if (!drawn) return;
            window.positioned = getComputedStyle(drawn).position;
            observer.disconnect();
        }).observe(document.body, { childList: true, subtree: true })"""
    )
    open_panel(page, "Plots")
    page.wait_for_function("window.positioned")
    assert page.evaluate("window.positioned") == "absolute"
    assert page.evaluate(request_count) == 2


def find_drawn_colors(page: Page) -> set[str]:
    """Return which of the first two series colors the canvas of the first plot has."""
    return set(
        page.evaluate(
            """() => {
                const canvas = document.querySelector(".plot-canvas canvas");
                const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
                const wanted = ["--plot-1", "--plot-2"].map((name) =>
                    getComputedStyle(document.documentElement).getPropertyValue(name).trim().slice(1));
                const found = new Set();
                for (let at = 0; at < data.length; at += 4) {
                    const hex = [0, 1, 2].map((part) => data[at + part].toString(16).padStart(2, "0")).join("");
                    if (data[at + 3] === 255 && wanted.includes(hex)) found.add(hex);
                }
                return [...found];
            }"""
        )
    )


def test_misspelled_field_is_reported_with_suggestion(page: Page):
    open_panel(page, "Plots")
    add_series(page, "/left/current.dta")
    page.get_by_text("did you mean 'data'").wait_for()


def test_topics_are_measured_and_opened(page: Page, robot: Robot):
    open_panel(page, "Topics")
    row = page.locator("tr[data-topic='/left/current']")
    row.wait_for()
    assert [cell.strip() for cell in row.locator("td").all_inner_texts()[1:4]] == ["std_msgs/Float64", "1", "1"]
    page.get_by_role("checkbox", name="Measure /left/current").check()
    until(page, f"{MONITOR}.traffic['/left/current']?.rate > 500")
    rate = "window.linkwright.panels.monitor.traffic['/left/current'].rate"
    wait_until_equal(lambda: page.evaluate(rate), pytest.approx(1000, rel=0.2))
    wait_until_equal(lambda: re.sub(r"\d+", "N", row.locator("td").nth(4).inner_text()), "N Hz")
    page.get_by_role("button", name="Last message of /joint_states").click()
    page.get_by_role("button", name="position", exact=True).click()
    message = page.locator(".topic-message:visible")
    message.get_by_text("[0]").wait_for()
    wait_until_equal(lambda: "0.25" in message.inner_text(), True)
    # A click plots a number of the message.
    message.locator(".message-row", has_text="[0]").hover()
    message.get_by_role("button", name="Plot this field").first.click()
    until(page, f"{MONITOR}.plots[0].series[0].name === '/joint_states.position[0]'")
    until(page, f"{MONITOR}.plots[0].series[0].last === 0.25")
    # The Topics panel is now hidden behind the plots, and does not measure rates.
    wait_until(lambda: subscriber_count(robot, "/left/current") == 1)


def test_node_graph_shows_publishers_and_subscribers(page: Page, robot: Robot):
    open_panel(page, "Node graph")
    page.locator(".vertex[data-id='node:/arm']").wait_for()
    row = ["node:/arm", "topic:/joint_states", "node:/planner"]

    def from_left_to_right() -> list[str]:
        return sorted(row, key=lambda name: page.locator(f".vertex[data-id='{name}']").bounding_box()["x"])

    wait_until_equal(from_left_to_right, row)
    page.locator(".vertex[data-id='topic:/joint_states']").click()
    details = page.locator(".graph-details")
    wait_until_equal(
        lambda: all(name in details.inner_text() for name in ("sensor_msgs/msg/JointState", "/planner")), True
    )
    neighbors = page.locator(".vertex.near")
    wait_until_equal(
        lambda: sorted(neighbors.evaluate_all("elements => elements.map((element) => element.dataset.id)")),
        ["node:/arm", "node:/planner"],
    )
    # A new node is drawn without a reload.
    robot.viewer.run(lambda: robot.viewer.node.graph.create_node("late").create_publisher(FLOAT, "/left/current", 10))
    page.locator(".vertex[data-id='node:/late']").wait_for()
    page.get_by_role("checkbox", name="Group").check()
    page.locator(".vertex[data-id='group:/left']").click()
    page.locator(".vertex[data-id='node:/left/motor']").wait_for()
    page.locator(".graph-drawing").focus()
    drawing = page.locator(".graph-drawing > svg > g")
    transform = drawing.get_attribute("transform")
    page.keyboard.press("+")
    wait_until_equal(lambda: drawing.get_attribute("transform") != transform, True)


def test_parameters_are_edited(page: Page, robot: Robot):
    open_panel(page, "Parameters")
    page.get_by_role("option", name="/base").click()
    speed = page.get_by_role("textbox", name="speed")
    speed.fill("0.75")
    speed.press("Enter")
    wait_until(lambda: robot.viewer.run(lambda: robot.base.get_parameter("speed").value) == 0.75)
    speed.fill("9")
    speed.press("Enter")
    page.get_by_text("out of range").wait_for()
    assert robot.viewer.run(lambda: robot.base.get_parameter("speed").value) == 0.75
    wheels = page.get_by_role("textbox", name="wheels")
    assert wheels.input_value() == '["left", "right"]'
    wheels.fill('["left", "right, rear"]')
    wheels.press("Enter")
    result = ["left", "right, rear"]
    wait_until(lambda: robot.viewer.run(lambda: list(robot.base.get_parameter("wheels").value)) == result)
    with page.expect_download() as download:
        page.get_by_role("button", name="YAML").click()
    assert download.value.suggested_filename == "base.yaml"
    assert "    speed: 0.75\n" in download.value.path().read_text()


def test_log_is_filtered_and_renders_only_visible_rows(page: Page, robot: Robot):
    open_panel(page, "Log")
    until(page, f"{MONITOR}.log !== undefined")
    robot.log_texts(*(f"line {number}" for number in range(300)))
    until(page, f"{MONITOR}.log.last === 'line 299'")
    page.locator(".virtual-list").get_by_text("line 299").wait_for()
    assert page.locator(".virtual-list .log-row").count() < 60
    page.get_by_role("textbox", name="Filter").fill("line 27")
    until(page, f"{MONITOR}.log.shown === 11")
    page.get_by_role("button", name="Warn", exact=True).click()
    until(page, f"{MONITOR}.log.shown === 0")
    page.get_by_role("button", name="Warn", exact=True).click()
    page.locator(".virtual-list").get_by_text("line 277").click()
    page.locator(".log-details").get_by_text("line 277").first.wait_for()
    page.get_by_role("button", name="Clear").click()
    until(page, f"{MONITOR}.log.lines === 0")


GAMEPAD = """() => {
    window.testPad = {
        id: "Test pad", connected: true, axes: [0, -1, 0, 0],
        buttons: Array.from({ length: 16 }, () => ({ pressed: false })),
    };
    navigator.getGamepads = () => [window.testPad];
}"""


def test_teleop_pad_publishes_while_held(page: Page, robot: Robot):
    open_panel(page, "Teleop")
    until(page, f"{MONITOR}.teleop.aim?.subscribers === 1")
    pad = page.locator(".pad")
    pad.focus()
    page.keyboard.down("i")
    wait_until(lambda: len(robot.velocities) >= 4)
    page.keyboard.down("j")
    wait_until(lambda: robot.velocities[-1] == (0.5, 1.0))
    page.keyboard.up("i")
    page.keyboard.up("j")
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    robot.velocities.clear()
    # With the mouse: the top right corner means full speed and a turn to the right.
    box = pad.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"], box["y"])
    wait_until(lambda: (0.5, -1.0) in robot.velocities)
    page.mouse.up()
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    robot.velocities.clear()
    # With a gamepad: the left stick, while LB is held.
    page.evaluate(GAMEPAD)
    page.get_by_role("checkbox", name="Gamepad").check()
    page.get_by_text("Test pad").wait_for()
    assert robot.velocities == []
    page.evaluate("window.testPad.buttons[4].pressed = true")
    wait_until(lambda: (0.5, 0.0) in robot.velocities)
    page.evaluate("window.testPad.buttons[4].pressed = false")
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    robot.velocities.clear()
    # Closing the page during a command stops the robot.
    pad.focus()
    page.keyboard.down("ArrowUp")
    wait_until(lambda: len(robot.velocities) >= 2)
    page.close()
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    wait_until(lambda: robot.viewer.run(lambda: robot.viewer.node.graph.count_publishers("/cmd_vel")) == 0)


def test_teleop_pad_stops_when_touch_ends_tab_hides_or_page_crashes(page: Page, robot: Robot):
    open_panel(page, "Teleop")
    until(page, f"{MONITOR}.teleop.aim?.subscribers === 1")
    pad = page.locator(".pad")
    tools = page.context.new_cdp_session(page)
    box = pad.bounding_box()
    finger = {"x": box["x"] + box["width"] / 2, "y": box["y"] + 1}

    def touch(kind: str) -> None:
        points = [finger] if kind == "touchStart" else []
        tools.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    for end in ("touchEnd", "touchCancel"):
        touch("touchStart")
        wait_until(lambda: robot.velocities and robot.velocities[-1] == (0.5, 0.0))
        touch(end)
        wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    pad.focus()
    page.keyboard.down("i")
    wait_until(lambda: robot.velocities[-1] == (0.5, 0.0))
    page.evaluate("""() => {
        Object.defineProperty(document, "hidden", { value: true, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
        delete document.hidden;
    }""")
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
    page.keyboard.up("i")
    page.keyboard.down("j")
    wait_until(lambda: robot.velocities[-1] == (0.0, 1.0))
    # A crashed page sends nothing: the server stops the robot.
    with pytest.raises(Error, match="crash"):
        page.goto("chrome://crash")
    wait_until(lambda: robot.velocities[-1] == (0.0, 0.0))
