"""Measure the processor time of a simulated second, compared with MuJoCo alone.

Run it with ``python -m benchmarks simulation``. Most figures are the processor time (ms) of a simulated second at steps
of 1 ms, including all messages published and received in this process; 1000 ms are real time on one processor. "MuJoCo"
is ``mj_step`` of the same model from the same state in the same process, and "pybullet" simulates the same robots and
boxes. All run in turns of a tenth of a second under the same conditions, and the median turn is reported. Worlds of
other projects are measured if they are next to the repository. The last rows measure the whole command, in seconds of
wall time and MB.
"""

from __future__ import annotations

import asyncio
import gc
import os
import statistics
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from benchmarks.bullet import BulletWorld, make_bullet_world
from benchmarks.measure import LINKWRIGHT, Row, measure_commands, measure_peak_memory, show
from benchmarks.robots import REPOSITORY, SHIPPED
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import Graph, Node
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.nodes.simulator import Simulator
from linkwright.simulation.server.entities import read_entity
from linkwright.simulation.server.server import ServerOptions, SimulationServer
from linkwright.simulation.server.worlds import load_world
from linkwright.simulation.simulation import Simulation
from linkwright.xacro import expand

WORLDS = REPOSITORY / "robots" / "my_robot_gazebo" / "worlds"
MBOT = SHIPPED / "urdf" / "mbot_gazebo.xacro"
OTHER_WORLDS = REPOSITORY.parent / "shared" / "worlds"
"""The folder of other projects' worlds, which may be missing."""
MAX_TURNS = 60
_MIN_TURNS = 5
_MAX_DURATION_S = 10.0
"""The maximum and minimum number of turns, and the seconds after which no more turns start."""
_TURN_NS = NANOSECONDS_PER_SECOND // 10
_ROBOT_SPACING_M = 1.5
"""The distance between adjacent robots in meters."""
_SENSOR_TOPICS = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/imu": "sensor_msgs/msg/Imu",
    "/odom": "nav_msgs/msg/Odometry",
    "/tf": "tf2_msgs/msg/TFMessage",
}
_IMAGE_TOPICS = {"/camera/image_raw": "sensor_msgs/msg/Image", "/kinect/depth/image_raw": "sensor_msgs/msg/Image"}
_BOX = """<sdf version="1.7"><model name="box"><link name="link">
<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
<collision name="collision"><geometry><box><size>0.25 0.25 0.25</size></box></geometry></collision>
</link></model></sdf>"""


@dataclass(frozen=True)
class Case:
    """A measured simulation.

    Attributes:
        what: the description for the table.
        target: the promised figure.
        world: the name of one of our worlds, or a path below `OTHER_WORLDS`.
        robots: the number of robots.
        boxes: the number of boxes.
        arguments: the xacro arguments of the robot.
        topics: the subscribed topics, each with its type.
        pixels: the width and height of images.
        renderer: the renderer of images, a value of ``MUJOCO_GL``.
        bullet: whether pybullet has the same world.
        drives: whether the robots drive in circles, with subscriptions to their odometry and transforms.
    """

    what: str
    target: str = ""
    world: str = "empty"
    robots: int = 1
    boxes: int = 0
    arguments: Mapping[str, str] | None = None
    topics: Mapping[str, str] | None = None
    pixels: tuple[int, int] = (640, 480)
    renderer: str = ""
    bullet: bool = False
    drives: bool = False

    @property
    def is_available(self) -> bool:
        """Return whether the world exists."""
        return not self.world.endswith(".world") or (OTHER_WORLDS / self.world).is_file()


