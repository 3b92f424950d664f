"""Names from the running graph, read from a cache.

Discovering the nodes of other processes takes too long after TAB is pressed. Completion therefore offers the names of
the last discovery, and starts a new discovery in another process.
"""

from __future__ import annotations

import json
import os
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.files.user_folders import cache_folder

if TYPE_CHECKING:
    from linkwright.cli.session import Session

_REFRESH_AGE_S = 2.0
"""Seconds for which the cached names are not refreshed."""
_MAX_AGE_S = 600.0
"""Seconds after which the cached names are too old to offer."""


def read_names(kind: str) -> list[str]:
    """Return the cached names of a kind, and start a discovery if they are out of date.

    Args:
        kind: ``topics``, ``nodes``, ``services`` or ``actions``.

    Returns:
        The names, or an empty list if there is no cache or the cache is too old.
    """
    path = _find_cache_path()
    try:
        age = time.time() - path.stat().st_mtime
        names: list[str] = json.loads(path.read_text(encoding="utf-8"))[kind]
    except (OSError, ValueError, KeyError):
        age, names = _MAX_AGE_S, []
    if age > _REFRESH_AGE_S:
        _start_discovery(path)
    return names if age < _MAX_AGE_S else []


def _find_cache_path() -> Path:
    return cache_folder() / "completion" / f"graph-{os.environ.get('ROS_DOMAIN_ID') or 0}.json"


def _start_discovery(path: Path) -> None:
    """Start a discovery in another process, unless one started less than `_REFRESH_AGE_S` ago."""
    marker = path.with_suffix(".begun")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        if marker.exists() and time.time() - marker.stat().st_mtime < _REFRESH_AGE_S:
            return
        marker.touch()
        import subprocess

        subprocess.Popen(
            [sys.executable, "-m", "linkwright.cli.completion.graph_names"],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )


def discover() -> int:
    """Discover the names of the graph, cache them for `read_names`, and return the exit status."""
    from argparse import Namespace

    from linkwright.cli.calls import list_node_names
    from linkwright.cli.lookup import sort_visible_names
    from linkwright.cli.session import run_in_graph

    async def job(session: Session) -> int:
        node = session.node
        names_by_kind = {
            "topics": [name for name, _ in sort_visible_names(node.get_topic_names_and_types(), hidden=False)],
            "services": [name for name, _ in sort_visible_names(node.get_service_names_and_types(), hidden=False)],
            "nodes": list_node_names(session, hidden=False),
        }
        suffix = "/_action/feedback"
        topics = [name for name, _ in node.get_topic_names_and_types()]
        names_by_kind["actions"] = sorted(name.removesuffix(suffix) for name in topics if name.endswith(suffix))
        path = _find_cache_path()
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary_path = path.with_suffix(f".{os.getpid()}")
        temporary_path.write_text(json.dumps(names_by_kind), encoding="utf-8")
        temporary_path.replace(path)
        return 0

    return run_in_graph(Namespace(), job, read_only=True)


if __name__ == "__main__":
    raise SystemExit(discover())
