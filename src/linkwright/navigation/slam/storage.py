"""Files that store a pose graph with its scans, in place of slam_toolbox's serialized maps.

A file is a NumPy archive of plain arrays, in a format of Linkwright. slam_toolbox serializes its C++ classes with
Boost, which other programs cannot read.
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
from linkwright.navigation.slam.poses import FloatArray
from linkwright.navigation.slam.scan import PlanarScan

EXTENSION = ".posegraph"
_FORMAT_VERSION = 1
_MAX_FILE_BYTES = 1 << 30


def graph_path(name: str) -> Path:
    """Return the path of a graph's file, with the extension added if it is missing."""
    return Path(name if name.endswith(EXTENSION) else name + EXTENSION)


def save_graph(mapper: Mapper, path: Path) -> None:
    """Save a mapper's graph and scans.

    Raises:
        OSError: the file cannot be written.
    """
    graph, scans = mapper.graph, mapper.scans
    arrays = {
        "format": np.array(_FORMAT_VERSION),
        "poses": graph.poses,
        "edges": np.array([graph.first, graph.second], dtype=np.int64),
        "measured": np.array(graph.measured).reshape(-1, 3),
        "information": np.array(graph.information).reshape(-1, 3, 3),
        "doubtful": np.array(graph.is_doubtful, dtype=bool),
        "odometry": np.array(mapper.odometry).reshape(-1, 3),
        "origins": np.array([scan.origin for scan in scans]).reshape(-1, 2),
        "stamps": np.array([scan.stamp_ns for scan in scans], dtype=np.int64),
        "counts": np.array([(len(scan.points), len(scan.free_ends)) for scan in scans], dtype=np.int64).reshape(-1, 2),
        "points": np.concatenate(
            [np.zeros((0, 2)), *(point_array for scan in scans for point_array in (scan.points, scan.free_ends))]
        ),
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
        data = read_file(path, _MAX_FILE_BYTES)
    except FileNotFoundError:
        message = phrase("the pose graph '{path}' does not exist", path=display_path(path))
        raise LinkwrightError(Diagnostic("NAV501", message, hint=missing_file_hint(path))) from None
    except OSError as error:
        raise _unreadable_error(path, foreign(error.strerror or error)) from None
    if b"serialization::archive" in data[:64]:
        raise _unreadable_error(path, phrase("slam_toolbox wrote it, in a format that only slam_toolbox can read"))
    try:
        graph, scans, odometry = _read(data)
    except (BadZipFile, KeyError, ValueError, IndexError, OSError, EOFError):
        raise _unreadable_error(path, phrase("it does not contain a pose graph")) from None
    mapper.replace_graph(graph, scans, odometry)


def _read(data: bytes) -> tuple[PoseGraph, list[PlanarScan], list[FloatArray]]:
    with np.load(BytesIO(data), allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    poses, edges, counts = arrays["poses"].reshape(-1, 3), arrays["edges"].reshape(2, -1), arrays["counts"]
    node_count, edge_count = len(poses), edges.shape[1]
    lengths = [len(arrays[name]) for name in ("odometry", "origins", "stamps", "counts")]
    if int(arrays["format"]) != _FORMAT_VERSION or lengths != [node_count] * 4 or counts.sum() != len(arrays["points"]):
        raise ValueError
    if edges.size and (edges.min() < 0 or edges.max() >= node_count):
        raise ValueError
    measured, information = arrays["measured"].reshape(edge_count, 3), arrays["information"].reshape(edge_count, 3, 3)
    doubtful = arrays["doubtful"].reshape(edge_count)
    if not all(np.isfinite(array).all() for array in (poses, measured, information, arrays["points"])):
        raise ValueError
    point_arrays = np.split(arrays["points"].reshape(-1, 2), np.cumsum(counts.ravel())[:-1])
    scans = [
        PlanarScan(
            point_arrays[2 * index], point_arrays[2 * index + 1], arrays["origins"][index], int(arrays["stamps"][index])
        )
        for index in range(node_count)
    ]
    first, second = edges.tolist()
    graph = PoseGraph(poses, first, second, list(measured), list(information), [bool(flag) for flag in doubtful])
    return graph, scans, list(arrays["odometry"])


def _unreadable_error(path: Path, reason: Phrase) -> LinkwrightError:
    message = phrase("the pose graph '{path}' cannot be read: {reason}", path=display_path(path), reason=reason)
    hint = phrase("create the map again, and save it with the service serialize_map")
    return LinkwrightError(Diagnostic("NAV501", message, hint=hint))
