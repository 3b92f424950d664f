"""Functions for the programs of this folder that are a node.

They run on any rclpy of the interpreter.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node

from tests.wire.programs import serve

TIMEOUT_S = 60.0
"""The time limit for another program's answer."""


def serve_node(make: Callable[[str], Node], questions: str, *, threads: int = 1) -> None:
    """Run a node whose methods answer questions until standard input is closed.

    Args:
        make: creates the node with the name that is the program's argument.
        questions: the names of the methods.
        threads: the number of threads that run its callbacks.
    """
    rclpy.init()
    node = make(sys.argv[1])
    executor = SingleThreadedExecutor() if threads == 1 else MultiThreadedExecutor(threads)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    serve({question: getattr(node, question) for question in questions.split()})
    rclpy.shutdown()


def result_of(future: Any, seconds: float = TIMEOUT_S) -> Any:
    """Return the result that another thread delivers.

    Raises:
        TimeoutError: the result is not there in time.
    """
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    if not done.wait(seconds):
        raise TimeoutError
    return future.result()
