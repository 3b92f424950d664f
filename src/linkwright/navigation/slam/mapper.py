"""A mapper, as in slam_toolbox (Karto): map and pose from laser scans and odometry.

As in Karto, some scans become nodes of a pose graph. Each new node is matched against the latest scans, linked to
nearby scans of earlier passes, and matched against scans farther away to close a loop.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.navigation.slam.contradiction import compute_contradiction_share
from linkwright.navigation.slam.matching import Match, match_scan
from linkwright.navigation.slam.occupancy import OccupancyMap
from linkwright.navigation.slam.pose_graph import PoseGraph
from linkwright.navigation.slam.poses import FloatArray, compose, relative_pose, wrap_angles
from linkwright.navigation.slam.reference import Reference
from linkwright.navigation.slam.scan import PlanarScan
from linkwright.navigation.slam.search import Search
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.navigation.slam.steps import Steps

_TRAVEL_FRACTION = 0.8
"""The fraction of the minimum travel distance after which a scan is processed, because odometry may be wrong."""
_MIN_INLIER_FRACTION = 0.25
"""The minimum fraction of a scan's points that must fit for a match."""
_MIN_LINK_INLIER_FRACTION = 0.4
"""The minimum shares of points on known walls, for any match and for a match with an earlier pass."""
_MAX_CONTRADICTING_FRACTION = 0.15
"""The maximum contradiction of two linked scans, as a fraction of the points."""
_MAX_LINK_VARIANCE = 0.01
"""A link to an earlier pass closes the loop if the variance of its position is below this, in square meters."""
_MAX_LOOP_CANDIDATES = 3
_REDRAW_FRACTION = 0.2
"""A scan is redrawn if its points at `_FAR_POINT_DISTANCE_M` moved by at least this fraction of a cell."""
_FAR_POINT_DISTANCE_M = 5.0
_MIN_INFORMATION = 1e-3
"""Information added in all directions, so that the matrix can be inverted."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """The result of processing a scan.

    Attributes:
        pose: the pose of the robot in the map, of shape (3,).
        covariance: the covariance of the pose, of shape (3, 3), in the frame of the robot.
        is_matched: whether scan matching determined the pose; otherwise odometry did.
        response: the response of the match, 0 to 1.
        link_count: the number of earlier passes to which the scan was linked.
        loop_count: the number of closed loops.
    """

    pose: FloatArray
    covariance: FloatArray
    is_matched: bool
    response: float
    link_count: int = 0
    loop_count: int = 0


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
        self.odometry: list[FloatArray] = []
        self._last_processed: tuple[FloatArray, int] | None = None
        self._map_pose: FloatArray | None = None
        self._session = 0

    @property
    def latest_ns(self) -> int:
        """The time of the last processed scan in nanoseconds, or 0 before the first scan."""
        return 0 if self._last_processed is None else self._last_processed[1]

    def replace_graph(self, graph: PoseGraph, scans: list[PlanarScan], odometry: list[FloatArray]) -> None:
        """Replace the graph, and erase the old scans from the map.

        The new scans are not drawn yet.
        """
        for index in range(len(self.scans)):
            self.occupancy.erase(index)
        self.graph, self.scans, self.odometry = graph, scans, odometry
        self.begin_session(None)

    def begin_session(self, pose: FloatArray | None) -> None:
        """Start a new session at a pose.

        The first scan is matched around this pose. Scans of earlier sessions no longer count as the latest scans.

        Args:
            pose: the expected pose, of shape (3,); None for the pose of the graph's first scan.
        """
        self._session = len(self.scans)
        self._last_processed = None
        self._map_pose = None
        if pose is not None:
            self._map_pose = pose.copy()
        elif len(self.graph.poses):
            self._map_pose = self.graph.poses[0].copy()

    def should_process(self, odometry: FloatArray, stamp_ns: int, since: tuple[FloatArray, int] | None = None) -> bool:
        """Return whether enough time has passed and the robot has moved or turned enough.

        Args:
            odometry: the odometry pose at the scan, of shape (3,).
            stamp_ns: the time of the scan.
            since: the odometry pose and time of a queued scan that counts as the last scan; None for the last
                processed scan.
        """
        reference = since or self._last_processed
        if reference is None:
            return True
        pose, previous_ns = reference
        if stamp_ns - previous_ns < self.settings.minimum_time_interval * 1e9:
            return False
        motion = relative_pose(pose, odometry)
        return bool(
            np.hypot(motion[0], motion[1]) >= _TRAVEL_FRACTION * self.settings.minimum_travel_distance
            or abs(motion[2]) >= self.settings.minimum_travel_heading
        )

    def predict_pose(self, odometry: FloatArray) -> FloatArray:
        """Return the pose in the map, of shape (3,), predicted by odometry since the last scan."""
        if self._map_pose is None:
            return odometry
        return (
            self._map_pose
            if self._last_processed is None
            else compose(self._map_pose, relative_pose(self._last_processed[0], odometry))
        )

    def process(self, scan: PlanarScan, odometry: FloatArray) -> Steps[Outcome]:
        """Add a scan to the graph and draw the changes to the map, in steps.

        Args:
            scan: the laser scan in the frame of the robot.
            odometry: the odometry pose of the robot, of shape (3,).
        """
        is_first_of_session = self._last_processed is None and self._map_pose is not None
        guess, motion = self.predict_pose(odometry), None
        if self._last_processed is not None:
            motion = relative_pose(self._last_processed[0], odometry)
        self._last_processed = odometry, scan.stamp_ns
        if is_first_of_session and self.scans:
            return (yield from self._match_first_scan(scan, guess, odometry))
        odometric_information = _compute_odometric_information(motion if motion is not None else np.zeros(3))
        best_match = None
        latest_scans = self._find_recent_scans_near(guess)
        if motion is not None and latest_scans and self.settings.use_scan_matching:
            best_match = yield from self._match(latest_scans, scan, guess, self.settings.matching)
        pose = guess if best_match is None else best_match.pose
        number = self._add(scan, odometry, pose)
        information = odometric_information if best_match is None else odometric_information + best_match.information
        if motion is not None:
            self.graph.add_edge(number - 1, number, relative_pose(self.graph.poses[number - 1], pose), information)
        links = loops = 0
        if self.settings.use_scan_matching and motion is not None:
            links, loops = yield from self._link(number)
        if links or loops:
            yield from self.graph.solve()
        self._map_pose = self.graph.poses[number].copy()
        yield from self.redraw()
        return _make_outcome(self._map_pose, information, best_match, links, loops)

    def localize(self, scan: PlanarScan, odometry: FloatArray) -> Steps[Outcome]:
        """Localize a scan, in steps, without changing the graph.

        The arguments are the same as for `process`.
        """
        is_first = self._last_processed is None
        guess = self.predict_pose(odometry)
        motion = np.zeros(3) if self._last_processed is None else relative_pose(self._last_processed[0], odometry)
        self._last_processed = odometry, scan.stamp_ns
        window = self.settings.loop if is_first else self.settings.matching
        best_match = yield from self._match(self._find_nearest_scans(guess), scan, guess, window)
        self._map_pose = guess if best_match is None else best_match.pose
        information = _compute_odometric_information(motion)
        if best_match is not None:
            information = information + best_match.information
        return _make_outcome(self._map_pose, information, best_match)

    def redraw(self) -> Steps[None]:
        """Draw the scans that are not in the map yet or whose poses changed.

        Each scan is a step.
        """
        tolerance = _REDRAW_FRACTION * self.occupancy.resolution
        for index, scan in enumerate(self.scans):
            pose, drawn_pose = self.graph.poses[index], self.occupancy.get_drawn_pose(index)
            if drawn_pose is not None:
                change = relative_pose(drawn_pose, pose)
                if np.hypot(change[0], change[1]) + _FAR_POINT_DISTANCE_M * abs(change[2]) < tolerance:
                    continue
            self.occupancy.draw(index, scan, pose)
            yield

    def _add(self, scan: PlanarScan, odometry: FloatArray, pose: FloatArray) -> int:
        self.scans.append(scan)
        self.odometry.append(odometry)
        return self.graph.add_node(pose)

    def _match_first_scan(self, scan: PlanarScan, guess: FloatArray, odometry: FloatArray) -> Steps[Outcome]:
        """Add the first scan of a session, matched against scans of earlier sessions."""
        nodes = self._find_nearest_scans(guess)
        best_match = yield from self._match(nodes, scan, guess, self.settings.loop)
        pose = guess if best_match is None else best_match.pose
        number = self._add(scan, odometry, pose)
        information = _compute_odometric_information(np.zeros(3))
        if best_match is not None:
            information = information + best_match.information
        nearest = self._find_nearest_node(nodes, pose) if nodes else number - 1
        self.graph.add_edge(nearest, number, relative_pose(self.graph.poses[nearest], pose), information)
        self._map_pose = pose.copy()
        yield from self.redraw()
        return _make_outcome(pose, information, best_match)

    def _find_recent_scans_near(self, pose: FloatArray) -> list[int]:
        """Return the numbers of the latest scans of this session that are near a pose."""
        begin = max(self._session, len(self.scans) - self.settings.scan_buffer_size)
        is_near = self._compute_distances(pose) <= self.settings.scan_buffer_maximum_scan_distance
        return [number for number in range(begin, len(self.scans)) if is_near[number]]

    def _find_nearest_scans(self, pose: FloatArray) -> list[int]:
        """Return the numbers of the scans nearest to a pose, of all sessions, nearest first."""
        order = np.argsort(self._compute_distances(pose), kind="stable")
        return [int(index) for index in order[: 2 * self.settings.scan_buffer_size]]

    def _compute_distances(self, pose: FloatArray) -> FloatArray:
        offsets = self.graph.poses[:, :2] - pose[:2]
        result: FloatArray = np.hypot(offsets[:, 0], offsets[:, 1])
        return result

    def _find_nearest_node(self, nodes: list[int], pose: FloatArray) -> int:
        return nodes[int(np.argmin(self._compute_distances(pose)[nodes]))]

    def _match(self, nodes: list[int], scan: PlanarScan, guess: FloatArray, search: Search) -> Steps[Match | None]:
        """Match a scan against the scans of some nodes.

        Returns None if the match is not good enough or is too far from the guess.
        """
        reference = Reference([self.scans[node] for node in nodes], self.graph.poses[nodes])
        yield
        best_match = yield from match_scan(reference, scan, guess, search, expand=self.settings.use_response_expansion)
        if best_match is None or best_match.response < self.settings.link_match_minimum_response_fine:
            return None
        offset = np.abs(best_match.pose - guess)[:2].max()
        return best_match if best_match.inliers > _MIN_INLIER_FRACTION and offset <= search.dimension else None

    def _link(self, node: int) -> Steps[tuple[int, int]]:
        """Link a new node to nodes of earlier passes, and close loops.

        Returns:
            The number of links, and the number of loops.
        """
        settings, links, loops = self.settings, 0, 0
        linked_nodes: set[int] = set()
        for chain in self._find_chains(node, settings.link_scan_maximum_distance):
            min_response = settings.link_match_minimum_response_fine
            best_match = yield from self._connect(node, chain, settings.matching, min_response)
            if best_match is not None:
                links += 1
                if (
                    _find_worst_variance(best_match) < _MAX_LINK_VARIANCE
                ):  # Along a corridor, a loop may still be open despite the link.
                    linked_nodes.update(chain)
        if not settings.do_loop_closing:
            return links, 0
        candidates = [
            chain
            for chain in self._find_chains(node, settings.loop_search_maximum_distance)
            if len(chain) >= settings.loop_match_minimum_chain_size and linked_nodes.isdisjoint(chain)
        ]
        for chain in candidates[:_MAX_LOOP_CANDIDATES]:
            if (yield from self._close_loop(node, chain)):
                loops += 1
        return links, loops

    def _find_chains(self, node: int, distance: float) -> list[list[int]]:
        """Return the chains of consecutive nodes within a distance of a node, nearest first.

        The latest nodes before this node are left out.
        """
        distances = self._compute_distances(self.graph.poses[node])
        end = node - self.settings.scan_buffer_size
        chains: list[list[int]] = []
        for index in np.flatnonzero(distances[: max(end, 0)] <= distance).tolist():
            if chains and chains[-1][-1] == index - 1:
                chains[-1].append(index)
            else:
                chains.append([index])
        return sorted(chains, key=lambda chain: (float(distances[chain].min()), chain[0]))

    def _close_loop(self, node: int, chain: list[int]) -> Steps[bool]:
        """Try to close a loop with a chain of nodes, and return whether an edge was added."""
        settings = self.settings
        guess = self.graph.poses[node]
        best_match = yield from self._match(chain, self.scans[node], guess, settings.loop)
        if best_match is None or best_match.response < settings.loop_match_minimum_response_coarse:
            return False
        if _find_worst_variance(best_match) > settings.loop_match_maximum_variance_coarse:
            return False
        min_response = settings.loop_match_minimum_response_fine
        return (
            yield from self._connect(node, chain, settings.matching, min_response, around=best_match.pose)
        ) is not None

    def _connect(
        self, node: int, chain: list[int], search: Search, min_response: float, *, around: FloatArray | None = None
    ) -> Steps[Match | None]:
        """Match a node against a chain of nodes, add an edge, and return the match.

        Returns None and adds no edge if the match is not certain.
        """
        scan = self.scans[node]
        guess = self.graph.poses[node] if around is None else around
        nodes = sorted(chain, key=lambda index: float(self._compute_distances(guess)[index]))[
            : self.settings.scan_buffer_size
        ]
        best_match = yield from self._match(nodes, scan, guess, search)
        if best_match is None or best_match.response < min_response or best_match.inliers < _MIN_LINK_INLIER_FRACTION:
            return None
        nearest = self._find_nearest_node(nodes, best_match.pose)
        pose = self.graph.poses[nearest]
        if compute_contradiction_share(self.scans[nearest], pose, scan, best_match.pose) > _MAX_CONTRADICTING_FRACTION:
            return None
        information = best_match.information + _MIN_INFORMATION * np.eye(3)
        self.graph.add_edge(nearest, node, relative_pose(pose, best_match.pose), information, is_doubtful=True)
        return best_match


def _find_worst_variance(best_match: Match) -> float:
    """Return the larger of a match's position variances along x and y, in square meters."""
    return float(np.linalg.inv(best_match.information + _MIN_INFORMATION * np.eye(3)).diagonal()[:2].max())


def _make_outcome(
    pose: FloatArray, information: FloatArray, best_match: Match | None, links: int = 0, loops: int = 0
) -> Outcome:
    covariance: FloatArray = np.asarray(np.linalg.inv(information), dtype=np.float64)
    response = 0.0 if best_match is None else best_match.response
    return Outcome(pose.copy(), covariance, best_match is not None, response, links, loops)


def _compute_odometric_information(motion: FloatArray) -> FloatArray:
    """Return the information matrix, of shape (3, 3), of an odometry motion of shape (3,).

    The standard deviations are 3 cm and 0.02 rad at rest, and grow by about 10 % of the motion.
    """
    rotation = abs(float(wrap_angles(motion)[2]))
    position_deviation = 0.03 + 0.1 * float(np.hypot(motion[0], motion[1])) + 0.03 * rotation
    yaw_deviation = 0.02 + 0.1 * rotation + 0.05 * float(np.hypot(motion[0], motion[1]))
    result: FloatArray = np.diag((position_deviation**-2, position_deviation**-2, yaw_deviation**-2))
    return result
