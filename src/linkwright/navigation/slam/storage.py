"""Files that store a pose graph with its scans, in place of slam_toolbox's serialised maps.

A file is a NumPy archive of plain arrays in Linkwright's own format: slam_toolbox writes the memory of its C++
classes, serialised by Boost, which other programs cannot read.
"""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import read_file
from linkwright.files.whole_files import write_whole_file
from linkwright.navigation.slam.mapper import Mapper
from linkwright.navigation.slam.pose_graph import PoseGraph
from linkwright.navigation.slam.poses import Floats
from linkwright.navigation.slam.scan import PlanarScan

ENDING = ".posegraph"
_FORMAT = 1
_LARGEST_FILE = 1 << 30


def path_of(name: str) -> Path:
    """Return the path of a graph's file, with the extension added if the name lacks it."""
    return Path(name if name.endswith(ENDING) else name + ENDING)


def save_graph(mapper: Mapper, path: Path) -> None:
    """Save a mapper's graph and scans.

    Raises:
        OSError: the file cannot be written.
    """
    graph, scans = mapper.graph, mapper.scans
    arrays = {
        "format": np.array(_FORMAT),
        "poses": graph.poses,
        "edges": np.array([graph.first, graph.second], dtype=np.int64),
        "measured": np.array(graph.measured).reshape(-1, 3),
        "information": np.array(graph.information).reshape(-1, 3, 3),
        "doubtful": np.array(graph.doubtful, dtype=bool),
        "odometry": np.array(mapper.odometry).reshape(-1, 3),
        "origins": np.array([scan.origin for scan in scans]).reshape(-1, 2),
        "stamps": np.array([scan.stamp_ns for scan in scans], dtype=np.int64),
        "counts": np.array([(len(scan.points), len(scan.passed)) for scan in scans], dtype=np.int64).reshape(-1, 2),
        "points": np.concatenate([np.zeros((0, 2)), *(part for scan in scans for part in (scan.points, scan.passed))]),
    }
    file = BytesIO()
    np.savez_compressed(file, allow_pickle=False, **arrays)
    write_whole_file(path, file.getvalue())


def load_graph(mapper: Mapper, path: Path) -> None:
    """Load a graph into a mapper, without drawing it yet.

    Raises:
        LinkwrightError: NAV501, the file does not exist, or does not contain a graph saved by Linkwright; the mapper is
            unchanged.
    """
    try:
        data = read_file(path, _LARGEST_FILE)
    except FileNotFoundError:
        message = phrase("the pose graph '{path}' does not exist", path=display_path(path))
        raise LinkwrightError(Diagnostic("NAV501", message, hint=missing_file_hint(path))) from None
    except OSError as error:
        raise _unreadable(path, foreign(error.strerror or error)) from None
    if b"serialization::archive" in data[:64]:
        raise _unreadable(
            path, phrase("it was written by slam_toolbox itself, in a format that only slam_toolbox reads")
        )
    try:
        graph, scans, odometry = _read(data)
    except (BadZipFile, KeyError, ValueError, IndexError, OSError, EOFError):
        raise _unreadable(path, phrase("it is not a pose graph")) from None
    mapper.replace(graph, scans, odometry)


def _read(data: bytes) -> tuple[PoseGraph, list[PlanarScan], list[Floats]]:
    with np.load(BytesIO(data), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    poses, edges, counts = arrays["poses"].reshape(-1, 3), arrays["edges"].reshape(2, -1), arrays["counts"]
    number, links = len(poses), edges.shape[1]
    lengths = [len(arrays[name]) for name in ("odometry", "origins", "stamps", "counts")]
    if int(arrays["format"]) != _FORMAT or lengths != [number] * 4 or counts.sum() != len(arrays["points"]):
        raise ValueError
    if edges.size and (edges.min() < 0 or edges.max() >= number):
        raise ValueError
    measured, information = arrays["measured"].reshape(links, 3), arrays["information"].reshape(links, 3, 3)
    doubtful = arrays["doubtful"].reshape(links)
    if not all(np.isfinite(array).all() for array in (poses, measured, information, arrays["points"])):
        raise ValueError
    parts = np.split(arrays["points"].reshape(-1, 2), np.cumsum(counts.ravel())[:-1])
    scans = [
        PlanarScan(parts[2 * index], parts[2 * index + 1], arrays["origins"][index], int(arrays["stamps"][index]))
        for index in range(number)
    ]
    first, second = edges.tolist()
    graph = PoseGraph(poses, first, second, list(measured), list(information), [bool(flag) for flag in doubtful])
    return graph, scans, list(arrays["odometry"])


def _unreadable(path: Path, reason: Phrase) -> LinkwrightError:
    message = phrase("the pose graph '{path}' cannot be read: {reason}", path=display_path(path), reason=reason)
    hint = phrase("map the place again, and save it with the service serialize_map")
    return LinkwrightError(Diagnostic("NAV501", message, hint=hint))
