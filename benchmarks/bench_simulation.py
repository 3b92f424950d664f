"""Simulated worlds: how many simulated seconds pass in one of the processor's, beside MuJoCo alone.

Run it with ``python -m benchmarks simulation``. Every figure is the processor's time (ms) of a simulated second at
steps of 1 ms, with everything that is published and received in this process; "MuJoCo" is ``mj_step`` of the same model
from the same state in the same process, in turns. 1000 ms is real time on one processor.
"""

from __future__ import annotations

import asyncio
import gc
import statistics
import time
from collections.abc import Mapping
from dataclasses import dataclass

from benchmarks.measure import Row, show
from benchmarks.robots import REPOSITORY, SHIPPED
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import Graph
from linkwright.messages import get_message
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.server.entities import entity_from
from linkwright.simulation.server.server import ServerOptions, SimulationServer
from linkwright.simulation.server.worlds import load_world
from linkwright.simulation.simulation import NANOSECONDS, Simulation
from linkwright.xacro import expand

WORLDS = REPOSITORY / "robots" / "my_robot_gazebo" / "worlds"
MBOT = SHIPPED / "urdf" / "mbot_gazebo.xacro"
ROUNDS = 5
_SLICE = NANOSECONDS // 10
_BESIDE = 1.5
"""Metres from one robot to the next."""
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
    """What is simulated.

    Attributes:
        what: in words.
        target: what was promised.
        world: its name.
        robots: how many robots.
        boxes: how many boxes.
        arguments: of the robot's xacro.
        topics: what somebody listens to, with its type.
        pixels: width and height of pictures.
        seconds: how many simulated ones are timed at once.
    """

    what: str
    target: str = ""
    world: str = "empty"
    robots: int = 1
    boxes: int = 0
    arguments: Mapping[str, str] | None = None
    topics: Mapping[str, str] | None = None
    pixels: tuple[int, int] = (640, 480)
    seconds: int = 2


_ALL = {"laser": "true", "camera": "true", "kinect": "true"}
CASES = (
    Case("mbot, nobody listens", "0.8 of MuJoCo"),
    Case("mbot, 360 rays at 10 Hz, IMU and odometry at 100 Hz", "33 ms", arguments={"laser": "true"}, topics=_LISTENED),
    Case("the same in the playground", world="playground", arguments={"laser": "true"}, topics=_LISTENED),
    Case(
        "the same, camera at 30 Hz and depth at 20 Hz, 640x480",
        "500 ms",
        world="playground",
        arguments=_ALL,
        topics={**_LISTENED, **_PICTURES},
    ),
    Case("10 mbots, nobody listens", robots=10, seconds=1),
    Case("100 mbots, nobody listens", robots=100, seconds=1),
    Case("1 000 boxes at rest", robots=0, boxes=1000, seconds=1),
)


def rows() -> list[Row]:
    """Measure."""
    return [asyncio.run(_row(case)) for case in CASES]


async def _row(case: Case) -> Row:
    graph = Graph(on_log=lambda _: None)
    server = _server(graph, case)
    listener = graph.create_node("listener")
    for topic, kind in (case.topics or {}).items():
        listener.create_subscription(get_message(kind), topic, lambda _: None, 10)
    try:
        await _pass(graph, server, 1)  # things fall to the ground
        ours, alone = [], []
        for _ in range(ROUNDS):
            gc.collect()
            ours.append(await _pass(graph, server, case.seconds) / case.seconds)
            alone.append(_mujoco_alone(server.simulation, case.seconds) / case.seconds)
    finally:
        server.close()
        await graph.close()
    return Row(case.what, _milliseconds(ours), "ms", case.target, {"MuJoCo": _milliseconds(alone)})


def _milliseconds(seconds: list[float]) -> float:
    return statistics.median(seconds) * 1000


def _server(graph: Graph, case: Case) -> SimulationServer:
    loaded = load_world(str(WORLDS / f"{case.world}.world"))
    simulation = Simulation(loaded.world, loaded.finder)
    server = SimulationServer(simulation, graph.create_node("gazebo"), ServerOptions(usual_names=True))
    server.start()
    library = DescriptionLibrary()
    if case.robots:
        text = str(expand(MBOT, case.arguments, packages={"my_robot_description": SHIPPED}))
        text = text.replace("<update_rate>50<", "<update_rate>100<")
        robot = entity_from(text, loaded.finder, library).model
        for number in range(case.robots):
            row, column = divmod(number, 10)
            place = (row * _BESIDE, column * _BESIDE, 0.12, 0.0, 0.0, 0.0, 1.0)
            server.spawn(robot, f"mbot{number}", place, f"mbot{number}" if number else "")
    box = entity_from(_BOX, loaded.finder, library).model
    for number in range(case.boxes):
        row, column = divmod(number, 40)
        simulation.spawn(box, f"box{number}", (row * 0.5, column * 0.5, 0.125, 0.0, 0.0, 0.0, 1.0))
    return server


async def _pass(graph: Graph, server: SimulationServer, seconds: int) -> float:
    """The processor's seconds that some simulated ones take, receiving what is published among them."""
    begin = time.process_time()
    for _ in range(seconds * NANOSECONDS // _SLICE):
        server.advance(_SLICE)
        await graph.settle()
    return time.process_time() - begin


def _mujoco_alone(simulation: Simulation, seconds: int) -> float:
    """The processor's seconds that MuJoCo takes for some simulated ones from the same state on."""
    mujoco, model = load_mujoco(), simulation.model
    simulation.refresh()
    data = mujoco.MjData(model)
    mujoco.mj_copyData(data, model, simulation.data)
    begin = time.process_time()
    mujoco.mj_step(model, data, nstep=seconds * NANOSECONDS // simulation.step)
    return time.process_time() - begin


def main() -> None:
    """Measure and print."""
    show(rows())


if __name__ == "__main__":
    main()
