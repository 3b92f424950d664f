"""Takes with the reverberation of a room, to recognize words from a distance.

A room adds earlier sound to the current sound. In each band its power decays exponentially, by 60 dB in the
reverberation time (Polack's model of late reverberation), and its total energy is a fraction of the direct sound's
energy. The powers of a take are therefore sufficient: they are convolved with this decay, in the way that Hirsch and
Finster adapt models of words to rooms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.speech.enrolled.words import Take
from linkwright.speech.sound.samples import RATE
from linkwright.speech.sound.spectra import HOP_LENGTH

_MAX_DECAY_DB = 30.0  # the attenuation of the reverberation in dB at which a take ends


@dataclass(frozen=True, slots=True)
class Room:
    """A room, and the microphone's distance in it, expressed by two acoustic values.

    Attributes:
        reverberation_time: the time in s in which sound decays by 60 dB.
        direct_ratio: the energy of the direct sound relative to the reverberation, in dB.
    """

    reverberation_time: float
    direct_ratio: float

    def reverberate(self, take: Take) -> Take:
        """Return the take as it would sound in this room, extended by the decay."""
        frame_seconds = HOP_LENGTH / RATE
        decay = 10.0 ** (-6.0 * frame_seconds / self.reverberation_time)
        tail_frames = round(_MAX_DECAY_DB / 60.0 * self.reverberation_time / frame_seconds)
        direct_powers = np.maximum(take.powers - take.noise, 0.0)
        direct_powers = np.concatenate((direct_powers, np.zeros((tail_frames, direct_powers.shape[1]))))
        late_powers = np.zeros_like(direct_powers)
        for index in range(len(direct_powers)):
            late_powers[index] = (1.0 - decay) * direct_powers[index] + (
                decay * late_powers[index - 1] if index else 0.0
            )
        return Take(direct_powers + 10.0 ** (-self.direct_ratio / 10.0) * late_powers + take.noise, take.noise)


ROOMS = (Room(0.4, 8.0), Room(0.5, 2.0))
"""A living room from a distance of two meters, and a larger room or a greater distance."""
