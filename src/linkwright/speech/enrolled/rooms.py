"""Takes as they would sound in a room, which recognises words enrolled near the microphone from farther away.

A room adds earlier sound to the current sound. In each band its power decays exponentially, by 60 dB in the
reverberation time (Polack's model of late reverberation), and its total energy is a fraction of the energy of the
direct sound. The powers of a take are therefore sufficient: they are convolved with this decay, in the way that Hirsch
and Finster adapt models of words to rooms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.speech.enrolled.words import Take
from linkwright.speech.sound.samples import RATE
from linkwright.speech.sound.spectra import HOP

_FADED = 30.0  # dB: attenuation of the reverberation at which a take ends


@dataclass(frozen=True, slots=True)
class Room:
    """A room and the distance of the microphone in it.

    Attributes:
        reverberation: the time in s in which sound decays by 60 dB.
        direct: the energy of the direct sound relative to the reverberation, in dB.
    """

    reverberation: float
    direct: float

    def reverberate(self, take: Take) -> Take:
        """Return a take as it would sound in this room, extended by the decay."""
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
