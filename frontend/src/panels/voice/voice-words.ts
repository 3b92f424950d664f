import type { VoiceState } from "../../state/voice/voice";
import { strings } from "../../strings";

/** Returns the obstacle to talking and its remedy; null if there is none. */
export function obstacle(voice: VoiceState): string | null {
  const words = strings.voice;
  const { microphone, serverState, held, open } = voice;
  if (microphone.problem === "insecure") return words.insecure(location.hostname, location.port || "80");
  if (microphone.problem === "failed") return words.failed(microphone.detail);
  if (microphone.problem !== null) return words.problems[microphone.problem];
  if (serverState?.cut === true) return words.cut;
  if (voice.hasGaps && !voice.answered) return words.gaps;
  if (!held && !open) return null;
  if (serverState?.talking === "another") return words.another;
  if (serverState?.sound_listeners === 0) return words.nobody;
  return null;
}

/** Returns the state of the microphone in words. */
export function activity(voice: VoiceState): string {
  const words = strings.voice;
  if (voice.microphone.isOpening) return words.opening;
  if (voice.held) return words.listening;
  return voice.open ? words.openListening : words.idle;
}
