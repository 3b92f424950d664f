"""The thread of move_group's computations: order, compiled scenes, and an event loop that is not blocked."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest

from linkwright.planning.effort import is_counted
from linkwright.planning.nodes.worker import PlanningWorker
from tests.planning.nodes.bench import Bench, box, closed_room, message

pytestmark = pytest.mark.extra("arm")


def worker_of(bench: Bench) -> PlanningWorker:
    return PlanningWorker(bench.move_group._robot, bench.move_group._monitor, is_lockstep=False)


async def compiled(worker: PlanningWorker, scene: Any) -> Any:
    return await worker.run(scene, lambda _model, collisions, _must_stop: collisions)


async def test_equal_scenes_are_compiled_once(bench) -> None:
    worker, scene = worker_of(bench), bench.move_group._monitor.scene
    empty = await compiled(worker, scene)
    assert await compiled(worker, scene.copy()) is empty
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    walls = await compiled(worker, scene)
    assert walls is not empty
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
    assert await compiled(worker, scene) is walls
    changed = message("moveit_msgs/msg/PlanningScene", is_diff=True)
    changed.world.collision_objects = [box("front", 1.05, 0.1, 0.0, size=(1.9, 0.02, 3.0))]
    await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=changed)
    assert await compiled(worker, scene) is not walls


async def test_computations_in_lockstep_are_done_at_once(bench) -> None:
    worker = PlanningWorker(bench.move_group._robot, bench.move_group._monitor, is_lockstep=True)

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
    planning, may_go = bench.move_group._planning, threading.Event()
    plan = asyncio.ensure_future(planning.run(bench.move_group._monitor.scene, lambda _planner: may_go.wait(20.0)))
    assert (await bench.call("GetStateValidity", "check_state_validity", group_name="arm")).valid
    assert not plan.done()
    may_go.set()
    assert await plan
