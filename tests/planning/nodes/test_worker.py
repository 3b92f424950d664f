"""The computations of move_group beside the event loop: order, compiled scenes, threads and processes."""

from __future__ import annotations

import asyncio
import os
import signal
import threading
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.planning.effort import is_counted
from linkwright.planning.nodes.conversions import RequestError
from linkwright.planning.nodes.worker import PlanningWorker
from linkwright.planning.planner import Failure, PlanError
from tests.planning.nodes.bench import Bench, box, closed_room, endless_request, message
from tests.waiting import TIMEOUT_S

pytestmark = pytest.mark.extra("arm")


def worker_of(bench: Bench, *, has_process: bool = False) -> PlanningWorker:
    return PlanningWorker(
        bench.move_group._robot, bench.move_group._monitor, is_lockstep=False, has_process=has_process
    )


async def compiled(worker: PlanningWorker, scene: Any) -> Any:
    return await worker.run(scene, lambda _model, collisions, _must_stop: collisions)


def moved_wall() -> Any:
    scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
    scene.world.collision_objects = [box("front", 1.05, 0.1, 0.0, size=(1.9, 0.02, 3.0))]
    return scene


async def test_equal_scenes_are_compiled_once(bench) -> None:
    worker, scene = worker_of(bench), bench.move_group._monitor.scene
    empty = await compiled(worker, scene)
    assert await compiled(worker, scene.copy()) is empty
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    walls = await compiled(worker, scene)
    assert walls is not empty
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    assert await compiled(worker, scene) is walls
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=moved_wall())
    assert await compiled(worker, scene) is not walls


async def test_computations_in_lockstep_are_done_at_once(bench) -> None:
    worker = PlanningWorker(bench.move_group._robot, bench.move_group._monitor, is_lockstep=True, has_process=True)

    def compute(*_: Any) -> bool:
        assert threading.current_thread() is threading.main_thread()
        return is_counted()

    with pytest.raises(StopIteration) as ended:
        worker.run(None, compute).send(None)
    assert ended.value.value is True
    assert not is_counted()


async def test_computations_run_in_order_beside_the_event_loop(bench) -> None:
    worker, order, may_go = worker_of(bench), [], threading.Event()

    def compute(number: int) -> None:
        assert threading.current_thread() is not threading.main_thread()
        assert may_go.wait(20.0)
        order.append(number)

    tasks = [
        asyncio.ensure_future(worker.run(None, lambda _model, _scene, _must_stop, number=number: compute(number)))
        for number in range(3)
    ]
    await asyncio.sleep(0.05)  # The loop works while the first one waits in its thread.
    assert order == []
    may_go.set()
    await asyncio.gather(*tasks)
    assert order == [0, 1, 2]


async def test_next_computation_waits_for_the_thread_of_an_abandoned_one(bench) -> None:
    worker, order = worker_of(bench), []
    has_begun, may_go = threading.Event(), threading.Event()

    def compute(*_: Any) -> None:
        has_begun.set()
        assert may_go.wait(20.0)
        order.append("abandoned")

    first = asyncio.ensure_future(worker.run(None, compute))
    await asyncio.to_thread(has_begun.wait, 20.0)
    first.cancel()
    second = asyncio.ensure_future(worker.run(None, lambda *_: order.append("next")))
    await asyncio.sleep(0.05)
    may_go.set()
    await second
    assert order == ["abandoned", "next"]


async def test_services_do_not_wait_for_a_plan(bench) -> None:
    """The planner is busy, and the kinematics have a thread and models of their own."""
    planning, request = bench.move_group._planning, endless_request()
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    may_end = threading.Event()
    plan = asyncio.ensure_future(planning.plan(request, bench.move_group._monitor.scene, may_end.is_set))
    assert (await bench.call("GetStateValidity", "check_state_validity", group_name="arm")).contacts
    assert not plan.done()
    may_end.set()
    with pytest.raises(RequestError, match="canceled"):
        await plan


# --- the process ----------------------------------------------------------------------------------------------


@pytest.fixture
def worker(bench, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[3]))  # The process imports the functions below.
    worker = worker_of(bench, has_process=True)
    yield worker
    worker.stop()


def wait_for_file(path: Path, *_: Any) -> int:
    """Return the ID of the process that waits until a file exists."""
    deadline = time.monotonic() + TIMEOUT_S
    while not path.exists():
        assert time.monotonic() < deadline
        time.sleep(0.005)
    return os.getpid()


def describe(model: Any, scene: Any, _must_stop: Any) -> tuple[int, int, set[frozenset[str]]]:
    """Return the process, the identity of the compiled scene, and what collides when the arm reaches forward."""
    positions = np.array([1.5708 if name == "lift" else 0.0 for name in model.joint_names])
    return os.getpid(), id(scene), scene.colliding_pairs(positions)


def wait_until_canceled(path: Path, _model: Any, _scene: Any, must_stop: Any) -> None:
    path.touch()
    deadline = time.monotonic() + TIMEOUT_S
    while not must_stop():
        assert time.monotonic() < deadline
        time.sleep(0.005)
    raise PlanError(Failure.PREEMPTED)


def fail(error: Exception, *_: Any) -> None:
    raise error


async def test_process_compiles_scenes_that_changed(bench, worker) -> None:
    scene = bench.move_group._monitor.scene
    process, empty, _ = await worker.run(scene, describe)
    assert process != os.getpid()
    assert await worker.run(scene.copy(), describe) == (process, empty, set())
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    same_process, walls, pairs = await worker.run(scene, describe)
    assert (same_process, walls != empty) == (process, True)
    assert pairs
    assert {"front"} <= frozenset().union(*pairs)


async def test_cancellation_reaches_the_process(bench, worker, tmp_path) -> None:
    has_begun = tmp_path / "begun"
    with pytest.raises(PlanError) as caught:
        await worker.run(bench.move_group._monitor.scene, partial(wait_until_canceled, has_begun), has_begun.exists)
    assert caught.value.failure is Failure.PREEMPTED
    assert len(await worker.run(bench.move_group._monitor.scene, describe)) == 3  # The next one is not canceled.


async def test_errors_of_the_process_arrive_with_what_they_tell(bench, worker) -> None:
    scene = bench.move_group._monitor.scene
    with pytest.raises(PlanError, match="because") as caught:
        await worker.run(scene, partial(fail, PlanError(Failure.GOAL_IN_COLLISION, reason="because")))
    assert caught.value.failure is Failure.GOAL_IN_COLLISION
    with pytest.raises(RuntimeError, match="ValueError: a defect"):
        await worker.run(scene, partial(fail, ValueError("a defect")))


async def test_next_computation_starts_another_process_after_one_that_was_killed(bench, worker, tmp_path) -> None:
    scene = bench.move_group._monitor.scene
    process, *_ = await worker.run(scene, describe)
    waiting = asyncio.ensure_future(worker.run(scene, partial(wait_for_file, tmp_path / "never")))
    os.kill(process, signal.SIGKILL)
    with pytest.raises(PlanError, match="ended with status -9"):
        await waiting
    other_process, *_ = await worker.run(scene, describe)
    assert other_process != process


async def test_closed_node_ends_the_process_during_a_computation(bench, worker, tmp_path) -> None:
    scene = bench.move_group._monitor.scene
    process, *_ = await worker.run(scene, describe)
    waiting = asyncio.ensure_future(worker.run(scene, partial(wait_for_file, tmp_path / "never")))
    await asyncio.sleep(0.0)
    worker.stop()
    with pytest.raises((PlanError, RequestError)):
        await waiting
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)
