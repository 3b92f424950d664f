"""The Voice panel: sound from microphones, recognized and typed commands, and answers.

Sound is sent in little-endian binary frames: four uint32 (kind 5, number of samples N, number of samples that the
browser lost in or before these samples, 0), and N int16 samples, mono at 16 kHz. A frame contains a tenth of a second,
or less at the end of the sound.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.page.protocol.message import PageMessage, ServerMessage

SOUND_KIND = 5
SOUND_RATE = 16_000
"""The number of samples per second."""

MAX_SAMPLES = 1600
"""The largest number of samples in a frame."""

MAX_LOST_SAMPLES = 5 * SOUND_RATE
"""The largest number of lost samples in a frame. A page that lost more samples reports this number."""

_HEADER = struct.Struct("<IIII")


@dataclass(frozen=True, slots=True)
class SoundBlock:
    """Sound from a page's microphone.

    Attributes:
        samples: mono 16-bit PCM at 16 kHz, shape (n,).
        lost: the duration in seconds of the lost sound in or before the samples, if the machine was too busy.
    """

    samples: NDArray[np.int16]
    lost: float = 0.0


def unpack_sound(frame: bytes) -> SoundBlock | None:
    """Return the sound in a binary frame of a page, or None if the frame is not valid sound."""
    if len(frame) < _HEADER.size:
        return None
    kind, count, lost, _ = _HEADER.unpack_from(frame)
    if kind != SOUND_KIND or not 0 < count <= MAX_SAMPLES or len(frame) != _HEADER.size + 2 * count:
        return None
    if lost > MAX_LOST_SAMPLES:
        return None
    return SoundBlock(np.frombuffer(frame, "<i2", count, _HEADER.size).astype(np.int16), lost / SOUND_RATE)


class VoiceNode(ServerMessage):
    """Whether there is a node that carries out spoken commands."""

    present: bool


class WatchVoice(PageMessage):
    """Whether the page receives recognized commands and answers from now on."""

    watched: bool


TalkMode = Literal["off", "ready", "held", "open"]


class Talk(PageMessage):
    """The mode of the page's microphone.

    The microphone is off, or ready without publishing sound, or it publishes sound while a button is held or
    continuously.
    """

    mode: TalkMode


class SayCommand(PageMessage):
    """A command that the user has typed.

    The command is handled like a spoken command.
    """

    text: str


Talking = Literal["nobody", "you", "another"]


class VoiceState(ServerMessage):
    """The page whose sound is published, and the subscribers in the graph.

    Attributes:
        talking: the page whose sound is published. One page talks at a time: the first page with its button held or,
            if there is none, the first that talks continuously.
        sound_listeners: the number of subscribers to sound.
        text_listeners: the number of subscribers to commands as text.
        cut: whether the page has to start again, because it sent sound faster than real time or reported too much loss.
        proposes_enrolling: whether the robot recognized no word of a command and proposes to enroll words.
    """

    talking: Talking
    sound_listeners: int
    text_listeners: int
    cut: bool
    proposes_enrolling: bool


ConversationPart = Literal["partial", "text", "command", "response"]


class ConversationText(ServerMessage):
    """A text of the conversation: partial or final speech, a recognized command, or an answer."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    part: ConversationPart
    text: str
