import { createButton } from "../../dom";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";

/** Returns whether the robot proposes to enroll words at the user's location, and the user has not started yet. */
export function proposesEnrolling(voice: VoiceState, words: WordsState): boolean {
  return voice.serverState?.proposes_enrolling === true && words.takesHere === null;
}

/** Returns a button that starts enrollment at the user's location. */
export function createEnrollHereButton(words: WordsState): HTMLButtonElement {
  const { enrollHere, enrollHereHint } = strings.voice.words;
  return createButton(enrollHereHint, () => words.enrollRequested.emit(), "tool framed primary", enrollHere);
}
