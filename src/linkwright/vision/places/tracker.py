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

_MEASUREMENT_NOISE = 0.05
"""The standard deviation of a measured box's center and size, as a fraction of its size."""
_SPEED_NOISE = 2.0
"""The standard deviation of a new track's velocity, in box sizes per second."""
_ACCELERATION_NOISE = 3.0
"""The standard deviation of acceleration, in box sizes per second squared."""


@dataclass(frozen=True, slots=True)
class TrackerSettings:
    """The settings of a tracker, with ByteTrack's names and defaults where it has them.

    Attributes:
        high_threshold: detections with at least this score are matched first, and only they may start a track
            (``track_high_thresh``).
        low_threshold: detections with a lower score are ignored (``track_low_thresh``).
        new_track_score: the minimum score that starts a track (``new_track_thresh``).
        match_threshold: the maximum of 1 - IoU for two boxes of the same object (``match_thresh``).
        max_age: how long a track is kept without a detection, seconds (``track_buffer``, 30 images at 30 Hz).
        min_hits: the number of consecutive images that must show an object before it gets an ID.
    """

    high_threshold: float = 0.25
    low_threshold: float = 0.1
    new_track_score: float = 0.25
    match_threshold: float = 0.8
    max_age: float = 1.0
    min_hits: int = 2


@dataclass(slots=True)
class _Track:
    """A tracked object: its center and size, their velocities, and the covariances.

    The values are x, y, width and height. Each has a Kalman filter with constant velocity: the variances of value and
    velocity, and their covariance.
    """

    name: str
    state: Floats
    velocity: Floats
    variance: Floats
    covariance: Floats
    velocity_variance: Floats
    last_seen: float
    hits: int = 1
    id: int = 0

    def predict(self, seconds: float) -> None:
        """Move the state to a later time, and increase the variances."""
        noise = (_ACCELERATION_NOISE * self._get_box_scale()) ** 2
        self.state = self.state + self.velocity * seconds
        self.state[2:] = np.maximum(self.state[2:], 1.0)
        self.variance = (
            self.variance + 2 * seconds * self.covariance + seconds**2 * self.velocity_variance + noise * seconds**4 / 4
        )
        self.covariance = self.covariance + seconds * self.velocity_variance + noise * seconds**3 / 2
        self.velocity_variance = self.velocity_variance + noise * seconds**2

    def correct(self, measurement: Floats) -> None:
        """Correct the state by a measured box, and decrease the variances."""
        noise = (_MEASUREMENT_NOISE * self._get_box_scale()) ** 2
        total_variance = self.variance + noise
        gain, velocity_gain = self.variance / total_variance, self.covariance / total_variance
        residual = measurement - self.state
        self.state = self.state + gain * residual
        self.velocity = self.velocity + velocity_gain * residual
        self.velocity_variance = self.velocity_variance - velocity_gain * self.covariance
        self.covariance = (1 - gain) * self.covariance
        self.variance = (1 - gain) * self.variance

    def _get_box_scale(self) -> Floats:
        width, height = self.state[2], self.state[3]
        return np.array([width, height, width, height])


@dataclass(frozen=True, slots=True)
class _Frame:
    """The detections of an image: boxes as center and size, names, and the time in seconds."""

    boxes: Floats
    names: list[str]
    time: float


