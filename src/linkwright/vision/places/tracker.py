"""Track objects from image to image, after ByteTrack.

Source: SORT (Bewley et al., 2016): boxes move with constant velocity and are assigned by their overlap; ByteTrack
(Zhang et al., 2022): detections with a low score keep tracks alive, but do not start them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.detections import Detections
from linkwright.vision.places.assignment import assign
from linkwright.vision.places.camera import Floats

_PLACE_NOISE = 0.05
"""The standard deviation of a box's edges, as a share of its size."""
_SPEED_NOISE = 2.0
"""The standard deviation of a new track's velocity, in sizes of its box a second."""
_ACCELERATION_NOISE = 3.0
"""The standard deviation of acceleration, in sizes of the box and seconds."""


@dataclass(frozen=True, slots=True)
class TrackerSettings:
    """Settings of tracking. Names and defaults are those of ByteTrack's file, where it has them.

    Attributes:
        high: detections with at least this score start tracks, and are matched first (``track_high_thresh``).
        low: detections with a lower score are ignored (``track_low_thresh``).
        new: the minimum score that starts a track (``new_track_thresh``).
        match: the maximum 1 - IoU of two boxes that belong to the same object (``match_thresh``).
        patience: how long a track without a detection is kept, seconds (``track_buffer``, 30 images at 30 Hz).
        births: the number of consecutive images that must show an object before it gets an ID.
    """

    high: float = 0.25
    low: float = 0.1
    new: float = 0.25
    match: float = 0.8
    patience: float = 1.0
    births: int = 2


@dataclass(slots=True)
class _Track:
    """A tracked object: centre and size (x, y, width, height), their velocities and covariance.

    Each of the four values has its own filter with the same model: the variances of value and velocity, and their
    covariance.
    """

    name: str
    state: Floats
    speed: Floats
    variance: Floats
    covariance: Floats
    speed_variance: Floats
    seen_at: float
    hits: int = 1
    id: int = 0

    def predict(self, seconds: float) -> None:
        noise = (_ACCELERATION_NOISE * self._scale()) ** 2
        self.state = self.state + self.speed * seconds
        self.state[2:] = np.maximum(self.state[2:], 1.0)
        self.variance = (
            self.variance + 2 * seconds * self.covariance + seconds**2 * self.speed_variance + noise * seconds**4 / 4
        )
        self.covariance = self.covariance + seconds * self.speed_variance + noise * seconds**3 / 2
        self.speed_variance = self.speed_variance + noise * seconds**2

    def correct(self, measured: Floats) -> None:
        noise = (_PLACE_NOISE * self._scale()) ** 2
        total = self.variance + noise
        gain, speed_gain = self.variance / total, self.covariance / total
        difference = measured - self.state
        self.state = self.state + gain * difference
        self.speed = self.speed + speed_gain * difference
        self.speed_variance = self.speed_variance - speed_gain * self.covariance
        self.covariance = (1 - gain) * self.covariance
        self.variance = (1 - gain) * self.variance

    def _scale(self) -> Floats:
        width, height = self.state[2], self.state[3]
        return np.array([width, height, width, height])


@dataclass(frozen=True, slots=True)
class _Seen:
    """The detections of an image: boxes as centre and size, names, and stamp."""

    boxes: Floats
    names: list[str]
    time: float


