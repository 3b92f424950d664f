"""The worker that processes only the latest item."""

from __future__ import annotations

import threading

from linkwright.vision.nodes.latest_worker import LatestWorker
from tests.waiting import TIMEOUT_S, wait_until


def test_busy_worker_keeps_only_latest_item():
    processed: list[int] = []
    has_begun, may_continue = threading.Event(), threading.Event()

    def work(item: int) -> None:
        has_begun.set()
        assert may_continue.wait(TIMEOUT_S)
        processed.append(item)

    worker = LatestWorker(lambda: work, "slow")
    worker.offer(0)
    assert has_begun.wait(TIMEOUT_S)
    for item in range(1, 50):
        worker.offer(item)
    may_continue.set()
    wait_until(lambda: len(processed) == 2)
    worker.close()
    assert processed == [0, 49]


def test_close_waits_for_current_item_and_drops_rest():
    processed: list[int] = []
    has_begun, may_continue = threading.Event(), threading.Event()

    def work(item: int) -> None:
        has_begun.set()
        assert may_continue.wait(TIMEOUT_S)
        processed.append(item)

    worker = LatestWorker(lambda: work, "slow")
    worker.offer(0)
    assert has_begun.wait(TIMEOUT_S)
    worker.offer(1)
    closing = threading.Thread(target=worker.close)
    closing.start()
    wait_until(lambda: not worker.has_pending_item)
    may_continue.set()
    closing.join(TIMEOUT_S)
    worker.offer(2)
    assert processed == [0]