_ALL = {"laser": "true", "camera": "true", "kinect": "true"}
_LASER = {"laser": "true"}
_TURTLEBOT = "turtlebot3_simulations_classic/turtlebot3_gazebo/worlds"
_WAREHOUSE = "aws_small_warehouse/worlds/no_roof_small_warehouse/no_roof_small_warehouse.world"
CASES = (
    Case("mbot, nobody listens", "0.8 of MuJoCo", bullet=True),
    Case("mbot, 360 rays at 10 Hz, IMU and odometry at 100 Hz", "33 ms", arguments=_LASER, topics=_SENSOR_TOPICS),
    Case("the same in the playground", world="playground", arguments=_LASER, topics=_SENSOR_TOPICS),
    Case(
        "the same, camera at 30 Hz and depth at 20 Hz, 640x480",
        "500 ms",
        world="playground",
        arguments=_ALL,
        topics={**_SENSOR_TOPICS, **_IMAGE_TOPICS},
    ),
    Case(
        "the same, 320x240, by ray casting",
        "1000 ms",
        world="playground",
        arguments=_ALL,
        topics={**_SENSOR_TOPICS, **_IMAGE_TOPICS},
        pixels=(320, 240),
        renderer="off",
    ),
    *(
        Case(f"mbot with laser in {name}", world=path, arguments=_LASER, topics=_SENSOR_TOPICS)
        for name, path in (
            ("the warehouse of AWS", _WAREHOUSE),
            ("turtlebot3_world", f"{_TURTLEBOT}/turtlebot3_world.world"),
            ("turtlebot3_house", f"{_TURTLEBOT}/turtlebot3_house.world"),
        )
    ),
    Case("10 mbots, nobody listens", robots=10, bullet=True),
    Case("100 mbots, nobody listens", robots=100, bullet=True),
    Case("100 mbots that drive, odometry and tf received", "1000 ms", robots=100, drives=True),
    *(Case(f"{count} boxes at rest", robots=0, boxes=count, bullet=True) for count in (10, 100, 1000)),
)


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    cases = (asyncio.run(_measure_case(case)) for case in CASES if case.is_available)
    return [*cases, *(asyncio.run(_measure_spawning(count)) for count in (10, 100)), *_measure_command()]


async def _measure_spawning(count: int) -> Row:
    """Measure the processor time of adding robots to a running simulator, one after another."""
    graph = Graph(on_log=lambda _: None)
    simulator = Simulator(graph, NodeOptions(parameters={"world": str(WORLDS / "empty.world"), "usual_names": True}))
    text, is_spawned = _make_robot(_LASER), asyncio.Event()
    begin = time.process_time()
    for number in range(count):
        row, column = divmod(number, 10)
        pose = (row * _ROBOT_SPACING_M, column * _ROBOT_SPACING_M, 0.12, 0.0, 0.0, 0.0, 1.0)
        spawn = partial(simulator.services.spawn, text, f"mbot{number}", pose, f"mbot{number}")
        simulator.server.exchange.post(spawn)
    loop = asyncio.get_running_loop()
    simulator.server.exchange.post(lambda: loop.call_soon_threadsafe(is_spawned.set))
    await is_spawned.wait()
    seconds = time.process_time() - begin
    simulator.close()
    await graph.close()
    return Row(f"{count} mbots with laser come to a running world", seconds, "s", "5 s" if count == 100 else "")


def _measure_command() -> Iterator[Row]:
    """Measure the command without a page: the time until 0.1 s is simulated, and the memory."""
    words = [LINKWRIGHT, "sim", "playground", str(MBOT), "laser:=true", "camera:=true", "--headless", "--rate", "max"]
    begun = [*words, "--seconds", "0.1"]
    yield Row("linkwright sim, until 0.1 s is simulated", measure_commands({"it": begun}, 3)["it"], "s", "3 s")
    yield Row("memory of linkwright sim", measure_peak_memory([*words, "--seconds", "2"]), "MB", "2000 MB")


