"""Sound: WAV files in all formats, resampling, spectra, and voice activity."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.speech.sound.activity import VoiceActivity, estimate_unsteady_noise, find_speech_span
from linkwright.speech.sound.resampling import Resampler, resample
from linkwright.speech.sound.samples import RATE
from linkwright.speech.sound.spectra import BANDS, HOP_LENGTH, MelFrames, extract_mel_frames
from linkwright.speech.sound.wav import encode_wav, parse_wav, read_wav
from tests.speech.voices import WORDS, add_noise, babble, say


def tone(hertz, rate=RATE, seconds=0.5, level=0.5):
    return level * np.sin(2 * np.pi * hertz * np.arange(int(rate * seconds)) / rate)


def wav(sound, *, kind=1, channels=1, rate=RATE, bits=16, extensible=False, before=b""):
    form = struct.pack("<HHIIHH", 0xFFFE if extensible else kind, channels, rate, 0, channels * bits // 8, bits)
    if extensible:
        form += struct.pack("<HHIH", 22, bits, 0, kind) + bytes(14)
    body = before + b"fmt " + struct.pack("<I", len(form)) + form + b"data" + struct.pack("<I", len(sound)) + sound
    return b"RIFF" + struct.pack("<I", 4 + len(body)) + b"WAVE" + body


def encoded(values, kind, bits):
    if kind == 3:
        return values.astype(f"<f{bits // 8}").tobytes()
    if bits == 8:
        return np.rint(values * 127 + 128).astype(np.uint8).tobytes()
    integers = np.rint(values * (2 ** (bits - 1) - 1)).astype("<i4")
    if bits == 24:
        return integers.reshape(-1, 1).view(np.uint8)[:, :3].tobytes()
    return integers.astype(f"<i{bits // 8}").tobytes()


@pytest.mark.parametrize(("kind", "bits"), [(1, 8), (1, 16), (1, 24), (1, 32), (3, 32), (3, 64)])
@pytest.mark.parametrize("extensible", [False, True])
def test_wav_bit_depths_give_same_samples(kind, bits, extensible):
    data = wav(encoded(tone(440), kind, bits), kind=kind, bits=bits, extensible=extensible)
    expected = np.rint(tone(440) * 32768)
    assert np.abs(parse_wav(data, "a.wav") - expected).max() <= (260 if bits == 8 else 2)


def test_channels_are_averaged():
    stereo = np.stack((tone(440), -tone(440)), axis=1).reshape(-1)
    assert not parse_wav(wav(encoded(stereo, 1, 16), channels=2), "a.wav").any()


def test_unneeded_wav_chunks_are_skipped_with_padding():
    data = wav(encoded(tone(440), 1, 16), before=b"LIST" + struct.pack("<I", 3) + b"abc\0")
    assert len(parse_wav(data, "a.wav")) == RATE // 2


def test_truncated_wav_gives_available_samples():
    assert len(parse_wav(wav(encoded(tone(440), 1, 16))[:-1001], "a.wav")) == RATE // 2 - 501


def test_encoded_wav_reads_back(tmp_path):
    samples = say(WORDS["stop"])
    (tmp_path / "stop.wav").write_bytes(encode_wav(samples))
    assert np.array_equal(read_wav(tmp_path / "stop.wav"), samples)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "has no WAV header"),
        (b"OggS" + bytes(60), "has no WAV header"),
        (wav(b"")[:12], "no samples"),
        (b"RIFF\0\0\0\0WAVEdata\0\0\0\0", "before its 'fmt ' chunk"),
        (wav(bytes(8), kind=7, bits=8), "mu-law with 8 bits"),
        (wav(bytes(8), kind=0x1234, bits=8), "0x1234"),
        (wav(bytes(8), bits=12), "PCM with 12 bits"),
        (wav(bytes(8), channels=0), "0 channels"),
        (wav(bytes(8), rate=0), "0 Hz"),
        (wav(bytes(8), rate=10_000_000), "10000000 Hz"),
    ],
)
def test_malformed_wav_is_rejected_with_reason(data, reason):
    with pytest.raises(LinkwrightError) as error:
        parse_wav(data, "a.wav")
    (finding,) = error.value.diagnostics
    assert finding.code == "VOICE402"
    assert "'a.wav'" in str(finding.message)
    assert reason in str(finding.message)
    assert finding.hint is not None


def test_missing_wav_is_reported(tmp_path):
    with pytest.raises(LinkwrightError) as error:
        read_wav(tmp_path / "none.wav")
    assert error.value.diagnostics[0].code == "VOICE401"


@pytest.mark.parametrize("rate", [8_000, 11_025, 22_050, 44_100, 48_000, 96_000])
def test_resampling_keeps_tone(rate):
    resampled = resample(tone(1000, rate), rate)
    assert abs(len(resampled) - RATE // 2) <= 2
    inner_samples = slice(500, 7000)
    assert np.abs(resampled / 32768 - tone(1000)[: len(resampled)])[inner_samples].max() < 1e-3


@pytest.mark.parametrize("hertz", [8_200, 9_000, 12_000, 20_000])
def test_resampling_does_not_alias(hertz):
    resampled = resample(tone(hertz, 48_000), 48_000) / 32768
    assert np.sqrt(np.mean(resampled[500:7000] ** 2)) < 1e-3


@pytest.mark.parametrize("length", [50, 777, 4410])
def test_streamed_resampling_matches_whole(length):
    values = np.random.default_rng(1).normal(size=20_000) / 10
    resampler = Resampler(44_100)
    blocks = [resampler.feed(values[offset : offset + length]) for offset in range(0, len(values), length)]
    resampled = np.concatenate((*blocks, resampler.flush()))
    expected = resample(values, 44_100)
    assert np.abs(resampled[: len(expected)].astype(int) - expected).max() <= 1


def test_resampling_clips_values_and_silences_nan():
    assert resample(np.array([2.0, -2.0, np.nan, 0.5]), RATE).tolist() == [32767, -32768, 0, 16384]


@pytest.mark.parametrize("length", [1, 159, 160, 1600, 5000])
def test_mel_frames_do_not_depend_on_block_size(length):
    samples = say(WORDS["forward"], silence=0.1)
    if length == 1:
        samples = samples[:1000]
    stream = MelFrames()
    blocks = [stream.feed(samples[offset : offset + length]) for offset in range(0, len(samples), length)]
    assert np.allclose(np.concatenate(blocks), extract_mel_frames(samples))


def test_tone_is_strongest_in_its_band():
    frames = [
        extract_mel_frames(np.rint(tone(hertz) * 32768).astype(np.int16))
        for hertz in (150, 500, 1000, 2000, 4000, 7000)
    ]
    strongest = [int(powers.mean(axis=0).argmax()) for powers in frames]
    assert strongest == sorted(set(strongest))
    assert strongest[0] <= 1
    assert strongest[-1] == BANDS - 1


def test_too_few_samples_give_no_frames():
    assert extract_mel_frames(np.zeros(0, np.int16)).shape == (0, BANDS)
    assert extract_mel_frames(np.zeros(100, np.int16)).shape == (0, BANDS)


@pytest.mark.parametrize("noise", [0.0, 3.0, 100.0])
def test_speech_span_is_found(noise):
    samples = say(WORDS["forward"], silence=0.6, noise=noise)
    first, last, _ = find_speech_span(extract_mel_frames(samples))
    assert abs(first * HOP_LENGTH - 0.6 * RATE) < 0.06 * RATE
    assert abs(last * HOP_LENGTH - (len(samples) - 0.6 * RATE)) < 0.08 * RATE


def test_speech_span_is_found_in_fading_noise():
    samples = say(WORDS["forward"], silence=1.2, noise=0.0)
    fading = 5.0 * np.exp(-np.arange(len(samples)) / RATE) * np.random.default_rng(3).normal(size=len(samples))
    first, last, _ = find_speech_span(extract_mel_frames(np.rint(samples + fading).astype(np.int16)))
    assert abs(first * HOP_LENGTH - 1.2 * RATE) < 0.06 * RATE
    assert abs(last * HOP_LENGTH - (len(samples) - 1.2 * RATE)) < 0.08 * RATE


def voice_activity(samples):
    activity = VoiceActivity()
    return np.array([activity.step(frame) for frame in extract_mel_frames(samples)])


@pytest.mark.parametrize("noise", [0.0, 3.0, 100.0])
def test_voice_activity_covers_word_and_hangover(noise):
    samples = say(WORDS["forward"], silence=1.0, noise=noise)
    changes = np.flatnonzero(np.diff(voice_activity(samples).astype(int)))
    assert len(changes) == 2
    assert 95 <= changes[0] <= 110
    assert 0.3 <= changes[1] / 100 - (len(samples) / RATE - 1.0) <= 0.5


@pytest.mark.parametrize("level", [0.0, 1.0, 30.0, 1000.0])
def test_steady_noise_is_not_speech(level):
    samples = np.rint(level * np.random.default_rng(2).normal(size=10 * RATE)).astype(np.int16)
    assert not voice_activity(samples).any()


def test_sudden_noise_counts_as_speech_for_at_most_two_seconds():
    rng = np.random.default_rng(3)
    levels = np.where(np.arange(8 * RATE) < 2 * RATE, 5.0, 300.0)
    activity = voice_activity(np.rint(levels * rng.normal(size=8 * RATE)).astype(np.int16))
    assert not activity[450:].any()


def floor_and_unsteady_noise(samples):
    """Return the noise floor at the end of a recording, and the unsteady noise above it."""
    powers, activity = extract_mel_frames(samples), VoiceActivity()
    for frame in powers:
        activity.step(frame)
    return activity.floor, estimate_unsteady_noise(powers, activity.floor)


@pytest.mark.parametrize("name", WORDS)
@pytest.mark.parametrize("level", [3.0, 300.0, 900.0])
def test_steady_noise_beside_word_is_not_unsteady(name, level):
    assert floor_and_unsteady_noise(say(WORDS[name], level=3000.0, noise=level))[1] is None


def test_wavering_hum_and_soft_onset_are_not_unsteady_noise():
    times = np.arange(2 * RATE) / RATE
    hum = (1.0 + 0.3 * np.sin(2 * np.pi * 11 * times)) * np.sin(2 * np.pi * 100 * times)
    samples = say(WORDS["forward"], level=3000.0)
    assert floor_and_unsteady_noise(add_noise(samples, hum, 10.0, 3000.0))[1] is None
    softly = samples * np.clip((times[: len(samples)] - 0.5) / 0.3, 0.02, 1.0)
    assert floor_and_unsteady_noise(np.rint(softly).astype(np.int16))[1] is None


def test_babble_beside_word_is_unsteady_noise_above_floor():
    samples = say(WORDS["forward"], level=3000.0)
    babble_samples = babble(len(samples) / RATE + 0.1, np.random.default_rng(5))
    floor, noise = floor_and_unsteady_noise(add_noise(samples, babble_samples, 15.0, 3000.0))
    assert noise is not None
    assert (noise >= floor).all()
    before = extract_mel_frames(add_noise(np.zeros_like(samples), babble_samples, 15.0, 3000.0))
    assert np.mean(before <= noise) > 0.85
    assert np.mean(before <= floor) < 0.5


def test_short_lead_gives_no_unsteady_noise():
    powers = extract_mel_frames(say(WORDS["forward"], silence=0.1))
    assert estimate_unsteady_noise(powers, np.full(BANDS, 1e-3)) is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_wav_with_non_finite_samples_is_rejected(value):
    sound = np.array([0.0, 0.5, value, 0.1], "<f4").tobytes()
    with pytest.raises(LinkwrightError) as error:
        parse_wav(wav(sound, kind=3, bits=32), "sound.wav")
    assert error.value.diagnostics[0].code == "VOICE402"


def test_values_far_beyond_full_scale_are_clipped():
    assert resample(np.array([1e308, -1e308, np.inf]), RATE).tolist() == [32767, -32768, 32767]