class Tracker:
    """Assigns objects IDs, which are never used again.

    Args:
        settings: how.
    """

    def __init__(self, settings: TrackerSettings | None = None) -> None:
        self._settings = settings or TrackerSettings()
        self._tracks: list[_Track] = []
        self._time: float | None = None
        self._last_id = 0

    def update(self, detections: Detections, time: float) -> list[int]:
        """Update the tracks with the detections of an image.

        Args:
            detections: all detections, including those with a low score.
            time: the time of the image, seconds. A jump back drops all tracks, but IDs continue.

        Returns:
            The ID of each detection; 0 for one without an ID yet.
        """
        settings = self._settings
        seconds = 0.0 if self._time is None else time - self._time
        if seconds < 0:
            self._tracks, seconds = [], 0.0
        self._time = time
        for track in self._tracks:
            track.predict(seconds)
        seen = _Seen(_centred(detections.boxes), [detections.name(index) for index in range(len(detections))], time)
        scores = detections.scores
        high = [index for index in range(len(detections)) if scores[index] >= settings.high]
        low = [index for index in range(len(detections)) if settings.low <= scores[index] < settings.high]
        owners = self._correct(self._tracks, high, seen)
        left = [track for track in self._tracks if track.id and track.seen_at != time]
        owners |= self._correct(left, low, seen)
        self._tracks = [track for track in self._tracks if not self._is_gone(track, time)]
        for index in high:
            if index not in owners and scores[index] >= settings.new:
                owners[index] = self._born(seen.names[index], seen.boxes[index], time)
                self._tracks.append(owners[index])
        for track in owners.values():
            if not track.id and track.hits >= settings.births:
                self._last_id += 1
                track.id = self._last_id
        return [owners[index].id if index in owners else 0 for index in range(len(detections))]

    def _correct(self, tracks: Sequence[_Track], candidates: Sequence[int], seen: _Seen) -> dict[int, _Track]:
        """Correct tracks by their matching detections, and return the tracks by detection."""
        owners: dict[int, _Track] = {}
        for row, column in self._pairs(tracks, candidates, seen):
            track, index = tracks[row], candidates[column]
            track.correct(seen.boxes[index])
            track.seen_at, track.hits = seen.time, track.hits + 1
            owners[index] = track
        return owners

    def _pairs(self, tracks: Sequence[_Track], candidates: Sequence[int], seen: _Seen) -> list[tuple[int, int]]:
        if not tracks or not candidates:
            return []
        expected = np.stack([track.state for track in tracks])
        costs = 1.0 - overlaps(_cornered(expected), _cornered(seen.boxes[list(candidates)]))
        same = [[track.name == seen.names[index] for index in candidates] for track in tracks]
        return assign(np.where(same, costs, np.inf), self._settings.match)

    def _is_gone(self, track: _Track, time: float) -> bool:
        return track.seen_at != time and (not track.id or time - track.seen_at > self._settings.patience)

    def _born(self, name: str, box: Floats, time: float) -> _Track:
        scale = np.array([box[2], box[3], box[2], box[3]])
        variance, speed_variance = (_PLACE_NOISE * scale) ** 2, (_SPEED_NOISE * scale) ** 2
        return _Track(name, box.copy(), np.zeros(4), variance, np.zeros(4), speed_variance, time)


def overlaps(first: NDArray[np.floating], second: NDArray[np.floating]) -> Floats:
    """Return the IoU of every pair of boxes from two sets.

    Args:
        first: left, top, right, bottom: shape ``(n, 4)``.
        second: shape ``(m, 4)``.

    Returns:
        Shape ``(n, m)``, 0 to 1.
    """
    corner = np.maximum(first[:, None, :2], second[None, :, :2])
    opposite = np.minimum(first[:, None, 2:], second[None, :, 2:])
    shared = np.prod(np.maximum(opposite - corner, 0.0), axis=-1)
    areas = [np.prod(np.maximum(boxes[:, 2:] - boxes[:, :2], 0.0), axis=-1) for boxes in (first, second)]
    union = areas[0][:, None] + areas[1][None, :] - shared
    result: Floats = shared / np.maximum(union, 1e-9)
    return result


def _centred(boxes: NDArray[np.floating]) -> Floats:
    corners = np.asarray(boxes, np.float64).reshape(-1, 4)
    return np.concatenate([(corners[:, :2] + corners[:, 2:]) / 2, corners[:, 2:] - corners[:, :2]], axis=1)


def _cornered(boxes: Floats) -> Floats:
    return np.concatenate([boxes[:, :2] - boxes[:, 2:] / 2, boxes[:, :2] + boxes[:, 2:] / 2], axis=1)
