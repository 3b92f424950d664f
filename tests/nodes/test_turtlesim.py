"""turtlesim_node, mimic and draw_square."""

from __future__ import annotations

import re
from math import cos, pi, sin
from random import Random

import numpy as np
import pytest

from linkwright.graph import ActionClient, GoalStatus
from linkwright.messages import get_action, get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.nodes.turtlesim.canvas import EXTENT, SIZE_PX, Canvas
from linkwright.nodes.turtlesim.draw_square import DrawSquare
from linkwright.nodes.turtlesim.mimic import Mimic
from linkwright.nodes.turtlesim.simulator import SHAPE_COUNT, Turtlesim
from linkwright.nodes.turtlesim.turtle import normalize_angle

PERIOD_S = 0.016
CENTER = EXTENT / 2.0
DEFAULT_PEN = (179, 184, 255)
WHITE = (255, 255, 255)


class Sea:
    """A turtlesim_node, and a node that commands and observes its turtles."""

    def __init__(self, harness, interfaces="turtlesim", **options):
        self.harness, self.interfaces = harness, interfaces
        self.node = harness.node
        self.simulator = Turtlesim(harness.graph, NodeOptions(**options), Random(1))
        self.poses, self.colors, self.publishers, self.subscriptions = [], [], {}, []
        self.watch("turtle1")

    def watch(self, name):
        """Observe the topics of a turtle from now on."""
        self.poses, self.colors = [], []
        for subscription in self.subscriptions:
            self.node.destroy_subscription(subscription)
        self.subscriptions = [
            self.node.create_subscription(f"{self.interfaces}/msg/{kind}", f"/{name}/{topic}", received.append, 100)
            for kind, topic, received in (("Pose", "pose", self.poses), ("Color", "color_sensor", self.colors))
        ]

    async def pass_time(self, seconds):
        await self.harness.clock.advance(seconds)

    async def command(self, forward=0.0, turn=0.0, sideways=0.0, turtle="turtle1"):
        twist = get_message("geometry_msgs/msg/Twist")()
        twist.linear.x, twist.linear.y, twist.angular.z = forward, sideways, turn
        if turtle not in self.publishers:
            self.publishers[turtle] = self.node.create_publisher(type(twist), f"/{turtle}/cmd_vel", 10)
        self.publishers[turtle].publish(twist)
        await self.harness.graph.settle()

    async def call(self, service, kind, **fields):
        service_class = get_service(kind if "/" in kind else f"{self.interfaces}/srv/{kind}")
        client = self.node.create_client(service_class, service)
        future = client.call_async(service_class.Request(**fields))
        await self.harness.graph.settle()
        self.node.destroy_client(client)
        return future.result()

    def place(self, turtle="turtle1"):
        turtle = self.simulator.turtles[turtle]
        return turtle.x, turtle.y, turtle.theta

    def pen_pixels(self):
        return int((self.simulator.canvas.pixels[..., 3] > 0).sum())


@pytest.fixture
def start_sea(harness):
    seas = []

    def start(**options):
        seas.append(Sea(harness, **options))
        return seas[-1]

    yield start
    for sea in seas:
        sea.simulator.close()


@pytest.fixture
def sea(start_sea):
    return start_sea()


# --- the node ---------------------------------------------------------------------------------------------------------


async def test_first_turtle_is_in_the_middle_and_publishes_at_62_hz(sea, logged):
    assert logged("INFO") == [
        "Starting turtlesim with node name /turtlesim",
        "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]",
    ]
    await sea.pass_time(1.0)
    assert len(sea.poses) == int(1.0 / PERIOD_S)
    pose = sea.poses[-1]
    assert (pose.x, pose.y) == (pytest.approx(499 / 45 / 2),) * 2
    assert (pose.theta, pose.linear_velocity, pose.angular_velocity) == (0.0, 0.0, 0.0)
    assert (sea.colors[-1].r, sea.colors[-1].g, sea.colors[-1].b) == WHITE


