"""Recognize enrolled words, with a confidence.

A word counts only if nothing else is nearer: no other word, not the background, and no take played backwards, which is
speech of the same voice but not a word. Then logistic regression computes the confidence from four inputs. The first
is the largest distance of the sound from the best take, relative to the distances between the user's own takes of the
word: it separates words that differ in a single speech sound. The second and the third compare the take's cost with
that of the background and of takes played backwards. The fourth is the level of the sound above the noise: in noise
all costs become similar, and a word must fit better. The absolute cost is not used, because it differs between voices.

Each take is compared as it was recorded, and with the reverberation of rooms. Matches with reverberation need more
confidence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log, log10

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.enrolled.matching import Match, Templates, compute_loudness
from linkwright.speech.enrolled.rooms import ROOMS, Room
from linkwright.speech.enrolled.words import Take, Words
from linkwright.speech.sound.spectra import Powers

ACCEPTED_CONFIDENCE = 0.5
"""The minimum confidence of a recognized word."""

_MIN_RATIO_TERM = 1e-3
_EXCLUDED_COST = np.float32(1e9)
_MIN_REVERBERATION_LEVEL_DB = 20.0  # in dB above the noise; below this level, noise hides the decay of words


@dataclass(frozen=True, slots=True)
class Guess:
    """The enrolled word that is nearest to a recording, with a confidence.

    Attributes:
        name: the name of the word.
        confidence: the probability that exactly this word was spoken, 0 to 1.
        first: the first frame of the word in the recording.
        last: the last frame of the word in the recording.
    """

    name: str
    confidence: float
    first: int
    last: int


class Recognizer:
    """A recognizer of the enrolled words of a user.

    Args:
        words: all enrolled words, at least one; words that are not requested help to reject other speech.
        rooms: the rooms in which the words may be spoken, in addition to the room in which they were enrolled.
    """

    def __init__(self, words: Words, rooms: tuple[Room, ...] = ROOMS) -> None:
        self.names = words.names
        self._takes = [words.takes(name) for name in self.names]
        close_takes = [(word, take) for word, takes in enumerate(self._takes) for take in takes]
        close_takes += [(-1, _reverse_median_take(takes)) for takes in self._takes]
        far_takes = [(word, room.reverberate(take)) for room in rooms for word, take in close_takes]
        self._word_indices = np.array([word for word, _ in (*close_takes, *far_takes)])
        self._is_far = np.arange(len(self._word_indices)) >= len(close_takes)
        self._templates = Templates(tuple(take for _, take in (*close_takes, *far_takes)))
        self._own_worst_by_word: dict[int, float] = {}  # see `_compute_own_worst_distance`
        self.longest = max(len(take.powers) for takes in self._takes for take in takes)

    def guess(self, powers: Powers, noise: NDArray[np.float64]) -> Guess:
        """Return the word that is nearest to an utterance.

        Args:
            powers: the powers of the utterance, with some frames of background before and after it.
            noise: the power of the background, shape ``(BANDS,)``.
        """
        match = self._templates.match(powers, noise)
        if 10.0 * log10(compute_loudness(powers) / float(noise.sum())) < _MIN_REVERBERATION_LEVEL_DB:
            match = replace(match, cost=np.where(self._is_far, _EXCLUDED_COST, match.cost))
        costs = self._compute_word_costs(match)
        word = int(np.argmin(costs))
        take = int(np.flatnonzero(self._word_indices == word)[match.cost[self._word_indices == word].argmin()])
        first, last = int(match.first[take]), int(match.last[take])
        is_nearest = costs[word] < min(self._compute_reversed_cost(match), float(match.background[take]))
        confidence = 0.0
        if is_nearest:
            above_noise = 10.0 * log10(compute_loudness(powers[first : last + 1]) / float(noise.sum()))
            inputs = self._compute_regression_inputs(match, float(costs[word]), word, take, above_noise)
            confidence = _compute_confidence(inputs, is_far=bool(self._is_far[take]))
        return Guess(self.names[word], confidence, first, last)

    def compare(self, take: Take) -> tuple[dict[str, float], float]:
        """Return the distance of a take from each word, and from the nearest take played backwards."""
        match = self._templates.match(take.powers, take.noise)
        costs = self._compute_word_costs(match).tolist()
        return dict(zip(self.names, costs, strict=True)), self._compute_reversed_cost(match)

    def prepare(self) -> None:
        """Compute cached values now, so that the first recognition of a word does not take longer."""
        for word in range(len(self.names)):
            self._compute_own_worst_distance(word)

    def _compute_own_worst_distance(self, word: int) -> float:
        """Return the median over a word's takes of the worst distance from the nearest other take."""
        if word not in self._own_worst_by_word:
            takes = self._takes[word]
            templates = Templates(takes)
            matches = [templates.match(take.powers, take.noise) for take in takes] if len(takes) > 1 else []
            nearest = [int(np.argsort(match.cost)[1]) for match in matches]  # the nearest other take
            worst_distances = [
                templates.compute_worst_distance(match, take) for match, take in zip(matches, nearest, strict=True)
            ]
            self._own_worst_by_word[word] = (
                float(np.median(worst_distances)) if worst_distances else _DEFAULT_WORST_DISTANCE
            )
        return self._own_worst_by_word[word]

    def _compute_word_costs(self, match: Match) -> NDArray[np.float32]:
        return np.array([match.cost[self._word_indices == word].min() for word in range(len(self.names))])

    def _compute_reversed_cost(self, match: Match) -> float:
        """Return the cost of the nearest take played backwards."""
        return float(match.cost[self._word_indices == -1].min())

    def _compute_regression_inputs(
        self, match: Match, cost: float, word: int, take: int, above_noise: float
    ) -> NDArray[np.float64]:
        """Return the inputs of the regression for the confidence, shape ``(4,)``."""
        cost = max(cost, _MIN_RATIO_TERM)
        worst = log(
            max(self._templates.compute_worst_distance(match, take), _MIN_RATIO_TERM)
            / max(self._compute_own_worst_distance(word), _MIN_RATIO_TERM)
        )
        log_background, log_reversed = (
            log(cost / max(reference, _MIN_RATIO_TERM))
            for reference in (float(match.background[take]), self._compute_reversed_cost(match))
        )
        return np.array([worst, log_background, log_reversed, min(max(above_noise, 0.0), _MAX_LEVEL_DB)])


def _reverse_median_take(takes: tuple[Take, ...]) -> Take:
    """Return the take with the median length, reversed in time."""
    take = sorted(takes, key=lambda candidate: len(candidate.powers))[len(takes) // 2]
    return Take(take.powers[::-1], take.noise)


_DEFAULT_WORST_DISTANCE = 15.0  # the value for a word with a single take
_MAX_LEVEL_DB = 30.0  # in dB above the noise; a higher level makes no difference
_REGRESSION_WEIGHTS = np.array(
    [-5.29, -4.40, -3.06, 0.12]
)  # fitted to 16 voices in five languages, with and without noise
_REGRESSION_OFFSET = -9.5
_REGRESSION_OFFSET_FAR = -11.5  # reverberation blurs differences between words, so these takes need to fit better


def _compute_confidence(inputs: NDArray[np.float64], *, is_far: bool) -> float:
    offset = _REGRESSION_OFFSET_FAR if is_far else _REGRESSION_OFFSET
    return 1.0 / (1.0 + exp(-(offset + float(_REGRESSION_WEIGHTS @ inputs))))
