"""Measure simulated worlds: the processor time of a simulated second, compared with MuJoCo alone.

Run it with ``python -m benchmarks simulation``. Most figures are the processor's time (ms) of a simulated second at
steps of 1 ms, with everything that is published and received in this process; 1000 ms is real time on one processor.
"MuJoCo" is ``mj_step`` of the same model from the same state in the same process, "pybullet" steps of the same robots
and boxes there. All take turns of a tenth of a second, so that they meet the same machine, and the median turn counts.
Worlds of others are measured where they are beside the repository. The last rows are the whole command, in real seconds
and MB.
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

from benchmarks.bullet import BulletWorld, bullet_world
from benchmarks.measure import LINKWRIGHT, Row, commands, peak_memory, show
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
OTHERS = REPOSITORY.parent / "shared" / "worlds"
"""The folder of other projects' worlds, which may be missing."""
TURNS = 60
_LEAST = 5
_LONGEST = 10.0
"""At most so many turns are measured of each, at least so many, and no more after so many seconds."""
_SLICE = NANOSECONDS_PER_SECOND // 10
_BESIDE = 1.5
"""The distance between adjacent robots in meters."""
_LISTENED = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/imu": "sensor_msgs/msg/Imu",
    "/odom": "nav_msgs/msg/Odometry",
    "/tf": "tf2_msgs/msg/TFMessage",
}
_PICTURES = {"/camera/image_raw": "sensor_msgs/msg/Image", "/kinect/depth/image_raw": "sensor_msgs/msg/Image"}
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
        world: the name of one of our worlds, or a path below `OTHERS`.
        robots: the number of robots.
        boxes: the number of boxes.
        arguments: the xacro arguments of the robot.
        topics: the subscribed topics, each with its type.
        pixels: the width and height of images.
        way: the renderer of images, a value of ``MUJOCO_GL``.
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
    way: str = ""
    bullet: bool = False
    drives: bool = False

    @property
    def is_here(self) -> bool:
        """Return whether the world exists."""
        return not self.world.endswith(".world") or (OTHERS / self.world).is_file()