async def test_turtle_has_topics_services_and_action_of_turtlesim(sea, harness):
    topics = harness.graph.topics()
    assert topics["/turtle1/cmd_vel"] == ["geometry_msgs/msg/Twist"]
    assert topics["/turtle1/pose"] == ["turtlesim/msg/Pose"]
    assert topics["/turtle1/color_sensor"] == ["turtlesim/msg/Color"]
    services = dict(sea.node.get_service_names_and_types())
    assert {
        name: kinds[0] for name, kinds in services.items() if "turtlesim" in kinds[0] and "_action" not in name
    } == {
        "/kill": "turtlesim/srv/Kill",
        "/spawn": "turtlesim/srv/Spawn",
        "/turtle1/set_pen": "turtlesim/srv/SetPen",
        "/turtle1/teleport_absolute": "turtlesim/srv/TeleportAbsolute",
        "/turtle1/teleport_relative": "turtlesim/srv/TeleportRelative",
    }
    assert {"/clear", "/reset", "/turtle1/rotate_absolute/_action/send_goal"} <= services.keys()


async def test_interfaces_are_those_of_turtlesim_msgs_from_kilted(start_sea):
    sea = start_sea(interfaces="turtlesim_msgs", environment={"ROS_DISTRO": "kilted"})
    await sea.pass_time(PERIOD_S)
    assert len(sea.poses) == 1
    assert (await sea.call("/spawn", "Spawn", x=1.0, y=1.0)).name == "turtle2"


@pytest.mark.parametrize(
    ("distribution", "parameters", "moves"),
    [("", {}, True), ("jazzy", {}, False), ("jazzy", {"holonomic": True}, True)],
)
async def test_turtles_move_sideways_in_humble_or_if_holonomic(start_sea, distribution, parameters, moves):
    sea = start_sea(environment={"ROS_DISTRO": distribution}, parameters=parameters)
    await sea.command(sideways=1.0)
    await sea.pass_time(0.5)
    x, y, _ = sea.place()
    assert x == pytest.approx(CENTER)
    assert y == pytest.approx(CENTER + (0.496 if moves else 0.0))


# --- motion -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("forward", "turn"), [(2.0, 0.0), (-1.0, 0.0), (0.0, 1.5), (2.0, 1.8), (1.0, -3.0)])
async def test_pose_follows_the_velocity_for_a_second(sea, forward, turn):
    await sea.command(forward, turn)
    await sea.pass_time(2.0)
    steps = next(
        number for number, pose in enumerate(sea.poses) if not pose.linear_velocity and not pose.angular_velocity
    )
    assert steps == int(1.0 / PERIOD_S)
    x = y = CENTER
    theta = 0.0
    for _ in range(steps):
        theta += turn * PERIOD_S
        x, y = x + cos(theta) * forward * PERIOD_S, y + sin(theta) * forward * PERIOD_S
    assert sea.place() == (
        pytest.approx(x, abs=1e-6),
        pytest.approx(y, abs=1e-6),
        pytest.approx(normalize_angle(theta)),
    )
    assert sea.poses[0].linear_velocity == pytest.approx(abs(forward))
    assert sea.poses[0].angular_velocity == pytest.approx(turn)


async def test_turtle_stops_at_wall_and_warns_with_its_position(sea, logged):
    await sea.command(forward=9.0)
    await sea.pass_time(0.9)
    assert sea.place() == (EXTENT, pytest.approx(CENTER), 0.0)
    first, *_ = logged("WARN")
    x, y = map(float, re.fullmatch(r"Oh no! I hit the wall! \(Clamping from \[x=(.*), y=(.*)\]\)", first).groups())
    steps = next(number for number in range(100) if CENTER + 9.0 * PERIOD_S * number > EXTENT)
    assert (x, y) == (pytest.approx(CENTER + 9.0 * PERIOD_S * steps), pytest.approx(CENTER))


