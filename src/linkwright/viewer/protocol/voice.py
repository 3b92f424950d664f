"""The Voice panel: sound of pages' microphones, what was heard and answered, commands as text.

Sound comes in binary frames, little endian: four uint32 (kind 5, number of samples N, number of samples that the
browser lost in them or before them, 0), and int16 N, mono at 16 kHz. A frame has a tenth of a second, or less where the
sound ends.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.viewer.protocol.message import PageMessage, ServerMessage

SOUND_KIND = 5
SOUND_RATE = 16_000
"""Samples a second."""

MOST_SAMPLES = 1600
"""The largest number of samples in a frame."""

MOST_LOST_SAMPLES = 5 * SOUND_RATE
"""Samples that a frame may say were lost; of more than that a page says so many."""

_HEADER = struct.Struct("<IIII")


@dataclass(frozen=True, slots=True)
class SoundBlock:
    """Sound of a page's microphone.

    Attributes:
        samples: mono PCM of 16 bits at 16 kHz, shape (n,).
        lost: seconds that are missing in them or before them: the browser's machine was too busy.
    """

    samples: NDArray[np.int16]
    lost: float = 0.0


def unpack_sound(frame: bytes) -> SoundBlock | None:
    """The sound in a binary frame of a page; None for anything else."""
    if len(frame) < _HEADER.size:
        return None
    kind, count, lost, _ = _HEADER.unpack_from(frame)
    if kind != SOUND_KIND or not 0 < count <= MOST_SAMPLES or len(frame) != _HEADER.size + 2 * count:
        return None
    if lost > MOST_LOST_SAMPLES:
        return None
    return SoundBlock(np.frombuffer(frame, "<i2", count, _HEADER.size).astype(np.int16), lost / SOUND_RATE)


class VoiceNode(ServerMessage):
    """Whether a node is there that carries out spoken commands."""

    present: bool


class WatchVoice(PageMessage):
    """Start or stop sending what is heard and answered."""

    watched: bool


TalkMode = Literal["off", "ready", "held", "open"]


class Talk(PageMessage):
    """The mode of the page's microphone.

    It is off; ready, which publishes nothing yet; or its sound is meant: as long as a button is held, or all of it.
    """

    mode: TalkMode


class SayCommand(PageMessage):
    """A command as text, as if it had been heard."""

    text: str


Talking = Literal["nobody", "you", "another"]


class VoiceState(ServerMessage):
    """The page that talks, and the listeners in the graph.

    Attributes:
        talking: whose sound is published. One page talks at a time: the first that holds its button, else the first
            that listens all the time.
        sound_listeners: the number of subscribers to sound.
        text_listeners: the number of subscribers to commands as text.
        cut: the page sent more sound than time has passed, or says that more was lost, and has to begin anew.
        proposes_enrolling: the robot knows none of what was said and proposes to enrol words where the user stands.
    """

    talking: Talking
    sound_listeners: int
    text_listeners: int
    cut: bool
    proposes_enrolling: bool


SaidPart = Literal["partial", "text", "command", "response"]


class VoiceSaid(ServerMessage):
    """A text of the conversation: what is being heard, was heard, was understood, is answered."""

    NEWEST_OF: ClassVar[tuple[str, ...]] = ("number",)

    number: int
    part: SaidPart
    text: str
