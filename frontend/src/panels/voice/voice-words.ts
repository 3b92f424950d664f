import type { VoiceState } from "../../state/voice/voice";
import { strings } from "../../strings";

/** Returns the obstacle to talking and its remedy; null if there is none. */
export function describeObstacle(voice: VoiceState): string | null {
  const texts = strings.voice;
  const { microphone, serverState, isHeld, isAlwaysListening } = voice;
  if (microphone.problem === "insecure") return texts.insecure(location.hostname, location.port || "80");
  if (microphone.problem === "failed") return texts.failed(microphone.detail);
  if (microphone.problem !== null) return texts.problems[microphone.problem];
  if (serverState?.cut === true) return texts.cut;
  if (voice.hasGaps && !voice.hasAnswer) return texts.gaps;
  if (!isHeld && !isAlwaysListening) return null;
  if (serverState?.talking === "another") return texts.another;
  if (serverState?.sound_listeners === 0) return texts.nobody;
  return null;
}

/** Returns the state of the microphone in words. */
export function describeActivity(voice: VoiceState): string {
  const texts = strings.voice;
  if (voice.microphone.isOpening) return texts.opening;
  if (voice.isHeld) return texts.listening;
  return voice.isAlwaysListening ? texts.openListening : texts.idle;
}
