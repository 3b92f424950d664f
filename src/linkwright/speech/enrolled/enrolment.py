"""Enrol words: decide whether a recording is usable, and give the reason if not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.speech.enrolled.recognition import Recogniser
from linkwright.speech.enrolled.words import MOST_WORDS, Take, Words, name_problem, rounded
from linkwright.speech.sound.activity import speech_span
from linkwright.speech.sound.samples import Samples
from linkwright.speech.sound.spectra import HOP, WINDOW, mel_frames

_SHORTEST, _LONGEST = 15, 300  # frames: 0.15 s and 3 s
_EDGE = 3  # frames at either end of a recording that must not contain speech
_QUIETEST = 60.0  # RMS value of the loudest 50 ms, in units of a 16-bit sample: -55 dB of full scale
_LEAST_ABOVE_NOISE = 8.0  # dB, mean over the bands of the loudest frames
_CLIPPED_SHARE = 0.01
_CLIPPED_AT = 32_700
_UNLIKE = 0.7  # times its distance to a reversed word; different words exceed this three times in four
_MUCH_ALIKE = 0.85  # times its distance to another word


def enrol(words: Words, name: str, samples: Samples, has_gaps: bool = False) -> tuple[Diagnostic, ...]:
    """Add a recording of a word if it is usable.

    Args:
        words: the words to which the take is added, unless a finding is an error.
        name: the phrase of the word.
        samples: a recording that contains the word once, preferably with some tenths of a second of silence around it.
        has_gaps: whether some of the sound was lost.

    Returns:
        The findings. Errors, which reject the recording: VOICE204, the name cannot be used; VOICE205, nothing is
        audible, or too little above the noise; VOICE206, it is too short or too long; VOICE207, it is clipped;
        VOICE208, it differs from the earlier takes of the word; VOICE211, its beginning or its end is cut off;
        VOICE212, the sound has gaps. A warning: VOICE209, it sounds very similar to another word.
    """
    reason = name_problem(name)
    if reason is not None:
        return (_refused("VOICE204", phrase("a word cannot be named '{name}': {reason}", name=name, reason=reason)),)
    if len(words.names) >= MOST_WORDS and name not in words.names:
        reason = phrase("there are already {most} words", most=MOST_WORDS)
        return (_refused("VOICE204", phrase("a word cannot be named '{name}': {reason}", name=name, reason=reason)),)
    if has_gaps:
        message = phrase("the sound that was recorded for '{name}' has gaps", name=name)
        return (
            _refused(
                "VOICE212", message, phrase("record it again; the machine was too busy to record all of the sound")
            ),
        )
    powers = mel_frames(samples)
    first, last, noise = speech_span(powers)
    finding = _unfit(name, samples, first, last)
    if finding is None and (first < _EDGE or last > len(powers) - _EDGE):
        finding = _refused(
            "VOICE211",
            phrase("the word recorded for '{name}' is cut off at the beginning or end", name=name),
            phrase("leave some tenths of a second of silence before and after the word"),
        )
    if finding is None and np.quantile(_above(powers[first:last], noise), 0.9) < _LEAST_ABOVE_NOISE:
        finding = _refused(
            "VOICE205",
            phrase("'{name}' is hardly louder than the background", name=name),
            phrase("speak louder or nearer to the microphone, or where it is quieter"),
        )
    if finding is not None:
        return (finding,)
    take = Take(rounded(powers[first:last]), rounded(noise))
    found = _compared(words, name, take)
    if found is None or found.severity is not Severity.ERROR:
        words.add(name, take)
    return () if found is None else (found,)


def _compared(words: Words, name: str, take: Take) -> Diagnostic | None:
    """Compare a take with other takes of its word and with other words.

    Returns a finding if the take does not fit. The first take of a word is not compared.
    """
    if not words.takes(name):
        return None
    costs, backwards = Recogniser(words, rooms=()).compare(take)
    own = costs.pop(name)
    if own > _UNLIKE * backwards:
        return _refused(
            "VOICE208",
            phrase("the recording for '{name}' differs from its earlier ones", name=name),
            phrase("speak it as before, or remove the word and enrol it again"),
        )
    other = min(costs, key=lambda one: costs[one], default=name)
    if other != name and own > _MUCH_ALIKE * costs[other]:
        message = phrase(
            "'{name}' sounds much like '{other}', so one may be taken for the other", name=name, other=other
        )
        hint = phrase("choose a longer or a more different word for one of them")
        return Diagnostic("VOICE209", message, severity=Severity.WARNING, hint=hint)
    return None


def _above(powers: NDArray[np.float64], noise: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.mean(10.0 * np.log10(np.maximum(powers, 1.0) / noise), axis=1))


def _unfit(name: str, samples: Samples, first: int, last: int) -> Diagnostic | None:
    """Return the reason why the sound itself is not usable, or None."""
    spoken = samples[first * HOP : (last - 1) * HOP + WINDOW].astype(np.float64) if last > first else np.zeros(0)
    loudest = 0.0
    if len(spoken):
        blocks = spoken[: max(1, len(spoken) // (5 * HOP)) * 5 * HOP]
        loudest = max(
            float(np.sqrt(np.mean(part**2))) for part in np.array_split(blocks, max(1, len(spoken) // (5 * HOP)))
        )
    if loudest < _QUIETEST:
        return _refused(
            "VOICE205",
            phrase("there is no audible word in the recording for '{name}'", name=name),
            phrase("check that the right microphone is selected and not muted, and speak louder"),
        )
    if last - first < _SHORTEST:
        return _refused(
            "VOICE206",
            phrase(
                "the word recorded for '{name}' is too short: {seconds} s",
                name=name,
                seconds=f"{(last - first) / 100:.2f}",
            ),
            phrase("words of two or more syllables are recognized best"),
        )
    if last - first > _LONGEST:
        return _refused(
            "VOICE206",
            phrase(
                "the word recorded for '{name}' is too long: {seconds} s",
                name=name,
                seconds=f"{(last - first) / 100:.1f}",
            ),
            phrase("say the word once, within {seconds} s", seconds=_LONGEST // 100),
        )
    if np.mean(np.abs(spoken) >= _CLIPPED_AT) > _CLIPPED_SHARE:
        return _refused(
            "VOICE207",
            phrase("the recording for '{name}' is clipped: its loudest parts are cut off", name=name),
            phrase("speak more softly or farther from the microphone, or turn its level down"),
        )
    return None


def _refused(code: str, message: Phrase, hint: Phrase | None = None) -> Diagnostic:
    return Diagnostic(code, message, severity=Severity.ERROR, hint=hint)
