"""Recognise enrolled words, with a confidence.

A word counts only if nothing else is nearer: no other word, not the background, and no take played backwards, which is
speech of the same voice but not a word. Then logistic regression computes the confidence from three inputs. The first
is the largest distance of the sound from the best take, relative to the distances between the user's own takes of the
word: it separates words that differ in a single speech sound. The second is the take's cost relative to the background
and to takes played backwards. The third is the level of the sound above the noise: in noise all costs become similar,
and a word must fit better. The absolute cost is not used, because it differs between voices and microphones.

Each take is compared as it was recorded, and with the reverberation of rooms; the latter matches need more confidence.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log, log10

import numpy as np
from numpy.typing import NDArray

from linkwright.speech.enrolled.matching import Match, Templates, loudness
from linkwright.speech.enrolled.rooms import ROOMS, Room
from linkwright.speech.enrolled.words import Take, Words
from linkwright.speech.sound.spectra import Powers

ACCEPTED = 0.5
"""The confidence from which a word counts."""

_LEAST = 1e-3
_NEVER = np.float32(1e9)
_REVERBERATION_HEARD = 20.0  # dB above noise: below it, noise hides the decay of words, and all words seem far away


@dataclass(frozen=True, slots=True)
class Guess:
    """The enrolled word that is nearest to a sound.

    Attributes:
        name: the name of the word.
        confidence: the probability that exactly this word was spoken, 0 to 1.
        first: the first frame of the word in the sound.
        last: the last frame of the word in the sound.
    """

    name: str
    confidence: float
    first: int
    last: int


class Recogniser:
    """Recognises the words of a user, at least one.

    Args:
        words: all enrolled words; those that are not requested help to reject other words.
        rooms: the rooms in which the words may be spoken, in addition to the one in which they were enrolled.
    """

    def __init__(self, words: Words, rooms: tuple[Room, ...] = ROOMS) -> None:
        self.names = words.names
        self._takes = [words.takes(name) for name in self.names]
        close = [(word, take) for word, takes in enumerate(self._takes) for take in takes]
        close += [(-1, _backwards(takes)) for takes in self._takes]
        far = [(word, room.reverberate(take)) for room in rooms for word, take in close]
        self._word = np.array([word for word, _ in (*close, *far)])
        self._is_far = np.arange(len(self._word)) >= len(close)
        self._templates = Templates(tuple(take for _, take in (*close, *far)))
        self._own: dict[int, float] = {}  # see `_own_worst`
        self.longest = max(len(take.powers) for takes in self._takes for take in takes)

    def guess(self, powers: Powers, noise: NDArray[np.float64]) -> Guess:
        """Find the nearest word.

        Args:
            powers: the powers of the utterance, with some frames of background before and after it.
            noise: the power of the background, shape ``(BANDS,)``.
        """
        match = self._templates.match(powers, noise)
        if 10.0 * log10(loudness(powers) / float(noise.sum())) < _REVERBERATION_HEARD:
            match = replace(match, cost=np.where(self._is_far, _NEVER, match.cost))
        costs = self._costs(match)
        word = int(np.argmin(costs))
        take = int(np.flatnonzero(self._word == word)[match.cost[self._word == word].argmin()])
        first, last = int(match.first[take]), int(match.last[take])
        is_nearest = costs[word] < min(self._nonsense(match), float(match.background[take]))
        confidence = 0.0
        if is_nearest:
            above_noise = 10.0 * log10(loudness(powers[first : last + 1]) / float(noise.sum()))
            figures = self._figures(match, float(costs[word]), word, take, above_noise)
            confidence = _confidence(figures, is_far=bool(self._is_far[take]))
        return Guess(self.names[word], confidence, first, last)

    def compare(self, take: Take) -> tuple[dict[str, float], float]:
        """Return the distance of a take from each word, and from the nearest word played backwards."""
        match = self._templates.match(take.powers, take.noise)
        costs = self._costs(match).tolist()
        return dict(zip(self.names, costs, strict=True)), self._nonsense(match)

    def prepare(self) -> None:
        """Compute cached values in advance, so that the first recognition of a word does not take longer."""
        for word in range(len(self.names)):
            self._own_worst(word)

    def _own_worst(self, word: int) -> float:
        """Return the median over a word's takes of the worst distance from the nearest other take."""
        if word not in self._own:
            takes = self._takes[word]
            alone = Templates(takes)
            matches = [alone.match(take.powers, take.noise) for take in takes] if len(takes) > 1 else []
            nearest = [int(np.argsort(match.cost)[1]) for match in matches]  # the nearest take except itself
            found = [alone.worst(match, take) for match, take in zip(matches, nearest, strict=True)]
            self._own[word] = float(np.median(found)) if found else _USUAL_WORST
        return self._own[word]

    def _costs(self, match: Match) -> NDArray[np.float32]:
        return np.array([match.cost[self._word == number].min() for number in range(len(self.names))])

    def _nonsense(self, match: Match) -> float:
        """Return the distance to the nearest take played backwards."""
        return float(match.cost[self._word == -1].min())

    def _figures(self, match: Match, cost: float, word: int, take: int, above_noise: float) -> NDArray[np.float64]:
        """Return the inputs of the regression for the confidence, shape ``(4,)``."""
        cost = max(cost, _LEAST)
        worst = log(max(self._templates.worst(match, take), _LEAST) / max(self._own_worst(word), _LEAST))
        background, nonsense = (
            log(cost / max(against, _LEAST)) for against in (float(match.background[take]), self._nonsense(match))
        )
        return np.array([worst, background, nonsense, min(max(above_noise, 0.0), _CLEAR)])


def _backwards(takes: tuple[Take, ...]) -> Take:
    """Return the take of median length, reversed."""
    take = sorted(takes, key=lambda one: len(one.powers))[len(takes) // 2]
    return Take(take.powers[::-1], take.noise)


_USUAL_WORST = 15.0  # for a word with a single take
_CLEAR = 30.0  # dB above the noise: a higher level makes no difference
_WEIGHTS = np.array([-5.29, -4.40, -3.06, 0.12])  # fitted to 16 synthetic voices in five languages, clean and in noise
_OFFSET = -9.5
_OFFSET_FAR = -11.5  # reverberation blurs differences between words, so these takes need to fit better


def _confidence(figures: NDArray[np.float64], *, is_far: bool) -> float:
    offset = _OFFSET_FAR if is_far else _OFFSET
    return 1.0 / (1.0 + exp(-(offset + float(_WEIGHTS @ figures))))