async def test_teleports_are_absolute_and_relative(sea, logged):
    await sea.call("/turtle1/teleport_absolute", "TeleportAbsolute", x=1.0, y=2.0, theta=pi / 2.0)
    await sea.pass_time(PERIOD_S)
    assert sea.place() == (pytest.approx(1.0), pytest.approx(2.0), pytest.approx(pi / 2.0))
    await sea.call("/turtle1/teleport_relative", "TeleportRelative", linear=3.0, angular=-pi / 2.0)
    await sea.pass_time(PERIOD_S)
    assert sea.place() == (pytest.approx(4.0), pytest.approx(2.0), pytest.approx(0.0, abs=1e-6))
    await sea.call("/turtle1/teleport_absolute", "TeleportAbsolute", x=20.0, y=20.0, theta=0.0)
    await sea.pass_time(PERIOD_S)
    assert sea.place() == (EXTENT, EXTENT, 0.0)


# --- spawn, kill, reset -----------------------------------------------------------------------------------------------


async def test_spawned_turtle_moves_alone(sea):
    response = await sea.call("/spawn", "Spawn", x=2.0, y=2.0, theta=0.2, name="Leonardo")
    assert response.name == "Leonardo"
    sea.watch("Leonardo")
    await sea.command(forward=1.0, turtle="Leonardo")
    await sea.pass_time(0.5)
    assert sea.poses[-1].theta == pytest.approx(0.2)
    assert sea.place("Leonardo")[0] > 2.4
    assert sea.place("turtle1") == (pytest.approx(CENTER), pytest.approx(CENTER), 0.0)


async def test_names_of_spawned_turtles_are_numbered_and_unique(sea, logged):
    assert (await sea.call("/spawn", "Spawn", name="turtle2")).name == "turtle2"
    assert (await sea.call("/spawn", "Spawn")).name == "turtle3"
    assert (await sea.call("/spawn", "Spawn", name="turtle2")).name == ""
    assert (await sea.call("/spawn", "Spawn", name="my turtle")).name == ""
    taken, invalid = logged("ERROR")
    assert taken == "A turtle named [turtle2] already exists"
    assert "my turtle" in invalid
    assert list(sea.simulator.turtles) == ["turtle1", "turtle2", "turtle3"]


async def test_turtles_look_different(sea):
    for _ in range(SHAPE_COUNT - 1):
        await sea.call("/spawn", "Spawn")
    assert {turtle.shape for turtle in sea.simulator.turtles.values()} == set(range(SHAPE_COUNT))


async def test_killed_turtle_leaves_no_topics_services_or_action(sea, harness, logged):
    names = {*harness.graph.topics(), *dict(sea.node.get_service_names_and_types())}
    await sea.call("/spawn", "Spawn", name="turtle2")
    await sea.call("/kill", "Kill", name="turtle2")
    assert {*harness.graph.topics(), *dict(sea.node.get_service_names_and_types())} == names
    await sea.call("/kill", "Kill", name="turtle2")
    assert logged("ERROR") == ["Tried to kill turtle [turtle2], which does not exist"]


async def test_reset_leaves_one_turtle_in_the_middle_and_no_lines(sea):
    await sea.call("/spawn", "Spawn", x=1.0, y=1.0)
    await sea.command(forward=2.0)
    await sea.pass_time(0.5)
    assert sea.pen_pixels() > 0
    await sea.call("/reset", "std_srvs/srv/Empty")
    assert list(sea.simulator.turtles) == ["turtle1"]
    assert sea.place() == (pytest.approx(CENTER), pytest.approx(CENTER), 0.0)
    assert sea.pen_pixels() == 0
    assert (await sea.call("/spawn", "Spawn")).name == "turtle2"


# --- the pen and the background ---------------------------------------------------------------------------------------


