"""The enrollment of words: checks whether a recording is usable, and why it is not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, Phrase, Severity, phrase
from linkwright.speech.enrolled.recognition import Recognizer
from linkwright.speech.enrolled.words import MAX_WORDS, Take, Words, find_name_problem, round_powers
from linkwright.speech.sound.activity import find_speech_span
from linkwright.speech.sound.samples import Samples
from linkwright.speech.sound.spectra import HOP_LENGTH, WINDOW_LENGTH, extract_mel_frames

_MIN_FRAMES, _MAX_FRAMES = 15, 300  # the minimum and maximum length of a word in frames: 0.15 s and 3 s
_SILENT_EDGE_FRAMES = 3  # the number of frames at both ends of a recording that must not contain speech
_MIN_RMS = 60.0  # the minimum RMS value of the loudest 50 ms, in steps of a 16-bit sample: -55 dB of full scale
_MIN_SIGNAL_TO_NOISE_DB = (
    8.0  # the minimum level above the noise in dB, as the mean over the bands of the loudest frames
)
_MAX_CLIPPED_FRACTION = 0.01
"""The maximum fraction of the samples that may be clipped."""
_CLIPPED_LEVEL = 32_700
_MAX_OWN_DISTANCE = 0.7  # a multiple of the distance to a reversed word; 3 of 4 different words exceed it
_SIMILAR_DISTANCE = 0.85  # a multiple of the distance to another word


def enroll(words: Words, name: str, samples: Samples, has_gaps: bool = False) -> tuple[Diagnostic, ...]:
    """Add a recording of a word if it is usable.

    Args:
        words: the words to which the take is added if no finding is an error.
        name: the phrase that the word represents.
        samples: a recording of the word, spoken once, preferably with some tenths of a second of silence around it.
        has_gaps: whether some of the sound was lost during recording.

    Returns:
        The findings. An error rejects the recording: VOICE204, the name cannot be used; VOICE205, nothing is
        audible, or too little above the noise; VOICE206, it is too short or too long; VOICE207, it is clipped;
        VOICE208, it differs from the earlier takes of the word; VOICE211, its beginning or its end is cut off;
        VOICE212, the sound has gaps. A warning: VOICE209, it sounds very similar to another word.
    """
    reason = find_name_problem(name)
    if reason is not None:
        return (
            _make_rejection("VOICE204", phrase("a word cannot be named '{name}': {reason}", name=name, reason=reason)),
        )
    if len(words.names) >= MAX_WORDS and name not in words.names:
        reason = phrase("{maximum} words are enrolled already, the maximum", maximum=MAX_WORDS)
        return (
            _make_rejection("VOICE204", phrase("a word cannot be named '{name}': {reason}", name=name, reason=reason)),
        )
    if has_gaps:
        message = phrase("the recording for '{name}' has gaps", name=name)
        return (_make_rejection("VOICE212", message, phrase("record it again when the machine is less busy")),)
    powers = extract_mel_frames(samples)
    first, last, noise = find_speech_span(powers)
    rejection = _check_sound(name, samples, first, last)
    if rejection is None and (first < _SILENT_EDGE_FRAMES or last > len(powers) - _SILENT_EDGE_FRAMES):
        rejection = _make_rejection(
            "VOICE211",
            phrase("the word recorded for '{name}' is cut off at the beginning or end", name=name),
            phrase("leave some tenths of a second of silence before and after the word"),
        )
    if (
        rejection is None
        and np.quantile(_compute_level_above_noise(powers[first:last], noise), 0.9) < _MIN_SIGNAL_TO_NOISE_DB
    ):
        rejection = _make_rejection(
            "VOICE205",
            phrase("'{name}' is hardly louder than the background noise", name=name),
            phrase("speak louder, nearer to the microphone, or in a quieter place"),
        )
    if rejection is not None:
        return (rejection,)
    take = Take(round_powers(powers[first:last]), round_powers(noise))
    comparison = _compare_take(words, name, take)
    if comparison is None or comparison.severity is not Severity.ERROR:
        words.add(name, take)
    return () if comparison is None else (comparison,)


def _compare_take(words: Words, name: str, take: Take) -> Diagnostic | None:
    """Compare a take with the other takes of its word and with other words.

    Return a finding if the take does not fit, else None. The first take of a word is not compared.
    """
    if not words.takes(name):
        return None
    costs, reversed_cost = Recognizer(words, rooms=()).compare(take)
    own_cost = costs.pop(name)
    if own_cost > _MAX_OWN_DISTANCE * reversed_cost:
        return _make_rejection(
            "VOICE208",
            phrase("the recording for '{name}' differs from the earlier ones", name=name),
            phrase("speak it as before, or remove the word and enroll it again"),
        )
    nearest = min(costs, key=lambda word: costs[word], default=name)
    if nearest != name and own_cost > _SIMILAR_DISTANCE * costs[nearest]:
        message = phrase(
            "'{name}' sounds very similar to '{other_name}', so they may be confused", name=name, other_name=nearest
        )
        hint = phrase("choose a longer or less similar word for one of them")
        return Diagnostic("VOICE209", message, severity=Severity.WARNING, hint=hint)
    return None


def _compute_level_above_noise(powers: NDArray[np.float64], noise: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.mean(10.0 * np.log10(np.maximum(powers, 1.0) / noise), axis=1))


def _check_sound(name: str, samples: Samples, first: int, last: int) -> Diagnostic | None:
    """Return a finding if the sound is too quiet, too short, too long or clipped, else None."""
    speech = (
        samples[first * HOP_LENGTH : (last - 1) * HOP_LENGTH + WINDOW_LENGTH].astype(np.float64)
        if last > first
        else np.zeros(0)
    )
    loudest = 0.0
    if len(speech):
        whole_blocks = speech[: max(1, len(speech) // (5 * HOP_LENGTH)) * 5 * HOP_LENGTH]
        loudest = max(
            float(np.sqrt(np.mean(block**2)))
            for block in np.array_split(whole_blocks, max(1, len(speech) // (5 * HOP_LENGTH)))
        )
    if loudest < _MIN_RMS:
        return _make_rejection(
            "VOICE205",
            phrase("there is no audible word in the recording for '{name}'", name=name),
            phrase("check that the right microphone is selected and not muted, and speak louder"),
        )
    if last - first < _MIN_FRAMES:
        return _make_rejection(
            "VOICE206",
            phrase(
                "the word recorded for '{name}' is too short: {seconds} s",
                name=name,
                seconds=f"{(last - first) / 100:.2f}",
            ),
            phrase("words of two or more syllables are recognized best"),
        )
    if last - first > _MAX_FRAMES:
        return _make_rejection(
            "VOICE206",
            phrase(
                "the word recorded for '{name}' is too long: {seconds} s",
                name=name,
                seconds=f"{(last - first) / 100:.1f}",
            ),
            phrase("say the word once, within {seconds} s", seconds=_MAX_FRAMES // 100),
        )
    if np.mean(np.abs(speech) >= _CLIPPED_LEVEL) > _MAX_CLIPPED_FRACTION:
        return _make_rejection(
            "VOICE207",
            phrase("the recording for '{name}' is clipped: its loudest parts are cut off", name=name),
            phrase("speak more softly or farther from the microphone, or lower its level"),
        )
    return None


def _make_rejection(code: str, message: Phrase, hint: Phrase | None = None) -> Diagnostic:
    return Diagnostic(code, message, severity=Severity.ERROR, hint=hint)
