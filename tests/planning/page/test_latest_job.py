"""Jobs of which only the newest matters."""

from __future__ import annotations

import asyncio

from linkwright.planning.page.latest_job import LatestJob
from tests.waiting import eventually


def make_job(gate: asyncio.Event, done: list[int], number: int):
    async def run() -> None:
        await gate.wait()
        done.append(number)

    return run


async def test_only_newest_waiting_job_runs():
    gate, done, idle = asyncio.Event(), [], []
    job = LatestJob(lambda: idle.append(list(done)))
    job.request(make_job(gate, done, 1))
    await asyncio.sleep(0)
    for number in (2, 3, 4):
        job.request(make_job(gate, done, number))
    gate.set()
    await eventually(lambda: not job.is_running)
    assert (done, idle) == ([1, 4], [[1, 4]])


async def test_canceled_jobs_do_not_run():
    gate, done = asyncio.Event(), []
    job = LatestJob()
    job.request(make_job(gate, done, 1))
    await asyncio.sleep(0)
    job.request(make_job(gate, done, 2))
    job.cancel()
    gate.set()
    await asyncio.sleep(0.01)
    assert done == []
    assert not job.is_running
    job.request(make_job(gate, done, 3))
    await eventually(lambda: done == [3])