async def test_pen_draws_in_its_color_and_width(sea):
    await sea.command(forward=2.0)
    await sea.pass_time(0.5)
    column = sea.simulator.canvas.pixels[:, SIZE_PX // 2 + 20]
    assert (column[:, 3] > 0).sum() == 3
    assert {tuple(color) for color in column[column[:, 3] > 0][:, :3].tolist()} == {DEFAULT_PEN}
    assert (sea.colors[-1].r, sea.colors[-1].g, sea.colors[-1].b) == DEFAULT_PEN
    await sea.call("/turtle1/set_pen", "SetPen", r=255, g=0, b=0, width=9)
    await sea.call("/turtle1/teleport_absolute", "TeleportAbsolute", x=9.0, y=2.0)
    await sea.pass_time(2 * PERIOD_S)
    assert (sea.colors[-1].r, sea.colors[-1].g, sea.colors[-1].b) == (255, 0, 0)


async def test_pen_that_is_off_draws_nothing(sea):
    await sea.call("/turtle1/set_pen", "SetPen", off=1)
    await sea.command(forward=2.0)
    await sea.pass_time(0.5)
    assert sea.pen_pixels() == 0


async def test_clear_removes_lines_but_not_turtles(sea):
    await sea.command(forward=2.0)
    await sea.pass_time(0.5)
    place = sea.place()
    await sea.call("/clear", "std_srvs/srv/Empty")
    assert sea.pen_pixels() == 0
    assert sea.place() == place


def test_line_has_width_at_any_angle_and_is_cut_at_edges():
    canvas = Canvas()
    canvas.draw_line((0.0, 0.0), (EXTENT, EXTENT), (1, 2, 3), 5)
    drawn = canvas.pixels[..., 3] > 0
    rows, columns = np.nonzero(drawn)
    distances = np.abs(columns - (SIZE_PX - 1 - rows)) / 2.0**0.5
    assert distances.max() <= 2.5
    assert drawn.sum() == pytest.approx(5 * 499 * 2.0**0.5, rel=0.05)
    assert canvas.color_at(1.0, 1.0) == (1, 2, 3)
    assert canvas.color_at(1.0, 3.0) == WHITE
    version = canvas.version
    canvas.draw_line((-5.0, -5.0), (-4.0, -4.0), (1, 2, 3), 5)
    assert canvas.version == version


async def test_background_is_a_parameter_with_description_and_range(sea, harness):
    descriptor = sea.simulator.node.describe_parameter("background_g")
    assert descriptor.description == "Green channel of the background color"
    assert (descriptor.integer_range[0].from_value, descriptor.integer_range[0].to_value) == (0, 255)
    assert sea.simulator.background == (69, 86, 255)
    assert await harness.set(sea.simulator, background_r=120) == [(True, "")]
    assert sea.simulator.background == (120, 86, 255)
    ((is_set, _),) = await harness.set(sea.simulator, background_r=256)
    assert not is_set


# --- the action -------------------------------------------------------------------------------------------------------


class Rotation:
    """A goal of the action rotate_absolute."""

    def __init__(self, sea, theta):
        self.sea, self.feedback = sea, []
        action = get_action(f"{sea.interfaces}/action/RotateAbsolute")
        self.client = ActionClient(sea.node, action, "/turtle1/rotate_absolute")
        self.sent = self.client.send_goal_async(
            action.Goal(theta=theta), feedback_callback=lambda message: self.feedback.append(message.feedback.remaining)
        )

    async def accept(self):
        await self.sea.harness.graph.settle()
        self.handle = self.sent.result()
        self.result = self.handle.get_result_async()
        return self

    def end(self):
        """Return the status and the result."""
        response = self.result.result()
        self.client.destroy()
        return GoalStatus(response.status), response.result.delta


async def test_turtle_rotates_the_short_way_with_feedback(sea, logged):
    await sea.call("/turtle1/teleport_absolute", "TeleportAbsolute", x=5.0, y=5.0, theta=3.0)
    await sea.pass_time(PERIOD_S)
    rotation = await Rotation(sea, -3.0).accept()
    await sea.pass_time(2.0)
    status, delta = rotation.end()
    assert status is GoalStatus.SUCCEEDED
    assert sea.place()[2] == pytest.approx(-3.0, abs=0.02)
    assert delta == pytest.approx(normalize_angle(3.0 - sea.place()[2]), abs=1e-5)
    assert rotation.feedback[0] == pytest.approx(2.0 * pi - 6.0, abs=1e-5)
    assert rotation.feedback == sorted(rotation.feedback, reverse=True)
    assert abs(rotation.feedback[-1]) < 0.02
    assert "Rotation goal completed successfully" in logged("INFO")


async def test_rotation_is_canceled(sea, logged):
    rotation = await Rotation(sea, 3.0).accept()
    await sea.pass_time(1.6)
    rotation.handle.cancel_goal_async()
    await sea.pass_time(0.1)
    status, delta = rotation.end()
    assert status is GoalStatus.CANCELED
    assert delta == pytest.approx(-1.6, abs=2 * PERIOD_S)
    heading = sea.place()[2]
    await sea.pass_time(0.5)
    assert sea.place()[2] == heading
    assert "Rotation goal canceled" in logged("INFO")


@pytest.mark.parametrize(
    ("interruption", "warning"),
    [
        ("velocity", "Velocity command received during rotation goal. Aborting goal"),
        ("goal", "Rotation goal received before a previous goal finished. Aborting previous goal"),
    ],
)
async def test_velocity_and_next_goal_abort_rotation(sea, logged, interruption, warning):
    rotation = await Rotation(sea, 3.0).accept()
    await sea.pass_time(0.5)
    if interruption == "velocity":
        await sea.command(forward=0.5)
    else:
        other = await Rotation(sea, 0.0).accept()
    await sea.pass_time(1.0)
    assert rotation.end()[0] is GoalStatus.ABORTED
    assert warning in logged("WARN")
    if interruption == "goal":
        assert other.end()[0] is GoalStatus.SUCCEEDED


# --- mimic and draw_square --------------------------------------------------------------------------------------------


async def test_mimic_repeats_the_velocities_of_a_pose(sea, harness):
    await sea.call("/spawn", "Spawn", x=2.0, y=2.0)
    mimic = Mimic(
        harness.graph, NodeOptions(remappings=[("input/pose", "turtle1/pose"), ("output/cmd_vel", "turtle2/cmd_vel")])
    )
    await sea.command(1.0, 0.5)
    await sea.pass_time(0.5)
    (x1, y1, theta1), (x2, y2, theta2) = sea.place("turtle1"), sea.place("turtle2")
    assert theta2 == pytest.approx(theta1, abs=0.5 * PERIOD_S * 1.01)
    assert (x2 - 2.0, y2 - 2.0) == (pytest.approx(x1 - CENTER, abs=0.02), pytest.approx(y1 - CENTER, abs=0.02))
    mimic.close()


async def test_draw_square_resets_and_drives_along_a_square(sea, harness, logged):
    await sea.call("/turtle1/teleport_absolute", "TeleportAbsolute", x=1.0, y=1.0, theta=1.0)
    await sea.pass_time(PERIOD_S)
    square = DrawSquare(harness.graph, NodeOptions())
    await sea.pass_time(30.0)
    goals = [text for text in logged("INFO") if text.startswith("New goal")]
    assert len(goals) >= 8
    places = [tuple(map(float, goal[10:-1].replace(",", "").split())) for goal in goals]
    assert places[0] == (pytest.approx(CENTER + 2.0), pytest.approx(CENTER), 0.0)
    corners = [(2, 0, pi / 2), (2, 2, pi), (0, 2, -pi / 2), (0, 0, 0.0)]
    for (x, y, theta), (expected_x, expected_y, heading) in zip(places[1:8:2], corners, strict=True):
        assert (x - CENTER, y - CENTER) == (pytest.approx(expected_x, abs=0.4), pytest.approx(expected_y, abs=0.4))
        assert abs(normalize_angle(theta - heading)) < 0.1
    square.close()
