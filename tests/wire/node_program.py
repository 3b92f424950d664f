"""Programs of this folder that are a node, on whichever rclpy their interpreter has."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node

from tests.wire.programs import serve

SECONDS = 60.0
"""How long a program waits for another one's answer."""


def serve_node(make: Callable[[str], Node], questions: str, *, threads: int = 1) -> None:
    """Run a node, and answer questions by its methods until standard input is closed.

    Args:
        make: makes the node, of the name that the program is called with.
        questions: the names of the methods.
        threads: that run its callbacks.
    """
    rclpy.init()
    node = make(sys.argv[1])
    executor = SingleThreadedExecutor() if threads == 1 else MultiThreadedExecutor(threads)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    serve({question: getattr(node, question) for question in questions.split()})
    rclpy.shutdown()


def result_of(future: Any, seconds: float = SECONDS) -> Any:
    """What another thread hands over.

    Raises:
        TimeoutError: not in time.
    """
    came = threading.Event()
    future.add_done_callback(lambda _: came.set())
    if not came.wait(seconds):
        raise TimeoutError
    return future.result()
