"""Takes as a room would return them, so that words enrolled close to the microphone are recognised from farther away.

A room adds the sound of before to that of now. In each band its power fades exponentially, by 60 dB in the
reverberation time (Polack's model of late reverberation), and the energy of all of it is a share of that of the direct
sound. So the powers of a take are enough: they are convolved with that decay, as Hirsch and Finster adapt models of
words to rooms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.speech.enrolled.words import Take
from linkwright.speech.sound.samples import RATE
from linkwright.speech.sound.spectra import HOP

_FADED = 30.0  # dB: how far the echo fades before a take ends


@dataclass(frozen=True, slots=True)
class Room:
    """A room, and how far away the microphone is.

    Attributes:
        reverberation: s in which sound fades by 60 dB.
        direct: energy of the direct sound relative to that of the reverberation, in dB.
    """

    reverberation: float
    direct: float

    def returns(self, take: Take) -> Take:
        """A take as it would be in this room, with the time in which it fades away."""
        frame = HOP / RATE
        kept = 10.0 ** (-6.0 * frame / self.reverberation)
        faded = round(_FADED / 60.0 * self.reverberation / frame)
        direct = np.maximum(take.powers - take.noise, 0.0)
        direct = np.concatenate((direct, np.zeros((faded, direct.shape[1]))))
        late = np.zeros_like(direct)
        for at in range(len(direct)):
            late[at] = (1.0 - kept) * direct[at] + (kept * late[at - 1] if at else 0.0)
        return Take(direct + 10.0 ** (-self.direct / 10.0) * late + take.noise, take.noise)


ROOMS = (Room(0.4, 8.0), Room(0.5, 2.0))
"""A living room from two metres, and a larger one or from farther away."""