_ALL = {"laser": "true", "camera": "true", "kinect": "true"}
_LASER = {"laser": "true"}
_TURTLEBOT = "turtlebot3_simulations_classic/turtlebot3_gazebo/worlds"
_WAREHOUSE = "aws_small_warehouse/worlds/no_roof_small_warehouse/no_roof_small_warehouse.world"
CASES = (
    Case("mbot, nobody listens", "0.8 of MuJoCo", bullet=True),
    Case("mbot, 360 rays at 10 Hz, IMU and odometry at 100 Hz", "33 ms", arguments=_LASER, topics=_LISTENED),
    Case("the same in the playground", world="playground", arguments=_LASER, topics=_LISTENED),
    Case(
        "the same, camera at 30 Hz and depth at 20 Hz, 640x480",
        "500 ms",
        world="playground",
        arguments=_ALL,
        topics={**_LISTENED, **_PICTURES},
    ),
    Case(
        "the same, 320x240, by ray casting",
        "1000 ms",
        world="playground",
        arguments=_ALL,
        topics={**_LISTENED, **_PICTURES},
        pixels=(320, 240),
        way="off",
    ),
    *(
        Case(f"mbot with laser in {name}", world=path, arguments=_LASER, topics=_LISTENED)
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
    cases = (asyncio.run(_row(case)) for case in CASES if case.is_here)
    return [*cases, *(asyncio.run(_coming_row(count)) for count in (10, 100)), *_command_rows()]


async def _coming_row(count: int) -> Row:
    """Measure the processor time of adding robots to a running simulator, one after another."""
    graph = Graph(on_log=lambda _: None)
    simulator = Simulator(graph, NodeOptions(parameters={"world": str(WORLDS / "empty.world"), "usual_names": True}))
    text, here = _robot(_LASER), asyncio.Event()
    begin = time.process_time()
    for number in range(count):
        row, column = divmod(number, 10)
        place = (row * _BESIDE, column * _BESIDE, 0.12, 0.0, 0.0, 0.0, 1.0)
        spawn = partial(simulator.services.spawn, text, f"mbot{number}", place, f"mbot{number}")
        simulator.server.exchange.post(spawn)
    loop = asyncio.get_running_loop()
    simulator.server.exchange.post(lambda: loop.call_soon_threadsafe(here.set))
    await here.wait()
    taken = time.process_time() - begin
    simulator.close()
    await graph.close()
    return Row(f"{count} mbots with laser come to a running world", taken, "s", "5 s" if count == 100 else "")


def _command_rows() -> Iterator[Row]:
    """Measure the command without a page: the time until a tenth of a second is simulated, and the memory."""
    words = [LINKWRIGHT, "sim", "playground", str(MBOT), "laser:=true", "camera:=true", "--headless", "--rate", "max"]
    begun = [*words, "--seconds", "0.1"]
    yield Row("linkwright sim, until 0.1 s is simulated", commands({"it": begun}, 3)["it"], "s", "3 s")
    yield Row("memory of linkwright sim", peak_memory([*words, "--seconds", "2"]), "MB", "2000 MB")


async def _row(case: Case) -> Row:
    graph = Graph(on_log=lambda _: None)
    server = _server(graph, case)
    bullet = bullet_world(_robot({}), case.robots, case.boxes) if case.bullet else None
    listener = graph.create_node("listener")
    for topic, kind in (case.topics or {}).items():
        listener.create_subscription(get_message(kind), topic, lambda _: None, 10)
    if case.drives:
        _drive(listener, case.robots)
    try:
        with _made_by(case.way):
            for _ in range(NANOSECONDS_PER_SECOND // _SLICE):  # objects fall to the ground
                await _pass(graph, server)
                _advance(bullet)
            turns = await _take_turns(graph, server, bullet)
    finally:
        server.close()
        await graph.close()
        if bullet is not None:
            bullet.close()
    ours, *others = (statistics.median(turn) * 1000 * NANOSECONDS_PER_SECOND / _SLICE for turn in turns if turn)
    names = ("MuJoCo", "pybullet")
    beside: dict[str, float | None] = dict(zip(names, others, strict=False))
    return Row(case.what, ours, "ms", case.target, beside | ({"pybullet": None} if case.bullet and not bullet else {}))


async def _take_turns(
    graph: Graph, server: SimulationServer, bullet: BulletWorld | None
) -> tuple[list[float], list[float], list[float]]:
    """Return the processor times of each turn of ours, of MuJoCo and of Bullet, in seconds."""
    ours, alone, there = [], [], []
    begin = time.monotonic()
    for number in range(TURNS):
        if number >= _LEAST and time.monotonic() - begin > _LONGEST:
            break
        gc.collect()  # before each of both: it leaves the processor's caches cold
        ours.append(await _pass(graph, server))
        gc.collect()
        alone.append(_mujoco_alone(server.simulation))
        if bullet is not None:
            there.append(_timed(lambda: _advance(bullet)))
    return ours, alone, there


@contextmanager
def _made_by(way: str) -> Iterator[None]:
    """Render images with a given renderer in the context."""
    before = os.environ.get("MUJOCO_GL")
    if way:
        os.environ["MUJOCO_GL"] = way
    try:
        yield
    finally:
        if way:
            del os.environ["MUJOCO_GL"]
            if before is not None:
                os.environ["MUJOCO_GL"] = before


def _robot(arguments: Mapping[str, str], pixels: tuple[int, int] = (640, 480)) -> str:
    """Return the description of mbot."""
    text = str(expand(MBOT, arguments, packages={"my_robot_description": SHIPPED}))
    for name, usual, wanted in zip(("width", "height"), (640, 480), pixels, strict=True):
        text = text.replace(f"<{name}>{usual}<", f"<{name}>{wanted}<")
    return text.replace("<update_rate>50<", "<update_rate>100<")


def _server(graph: Graph, case: Case) -> SimulationServer:
    path = OTHERS / case.world if case.world.endswith(".world") else WORLDS / f"{case.world}.world"
    loaded = load_world(str(path))
    simulation = Simulation(loaded.world, loaded.finder)
    server = SimulationServer(simulation, graph.create_node("gazebo"), ServerOptions(usual_names=True))
    server.start()
    library = DescriptionLibrary()
    if case.robots:
        robot = read_entity(_robot(case.arguments or {}, case.pixels), loaded.finder, library).model
        for number in range(case.robots):
            row, column = divmod(number, 10)
            place = (row * _BESIDE, column * _BESIDE, 0.12, 0.0, 0.0, 0.0, 1.0)
            server.spawn(robot, f"mbot{number}", place, f"mbot{number}" if number else "")
    box = read_entity(_BOX, loaded.finder, library).model
    for number in range(case.boxes):
        row, column = divmod(number, 40)
        simulation.spawn(box, f"box{number}", (row * 0.5, column * 0.5, 0.125, 0.0, 0.0, 0.0, 1.0))
    return server


def _drive(node: Node, robots: int) -> None:
    """Make robots drive in circles, and subscribe to their odometry and transforms."""
    twist, listened = get_message("geometry_msgs/msg/Twist"), {"odom": _LISTENED["/odom"], "tf": _LISTENED["/tf"]}
    for number in range(robots):
        begin = f"/mbot{number}/" if number else "/"
        message = twist()
        message.linear.x, message.angular.z = 0.3, 0.3
        node.create_publisher(twist, f"{begin}cmd_vel", 10).publish(message)
        for name, kind in listened.items():
            node.create_subscription(get_message(kind), begin + name, lambda _: None, 10)


async def _pass(graph: Graph, server: SimulationServer) -> float:
    """Return the processor time of one of our turns in seconds, including the reception of messages."""
    begin = time.process_time()
    server.advance(_SLICE)
    await graph.settle()
    return time.process_time() - begin


def _mujoco_alone(simulation: Simulation) -> float:
    """Return the processor time of MuJoCo for a turn from the same state, in seconds."""
    mujoco, model = load_mujoco(), simulation.model
    simulation.refresh()
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, simulation.data)
    return _timed(lambda: mujoco.mj_step(model, data, nstep=_SLICE // simulation.step))


def _advance(bullet: BulletWorld | None) -> None:
    if bullet is not None:
        bullet.advance(_SLICE * 1000 // NANOSECONDS_PER_SECOND)


def _timed(function: Callable[[], object]) -> float:
    begin = time.process_time()
    function()
    return time.process_time() - begin


def main() -> None:
    """Measure and print."""
    show(rows())


if __name__ == "__main__":
    main()