async def _measure_case(case: Case) -> Row:
    graph = Graph(on_log=lambda _: None)
    server = _make_server(graph, case)
    bullet = make_bullet_world(_make_robot({}), case.robots, case.boxes) if case.bullet else None
    listener = graph.create_node("listener")
    for topic, kind in (case.topics or {}).items():
        listener.create_subscription(get_message(kind), topic, lambda _: None, 10)
    if case.drives:
        _drive(listener, case.robots)
    try:
        with _use_renderer(case.renderer):
            for _ in range(NANOSECONDS_PER_SECOND // _TURN_NS):  # objects fall to the ground
                await _run_turn(graph, server)
                _advance_bullet(bullet)
            turns = await _take_turns(graph, server, bullet)
    finally:
        server.close()
        await graph.close()
        if bullet is not None:
            bullet.close()
    ours, *others = (statistics.median(turn) * 1000 * NANOSECONDS_PER_SECOND / _TURN_NS for turn in turns if turn)
    names = ("MuJoCo", "pybullet")
    peers: dict[str, float | None] = dict(zip(names, others, strict=False))
    return Row(case.what, ours, "ms", case.target, peers | ({"pybullet": None} if case.bullet and not bullet else {}))


async def _take_turns(
    graph: Graph, server: SimulationServer, bullet: BulletWorld | None
) -> tuple[list[float], list[float], list[float]]:
    """Return the processor times of each turn of ours, of MuJoCo and of Bullet, in seconds."""
    our_seconds, mujoco_seconds, bullet_seconds = [], [], []
    begin = time.monotonic()
    for number in range(MAX_TURNS):
        if number >= _MIN_TURNS and time.monotonic() - begin > _MAX_DURATION_S:
            break
        gc.collect()  # before each of both: it leaves the processor's caches cold
        our_seconds.append(await _run_turn(graph, server))
        gc.collect()
        mujoco_seconds.append(_run_mujoco_turn(server.simulation))
        if bullet is not None:
            bullet_seconds.append(_time_call(lambda: _advance_bullet(bullet)))
    return our_seconds, mujoco_seconds, bullet_seconds


@contextmanager
def _use_renderer(renderer: str) -> Iterator[None]:
    """Render images with a given renderer in the context."""
    old_renderer = os.environ.get("MUJOCO_GL")
    if renderer:
        os.environ["MUJOCO_GL"] = renderer
    try:
        yield
    finally:
        if renderer:
            del os.environ["MUJOCO_GL"]
            if old_renderer is not None:
                os.environ["MUJOCO_GL"] = old_renderer


def _make_robot(arguments: Mapping[str, str], pixels: tuple[int, int] = (640, 480)) -> str:
    """Return the description of mbot."""
    text = str(expand(MBOT, arguments, packages={"my_robot_description": SHIPPED}))
    for name, old_size, new_size in zip(("width", "height"), (640, 480), pixels, strict=True):
        text = text.replace(f"<{name}>{old_size}<", f"<{name}>{new_size}<")
    return text.replace("<update_rate>50<", "<update_rate>100<")


def _make_server(graph: Graph, case: Case) -> SimulationServer:
    path = OTHER_WORLDS / case.world if case.world.endswith(".world") else WORLDS / f"{case.world}.world"
    loaded = load_world(str(path))
    simulation = Simulation(loaded.world, loaded.finder)
    server = SimulationServer(simulation, graph.create_node("gazebo"), ServerOptions(usual_names=True))
    server.start()
    library = DescriptionLibrary()
    if case.robots:
        robot = read_entity(_make_robot(case.arguments or {}, case.pixels), loaded.finder, library).model
        for number in range(case.robots):
            row, column = divmod(number, 10)
            pose = (row * _ROBOT_SPACING_M, column * _ROBOT_SPACING_M, 0.12, 0.0, 0.0, 0.0, 1.0)
            server.spawn(robot, f"mbot{number}", pose, f"mbot{number}" if number else "")
    box = read_entity(_BOX, loaded.finder, library).model
    for number in range(case.boxes):
        row, column = divmod(number, 40)
        simulation.spawn(box, f"box{number}", (row * 0.5, column * 0.5, 0.125, 0.0, 0.0, 0.0, 1.0))
    return server


def _drive(node: Node, robots: int) -> None:
    """Make robots drive in circles, and subscribe to their odometry and transforms."""
    twist, listened = (
        get_message("geometry_msgs/msg/Twist"),
        {"odom": _SENSOR_TOPICS["/odom"], "tf": _SENSOR_TOPICS["/tf"]},
    )
    for number in range(robots):
        begin = f"/mbot{number}/" if number else "/"
        message = twist()
        message.linear.x, message.angular.z = 0.3, 0.3
        node.create_publisher(twist, f"{begin}cmd_vel", 10).publish(message)
        for name, kind in listened.items():
            node.create_subscription(get_message(kind), begin + name, lambda _: None, 10)


async def _run_turn(graph: Graph, server: SimulationServer) -> float:
    """Return the processor time of one of our turns in s, including received messages."""
    begin = time.process_time()
    server.advance(_TURN_NS)
    await graph.settle()
    return time.process_time() - begin


def _run_mujoco_turn(simulation: Simulation) -> float:
    """Return the processor time of MuJoCo for a turn from the same state, in seconds."""
    mujoco, model = load_mujoco(), simulation.model
    simulation.refresh()
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, simulation.data)
    return _time_call(lambda: mujoco.mj_step(model, data, nstep=_TURN_NS // simulation.step))


def _advance_bullet(bullet: BulletWorld | None) -> None:
    if bullet is not None:
        bullet.advance(_TURN_NS * 1000 // NANOSECONDS_PER_SECOND)


def _time_call(function: Callable[[], object]) -> float:
    begin = time.process_time()
    function()
    return time.process_time() - begin


def main() -> None:
    """Measure and print."""
    show(rows())


if __name__ == "__main__":
    main()