class Tracker:
    """A tracker that assigns IDs to objects.

    An ID is never reused.

    Args:
        settings: the settings; None for the defaults.
    """

    def __init__(self, settings: TrackerSettings | None = None) -> None:
        self._settings = settings or TrackerSettings()
        self._tracks: list[_Track] = []
        self._time: float | None = None
        self._last_id = 0

    def update(self, detections: Detections, time: float) -> list[int]:
        """Update the tracks with the detections of an image.

        Args:
            detections: all detections, including detections with a low score.
            time: the time of the image, seconds. A jump back drops all tracks; IDs are still never reused.

        Returns:
            The ID of each detection; 0 for a detection that has no ID yet.
        """
        settings = self._settings
        elapsed = 0.0 if self._time is None else time - self._time
        if elapsed < 0:
            self._tracks, elapsed = [], 0.0
        self._time = time
        for track in self._tracks:
            track.predict(elapsed)
        frame = _Frame(
            _to_center_form(detections.boxes), [detections.name(index) for index in range(len(detections))], time
        )
        scores = detections.scores
        high_indices = [index for index in range(len(detections)) if scores[index] >= settings.high_threshold]
        low_indices = [
            index
            for index in range(len(detections))
            if settings.low_threshold <= scores[index] < settings.high_threshold
        ]
        track_by_detection = self._correct_tracks(self._tracks, high_indices, frame)
        unmatched_tracks = [track for track in self._tracks if track.id and track.last_seen != time]
        track_by_detection |= self._correct_tracks(unmatched_tracks, low_indices, frame)
        self._tracks = [track for track in self._tracks if not self._is_expired(track, time)]
        for index in high_indices:
            if index not in track_by_detection and scores[index] >= settings.new_track_score:
                track_by_detection[index] = self._start_track(frame.names[index], frame.boxes[index], time)
                self._tracks.append(track_by_detection[index])
        for track in track_by_detection.values():
            if not track.id and track.hits >= settings.min_hits:
                self._last_id += 1
                track.id = self._last_id
        return [track_by_detection[index].id if index in track_by_detection else 0 for index in range(len(detections))]

    def _correct_tracks(self, tracks: Sequence[_Track], candidates: Sequence[int], frame: _Frame) -> dict[int, _Track]:
        """Update tracks with matching detections, and return the track for each such detection."""
        track_by_detection: dict[int, _Track] = {}
        for row, column in self._match(tracks, candidates, frame):
            track, index = tracks[row], candidates[column]
            track.correct(frame.boxes[index])
            track.last_seen, track.hits = frame.time, track.hits + 1
            track_by_detection[index] = track
        return track_by_detection

    def _match(self, tracks: Sequence[_Track], candidates: Sequence[int], frame: _Frame) -> list[tuple[int, int]]:
        if not tracks or not candidates:
            return []
        predicted = np.stack([track.state for track in tracks])
        costs = 1.0 - pairwise_iou(_to_corner_form(predicted), _to_corner_form(frame.boxes[list(candidates)]))
        same_class = [[track.name == frame.names[index] for index in candidates] for track in tracks]
        return assign(np.where(same_class, costs, np.inf), self._settings.match_threshold)

    def _is_expired(self, track: _Track, time: float) -> bool:
        return track.last_seen != time and (not track.id or time - track.last_seen > self._settings.max_age)

    def _start_track(self, name: str, box: Floats, time: float) -> _Track:
        scale = np.array([box[2], box[3], box[2], box[3]])
        variance, speed_variance = (_MEASUREMENT_NOISE * scale) ** 2, (_SPEED_NOISE * scale) ** 2
        return _Track(name, box.copy(), np.zeros(4), variance, np.zeros(4), speed_variance, time)


def pairwise_iou(first: NDArray[np.floating], second: NDArray[np.floating]) -> Floats:
    """Return the IoU of every pair of boxes from two sets.

    Args:
        first: left, top, right, bottom: shape ``(n, 4)``.
        second: shape ``(m, 4)``.

    Returns:
        Shape ``(n, m)``, 0 to 1.
    """
    top_left = np.maximum(first[:, None, :2], second[None, :, :2])
    bottom_right = np.minimum(first[:, None, 2:], second[None, :, 2:])
    intersection = np.prod(np.maximum(bottom_right - top_left, 0.0), axis=-1)
    areas = [np.prod(np.maximum(boxes[:, 2:] - boxes[:, :2], 0.0), axis=-1) for boxes in (first, second)]
    union = areas[0][:, None] + areas[1][None, :] - intersection
    result: Floats = intersection / np.maximum(union, 1e-9)
    return result


def _to_center_form(boxes: NDArray[np.floating]) -> Floats:
    corners = np.asarray(boxes, np.float64).reshape(-1, 4)
    return np.concatenate([(corners[:, :2] + corners[:, 2:]) / 2, corners[:, 2:] - corners[:, :2]], axis=1)


def _to_corner_form(boxes: Floats) -> Floats:
    return np.concatenate([boxes[:, :2] - boxes[:, 2:] / 2, boxes[:, :2] + boxes[:, 2:] / 2], axis=1)
