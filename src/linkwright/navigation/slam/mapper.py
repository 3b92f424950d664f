"""The map and the robot's pose in it, from laser scans and odometry, as in slam_toolbox (Karto).

As in Karto, some scans become nodes of a pose graph: each is matched against the latest ones, linked to nearby scans of
earlier passes, and matched against scans further away to close a loop.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.navigation.slam.contradiction import contradiction_share
from linkwright.navigation.slam.matching import Match, match
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.pose_graph import PoseGraph
from linkwright.navigation.slam.poses import Floats, compose, relative_pose, wrapped
from linkwright.navigation.slam.reference import Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.navigation.slam.steps import Steps

_TOLERANCE = 0.8
"""A scan is taken a little before the minimum travel distance is reached, for odometry may be wrong."""
_FEWEST_ON_WALLS = 0.25
_LEAST_INLIERS = 0.4
"""The least shares of points on known walls, for any match and for one with an earlier pass."""
_MOST_CONTRADICTION = 0.15
_WELL_KNOWN = 0.01
"""The variance of a position below which a link with an earlier pass leaves no loop open, metres squared."""
_LOOPS_TRIED = 3
_REDRAWN = 0.2
"""A scan is redrawn if its pose, or its points at 5 m, moved by more than this share of a cell."""
_FAR_POINT = 5.0
_NOTHING = 1e-3
"""The information in unmeasured directions, so that an inverse exists."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """The result of processing a scan.

    Attributes:
        pose: the pose of the robot in the map, of shape (3,).
        covariance: the covariance of the pose, of shape (3, 3), in the frame of the robot.
        matched: whether scan matching determined the pose; otherwise odometry did.
        response: the response of the match, 0 to 1.
        links: the number of earlier passes to which the scan was linked.
        loops: the number of closed loops.
    """

    pose: Floats
    covariance: Floats
    matched: bool
    response: float
    links: int = 0
    loops: int = 0


class Mapper:
    """A mapper that builds a graph of scans, and draws the map from the graph.

    Args:
        settings: the settings of the mapper.
        occupancy: the map that is drawn.

    Attributes:
        settings: the settings of the mapper.
        occupancy: the map that is drawn.
        graph: the poses of the scans, and the measurements between them.
        scans: the scans of the graph.
        odometry: the odometry pose of each scan, shape (3,).
    """

    def __init__(self, settings: MapperSettings, occupancy: OccupancyMap) -> None:
        self.settings = settings
        self.occupancy = occupancy
        self.graph = PoseGraph()
        self.scans: list[PlanarScan] = []
        self.odometry: list[Floats] = []
        self._last: tuple[Floats, int] | None = None
        self._in_map: Floats | None = None
        self._session = 0

    @property
    def latest_ns(self) -> int:
        """The time of the last processed scan in nanoseconds; 0 before the first scan."""
        return 0 if self._last is None else self._last[1]

    def replace(self, graph: PoseGraph, scans: list[PlanarScan], odometry: list[Floats]) -> None:
        """Replace the graph, and erase the old scans from the map; the new ones are not drawn yet."""
        for number in range(len(self.scans)):
            self.occupancy.erase(number)
        self.graph, self.scans, self.odometry = graph, scans, odometry
        self.begin_session(None)

    def begin_session(self, pose: Floats | None) -> None:
        """Start a session in the graph, whose first scan is matched around a pose.

        Scans of earlier sessions no longer count as the latest scans.

        Args:
            pose: the expected pose, of shape (3,); None for the pose of the graph's first scan.
        """
        self._session = len(self.scans)
        self._last = None
        self._in_map = None
        if pose is not None:
            self._in_map = pose.copy()
        elif len(self.graph.poses):
            self._in_map = self.graph.poses[0].copy()

    def should_process(self, odometry: Floats, stamp_ns: int, since: tuple[Floats, int] | None = None) -> bool:
        """Return whether enough time has passed and the robot moved far enough since the last scan.

        Args:
            odometry: the odometry pose at the scan, of shape (3,).
            stamp_ns: the time of the scan.
            since: the odometry pose and time of a queued scan that counts as the last one; None for the last processed
                scan.
        """
        last = since or self._last
        if last is None:
            return True
        pose, before_ns = last
        if stamp_ns - before_ns < self.settings.minimum_time_interval * 1e9:
            return False
        moved = relative_pose(pose, odometry)
        return bool(
            np.hypot(moved[0], moved[1]) >= _TOLERANCE * self.settings.minimum_travel_distance
            or abs(moved[2]) >= self.settings.minimum_travel_heading
        )

    def expected(self, odometry: Floats) -> Floats:
        """Return the pose in the map, of shape (3,), predicted by odometry since the last scan."""
        if self._in_map is None:
            return odometry
        return self._in_map if self._last is None else compose(self._in_map, relative_pose(self._last[0], odometry))

    def process(self, scan: PlanarScan, odometry: Floats) -> Steps[Outcome]:
        """Add a scan to the graph and draw the changes of the map, in steps.

        Args:
            scan: the scan.
            odometry: the odometry pose of the robot, of shape (3,).
        """
        searched = self._last is None and self._in_map is not None
        guess, moved = self.expected(odometry), None
        if self._last is not None:
            moved = relative_pose(self._last[0], odometry)
        self._last = odometry, scan.stamp_ns
        if searched and self.scans:
            return (yield from self._match_first_scan(scan, guess, odometry))
        uncertain = _odometric_information(moved if moved is not None else np.zeros(3))
        found = None
        buffer = self._buffer(guess)
        if moved is not None and buffer and self.settings.use_scan_matching:
            found = yield from self._match(buffer, scan, guess, self.settings.matching)
        pose = guess if found is None else found.pose
        number = self._add(scan, odometry, pose)
        information = uncertain if found is None else uncertain + found.information
        if moved is not None:
            self.graph.add_edge(number - 1, number, relative_pose(self.graph.poses[number - 1], pose), information)
        links = loops = 0
        if self.settings.use_scan_matching and moved is not None:
            links, loops = yield from self._link(number)
        if links or loops:
            yield from self.graph.solve()
        self._in_map = self.graph.poses[number].copy()
        yield from self.redraw()
        return _outcome(self._in_map, information, found, links, loops)

    def localize(self, scan: PlanarScan, odometry: Floats) -> Steps[Outcome]:
        """Localize a scan, in steps, without changing the graph.

        The arguments are those of `process`.
        """
        searched = self._last is None
        guess = self.expected(odometry)
        moved = np.zeros(3) if self._last is None else relative_pose(self._last[0], odometry)
        self._last = odometry, scan.stamp_ns
        window = self.settings.loop if searched else self.settings.matching
        found = yield from self._match(self._nearest_scans(guess), scan, guess, window)
        self._in_map = guess if found is None else found.pose
        information = _odometric_information(moved)
        if found is not None:
            information = information + found.information
        return _outcome(self._in_map, information, found)

    def redraw(self) -> Steps[None]:
        """Draw the scans that are missing in the map or whose poses changed; each scan is a step."""
        tolerance = _REDRAWN * self.occupancy.resolution
        for number, scan in enumerate(self.scans):
            pose, drawn = self.graph.poses[number], self.occupancy.drawn_at(number)
            if drawn is not None:
                away = relative_pose(drawn, pose)
                if np.hypot(away[0], away[1]) + _FAR_POINT * abs(away[2]) < tolerance:
                    continue
            self.occupancy.draw(number, scan, pose)
            yield

    def _add(self, scan: PlanarScan, odometry: Floats, pose: Floats) -> int:
        self.scans.append(scan)
        self.odometry.append(odometry)
        return self.graph.add_node(pose)

    def _match_first_scan(self, scan: PlanarScan, guess: Floats, odometry: Floats) -> Steps[Outcome]:
        """Add the first scan of a session, matched against scans of earlier sessions."""
        nodes = self._nearest_scans(guess)
        found = yield from self._match(nodes, scan, guess, self.settings.loop)
        pose = guess if found is None else found.pose
        number = self._add(scan, odometry, pose)
        information = _odometric_information(np.zeros(3))
        if found is not None:
            information = information + found.information
        nearest = self._nearest(nodes, pose) if nodes else number - 1
        self.graph.add_edge(nearest, number, relative_pose(self.graph.poses[nearest], pose), information)
        self._in_map = pose.copy()
        yield from self.redraw()
        return _outcome(pose, information, found)

    def _buffer(self, pose: Floats) -> list[int]:
        """Return the numbers of the latest scans of this session that are near a pose."""
        begin = max(self._session, len(self.scans) - self.settings.scan_buffer_size)
        near = self._distances(pose) <= self.settings.scan_buffer_maximum_scan_distance
        return [number for number in range(begin, len(self.scans)) if near[number]]

    def _nearest_scans(self, pose: Floats) -> list[int]:
        """Return the numbers of the scans nearest to a pose, of all sessions, nearest first."""
        order = np.argsort(self._distances(pose), kind="stable")
        return [int(index) for index in order[: 2 * self.settings.scan_buffer_size]]

    def _distances(self, pose: Floats) -> Floats:
        away = self.graph.poses[:, :2] - pose[:2]
        result: Floats = np.hypot(away[:, 0], away[:, 1])
        return result

    def _nearest(self, nodes: list[int], pose: Floats) -> int:
        return nodes[int(np.argmin(self._distances(pose)[nodes]))]

    def _match(self, nodes: list[int], scan: PlanarScan, guess: Floats, search: Search) -> Steps[Match | None]:
        """Match a scan against the scans of some nodes.

        Returns None if the match is not good enough or too far from the guess.
        """
        reference = Reference([self.scans[node] for node in nodes], self.graph.poses[nodes])
        yield
        found = yield from match(reference, scan, guess, search, expand=self.settings.use_response_expansion)
        if found is None or found.response < self.settings.link_match_minimum_response_fine:
            return None
        away = np.abs(found.pose - guess)[:2].max()
        return found if found.inliers > _FEWEST_ON_WALLS and away <= search.dimension else None

    def _link(self, number: int) -> Steps[tuple[int, int]]:
        """Link a new node to nodes of earlier passes, and close loops.

        Returns:
            The number of links, and the number of loops.
        """
        settings, links, loops = self.settings, 0, 0
        linked: set[int] = set()
        for chain in self._chains(number, settings.link_scan_maximum_distance):
            least = settings.link_match_minimum_response_fine
            found = yield from self._connect(number, chain, settings.matching, least)
            if found is not None:
                links += 1
                if _worst_variance(found) < _WELL_KNOWN:  # Along a corridor, a loop may still be open despite the link.
                    linked.update(chain)
        if not settings.do_loop_closing:
            return links, 0
        candidates = [
            chain
            for chain in self._chains(number, settings.loop_search_maximum_distance)
            if len(chain) >= settings.loop_match_minimum_chain_size and linked.isdisjoint(chain)
        ]
        for chain in candidates[:_LOOPS_TRIED]:
            if (yield from self._close(number, chain)):
                loops += 1
        return links, loops

    def _chains(self, number: int, distance: float) -> list[list[int]]:
        """Return the chains of consecutive nodes within a distance of a node, nearest first.

        The latest nodes before the given one are left out.
        """
        away = self._distances(self.graph.poses[number])
        last = number - self.settings.scan_buffer_size
        chains: list[list[int]] = []
        for index in np.flatnonzero(away[: max(last, 0)] <= distance).tolist():
            if chains and chains[-1][-1] == index - 1:
                chains[-1].append(index)
            else:
                chains.append([index])
        return sorted(chains, key=lambda chain: (float(away[chain].min()), chain[0]))

    def _close(self, number: int, chain: list[int]) -> Steps[bool]:
        """Try to close a loop with a chain of nodes, and return whether an edge was added."""
        settings = self.settings
        guess = self.graph.poses[number]
        found = yield from self._match(chain, self.scans[number], guess, settings.loop)
        if found is None or found.response < settings.loop_match_minimum_response_coarse:
            return False
        if _worst_variance(found) > settings.loop_match_maximum_variance_coarse:
            return False
        least = settings.loop_match_minimum_response_fine
        return (yield from self._connect(number, chain, settings.matching, least, around=found.pose)) is not None

    def _connect(
        self, number: int, chain: list[int], search: Search, least: float, *, around: Floats | None = None
    ) -> Steps[Match | None]:
        """Match a node against a chain of nodes, add an edge, and return the match.

        Returns None, without adding an edge, if the match is not certain.
        """
        scan = self.scans[number]
        guess = self.graph.poses[number] if around is None else around
        nodes = sorted(chain, key=lambda index: float(self._distances(guess)[index]))[: self.settings.scan_buffer_size]
        found = yield from self._match(nodes, scan, guess, search)
        if found is None or found.response < least or found.inliers < _LEAST_INLIERS:
            return None
        nearest = self._nearest(nodes, found.pose)
        pose = self.graph.poses[nearest]
        if contradiction_share(self.scans[nearest], pose, scan, found.pose) > _MOST_CONTRADICTION:
            return None
        information = found.information + _NOTHING * np.eye(3)
        self.graph.add_edge(nearest, number, relative_pose(pose, found.pose), information, doubtful=True)
        return found


def _worst_variance(found: Match) -> float:
    """Return the larger of a match's position variances along x and y, in square metres."""
    return float(np.linalg.inv(found.information + _NOTHING * np.eye(3)).diagonal()[:2].max())


def _outcome(pose: Floats, information: Floats, found: Match | None, links: int = 0, loops: int = 0) -> Outcome:
    covariance: Floats = np.asarray(np.linalg.inv(information), dtype=np.float64)
    response = 0.0 if found is None else found.response
    return Outcome(pose.copy(), covariance, found is not None, response, links, loops)


def _odometric_information(moved: Floats) -> Floats:
    """Return the information matrix, of shape (3, 3), of an odometry motion of shape (3,).

    The standard deviation is about 10 % of the motion.
    """
    turned = abs(float(wrapped(moved)[2]))
    along = 0.03 + 0.1 * float(np.hypot(moved[0], moved[1])) + 0.03 * turned
    around = 0.02 + 0.1 * turned + 0.05 * float(np.hypot(moved[0], moved[1]))
    result: Floats = np.diag((along**-2, along**-2, around**-2))
    return result
